//! Whether a library is whole, by its own tables, before the system maps it.
//!
//! The system maps a library that was cut short as if it were whole, and the first touch of a page
//! that the file does not hold ends the program (SIGBUS). An interrupted link or copy leaves such
//! files. So every range of the file that its headers name must lie within it, and what the loader
//! follows without a look of its own, the tables of the dynamic section, must lie in what it maps.
//!
//! Source: System V ABI, chapters 4 and 5 (ELF); Mach-O Programming Topics; PE Format. Cost:
//! microseconds. Limit: what lies within the ranges is not looked at. A file of another form is
//! left to the system, which refuses it by its first bytes.

/// Checks the tables of a library.
///
/// Errors: one sentence in lower case.
pub(super) fn check_whole(bytes: &[u8]) -> Result<(), String> {
    match bytes {
        [0x7F, b'E', b'L', b'F', ..] => elf(bytes),
        [0xCF, 0xFA, 0xED, 0xFE, ..] => mach(bytes, 0),
        [0xCA, 0xFE, 0xBA, 0xBE, ..] => fat_mach(bytes),
        [b'M', b'Z', ..] => pe(bytes),
        _ => Ok(()),
    }
}

/// Numbers of a file at their offsets.
#[derive(Clone, Copy)]
struct Numbers<'a> {
    bytes: &'a [u8],
    big: bool,
}

impl Numbers<'_> {
    /// An unsigned number of `size` bytes.
    fn at(&self, offset: u64, size: u64) -> Result<u64, String> {
        let short = || cut_short(offset.saturating_add(size), self.bytes);
        let range = usize::try_from(offset).ok().zip(usize::try_from(offset.saturating_add(size)).ok());
        let slice = range.and_then(|(from, to)| self.bytes.get(from..to)).ok_or_else(short)?;
        let add = |n: u64, b: &u8| n << 8 | u64::from(*b);
        Ok(if self.big { slice.iter().fold(0, add) } else { slice.iter().rev().fold(0, add) })
    }

    /// A range that a table names lies in the file.
    fn holds(&self, offset: u64, size: u64) -> Result<(), String> {
        let end = offset.saturating_add(size);
        if end > self.bytes.len() as u64 { Err(cut_short(end, self.bytes)) } else { Ok(()) }
    }
}

fn cut_short(needs: u64, bytes: &[u8]) -> String {
    format!("it is cut short: its tables name {needs} bytes, it has {}", bytes.len())
}

/// Where the fields of an ELF file lie, by the width of its addresses.
struct ElfLayout {
    /// Bytes of an address.
    word: u64,
    /// Of the file header: offsets of the program and the section headers, and of the sizes and
    /// counts behind them.
    programs: u64,
    sections: u64,
    counts: u64,
    /// Of a program header: its offset in the file, address, size in the file, size in memory.
    segment: [u64; 4],
    /// Of a section header: its offset in the file, size.
    section: [u64; 2],
}

const ELF32: ElfLayout =
    ElfLayout { word: 4, programs: 28, sections: 32, counts: 42, segment: [4, 8, 16, 20], section: [16, 20] };
const ELF64: ElfLayout = ElfLayout {
    word: 8,
    programs: 32,
    sections: 40,
    counts: 54,
    segment: [8, 16, 32, 40],
    section: [24, 32],
};

const LOADED: u64 = 1;
const DYNAMIC: u64 = 2;
/// A section without a place in the file.
const NO_BITS: u64 = 8;
/// Entries of the dynamic section that hold an address, and the entry that holds its size, where
/// there is one.
const TABLES: [(u64, Option<u64>); 11] = [
    (STRINGS, Some(10)),
    (SYMBOLS, None),
    (4, None),
    (0x6FFF_FEF5, None),
    (7, Some(8)),
    (17, Some(18)),
    (23, Some(2)),
    (25, Some(27)),
    (26, Some(28)),
    (36, Some(35)),
    (0x6FFF_FFF0, None),
];
const STRINGS: u64 = 5;
const SYMBOLS: u64 = 6;

fn elf(bytes: &[u8]) -> Result<(), String> {
    let layout = match bytes.get(4) {
        Some(1) => ELF32,
        Some(2) => ELF64,
        _ => return Err("its ELF header is damaged".into()),
    };
    let n = Numbers { bytes, big: bytes.get(5) == Some(&2) };
    let word = layout.word;
    let [programs, sections] = [n.at(layout.programs, word)?, n.at(layout.sections, word)?];
    let count = |k: u64| n.at(layout.counts + 2 * k, 2);
    let (program_size, program_count, section_size, section_count) =
        (count(0)?, count(1)?, count(2)?, count(3)?);
    n.holds(programs, program_size * program_count)?;
    n.holds(sections, section_size * section_count)?;
    let mut mapped = Vec::new();
    let mut dynamic = None;
    for i in 0..program_count {
        let at = programs + i * program_size;
        let [offset, address, size, memory] = field(&n, at, &layout.segment, word)?;
        n.holds(offset, size)?;
        match n.at(at, 4)? {
            LOADED => mapped.push((address, address.saturating_add(memory))),
            DYNAMIC => dynamic = Some((offset, size)),
            _ => {}
        }
    }
    for i in 0..section_count {
        let at = sections + i * section_size;
        let [offset, size] = field(&n, at, &layout.section, word)?;
        if n.at(at + 4, 4)? != NO_BITS {
            n.holds(offset, size)?;
        }
    }
    let (offset, size) = dynamic.ok_or("it has no dynamic section")?;
    tables(&n, (offset, size), word, &mapped)
}

/// Fields of a header at `at`.
fn field<const N: usize>(
    n: &Numbers<'_>,
    at: u64,
    offsets: &[u64; N],
    word: u64,
) -> Result<[u64; N], String> {
    let mut found = [0; N];
    for (value, offset) in found.iter_mut().zip(offsets) {
        *value = n.at(at.saturating_add(*offset), word)?;
    }
    Ok(found)
}

/// The tables that the loader follows lie in what it maps, and those without which it cannot work
/// are there.
fn tables(
    n: &Numbers<'_>,
    (offset, size): (u64, u64),
    word: u64,
    mapped: &[(u64, u64)],
) -> Result<(), String> {
    let mut entries = Vec::new();
    for i in 0..size / (2 * word) {
        let at = offset + i * 2 * word;
        match n.at(at, word)? {
            0 => break,
            tag => entries.push((tag, n.at(at + word, word)?)),
        }
    }
    let value = |tag: u64| entries.iter().find(|(t, _)| *t == tag).map(|(_, v)| *v);
    if value(STRINGS).is_none() || value(SYMBOLS).is_none() {
        return Err("its dynamic section is damaged: it names no symbols".into());
    }
    for (table, length) in TABLES {
        let Some(from) = value(table) else { continue };
        let to = from.saturating_add(length.and_then(value).unwrap_or(1));
        if !mapped.iter().any(|(a, b)| *a <= from && to <= *b) {
            return Err(format!(
                "its dynamic section is damaged: table {table:#x} lies at {from:#x}, where nothing is"
            ));
        }
    }
    Ok(())
}

/// One architecture of a Mach-O file, which begins at `base`.
fn mach(bytes: &[u8], base: u64) -> Result<(), String> {
    const SEGMENT: u64 = 0x19;
    let n = Numbers { bytes, big: false };
    let (count, size) = (n.at(base + 16, 4)?, n.at(base + 20, 4)?);
    n.holds(base + 32, size)?;
    let mut at = base + 32;
    for _ in 0..count {
        let (kind, length) = (n.at(at, 4)?, n.at(at + 4, 4)?);
        if kind == SEGMENT {
            n.holds(base.saturating_add(n.at(at + 40, 8)?), n.at(at + 48, 8)?)?;
        }
        at += length.max(8);
    }
    Ok(())
}

/// A Mach-O file of several architectures. Java classes begin alike; their count reads as one
/// beyond any.
fn fat_mach(bytes: &[u8]) -> Result<(), String> {
    let n = Numbers { bytes, big: true };
    let count = n.at(4, 4)?;
    if count > 16 {
        return Ok(());
    }
    for i in 0..count {
        let at = 8 + 20 * i;
        let (offset, size) = (n.at(at + 8, 4)?, n.at(at + 12, 4)?);
        n.holds(offset, size)?;
        if bytes[offset as usize..].starts_with(&[0xCF, 0xFA, 0xED, 0xFE]) {
            mach(bytes, offset)?;
        }
    }
    Ok(())
}

fn pe(bytes: &[u8]) -> Result<(), String> {
    let n = Numbers { bytes, big: false };
    let at = n.at(0x3C, 4)?;
    n.holds(at, 24)?;
    if !bytes[at as usize..].starts_with(b"PE\0\0") {
        return Err("its PE header is damaged".into());
    }
    let (count, optional) = (n.at(at + 6, 2)?, n.at(at + 20, 2)?);
    for i in 0..count {
        let section = at + 24 + optional + 40 * i;
        n.holds(n.at(section + 20, 4)?, n.at(section + 16, 4)?)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A little library of one segment with a dynamic section, and one section header for it.
    fn library() -> Vec<u8> {
        let mut b = vec![0; 64 + 2 * 56];
        b[..6].copy_from_slice(&[0x7F, b'E', b'L', b'F', 2, 1]);
        let dynamic = b.len() as u64;
        let entries: [(u64, u64); 5] = [(5, 0), (10, 16), (6, 0), (7, 16), (0, 0)];
        entries.iter().for_each(|(t, v)| b.extend([t.to_le_bytes(), v.to_le_bytes()].concat()));
        let sections = b.len() as u64;
        b.extend([0; 64]);
        let put = |b: &mut Vec<u8>, at: usize, v: u64, size: usize| {
            b[at..at + size].copy_from_slice(&v.to_le_bytes()[..size])
        };
        for (at, v, size) in
            [(32, 64, 8), (40, sections, 8), (54, 56, 2), (56, 2, 2), (58, 64, 2), (60, 1, 2)]
        {
            put(&mut b, at, v, size);
        }
        let length = b.len() as u64;
        for (at, kind, offset, size) in [(64, 1, 0, length), (120, 2, dynamic, 80)] {
            put(&mut b, at, kind, 4);
            put(&mut b, at + 8, offset, 8);
            put(&mut b, at + 32, size, 8);
            put(&mut b, at + 40, size, 8);
        }
        b
    }

    #[test]
    fn a_library_cut_short_anywhere_is_told_by_its_tables() {
        let whole_one = library();
        assert_eq!(check_whole(&whole_one), Ok(()));
        for length in 4..whole_one.len() {
            assert!(check_whole(&whole_one[..length]).is_err(), "{length}");
        }
        let (all, cut) = (whole_one.len(), whole_one.len() - 1);
        let words = format!("it is cut short: its tables name {all} bytes, it has {cut}");
        assert_eq!(check_whole(&whole_one[..cut]), Err(words));
    }

    #[test]
    fn tables_that_lead_nowhere_are_told() {
        let mut b = library();
        b[64 + 112 + 16 * 2] = 0;
        assert_eq!(check_whole(&b).unwrap_err(), "its dynamic section is damaged: it names no symbols");
        let mut b = library();
        b[64 + 112 + 8 + 2] = 1;
        let words = "its dynamic section is damaged: table 0x5 lies at 0x10000, where nothing is";
        assert_eq!(check_whole(&b).unwrap_err(), words);
    }

    #[test]
    fn no_bytes_panic() {
        let b = library();
        for at in 0..b.len() {
            for value in [0, 1, 0x7F, 0xFF] {
                let mut b = b.clone();
                b[at] = value;
                let _ = check_whole(&b);
            }
        }
        for head in [&[0xCF, 0xFA, 0xED, 0xFE][..], &[0xCA, 0xFE, 0xBA, 0xBE], b"MZ"] {
            for fill in [0_u8, 1, 0xFF] {
                for length in [0, 3, 60, 200, 4000] {
                    let _ = check_whole(&[head, &vec![fill; length]].concat());
                }
            }
        }
    }

    #[test]
    fn other_systems_libraries_are_looked_at_too() {
        let mut windows = vec![0; 0x40 + 24 + 40];
        windows[..2].copy_from_slice(b"MZ");
        windows[0x3C] = 0x40;
        windows[0x40..0x44].copy_from_slice(b"PE\0\0");
        windows[0x46] = 1;
        windows[0x40 + 24 + 21] = 2;
        windows[0x40 + 24 + 17] = 1;
        assert_eq!(
            check_whole(&windows).unwrap_err(),
            "it is cut short: its tables name 768 bytes, it has 128"
        );
        windows.resize(768, 0);
        assert_eq!(check_whole(&windows), Ok(()));
        let mut mac = vec![0; 32 + 72];
        mac[..4].copy_from_slice(&[0xCF, 0xFA, 0xED, 0xFE]);
        (mac[16], mac[20], mac[32], mac[36], mac[32 + 49]) = (1, 72, 0x19, 72, 1);
        assert_eq!(check_whole(&mac).unwrap_err(), "it is cut short: its tables name 256 bytes, it has 104");
        mac.resize(256, 0);
        assert_eq!(check_whole(&mac), Ok(()));
    }
}
