//! A garment from a binary glTF file (GLB).
//!
//! Every triangle primitive of every node of the scene is read where the node puts it; a node's mesh is a group, line primitives mark seams.
//! Limits: everything must stand in the one file, without sparse accessors; of animated or skinned meshes the shape at rest is read.

use super::raw::{NO_POINT, RawMesh};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::{Mode, Primitive, Semantic};
use nalgebra::Matrix4;
use toile_core::prelude::*;

/// Nodes may be nested so deep.
const DEEPEST: usize = 64;
/// Most vertices, all meshes together.
const MOST: usize = 4_000_000;
/// Most items of one list: the corners of twice as many triangles.
const MOST_ITEMS: usize = 6 * MOST;
/// Most bytes from one item to the next: more than the format allows.
const MOST_STRIDE: usize = 1 << 12;
/// Coordinates reach this far, in the file's unit.
const FARTHEST: f64 = 1e7;

/// The mesh of a file's bytes, in its own unit and axes.
pub(super) fn read_glb(bytes: &[u8], file: &str) -> Result<RawMesh, StageError> {
    let damaged = |what: String| {
        StageError::new(ErrorCode::PatternLoading, format!("\"{file}\": {what}"))
            .hint("write it again as one .glb file with its buffers in it, or as OBJ")
            .at("file")
    };
    let unsound = |e: gltf::Error| damaged(format!("it is no sound GLB ({e})"));
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes).map_err(unsound)?;
    names_what_it_holds(unchecked.as_json()).map_err(damaged)?;
    let gltf = gltf::Gltf::from_slice(bytes).map_err(unsound)?;
    let blob = gltf.blob.as_deref();
    let mut reader = Reader { blob, raw: RawMesh::default() };
    reader.raw.material_names =
        gltf.materials().map(|m| m.name().unwrap_or_default().to_owned()).chain([String::new()]).collect();
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let nodes = scene.ok_or_else(|| damaged("it holds no scene".to_owned()))?;
    for node in nodes.nodes() {
        reader.node(&node, &Matrix4::identity(), 0).map_err(damaged)?;
    }
    if reader.raw.triangles.is_empty() {
        return Err(damaged("it holds no triangles".to_owned()));
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

struct Reader<'a> {
    blob: Option<&'a [u8]>,
    raw: RawMesh,
}

impl Reader<'_> {
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
        let blob = self.blob;
        let wanted = [
            (primitive.get(&Semantic::Positions), &[DataType::F32][..], Dimensions::Vec3),
            (primitive.indices(), &[DataType::U8, DataType::U16, DataType::U32][..], Dimensions::Scalar),
            (
                primitive.get(&Semantic::TexCoords(0)),
                &[DataType::U8, DataType::U16, DataType::F32][..],
                Dimensions::Vec2,
            ),
        ];
        for (accessor, types, dimensions) in wanted {
            accessor.map_or(Ok(()), |a| is_sound(&a, types, dimensions))?;
        }
        let reader = primitive.reader(|buffer| match buffer.source() {
            gltf::buffer::Source::Bin => blob,
            gltf::buffer::Source::Uri(_) => None,
        });
        let places = reader.read_positions().ok_or("a mesh has no positions in the file")?;
        let first = self.raw.positions.len();
        for p in places {
            let p = here.transform_point(&Point3::from(p.map(f64::from)));
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
        let indices: Vec<u32> =
            reader.read_indices().map_or_else(|| (0..count as u32).collect(), |i| i.into_u32().collect());
        if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
            return Err(format!("a triangle names vertex {i}, the mesh has {count}"));
        }
        let first_uv = self.raw.uv.len() as u32;
        let uv: Vec<Point2> = reader.read_tex_coords(0).map_or_else(Vec::new, |t| {
            t.into_f32().map(|[u, v]| Point2::new(f64::from(u), -f64::from(v))).collect()
        });
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
        self.raw.lines.extend(lines(primitive.mode(), &indices).into_iter().map(|l| l.map(global)));
        Ok(())
    }
}

/// Refuses a list of numbers on which the library would panic: it takes types, counts and strides for what they should be.
fn is_sound(accessor: &gltf::Accessor<'_>, types: &[DataType], dimensions: Dimensions) -> Result<(), String> {
    let bad = |what: &str| Err(format!("accessor {} {what}", accessor.index()));
    if !types.contains(&accessor.data_type()) || accessor.dimensions() != dimensions {
        return bad("holds numbers of another kind than its mesh needs");
    }
    if accessor.sparse().is_some() {
        return bad("is sparse, which is not read");
    }
    let Some(view) = accessor.view() else { return bad("names no part of the file") };
    if !(1..=MOST_ITEMS).contains(&accessor.count()) {
        return bad(&format!("holds {} items, not 1 to {MOST_ITEMS}", accessor.count()));
    }
    let reaches = |offset: usize| offset <= view.buffer().length();
    let is_stride = |s: usize| (accessor.size()..=MOST_STRIDE).contains(&s);
    if !view.stride().is_none_or(is_stride) || !reaches(accessor.offset()) || !reaches(view.offset()) {
        return bad("lies outside its part of the file");
    }
    Ok(())
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
