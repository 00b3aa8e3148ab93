//! Connected components of triangles across shared edges.

use super::edges::FREE;

/// For each triangle the number of its component; components are numbered by their first triangle.
#[must_use]
pub(crate) fn components(opposite: &[u32]) -> Vec<u32> {
    let mut component = vec![FREE; opposite.len() / 3];
    let (mut count, mut waiting) = (0, Vec::new());
    for seed in 0..component.len() {
        if component[seed] != FREE {
            continue;
        }
        component[seed] = count;
        waiting.push(seed);
        while let Some(t) = waiting.pop() {
            for &o in opposite[3 * t..3 * t + 3].iter().filter(|&&o| o != FREE) {
                let other = o as usize / 3;
                if component[other] == FREE {
                    component[other] = count;
                    waiting.push(other);
                }
            }
        }
        count += 1;
    }
    component
}

/// How many components a list of [`components`] has.
#[must_use]
pub(crate) fn component_count(components: &[u32]) -> usize {
    components.iter().max().map_or(0, |&c| c as usize + 1)
}
