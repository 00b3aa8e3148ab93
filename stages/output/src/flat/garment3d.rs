//! `Garment3d`: a garment from a 3D file.

use super::fault::surface_fault;
use super::file::{
    GARMENT_SIZES, Mended, NO_POINT, PiecesBy, RawMesh, cloth_of_ours, labels, leave_out, lies, list,
    open_cloth, read_glb, read_obj, wholes,
};
use super::sheet::{PieceDetails, assembled, unlike};
use std::sync::Arc;
use toile_body::Up;
use toile_core::prelude::*;
use toile_drape::fabric::Preset;
use toile_flatten::SurfaceError;
use toile_flatten::islands::{SurfacePiece, SurfacePieces, islands_by_labels};

/// The unit of a garment's file.
#[choice]
#[derive(Copy, Eq)]
pub enum FileUnit {
    /// Metres.
    Metres,
    /// Decimetres.
    Decimetres,
    /// Centimetres.
    Centimetres,
    /// Millimetres.
    Millimetres,
    /// Inches.
    Inches,
}

impl FileUnit {
    const ALL: [FileUnit; 5] = [
        FileUnit::Metres,
        FileUnit::Decimetres,
        FileUnit::Centimetres,
        FileUnit::Millimetres,
        FileUnit::Inches,
    ];

    fn metres(self) -> f64 {
        match self {
            FileUnit::Metres => 1.0,
            FileUnit::Decimetres => 0.1,
            FileUnit::Centimetres => 0.01,
            FileUnit::Millimetres => 0.001,
            FileUnit::Inches => 0.0254,
        }
    }
}

/// Whether the file says how the pieces were cut.
#[choice]
#[derive(Copy, Eq)]
pub enum FlatShape {
    /// It does not: a flattener finds the pattern.
    Unknown,
    /// The texture points are the pieces as they were cut, in the file's unit.
    Uv,
}

/// Reads a garment from a Wavefront OBJ file or a binary glTF file (GLB), to be flattened.
///
/// Of a file of this program the cloth is taken; of other files what is closed all around (a body,
/// buttons) is left out beside open cloth, and reported. The mesh is cut into pieces by its texture
/// islands, groups, materials, marked edges or parts. Seams are where pieces meet. What is damaged
/// is mended and counted: vertices at one place are joined, triangles without area or listed twice
/// are removed, edges of three triangles are cut, triangles that face against their neighbours are
/// turned. A piece without a boundary, or with tunnels, cannot be laid flat and is refused, as is
/// cloth that was exported with its thickness.
///
/// Its flat shape is not known, unless `flat` says that the texture is the pattern: to simulate it,
/// flatten it first.
#[stage(
    role = Reader,
    source = "Wavefront OBJ; glTF 2.0",
    example = "Garment3d(file: \"garment.obj\", unit: Metres, pieces: Parts)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Garment3d {
    /// The file, relative to the pipeline; `.glb` is read as glTF, all else as OBJ.
    #[param(default = String::new())]
    pub file: String,
    /// Objects, groups and materials of the file that are not of the garment: `["Body", "Shoes"]`.
    #[param(default = Vec::new())]
    pub leave_out: Vec<String>,
    /// The unit of its numbers.
    #[param(default = FileUnit::Metres)]
    pub unit: FileUnit,
    /// The axis that points up.
    #[param(default = Up::Y)]
    pub up: Up,
    /// What separates the pieces.
    #[param(default = PiecesBy::Auto)]
    pub pieces: PiecesBy,
    /// Vertices that are so near to each other are one.
    #[param(default = Length::mm(0.01), min = 0.0, max = 0.01)]
    pub weld: Length,
    /// Whether the file says how the pieces were cut.
    #[param(default = FlatShape::Unknown)]
    pub flat: FlatShape,
}

#[stage]
impl Garment3d {
    /// Runs the stage.
    pub fn run(&self, fabric: Option<&Fabric>, cx: &Context) -> Result<Garment, StageError> {
        let mut raw = self.raw(cx)?;
        cx.check()?;
        cloth_of_ours(&mut raw, &self.file, cx);
        leave_out(&mut raw, &self.leave_out, &self.file)?;
        self.check_size(&raw)?;
        let mut mended = raw.mended(self.weld.metres());
        if mended.mesh.triangles.is_empty() {
            return Err(StageError::new(
                ErrorCode::DegenerateTriangles,
                "no triangle of the file has an area",
            )
            .hint("check `unit` and `weld`, and the file")
            .at("weld"));
        }
        open_cloth(&mut mended, &self.file, cx)?;
        self.check_upright(&mended, cx);
        let by = self.pieces.resolved(&mended)?;
        let (labels, cut) = labels(&mended, by);
        let pieces = islands_by_labels(&mended.mesh.positions, &mended.mesh.triangles, &labels)
            .map_err(|e| unlaid(e, &mended).at("pieces"))?;
        cx.note(format!("the pieces are separated by {}", by.words()));
        let closed = wholes(&mended.mesh);
        if closed.iter().all(|w| w.is_closed()) {
            let names = list(closed.iter().map(|w| w.name.as_str()));
            cx.warn(format!(
                "\"{}\": {names} has no opening, as a body or a cushion has none: is it the garment, and not the body?",
                self.file
            ));
        }
        mended.repairs.cut = cut;
        mended.repairs.turned = pieces.pieces.iter().map(|p| p.surface.repairs().turned).sum();
        mended.repairs.count(cx);
        if let Some(what) = mended.repairs.words() {
            cx.warn(format!("\"{}\" was repaired: {what}", self.file));
        }
        self.garment(&mended, &pieces, by, fabric)
    }

    /// Whether the file is there; what stands in it is read by the run.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let there = self.named().and_then(|()| placed.cx.look(&self.file));
        there.map_err(|e| e.at("file")).err().into_iter().collect()
    }
}

impl Garment3d {
    fn named(&self) -> Result<(), StageError> {
        if self.file.is_empty() {
            let e = StageError::new(ErrorCode::InvalidParameter, "no file is named to read the garment from");
            return Err(e.hint("write `file: \"dress.obj\"`").at("file"));
        }
        Ok(())
    }

    /// The mesh of the file in metres, y up.
    fn raw(&self, cx: &Context) -> Result<RawMesh, StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let is_glb = self.file.to_ascii_lowercase().ends_with(".glb") || bytes.starts_with(b"glTF");
        let mut raw = if is_glb { read_glb(&bytes, &self.file) } else { read_obj(&bytes, &self.file) }?;
        let unit = self.unit.metres();
        for p in &mut raw.positions {
            *p = match self.up {
                Up::Y => *p * unit,
                Up::Z => Point3::new(p.x, p.z, -p.y) * unit,
            };
        }
        Ok(raw)
    }

    /// Refuses what is no garment in the unit that is stated.
    fn check_size(&self, raw: &RawMesh) -> Result<(), StageError> {
        let used = || raw.triangles.iter().flatten().map(|&v| raw.positions[v as usize]);
        let Some(first) = used().next() else { return Ok(()) };
        let (lo, hi) = used().fold((first, first), |(lo, hi), p| (lo.inf(&p), hi.sup(&p)));
        let size = (hi - lo).norm();
        if GARMENT_SIZES.contains(&size) {
            return Ok(());
        }
        let fits = |u: &FileUnit| GARMENT_SIZES.contains(&(size / self.unit.metres() * u.metres()));
        let hint = match FileUnit::ALL.iter().find(|u| fits(u)) {
            Some(unit) => {
                format!(
                    "state the unit of the file's numbers, such as `unit: {unit:?}` (`--set garment.unit={unit:?}`)"
                )
            }
            None => format!(
                "garments are 5 cm to 6 m from corner to corner, and no unit makes this one so; make it {} in the program that made it",
                times(size / self.unit.metres())
            ),
        };
        let what = format!("the garment would measure {size:.4} m from corner to corner");
        Err(StageError::invalid(what).hint(hint).at("unit"))
    }

    /// Asks about a garment that lies down.
    fn check_upright(&self, mended: &Mended, cx: &Context) {
        if lies(&mended.mesh) {
            let other = match self.up {
                Up::Y => "Z",
                Up::Z => "Y",
            };
            cx.warn(format!(
                "the garment lies on its back or front: if its file has {other} up, add `--set garment.up={other}`, or the grain of the pieces \
                 runs across"
            ));
        }
    }

    fn garment(
        &self,
        mended: &Mended,
        pieces: &SurfacePieces,
        by: PiecesBy,
        fabric: Option<&Fabric>,
    ) -> Result<Garment, StageError> {
        let fabric = match fabric {
            Some(fabric) => Arc::new(fabric.clone()),
            None => Arc::new(Preset::default().run(&Context::quiet())?),
        };
        let names = names(mended, pieces, by);
        let part = |(piece, name): (&SurfacePiece, String)| {
            let rest = self.rest(mended, piece, &name)?;
            Ok(PieceDetails { name, fabric: fabric.clone(), rest, photo_px: Vec::new() })
        };
        let parts: Vec<PieceDetails> =
            pieces.pieces.iter().zip(names).map(part).collect::<Result<_, StageError>>()?;
        Ok(assembled(pieces, parts))
    }

    /// The flat places of a piece's vertices; all zero where they are not known.
    fn rest(&self, mended: &Mended, piece: &SurfacePiece, name: &str) -> Result<Vec<Point2>, StageError> {
        let mut rest = vec![Point2::origin(); piece.vertices.len()];
        if self.flat == FlatShape::Unknown {
            return Ok(rest);
        }
        let mesh = &mended.mesh;
        for (&t, corners) in piece.triangles.iter().zip(piece.surface.triangles()) {
            for &v in corners {
                let own = mesh.triangles[t as usize];
                let k = own.iter().position(|u| *u == piece.vertices[v as usize]).unwrap_or(0);
                let point = mesh.corners[t as usize][k];
                if point == NO_POINT {
                    let what = format!("piece \"{name}\" has triangles without texture points");
                    return Err(StageError::invalid(what).hint("write `flat: Unknown`").at("flat"));
                }
                rest[v as usize] = mesh.uv[point as usize] * self.unit.metres();
            }
        }
        let area: f64 = piece.surface.triangles().iter().map(|t| area(t.map(|v| rest[v as usize]))).sum();
        if area < 0.0 {
            // Drawn as seen from inside.
            rest.iter_mut().for_each(|p| p.x = -p.x);
        }
        Ok(rest)
    }
}

/// How much larger or smaller something of this size must be to be about as large as a garment:
/// `1000 times larger`.
fn times(size: f64) -> String {
    // Garments are about a metre; a mesh is off by a unit, which is a power of ten.
    let power = if size > 0.0 { (-size.log10()).round() as i32 } else { 0 };
    match power {
        1.. => format!("{} times larger", 10_f64.powi(power)),
        ..0 => format!("{} times smaller", 10_f64.powi(-power)),
        0 => "larger".to_owned(),
    }
}

/// Why a piece cannot be laid flat, by the name of the object that it is of.
fn unlaid(e: SurfaceError, mended: &Mended) -> StageError {
    let of = |triangle: usize| match mended.mesh.called(triangle) {
        "" => "the mesh".to_owned(),
        name => format!("\"{name}\""),
    };
    let (what, hint) = match e {
        SurfaceError::Closed { triangle } => (
            format!(
                "{} is closed all around, as a body is: it has no edge from which it could be laid flat",
                of(triangle)
            ),
            "export the garment without the body; what is closed and is to be cut, such as a cushion, needs seams: mark them as edges (lines), or \
             unwrap it along them",
        ),
        SurfaceError::Handles { count } => (
            format!(
                "a piece closes on itself at {count} places, as with straps or belt loops, and cannot lie flat as one piece"
            ),
            "mark the seams of the garment as edges (lines), or unwrap it along them, and tell the pieces by those: `--set garment.pieces=Seams` \
             (or `Uv`)",
        ),
        SurfaceError::NotOrientable { triangle } => (
            format!("{} has one side only, as a band that was closed with a twist has", of(triangle)),
            "look for a twisted strap or waistband in the program that made it, and mend it there",
        ),
        other => return surface_fault(other, &mended.numbers),
    };
    StageError::invalid(what).hint(hint)
}

fn area([a, b, c]: [Point2; 3]) -> f64 {
    (b - a).perp(&(c - a)) / 2.0
}

/// Names by the group or material of most of a piece's triangles, else by number.
fn names(mended: &Mended, pieces: &SurfacePieces, by: PiecesBy) -> Vec<String> {
    let mesh = &mended.mesh;
    let (of, words) = match by {
        PiecesBy::Materials => (&mesh.materials, &mesh.material_names),
        _ => (&mesh.groups, &mesh.group_names),
    };
    let named = |(i, p): (usize, &SurfacePiece)| {
        let name = words.get(most(p.triangles.iter().map(|&t| of[t as usize])) as usize);
        let name: String = name.map_or("", |n| n.trim()).to_owned();
        if name.is_empty() { format!("piece_{}", i + 1) } else { name }
    };
    let all: Vec<String> = pieces.pieces.iter().enumerate().map(named).collect();
    unlike(all.iter().map(String::as_str))
}

/// The most frequent number; the least of equals.
fn most(numbers: impl Iterator<Item = u32>) -> u32 {
    let mut sorted: Vec<u32> = numbers.collect();
    sorted.sort_unstable();
    let groups = sorted.chunk_by(|a, b| a == b);
    groups.fold((0, 0), |best, g| if g.len() > best.1 { (g[0], g.len()) } else { best }).0
}
