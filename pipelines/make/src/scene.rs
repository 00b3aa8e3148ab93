//! The prepared scene: two panels before and behind a dress form, to be sewn into a skirt of 1,056
//! triangles.

use std::error::Error;
use std::path::Path;
use toile_cloth::scene::{body_to_obj, generate, to_json};

/// Cells of a panel along the waist.
const CELLS_ALONG: u32 = 16;
/// Cells of a panel from the waist down to the hem.
const CELLS_DOWN: u32 = 16;

/// The scene and the OBJ of its body: names and contents.
pub(crate) fn files() -> [(&'static str, String); 2] {
    let mut scene = generate::tube(CELLS_ALONG, CELLS_DOWN);
    scene.name = "skirt".into();
    [("skirt.json", to_json(&scene, "form.obj")), ("form.obj", body_to_obj(&scene))]
}

/// Writes them.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    for (name, text) in files() {
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}
