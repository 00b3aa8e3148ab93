//! Seams: boundary edges of pieces that are the same edge of the garment, joined into chains.

use super::SurfacePiece;
use crate::surface::edge_key;

/// A chain of boundary vertices of one piece, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    /// The piece.
    pub piece: usize,
    /// Vertices of the piece's surface, two or more.
    pub vertices: Vec<u32>,
}

/// Two chains whose vertices are, one by one, the same vertices of the garment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SurfaceSeam {
    /// The first chain, along its piece's boundary.
    pub a: Chain,
    /// The second chain, against its piece's boundary.
    pub b: Chain,
}

/// A boundary edge: its garment edge, its piece, and its loop and place there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct BoundaryEdge {
    key: u64,
    piece: usize,
    of_loop: usize,
    place: usize,
}

/// An edge that has a partner on another boundary.
#[derive(Debug, Clone, Copy)]
struct EdgePair {
    a: BoundaryEdge,
    b: BoundaryEdge,
}

/// All seams of pieces whose vertices know the garment's. Where three boundaries or more share an
/// edge, the first is paired with each.
pub(super) fn find_seams(pieces: &[SurfacePiece]) -> Vec<SurfaceSeam> {
    let mut pairs = pair_edges(pieces);
    pairs.sort_by_key(|p| (p.a.piece, p.a.of_loop, p.a.place, p.b));
    let mut runs: Vec<Vec<EdgePair>> = Vec::new();
    for pair in pairs {
        match runs
            .iter_mut()
            .rev()
            .take(4)
            .find(|run| run.last().is_some_and(|last| follows(pieces, last, &pair)))
        {
            Some(run) => run.push(pair),
            None => runs.push(vec![pair]),
        }
    }
    join_ends(pieces, &mut runs);
    runs.iter().map(|run| seam(pieces, run)).collect()
}

fn pair_edges(pieces: &[SurfacePiece]) -> Vec<EdgePair> {
    let mut edges = Vec::new();
    for (piece, p) in pieces.iter().enumerate() {
        for (of_loop, vertices) in p.surface.loops().iter().enumerate() {
            for place in 0..vertices.len() {
                let [a, b] = [vertices[place], vertices[(place + 1) % vertices.len()]];
                let key = edge_key(p.vertices[a as usize], p.vertices[b as usize]);
                edges.push(BoundaryEdge { key, piece, of_loop, place });
            }
        }
    }
    edges.sort_unstable();
    let mut pairs = Vec::new();
    for group in edges.chunk_by(|a, b| a.key == b.key) {
        pairs.extend(group[1..].iter().map(|&b| EdgePair { a: group[0], b }));
    }
    pairs
}

/// Whether `next` goes on along the first boundary where `last` ends, and against the second.
fn follows(pieces: &[SurfacePiece], last: &EdgePair, next: &EdgePair) -> bool {
    let same = |x: &BoundaryEdge, y: &BoundaryEdge| (x.piece, x.of_loop) == (y.piece, y.of_loop);
    if !same(&last.a, &next.a) || !same(&last.b, &next.b) {
        return false;
    }
    let after = |e: &BoundaryEdge| (e.place + 1) % pieces[e.piece].surface.loops()[e.of_loop].len();
    after(&last.a) == next.a.place && after(&next.b) == last.b.place
}

/// A run may go on over the place where its loop begins.
fn join_ends(pieces: &[SurfacePiece], runs: &mut Vec<Vec<EdgePair>>) {
    let mut i = 0;
    while i < runs.len() {
        let goes_on = |j: usize| match (runs[i].last(), runs[j].first()) {
            (Some(last), Some(first)) => j != i && first.a.place == 0 && follows(pieces, last, first),
            _ => false,
        };
        match (0..runs.len()).find(|&j| goes_on(j)) {
            Some(j) => {
                let rest = runs.remove(j);
                let i_now = if j < i { i - 1 } else { i };
                runs[i_now].extend(rest);
                i = i_now + 1;
            }
            None => i += 1,
        }
    }
}

fn seam(pieces: &[SurfacePiece], run: &[EdgePair]) -> SurfaceSeam {
    let vertex = |e: &BoundaryEdge, step: usize| {
        let vertices = &pieces[e.piece].surface.loops()[e.of_loop];
        vertices[(e.place + step) % vertices.len()]
    };
    let (mut a, mut b) = (vec![vertex(&run[0].a, 0)], vec![vertex(&run[0].b, 1)]);
    for pair in run {
        a.push(vertex(&pair.a, 1));
        b.push(vertex(&pair.b, 0));
    }
    SurfaceSeam {
        a: Chain { piece: run[0].a.piece, vertices: a },
        b: Chain { piece: run[0].b.piece, vertices: b },
    }
}
