//! Rounds numbers to so many digits, so that they are readable and nearly equal ones become equal.

/// A number to so many significant digits, at least one.
pub fn to_digits(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_count_from_the_first_that_is_not_zero() {
        assert_eq!(
            [to_digits(0.012_345, 3), to_digits(12_345.6, 3), to_digits(-9.996, 3)],
            [0.0123, 12_300.0, -10.0]
        );
        assert_eq!([to_digits(0.0, 3), to_digits(f64::INFINITY, 3)], [0.0, f64::INFINITY]);
        assert!(to_digits(f64::NAN, 3).is_nan());
    }
}
