//! Nested dissection: an order of elimination that keeps the factor of a surface's matrix sparse.
//!
//! The vertices are cut in two about the middle of the longer side of their box, again and again
//! (George 1973); those of one half that are coupled to the other half are the separator and are
//! eliminated last. Cost O(n log n). The order is only as good as the places given, but right for
//! any: a factor of n vertices has about 8 n log2 n blocks.

use super::graph::Graph;
use nalgebra::Point3;

/// Parts of at most this many vertices are not cut further: smaller supernodes cost more than their
/// zeros save.
const LEAF: usize = 12;

/// The vertices in the order of elimination, halves before separators.
#[must_use]
pub(crate) fn elimination_order(graph: &Graph, places: &[Point3<f64>]) -> Vec<u32> {
    let (starts, neighbours) = graph.both_ways();
    let mut dissection =
        Dissection { starts, neighbours, places, side: vec![0; places.len()], cuts: 0, order: Vec::new() };
    let mut all: Vec<u32> = (0..graph.vertices() as u32).collect();
    dissection.cut(&mut all);
    dissection.order
}

struct Dissection<'a> {
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    places: &'a [Point3<f64>],
    /// The cut that a vertex was last on the high side of.
    side: Vec<u32>,
    cuts: u32,
    order: Vec<u32>,
}

impl Dissection<'_> {
    /// Appends the order of `part`. As deep as log2 of its length, for each half has at most half
    /// of it.
    fn cut(&mut self, part: &mut [u32]) {
        if part.len() <= LEAF {
            self.order.extend_from_slice(part);
            return;
        }
        let axis = self.longest_axis(part);
        let middle = part.len() / 2;
        let places = self.places;
        let key = |v: &u32| places[*v as usize][axis];
        part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let (low, high) = part.split_at_mut(middle);
        let kept = self.part_without_separator(low, high);
        let (low, separator) = low.split_at_mut(kept);
        self.cut(low);
        self.cut(high);
        self.order.extend_from_slice(separator);
    }

    /// Moves the vertices of `low` that touch `high` to its end; returns how many do not.
    fn part_without_separator(&mut self, low: &mut [u32], high: &[u32]) -> usize {
        self.cuts += 1;
        high.iter().for_each(|&v| self.side[v as usize] = self.cuts);
        let touches = |v: u32| {
            let (a, b) = (self.starts[v as usize] as usize, self.starts[v as usize + 1] as usize);
            self.neighbours[a..b].iter().any(|&u| self.side[u as usize] == self.cuts)
        };
        let mut kept = 0;
        for k in 0..low.len() {
            if !touches(low[k]) {
                low.swap(kept, k);
                kept += 1;
            }
        }
        kept
    }

    fn longest_axis(&self, part: &[u32]) -> usize {
        let (mut low, mut high) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        for &v in part {
            low = low.inf(&self.places[v as usize]);
            high = high.sup(&self.places[v as usize]);
        }
        (high - low).imax()
    }
}
