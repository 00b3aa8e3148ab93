//! Types that may stand as a stage's parameter.

use super::Length;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

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
        vec![self.metres()]
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
