//! The pieces of a garment solved again so that seams fit, straight edges are straight and mirror
//! images agree.
//!
//! In this order: pieces whose vertices are mirror images become so; each seam gets one length for
//! both sides (and for its mirror image); each piece is solved again with those lengths and its
//! straight edges, so that every correction is the gentlest that the cloth allows; then outlines of
//! left and right pieces with different meshes become mirror images. Cost: some ten Newton
//! iterations a piece.

use super::Objective;
use super::care_options::CareOptions;
use super::laid::Pull;
use super::mirror::{MirrorPair, mean, mirror_distance, mirror_pairs};
use super::outline_mirror::{OutlineMirror, OutlinePair, outline_pairs};
use super::piece_care::PieceCare;
use super::seam_lengths::{SeamLengths, seam_targets, side_lengths, sides_of};
use crate::error::FlattenError;
use crate::flatteners::{Flattening, Placement};
use crate::frames::flipped;
use crate::islands::SurfacePieces;
use crate::newton::QuadraticTerm;
use nalgebra::Point2;
use rayon::prelude::*;

impl CareOptions {
    fn outline_pairs(&self, pieces: &SurfacePieces, exact: &[MirrorPair]) -> Vec<[usize; 2]> {
        if self.mirror_outline == 0.0 {
            return Vec::new();
        }
        let mut taken = vec![false; pieces.pieces.len()];
        exact.iter().for_each(|p| (taken[p.a], taken[p.b]) = (true, true));
        outline_pairs(pieces, &taken, self.mirror_outline)
    }
}

/// What was done.
#[derive(Debug, Clone, PartialEq)]
pub struct CareReport {
    /// Lengths of the sides of each seam.
    pub seams: Vec<SeamLengths>,
    /// How many chains of each piece were made straight.
    pub straight: Vec<usize>,
    /// Mirror pairs, each with the largest distance of the one from the image of the other before
    /// the care.
    pub mirrors: Vec<(MirrorPair, f64)>,
    /// Pairs whose outlines were made mirror images.
    pub outlines: Vec<OutlinePair>,
}

/// Where an outline is held on another, edges that leave their line by this share are straight: the
/// other's edges decide, not how far its own are from straight.
const STRAIGHT: f64 = 1e-4;

/// Corrects the flat pieces in place; `flats` and `placements` have one entry a piece.
///
/// # Errors
/// [`FlattenError::InvalidParameter`], lists of other lengths than that of the pieces,
/// [`FlattenError::NoStart`] for flat pieces with flipped triangles, and the errors of the solver.
pub fn refine(
    pieces: &SurfacePieces,
    flats: &mut [Flattening],
    objective: &Objective,
    placements: &[Placement],
    options: CareOptions,
) -> Result<CareReport, FlattenError> {
    options.check()?;
    check_flats(pieces, flats, placements)?;
    let before: Vec<_> = pieces.seams.iter().map(|s| side_lengths(s, flats)).collect();
    let pairs = if options.mirror > 0.0 { mirror_pairs(&pieces.pieces, options.mirror) } else { Vec::new() };
    let apart: Vec<f64> =
        pairs.iter().map(|p| mirror_distance(p, &flats[p.a].points, &flats[p.b].points)).collect();
    make_mirrors(pieces, &pairs, flats);
    let near_pairs = options.outline_pairs(pieces, &pairs);
    let corner = options.corner.to_radians();
    let equal = OutlineMirror { pieces, corner, tolerance: options.mirror_outline };
    let alike: Vec<_> = near_pairs.iter().flat_map(|&pair| equal.seam_partners(pair, flats)).collect();
    let targets = seam_targets(&pieces.seams, flats, &alike);
    let care = |i: usize| {
        let sides = if options.seams { sides_of(i, &pieces.seams, &targets) } else { Vec::new() };
        PieceCare { surface: &pieces.pieces[i].surface, objective, placement: &placements[i], options, sides }
    };
    let solved = flats.par_iter_mut().enumerate().map(|(i, flat)| care(i).solve(flat, &[]));
    let straight = solved.collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>, _>>()?;
    // Where only the vertices are mirror images, the mean of two solutions would undo their seam
    // lengths.
    let exact: Vec<_> = pairs.iter().filter(|p| p.exact).cloned().collect();
    make_mirrors(pieces, &exact, flats);
    let solve = |i: usize, near: &[QuadraticTerm], pull: Pull, flat: &mut Flattening| {
        let mut care = care(i);
        if pull != Pull::Slide {
            care.options.straight = care.options.straight.min(STRAIGHT);
        }
        care.solve(flat, near).map(|_| ())
    };
    // No piece is in two pairs.
    let equalised = near_pairs.par_iter().map(|&pair| {
        let mut own = flats.to_vec();
        equal.equalise(pair, &mut own, solve).map(|done| (done, pair.map(|i| own[i].clone())))
    });
    let mut outlines = Vec::new();
    for (pair, equalised) in near_pairs.iter().zip(equalised.collect::<Vec<_>>()) {
        let (done, [a, b]) = equalised?;
        outlines.extend(done);
        (flats[pair[0]], flats[pair[1]]) = (a, b);
    }
    let seams = pieces.seams.iter().zip(before);
    let seams = seams.map(|(s, before)| SeamLengths { before, after: side_lengths(s, flats) }).collect();
    Ok(CareReport { seams, straight, mirrors: pairs.into_iter().zip(apart).collect(), outlines })
}

fn check_flats(
    pieces: &SurfacePieces,
    flats: &[Flattening],
    placements: &[Placement],
) -> Result<(), FlattenError> {
    let mismatch =
        |what, found, wanted| Err(crate::SurfaceError::LengthMismatch { what, found, wanted }.into());
    if flats.len() != pieces.pieces.len() {
        return mismatch("flat pieces", flats.len(), pieces.pieces.len());
    }
    if placements.len() != pieces.pieces.len() {
        return mismatch("placements", placements.len(), pieces.pieces.len());
    }
    for (placement, piece) in placements.iter().zip(&pieces.pieces) {
        placement.check(&piece.surface)?;
    }
    for (flat, piece) in flats.iter().zip(&pieces.pieces) {
        if flat.points.len() != piece.surface.positions().len() {
            return mismatch("flat places", flat.points.len(), piece.surface.positions().len());
        }
        let flips = flat.flipped(&piece.surface);
        if let Some(&triangle) = flips.first() {
            return Err(FlattenError::NoStart { flips: flips.len(), triangle });
        }
    }
    Ok(())
}

/// Replaces the pieces of each pair by their mean, unless that flips a triangle.
fn make_mirrors(pieces: &SurfacePieces, pairs: &[MirrorPair], flats: &mut [Flattening]) {
    for pair in pairs {
        let [first, second] = mean(pair, &flats[pair.a].points, &flats[pair.b].points);
        let sound = |i: usize, q: &[Point2<f64>]| flipped(pieces.pieces[i].surface.triangles(), q).is_empty();
        if sound(pair.a, &first) && sound(pair.b, &second) {
            flats[pair.a].points = first;
            if pair.a != pair.b {
                flats[pair.b].points = second;
            }
        }
    }
}
