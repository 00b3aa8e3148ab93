//! A garment in space: a tube of two pieces that narrows or widens, worn by nobody.

use std::fmt::Write;

const AROUND: usize = 32;
const UP: usize = 14;

/// An OBJ file in centimetres: radii at the lower and the upper end, and the length, cm; the halves
/// are groups `front` and `back`.
pub(crate) fn tube(radii: [f64; 2], length: f64) -> Vec<u8> {
    let mut text = String::new();
    for j in 0..=UP {
        let share = j as f64 / UP as f64;
        let radius = radii[0] + share * (radii[1] - radii[0]);
        for i in 0..AROUND {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / AROUND as f64).sin_cos();
            writeln!(text, "v {:.4} {:.4} {:.4}", radius * cos, 40.0 + share * length, 0.8 * radius * sin)
                .unwrap();
        }
    }
    for (name, columns) in [("front", 0..AROUND / 2), ("back", AROUND / 2..AROUND)] {
        writeln!(text, "g {name}").unwrap();
        for i in columns {
            for j in 0..UP {
                let at = |i: usize, j: usize| 1 + j * AROUND + i % AROUND;
                writeln!(text, "f {} {} {}", at(i, j), at(i, j + 1), at(i + 1, j)).unwrap();
                writeln!(text, "f {} {} {}", at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)).unwrap();
            }
        }
    }
    text.into_bytes()
}
