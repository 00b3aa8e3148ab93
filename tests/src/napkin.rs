//! A small sheet that is draped in a tenth of a second, for tests that run many times.

use serde_json::{Value, json};
use std::path::Path;

/// Its pipeline file, `napkin.ron`.
pub const PIPELINE: &str = r#"// A napkin held at two corners.
(
    name: "napkin",
    scene: Scene(file: "napkin.json"),
    stages: [
        StaticEquilibrium(speed: 0.01),  // mine
    ],
)
"#;

/// A square of 5 x 5 vertices, held at two corners, bent a little so that it knows which way to
/// fall.
pub fn scene() -> Value {
    let (n, step) = (5, 0.05);
    let at = |i: usize| ((i % n) as f64 * step, (i / n) as f64 * step);
    let rest: Vec<[f64; 2]> = (0..n * n).map(|i| [at(i).0, at(i).1]).collect();
    let positions: Vec<[f64; 3]> = (0..n * n).map(|i| [at(i).0, at(i).1, 0.02 * at(i).1]).collect();
    let cell = |k: usize| {
        let a = k / (n - 1) * n + k % (n - 1);
        [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]
    };
    let triangles: Vec<[usize; 3]> = (0..(n - 1) * (n - 1)).flat_map(cell).collect();
    json!({
        "format": "garment-scene-1", "name": "napkin",
        "rest_uv": rest, "positions": positions, "triangles": triangles,
        "panels": [{ "name": "napkin", "vertices": [0, n * n], "triangles": [0, triangles.len()] }],
        "seams": [], "pinned": [n * (n - 1), n * n - 1], "body": null, "self_collision": true,
        "material": { "area_density": 0.15, "stretch": 500.0, "shear": 50.0, "bend": 1e-5, "damping": 0.0,
                      "friction": 0.4, "thickness": 0.001 },
        "phases": [{ "name": "hang", "seconds": 1.0, "gravity": [0.0, -9.81, 0.0] }],
    })
}

/// Writes `napkin.ron` and the scene beside it.
pub fn write(dir: &Path) -> std::io::Result<()> {
    std::fs::write(dir.join("napkin.ron"), PIPELINE)?;
    std::fs::write(dir.join("napkin.json"), scene().to_string())
}
