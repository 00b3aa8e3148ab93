//! The dialect of pipeline files.

use serde::Serialize;

/// The RON dialect of pipeline files.
pub fn ron_options() -> ron::Options {
    use ron::extensions::Extensions as E;
    ron::Options::default()
        .with_default_extension(E::IMPLICIT_SOME | E::UNWRAP_NEWTYPES | E::UNWRAP_VARIANT_NEWTYPES)
}

/// A value as RON text, for cards and reports.
#[doc(hidden)]
pub fn ron_text<T: Serialize>(value: &T) -> String {
    let config = ron::ser::PrettyConfig::new().compact_arrays(true).compact_maps(true).compact_structs(true);
    ron_options().to_string_pretty(value, config).unwrap_or_default()
}
