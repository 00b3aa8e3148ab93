//! `GarmentObj`: the bare garment as Wavefront OBJ, vertex for vertex.

use crate::file_names::check_name;
use std::fmt::Write;
use toile_core::prelude::*;

/// Writes the garment's surface alone, its vertices in the garment's own order.
///
/// For programs that compare a result with the scene it came from: every vertex of every panel is
/// written, joined or not, to nine digits. Metres, Y up.
#[stage(
    role = Writer,
    source = "Wavefront Technologies, Object Files, 1992",
    example = "GarmentObj(name: \"result\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct GarmentObj {
    /// The file's name without its extension.
    #[param(default = "result".to_owned())]
    pub name: String,
    /// Name the panels as groups.
    #[param(default = false)]
    pub groups: bool,
    /// Write the flat places as texture points, metres; each panel's lie where they are in its own
    /// plane.
    #[param(default = false)]
    pub flat: bool,
}

#[stage]
impl GarmentObj {
    pub(super) fn run(&self, garment: &Garment, _cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        let mut text = String::with_capacity(48 * garment.positions.len() + 24 * garment.triangles.len());
        for p in &garment.positions {
            let _ = writeln!(text, "v {:.9} {:.9} {:.9}", p.x, p.y, p.z);
        }
        if self.flat {
            for p in &garment.rest {
                let _ = writeln!(text, "vt {:.9} {:.9}", p.x, p.y);
            }
        }
        for (k, t) in garment.triangles.iter().enumerate() {
            let begins = |p: &&GarmentPanel| self.groups && p.triangles.start == k && !p.triangles.is_empty();
            if let Some(panel) = garment.panels.iter().find(begins) {
                let _ = writeln!(text, "g {}", panel.name);
            }
            let [a, b, c] = t.map(|v| v + 1);
            let _ = match self.flat {
                true => writeln!(text, "f {a}/{a} {b}/{b} {c}/{c}"),
                false => writeln!(text, "f {a} {b} {c}"),
            };
        }
        Ok(OutputFiles::one(&format!("{}.obj", self.name), text.into_bytes()))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        crate::file_names::check_name(&self.name).err().into_iter().collect()
    }
}
