//! A garment from a binary glTF file (GLB).
//!
//! Every triangle primitive of every node of the scene is read where the node puts it; a node's
//! mesh is a group, line primitives mark seams. Limits: everything must stand in the one file,
//! without compression and sparse accessors; of animated or skinned meshes the shape at rest is
//! read.

use super::accessor::{CORNERS, MOST, PLACES, TEXTURE, is_sound, numbers};
use super::extensions::{geometry_only, unread};
use super::raw::{NO_POINT, RawMesh};
use gltf::mesh::{Mode, Primitive, Semantic};
use nalgebra::Matrix4;
use serde_json::Value;
use toile_core::prelude::*;

/// Nodes may be nested so deep.
const DEEPEST: usize = 64;
/// Coordinates reach this far, in the file's unit.
const FARTHEST: f64 = 1e7;
/// What this program's own files say that they were made by.
const OURS: &str = "toile ";

/// What is wrong with a file, and what to do about it.
struct FileFault {
    what: String,
    remedy: &'static str,
}

impl From<String> for FileFault {
    fn from(what: String) -> Self {
        Self { what, remedy: "write it again as one .glb file with its buffers in it, or as OBJ" }
    }
}

impl From<gltf::Error> for FileFault {
    fn from(e: gltf::Error) -> Self {
        format!("it is no sound GLB ({e})").into()
    }
}

/// The mesh of a file's bytes, in its own unit and axes.
pub(in crate::flat) fn read_glb(bytes: &[u8], file: &str) -> Result<RawMesh, StageError> {
    read(bytes).map_err(|FileFault { what, remedy }| {
        StageError::new(ErrorCode::PatternLoading, format!("\"{file}\": {what}")).hint(remedy).at("file")
    })
}

fn read(bytes: &[u8]) -> Result<RawMesh, FileFault> {
    let glb = gltf::Glb::from_slice(bytes)?;
    let no_json = |e: serde_json::Error| FileFault::from(format!("it is no sound GLB (its JSON: {e})"));
    let mut root: Value = serde_json::from_slice(&glb.json).map_err(no_json)?;
    if let Some((what, remedy)) = unread(&root) {
        return Err(FileFault { what, remedy });
    }
    let generator = root.pointer("/asset/generator").and_then(Value::as_str).unwrap_or_default();
    let is_ours = generator.starts_with(OURS);
    geometry_only(&mut root);
    let root: gltf::json::Root = serde_json::from_value(root).map_err(no_json)?;
    names_what_it_holds(&root)?;
    let document = gltf::Document::from_json(root)?;
    let raw = RawMesh { is_ours, has_own_vertices: true, ..RawMesh::default() };
    let mut reader = GlbReader { blob: glb.bin.as_deref(), raw, bare: 0 };
    reader.raw.material_names = document
        .materials()
        .map(|m| m.name().unwrap_or_default().to_owned())
        .chain([String::new()])
        .collect();
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let nodes = scene.ok_or_else(|| "it holds no scene".to_owned())?;
    for node in nodes.nodes() {
        reader.node(&node, &Matrix4::identity(), 0)?;
    }
    if reader.raw.triangles.is_empty() {
        let what = match (reader.bare, reader.raw.lines.len()) {
            (0, 0) => "it holds no triangles".to_owned(),
            (points, 0) => format!("it holds {points} points and no triangles"),
            (_, lines) => format!("it holds {lines} lines and no triangles"),
        };
        return Err(FileFault { what, remedy: "export the garment as a mesh with faces" });
    }
    Ok(reader.raw)
}

/// The library's own check looks into the list of accessors before it knows how long that is.
fn names_what_it_holds(root: &gltf::json::Root) -> Result<(), String> {
    let named = root.meshes.iter().flat_map(|m| &m.primitives).flat_map(|p| p.attributes.values());
    let held = root.accessors.len();
    match named.map(|i| i.value()).find(|i| *i >= held) {
        Some(i) => Err(format!("a mesh names accessor {i}, the file has {held}")),
        None => Ok(()),
    }
}

struct GlbReader<'a> {
    blob: Option<&'a [u8]>,
    raw: RawMesh,
    /// Vertices of primitives that are points.
    bare: usize,
}

impl GlbReader<'_> {
    fn node(&mut self, node: &gltf::Node<'_>, above: &Matrix4<f64>, depth: usize) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(format!("its nodes are nested deeper than {DEEPEST}"));
        }
        let local = node.transform().matrix();
        let here = above * Matrix4::from_fn(|r, c| f64::from(local[c][r]));
        if let Some(mesh) = node.mesh() {
            let group = self.raw.group_names.len() as u32;
            self.raw.group_names.push(node.name().or(mesh.name()).unwrap_or_default().to_owned());
            for primitive in mesh.primitives() {
                self.primitive(&primitive, &here, group)?;
            }
        }
        node.children().try_for_each(|child| self.node(&child, &here, depth + 1))
    }

    fn primitive(
        &mut self,
        primitive: &Primitive<'_>,
        here: &Matrix4<f64>,
        group: u32,
    ) -> Result<(), String> {
        let (corners, texture) = (primitive.indices(), primitive.get(&Semantic::TexCoords(0)));
        let places = primitive.get(&Semantic::Positions).ok_or("a mesh has no positions in the file")?;
        let wanted = [(Some(&places), PLACES), (corners.as_ref(), CORNERS), (texture.as_ref(), TEXTURE)];
        wanted.iter().try_for_each(|(list, wanted)| list.map_or(Ok(()), |a| is_sound(a, wanted)))?;
        let first = self.raw.positions.len();
        for p in numbers::<3>(&places, self.blob)? {
            let p = here.transform_point(&Point3::from(p));
            if !p.iter().all(|x| x.abs() <= FARTHEST) {
                return Err(format!(
                    "vertex {} is not between -1e7 and 1e7",
                    self.raw.positions.len() - first
                ));
            }
            self.raw.positions.push(p);
        }
        let count = self.raw.positions.len() - first;
        if self.raw.positions.len() > MOST {
            return Err(format!("it has more than {MOST} vertices; make the mesh coarser"));
        }
        let indices: Vec<u32> = match &corners {
            Some(corners) => numbers::<1>(corners, self.blob)?.into_iter().map(|[i]| i as u32).collect(),
            None => (0..count as u32).collect(),
        };
        if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
            return Err(format!("a triangle names vertex {i}, the mesh has {count}"));
        }
        let first_uv = self.raw.uv.len() as u32;
        let uv: Vec<Point2> = match &texture {
            Some(texture) => {
                numbers::<2>(texture, self.blob)?.into_iter().map(|[u, v]| Point2::new(u, -v)).collect()
            }
            None => Vec::new(),
        };
        let has_uv = uv.len() == count && uv.iter().all(|p| p.x.is_finite() && p.y.is_finite());
        if has_uv {
            self.raw.uv.extend(uv);
        }
        let material = primitive.material().index().unwrap_or(self.raw.material_names.len() - 1);
        let global = |i: u32| i + first as u32;
        for t in triangles(primitive.mode(), &indices) {
            self.raw.triangles.push(t.map(global));
            self.raw.corners.push(if has_uv { t.map(|i| i + first_uv) } else { [NO_POINT; 3] });
            self.raw.groups.push(group);
            self.raw.materials.push(material as u32);
        }
        self.bare += if primitive.mode() == Mode::Points { count } else { 0 };
        self.raw.lines.extend(lines(primitive.mode(), &indices).into_iter().map(|l| l.map(global)));
        Ok(())
    }
}

/// The triangles of a primitive's indices.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        Mode::TriangleStrip => {
            let turned =
                |(k, w): (usize, &[u32])| if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            indices.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => {
            let Some((&hub, rim)) = indices.split_first() else { return Vec::new() };
            rim.windows(2).map(|w| [hub, w[0], w[1]]).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}

/// The marked edges of a primitive's indices.
fn lines(mode: Mode, indices: &[u32]) -> Vec<[u32; 2]> {
    match mode {
        Mode::Lines => indices.chunks_exact(2).map(|l| [l[0], l[1]]).collect(),
        Mode::LineStrip => indices.windows(2).map(|l| [l[0], l[1]]).collect(),
        Mode::LineLoop => {
            let closing = indices.first().zip(indices.last()).map(|(a, b)| [*b, *a]);
            indices.windows(2).map(|l| [l[0], l[1]]).chain(closing).collect()
        }
        Mode::Points | Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => Vec::new(),
    }
}
