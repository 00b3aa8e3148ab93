//! Numbers as arguments.

/// A time in seconds, above zero and at most a week.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds <= 604_800.0 => Ok(seconds),
        _ => Err(format!("`{text}` is no time; write seconds above 0, like 10")),
    }
}

/// A share of one, above zero.
pub(super) fn share(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(share) if share > 0.0 && share <= 1.0 => Ok(share),
        _ => Err(format!("`{text}` is no share; write a number above 0 and at most 1, like 0.001")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_above_zero_and_at_most_one() {
        assert_eq!(share("0.001"), Ok(0.001));
        for wrong in ["0", "-1", "1.5", "NaN", "1 mm", ""] {
            let words = format!("`{wrong}` is no share; write a number above 0 and at most 1, like 0.001");
            assert_eq!(share(wrong), Err(words));
        }
    }

    #[test]
    fn times_are_seconds_above_zero() {
        assert_eq!(seconds("0.02"), Ok(0.02));
        for wrong in ["0", "-1", "3s", "NaN", "inf", ""] {
            assert_eq!(seconds(wrong), Err(format!("`{wrong}` is no time; write seconds above 0, like 10")));
        }
    }
}
