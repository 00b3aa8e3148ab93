//! Lengths with their unit.

use serde::de::Unexpected;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

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
