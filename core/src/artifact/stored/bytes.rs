//! Records as bytes, with every length checked on the way back.
//!
//! Layout, little-endian: the magic, the kind as text, then the record: the number of its fields
//! (u32), and of each its name (u32 and bytes), type (u8), width (u32), count (u64) and numbers.

use super::MAX_DEPTH;
use super::{Data, MemoryOwner, Record, RecordField};
use crate::artifact::Kind;
use bytemuck::{Pod, cast_slice, pod_collect_to_vec};
use std::borrow::Cow;

/// The first bytes; the digits are the layout's version.
const MAGIC: &[u8; 8] = b"TOILE\x0001";

const _: () = assert!(cfg!(target_endian = "little"), "records are stored as they lie in memory");

pub(super) fn write(kind: Kind, record: &Record<'_>) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    text(&mut out, kind.0);
    put(&mut out, record);
    out
}

fn text(out: &mut Vec<u8>, text: &str) {
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(text.as_bytes());
}

fn put(out: &mut Vec<u8>, record: &Record<'_>) {
    out.extend((record.fields.len() as u32).to_le_bytes());
    for field in &record.fields {
        text(out, &field.name);
        out.push(tag(&field.data));
        out.extend(field.width.to_le_bytes());
        out.extend((field.data.len() as u64).to_le_bytes());
        match &field.data {
            Data::U8(x) => out.extend(x.iter()),
            Data::U32(x) => out.extend(cast_slice::<u32, u8>(x)),
            Data::U64(x) => out.extend(cast_slice::<u64, u8>(x)),
            Data::F32(x) => out.extend(cast_slice::<f32, u8>(x)),
            Data::F64(x) => out.extend(cast_slice::<f64, u8>(x)),
            Data::Text(x) => out.extend(x.as_bytes()),
            Data::Records(records) => records.iter().for_each(|r| put(out, r)),
        }
    }
}

fn tag(data: &Data<'_>) -> u8 {
    match data {
        Data::U8(_) => 1,
        Data::U32(_) => 2,
        Data::U64(_) => 3,
        Data::F32(_) => 4,
        Data::F64(_) => 5,
        Data::Text(_) => 6,
        Data::Records(_) => 7,
    }
}

pub(super) fn read(kind: Kind, bytes: &[u8]) -> Result<Record<'_>, String> {
    let mut bytes = UnreadBytes(bytes);
    if bytes.take(MAGIC.len() as u64)? != MAGIC {
        return Err("it is no stored artifact of this version".into());
    }
    let found = bytes.text()?;
    if found != kind.0 {
        return Err(format!("it holds a {found}, a {kind} is wanted"));
    }
    let record = bytes.record(0)?;
    match bytes.0 {
        [] => Ok(record),
        rest => Err(format!("{} bytes are left over", rest.len())),
    }
}

/// What has not been read yet.
struct UnreadBytes<'a>(&'a [u8]);

impl<'a> UnreadBytes<'a> {
    fn take(&mut self, count: u64) -> Result<&'a [u8], String> {
        let count = usize::try_from(count).ok().filter(|n| *n <= self.0.len());
        let (taken, rest) = self.0.split_at(count.ok_or("it ends too early")?);
        self.0 = rest;
        Ok(taken)
    }

    fn u32(&mut self) -> Result<u32, String> {
        Ok(u32::from_le_bytes(self.take(4)?.try_into().unwrap_or_default()))
    }

    fn u64(&mut self) -> Result<u64, String> {
        Ok(u64::from_le_bytes(self.take(8)?.try_into().unwrap_or_default()))
    }

    fn text(&mut self) -> Result<&'a str, String> {
        let length = self.u32()?;
        self.utf8(u64::from(length))
    }

    fn utf8(&mut self, length: u64) -> Result<&'a str, String> {
        std::str::from_utf8(self.take(length)?).map_err(|_| "a text in it is not UTF-8".into())
    }

    fn numbers<T: Pod>(&mut self, count: u64) -> Result<Cow<'a, [T]>, String> {
        let length = count.checked_mul(size_of::<T>() as u64).ok_or("it ends too early")?;
        Ok(Cow::Owned(pod_collect_to_vec(self.take(length)?)))
    }

    fn record(&mut self, depth: usize) -> Result<Record<'a>, String> {
        if depth > MAX_DEPTH {
            return Err(format!("its records are nested deeper than {MAX_DEPTH}"));
        }
        // The lists grow as fields are read, so that a false count claims no memory.
        let (count, mut record) = (self.u32()?, Record::new());
        for _ in 0..count {
            record.fields.push(self.field(depth)?);
        }
        Ok(record)
    }

    fn field(&mut self, depth: usize) -> Result<RecordField<'a>, String> {
        let name = Cow::Borrowed(self.text()?);
        let tag = self.take(1)?[0];
        let (width, count) = (self.u32()?, self.u64()?);
        let data = match tag {
            1 => Data::U8(Cow::Borrowed(self.take(count)?)),
            2 => Data::U32(self.numbers(count)?),
            3 => Data::U64(self.numbers(count)?),
            4 => Data::F32(self.numbers(count)?),
            5 => Data::F64(self.numbers(count)?),
            6 => Data::Text(Cow::Borrowed(self.utf8(count)?)),
            7 => Data::Records(self.records(count, depth)?),
            other => return Err(format!("the field `{name}` has the unknown type {other}")),
        };
        Ok(RecordField { name, width, data, owner: MemoryOwner::None })
    }

    fn records(&mut self, count: u64, depth: usize) -> Result<Vec<Record<'a>>, String> {
        let mut records = Vec::new();
        for _ in 0..count {
            records.push(self.record(depth + 1)?);
        }
        Ok(records)
    }
}
