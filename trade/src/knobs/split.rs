//! Cuts a RON text at commas outside of brackets and quotes.

/// The parts of `text` between commas at its top level, trimmed; empty parts are left out.
pub(crate) fn at_commas(text: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quoted, mut escaped) = (Vec::new(), 0, 0_i32, false, false);
    for (i, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' if quoted => escaped = true,
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&text[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts.into_iter().map(str::trim).filter(|p| !p.is_empty()).collect()
}

/// The value of the field `name` in a stage's canonical parameters,
/// `(edge: "12 mm", least_angle: 28.0)`.
pub(crate) fn field<'a>(params: &'a str, name: &str) -> Option<&'a str> {
    let inside = params.trim().strip_prefix('(')?.strip_suffix(')')?;
    let named = |part: &&'a str| part.split_once(':').is_some_and(|(key, _)| key.trim() == name);
    at_commas(inside).into_iter().find(named)?.split_once(':').map(|(_, value)| value.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_in_brackets_and_quotes_do_not_count() {
        assert_eq!(
            at_commas("Aabb, KDop(14, 2),\"a,b\\\",c\", [1,2],"),
            ["Aabb", "KDop(14, 2)", "\"a,b\\\",c\"", "[1,2]"]
        );
    }

    #[test]
    fn a_field_is_found_by_its_name() {
        let params = "(edge: \"12 mm\", volume: KDop(14), least: (a: 1, edge: 3))";
        assert_eq!(field(params, "edge"), Some("\"12 mm\""));
        assert_eq!(field(params, "volume"), Some("KDop(14)"));
        assert_eq!(field(params, "a"), None);
        assert_eq!(field("", "a"), None);
    }
}
