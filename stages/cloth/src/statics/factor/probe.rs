//! Results that show which arithmetic a machine has.
//!
//! Two things make the bits of a drape depend on the machine. The kernels of `faer` use the widest
//! vectors of the processor and block their products by the sizes of its caches, so that the order
//! of sums differs. The C library uses other versions of `exp`, `sin` and similar functions where
//! the processor has fused multiplication, and in other releases. Cost: some tens of milliseconds.
//! Limit: two machines that agree here may differ where nothing was probed.

use super::dense::probe_factor;

/// Unknowns and rows of the probed factor: as large as the fronts of a fine mesh, so that its
/// products are blocked.
const COLUMNS: usize = 512;
const ROWS: usize = 700;
/// Number of arguments of each function.
const ARGUMENTS: usize = 64;

/// Numbers that are equal on two machines of equal arithmetic.
#[must_use]
pub fn probe() -> Vec<f64> {
    let mut found = probe_factor::<f64>(ROWS, COLUMNS);
    found.extend(probe_factor::<f32>(ROWS, COLUMNS));
    (0..ARGUMENTS).for_each(|i| found.extend(functions(0.013 + 0.37 * i as f64)));
    found
}

/// The functions of the C library that stages call.
fn functions(x: f64) -> [f64; 16] {
    let (share, single) = (x.fract(), x as f32);
    [
        x.sin(),
        x.cos(),
        x.tan(),
        share.asin(),
        share.acos(),
        x.atan2(1.7),
        (-x).exp(),
        x.exp_m1(),
        x.ln(),
        x.log10(),
        x.powf(1.7),
        x.cbrt(),
        x.hypot(0.7),
        x.tanh(),
        f64::from(single.sin() + single.atan2(0.3)),
        f64::from((-single).exp() + single.powf(2.2)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_machine_gives_the_same_bits() {
        let bits = |all: Vec<f64>| all.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        let found = bits(probe());
        assert_eq!(found, bits(probe()));
        assert!(found.len() > 1000 && probe().iter().all(|x| x.is_finite()));
    }
}
