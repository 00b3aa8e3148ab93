//! A ZIP archive without compression, as USDZ asks for (Pixar, *Usdz file format specification*,
//! 2018; PKWARE, *APPNOTE*, 6.3).
//!
//! The data of each file begins at a multiple of 64 bytes, so that programs map it into memory as
//! it is: the extra field of its header is filled up. Times are those of no clock (1 January 1980).
//! Limits: 4 GiB, and 65,535 files.

use toile_core::StageError;

/// What the data of each file is aligned to, bytes.
const ALIGNMENT: usize = 64;
/// Bytes of a local header and of an extra field's own header.
const HEADER: usize = 30;
const EXTRA: usize = 4;
/// The identifier of the extra field that fills up: the one that Pixar's own writer takes.
const FILLING: u16 = 0x1986;
/// The first day that the format knows: year 1980, month 1, day 1.
const FIRST_DAY: u16 = 1 << 5 | 1;
/// The format's version that readers must know: 1.0.
const VERSION: u16 = 10;

/// The archive of files, by their paths with `/` in ASCII letters, in this order.
///
/// Errors: it exceeds the format's limits.
pub(in crate::write) fn stored(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, StageError> {
    let hint = "lower `size` of the texturer or make the mesh coarser";
    let too_large = || StageError::invalid("the model exceeds the 4 GiB of a ZIP archive").hint(hint);
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (path, data) in files {
        let start = u32::try_from(archive.len()).map_err(|_| too_large())?;
        let size = u32::try_from(data.len()).map_err(|_| too_large())?;
        let same = shared_fields(path, data, size);
        let filling = filling(archive.len() + HEADER + path.len());
        archive.extend_from_slice(b"PK\x03\x04");
        archive.extend_from_slice(&same);
        archive.extend_from_slice(&(filling.len() as u16).to_le_bytes());
        archive.extend_from_slice(path.as_bytes());
        archive.extend_from_slice(&filling);
        archive.extend_from_slice(data);
        directory.extend_from_slice(b"PK\x01\x02");
        directory.extend_from_slice(&VERSION.to_le_bytes());
        directory.extend_from_slice(&same);
        // No extra field, no comment, first disk, no attributes.
        directory.extend_from_slice(&[0; 12]);
        directory.extend_from_slice(&start.to_le_bytes());
        directory.extend_from_slice(path.as_bytes());
    }
    let count = u16::try_from(files.len()).map_err(|_| too_large())?;
    let (start, size) = (u32::try_from(archive.len()), u32::try_from(directory.len()));
    let (start, size) = (start.map_err(|_| too_large())?, size.map_err(|_| too_large())?);
    archive.extend_from_slice(&directory);
    archive.extend_from_slice(b"PK\x05\x06\0\0\0\0");
    archive.extend_from_slice(&[count.to_le_bytes(), count.to_le_bytes()].concat());
    archive.extend_from_slice(&[size.to_le_bytes(), start.to_le_bytes()].concat());
    archive.extend_from_slice(&[0; 2]);
    Ok(archive)
}

/// The fields that both headers of a file have, up to the length of its path.
fn shared_fields(path: &str, data: &[u8], size: u32) -> Vec<u8> {
    let (flags, method, time) = (0_u16, 0_u16, 0_u16);
    let short = [VERSION, flags, method, time, FIRST_DAY].map(u16::to_le_bytes).concat();
    let long = [crc32fast::hash(data), size, size].map(u32::to_le_bytes).concat();
    [short, long, (path.len() as u16).to_le_bytes().to_vec()].concat()
}

/// An extra field after which the data, which would begin at `at`, is aligned; empty where it is
/// without one.
fn filling(at: usize) -> Vec<u8> {
    let missing = at.next_multiple_of(ALIGNMENT) - at;
    if missing == 0 {
        return Vec::new();
    }
    let length = if missing < EXTRA { missing + ALIGNMENT } else { missing };
    let mut field = [FILLING, (length - EXTRA) as u16].map(u16::to_le_bytes).concat();
    field.resize(length, 0);
    field
}
