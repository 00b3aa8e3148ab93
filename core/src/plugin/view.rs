//! Records across the border: lent as they lie in memory, and read with every pointer checked as
//! far as a pointer can be.

use super::abi;
use super::lending::{Lending, ListOwners};
use crate::artifact::stored::{Data, MAX_DEPTH, MemoryOwner, Record, RecordField};
use bytemuck::Pod;
use std::borrow::Cow;
use std::ffi::c_void;
use std::sync::Arc;

/// The longest list of fields of one record.
const MAX_FIELDS: usize = 1000;

/// A record in C's form, with the record whose lists it shows.
#[derive(Debug)]
pub struct Lent<'a> {
    views: RecordViews,
    /// Its lists lie on the heap or elsewhere, so that they stay where they are when this moves.
    _record: Record<'a>,
}

/// The views of one record and of all records within.
#[derive(Debug)]
struct RecordViews {
    /// Pointed at from outside; boxed, so that it stays where it is.
    view: Box<abi::Record>,
    _fields: Vec<abi::Field>,
    _parts: Vec<NestedViews>,
    _owners: ListOwners,
}

/// The records of one field: kept for their owners, and side by side for C.
#[derive(Debug)]
struct NestedViews {
    _owners: Vec<RecordViews>,
    _views: Vec<abi::Record>,
}

impl<'a> Lent<'a> {
    /// Lends a record for as long as the result lives.
    pub fn of(record: Record<'a>) -> Self {
        Lent { views: RecordViews::of(&record), _record: record }
    }

    /// Where it lies.
    pub fn as_ptr(&self) -> *const abi::Record {
        &*self.views.view
    }
}

impl RecordViews {
    fn of(record: &Record<'_>) -> Self {
        let (mut parts, mut owners) = (Vec::new(), ListOwners::default());
        let fields: Vec<abi::Field> =
            record.fields.iter().map(|f| field(f, &mut parts, &mut owners)).collect();
        let view = Box::new(abi::Record { fields: fields.as_ptr(), count: fields.len() });
        RecordViews { view, _fields: fields, _parts: parts, _owners: owners }
    }
}

fn field(field: &RecordField<'_>, parts: &mut Vec<NestedViews>, owners: &mut ListOwners) -> abi::Field {
    let (kind, data): (u32, *const c_void) = match &field.data {
        Data::U8(x) => (abi::FIELD_U8, x.as_ptr().cast()),
        Data::U32(x) => (abi::FIELD_U32, x.as_ptr().cast()),
        Data::U64(x) => (abi::FIELD_U64, x.as_ptr().cast()),
        Data::F32(x) => (abi::FIELD_F32, x.as_ptr().cast()),
        Data::F64(x) => (abi::FIELD_F64, x.as_ptr().cast()),
        Data::Text(x) => (abi::FIELD_TEXT, x.as_ptr().cast()),
        Data::Records(records) => (abi::FIELD_RECORDS, lend_all(records, parts).cast()),
    };
    let owner = match &field.owner {
        MemoryOwner::Own(own) => owners.lend(own),
        _ => std::ptr::null(),
    };
    let (name, count) = (abi::Text::of(&field.name), field.data.len());
    abi::Field { name, data, count, kind, width: field.width, owner }
}

fn lend_all(records: &[Record<'_>], parts: &mut Vec<NestedViews>) -> *const abi::Record {
    let owners: Vec<RecordViews> = records.iter().map(RecordViews::of).collect();
    let views: Vec<abi::Record> = owners.iter().map(|o| *o.view).collect();
    let at = views.as_ptr();
    parts.push(NestedViews { _owners: owners, _views: views });
    at
}

/// A text of the other side.
///
/// # Safety
/// `text` holds as many bytes as it says, for as long as the result is used.
pub unsafe fn text<'a>(text: abi::Text) -> Result<&'a str, String> {
    let bytes = unsafe { list::<u8>(text.ptr.cast(), text.len, "a text")? };
    std::str::from_utf8(bytes).map_err(|_| "a text is not UTF-8".into())
}

/// A list of the other side: not null, aligned, of a length that can be.
///
/// # Safety
/// There are as many elements as it says, for as long as the result is used.
pub unsafe fn list<'a, T>(ptr: *const c_void, count: usize, what: &str) -> Result<&'a [T], String> {
    let ptr = ptr.cast::<T>();
    if count == 0 {
        return Ok(&[]);
    }
    if ptr.is_null() {
        return Err(format!("{what} has {count} elements at address zero"));
    }
    if !ptr.is_aligned() {
        return Err(format!("{what} is not aligned to {} bytes", align_of::<T>()));
    }
    if count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(format!("{what} has {count} elements, which is more than memory holds"));
    }
    Ok(unsafe { std::slice::from_raw_parts(ptr, count) })
}

/// Reads a record of the other side; `budget` is what its lists may have in bytes together.
///
/// # Safety
/// All that it points at is there for as long as the result is used.
pub unsafe fn record<'a>(record: *const abi::Record, budget: &mut u64) -> Result<Record<'a>, String> {
    let view = unsafe { list::<abi::Record>(record.cast(), 1, "a record")? };
    unsafe { fields(view[0], budget, 0) }
}

unsafe fn fields<'a>(view: abi::Record, budget: &mut u64, depth: usize) -> Result<Record<'a>, String> {
    if depth > MAX_DEPTH {
        return Err(format!("its records are nested deeper than {MAX_DEPTH}"));
    }
    if view.count > MAX_FIELDS {
        return Err(format!("a record has {} fields, the limit is {MAX_FIELDS}", view.count));
    }
    let views = unsafe { list::<abi::Field>(view.fields.cast(), view.count, "a record")? };
    let read = views.iter().map(|f| unsafe { one(f, budget, depth) });
    Ok(Record { fields: read.collect::<Result<_, _>>()? })
}

unsafe fn one<'a>(f: &abi::Field, budget: &mut u64, depth: usize) -> Result<RecordField<'a>, String> {
    let name = unsafe { text(f.name)? };
    let data = match f.kind {
        abi::FIELD_U8 => Data::U8(unsafe { numbers(f, name, budget)? }),
        abi::FIELD_U32 => Data::U32(unsafe { numbers(f, name, budget)? }),
        abi::FIELD_U64 => Data::U64(unsafe { numbers(f, name, budget)? }),
        abi::FIELD_F32 => Data::F32(unsafe { numbers(f, name, budget)? }),
        abi::FIELD_F64 => Data::F64(unsafe { numbers(f, name, budget)? }),
        abi::FIELD_TEXT => {
            spend(f.count, 1, name, budget)?;
            Data::Text(Cow::Borrowed(unsafe { text(abi::Text { ptr: f.data.cast(), len: f.count })? }))
        }
        abi::FIELD_RECORDS => {
            spend(f.count, size_of::<abi::Record>(), name, budget)?;
            let views = unsafe { list::<abi::Record>(f.data, f.count, name)? };
            let records = views.iter().map(|v| unsafe { fields(*v, budget, depth + 1) });
            Data::Records(records.collect::<Result<_, _>>()?)
        }
        other => return Err(format!("the field `{name}` has the unknown type {other}")),
    };
    let owner =
        unsafe { Lending::of(f.owner) }.map_or(MemoryOwner::None, |of| MemoryOwner::Foreign(Arc::new(of)));
    Ok(RecordField { name: Cow::Borrowed(name), width: f.width, data, owner })
}

unsafe fn numbers<'a, T: Pod>(f: &abi::Field, name: &str, budget: &mut u64) -> Result<Cow<'a, [T]>, String> {
    spend(f.count, size_of::<T>(), name, budget)?;
    let what = format!("the field `{name}`");
    Ok(Cow::Borrowed(unsafe { list::<T>(f.data, f.count, &what)? }))
}

/// Takes the bytes of a list off the budget.
fn spend(count: usize, size: usize, name: &str, budget: &mut u64) -> Result<(), String> {
    let bytes = (count as u64).saturating_mul(size as u64);
    if bytes > *budget {
        return Err(format!("the field `{name}` claims {bytes} bytes, {budget} are left of what is allowed"));
    }
    *budget -= bytes;
    Ok(())
}
