//! Places of rectangles side by side in rows, without overlap.
//!
//! Method: the tallest first, each in the first row that has room (first fit decreasing height,
//! Coffman et al. 1980). Cost: rectangles times rows. Limits: at most 1.7 times the least height
//! and one row, never the least.

/// Where rectangles lie: the lower left corner of each, and the size of all together. Each is
/// `[width, height]`, a row is as wide as the widest at least, `gap` lies between them. Rows are
/// stacked downwards from y = 0.
pub(crate) fn pack(sizes: &[[f64; 2]], width: f64, gap: f64) -> (Vec<[f64; 2]>, [f64; 2]) {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&i, &j| sizes[j][1].total_cmp(&sizes[i][1]).then(i.cmp(&j)));
    let row = sizes.iter().map(|s| s[0]).fold(width, f64::max);
    let mut rows: Vec<(f64, f64, f64)> = Vec::new();
    let mut places = vec![[0.0; 2]; sizes.len()];
    let (mut bottom, mut right) = (0.0, 0.0_f64);
    for i in order {
        let [w, h] = sizes[i];
        let k = rows.iter().position(|(x, _, _)| x + w <= row).unwrap_or_else(|| {
            let top = if rows.is_empty() { 0.0 } else { bottom - gap };
            bottom = top - h;
            rows.push((0.0, top, h));
            rows.len() - 1
        });
        let (x, top, _) = &mut rows[k];
        places[i] = [*x, *top - h];
        *x += w + gap;
        right = right.max(*x - gap);
    }
    (places, [right, -bottom])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_overlaps_and_all_lies_in_the_whole() {
        let sizes: Vec<[f64; 2]> =
            (0..40).map(|k| [f64::from(k * 7 % 11 + 1), f64::from(k * 5 % 13 + 1)]).collect();
        let (places, [w, h]) = pack(&sizes, 30.0, 0.5);
        for i in 0..sizes.len() {
            let [x, y] = places[i];
            assert!(x >= 0.0 && x + sizes[i][0] <= w && y >= -h && y + sizes[i][1] <= 1e-12);
            for j in 0..i {
                let apart = |d: usize| {
                    places[i][d] + sizes[i][d] + 0.5 <= places[j][d] + 1e-9
                        || places[j][d] + sizes[j][d] + 0.5 <= places[i][d] + 1e-9
                };
                assert!(apart(0) || apart(1), "{i} {j}");
            }
        }
    }

    #[test]
    fn no_rectangles_have_no_size() {
        assert_eq!(pack(&[], 10.0, 1.0), (vec![], [0.0, 0.0]));
    }
}
