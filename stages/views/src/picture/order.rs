//! The order of named photos: numbers in their names count as numbers, so that `10` follows `9`.

use std::cmp::Ordering;

/// The names in that order.
pub fn in_order<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_by(|a, b| compare(a, b).then_with(|| a.cmp(b)));
    names
}

fn compare(mut a: &str, mut b: &str) -> Ordering {
    loop {
        let (na, nb) = (digits(a), digits(b));
        let order = match (na.len(), nb.len()) {
            (0, _) | (_, 0) => match (a.chars().next(), b.chars().next()) {
                (None, None) => return Ordering::Equal,
                (x, y) if x != y => return x.cmp(&y),
                (Some(c), _) => {
                    (a, b) = (&a[c.len_utf8()..], &b[c.len_utf8()..]);
                    continue;
                }
                (None, _) => return Ordering::Less,
            },
            _ => number(na, nb),
        };
        if order != Ordering::Equal {
            return order;
        }
        (a, b) = (&a[na.len()..], &b[nb.len()..]);
    }
}

/// The digits at the beginning.
fn digits(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    &text[..end]
}

/// Numbers of any length.
fn number(a: &str, b: &str) -> Ordering {
    let (a, b) = (a.trim_start_matches('0'), b.trim_start_matches('0'));
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_count_as_numbers() {
        assert_eq!(in_order(["10", "9", "1", "02"]), ["1", "02", "9", "10"]);
        assert_eq!(in_order(["b2", "a10", "a9", "b"]), ["a9", "a10", "b", "b2"]);
        assert_eq!(in_order(["é1", "", "é"]), ["", "é", "é1"]);
        assert_eq!(in_order(["01", "1", "001"]), ["001", "01", "1"]);
    }
}
