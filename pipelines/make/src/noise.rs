//! Repeatable randomness: a hash of lattice coordinates and value noise over it.
//!
//! No state and no clock, so that every pixel can be drawn on any thread and the pictures are the
//! same on every run.

/// SplitMix64's finaliser (Steele, Lea and Flood, 2014).
fn scramble(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number in 0..1 for a lattice point.
pub(crate) fn hash(seed: u64, x: i64, y: i64) -> f64 {
    let key = seed
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add((x as u64).wrapping_mul(0xD1B5_4A32_D192_ED03))
        .wrapping_add((y as u64).wrapping_mul(0xABC9_8388_FB8F_AC03));
    (scramble(key) >> 11) as f64 / (1u64 << 53) as f64
}

/// A nearly Gaussian number with mean 0 and variance 1 (sum of four uniforms).
pub(crate) fn gauss(seed: u64, x: i64, y: i64) -> f64 {
    let sum: f64 = (0..4).map(|k| hash(seed.wrapping_add(k * 7919), x, y)).sum();
    (sum - 2.0) * 3f64.sqrt()
}

/// Smooth value noise in -1..1, one lattice cell a unit.
pub(crate) fn value(seed: u64, x: f64, y: f64) -> f64 {
    let (ix, iy) = (x.floor(), y.floor());
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, v) = (fade(x - ix), fade(y - iy));
    let at = |dx: i64, dy: i64| hash(seed, ix as i64 + dx, iy as i64 + dy);
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * u;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
    2.0 * (low + (high - low) * v) - 1.0
}

/// Value noise over `octaves` halvings of scale, in about -1..1.
pub(crate) fn fractal(seed: u64, x: f64, y: f64, octaves: u32) -> f64 {
    let (mut sum, mut weight, mut scale) = (0.0, 0.5, 1.0);
    for k in 0..octaves {
        sum += weight * value(seed + u64::from(k) * 101, x * scale, y * scale);
        weight *= 0.5;
        scale *= 2.0;
    }
    sum
}
