//! Sizes of the trade: the measures that go with a letter or an EU number.
//!
//! Girths by EN 13402-3 (2017), middles of the ranges; that standard gives no hip for men, which is
//! taken as the chest's and 3 cm, and letters stand for its ranges of 8 cm up to L, 12 cm above.
//! Heights are the means of EN 13402-3: women 168 cm, men 178 cm. Children's sizes are their
//! heights; girths by EN 13402-3 and ISO 3637 (1977), interpolated. EU numbers as the trade uses
//! them: women's 38 is a bust of 88 cm, men's is half the chest.

use crate::wearer::Wearer;

/// Height, bust, waist and hip, centimetres.
pub(crate) type SizeRow = [f64; 4];

/// Bust, waist and hip of women, centimetres, by EU number.
const WOMEN: [(u32, [f64; 3]); 12] = [
    (32, [76.0, 60.0, 84.0]),
    (34, [80.0, 64.0, 88.0]),
    (36, [84.0, 68.0, 92.0]),
    (38, [88.0, 72.0, 96.0]),
    (40, [92.0, 76.0, 100.0]),
    (42, [96.0, 80.0, 104.0]),
    (44, [100.0, 84.0, 108.0]),
    (46, [104.0, 88.0, 112.0]),
    (48, [110.0, 94.0, 117.0]),
    (50, [116.0, 100.0, 122.0]),
    (52, [122.0, 106.0, 127.0]),
    (54, [128.0, 112.0, 132.0]),
];

/// Chest, waist and hip of men, centimetres, by EU number.
const MEN: [(u32, [f64; 3]); 11] = [
    (44, [88.0, 76.0, 91.0]),
    (46, [92.0, 80.0, 95.0]),
    (48, [96.0, 84.0, 99.0]),
    (50, [100.0, 88.0, 103.0]),
    (52, [104.0, 92.0, 107.0]),
    (54, [108.0, 96.0, 111.0]),
    (56, [112.0, 100.0, 115.0]),
    (58, [116.0, 104.0, 119.0]),
    (60, [120.0, 108.0, 123.0]),
    (62, [124.0, 112.0, 127.0]),
    (64, [128.0, 116.0, 131.0]),
];

/// Chest, waist and hip of children, centimetres, by height.
const CHILDREN: [(u32, [f64; 3]); 12] = [
    (86, [51.0, 49.0, 52.0]),
    (92, [53.0, 50.0, 54.0]),
    (98, [55.0, 51.0, 56.0]),
    (104, [56.0, 52.0, 58.0]),
    (110, [57.0, 53.0, 60.0]),
    (116, [59.0, 54.0, 62.0]),
    (122, [61.0, 56.0, 65.0]),
    (128, [64.0, 58.0, 68.0]),
    (134, [67.0, 60.0, 72.0]),
    (140, [70.0, 62.0, 75.0]),
    (146, [73.0, 64.0, 78.0]),
    (152, [76.0, 66.0, 82.0]),
];

/// Letters with the EU numbers at the middle of their ranges, women's and men's.
const LETTERS: [(&str, u32, u32); 6] =
    [("XS", 34, 44), ("S", 36, 46), ("M", 38, 50), ("L", 42, 54), ("XL", 46, 58), ("XXL", 50, 62)];

/// Mean heights of women and men, centimetres.
const HEIGHTS: [f64; 2] = [168.0, 178.0];

/// The measures of a size such as `M` or `EU 38`; of a child where no figure is stated and the
/// number is a child's. `None` where there is no such size.
pub(crate) fn measures(size: &str, wearer: Option<Wearer>) -> Option<(Wearer, SizeRow)> {
    let text = size.trim().to_uppercase();
    let number = |women: bool| {
        let letter = LETTERS.iter().find(|l| l.0 == text).map(|l| if women { l.1 } else { l.2 });
        letter.or_else(|| text.strip_prefix("EU")?.trim().parse().ok())
    };
    let row = |table: &[(u32, [f64; 3])], n: u32| table.iter().find(|r| r.0 == n).map(|r| r.1);
    let found = |wearer: Wearer| {
        let n = number(wearer != Wearer::Man)?;
        let ([bust, waist, hip], height) = match wearer {
            Wearer::Woman => (row(&WOMEN, n)?, HEIGHTS[0]),
            Wearer::Man => (row(&MEN, n)?, HEIGHTS[1]),
            Wearer::Child => (row(&CHILDREN, n)?, f64::from(n)),
        };
        Some((wearer, [height, bust, waist, hip]))
    };
    match wearer {
        Some(wearer) => found(wearer),
        None => found(Wearer::Woman).or_else(|| found(Wearer::Child)),
    }
}

/// Height, bust, waist and hip of a child of that height, centimetres; beyond the table its ends go
/// on as they run.
pub(crate) fn of_child(height: f64) -> SizeRow {
    let last = CHILDREN.len() - 2;
    let k = CHILDREN.iter().filter(|row| f64::from(row.0) <= height).count().saturating_sub(1).min(last);
    let ((low, from), (high, to)) = (CHILDREN[k], CHILDREN[k + 1]);
    let share = (height - f64::from(low)) / f64::from(high - low);
    let [bust, waist, hip] = [0, 1, 2].map(|i: usize| from[i] + share * (to[i] - from[i]));
    [height, bust, waist, hip]
}

/// The sizes that there are, in words.
pub(crate) fn known(wearer: Option<Wearer>) -> &'static str {
    match wearer {
        None => "XS, S, M, L, XL, XXL, EU 32 to EU 54, or a child's EU 86 to EU 152",
        Some(Wearer::Woman) => "XS, S, M, L, XL, XXL, or EU 32 to EU 54",
        Some(Wearer::Man) => "XS, S, M, L, XL, XXL, or EU 44 to EU 64",
        Some(Wearer::Child) => "EU 86 to EU 152, which is the height in centimetres",
    }
}

/// The names of all sizes that a figure comes in, as `Mannequin(size: ...)` takes them: letters
/// first, then EU numbers; where no figure is stated a woman's, then a child's.
pub fn size_names(wearer: Option<Wearer>) -> Vec<String> {
    let eu = |table: &[(u32, [f64; 3])]| table.iter().map(|row| format!("EU {}", row.0)).collect::<Vec<_>>();
    let letters = || LETTERS.iter().map(|l| l.0.to_owned()).collect::<Vec<_>>();
    match wearer {
        None => [letters(), eu(&WOMEN), eu(&CHILDREN)].concat(),
        Some(Wearer::Woman) => [letters(), eu(&WOMEN)].concat(),
        Some(Wearer::Man) => [letters(), eu(&MEN)].concat(),
        Some(Wearer::Child) => eu(&CHILDREN),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn every_name_of_a_size_is_one() {
        for wearer in [None, Some(Wearer::Woman), Some(Wearer::Man), Some(Wearer::Child)] {
            let names = size_names(wearer);
            assert!(names.iter().all(|name| measures(name, wearer).is_some()), "{names:?}");
        }
        assert_eq!(size_names(Some(Wearer::Man))[5..8], ["XXL", "EU 44", "EU 46"]);
        assert_eq!((size_names(None).len(), size_names(Some(Wearer::Child)).len()), (30, 12));
    }

    #[test]
    fn a_childs_girths_follow_its_height() {
        assert_eq!(of_child(134.0), [134.0, 67.0, 60.0, 72.0]);
        assert_eq!(of_child(107.0), [107.0, 56.5, 52.5, 59.0]);
        // As from 86 to 92 cm, and from 146 to 152.
        assert_eq!(of_child(80.0), [80.0, 49.0, 48.0, 50.0]);
        assert_eq!(of_child(158.0), [158.0, 79.0, 68.0, 86.0]);
    }

    #[test]
    fn letters_and_numbers_are_found_for_each_figure() {
        assert_eq!(measures("M", None).unwrap(), (Wearer::Woman, [168.0, 88.0, 72.0, 96.0]));
        assert_eq!(measures("eu 38", Some(Wearer::Woman)), measures("M", Some(Wearer::Woman)));
        assert_eq!(measures("M", Some(Wearer::Man)).unwrap().1, [178.0, 100.0, 88.0, 103.0]);
        assert_eq!(measures("EU110", None).unwrap(), (Wearer::Child, [110.0, 57.0, 53.0, 60.0]));
        assert_eq!(measures("M", Some(Wearer::Child)), None);
        assert_eq!(measures("EU 37", None), None);
    }
}
