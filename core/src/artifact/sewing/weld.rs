//! Which vertices are one: each names the least of those that it is joined to.

/// Joins pairs of vertices: each vertex names the least of those that it is joined to.
pub fn join_pairs<'a>(weld: &mut [u32], pairs: impl IntoIterator<Item = &'a [u32; 2]>) {
    for &[a, b] in pairs {
        let (a, b) = (root(weld, a), root(weld, b));
        weld[a.max(b) as usize] = a.min(b);
    }
    // What a vertex names is below it and has its root already.
    for v in 0..weld.len() {
        weld[v] = weld[weld[v] as usize];
    }
}

fn root(weld: &mut [u32], mut v: u32) -> u32 {
    while weld[v as usize] != v {
        // Ways to the root are halved, or a long chain would be walked again for each of its
        // members.
        weld[v as usize] = weld[weld[v as usize] as usize];
        v = weld[v as usize];
    }
    v
}
