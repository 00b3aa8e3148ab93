//! Whole numbers in few bytes while they are small.

/// Adds a number with its sign in the lowest bit (zigzag), seven bits a byte, low bits first
/// (LEB128).
pub(super) fn push(bytes: &mut Vec<u8>, number: i64) {
    let mut z = ((number << 1) ^ (number >> 63)) as u64;
    while z > 127 {
        bytes.push((z & 127) as u8 | 128);
        z >>= 7;
    }
    bytes.push(z as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_take_a_byte_and_any_number_is_taken() {
        let of = |n| {
            let mut bytes = Vec::new();
            push(&mut bytes, n);
            bytes
        };
        assert_eq!((of(0), of(-1), of(1), of(63)), (vec![0], vec![1], vec![2], vec![126]));
        assert_eq!(of(200), [0x90, 3]);
        assert_eq!((of(i64::MAX).len(), of(i64::MIN).len()), (10, 10));
    }
}
