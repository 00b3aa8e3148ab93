//! What is judged: a garment, and what is known beside it.

use nalgebra::Vector3;
use std::collections::HashMap;
use std::sync::Arc;
use toile_core::artifact::{
    Body, Collider, Curve, Fabric, Garment, GarmentPanel, Pattern, Point2, Point3, SolveStatus, join_pairs,
};

/// Vertices that a seam joins are one within this, metres.
const JOINED: f64 = 1e-5;

/// A garment, and what is known beside it. A `Err` says why something is not known, in the words of
/// the certificate.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The garment: each panel has vertices of its own, and those at one place have one `weld`.
    pub garment: Garment,
    /// Whether `rest` of the garment's vertices is its flat shape.
    pub flat: Result<(), String>,
    /// Whether the garment's seams are all that there are.
    pub seams: Result<(), String>,
    /// The pattern.
    pub pattern: Option<Pattern>,
    /// The body.
    pub body: Result<WearerBody, String>,
    /// What it is made of and lies on.
    pub cloth: Result<KnownCloth, String>,
    /// What is wrong between the files, a sentence each: each is a failure.
    pub faults: Vec<String>,
}

/// The body, and what of it is known.
#[derive(Debug, Clone)]
pub struct WearerBody {
    /// The mesh; its landmarks are empty where they could not be found.
    pub body: Body,
    /// Whether inside and outside can be distinguished.
    pub closed: Result<(), String>,
    /// Whether it has landmarks and girths.
    pub measured: Result<(), String>,
}

/// What a garment is made of, and what it lies on.
#[derive(Debug, Clone)]
pub struct KnownCloth {
    /// Its fabric.
    pub fabric: Arc<Fabric>,
    /// Its body, with friction.
    pub collider: Collider,
}

/// One panel's triangles in a file.
#[derive(Debug, Clone)]
pub struct PanelTriangles {
    /// Its name.
    pub name: String,
    /// Corners by the file's vertices.
    pub triangles: Vec<[u32; 3]>,
    /// Flat corners, metres; empty where they are not known.
    pub flat: Vec<[Point2; 3]>,
}

/// The garment of panels cut from a file's mesh: a vertex of a panel is a vertex of the file at one
/// flat place.
#[must_use]
pub fn garment_of(positions: &[Point3], cuts: &[PanelTriangles]) -> Garment {
    let mut garment = bare();
    let fabric = Arc::new(unknown_fabric());
    for cut in cuts {
        let (v, t) = (garment.positions.len(), garment.triangles.len());
        let mut known: HashMap<(u32, [u64; 2]), u32> = HashMap::new();
        for (k, corners) in cut.triangles.iter().enumerate() {
            let flat = cut.flat.get(k).copied().unwrap_or([Point2::origin(); 3]);
            let own = [0, 1, 2].map(|c| {
                let key = (corners[c], [flat[c].x, flat[c].y].map(|x| (x + 0.0).to_bits()));
                *known.entry(key).or_insert_with(|| {
                    garment.positions.push(positions[corners[c] as usize]);
                    garment.rest.push(flat[c]);
                    garment.positions.len() as u32 - 1
                })
            });
            garment.triangles.push(own);
        }
        let (vertices, triangles) = (v..garment.positions.len(), t..garment.triangles.len());
        garment.panels.push(panel(&cut.name, vertices, triangles, &fabric));
    }
    finished(garment)
}

/// A garment without anything.
pub(crate) fn bare() -> Garment {
    Garment {
        positions: Vec::new(),
        velocities: Vec::new(),
        rest: Vec::new(),
        triangles: Vec::new(),
        panels: Vec::new(),
        seams: Vec::new(),
        weld: Vec::new(),
        pinned: Vec::new(),
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
    }
}

pub(crate) fn panel(
    name: &str,
    vertices: std::ops::Range<usize>,
    triangles: std::ops::Range<usize>,
    fabric: &Arc<Fabric>,
) -> GarmentPanel {
    let (name, fabric) = (name.to_owned(), fabric.clone());
    GarmentPanel { name, vertices, triangles, boundary: Vec::new(), photo_px: Vec::new(), fabric, layer: 0 }
}

/// The garment with boundaries and joined vertices, as they follow from its positions and
/// triangles.
pub(crate) fn finished(mut garment: Garment) -> Garment {
    garment.velocities = vec![Vector3::zeros(); garment.positions.len()];
    for k in 0..garment.panels.len() {
        garment.panels[k].boundary = crate::loops::outer(&garment, k);
    }
    garment.weld = joined(&garment);
    garment
}

/// For every vertex the least that it is joined to: those at the very same place, and those of a
/// seam within a hundredth of a millimetre.
fn joined(garment: &Garment) -> Vec<u32> {
    let mut first: HashMap<[u64; 3], u32> = HashMap::with_capacity(garment.positions.len());
    let least = |(v, p): (usize, &Point3)| {
        // Adding zero turns -0 into 0, which stands in the same place.
        *first.entry([p.x, p.y, p.z].map(|c| (c + 0.0).to_bits())).or_insert(v as u32)
    };
    let mut weld: Vec<u32> = garment.positions.iter().enumerate().map(least).collect();
    let near = |[a, b]: &&[u32; 2]| {
        (garment.positions[*a as usize] - garment.positions[*b as usize]).norm() <= JOINED
    };
    join_pairs(&mut weld, garment.seams.iter().flat_map(|s| &s.pairs).filter(near));
    weld
}

/// A fabric of which nothing is known: panels must name one.
pub(crate) fn unknown_fabric() -> Fabric {
    Fabric {
        name: "unknown".into(),
        area_density: 0.1,
        warp: Curve::linear(1.0),
        weft: Curve::linear(1.0),
        shear: Curve::linear(1.0),
        bending_warp: 0.0,
        bending_weft: 0.0,
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 1e-4,
        friction: 0.0,
        damping: 0.0,
        source: "none".into(),
    }
}
