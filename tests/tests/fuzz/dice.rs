//! Random numbers that come back: a case is made from the seed, the target's name and the case's
//! number alone.

/// SplitMix64 (Steele, Lea, Flood, 2014).
pub(crate) struct Dice(u64);

impl Dice {
    /// The numbers of one case.
    pub(crate) fn of(seed: u64, target: &str, case: u64) -> Self {
        let name = target
            .bytes()
            .fold(0xCBF2_9CE4_8422_2325, |h: u64, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01B3));
        let mut dice = Dice(seed ^ name);
        dice.0 = dice.next() ^ case;
        dice
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number below `n`; 0 where there is none.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        if n == 0 { 0 } else { (self.next() % n as u64) as usize }
    }

    pub(crate) fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }

    /// A range within `n` of at most `most`.
    pub(crate) fn range(&mut self, n: usize, most: usize) -> std::ops::Range<usize> {
        let start = self.below(n + 1);
        start..start + self.below((n - start).min(most) + 1)
    }
}
