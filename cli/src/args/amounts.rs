//! Times and lengths as arguments.

use std::time::Duration;
use toile_core::Length;

/// `90s`, `800ms`, `5m`, `1h`.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let fault = || format!("`{text}` is no time; write a number and a unit, like 90s (ms, s, m, h)");
    let text = text.trim();
    let split = text.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(fault)?;
    let (number, unit) = text.split_at(split);
    let seconds = match unit {
        "ms" => 1e-3,
        "s" => 1.0,
        "m" => 60.0,
        "h" => 3600.0,
        _ => return Err(fault()),
    };
    let seconds = number.trim().parse::<f64>().map_err(|_| fault())? * seconds;
    // A week is more than anybody means.
    let is_sound = seconds > 0.0 && seconds < 604_800.0;
    if is_sound { Ok(Duration::from_secs_f64(seconds)) } else { Err(fault()) }
}

/// A length with its unit.
pub(crate) fn length(text: &str) -> Result<Length, String> {
    let length: Length = text.parse()?;
    if length.metres() > 0.0 { Ok(length) } else { Err(format!("`{text}` is not above zero")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_carry_their_unit() {
        assert_eq!(duration("90s"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("1.5 m"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("800ms"), Ok(Duration::from_millis(800)));
        for wrong in ["5", "-1s", "s", "1d", "1e9h", "NaNs"] {
            let words = format!("`{wrong}` is no time; write a number and a unit, like 90s (ms, s, m, h)");
            assert_eq!(duration(wrong), Err(words));
        }
        assert_eq!(length("0 mm"), Err("`0 mm` is not above zero".into()));
    }
}
