//! The prepared scenes: two panels before and behind a dress form, to be sewn into a skirt of 1,024
//! triangles; and a square metre of cloth that hangs from its upper edge, is blown and swings.

use nalgebra::Vector3;
use std::error::Error;
use std::path::Path;
use toile_cloth::energy::Air;
use toile_cloth::scene::{Phase, Scene, body_to_obj, generate, to_json};

/// Cells of a panel along the waist.
const CELLS_ALONG: u32 = 16;
/// Cells of a panel from the waist down to the hem.
const CELLS_DOWN: u32 = 16;
/// Cells of the square that is blown, along each side.
const CELLS: u32 = 16;

/// The scenes and the OBJ of the body: names and contents.
pub(crate) fn files() -> [(&'static str, String); 3] {
    let mut skirt = generate::tube(CELLS_ALONG, CELLS_DOWN);
    skirt.name = "skirt".into();
    [
        ("skirt.json", to_json(&skirt, "form.obj")),
        ("form.obj", body_to_obj(&skirt)),
        ("blown.json", to_json(&blown(), "")),
    ]
}

/// Wind for 4 s, in which the cloth comes to rest at a slant; then none, in a vacuum.
fn blown() -> Scene {
    let hung = generate::hang(CELLS);
    let phase = |name: &str, seconds: f64, air: Option<Air>| Phase {
        name: name.into(),
        seconds,
        gravity: Vector3::new(0.0, -9.81, 0.0),
        air,
    };
    let wind = Air { density: 1.2, normal: 1.17, tangential: 0.008, wind: Vector3::new(0.0, 0.0, 0.5) };
    Scene {
        name: "blown".into(),
        positions: hung.rest.iter().map(|p| Vector3::new(p.x, p.y - 0.5, 0.0)).collect(),
        pinned: (0..=CELLS).map(|i| CELLS * (CELLS + 1) + i).collect(),
        phases: vec![phase("blow", 4.0, Some(wind)), phase("swing", 7.0, None)],
        ..hung
    }
}

/// Writes them.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    for (name, text) in files() {
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}
