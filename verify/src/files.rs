//! A garment, its body and its pattern from files.
//!
//! Of a run's folder `garment.glb` is read (else the first GLB, else `result.obj`, else the first
//! OBJ), its body, and the flat pieces of `origin.json`. Of any other file the panels are its
//! texture islands where all of it has texture points, else those of GarmentCode's segmentation
//! beside it, else groups, else materials, else parts; its texture counts as the flat shape where
//! it is that in some scale (with a pattern) or in some unit (without).

mod cut;
mod fault;
mod flat;
mod segmentation;
mod stages;
mod up;

pub use segmentation::Segmentation;
pub use stages::reader_words;
pub use toile_body::Up;

use crate::certificate::{Certificate, Compared, InputFile};
use crate::compare::compare;
use crate::judge::judge;
use crate::limits::CheckLimits;
use crate::subject::{KnownCloth, Subject, WearerBody};
use fault::unreadable;
use stages::{made, one};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_body::{HUMAN_HEIGHTS, body_of_mesh};
use toile_core::artifact::{Body, Collider, Fabric, Pattern, Point3};
use toile_core::prelude::{Context, Stage, StageError};
use toile_geometry::obj;
use toile_output::flat::{FileMeshes, file_meshes};
use toile_output::write::origin::{FILE, FlatPieces};

/// The files' names that a run's folder is searched for first.
const FIRST: [&str; 2] = ["garment.glb", "result.obj"];

/// Why rest is not judged where no fabric is named.
const NO_CLOTH: &str = "forces need the fabric, which no file of a garment tells: name it with `--fabric`";

/// What is requested.
#[derive(Debug, Clone, Default)]
pub struct AskedFiles {
    /// A garment's file, or the folder of a run.
    pub garment: PathBuf,
    /// The file of a pattern.
    pub pattern: Option<PathBuf>,
    /// The seams of a pattern, where a file of their own holds them.
    pub seams: Option<PathBuf>,
    /// The stage that reads the pattern, such as [`reader_words`] names one.
    pub reader: Option<Arc<dyn Stage>>,
    /// What the garment is made of and what it lies on, where its rest is to be judged.
    pub cloth: Option<ClothStages>,
    /// A body; that of the garment's file where none is named.
    pub body: Option<PathBuf>,
    /// A second garment of the same pattern, or the folder of its run.
    pub compare: Option<PathBuf>,
    /// What a number of the garment's file is in metres; guessed where it is not given.
    pub unit: Option<f64>,
    /// Which axis of the files is up; found where it is not given.
    pub up: Option<Up>,
    /// The limits.
    pub limits: CheckLimits,
}

/// The stages that say what a garment is made of and what it lies on.
#[derive(Debug, Clone)]
pub struct ClothStages {
    /// Its fabric.
    pub fabric: Arc<dyn Stage>,
    /// Makes of the body what cloth lies on: its friction and how far it holds cloth off.
    pub collider: Arc<dyn Stage>,
}

/// The certificate of what is requested, and the folder of the garment.
///
/// # Errors
/// A file that cannot be read, with its place and a remedy.
pub fn certify(asked: &AskedFiles) -> Result<(Certificate, PathBuf), StageError> {
    let mut reader = FileReader::default();
    let pattern = asked.reader.as_deref().map(|stage| reader.pattern(stage, asked)).transpose()?;
    let body = asked.body.as_deref().map(|p| reader.body(p, asked.up)).transpose()?;
    let file = garment_file(&asked.garment)?;
    let subject = reader.subject("garment", &file, asked, pattern.as_deref(), body.as_ref())?;
    let found = judge(&subject, &asked.limits);
    let compared = match &asked.compare {
        None => None,
        Some(other) => {
            let other = garment_file(other)?;
            let other = reader.subject("compared", &other, asked, pattern.as_deref(), body.as_ref())?;
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

    /// The pattern, by its stage; the files that it reads are noted by what they are.
    fn pattern(&mut self, stage: &dyn Stage, asked: &AskedFiles) -> Result<Arc<Pattern>, StageError> {
        let cx = Context::quiet();
        let pattern = made::<Pattern>(stage, Vec::new(), &cx)?;
        let is = |path: &str, named: &Option<PathBuf>| named.as_deref() == Some(Path::new(path));
        // A file that was looked for and is not there has no digest.
        let read = cx.take_reads().into_iter().filter(|(_, digest)| digest.is_some());
        for (k, (path, _)) in read.enumerate() {
            let role = match () {
                () if is(&path, &asked.pattern) || k == 0 => "pattern",
                () if is(&path, &asked.seams) => "seams",
                () => "measurements",
            };
            self.bytes(role, Path::new(&path))?;
        }
        let told = cx.take_remarks();
        self.notes.extend(told.warnings.into_iter().chain(told.notes));
        Ok(pattern)
    }

    /// A body, and which axis of its file is up.
    fn body(&mut self, path: &Path, up: Option<Up>) -> Result<(WearerBody, Up), StageError> {
        let bytes = self.bytes("body", path)?;
        let file = path.display().to_string();
        let is_glb = bytes.starts_with(b"glTF");
        let meshes = file_meshes(&bytes, &file, Some(1.0))?;
        let triangles = if meshes.body.is_empty() { meshes.triangles } else { meshes.body };
        let mut positions = meshes.positions;
        let up = up.unwrap_or_else(|| match is_glb {
            true => Up::Y,
            false => up::of_body(&positions, &triangles),
        });
        up::turn(up, &mut positions);
        if !is_glb {
            let unit = body_unit(&positions, &triangles, &file)?;
            positions.iter_mut().for_each(|p| *p *= unit);
        }
        Ok((wearer(&positions, &triangles), up))
    }

    fn subject(
        &mut self,
        role: &'static str,
        path: &Path,
        asked: &AskedFiles,
        pattern: Option<&Pattern>,
        body: Option<&(WearerBody, Up)>,
    ) -> Result<Subject, StageError> {
        let bytes = self.bytes(role, path)?;
        let mut meshes = file_meshes(&bytes, &path.display().to_string(), asked.unit)?;
        self.notes.append(&mut meshes.notes);
        let up = asked.up.or(body.map(|b| b.1)).unwrap_or_else(|| self.up(&meshes, &bytes, path));
        up::turn(up, &mut meshes.positions);
        let pieces = self.pieces(path)?;
        let labels = self.labels(path)?;
        let body = match body {
            Some((wearer, _)) => Ok(wearer.clone()),
            None if meshes.body.is_empty() => Err("no body is known: name one with `--body`".to_owned()),
            None => Ok(wearer(&meshes.positions, &meshes.body)),
        };
        let mut subject = subject(&meshes, pieces.as_ref(), labels.as_ref(), pattern, body);
        if let Some(stages) = &asked.cloth {
            subject.cloth = self.cloth(stages, &subject.body)?;
        }
        Ok(subject)
    }

    /// What the garment is made of and lies on; why that is not known.
    fn cloth(
        &mut self,
        stages: &ClothStages,
        body: &Result<WearerBody, String>,
    ) -> Result<Result<KnownCloth, String>, StageError> {
        let cx = Context::quiet();
        let fabric = made::<Fabric>(stages.fabric.as_ref(), Vec::new(), &cx)?;
        let wearer = match body {
            Ok(WearerBody { closed: Err(why), .. }) | Err(why) => return Ok(Err(why.clone())),
            Ok(wearer) => wearer,
        };
        let collider = made::<Collider>(stages.collider.as_ref(), vec![one(wearer.body.clone())], &cx)?;
        let told = cx.take_remarks();
        self.notes.extend(told.warnings.into_iter().chain(told.notes));
        Ok(Ok(KnownCloth { fabric, collider: collider.as_ref().clone() }))
    }

    /// The axis that is up in a garment's file: z where its openings face forwards otherwise.
    fn up(&mut self, meshes: &FileMeshes, bytes: &[u8], path: &Path) -> Up {
        if bytes.starts_with(b"glTF") || !meshes.lies {
            return Up::Y;
        }
        let file = path.display();
        self.notes.push(format!("\"{file}\": its z axis is taken as up; `--up y` says otherwise"));
        Up::Z
    }

    /// The panels' names beside a garment's file.
    fn labels(&mut self, garment: &Path) -> Result<Option<(String, Segmentation)>, StageError> {
        let Some(path) = segmentation::beside(garment) else { return Ok(None) };
        let bytes = self.bytes("segmentation", &path)?;
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        Ok(Some((name, Segmentation::of(&String::from_utf8_lossy(&bytes)))))
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
    labels: Option<&(String, Segmentation)>,
    pattern: Option<&Pattern>,
    body: Result<WearerBody, String>,
) -> Subject {
    let mut faults = Vec::new();
    let (lines, vertices) = (labels.map_or(0, |l| l.1.0.len()), meshes.positions.len());
    let fitting = labels.filter(|_| lines == vertices).map(|l| &l.1);
    if let (Some((file, _)), None) = (labels, fitting) {
        faults.push(format!("\"{file}\" has {lines} lines for {vertices} vertices"));
    }
    let of_pieces = pieces.and_then(|p| flat::garment_of_pieces(meshes, p).map_err(|e| faults.push(e)).ok());
    let (garment, flat) = match of_pieces {
        Some(garment) => (garment, Ok(())),
        None => cut::garment(meshes, fitting, pattern),
    };
    let seams = match (pieces, garment.seams.is_empty()) {
        (_, false) => Ok(()),
        (Some(_), true) => Err(format!(
            "\"{FILE}\" has no seams: run the pipeline again, or name the pattern with `--pattern`"
        )),
        (None, true) => Err("no pattern was given: name one with `--pattern`".to_owned()),
    };
    let cloth = Err(NO_CLOTH.to_owned());
    Subject { garment, flat, seams, pattern: pattern.cloned(), body, cloth, faults }
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
