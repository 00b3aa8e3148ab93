//! Garments and bodies as flat arrays behind a head in JSON.
//!
//! `TOILEG1\0`, the head's length (u32), the head, zero bytes up to a multiple of 4, then the
//! arrays, little endian. The head says where each lies, from the start of the file.

use super::of_panel;
use crate::live::shown::ShownArtifacts;
use serde_json::{Map, Value, json};
use toile_core::artifact::{Body, Collider, Garment, GarmentPanel, Model, Point3};
use toile_geometry::cloth_tree::ClothTree;
use toile_output::fit::pressures;

const MAGIC: &[u8; 8] = b"TOILEG1\0";

/// Sewn vertices farther apart than this are an open seam, metres.
const OPEN: f64 = 2e-3;

/// Distances from the body are told up to this, metres.
const FAR: f64 = 0.25;

/// Colours of panels that are told apart.
const COLOURS: [[u8; 3]; 8] = [
    [96, 134, 173],
    [196, 140, 96],
    [112, 158, 118],
    [178, 112, 128],
    [142, 126, 178],
    [176, 164, 96],
    [96, 160, 164],
    [150, 150, 150],
];

/// An array of the file.
struct MeshArray {
    name: &'static str,
    kind: &'static str,
    bytes: Vec<u8>,
}

impl MeshArray {
    fn floats(name: &'static str, values: impl Iterator<Item = f64>) -> Self {
        let bytes = values.flat_map(|v| (v as f32).to_le_bytes()).collect();
        MeshArray { name, kind: "f32", bytes }
    }

    fn indices(name: &'static str, values: impl Iterator<Item = u32>) -> Self {
        MeshArray { name, kind: "u32", bytes: values.flat_map(u32::to_le_bytes).collect() }
    }
}

/// The garment that is shown, with its textures' coordinates.
pub(crate) fn garment(garment: &Garment, shown: &ShownArtifacts) -> Vec<u8> {
    let model = shown.model.as_deref();
    let dressed: Vec<PanelLook> = garment.panels.iter().map(|p| PanelLook::of(p, shown, model)).collect();
    let panel = |((k, p), look): ((usize, &GarmentPanel), &PanelLook)| {
        json!({
            "name": p.name,
            "photo": look.photo,
            "texture": look.texture,
            "first_vertex": p.vertices.start,
            "vertices": p.vertices.len(),
            "first_triangle": p.triangles.start,
            "triangles": p.triangles.len(),
            "colour": COLOURS[k % COLOURS.len()],
        })
    };
    let pixels = garment.panels.iter().flat_map(|p| {
        let none = if p.photo_px.is_empty() { p.vertices.len() } else { 0 };
        p.photo_px.iter().flat_map(|px| [px.x, px.y]).chain(std::iter::repeat_n(f64::NAN, 2 * none))
    });
    let mut arrays = vec![
        positions(&garment.positions),
        MeshArray::indices("triangles", garment.triangles.iter().flatten().copied()),
        MeshArray::floats("flat", garment.rest.iter().flat_map(|p| [p.x, p.y])),
        MeshArray::floats("photo_px", pixels),
        MeshArray::floats("uv", dressed.iter().flat_map(|look| look.uv.iter().flatten().copied())),
        MeshArray::floats("strain", strains(garment).into_iter()),
    ];
    if let Some(collider) = shown.collider.as_deref().filter(|_| garment.status.converged) {
        arrays.push(MeshArray::floats("distance", distances(garment, collider).into_iter()));
        if let Ok(pressures) = pressures(garment, collider) {
            arrays.push(MeshArray::floats("pressure", pressures.into_iter().map(|p| p.unwrap_or(0.0))));
        }
    }
    let mut head = Map::new();
    head.insert("vertices".into(), json!(garment.positions.len()));
    head.insert("triangles".into(), json!(garment.triangles.len()));
    let panels = garment.panels.iter().enumerate().zip(&dressed).map(panel);
    head.insert("panels".into(), panels.collect());
    head.insert("open_seams".into(), json!(open_seams(garment)));
    head.insert("crossings".into(), json!(crossings(garment)));
    packed(head, &arrays)
}

/// Places of vertices by themselves.
pub(crate) fn places(of: &[Point3]) -> Vec<u8> {
    let mut head = Map::new();
    head.insert("vertices".into(), json!(of.len()));
    packed(head, &[positions(of)])
}

/// A body.
pub(crate) fn body(body: &Body) -> Vec<u8> {
    let arrays = vec![
        positions(&body.positions),
        MeshArray::indices("triangles", body.triangles.iter().flatten().copied()),
    ];
    let mut head = Map::new();
    head.insert("vertices".into(), json!(body.positions.len()));
    head.insert("triangles".into(), json!(body.triangles.len()));
    packed(head, &arrays)
}

fn positions(of: &[Point3]) -> MeshArray {
    MeshArray::floats("positions", of.iter().flat_map(|p| [p.x, p.y, p.z]))
}

/// How a panel is dressed.
struct PanelLook {
    photo: Option<String>,
    /// The number of its texture.
    texture: Option<usize>,
    /// One a vertex; not a number where it has no texture.
    uv: Vec<[f64; 2]>,
}

impl PanelLook {
    /// By the model where it is there and has this panel's vertices, else by its photo.
    fn of(panel: &GarmentPanel, shown: &ShownArtifacts, model: Option<&Model>) -> Self {
        let photo = of_panel(&shown.photos, &panel.name).filter(|_| !panel.photo_px.is_empty());
        let name = photo.map(|(name, _)| name.to_owned());
        let plain = || vec![[f64::NAN; 2]; panel.vertices.len()];
        if let Some(model) = model {
            let fits = |m: &&toile_core::artifact::Mesh| {
                m.name == panel.name
                    && m.positions.len() == panel.vertices.len()
                    && m.uv.len() == m.positions.len()
            };
            let mesh = model.meshes.iter().find(fits);
            let texture = mesh.and_then(|m| model.materials.get(m.material)?.texture);
            let uv = mesh.map_or_else(plain, |m| m.uv.iter().map(|uv| uv.map(f64::from)).collect());
            return PanelLook { photo: name, texture, uv };
        }
        let Some((of, photo)) = photo else { return PanelLook { photo: None, texture: None, uv: plain() } };
        let (width, height) = photo.pixels.dimensions();
        let size = [width, height].map(|n| f64::from(n * photo.joined));
        let uv = panel.photo_px.iter().map(|px| [(px.x + 0.5) / size[0], (px.y + 0.5) / size[1]]).collect();
        PanelLook { photo: name, texture: shown.photos.keys().position(|name| name == of), uv }
    }
}

/// The largest principal strain at each vertex: the mean over its triangles.
fn strains(garment: &Garment) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); garment.positions.len()];
    for (t, stretch) in garment.triangles.iter().zip(garment.stretches()) {
        for &v in t {
            let (sum, count) = &mut sums[v as usize];
            *sum += stretch - 1.0;
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { 0.0 }).collect()
}

/// How far each vertex is from the skin, metres; [`FAR`] at most.
fn distances(garment: &Garment, collider: &Collider) -> Vec<f64> {
    let mut near = Vec::new();
    collider.scheme.body_contacts(&garment.positions, FAR, &mut near);
    let mut all = vec![FAR; garment.positions.len()];
    near.iter().for_each(|contact| all[contact.vertex as usize] = contact.distance);
    all
}

fn open_seams(garment: &Garment) -> Vec<[u32; 2]> {
    let apart =
        |&[a, b]: &[u32; 2]| (garment.positions[a as usize] - garment.positions[b as usize]).norm() > OPEN;
    garment.seams.iter().flat_map(|s| &s.pairs).copied().filter(apart).collect()
}

/// Triangles that cross others.
fn crossings(garment: &Garment) -> Vec<u32> {
    let welded: Vec<[u32; 3]> =
        garment.triangles.iter().map(|t| t.map(|i| garment.weld[i as usize])).collect();
    let places: Vec<toile_geometry::Vec3> = garment.positions.iter().map(|p| p.coords).collect();
    let pairs = ClothTree::new(&welded, &places).exact_crossings(&places);
    let mut all: Vec<u32> = pairs.into_iter().flatten().collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Head and arrays as one file.
fn packed(mut head: Map<String, Value>, arrays: &[MeshArray]) -> Vec<u8> {
    // Offsets stand in the head, whose length they change.
    let (mut from, mut text) = (0, Vec::new());
    loop {
        let mut offset = from;
        let mut places = Map::new();
        for array in arrays {
            let count = array.bytes.len() / 4;
            places.insert(array.name.into(), json!({ "offset": offset, "count": count, "type": array.kind }));
            offset += array.bytes.len();
        }
        head.insert("arrays".into(), Value::Object(places));
        text = serde_json::to_vec(&head).unwrap_or(text);
        let start = (MAGIC.len() + 4 + text.len()).next_multiple_of(4);
        if start == from {
            break;
        }
        from = start;
    }
    let mut file = Vec::with_capacity(from + arrays.iter().map(|a| a.bytes.len()).sum::<usize>());
    file.extend_from_slice(MAGIC);
    file.extend_from_slice(&(text.len() as u32).to_le_bytes());
    file.extend_from_slice(&text);
    file.resize(from, 0);
    arrays.iter().for_each(|a| file.extend_from_slice(&a.bytes));
    file
}
