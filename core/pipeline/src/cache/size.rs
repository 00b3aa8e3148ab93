//! Sizes as people write them: `"500 MB"`, `"2 GB"`, `"64 MiB"`.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// Units and their bytes, the greater first.
const UNITS: [(&str, u64); 8] = [
    ("TB", 1_000_000_000_000),
    ("GB", 1_000_000_000),
    ("MB", 1_000_000),
    ("kB", 1000),
    ("GiB", 1 << 30),
    ("MiB", 1 << 20),
    ("KiB", 1 << 10),
    ("B", 1),
];

/// A number of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bytes(pub u64);

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let fault = || {
            format!(
                "\"{text}\" is not a size; write a number and a unit, like \"500 MB\" (B, kB, MB, GB, TB, KiB, MiB, GiB)"
            )
        };
        let bare = text.trim();
        let split = bare.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(bare.len());
        let (number, unit) = bare.split_at(split);
        let value: f64 = number.trim().parse().map_err(|_| fault())?;
        let known = UNITS.iter().find(|(name, _)| name.eq_ignore_ascii_case(unit));
        let scale = match (known, unit) {
            (Some((_, scale)), _) => *scale,
            // Nothing is nothing in any unit.
            (None, "") if value == 0.0 => 1,
            _ => return Err(fault()),
        };
        let bytes = value * scale as f64;
        if bytes.is_finite() && (0.0..1e18).contains(&bytes) {
            Ok(Bytes(bytes.round() as u64))
        } else {
            Err(fault())
        }
    }
}

impl Display for Bytes {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match UNITS.iter().take(4).find(|(_, scale)| self.0 >= *scale) {
            Some((name, scale)) => write!(f, "{:.1} {name}", self.0 as f64 / *scale as f64),
            None => write!(f, "{} B", self.0),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::Bytes;

    #[test]
    fn a_size_has_a_unit_of_any_case_and_zero_needs_none() {
        for (text, bytes) in
            [("500 MB", 500_000_000), ("1.5gb", 1_500_000_000), ("0", 0), ("2 KiB", 2048), (" 7 B ", 7)]
        {
            assert_eq!(text.parse::<Bytes>().unwrap(), Bytes(bytes), "{text}");
        }
    }

    #[test]
    fn what_is_no_size_is_refused_in_words() {
        for text in ["", "500", "MB", "-1 MB", "1 XB", "nan MB", "1e30 TB"] {
            let words = format!(
                "\"{text}\" is not a size; write a number and a unit, like \"500 MB\" (B, kB, MB, GB, TB, KiB, MiB, GiB)"
            );
            assert_eq!(text.parse::<Bytes>().unwrap_err(), words);
        }
    }

    #[test]
    fn a_size_is_shown_in_its_unit() {
        assert_eq!(
            [999, 1000, 1_234_567, 2_000_000_000].map(|b| Bytes(b).to_string()),
            ["999 B", "1.0 kB", "1.2 MB", "2.0 GB"]
        );
    }
}
