//! Colours in linear light, as light adds up, and their sRGB form, as files hold them.

/// Linear red, green, blue, 0 to 1.
pub(crate) type LinearColour = [f64; 3];

/// A colour from its sRGB bytes.
pub(crate) fn srgb(r: u8, g: u8, b: u8) -> LinearColour {
    [r, g, b].map(|v| {
        let v = f64::from(v) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    })
}

/// The sRGB level, 0 to 1, of a linear value.
pub(crate) fn encode(v: f64) -> f64 {
    let v = v.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

pub(crate) fn blend(a: LinearColour, b: LinearColour, t: f64) -> LinearColour {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
}

pub(crate) fn scale(a: LinearColour, by: f64) -> LinearColour {
    a.map(|v| v * by)
}

/// 0 below `low`, 1 above `high`, smooth between.
pub(crate) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
