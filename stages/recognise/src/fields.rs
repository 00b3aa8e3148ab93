//! The fields of a file of Protocol Buffers, looked at before the runtime reads it.
//!
//! The runtime (rten 0.27) skips a field by moving on by its length as a signed number. A length of
//! 2^63 or more moves it back, and it then reads the same field for ever. Within a field it knows
//! where the field ends.

/// Whether the runtime would move forward over every outermost field. What cannot be read is left
/// to the runtime, which refuses it.
pub(crate) fn skips_forward(mut bytes: &[u8]) -> bool {
    while let Some((key, rest)) = number(bytes) {
        let skipped = match key % 8 {
            0 => number(rest).map(|(_, rest)| rest),
            1 => rest.get(8..),
            2 => match number(rest) {
                Some((length, _)) if i64::try_from(length).is_err() => return false,
                Some((length, rest)) => usize::try_from(length).ok().and_then(|n| rest.get(n..)),
                None => None,
            },
            5 => rest.get(4..),
            _ => None,
        };
        let Some(rest) = skipped else { return true };
        bytes = rest;
    }
    true
}

/// A number of variable length, and what follows it.
fn number(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let end = bytes.iter().take(10).position(|b| b & 0x80 == 0)?;
    let value = bytes[..=end].iter().rev().fold(0u64, |value, b| value << 7 | u64::from(b & 0x7f));
    Some((value, &bytes[end + 1..]))
}
