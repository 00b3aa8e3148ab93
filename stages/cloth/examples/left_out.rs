//! Brings a square of cloth on two pins to rest, `left_out [CELLS]`: no body, no contact with
//! itself. tests/costs/left_out.sh counts its instructions beside those of builds that do not know
//! bodies or self-contact at all.
#![allow(clippy::print_stdout)]
use std::error::Error;
use std::ops::ControlFlow;
use toile_cloth::scene::generate;
use toile_cloth::statics::drive::solve::StaticEquilibrium;

fn main() -> Result<(), Box<dyn Error>> {
    let cells: u32 = std::env::args().nth(1).map_or(Ok(24), |n| n.parse())?;
    let scene = generate::hang(cells);
    let rested = StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(()))?;
    // All bits of the result, so that the results of two builds can be compared exactly.
    let bits = rested.positions.iter().flat_map(|p| [p.x, p.y, p.z]).map(f64::to_bits);
    let digest = bits.fold(0xcbf2_9ce4_8422_2325_u64, |d, b| (d ^ b).wrapping_mul(0x0100_0000_01b3));
    println!("{} nodes, {} steps, {digest:016x}", rested.positions.len(), rested.outcome.steps);
    Ok(())
}
