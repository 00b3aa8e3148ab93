//! From RON text to a stage with its parameters.
//!
//! typetag asks its deserializer for a map of one entry, `{"Otsu": (bias: 3)}`. Pipeline files
//! say `Otsu(bias: 3)`, which is an enum to `ron`; the adapter shows that enum as the map.

use crate::Stage;
use crate::param::ron_options;
use serde::de::{self, DeserializeSeed, Deserializer, EnumAccess, MapAccess, VariantAccess, Visitor, value};
use serde::{Deserialize, forward_to_deserialize_any};
use std::fmt;

/// Makes the stage that `text` writes: `Otsu(bias: 3)`.
pub(crate) fn stage(text: &str) -> Result<Box<dyn Stage>, String> {
    struct Any(Box<dyn Stage>);
    impl<'de> Deserialize<'de> for Any {
        fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
            Box::<dyn Stage>::deserialize(EnumAsMap(d)).map(Any)
        }
    }
    ron_options().from_str::<Any>(text).map(|any| any.0).map_err(|e| e.code.to_string())
}

struct EnumAsMap<D>(D);

impl<'de, D: Deserializer<'de>> Deserializer<'de> for EnumAsMap<D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_enum("Stage", &[], EnumVisitor(visitor))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }

    fn is_human_readable(&self) -> bool {
        self.0.is_human_readable()
    }
}

struct EnumVisitor<V>(V);

impl<'de, V: Visitor<'de>> Visitor<'de> for EnumVisitor<V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a stage, like `Name(field: value)`")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<V::Value, A::Error> {
        self.0.visit_map(OneEntry::Key(access))
    }
}

/// The enum as a map: its variant is the key.
enum OneEntry<A, B> {
    Key(A),
    Value(B),
    Done,
}

impl<'de, A, B> MapAccess<'de> for OneEntry<A, B>
where
    A: EnumAccess<'de, Variant = B>,
    B: VariantAccess<'de, Error = A::Error>,
{
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        let OneEntry::Key(access) = std::mem::replace(self, OneEntry::Done) else { return Ok(None) };
        // ron hands a bare name out only as an identifier; typetag asks for a text.
        let (name, variant) = access.variant_seed(Identifier)?;
        *self = OneEntry::Value(variant);
        seed.deserialize(value::StrDeserializer::new(&name)).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, A::Error> {
        match std::mem::replace(self, OneEntry::Done) {
            OneEntry::Value(variant) => variant.newtype_variant_seed(seed),
            _ => Err(de::Error::custom("value read before its key")),
        }
    }
}

struct Identifier;

impl<'de> DeserializeSeed<'de> for Identifier {
    type Value = String;

    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<String, D::Error> {
        d.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Identifier {
    type Value = String;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a stage's name")
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<String, E> {
        Ok(name.to_owned())
    }
}
