//! Colours beyond the panel's rim, by pulling means up a pyramid and pushing them down again
//! (Gortler, Grzeszczuk, Szeliski and Cohen 1996): what is filled is smooth, and matches the rim.
//! Linear in the pixels.

use image::RgbImage;

/// Gives every pixel off `sure` a colour from those on it; false where there is none.
pub(crate) fn fill(pixels: &mut RgbImage, sure: &[bool]) -> bool {
    let size = (pixels.width() as usize, pixels.height() as usize);
    if !sure.contains(&true) {
        return false;
    }
    let own = pixels.pixels().map(|p| p.0.map(f32::from));
    let mut colours: Vec<Option<[f32; 3]>> = own.zip(sure).map(|(c, sure)| sure.then_some(c)).collect();
    complete(&mut colours, size);
    for (pixel, colour) in pixels.pixels_mut().zip(colours) {
        pixel.0 = colour.unwrap_or_default().map(|v| v.round() as u8);
    }
    true
}

/// Fills what is missing from the picture at half the size.
fn complete(colours: &mut [Option<[f32; 3]>], (w, h): (usize, usize)) {
    if colours.iter().all(Option::is_some) || (w == 1 && h == 1) {
        return;
    }
    let (hw, hh) = (w.div_ceil(2), h.div_ceil(2));
    let mean = |k: usize| {
        let (x, y) = (k % hw * 2, k / hw * 2);
        let four = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        let known =
            four.into_iter().filter(|(x, y)| *x < w && *y < h).filter_map(|(x, y)| colours[y * w + x]);
        let (sum, n) =
            known.fold(([0.0; 3], 0.0), |(s, n), c| ([s[0] + c[0], s[1] + c[1], s[2] + c[2]], n + 1.0));
        (n > 0.0).then(|| sum.map(|s: f32| s / n))
    };
    let mut half: Vec<Option<[f32; 3]>> = (0..hw * hh).map(mean).collect();
    complete(&mut half, (hw, hh));
    for (k, slot) in colours.iter_mut().enumerate().filter(|(_, c)| c.is_none()) {
        *slot = Some(between(&half, (hw, hh), (k % w, k / w)));
    }
}

/// The half-sized picture between its pixels.
fn between(half: &[Option<[f32; 3]>], (w, h): (usize, usize), (x, y): (usize, usize)) -> [f32; 3] {
    let place = |v: usize, n: usize| {
        let at = (v as f32 - 0.5) / 2.0;
        let low = at.floor().max(0.0);
        (low as usize, (low as usize + 1).min(n - 1), (at - low).clamp(0.0, 1.0))
    };
    let ((x0, x1, tx), (y0, y1, ty)) = (place(x, w), place(y, h));
    let (x0, y0) = (x0.min(w - 1), y0.min(h - 1));
    let at = |x: usize, y: usize, c: usize| half[y * w + x].unwrap_or_default()[c];
    [0, 1, 2].map(|c| {
        let row = |y: usize| at(x0, y, c) * (1.0 - tx) + at(x1, y, c) * tx;
        row(y0) * (1.0 - ty) + row(y1) * ty
    })
}
