//! Asking a record for its fields.

use super::list::{Data, Listed, MemoryOwner, Record, RecordField};
use crate::artifact::Shared;
use crate::artifact::{GrayImage, Picture, RgbImage};

/// Reads the fields of one record by their names.
#[derive(Debug, Clone, Copy)]
pub struct Reader<'a>(&'a Record<'a>);

impl<'a> Reader<'a> {
    /// A reader of that record.
    pub fn new(record: &'a Record<'a>) -> Self {
        Reader(record)
    }

    /// The field of that name, where there is one.
    pub fn find(&self, name: &str) -> Option<&'a RecordField<'a>> {
        self.0.fields.iter().find(|f| f.name == name)
    }

    fn field(&self, name: &str) -> Result<&'a RecordField<'a>, String> {
        self.find(name).ok_or_else(|| format!("the field `{name}` is missing"))
    }

    /// A list.
    ///
    /// Errors: the field is missing, or holds something else.
    pub fn list<T: Listed>(&self, name: &str) -> Result<Vec<T>, String> {
        let field = self.field(name)?;
        if field.width != T::WIDTH {
            return Err(format!("`{name}` has {} numbers an element, {} are wanted", field.width, T::WIDTH));
        }
        if !field.data.len().is_multiple_of(T::WIDTH as usize) {
            return Err(format!("`{name}` has {} numbers, no whole number of elements", field.data.len()));
        }
        let wanted = T::lend(&[]);
        let cannot = || format!("`{name}` holds {}, {} are wanted", field.data.words(), wanted.words());
        T::take(&field.data).ok_or_else(cannot)
    }

    /// One element.
    pub fn one<T: Listed>(&self, name: &str) -> Result<T, String> {
        match self.list::<T>(name)?.as_slice() {
            [one] => Ok(*one),
            list => Err(format!("`{name}` has {} elements, 1 is wanted", list.len())),
        }
    }

    /// One element, where the field is there.
    pub fn maybe_one<T: Listed>(&self, name: &str) -> Result<Option<T>, String> {
        self.find(name).map(|_| self.one(name)).transpose()
    }

    /// A count.
    pub fn count(&self, name: &str) -> Result<usize, String> {
        let count = self.one::<u64>(name)?;
        usize::try_from(count).map_err(|_| format!("`{name}` is {count}, which is too many"))
    }

    /// A truth.
    pub fn flag(&self, name: &str) -> Result<bool, String> {
        Ok(self.one::<u8>(name)? != 0)
    }

    /// A text.
    pub fn text(&self, name: &str) -> Result<String, String> {
        match &self.field(name)?.data {
            Data::Text(text) => Ok(text.clone().into_owned()),
            other => Err(format!("`{name}` holds {}, a text is wanted", other.words())),
        }
    }

    /// Readers of the records in a field.
    pub fn records(&self, name: &str) -> Result<impl ExactSizeIterator<Item = Reader<'a>>, String> {
        match &self.field(name)?.data {
            Data::Records(records) => Ok(records.iter().map(Reader)),
            other => Err(format!("`{name}` holds {}, records are wanted", other.words())),
        }
    }

    /// A reader of the one record in a field, where the field is there.
    pub fn maybe(&self, name: &str) -> Result<Option<Reader<'a>>, String> {
        match self.find(name) {
            None => Ok(None),
            Some(_) => self.records(name).map(|mut r| r.next()),
        }
    }

    /// A colour picture: `size` (width, height) and three bytes a pixel.
    pub fn rgb(&self, name: &str) -> Result<Shared<RgbImage>, String> {
        self.picture(name)
    }

    /// A grey picture: `size` and one byte a pixel.
    pub fn grey(&self, name: &str) -> Result<Shared<GrayImage>, String> {
        self.picture(name)
    }

    fn picture<P: Picture>(&self, name: &str) -> Result<Shared<P>, String> {
        let width = P::CHANNELS;
        let [w, h] = self.one::<[u32; 2]>("size")?;
        let field = self.field(name)?;
        let Data::U8(bytes) = &field.data else {
            return Err(format!("`{name}` holds {}, bytes are wanted", field.data.words()));
        };
        if field.width != width {
            return Err(format!("`{name}` has {} numbers an element, {width} are wanted", field.width));
        }
        let wanted = u64::from(w) * u64::from(h) * u64::from(width);
        if bytes.len() as u64 != wanted {
            return Err(format!("`{name}` has {} bytes, {w} x {h} pixels are {wanted}", bytes.len()));
        }
        let lent = match &field.owner {
            MemoryOwner::Foreign(owner) => super::lend::picture(owner.as_ref(), bytes, w, h),
            _ => None,
        };
        let copied = || P::of_bytes(w, h, bytes.to_vec()).map(Shared::new);
        let cannot = || format!("`{name}` is no picture of {w} x {h} pixels");
        lent.or_else(copied).ok_or_else(cannot)
    }
}
