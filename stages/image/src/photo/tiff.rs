//! The first directory of a TIFF: the size of its picture, and whether that is all of a photo.
//!
//! Cameras' raw files are TIFFs as well. Their first picture is a thumbnail, which must not pass
//! for the photo.
//!
//! Source: TIFF revision 6.0, 1992, and its extension to files beyond 4 GB; DNG specification 1.6.

/// Tags of the directory.
const SUBFILE: u64 = 254;
const WIDTH: u64 = 256;
const HEIGHT: u64 = 257;
const STRIP_OFFSETS: u64 = 273;
const STRIP_LENGTHS: u64 = 279;
const TILE_OFFSETS: u64 = 324;
const TILE_LENGTHS: u64 = 325;
const DNG_VERSION: u64 = 50706;

/// Entries of a directory that are looked at.
const MAX_ENTRIES: u64 = 4096;

/// The first directory.
pub(super) struct Directory<'a> {
    bytes: &'a [u8],
    big_endian: bool,
    /// Bytes of an offset.
    word: u64,
    first: u64,
    count: u64,
}

/// Values of a tag: how many, bytes of each, where.
struct TagValues {
    count: u64,
    size: u64,
    at: u64,
}

impl<'a> Directory<'a> {
    /// The first directory; none where the file ends before it.
    pub(super) fn read(bytes: &'a [u8]) -> Option<Self> {
        let big_endian = bytes.starts_with(b"MM");
        let none = Directory { bytes, big_endian, word: 4, first: 0, count: 0 };
        let (word, at) =
            if none.number(2, 2)? == 43 { (8, none.number(8, 8)?) } else { (4, none.number(4, 4)?) };
        let counted = if word == 8 { 8 } else { 2 };
        let count = none.number(at, counted)?.min(MAX_ENTRIES);
        Some(Directory { word, first: at.checked_add(counted)?, count, ..none })
    }

    fn number(&self, at: u64, size: u64) -> Option<u64> {
        let from = usize::try_from(at).ok()?;
        let slice = self.bytes.get(from..from.checked_add(size as usize)?)?;
        let add = |n: u64, b: &u8| n << 8 | u64::from(*b);
        Some(if self.big_endian { slice.iter().fold(0, add) } else { slice.iter().rev().fold(0, add) })
    }

    fn values(&self, tag: u64) -> Option<TagValues> {
        let length = 4 + 2 * self.word;
        let at =
            (0..self.count).map(|i| self.first + i * length).find(|at| self.number(*at, 2) == Some(tag))?;
        let size = match self.number(at + 2, 2)? {
            1 | 7 => 1,
            3 => 2,
            4 | 13 => 4,
            16 | 18 => 8,
            _ => return None,
        };
        let count = self.number(at + 4, self.word)?;
        let place = at + 4 + self.word;
        // Values that fit stand in the entry itself.
        let at = if count.checked_mul(size)? <= self.word { place } else { self.number(place, self.word)? };
        Some(TagValues { count, size, at })
    }

    fn value(&self, tag: u64, index: u64) -> Option<u64> {
        let TagValues { count, size, at } = self.values(tag)?;
        (index < count).then_some(())?;
        self.number(at.checked_add(index.checked_mul(size)?)?, size)
    }

    /// Pixels across and down.
    pub(super) fn size(&self) -> Option<(u64, u64)> {
        Some((self.value(WIDTH, 0)?, self.value(HEIGHT, 0)?))
    }

    /// Whether all strips or tiles lie in the file; also where it does not say how long they are.
    pub(super) fn is_complete(&self) -> bool {
        let tags = [(STRIP_OFFSETS, STRIP_LENGTHS), (TILE_OFFSETS, TILE_LENGTHS)];
        tags.into_iter().all(|(offsets, lengths)| {
            let (Some(from), Some(long)) = (self.values(offsets), self.values(lengths)) else { return true };
            let number =
                |v: &TagValues, i: u64| self.number(v.at.checked_add(i.checked_mul(v.size)?)?, v.size);
            let ends = |i: u64| number(&from, i)?.checked_add(number(&long, i)?);
            (0..from.count.min(long.count)).all(|i| ends(i).is_some_and(|end| end <= self.bytes.len() as u64))
        })
    }
}

/// Whether a TIFF is a camera's raw file.
pub(super) fn is_raw(bytes: &[u8]) -> bool {
    let canon = bytes.get(8..10) == Some(b"CR");
    let Some(directory) = Directory::read(bytes) else { return canon };
    let reduced = directory.value(SUBFILE, 0).is_some_and(|kind| kind & 1 == 1);
    canon || reduced || directory.values(DNG_VERSION).is_some()
}
