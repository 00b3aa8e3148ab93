//! Values of pixels, row by row.

use rayon::prelude::*;
use toile_core::prelude::*;

/// A value for each pixel, by its number from the top left corner; rows in parallel.
///
/// # Errors
/// When the run has been stopped.
pub(crate) fn by_rows<T: Send>(
    width: usize,
    height: usize,
    cx: &Context,
    pixel: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, StageError> {
    let row = |y: usize| {
        cx.check()?;
        Ok((y * width..(y + 1) * width).map(&pixel).collect::<Vec<T>>())
    };
    let rows: Vec<Result<Vec<T>, StageError>> = (0..height).into_par_iter().map(row).collect();
    let mut all = Vec::with_capacity(width * height);
    for row in rows {
        all.extend(row?);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_core::Cancel;

    #[test]
    fn pixels_are_counted_from_the_top_left_and_a_stopped_run_gives_none() {
        assert_eq!(by_rows(3, 2, &Context::quiet(), |k| 10 * k).unwrap(), [0, 10, 20, 30, 40, 50]);
        let stopped = Cancel::new();
        stopped.cancel();
        let cx = Context::new("FlowView", std::path::Path::new(""), stopped, std::sync::Arc::new(()));
        assert_eq!(by_rows(3, 2, &cx, |k| k).unwrap_err().code, ErrorCode::Cancelled);
    }
}
