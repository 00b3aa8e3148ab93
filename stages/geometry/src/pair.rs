//! Two pieces of cloth near each other: a vertex and a triangle, or two edges.

use crate::closest::{Feature, between_segments, on_triangle};

use crate::Vec3;
/// What meets what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Node 0 against the triangle of the others.
    VertexTriangle,
    /// The edge of nodes 0 and 1 against that of 2 and 3.
    EdgeEdge,
}

/// Two features that share no node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    /// What it is.
    pub kind: Kind,
    /// Its nodes.
    pub nodes: [u32; 4],
}

/// The closest points of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// m.
    pub distance: f64,
    /// From the second feature to the first: the sum of nodes times weights.
    pub between: Vec3,
    /// Weights of the nodes; positive on the first feature (sum 1), negative on the second (sum
    /// -1).
    pub weights: [f64; 4],
    /// True where both closest points lie inside their features.
    pub inside: bool,
    /// Where on the triangle, for a vertex and a triangle.
    pub feature: Feature,
}

impl Kind {
    /// The closest points at these places.
    #[inline]
    #[must_use]
    pub fn closest(self, x: &[Vec3; 4]) -> Closest {
        match self {
            Self::VertexTriangle => {
                let on = on_triangle(&x[0], &[x[1], x[2], x[3]]);
                let between = x[0] - on.point;
                let [a, b, c] = on.weights;
                let inside = on.feature == Feature::Face;
                let weights = [1.0, -a, -b, -c];
                Closest { distance: between.norm(), between, weights, inside, feature: on.feature }
            }
            Self::EdgeEdge => {
                let (s, t) = between_segments(&[x[0], x[1]], &[x[2], x[3]]);
                let weights = [1.0 - s, s, t - 1.0, -t];
                let between: Vec3 = (0..4).map(|i| x[i] * weights[i]).sum();
                let inside = s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0;
                Closest { distance: between.norm(), between, weights, inside, feature: Feature::Face }
            }
        }
    }
}

impl Pair {
    /// Its nodes' values.
    #[inline]
    #[must_use]
    pub fn at(&self, x: &[Vec3]) -> [Vec3; 4] {
        let [a, b, c, d] = self.nodes;
        [x[a as usize], x[b as usize], x[c as usize], x[d as usize]]
    }

    /// Its closest points.
    #[inline]
    #[must_use]
    pub fn closest(&self, x: &[Vec3]) -> Closest {
        self.kind.closest(&self.at(x))
    }

    /// What carries weight, whichever pair it was seen in: a vertex against a corner or a side of
    /// several triangles.
    #[must_use]
    pub fn key(&self, c: &Closest) -> [u32; 4] {
        let [v, a, b, d] = self.nodes;
        let (mut low, mut high) = match c.feature {
            _ if self.kind == Kind::EdgeEdge => return self.nodes,
            Feature::Face => return self.nodes,
            Feature::Corner(k) => ([a, b, d][k as usize], u32::MAX),
            Feature::Side(k) => ([a, b, d][k as usize], [a, b, d][(k as usize + 1) % 3]),
        };
        if low > high {
            std::mem::swap(&mut low, &mut high);
        }
        [v, low, high, u32::MAX]
    }
}
