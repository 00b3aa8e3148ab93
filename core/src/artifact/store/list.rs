//! Records and their fields.

use super::lend::Lend;
use crate::artifact::{Digester, Point2, Point3, Vector3};
use bytemuck::{Pod, cast_slice};
use std::any::Any;
use std::borrow::Cow;
use std::sync::Arc;

/// Named fields, in the order in which they were added.
#[derive(Debug, Clone, Default)]
pub struct Record<'a> {
    /// The fields.
    pub fields: Vec<RecordField<'a>>,
}

/// One field of a record.
#[derive(Debug, Clone)]
pub struct RecordField<'a> {
    /// Its name, such as `positions`.
    pub name: Cow<'a, str>,
    /// How many numbers make one element: 3 for points in space.
    pub width: u32,
    /// What it holds.
    pub data: Data<'a>,
    /// Who keeps its memory beyond the record, where somebody does: then it may be lent and not
    /// copied.
    pub owner: MemoryOwner,
}

/// Who keeps the memory of a list.
#[derive(Debug, Clone, Default)]
pub enum MemoryOwner {
    /// Nobody beyond the record.
    #[default]
    None,
    /// A shared value of this program.
    Own(Arc<dyn Any + Send + Sync>),
    /// The other side of a plugin's border.
    Foreign(Arc<dyn Lend>),
}

/// What a field holds: numbers, a text or records.
#[derive(Debug, Clone)]
pub enum Data<'a> {
    /// Bytes: pixels, flags.
    U8(Cow<'a, [u8]>),
    /// Indices.
    U32(Cow<'a, [u32]>),
    /// Counts.
    U64(Cow<'a, [u64]>),
    /// Figures of pictures.
    F32(Cow<'a, [f32]>),
    /// Metres, kilograms, seconds.
    F64(Cow<'a, [f64]>),
    /// A text.
    Text(Cow<'a, str>),
    /// Further records.
    Records(Vec<Record<'a>>),
}

impl Data<'_> {
    /// How many numbers, bytes of text or records it holds.
    pub fn len(&self) -> usize {
        match self {
            Data::U8(x) => x.len(),
            Data::U32(x) => x.len(),
            Data::U64(x) => x.len(),
            Data::F32(x) => x.len(),
            Data::F64(x) => x.len(),
            Data::Text(x) => x.len(),
            Data::Records(x) => x.len(),
        }
    }

    /// True where it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What it is, in words.
    pub fn words(&self) -> &'static str {
        match self {
            Data::U8(_) => "bytes",
            Data::U32(_) => "32-bit whole numbers",
            Data::U64(_) => "64-bit whole numbers",
            Data::F32(_) => "32-bit floats",
            Data::F64(_) => "64-bit floats",
            Data::Text(_) => "a text",
            Data::Records(_) => "records",
        }
    }
}

/// A type whose lists are lists of plain numbers.
pub trait Listed: Pod {
    /// Numbers in one element.
    const WIDTH: u32;
    /// A list as numbers.
    fn lend(list: &[Self]) -> Data<'_>;
    /// The elements, where the numbers are of this type's.
    fn take(data: &Data<'_>) -> Option<Vec<Self>>;
}

macro_rules! listed {
    ($($t:ty: $width:literal of $number:ident),* $(,)?) => {$(
        impl Listed for $t {
            const WIDTH: u32 = $width;
            fn lend(list: &[Self]) -> Data<'_> {
                Data::$number(Cow::Borrowed(cast_slice(list)))
            }
            fn take(data: &Data<'_>) -> Option<Vec<Self>> {
                match data {
                    Data::$number(x) if x.len().is_multiple_of($width) => Some(bytemuck::pod_collect_to_vec(x)),
                    _ => None,
                }
            }
        }
    )*};
}
listed!(u8: 1 of U8, u32: 1 of U32, [u32; 2]: 2 of U32, [u32; 3]: 3 of U32, [u32; 4]: 4 of U32, u64: 1 of U64, [u64; 2]: 2 of U64, f32: 1 of F32,
    [f32; 2]: 2 of F32, [f32; 3]: 3 of F32, f64: 1 of F64, [f64; 2]: 2 of F64, Point2: 2 of F64, Point3: 3 of F64,
    Vector3: 3 of F64);

impl<'a> Record<'a> {
    /// No fields.
    pub fn new() -> Self {
        Self::default()
    }

    /// Feeds every field: its name, how many it holds, and those.
    pub(in crate::artifact) fn digest(&self, d: &mut Digester) {
        d.count(self.fields.len());
        for field in &self.fields {
            d.text(&field.name).count(field.data.len());
            match &field.data {
                Data::U8(x) => d.bytes(x),
                Data::U32(x) => d.bytes(cast_slice(x)),
                Data::U64(x) => d.bytes(cast_slice(x)),
                Data::F32(x) => d.bytes(cast_slice(x)),
                Data::F64(x) => d.bytes(cast_slice(x)),
                Data::Text(x) => d.bytes(x.as_bytes()),
                Data::Records(x) => x.iter().fold(&mut *d, |d, record| {
                    record.digest(d);
                    d
                }),
            };
        }
    }

    /// Adds a list.
    pub fn list<T: Listed>(self, name: &'a str, list: &'a [T]) -> Self {
        self.field(name, T::WIDTH, T::lend(list))
    }

    /// Adds elements that are made for the record.
    pub fn owned<T: Listed>(self, name: &'a str, list: impl IntoIterator<Item = T>) -> Self {
        let list: Vec<T> = list.into_iter().collect();
        let data = match T::lend(&list) {
            Data::U8(x) => Data::U8(Cow::Owned(x.into_owned())),
            Data::U32(x) => Data::U32(Cow::Owned(x.into_owned())),
            Data::U64(x) => Data::U64(Cow::Owned(x.into_owned())),
            Data::F32(x) => Data::F32(Cow::Owned(x.into_owned())),
            Data::F64(x) => Data::F64(Cow::Owned(x.into_owned())),
            Data::Text(x) => Data::Text(Cow::Owned(x.into_owned())),
            Data::Records(_) => Data::Records(Vec::new()),
        };
        self.field(name, T::WIDTH, data)
    }

    /// Adds one number.
    pub fn number(self, name: &'a str, number: f64) -> Self {
        self.owned(name, [number])
    }

    /// Adds one number, if there is one.
    pub fn maybe_number(self, name: &'a str, number: Option<f64>) -> Self {
        match number {
            Some(number) => self.number(name, number),
            None => self,
        }
    }

    /// Adds a count.
    pub fn count(self, name: &'a str, count: usize) -> Self {
        self.owned(name, [count as u64])
    }

    /// Adds a truth.
    pub fn flag(self, name: &'a str, flag: bool) -> Self {
        self.owned(name, [u8::from(flag)])
    }

    /// Adds a text.
    pub fn text(self, name: &'a str, text: &'a str) -> Self {
        self.field(name, 1, Data::Text(Cow::Borrowed(text)))
    }

    /// Adds records.
    pub fn records(self, name: &'a str, records: impl IntoIterator<Item = Record<'a>>) -> Self {
        self.field(name, 1, Data::Records(records.into_iter().collect()))
    }

    /// Adds a record, if there is one.
    pub fn maybe(self, name: &'a str, record: Option<Record<'a>>) -> Self {
        match record {
            Some(record) => self.records(name, [record]),
            None => self,
        }
    }

    /// Adds a field.
    pub fn field(mut self, name: &'a str, width: u32, data: Data<'a>) -> Self {
        self.fields.push(RecordField { name: Cow::Borrowed(name), width, data, owner: MemoryOwner::None });
        self
    }

    /// Adds bytes that are shared.
    pub(in crate::artifact) fn lent(
        mut self,
        name: &'a str,
        width: u32,
        bytes: &'a [u8],
        owner: Arc<dyn Any + Send + Sync>,
    ) -> Self {
        let data = Data::U8(Cow::Borrowed(bytes));
        self.fields.push(RecordField {
            name: Cow::Borrowed(name),
            width,
            data,
            owner: MemoryOwner::Own(owner),
        });
        self
    }
}
