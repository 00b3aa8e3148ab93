//! The files that examples name.

use super::{dress, shapes, suite};
use crate::artifact::*;
use crate::{Cancel, Card, Context, Inputs, PortValue, Registry};
use std::path::Path;
use std::sync::Arc;

/// Two rectangles of 50 x 60 cm, sewn at their sides, as GarmentCode writes them.
const PATTERN: &str = r#"{"pattern": {"panels": {
"front": {"translation": [-25, 80, 20], "rotation": [0, 0, 0], "vertices": [[0, 0], [50, 0], [50, 60], [0, 60]],
 "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}], "label": "body"},
"back": {"translation": [-25, 80, -20], "rotation": [0, 0, 0], "vertices": [[0, 0], [0, 60], [50, 60], [50, 0]],
 "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}], "label": "body"}},
"stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}]]},
"properties": {"units_in_meter": 100, "curvature_coords": "relative"}}"#;

/// Two half pieces with a fold, a grain line and a notch, as a drawing program saves them,
/// millimetres.
const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="600mm" height="700mm" viewBox="0 0 600 700">
<g id="front"><path d="M 20,80 V 650 H 270 Q 262,400 270,280 C 215,270 190,200 205,60 L 120,30 C 110,70 70,80 20,80 Z"/>
<path class="fold" d="M 20,100 V 600"/><path class="grain" d="M 60,200 V 500"/><circle class="notch" cx="266" cy="400" r="2"/></g>
<g id="back" transform="translate(290 0)"><path d="M 20,45 V 650 H 270 Q 262,400 270,280 C 215,270 190,200 205,60 L 120,30 C 110,42 70,45 20,45 Z"/>
<path class="fold" d="M 20,100 V 600"/><path class="grain" d="M 60,200 V 500"/><circle class="notch" cx="266" cy="400" r="2"/></g>
</svg>"##;

/// A front and a back of the same form, drafted from two measurements, as Seamly2D saves them.
const DRAFT: &str = r##"<pattern><version>0.6.8</version><unit>cm</unit><measurements>body.smis</measurements>
<variables><variable name="#ease" formula="4" description=""/></variables>
<draftBlock name="skirt"><calculation>
<point id="1" name="A" type="single" x="0" y="0"/>
<point id="2" name="B" type="endLine" basePoint="1" angle="270" length="60"/>
<point id="3" name="C" type="endLine" basePoint="2" angle="0" length="(hip_circ + #ease)/4 + 6"/>
<point id="4" name="D" type="endLine" basePoint="1" angle="3" length="(waist_circ + #ease)/4"/>
<spline id="5" type="simpleInteractive" point1="4" point4="3" angle1="AngleLine_D_C" length1="15" angle2="AngleLine_C_D" length2="15"/>
</calculation><modeling><point id="11" idObject="1" type="modeling"/><point id="12" idObject="2" type="modeling"/>
<point id="13" idObject="3" type="modeling"/><point id="14" idObject="4" type="modeling"/>
<spline id="15" idObject="5" type="modelingSpline"/></modeling>
<pieces><piece id="20" name="front"><data onFold="true" quantity="1"/><grainline visible="true" rotation="90"/><nodes>
<node type="NodePoint" idObject="11"/><node type="NodePoint" idObject="14"/><node type="NodeSpline" idObject="15"/>
<node type="NodePoint" idObject="13"/><node type="NodePoint" idObject="12"/></nodes></piece>
<piece id="21" name="back"><data onFold="true" quantity="1"/><grainline visible="true" rotation="90"/><nodes>
<node type="NodePoint" idObject="11"/><node type="NodePoint" idObject="14"/><node type="NodeSpline" idObject="15"/>
<node type="NodePoint" idObject="13"/><node type="NodePoint" idObject="12"/></nodes></piece></pieces></draftBlock></pattern>"##;

/// The measurements of the draft, as SeamlyMe saves them.
const MEASUREMENTS: &str = r#"<smis><version>0.3.4</version><unit>cm</unit><body-measurements>
<m name="waist_circ" value="72"/><m name="hip_circ" value="96"/></body-measurements></smis>"#;

/// Two half pieces of size M, as CAD programs exchange them: mirror line above, grain along x,
/// millimetres.
fn pieces() -> String {
    use std::fmt::Write;
    let mut out = String::from("  0\nSECTION\n  2\nBLOCKS\n");
    let corners = [[0.0, 250.0], [0.0, 0.0], [400.0, 0.0], [600.0, 60.0], [570.0, 170.0], [550.0, 250.0]];
    for name in ["FRONT", "BACK"] {
        let _ = write!(out, "  0\nBLOCK\n  8\n0\n  2\n{name}_M\n");
        for k in 0..corners.len() {
            let _ = write!(out, "  0\nPOLYLINE\n  8\n1\n 66\n1\n");
            for [x, y] in [corners[k], corners[(k + 1) % corners.len()]] {
                let _ = write!(out, "  0\nVERTEX\n  8\n1\n 10\n{x}\n 20\n{y}\n");
            }
            out += "  0\nSEQEND\n  8\n1\n";
        }
        for (layer, [x, y], [u, v]) in
            [(6, [550.0, 250.0], [0.0, 250.0]), (7, [100.0, 100.0], [300.0, 100.0])]
        {
            let _ = write!(out, "  0\nLINE\n  8\n{layer}\n 10\n{x}\n 20\n{y}\n 11\n{u}\n 21\n{v}\n");
        }
        out += "  0\nENDBLK\n";
    }
    out + "  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n  0\nTEXT\n  8\n1\n  1\nUnits: METRIC\n  0\nENDSEC\n  0\nEOF\n"
}

/// Lays the files that an example names into a folder: pictures (`empty.jpg` shows the ground
/// without the garment), a body as OBJ (a garment where its name says so), a GarmentCode pattern
/// under its usual ending, a DXF and an SVG of pieces, a draft with its measurements, and, of other
/// kinds, whatever a writer of the registry makes of the suite's garment under that extension, with
/// all that goes with it.
///
/// Errors: the system's, where a file cannot be written.
pub fn files_for(registry: &Registry, example: &str, folder: &Path) -> Result<(), String> {
    let lay = |name: &str, bytes: &[u8]| {
        std::fs::write(folder.join(name), bytes).map_err(|e| format!("cannot write {name}: {e}"))
    };
    for name in example.split('"').skip(1).step_by(2).filter(|n| !n.contains(['/', '\\'])) {
        match name.rsplit_once('.').map(|(_, extension)| extension) {
            _ if name.ends_with("_specification.json") => lay(name, PATTERN.as_bytes())?,
            Some("jpg") if name == "empty.jpg" => {
                lay(name, &encoded(&shapes::ground(), image::ImageFormat::Jpeg))?
            }
            Some("jpg" | "jpeg") => lay(name, &encoded(&shapes::photo(), image::ImageFormat::Jpeg))?,
            Some("png") => lay(name, &encoded(&shapes::photo(), image::ImageFormat::Png))?,
            Some("dxf") => lay(name, pieces().as_bytes())?,
            Some("svg") => lay(name, DRAWING.as_bytes())?,
            Some("sm2d" | "val") => lay(name, DRAFT.as_bytes())?,
            Some("smis" | "vit") => lay(name, MEASUREMENTS.as_bytes())?,
            Some("obj") if name.contains("garment") => lay(name, &garment_file())?,
            Some("obj") => lay(name, &body_file(registry, example.contains("up: Z")))?,
            Some(extension) if extension.chars().all(char::is_alphabetic) => {
                let ending = format!(".{extension}");
                let files = writers_for(registry, example).find_map(|card| written(registry, card, &ending));
                for file in files.into_iter().flatten() {
                    let own = if file.path.ends_with(&ending) { name } else { &file.path };
                    lay(own, &file.bytes)?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// All cards, first those that are named after the stage of the example: `SceneJson` writes what
/// `Scene` reads.
fn writers_for<'r>(registry: &'r Registry, example: &'r str) -> impl Iterator<Item = &'r Card> {
    let stage = example.split('(').next().unwrap_or("").trim();
    let kin = move |card: &&Card| card.name.starts_with(stage);
    registry.cards().filter(kin).chain(registry.cards())
}

fn encoded(photo: &Photo, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    // Writing into memory cannot fail; a stage that is given nothing says so.
    let _ = photo.pixels.write_to(&mut bytes, format);
    bytes.into_inner()
}

/// The suite's sewn garment as an OBJ file, each panel with vertices of its own.
fn garment_file() -> Vec<u8> {
    dress::sewn_garment().export().pop().map(|(_, bytes)| bytes).unwrap_or_default()
}

/// A body as an OBJ file, lying on its back where z is to be up: the one that a stage of the
/// registry makes without arguments, since readers of bodies look for shoulders and legs, else the
/// suite's own.
fn body_file(registry: &Registry, z_up: bool) -> Vec<u8> {
    let made = registry.of_role(crate::Role::Body).find_map(|card| {
        let outcome =
            registry.make(card, "()").ok()?.run_ports(&Inputs::default(), &Context::quiet()).ok()?;
        first::<Body>(&outcome)
    });
    let mut body = made.unwrap_or_else(dress::body);
    if z_up {
        body.positions.iter_mut().for_each(|p| *p = Point3::new(p.x, -p.z, p.y));
    }
    body.export().pop().map(|(_, bytes)| bytes).unwrap_or_default()
}

fn first<T: Clone + 'static>(made: &[PortValue]) -> Option<T> {
    made.iter().flat_map(PortValue::entries).find_map(|(_, a)| {
        let any: &dyn std::any::Any = a.as_ref();
        any.downcast_ref::<T>().cloned()
    })
}

/// What a writer of garments makes, where one of its files has that ending.
fn written(registry: &Registry, card: &Card, ending: &str) -> Option<Vec<OutputFile>> {
    let takes_garment = card.inputs.first().is_some_and(|port| port.kind == Garment::KIND);
    if card.role != crate::Role::Writer || !takes_garment {
        return None;
    }
    let cx = Context::new("suite", Path::new("."), Cancel::new(), Arc::new(()));
    let made = registry.make(card, "()").ok()?.run_ports(&inputs_of(card), &cx).ok()?;
    let files = first::<OutputFiles>(&made)?;
    files.0.iter().any(|f| f.path.ends_with(ending)).then_some(files.0)
}

fn inputs_of(card: &Card) -> Inputs {
    Inputs(card.inputs.iter().map(suite::default_value).collect())
}
