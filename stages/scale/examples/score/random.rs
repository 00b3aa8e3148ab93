//! Numbers for scenes: the same on every machine (Steele, Lea and Flood, SplitMix, 2014).

/// A generator of numbers.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The generator of a scene's number.
    pub fn new(seed: u64) -> Self {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        mix(self.0)
    }

    /// Even from `a` to `b`.
    pub fn from(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// One of `n` numbers from 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// True with a chance.
    pub fn chance(&mut self, p: f64) -> bool {
        self.from(0.0, 1.0) < p
    }

    /// Normal of mean 0 and deviation 1 (sum of twelve).
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.from(0.0, 1.0)).sum::<f64>() - 6.0
    }

    /// A colour between two grey levels.
    pub fn colour(&mut self, a: f64, b: f64) -> [f64; 3] {
        [self.from(a, b), self.from(a, b), self.from(a, b)]
    }
}

/// A well-mixed number of a number.
pub fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Smooth noise of -1 to 1 about cells of side 1.
pub fn noise(x: f64, y: f64, seed: u64) -> f64 {
    let (i, j) = (x.floor(), y.floor());
    let (u, v) = (x - i, y - j);
    let (u, v) = (u * u * (3.0 - 2.0 * u), v * v * (3.0 - 2.0 * v));
    let at = |a: f64, b: f64| {
        let n = mix(((i + a) as i64 as u64).wrapping_mul(0x1F123BB5)
            ^ ((j + b) as i64 as u64).wrapping_mul(0x0005_F356_4951)
            ^ seed);
        (n >> 40) as f64 / (1u64 << 23) as f64 - 1.0
    };
    let low = at(0.0, 0.0) * (1.0 - u) + at(1.0, 0.0) * u;
    let high = at(0.0, 1.0) * (1.0 - u) + at(1.0, 1.0) * u;
    low * (1.0 - v) + high * v
}

/// Sum of noises of halving cells.
pub fn rough(x: f64, y: f64, seed: u64) -> f64 {
    (0..3)
        .map(|o| {
            let s = f64::from(1 << o);
            noise(x * s, y * s, seed + o as u64) / s
        })
        .sum::<f64>()
        / 1.75
}
