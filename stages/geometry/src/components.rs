//! Connected components by union-find (Galler, Fischer 1964).
//!
//! Cost: nearly linear in the pairs.

/// Numbers the groups of `0..n` that `pairs` connect, in the order of their first members; with
/// their count.
///
/// Every member of a pair must be below `n`.
#[must_use]
pub fn groups(n: usize, pairs: impl Iterator<Item = [u32; 2]>) -> (Vec<u32>, usize) {
    let mut parent: Vec<u32> = (0..n as u32).collect();
    for [a, b] in pairs {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut number = vec![u32::MAX; n];
    let mut count = 0;
    let mut number_of = |i: u32| {
        let r = root(&mut parent, i) as usize;
        if number[r] == u32::MAX {
            number[r] = count;
            count += 1;
        }
        number[r]
    };
    let all = (0..n as u32).map(&mut number_of).collect();
    (all, count as usize)
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

/// The sides of triangles that connect their corners: two per triangle.
pub fn links(triangles: &[[u32; 3]]) -> impl Iterator<Item = [u32; 2]> + '_ {
    triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]])
}

#[cfg(test)]
mod tests {
    use super::{groups, links};

    #[test]
    fn groups_are_numbered_in_the_order_of_their_first_members() {
        let (of, count) = groups(6, [[4, 1], [0, 3], [1, 5]].into_iter());
        assert_eq!((of, count), (vec![0, 1, 2, 0, 1, 1], 3));
    }

    #[test]
    fn a_triangle_connects_its_corners() {
        let (of, count) = groups(4, links(&[[3, 1, 0]]));
        assert_eq!((of, count), (vec![0, 0, 1, 0], 2));
    }
}
