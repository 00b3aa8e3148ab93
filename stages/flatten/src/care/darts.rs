//! Darts and cuts where a fitted piece strains more than its cloth bears.
//!
//! Again and again, while the strain spread over a neighbourhood passes the limit: from the place
//! of most strain and from that of most curvature the ways to the boundary are tried, down and up
//! the grain and across it (and their mirror images, if the piece is symmetric); each is cut and
//! flattened, and the one that saves most energy is kept, those along the grain counting a quarter
//! more. Ways much longer than the shortest are not tried. Proposals end when the limit is met,
//! when no cut saves enough of what is left, or at the number that is allowed. Cost: up to eight
//! flattenings a dart.

use super::Objective;
use super::dart_path::Ways;
use super::dart_tips::tips;
use super::mirror::{MirrorPair, mirror_pairs};
use crate::distortion::distortion;
use crate::error::{FlattenError, SurfaceError};
use crate::flatteners::{Flattening, Placement};
use crate::islands::{SurfacePiece, SurfacePieces, islands_by_seams};
use crate::newton::{StoppingLimits, chain_length};
use crate::surface::PieceSurface;
use nalgebra::{Point2, Vector2};

/// A proposed cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Dart {
    /// Vertices of the uncut surface from the boundary to the tip, along edges.
    pub path: Vec<u32>,
    /// The share of the piece's energy, before any cut, that this one saves (with its mirror image,
    /// if it has one).
    pub saves: f64,
    /// The largest spread strain before and after this cut.
    pub strain: [f64; 2],
    /// The other cut of a mirrored pair, by its place in the list.
    pub mirror: Option<usize>,
}

/// When to propose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DartOptions {
    /// The strain that the cloth bears, spread over a neighbourhood: 0.015 is 1.5 per cent.
    /// Above 0.
    pub max_strain: f64,
    /// The least share of the energy that is left that a cut must save, above 0, below 1.
    pub least_saving: f64,
    /// Most cuts, 1 or more.
    pub most: usize,
    /// When the solver stops.
    pub newton: StoppingLimits,
}

impl Default for DartOptions {
    fn default() -> Self {
        Self { max_strain: 0.015, least_saving: 0.25, most: 8, newton: StoppingLimits::default() }
    }
}

/// By how much more a saving counts where the cut lies along the grain; in between by the square of
/// the cosine.
const GRAIN_BONUS: f64 = 0.25;

/// A dart is at most so many times as long as the shortest from its tip: one that runs across the
/// piece, through the places where others end, would save the most and could not be sewn.
const MOST_DETOUR: f64 = 2.0;

/// The share of the first energy that a cut saves at least, whatever is left.
const LEAST_OF_FIRST: f64 = 0.01;

/// How exactly a piece must be its own mirror image for its darts to be mirrored, a share of its
/// diagonal.
const SYMMETRIC: f64 = 1e-3;

/// A piece with its cuts so far.
struct CutPiece {
    piece: SurfacePiece,
    flat: Flattening,
}

/// A try: its paths on the uncut surface, what it gives, its energy, and its energy with the bonus.
struct DartCandidate {
    paths: Vec<Vec<u32>>,
    stage: CutPiece,
    rated: f64,
}

/// Proposes darts for one piece.
///
/// # Errors
/// [`FlattenError::InvalidParameter`], and those of the flattener.
pub fn propose_darts(
    surface: &PieceSurface,
    objective: &Objective,
    placement: &Placement,
    options: DartOptions,
) -> Result<Vec<Dart>, FlattenError> {
    options.check()?;
    placement.check(surface)?;
    let search = DartSearch::new(surface, objective, placement, options)?;
    let mut stage = search.stage(&[])?;
    let first = stage.flat.report.energy;
    let (mut darts, mut cuts): (Vec<Dart>, Vec<Vec<u32>>) = (Vec::new(), Vec::new());
    let mut strain = search.strain(&stage)?;
    while strain > options.max_strain && cuts.len() < options.most {
        let Some(best) = search.best(&stage, &cuts)? else { break };
        let saved = stage.flat.report.energy - best.stage.flat.report.energy;
        if saved < options.least_saving * stage.flat.report.energy || saved < LEAST_OF_FIRST * first {
            break;
        }
        let after = search.strain(&best.stage)?;
        let (at, both) = (darts.len(), best.paths.len() == 2);
        for (k, path) in best.paths.into_iter().enumerate() {
            let mirror = both.then_some(at + 1 - k);
            darts.push(Dart { path: path.clone(), saves: saved / first, strain: [strain, after], mirror });
            cuts.push(path);
        }
        (stage, strain) = (best.stage, after);
    }
    Ok(darts)
}

/// Cuts a surface along darts; the piece's vertices and triangles know those of the surface, and
/// its seams are the darts' legs.
///
/// # Errors
/// [`SurfaceError::NoSuchEdge`] if a path leaves the edges, [`SurfaceError::Disconnected`] if the
/// cuts divide the piece.
pub fn cut_darts(surface: &PieceSurface, darts: &[Dart]) -> Result<SurfacePieces, SurfaceError> {
    let paths: Vec<_> = darts.iter().map(|d| d.path.clone()).collect();
    cut(surface, &paths)
}

fn cut(surface: &PieceSurface, paths: &[Vec<u32>]) -> Result<SurfacePieces, SurfaceError> {
    let edges: Vec<[u32; 2]> = paths.iter().flat_map(|p| p.windows(2).map(|w| [w[0], w[1]])).collect();
    let pieces = islands_by_seams(surface.positions(), surface.triangles(), &edges)?;
    match pieces.pieces.get(1) {
        None => Ok(pieces),
        Some(second) => Err(SurfaceError::Disconnected {
            count: pieces.pieces.len(),
            triangle: second.triangles[0] as usize,
        }),
    }
}

impl DartOptions {
    fn check(&self) -> Result<(), FlattenError> {
        let bad = |name, value, range| Err(FlattenError::InvalidParameter { name, value, range });
        if !(self.max_strain > 0.0 && self.max_strain.is_finite()) {
            return bad("max_strain", self.max_strain, "a finite strain above 0");
        }
        if !(self.least_saving > 0.0 && self.least_saving < 1.0) {
            return bad("least_saving", self.least_saving, "a share above 0 and below 1");
        }
        if self.most == 0 {
            return bad("most", 0.0, "1 or more");
        }
        Ok(())
    }
}

struct DartSearch<'a> {
    surface: &'a PieceSurface,
    objective: &'a Objective,
    placement: &'a Placement,
    options: DartOptions,
    mirror: Option<MirrorPair>,
}

impl<'a> DartSearch<'a> {
    fn new(
        surface: &'a PieceSurface,
        objective: &'a Objective,
        placement: &'a Placement,
        options: DartOptions,
    ) -> Result<Self, FlattenError> {
        let whole = cut(surface, &[])?;
        let mirror = mirror_pairs(&whole.pieces, SYMMETRIC).into_iter().next();
        Ok(Self { surface, objective, placement, options, mirror })
    }

    /// Cuts and flattens.
    fn stage(&self, paths: &[Vec<u32>]) -> Result<CutPiece, FlattenError> {
        let mut pieces = cut(self.surface, paths)?;
        let piece = pieces.pieces.swap_remove(0);
        let grain = self.placement.grain.on_piece(&piece.vertices, &piece.triangles);
        let grain = grain.unwrap_or_else(|| self.placement.grain.clone());
        let placement = Placement { grain, ..self.placement.clone() };
        let flat = self.objective.flatten(&piece.surface, self.options.newton, &placement)?;
        Ok(CutPiece { piece, flat })
    }

    fn strain(&self, stage: &CutPiece) -> Result<f64, FlattenError> {
        let table = distortion(&stage.piece.surface, &stage.flat.points)?;
        let ways = Ways::new(&stage.piece.surface, &stage.flat.points);
        Ok(tips(&stage.piece.surface, &ways, &table.triangles).1)
    }

    /// The cut that leaves least energy.
    fn best(&self, stage: &CutPiece, cuts: &[Vec<u32>]) -> Result<Option<DartCandidate>, FlattenError> {
        let table = distortion(&stage.piece.surface, &stage.flat.points)?;
        let ways = Ways::new(&stage.piece.surface, &stage.flat.points);
        let (tips, _) = tips(&stage.piece.surface, &ways, &table.triangles);
        let mut best: Option<DartCandidate> = None;
        for tip in tips {
            for way in short_ways(&ways, tip, &stage.flat.points) {
                let along = grain_share(&way, &stage.flat.points);
                let way: Vec<u32> = way.iter().map(|&v| stage.piece.vertices[v as usize]).collect();
                let Some(candidate) = self.candidate(stage, cuts, way, along) else { continue };
                if best.as_ref().is_none_or(|b| candidate.rated > b.rated) {
                    best = Some(candidate);
                }
            }
        }
        Ok(best)
    }

    /// A way and its mirror image, cut and flattened; none if that divides the piece or cannot be
    /// flattened.
    fn candidate(
        &self,
        stage: &CutPiece,
        cuts: &[Vec<u32>],
        way: Vec<u32>,
        along: f64,
    ) -> Option<DartCandidate> {
        let mut paths = vec![way];
        if let Some(image) = self.image(&paths[0]).filter(|i| apart(i, &paths[0])) {
            paths.push(image);
        }
        let all: Vec<Vec<u32>> = cuts.iter().chain(&paths).cloned().collect();
        let next = self.stage(&all).ok()?;
        let saved = stage.flat.report.energy - next.flat.report.energy;
        let rated = saved * (1.0 + GRAIN_BONUS * along);
        Some(DartCandidate { paths, stage: next, rated })
    }

    fn image(&self, way: &[u32]) -> Option<Vec<u32>> {
        let mirror = self.mirror.as_ref()?;
        Some(way.iter().map(|&v| mirror.partner[v as usize]).collect())
    }
}

/// The ways down and up the grain and across it, but those that are much longer than the shortest.
fn short_ways(ways: &Ways<'_>, tip: u32, flat: &[Point2<f64>]) -> Vec<Vec<u32>> {
    let directions = [-Vector2::y(), Vector2::y(), -Vector2::x(), Vector2::x()];
    let mut found: Vec<_> = directions.iter().filter_map(|d| ways.to_boundary(tip, *d)).collect();
    let shortest = found.iter().map(|w| chain_length(w, flat)).fold(f64::INFINITY, f64::min);
    found.retain(|w| chain_length(w, flat) <= MOST_DETOUR * shortest);
    found
}

/// The squared cosine between a way, end to end, and the grain.
fn grain_share(way: &[u32], flat: &[Point2<f64>]) -> f64 {
    let [first, .., last] = way else { return 0.0 };
    let chord = flat[*last as usize] - flat[*first as usize];
    chord.y.powi(2) / chord.norm_squared().max(f64::MIN_POSITIVE)
}

/// Whether two ways share no vertex.
fn apart(a: &[u32], b: &[u32]) -> bool {
    a.iter().all(|v| !b.contains(v))
}

/// Where a dart's tip lies on a flat piece of the uncut surface.
#[must_use]
pub fn dart_tip(dart: &Dart, flat: &[Point2<f64>]) -> Option<Point2<f64>> {
    dart.path.last().and_then(|&v| flat.get(v as usize)).copied()
}
