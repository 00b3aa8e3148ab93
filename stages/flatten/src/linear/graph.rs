//! Which vertices of a mesh are coupled: the pattern of every matrix here.

/// Couplings of vertices, each pair once: for vertex i the sorted vertices above i that it is
/// coupled to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Graph {
    starts: Vec<u32>,
    above: Vec<u32>,
}

impl Graph {
    /// Couples the corners of every triangle, and the pairs of `extra`.
    #[must_use]
    pub(crate) fn new(vertices: usize, triangles: &[[u32; 3]], extra: &[[u32; 2]]) -> Self {
        let triangle_pairs = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let pairs = || triangle_pairs.clone().chain(extra.iter().copied()).filter(|[a, b]| a != b);
        let mut ends = vec![0u32; vertices + 1];
        pairs().for_each(|[a, b]| ends[a.min(b) as usize + 1] += 1);
        for i in 0..vertices {
            ends[i + 1] += ends[i];
        }
        let mut next = ends.clone();
        let mut all = vec![0u32; ends[vertices] as usize];
        for [a, b] in pairs() {
            let low = a.min(b) as usize;
            all[next[low] as usize] = a.max(b);
            next[low] += 1;
        }
        Self::without_doubles(&ends, all)
    }

    fn without_doubles(ends: &[u32], mut all: Vec<u32>) -> Self {
        let (mut starts, mut above) = (vec![0], Vec::with_capacity(all.len() / 2));
        for w in ends.windows(2) {
            let list = &mut all[w[0] as usize..w[1] as usize];
            list.sort_unstable();
            let first = above.len();
            for &v in list.iter() {
                if above.len() == first || above.last() != Some(&v) {
                    above.push(v);
                }
            }
            starts.push(above.len() as u32);
        }
        Self { starts, above }
    }

    /// How many vertices.
    #[must_use]
    pub(crate) fn vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many pairs.
    #[must_use]
    pub(crate) fn pairs(&self) -> usize {
        self.above.len()
    }

    /// The vertices above `i` that it is coupled to.
    #[must_use]
    pub(crate) fn above(&self, i: usize) -> &[u32] {
        &self.above[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// The number of the first pair of vertex `i`.
    #[must_use]
    pub(crate) fn start(&self, i: usize) -> usize {
        self.starts[i] as usize
    }

    /// The number of a pair, if it is coupled.
    #[must_use]
    pub(crate) fn pair(&self, a: u32, b: u32) -> Option<usize> {
        let (low, high) = (a.min(b) as usize, a.max(b));
        self.above(low).binary_search(&high).ok().map(|k| self.start(low) + k)
    }

    /// Neighbours of every vertex in both directions: starts, and one list.
    #[must_use]
    pub(crate) fn both_ways(&self) -> (Vec<u32>, Vec<u32>) {
        let n = self.vertices();
        let mut starts = vec![0u32; n + 1];
        let pairs = || (0..n).flat_map(|i| self.above(i).iter().map(move |&j| (i as u32, j)));
        for (i, j) in pairs() {
            starts[i as usize + 1] += 1;
            starts[j as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut list = vec![0u32; 2 * self.pairs()];
        for (a, b) in pairs().flat_map(|(i, j)| [(i, j), (j, i)]) {
            list[next[a as usize] as usize] = b;
            next[a as usize] += 1;
        }
        (starts, list)
    }
}
