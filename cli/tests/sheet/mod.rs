//! A scene so small that a run takes milliseconds.

use serde_json::{Value, json};

/// A strip of two triangles held at one side.
pub(crate) fn sheet() -> Value {
    json!({
        "format": "garment-scene-1", "name": "sheet",
        "rest_uv": [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1], [0.1, 0.1]],
        "positions": [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.01], [0.1, 0.1, 0.01]],
        "triangles": [[0, 1, 3], [0, 3, 2]],
        "panels": [{ "name": "sheet", "vertices": [0, 4], "triangles": [0, 2] }],
        "seams": [], "pinned": [2, 3], "body": null, "self_collision": true,
        "material": { "area_density": 0.15, "stretch": 500.0, "shear": 50.0, "bend": 1e-5, "damping": 0.0,
                      "friction": 0.4, "thickness": 0.001 },
        "phases": [{ "name": "hang", "seconds": 1.0, "gravity": [0.0, -9.81, 0.0] }],
    })
}
