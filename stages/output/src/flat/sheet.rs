//! A garment as pieces of a surface, and pieces as a garment.
//!
//! A garment's panels become pieces of one mesh whose vertices are the garment's nodes: cut where
//! panels meet, and within a panel where its own sides are sewn to each other. The way back makes a
//! garment of such pieces, each with its flat shape. Cost: two sorts of the edges.

use super::fault::surface_fault;
use super::file::of_corners;
use nalgebra::Matrix2;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::prelude::*;
use toile_flatten::islands::{Chain, SurfacePieces, SurfaceSeam, islands_by_labels};

/// Pieces that know the garment that they came from.
#[derive(Debug, Clone)]
pub(super) struct GarmentPieces {
    /// The pieces; their vertices are nodes: the least of the garment's vertices that are joined.
    pub(super) pieces: SurfacePieces,
    /// For each piece its name, unlike all others.
    pub(super) names: Vec<String>,
    /// For each piece the garment's panel.
    pub(super) panels: Vec<usize>,
    /// For each vertex of each piece the garment's vertex.
    pub(super) vertices: Vec<Vec<u32>>,
}

/// The mesh of a garment with a label for each half-edge.
pub(super) struct Labelled {
    places: Vec<Point3>,
    nodes: Vec<[u32; 3]>,
    labels: Vec<[u32; 2]>,
}

impl Labelled {
    /// A garment, cut where its panels were cut.
    pub(super) fn of(garment: &Garment) -> Result<Self, StageError> {
        if garment.triangles.is_empty() {
            return Err(StageError::invalid("the garment is empty: it has no triangles")
                .hint("see what the stages before made of it"));
        }
        let n = garment.positions.len();
        if garment.weld.len() != n || garment.triangles.iter().flatten().any(|&v| v as usize >= n) {
            return Err(StageError::internal("the garment names a vertex that it does not have"));
        }
        let nodes: Vec<_> = garment.triangles.iter().map(|t| t.map(|v| garment.weld[v as usize])).collect();
        let labels = of_corners(&nodes, &garment.triangles);
        Ok(Self { places: garment.positions.clone(), nodes, labels })
    }

    /// Cuts along edges of some triangles as well.
    pub(super) fn cut_along(&mut self, triangles: &[u32], edges: &[[u32; 2]]) {
        let sorted: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        for h in triangles.iter().flat_map(|t| 3 * t..3 * t + 3) {
            let (t, k) = (self.nodes[h as usize / 3], h as usize % 3);
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if sorted.contains(&[a.min(b), a.max(b)]) {
                self.labels[h as usize] = [h, u32::MAX];
            }
        }
    }

    /// The pieces.
    pub(super) fn sheet(&self, garment: &Garment) -> Result<GarmentPieces, StageError> {
        let pieces =
            islands_by_labels(&self.places, &self.nodes, &self.labels).map_err(|e| surface_fault(e, &[]))?;
        let panel_of = |t: u32| garment.panels.iter().position(|p| p.triangles.contains(&(t as usize)));
        let panels: Vec<usize> = pieces
            .pieces
            .iter()
            .map(|p| p.triangles.first().and_then(|&t| panel_of(t)).unwrap_or(0))
            .collect();
        let name = |p: &usize| garment.panels.get(*p).map_or("", |p| p.name.as_str());
        let names = unlike(panels.iter().map(name));
        let vertices = pieces.pieces.iter().map(|p| {
            let mut of = vec![0; p.vertices.len()];
            for (&t, corners) in p.triangles.iter().zip(p.surface.triangles()) {
                let own = garment.triangles[t as usize];
                for &v in corners {
                    let is_it = |u: &&u32| garment.weld[**u as usize] == p.vertices[v as usize];
                    of[v as usize] = own.iter().find(is_it).copied().unwrap_or(own[0]);
                }
            }
            of
        });
        let vertices = vertices.collect();
        let mut sheet = GarmentPieces { pieces, names, panels, vertices };
        sheet.let_gathers_out(garment);
        Ok(sheet)
    }
}

impl GarmentPieces {
    /// Triangles along gathered seams get the shape in which they were cut, strained as the
    /// gathered ones are.
    fn let_gathers_out(&mut self, garment: &Garment) {
        let Some(gathered) = garment.gathered_corners() else { return };
        for (piece, of) in self.pieces.pieces.iter_mut().zip(&self.vertices) {
            let mut shapes = Vec::new();
            for (j, (&t, corners)) in piece.triangles.iter().zip(piece.surface.triangles()).enumerate() {
                let own = garment.triangles[t as usize];
                let place = |v: u32| own.iter().position(|u| *u == of[v as usize]).unwrap_or(0);
                let drawn = corners.map(|v| gathered[t as usize][place(v)]);
                let cut = corners.map(|v| garment.rest[of[v as usize] as usize]);
                if drawn != cut {
                    let places = corners.map(|v| piece.surface.positions()[v as usize]);
                    shapes.extend(let_out(places, drawn, cut).map(|edges| (j as u32, edges)));
                }
            }
            if let Ok(surface) = piece.surface.clone().with_cut_shapes(shapes) {
                piece.surface = surface;
            }
        }
    }

    /// The pieces without the seams whose sides were cut to unlike lengths.
    pub(super) fn without_gathers(&self, garment: &Garment) -> SurfacePieces {
        let known = self.known_seams(garment);
        let is_even = |k: &Option<usize>| k.is_none_or(|k| garment.seams[k].kind != SeamKind::Gathered);
        let even = self.pieces.seams.iter().zip(&known).filter(|(_, k)| is_even(k));
        SurfacePieces { pieces: self.pieces.pieces.clone(), seams: even.map(|(s, _)| s.clone()).collect() }
    }

    /// The sheet of a garment as it was cut.
    pub(super) fn of(garment: &Garment) -> Result<Self, StageError> {
        Labelled::of(garment)?.sheet(garment)
    }

    /// The flat places of the garment, by pieces.
    pub(super) fn rest(&self, garment: &Garment) -> Vec<Vec<Point2>> {
        self.vertices.iter().map(|of| of.iter().map(|&v| garment.rest[v as usize]).collect()).collect()
    }

    /// The garment of these pieces with these flat places; what is not of places stays as it was.
    pub(super) fn garment(&self, from: &Garment, flat: &[Vec<Point2>]) -> Garment {
        let part = |i: usize| {
            let panel = &from.panels[self.panels[i]];
            let pixel =
                |v: &u32| panel.photo_px.get((*v as usize).wrapping_sub(panel.vertices.start)).copied();
            let photo_px: Option<Vec<Point2>> = self.vertices[i].iter().map(pixel).collect();
            PieceDetails {
                name: self.names[i].clone(),
                fabric: panel.fabric.clone(),
                rest: flat[i].clone(),
                photo_px: photo_px.unwrap_or_default(),
            }
        };
        let parts = (0..self.pieces.pieces.len()).map(part).collect();
        let mut garment = assembled(&self.pieces, parts);
        let sources: Vec<u32> = self.vertices.iter().flatten().copied().collect();
        garment.velocities = sources.iter().map(|&v| from.velocities[v as usize]).collect();
        let pinned = |v: &u32| from.pinned.binary_search(&sources[*v as usize]).is_ok();
        garment.pinned = (0..sources.len() as u32).filter(pinned).collect();
        // Friction refers to vertices by their old numbers.
        garment.status = SolveStatus { held: Held::default(), ..from.status.clone() };
        self.name_seams(from, &mut garment);
        garment
    }

    /// Seams of the garment that it came from keep their names and kinds.
    fn name_seams(&self, from: &Garment, garment: &mut Garment) {
        let known = SeamTable::of(from);
        for (seam, made) in self.pieces.seams.iter().zip(&mut garment.seams) {
            if let Some(k) = known.of_seam(self, seam) {
                made.name.clone_from(&from.seams[k].name);
                made.kind = from.seams[k].kind;
            }
        }
    }

    /// For each seam of the pieces the garment's seam that it is a part of.
    pub(super) fn known_seams(&self, from: &Garment) -> Vec<Option<usize>> {
        let known = SeamTable::of(from);
        self.pieces.seams.iter().map(|s| known.of_seam(self, s)).collect()
    }
}

/// Which seams of a garment join two of its vertices.
struct SeamTable(BTreeMap<[u32; 2], usize>);

impl SeamTable {
    fn of(garment: &Garment) -> Self {
        let pairs = garment.seams.iter().enumerate();
        Self(pairs.flat_map(|(k, s)| s.pairs.iter().map(move |p| (sorted(*p), k))).collect())
    }

    /// The seam that joins most of the vertices; the first of equals.
    fn of_seam(&self, sheet: &GarmentPieces, seam: &SurfaceSeam) -> Option<usize> {
        let vertex = |c: &Chain, i: usize| sheet.vertices[c.piece][c.vertices[i] as usize];
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for i in 0..seam.a.vertices.len().min(seam.b.vertices.len()) {
            let pair = sorted([vertex(&seam.a, i), vertex(&seam.b, i)]);
            self.0.get(&pair).into_iter().for_each(|k| *counts.entry(*k).or_default() += 1);
        }
        counts.into_iter().max_by_key(|(k, n)| (*n, std::cmp::Reverse(*k))).map(|(k, _)| k)
    }
}

/// The edges of a triangle in its plane, with the strain between its drawn corners and its places
/// put on its cut ones.
fn let_out([p, q, r]: [Point3; 3], drawn: [Point2; 3], cut: [Point2; 3]) -> Option<[Vector2; 2]> {
    let x = (q - p).try_normalize(0.0)?;
    let y = (q - p).cross(&(r - p)).try_normalize(0.0)?.cross(&x);
    let now = Matrix2::new((q - p).norm(), (r - p).dot(&x), 0.0, (r - p).dot(&y));
    let sides = |c: [Point2; 3]| Matrix2::from_columns(&[c[1] - c[0], c[2] - c[0]]);
    let out = now * sides(drawn).try_inverse()? * sides(cut);
    Some([out.column(0).into(), out.column(1).into()])
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Names, each unlike all others: a second `sleeve` becomes `sleeve_2`.
pub(super) fn unlike<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Vec<String> {
    let mut taken: std::collections::BTreeSet<String> = names.clone().map(str::to_owned).collect();
    let mut seen = std::collections::BTreeSet::new();
    let fresh = |name: &str| {
        if seen.insert(name.to_owned()) {
            return name.to_owned();
        }
        let mut k = 2;
        while !taken.insert(format!("{name}_{k}")) {
            k += 1;
        }
        format!("{name}_{k}")
    };
    names.map(fresh).collect()
}

/// What a piece is beside its mesh.
pub(super) struct PieceDetails {
    pub(super) name: String,
    pub(super) fabric: Arc<Fabric>,
    /// A flat place a vertex.
    pub(super) rest: Vec<Point2>,
    /// A pixel a vertex, or none at all.
    pub(super) photo_px: Vec<Point2>,
}

/// A garment at rest of pieces; vertices that stand for one are joined, and every seam is closed.
pub(super) fn assembled(pieces: &SurfacePieces, parts: Vec<PieceDetails>) -> Garment {
    let (mut positions, mut rest, mut triangles, mut panels) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut first_of: BTreeMap<u32, u32> = BTreeMap::new();
    let mut weld = Vec::new();
    let mut starts = Vec::with_capacity(parts.len());
    let names: Vec<String> = parts.iter().map(|p| p.name.clone()).collect();
    for (piece, part) in pieces.pieces.iter().zip(parts) {
        let (start, first) = (positions.len() as u32, triangles.len());
        starts.push(start);
        for (k, node) in piece.vertices.iter().enumerate() {
            weld.push(*first_of.entry(*node).or_insert(start + k as u32));
        }
        positions.extend_from_slice(piece.surface.positions());
        rest.extend_from_slice(&part.rest);
        triangles.extend(piece.surface.triangles().iter().map(|t| t.map(|v| v + start)));
        let boundary =
            piece.surface.loops().first().map_or_else(Vec::new, |l| l.iter().map(|v| v + start).collect());
        panels.push(GarmentPanel {
            name: part.name,
            vertices: start as usize..positions.len(),
            triangles: first..triangles.len(),
            boundary,
            photo_px: part.photo_px,
            fabric: part.fabric,
            layer: 0,
        });
    }
    let seam = |s: &SurfaceSeam| GarmentSeam {
        name: format!("{} + {}", names[s.a.piece], names[s.b.piece]),
        kind: SeamKind::Matched,
        pairs: pairs(s, &starts),
        state: SeamState::Closed,
    };
    let seams = pieces.seams.iter().map(seam).collect();
    let velocities = vec![Vector3::zeros(); positions.len()];
    Garment {
        positions,
        velocities,
        rest,
        triangles,
        panels,
        seams,
        weld,
        pinned: Vec::new(),
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
    }
}

fn pairs(seam: &SurfaceSeam, starts: &[u32]) -> Vec<[u32; 2]> {
    let at = |c: &Chain, v: u32| v + starts[c.piece];
    let both = seam.a.vertices.iter().zip(&seam.b.vertices);
    both.map(|(&a, &b)| [at(&seam.a, a), at(&seam.b, b)]).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_gathered_triangle_is_let_out_with_its_strain() {
        let flat = |p: [[f64; 2]; 3]| p.map(Point2::from);
        let (cut, drawn) =
            (flat([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]]), flat([[0.5, 0.0], [1.5, 0.0], [1.0, 1.0]]));
        // On the garment the drawn triangle stands upright, 10 % larger than it was drawn.
        let places = drawn.map(|p| Point3::new(0.0, 1.1 * p.y, -1.1 * p.x));
        let [a, b] = let_out(places, drawn, cut).unwrap();
        assert!(
            (a - Vector2::new(2.2, 0.0)).norm() < 1e-12 && (b - Vector2::new(1.1, 1.1)).norm() < 1e-12,
            "{a} {b}"
        );
        assert_eq!(let_out([places[0]; 3], drawn, cut), None);
    }

    #[test]
    fn names_become_unlike() {
        assert_eq!(unlike(["a", "b", "a", "a_2", "a"].into_iter()), ["a", "b", "a_3", "a_2", "a_4"]);
    }
}
