//! Groups of parameters: what several stages share, as if each had it for its own.
//!
//! A struct under `#[params]` is a group. A stage takes it as one field,
//! `#[param(flatten)] care: Care`; in pipeline files, on its card and in every check the group's
//! parameters stand among the stage's own, in the place of that field.

use super::ParamDoc;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use serde::ser::{SerializeStruct, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// A struct of parameters, those of its groups among them. `#[params]` and `#[stage]` derive it.
pub trait Params: Default {
    /// The parameters' names, in the order in which they are written.
    const NAMES: &'static [&'static str];
    /// Their table, with the values of `self` as defaults.
    fn docs(&self) -> Vec<ParamDoc>;
    /// Reads the value of the parameter `name` from the map; false where there is none of that
    /// name.
    fn read<'de, M: MapAccess<'de>>(&mut self, name: &str, map: &mut M) -> Result<bool, M::Error>;
    /// Writes all of them.
    fn write<S: SerializeStruct>(&self, out: &mut S) -> Result<(), S::Error>;
}

/// Reads a stage's parameters; those that are not given have their defaults.
#[doc(hidden)]
pub fn read<'de, T: Params, D: Deserializer<'de>>(stage: &'static str, d: D) -> Result<T, D::Error> {
    d.deserialize_struct(stage, T::NAMES, GroupVisitor(stage, PhantomData))
}

/// Writes a stage's parameters.
#[doc(hidden)]
pub fn write<T: Params, S: Serializer>(params: &T, stage: &'static str, s: S) -> Result<S::Ok, S::Error> {
    let mut out = s.serialize_struct(stage, T::NAMES.len())?;
    params.write(&mut out)?;
    out.end()
}

/// The names of all parts, one after the other, where `N` are there; no two may be alike.
#[doc(hidden)]
pub const fn joined<const N: usize>(parts: &[&[&'static str]]) -> [&'static str; N] {
    let (mut all, mut count, mut part) = ([""; N], 0, 0);
    while part < parts.len() {
        let mut k = 0;
        while k < parts[part].len() {
            all[count] = parts[part][k];
            let mut before = 0;
            while before < count {
                assert!(!alike(all[before], all[count]), "two parameters of a stage have one name");
                before += 1;
            }
            (count, k) = (count + 1, k + 1);
        }
        part += 1;
    }
    all
}

/// How many names all parts have.
#[doc(hidden)]
pub const fn count(parts: &[&[&'static str]]) -> usize {
    let (mut sum, mut part) = (0, 0);
    while part < parts.len() {
        (sum, part) = (sum + parts[part].len(), part + 1);
    }
    sum
}

const fn alike(a: &str, b: &str) -> bool {
    let (a, b, mut k) = (a.as_bytes(), b.as_bytes(), 0);
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}

struct GroupVisitor<T>(&'static str, PhantomData<T>);

impl<'de, T: Params> Visitor<'de> for GroupVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "struct {}", self.0)
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<T, M::Error> {
        let (mut params, mut given) = (T::default(), Vec::new());
        while let Some(name) = map.next_key_seed(NameVisitor(T::NAMES))? {
            if given.contains(&name) {
                return Err(M::Error::duplicate_field(name));
            }
            given.push(name);
            if !params.read(name, &mut map)? {
                return Err(M::Error::unknown_field(name, T::NAMES));
            }
        }
        Ok(params)
    }
}

/// One of these names.
struct NameVisitor(&'static [&'static str]);

impl<'de> DeserializeSeed<'de> for NameVisitor {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<&'static str, D::Error> {
        d.deserialize_identifier(self)
    }
}

impl Visitor<'_> for NameVisitor {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("field identifier")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<&'static str, E> {
        let known = self.0.iter().find(|known| **known == name);
        known.copied().ok_or_else(|| E::unknown_field(name, self.0))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::param::{ron_options, ron_text};
    use crate::prelude::*;

    /// What two stages share.
    #[params]
    #[derive(Copy)]
    struct Finish {
        /// How straight.
        #[param(default = 0.5, min = 0.0, max = 1.0)]
        straight: f64,
        /// Whether it is mirrored.
        #[param(default = true)]
        mirror: bool,
    }

    /// A stage with a group between parameters of its own.
    #[stage(role = Smoother)]
    struct Grouped {
        /// The first.
        #[param(default = 3, min = 1)]
        rounds: u32,
        #[param(flatten)]
        finish: Finish,
        /// The last.
        #[param(default = Length::mm(2.0))]
        reach: Length,
    }

    #[stage]
    impl Grouped {
        fn run(&self, panel: &Panel, _cx: &Context) -> Result<Panel, StageError> {
            Ok(panel.clone())
        }
    }

    /// The same parameters without a group.
    #[stage(role = Smoother)]
    struct Plain {
        /// The first.
        #[param(default = 3, min = 1)]
        rounds: u32,
        /// How straight.
        #[param(default = 0.5, min = 0.0, max = 1.0)]
        straight: f64,
        /// Whether it is mirrored.
        #[param(default = true)]
        mirror: bool,
        /// The last.
        #[param(default = Length::mm(2.0))]
        reach: Length,
    }

    fn read<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, String> {
        ron_options().from_str(text).map_err(|e| e.to_string().replace("Plain", "Grouped"))
    }

    #[test]
    fn a_groups_parameters_stand_among_the_stages_own() {
        let card = Grouped::type_card();
        let rows: Vec<_> = card.params.iter().map(|p| (p.name, p.default.as_str(), p.max)).collect();
        let expected = [
            ("rounds", "3", None),
            ("straight", "0.5", Some(1.0)),
            ("mirror", "true", None),
            ("reach", "\"2 mm\"", None),
        ];
        assert_eq!(rows, expected);
        let stage: Grouped = read("(mirror: false, rounds: 7)").unwrap();
        assert_eq!((stage.rounds, stage.finish), (7, Finish { straight: 0.5, mirror: false }));
        let text = ron_text(&stage);
        assert_eq!(text, "(rounds: 7, straight: 0.5, mirror: false, reach: \"2 mm\")");
        assert_eq!(read::<Grouped>(&text).unwrap(), stage);
        assert_eq!(ron_text(&read::<Plain>(&text).unwrap()), text);
        assert_eq!(read::<Grouped>("()").unwrap(), Grouped::default());
    }

    #[test]
    fn what_is_wrong_is_told_at_its_place_as_without_a_group() {
        let wrong = [
            "(strait: 0.1)",
            "(mirror: true, mirror: false)",
            "(mirror: 3)",
            "(straight: x)",
            "(rounds: -1)",
            "7",
        ];
        for text in wrong {
            let told = read::<Grouped>(text).unwrap_err();
            assert_eq!(told, read::<Plain>(text).unwrap_err());
        }
        let unknown = read::<Grouped>("(strait: 0.1)").unwrap_err();
        assert!(unknown.contains("`rounds`, `straight`, `mirror`, or `reach`"), "{unknown}");
    }
}
