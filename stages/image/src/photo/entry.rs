//! How a photo is written in a pipeline file: `(file: "front.jpg", width: "52 cm")` or
//! `MirrorOf("front")`.
//!
//! The two forms are read by the format's own enum and struct readers, so that a fault keeps its
//! line and column: a reader of tagged or untagged enums would lose them.

use super::scale::ScaleObject;
use serde::de::{DeserializeSeed, EnumAccess, VariantAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use toile_core::{Length, ParamType};

/// The narrowest garment, metres: a doll's sock. Smaller numbers are slips of the unit.
pub const MIN_WIDTH_M: f64 = 0.005;
/// The widest garment, metres: a ball gown laid flat has 3 m.
pub const MAX_WIDTH_M: f64 = 10.0;
/// The coarsest scale, pixels per metre: 1 cm per pixel.
pub const MIN_PX_PER_METRE: f64 = 100.0;
/// The finest scale, pixels per metre: a flat-bed scanner at 2,540 dpi.
pub const MAX_PX_PER_METRE: f64 = 100_000.0;

/// One photo of a pipeline.
#[derive(Debug, Clone, PartialEq)]
pub enum PhotoEntry {
    /// A file.
    File(PhotoFile),
    /// The mirror image of another entry, for a garment of which only one side was taken.
    MirrorOf(String),
}

/// A photo's file and what is known of its scale.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhotoFile {
    /// Path, relative to the pipeline file.
    pub file: String,
    /// Real width of the garment's bounding box; the scale follows once its mask is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<Length>,
    /// Scale, pixels per metre, where it is known otherwise (a scanner, a ruler in the photo).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub px_per_metre: Option<f64>,
    /// An object of known size beside the garment, which gives the scale; but for a ruler, the
    /// photo is rectified by it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<ScaleObject>,
    /// True where the garment's side is the mirror image of this photo.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirror: bool,
}

impl PhotoFile {
    /// A file whose garment has a known width.
    pub fn new(file: impl Into<String>, width: Length) -> Self {
        PhotoFile { file: file.into(), width: Some(width), ..Self::default() }
    }
}

/// Why a width cannot be right.
pub(super) fn width_fault(width: Length) -> Option<String> {
    match width.metres() {
        w if !w.is_finite() => Some("the garment's width is not a finite number".into()),
        w if w <= 0.0 => Some(format!("the garment's width is {width}, which is not positive")),
        w if !(MIN_WIDTH_M..=MAX_WIDTH_M).contains(&w) => Some(format!(
            "the garment's width is {width}, outside {} to {}",
            Length::m(MIN_WIDTH_M),
            Length::m(MAX_WIDTH_M)
        )),
        _ => None,
    }
}

/// Why a scale cannot be right.
pub(super) fn scale_fault(scale: f64) -> Option<String> {
    match (MIN_PX_PER_METRE..=MAX_PX_PER_METRE).contains(&scale) {
        true => None,
        false => Some(format!(
            "px_per_metre is {scale}, outside {MIN_PX_PER_METRE} to {MAX_PX_PER_METRE} pixels per metre"
        )),
    }
}

impl ParamType for PhotoEntry {
    fn describe() -> String {
        "(file: text, width: length, scale: BankCard | A4 | Letter | Ruler | Chessboard(square: length)) | MirrorOf(text)".into()
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            PhotoEntry::File(f) => f.width.map(Length::metres).into_iter().chain(f.px_per_metre).collect(),
            PhotoEntry::MirrorOf(_) => Vec::new(),
        }
    }
}

const NAME: &str = "PhotoEntry";
const MIRROR_OF: &str = "MirrorOf";
const FIELDS: [&str; 5] = ["file", "width", "px_per_metre", "scale", "mirror"];

impl Serialize for PhotoEntry {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            PhotoEntry::File(file) => file.serialize(s),
            PhotoEntry::MirrorOf(other) => s.serialize_newtype_variant(NAME, 0, MIRROR_OF, other),
        }
    }
}

impl<'de> Deserialize<'de> for PhotoEntry {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        d.deserialize_enum(NAME, &[MIRROR_OF], EntryVisitor)
    }
}

struct EntryVisitor;

impl<'de> Visitor<'de> for EntryVisitor {
    type Value = PhotoEntry;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("(file: \"...\", width: \"...\") or MirrorOf(\"...\")")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<PhotoEntry, A::Error> {
        match data.variant_seed(MirrorWord)? {
            (true, rest) => rest.newtype_variant().map(PhotoEntry::MirrorOf),
            (false, rest) => rest.struct_variant(&FIELDS, FileVisitor).map(PhotoEntry::File),
        }
    }
}

/// Takes the word `MirrorOf` where it stands; where it does not, nothing is taken.
struct MirrorWord;

impl<'de> DeserializeSeed<'de> for MirrorWord {
    type Value = bool;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<bool, D::Error> {
        struct Word;
        impl Visitor<'_> for Word {
            type Value = ();
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(MIRROR_OF)
            }
            fn visit_unit<E>(self) -> Result<(), E> {
                Ok(())
            }
        }
        Ok(d.deserialize_unit_struct(MIRROR_OF, Word).is_ok())
    }
}

/// Reads the fields by the derived reader.
struct FileVisitor;

impl<'de> Visitor<'de> for FileVisitor {
    type Value = PhotoFile;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("(file: \"...\", width: \"...\")")
    }

    fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<PhotoFile, A::Error> {
        PhotoFile::deserialize(serde::de::value::MapAccessDeserializer::new(map))
    }
}
