//! Parameters of stages: lengths with units, and the table that documents and checks them.

use crate::pipeline::near;
use serde::de::{DeserializeOwned, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A length in metres, written with its unit: `"12 mm"`, `"2.5 cm"`, `"1.72 m"`, `"3 in"`.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Length(f64);

/// Units a length may be written in, and their metres.
pub const LENGTH_UNITS: [(&str, f64); 4] = [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("in", 0.0254)];

impl Length {
    /// A length of so many metres.
    pub const fn m(metres: f64) -> Self {
        Length(metres)
    }

    /// A length of so many millimetres.
    pub const fn mm(millimetres: f64) -> Self {
        Length(millimetres / 1e3)
    }

    /// A length of so many centimetres.
    pub const fn cm(centimetres: f64) -> Self {
        Length(centimetres / 1e2)
    }

    /// In metres.
    pub const fn metres(self) -> f64 {
        self.0
    }
}

impl std::str::FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let fault = || {
            format!("\"{text}\" is not a length; write a number and a unit, like \"12 mm\" (mm, cm, m, in)")
        };
        let text = text.trim();
        let split = text.find(|c: char| c.is_ascii_alphabetic() && c != 'e' && c != 'E').ok_or_else(fault)?;
        let (number, unit) = text.split_at(split);
        let value: f64 = number.trim().parse().map_err(|_| fault())?;
        let metres = LENGTH_UNITS.iter().find(|(name, _)| *name == unit.trim()).ok_or_else(fault)?.1;
        match value.is_finite() {
            // Dividing by the whole number of units in a metre rounds once: 12 mm is 0.012 exactly.
            true if metres < 1.0 && unit.trim() != "in" => Ok(Length(value / (1.0 / metres).round())),
            true => Ok(Length(value * metres)),
            false => Err(fault()),
        }
    }
}

impl std::fmt::Display for Length {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let size = self.0.abs();
        match () {
            () if size == 0.0 || size >= 1.0 => write!(f, "{} m", self.0),
            () if size >= 0.1 => write!(f, "{} cm", tidy(self.0 * 1e2)),
            () => write!(f, "{} mm", tidy(self.0 * 1e3)),
        }
    }
}

/// Rounds off the last bits that a change of unit leaves.
fn tidy(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}

impl Serialize for Length {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&self.to_string())
    }
}

impl<'de> Deserialize<'de> for Length {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = Length;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a length with its unit, like \"12 mm\"")
            }
            fn visit_str<E: serde::de::Error>(self, v: &str) -> Result<Length, E> {
                v.parse().map_err(E::custom)
            }
            fn visit_f64<E: serde::de::Error>(self, v: f64) -> Result<Length, E> {
                Err(E::custom(format!("the length {v} has no unit; write \"{v} mm\" or \"{v} cm\"")))
            }
            fn visit_i64<E: serde::de::Error>(self, v: i64) -> Result<Length, E> {
                self.visit_f64(v as f64)
            }
            fn visit_u64<E: serde::de::Error>(self, v: u64) -> Result<Length, E> {
                self.visit_f64(v as f64)
            }
            fn visit_bool<E: serde::de::Error>(self, v: bool) -> Result<Length, E> {
                Err(E::invalid_type(Unexpected::Bool(v), &self))
            }
        }
        d.deserialize_any(Visitor)
    }
}

/// A type that may stand as a stage's parameter.
pub trait ParamType: Serialize + DeserializeOwned + Clone {
    /// The type in words, for cards: `number`, `length`, `Four | Eight`.
    fn describe() -> String;

    /// The numbers in the value (lengths in metres), which must be finite and in range.
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }
}

macro_rules! number_params {
    ($($t:ty => $words:literal),*) => {$(
        impl ParamType for $t {
            fn describe() -> String { $words.into() }
            fn numbers(&self) -> Vec<f64> { vec![*self as f64] }
        }
    )*};
}
number_params!(f64 => "number", f32 => "number", u8 => "whole number", u32 => "whole number", u64 => "whole number",
    usize => "whole number", i32 => "whole number", i64 => "whole number");

impl ParamType for Length {
    fn describe() -> String {
        "length".into()
    }
    fn numbers(&self) -> Vec<f64> {
        vec![self.0]
    }
}

impl ParamType for bool {
    fn describe() -> String {
        "true | false".into()
    }
}

impl ParamType for String {
    fn describe() -> String {
        "text".into()
    }
}

impl ParamType for crate::artifact::EdgeRef {
    fn describe() -> String {
        "panel.edge".into()
    }
}

impl<T: ParamType> ParamType for Option<T> {
    fn describe() -> String {
        format!("{} (or None)", T::describe())
    }
    fn numbers(&self) -> Vec<f64> {
        self.as_ref().map(T::numbers).unwrap_or_default()
    }
}

impl<T: ParamType> ParamType for Vec<T> {
    fn describe() -> String {
        format!("list of {}", T::describe())
    }
    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(T::numbers).collect()
    }
}

impl<A: ParamType, B: ParamType> ParamType for (A, B) {
    fn describe() -> String {
        format!("({}, {})", A::describe(), B::describe())
    }
    fn numbers(&self) -> Vec<f64> {
        [self.0.numbers(), self.1.numbers()].concat()
    }
}

impl<A: ParamType, B: ParamType, C: ParamType> ParamType for (A, B, C) {
    fn describe() -> String {
        format!("({}, {}, {})", A::describe(), B::describe(), C::describe())
    }
    fn numbers(&self) -> Vec<f64> {
        [self.0.numbers(), self.1.numbers(), self.2.numbers()].concat()
    }
}

impl<T: ParamType> ParamType for BTreeMap<String, T> {
    fn describe() -> String {
        format!("{{name: {}}}", T::describe())
    }
    fn numbers(&self) -> Vec<f64> {
        self.values().flat_map(T::numbers).collect()
    }
}

/// Which way a resolution is refined: the results of ever finer values come nearer to one limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finer {
    /// Less is finer: an edge length, a time step, a tolerance.
    Less,
    /// More is finer: a count of iterations.
    More,
}

impl Finer {
    /// In one word.
    pub fn as_str(self) -> &'static str {
        match self {
            Finer::Less => "less",
            Finer::More => "more",
        }
    }
}

/// One parameter of a stage: the single source of its RON form, checks, card and schema.
#[derive(Debug, Clone)]
pub struct ParamDoc {
    /// Field name.
    pub name: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// Its type in words.
    pub kind: String,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// Least value allowed (lengths in metres).
    pub min: Option<f64>,
    /// Greatest value allowed.
    pub max: Option<f64>,
    /// Default as RON text.
    pub default: String,
    /// True where it trades accuracy for time.
    pub trades: bool,
    /// Which way it is refined where it is a resolution; none where it is none.
    pub finer: Option<Finer>,
    /// Parses a RON text as this parameter's type and checks its numbers' range.
    pub check: Check,
}

/// How a parameter's text is checked: by its own type, or by the plugin that knows the type.
#[derive(Clone)]
pub struct Check(Arc<CheckFn>);

type CheckFn = dyn Fn(&str, &ParamDoc) -> Result<(), ParamFault> + Send + Sync;

impl Check {
    /// Checks by the type `T`.
    pub fn of<T: ParamType + 'static>() -> Self {
        Check(Arc::new(check_param::<T>))
    }

    /// Checks by a function.
    pub fn by(check: impl Fn(&str, &ParamDoc) -> Result<(), ParamFault> + Send + Sync + 'static) -> Self {
        Check(Arc::new(check))
    }

    /// Checks a text as the value of that parameter.
    pub fn run(&self, text: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
        (self.0)(text, doc)
    }
}

impl std::fmt::Debug for Check {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Check")
    }
}

impl ParamDoc {
    /// Its range in words, `1 mm to 100 mm`; `None` where it has none.
    pub fn range(&self) -> Option<String> {
        let show =
            |x: f64| if self.kind.contains("length") { Length::m(x).to_string() } else { x.to_string() };
        match (self.min, self.max) {
            (Some(lo), Some(hi)) => Some(format!("{} to {}", show(lo), show(hi))),
            (Some(lo), None) => Some(format!("at least {}", show(lo))),
            (None, Some(hi)) => Some(format!("at most {}", show(hi))),
            (None, None) => None,
        }
    }
}

/// Why a text is no value for a parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParamFault {
    /// The reason with the parameter's name, lower case.
    pub message: String,
    /// The reason alone, for a fault deep inside a value.
    pub reason: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Byte offset of the fault in the text, where the parser knows it.
    pub offset: Option<usize>,
}

/// The RON dialect of pipeline files.
pub fn ron_options() -> ron::Options {
    use ron::extensions::Extensions as E;
    ron::Options::default()
        .with_default_extension(E::IMPLICIT_SOME | E::UNWRAP_NEWTYPES | E::UNWRAP_VARIANT_NEWTYPES)
}

/// The check behind [`ParamDoc::check`] for a parameter of type `T`.
#[doc(hidden)]
pub fn check_param<T: ParamType>(text: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
    let value: T = ron_options().from_str(text).map_err(|e| type_fault(text, doc, &e))?;
    for x in value.numbers() {
        check_number(x, doc).map_err(|message| ParamFault {
            reason: message.clone(),
            message,
            hint: None,
            offset: None,
        })?;
    }
    Ok(())
}

/// Checks that every number of a value is finite and in range; used when a value is set from code.
pub(crate) fn check_number(x: f64, doc: &ParamDoc) -> Result<(), String> {
    let show = |v: f64| if doc.kind.contains("length") { Length(v).to_string() } else { v.to_string() };
    let unit = if doc.unit.is_empty() { String::new() } else { format!(" {}", doc.unit) };
    if !x.is_finite() {
        return Err(format!("`{}` is {x}, which is not a finite number", doc.name));
    }
    match (doc.min, doc.max) {
        (Some(lo), _) if x < lo => {
            Err(format!("`{}` is {}, below its least value {}{unit}", doc.name, show(x), show(lo)))
        }
        (_, Some(hi)) if x > hi => {
            Err(format!("`{}` is {}, above its greatest value {}{unit}", doc.name, show(x), show(hi)))
        }
        _ => Ok(()),
    }
}

/// A value as RON text, for cards and reports.
#[doc(hidden)]
pub fn ron_text<T: Serialize>(value: &T) -> String {
    let config = ron::ser::PrettyConfig::new().compact_arrays(true).compact_maps(true).compact_structs(true);
    ron_options().to_string_pretty(value, config).unwrap_or_default()
}

fn article(kind: &str) -> String {
    let plural = kind.contains('|') || kind.starts_with('{') || kind.starts_with('(');
    if plural || kind == "text" { kind.to_owned() } else { format!("a {kind}") }
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map(|c| c.to_lowercase().chain(chars).collect()).unwrap_or_default()
}

/// The fault of a text that is no value of the parameter's type.
fn type_fault(text: &str, doc: &ParamDoc, e: &ron::error::SpannedError) -> ParamFault {
    use ron::Error as E;
    let (reason, offset) = ron_fault(text, e);
    let (name, wants) = (doc.name, article(&doc.kind));
    let message = match &e.code {
        E::IntegerOutOfBounds => {
            let range = text.parse().ok().and_then(|x| check_number(x, doc).err());
            range.unwrap_or_else(|| format!("`{name}` wants {wants}: {reason}"))
        }
        // The type's own words name the value; those of the parser name what it wanted.
        E::Message(_) => format!("`{name}`: {reason}"),
        E::NoSuchStructField { .. } | E::DuplicateStructField { .. } => format!("{reason} in `{name}`"),
        E::InvalidValueForType { expected, found } => format!("`{name}` wants {expected}, found {found}"),
        code if expected(code).is_some() => {
            format!("`{name}` wants {wants}, found {}", found(text, offset, code))
        }
        _ => format!("`{name}` wants {wants}: {reason}"),
    };
    ParamFault { message, reason, hint: ron_hint(&e.code), offset }
}

/// What `ron` says is wrong, in lower case, and the byte of the text where it is.
pub(crate) fn ron_fault(text: &str, e: &ron::error::SpannedError) -> (String, Option<usize>) {
    use ron::Error as E;
    let at = byte_offset(text, &e.span.start);
    // ron points behind the name of a field that it does not want.
    let name_at = |name: &str| text.get(..byte_offset(text, &e.span.end)?)?.rfind(name).or(at);
    match &e.code {
        E::NoSuchStructField { found, .. } => (format!("unknown field `{found}`"), name_at(found)),
        E::DuplicateStructField { field, .. } => {
            (format!("the field `{field}` is given twice"), name_at(field))
        }
        E::MissingStructField { field, .. } => (format!("the field `{field}` is missing"), at),
        E::NoSuchEnumVariant { found, .. } => (format!("there is no choice `{found}`"), at),
        E::InvalidValueForType { expected, found } => (format!("expected {expected}, found {found}"), at),
        E::ExpectedDifferentLength { expected, found } => (length_words(expected, *found), at),
        code => match expected(code) {
            Some(words) => (format!("expected {words}, found {}", found(text, at, code)), at),
            None => (lower_first(&code.to_string()), at),
        },
    }
}

/// What the parser wanted, where it says no more than that.
fn expected(e: &ron::Error) -> Option<&'static str> {
    use ron::Error as E;
    match e {
        E::ExpectedInteger => Some("a whole number"),
        E::ExpectedFloat => Some("a number"),
        E::ExpectedBoolean => Some("`true` or `false`"),
        E::ExpectedString => Some("text in quotes"),
        E::ExpectedIdentifier | E::InvalidIdentifier(_) | E::SuggestRawIdentifier(_) => Some("a name"),
        E::ExpectedArray => Some("a list"),
        E::ExpectedMap => Some("a map"),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) => Some("`(...)`"),
        E::TrailingCharacters => Some("one value"),
        _ => None,
    }
}

/// `2 values, found 1`, out of serde's `tuple variant SeamLine::Match with 2 elements`.
fn length_words(expected: &str, found: usize) -> String {
    let wanted = expected.split(|c: char| !c.is_ascii_digit()).rfind(|s| !s.is_empty());
    wanted
        .map_or_else(|| format!("it holds {found} values"), |n| format!("it needs {n} values, found {found}"))
}

/// What stands there: a short piece of the text.
fn found(text: &str, at: Option<usize>, e: &ron::Error) -> String {
    let from = if matches!(e, ron::Error::TrailingCharacters) { 0 } else { at.unwrap_or(0) };
    let rest = text.get(from..).unwrap_or("");
    let word = match rest.chars().next() {
        Some('"') => rest[1..].find('"').map_or(rest, |end| &rest[..end + 2]),
        Some('(') => "(...)",
        Some('[') => "[...]",
        Some('{') => "{...}",
        _ => rest.split([',', ')', ']', '}', '\n']).next().unwrap_or("").trim(),
    };
    match word.char_indices().nth(MAX_SHOWN) {
        _ if word.is_empty() => "nothing".into(),
        Some((end, _)) => format!("`{}...`", &word[..end]),
        None => format!("`{word}`"),
    }
}

/// The longest piece of a file that a message repeats, characters.
const MAX_SHOWN: usize = 24;

/// The nearest name, and all of them, where the fault is a name.
fn ron_hint(e: &ron::Error) -> Option<String> {
    match e {
        ron::Error::NoSuchEnumVariant { expected, found, .. } => near::hint(found, "there is", expected),
        ron::Error::NoSuchStructField { expected, found, .. } => near::hint(found, "there is", expected),
        _ => None,
    }
}

/// The byte at a line and column that ron reports (both from 1, columns in characters).
pub(crate) fn byte_offset(text: &str, at: &ron::error::Position) -> Option<usize> {
    let start: usize = text.split_inclusive('\n').take(at.line.checked_sub(1)?).map(str::len).sum();
    let line = text.get(start..)?;
    Some(line.char_indices().nth(at.col.checked_sub(1)?).map_or(text.len(), |(i, _)| start + i))
}
