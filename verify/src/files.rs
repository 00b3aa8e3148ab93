//! A garment, its body and its pattern from files.
//!
//! Of a run's folder `garment.glb` is read (else the first GLB, else `result.obj`, else the first
//! OBJ), its body, and the flat pieces of `origin.json`. Of any other file the panels are its
//! texture islands where all of it has texture points, else groups, else materials, else parts; its
//! texture counts as the flat shape where it is that in some scale (with a pattern) or in some unit
//! (without).

mod cut;
mod flat;

use crate::certificate::{Certificate, Compared, InputFile};
use crate::compare::compare;
use crate::judge::judge;
use crate::limits::CheckLimits;
use crate::subject::{Subject, WearerBody};
use std::path::{Path, PathBuf};
use toile_body::{HUMAN_HEIGHTS, body_of_mesh};
use toile_core::artifact::{Body, Pattern, Point3};
use toile_core::prelude::{Context, ErrorCode, StageError};
use toile_geometry::obj;
use toile_output::flat::{FileMeshes, file_meshes};
use toile_output::write::origin::{FILE, FlatPieces};
use toile_pattern::pattern::{DxfPattern, GarmentCode, SeamlyPattern, SvgPattern};

/// The files' names that a run's folder is searched for first.
const FIRST: [&str; 2] = ["garment.glb", "result.obj"];

/// What is requested.
#[derive(Debug, Clone, Default)]
pub struct AskedFiles {
    /// A garment's file, or the folder of a run.
    pub garment: PathBuf,
    /// A pattern: GarmentCode's JSON, DXF or SVG.
    pub pattern: Option<PathBuf>,
    /// The seams of a DXF or SVG pattern, where a file of their own holds them.
    pub seams: Option<PathBuf>,
    /// A body; that of the garment's file where none is named.
    pub body: Option<PathBuf>,
    /// A second garment of the same pattern, or the folder of its run.
    pub compare: Option<PathBuf>,
    /// What a number of the garment's file is in metres; guessed where it is not given.
    pub unit: Option<f64>,
    /// The limits.
    pub limits: CheckLimits,
}

/// The certificate of what is requested, and the folder of the garment.
///
/// # Errors
/// A file that cannot be read, with its place and a remedy.
pub fn certify(asked: &AskedFiles) -> Result<(Certificate, PathBuf), StageError> {
    let mut reader = FileReader::default();
    let pattern = asked.pattern.as_deref().map(|p| reader.pattern(p, asked.seams.as_deref())).transpose()?;
    let body = asked.body.as_deref().map(|p| reader.body(p)).transpose()?;
    let file = garment_file(&asked.garment)?;
    let subject = reader.subject("garment", &file, asked.unit, pattern.as_ref(), body.as_ref())?;
    let found = judge(&subject, &asked.limits);
    let compared = match &asked.compare {
        None => None,
        Some(other) => {
            let other = garment_file(other)?;
            let other = reader.subject("compared", &other, asked.unit, pattern.as_ref(), body.as_ref())?;
            let difference = compare(&subject.garment, &other.garment);
            Some(Compared::new(judge(&other, &asked.limits), difference))
        }
    };
    let folder = file.parent().map(Path::to_owned).unwrap_or_default();
    Ok((Certificate::new(reader.inputs, found, compared, reader.notes), folder))
}

/// The garment's file of a folder; a file is itself.
fn garment_file(path: &Path) -> Result<PathBuf, StageError> {
    if !path.is_dir() {
        return Ok(path.to_owned());
    }
    let unread = |e: std::io::Error| {
        unreadable(format!("\"{}\" cannot be read: {e}", path.display())).hint("look at the folder's rights")
    };
    let mut names: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(path).map_err(unread)? {
        names.push(entry.map_err(unread)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    let ending = |end: &str| names.iter().find(|n| n.to_ascii_lowercase().ends_with(end));
    let known = |name: &str| names.iter().find(|n| *n == name);
    let found =
        known(FIRST[0]).or_else(|| ending(".glb")).or_else(|| known(FIRST[1])).or_else(|| ending(".obj"));
    found.map(|n| path.join(n)).ok_or_else(|| {
        unreadable(format!("the folder \"{}\" holds no garment", path.display()))
            .hint("name the output folder of a run with a writer of models (`Glb()` or `GarmentObj()`), or a .glb or .obj file")
    })
}

fn unreadable(what: String) -> StageError {
    StageError::new(ErrorCode::PatternLoading, what)
}

/// Reads files, and keeps note of them.
#[derive(Debug, Default)]
struct FileReader {
    inputs: Vec<InputFile>,
    notes: Vec<String>,
}

impl FileReader {
    fn bytes(&mut self, role: &'static str, path: &Path) -> Result<Vec<u8>, StageError> {
        let bytes = toile_core::read_file(path).map_err(|e| {
            unreadable(format!("\"{}\" cannot be read: {e}", path.display()))
                .hint("look at the path and the file's rights")
        })?;
        self.inputs.push(InputFile::of(role, &path.display().to_string(), &bytes));
        Ok(bytes)
    }

    fn pattern(&mut self, path: &Path, seams: Option<&Path>) -> Result<Pattern, StageError> {
        self.bytes("pattern", path)?;
        if let Some(seams) = seams {
            self.bytes("seams", seams)?;
        }
        let seams = seams.map(|s| s.display().to_string()).unwrap_or_default();
        let file = path.display().to_string();
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let cx = Context::quiet();
        let pattern = match extension.as_deref() {
            Some("json") => GarmentCode { file }.run(&cx)?.0,
            Some("dxf") => DxfPattern { file, seams, ..DxfPattern::default() }.run(&cx)?.0,
            Some("svg") => SvgPattern { file, seams, ..SvgPattern::default() }.run(&cx)?.0,
            Some("sm2d" | "val") => SeamlyPattern { file, seams, ..SeamlyPattern::default() }.run(&cx)?.0,
            _ => {
                let what = format!("\"{file}\" is not a pattern by its name");
                return Err(unreadable(what)
                    .hint("name a pattern of GarmentCode (.json), a .dxf, .svg, .sm2d or .val file"));
            }
        };
        let told = cx.take_remarks();
        self.notes.extend(told.warnings.into_iter().chain(told.notes));
        Ok(pattern)
    }

    fn body(&mut self, path: &Path) -> Result<WearerBody, StageError> {
        let bytes = self.bytes("body", path)?;
        let file = path.display().to_string();
        let is_glb = bytes.starts_with(b"glTF");
        let meshes = file_meshes(&bytes, &file, Some(1.0))?;
        let triangles = if meshes.body.is_empty() { meshes.triangles } else { meshes.body };
        let mut positions = meshes.positions;
        if !is_glb {
            let unit = body_unit(&positions, &triangles, &file)?;
            positions.iter_mut().for_each(|p| *p *= unit);
        }
        Ok(wearer(&positions, &triangles))
    }

    fn subject(
        &mut self,
        role: &'static str,
        path: &Path,
        unit: Option<f64>,
        pattern: Option<&Pattern>,
        body: Option<&WearerBody>,
    ) -> Result<Subject, StageError> {
        let bytes = self.bytes(role, path)?;
        let meshes = file_meshes(&bytes, &path.display().to_string(), unit)?;
        self.notes.extend(meshes.notes.iter().cloned());
        let pieces = self.pieces(path)?;
        let body = match body {
            Some(wearer) => Ok(wearer.clone()),
            None if meshes.body.is_empty() => Err("no body is known: name one with `--body`".to_owned()),
            None => Ok(wearer(&meshes.positions, &meshes.body)),
        };
        Ok(subject(&meshes, pieces.as_ref(), pattern, body))
    }

    /// The flat pieces beside a garment's file.
    fn pieces(&mut self, garment: &Path) -> Result<Option<FlatPieces>, StageError> {
        let path = garment.with_file_name(FILE);
        if !path.is_file() {
            return Ok(None);
        }
        let bytes = self.bytes("flat", &path)?;
        let pieces = toile_output::write::origin::flat(&bytes).map_err(|what| {
            unreadable(format!("\"{}\": {what}", path.display()))
                .hint("run the pipeline again, or take the file away")
        })?;
        Ok(Some(pieces))
    }
}

/// What is judged of the meshes of a file.
#[must_use]
pub fn subject(
    meshes: &FileMeshes,
    pieces: Option<&FlatPieces>,
    pattern: Option<&Pattern>,
    body: Result<WearerBody, String>,
) -> Subject {
    let mut faults = Vec::new();
    let of_pieces = pieces.and_then(|p| flat::garment_of_pieces(meshes, p).map_err(|e| faults.push(e)).ok());
    let (garment, flat) = match of_pieces {
        Some(garment) => (garment, Ok(())),
        None => cut::garment(meshes, pattern),
    };
    let seams = match (pieces, garment.seams.is_empty()) {
        (_, false) => Ok(()),
        (Some(_), true) => Err(format!(
            "\"{FILE}\" has no seams: run the pipeline again, or name the pattern with `--pattern`"
        )),
        (None, true) => Err("no pattern was given: name one with `--pattern`".to_owned()),
    };
    Subject { garment, flat, seams, pattern: pattern.cloned(), body, faults }
}

/// Metres of the unit in which a body is as tall as a person.
fn body_unit(positions: &[Point3], triangles: &[[u32; 3]], file: &str) -> Result<f64, StageError> {
    let y = || triangles.iter().flatten().map(|v| positions[*v as usize].y);
    let tall = y().fold(f64::NEG_INFINITY, f64::max) - y().fold(f64::INFINITY, f64::min);
    let fits = |u: &&f64| HUMAN_HEIGHTS.contains(&(tall * **u));
    [1.0, 0.01, 0.001, 0.1].iter().find(fits).copied().ok_or_else(|| {
        let what = format!("\"{file}\": no unit makes its height of {tall:.3} that of a person");
        unreadable(what).hint("the body must stand upright, y up; people are 0.5 to 2.5 m tall")
    })
}

/// The body of a mesh that stands where the garment is.
#[must_use]
pub fn wearer(positions: &[Point3], triangles: &[[u32; 3]]) -> WearerBody {
    let vertices = positions.iter().map(|p| p.coords).collect();
    let (mesh, _) = obj::repair(obj::Mesh { vertices, triangles: triangles.to_vec() });
    let points: Vec<Point3> = mesh.vertices.into_iter().map(Point3::from).collect();
    match body_of_mesh(points.clone(), mesh.triangles.clone()) {
        Ok((body, missing)) => {
            let why = |part: &str| Err(format!("the body's {part} cannot be found from its shape"));
            WearerBody { body, closed: Ok(()), measured: missing.map_or(Ok(()), why) }
        }
        Err(e) => {
            let body = Body {
                positions: points,
                triangles: mesh.triangles,
                landmarks: std::collections::BTreeMap::new(),
                measurements: std::collections::BTreeMap::new(),
            };
            WearerBody { body, closed: Err(e.message.clone()), measured: Err(e.message) }
        }
    }
}
