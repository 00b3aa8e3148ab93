//! Names that were probably meant.
//!
//! Distance is the number of letters changed, left out, put in or swapped with their neighbour
//! (optimal string alignment, Wagner and Fischer 1974 with Damerau's swap), blind to case.
//! Cost: the product of both lengths. Names longer than [`MAX_NAME`] are not compared.

/// Names longer than this are no misspelling of anything; bounds the work on hostile files.
const MAX_NAME: usize = 64;

/// Lists of names up to this length are printed whole.
const SHORT_LIST: usize = 12;

/// The candidate nearest to `name`, where one is near enough to be a misspelling of it.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = name.chars().count();
    if length > MAX_NAME {
        return None;
    }
    let limit = (length / 3).clamp(1, 3);
    let scored =
        candidates.into_iter().filter(|c| c.chars().count() <= MAX_NAME).map(|c| (distance(name, c), c));
    scored.filter(|(d, c)| *d <= limit && *d < c.chars().count()).min().map(|(_, c)| c)
}

/// ``did you mean `Otsu`?`` where a candidate is near, and all names where they are few.
pub fn hint(name: &str, known: &str, candidates: &[&str]) -> Option<String> {
    let near = nearest(name, candidates.iter().copied()).map(|n| format!("did you mean `{n}`?"));
    let list = (!candidates.is_empty() && candidates.len() <= SHORT_LIST && !known.is_empty())
        .then(|| format!("{known} {}", quoted(candidates)));
    match (near, list) {
        (Some(near), Some(list)) if candidates.len() > 1 => Some(format!("{near} {list}")),
        (near, list) => near.or(list),
    }
}

/// `` `a`, `b` ``
pub fn quoted(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

fn distance(a: &str, b: &str) -> usize {
    let fold = |s: &str| s.chars().flat_map(char::to_lowercase).collect::<Vec<_>>();
    let (a, b) = (fold(a), fold(b));
    let mut rows = [vec![0; b.len() + 1], (0..=b.len()).collect::<Vec<_>>(), vec![0; b.len() + 1]];
    for i in 1..=a.len() {
        // rows: two before, one before, this one
        rows[2][0] = i;
        for j in 1..=b.len() {
            let change = rows[1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            let swap = if swapped { rows[0][j - 2] + 1 } else { usize::MAX };
            rows[2][j] = change.min(rows[1][j] + 1).min(rows[2][j - 1] + 1).min(swap);
        }
        rows.rotate_left(1);
    }
    rows[1][b.len()]
}

#[cfg(test)]
mod tests {
    use super::{distance, nearest};

    #[test]
    fn a_letter_changed_left_out_put_in_or_swapped_costs_one() {
        for near in ["Otzu", "Osu", "Ottsu", "Ostu"] {
            assert_eq!(distance(near, "Otsu"), 1, "{near}");
        }
        assert_eq!(distance("otsu", "OTSU"), 0);
        assert_eq!(distance("", "Otsu"), 4);
    }

    #[test]
    fn only_a_misspelling_is_near() {
        assert_eq!(nearest("Cany", ["Otsu", "Canny"]), Some("Canny"));
        assert_eq!(nearest("Sobel", ["Otsu", "Canny"]), None);
        assert_eq!(nearest("x", ["y"]), None);
        assert_eq!(nearest(&"a".repeat(1000), ["a"]), None);
    }
}
