//! Finished edges in the picture of a panel: ribs that bind an edge, and hems that are turned under
//! and stitched.
//!
//! A panel with such edges has a picture of its own: its cloth, and near an edge what the distance
//! to it and the place along it say. A rib has columns of stitches upright on the edge and a seam
//! where it meets the cloth; a hem has a row of lock stitches in a shallow groove (ISO 4915, stitch
//! type 301). Nothing of it is in the mesh. Cost: one look a texel, and one a texel and mesh edge
//! near the edge. Limits: texels of 0.4 mm at least, so single yarns are not told apart; where two
//! finished edges meet, each texel belongs to the nearer one.

use super::relief::Relief;
use super::weave::{Colour, Swatch};
use crate::render::encode;
use image::RgbImage;
use rayon::prelude::*;
use std::f64::consts::TAU;
use toile_core::artifact::Point2;

/// How an edge is finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FinishKind {
    /// Bound with a knitted rib.
    Rib,
    /// Turned under and stitched.
    Stitches,
}

/// An edge of a panel and its finish.
#[derive(Debug, Clone)]
pub(super) struct EdgeFinish {
    pub(super) kind: FinishKind,
    /// Width of the rib, or distance of the stitches from the edge, metres.
    pub(super) width: f64,
    /// The edge, in the flat panel's coordinates.
    pub(super) line: Vec<Point2>,
}

/// The longer side of a panel's picture at most, px.
pub(super) const MOST_PX: f64 = 4096.0;
/// Columns of a rib: one that stands out and one that lies back, metres.
const RIB_PITCH: f64 = 2.6e-3;
/// Light on the columns that lie back, where those that stand out have 1, and how far they do,
/// metres.
const RIB_BACK: f64 = 0.62;
const RIB_HEIGHT: f64 = 0.6e-3;
/// Half the width of the seam between rib and cloth, metres, and its light.
const SEAM: f64 = 0.8e-3;
const SEAM_LIGHT: f64 = 0.6;
/// A stitch with the gap to the next, and its thread's length and half width, metres.
const STITCH: f64 = 3.0e-3;
const THREAD: [f64; 2] = [2.2e-3, 0.3e-3];
/// Light on the thread, and in the groove beside it, where cloth has 1; the groove's half width and
/// depth, metres.
const THREAD_LIGHT: f64 = 1.35;
const GROOVE_LIGHT: f64 = 0.72;
const GROOVE: [f64; 2] = [1.1e-3, 0.4e-3];

/// What is seen at a texel beside plain cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TexelLook {
    /// Whether the cloth's own threads show.
    cloth: bool,
    /// Factor of the colour.
    light: f64,
    /// Added to the cloth's height, metres.
    height: f64,
}

const CLOTH: TexelLook = TexelLook { cloth: true, light: 1.0, height: 0.0 };

impl EdgeFinish {
    /// How far from the edge it is seen, metres.
    fn reach(&self) -> f64 {
        self.width + 3.0 * GROOVE[0]
    }

    /// What is seen at a distance from the edge and a place along it, metres.
    fn look(&self, distance: f64, along: f64) -> TexelLook {
        let off = (distance - self.width).abs();
        match self.kind {
            FinishKind::Rib if off < SEAM => TexelLook { cloth: true, light: SEAM_LIGHT, height: -GROOVE[1] },
            FinishKind::Rib if distance < self.width => {
                let out = 0.5 + 0.5 * (TAU * along / RIB_PITCH).cos();
                let light = (RIB_BACK + (1.0 - RIB_BACK) * out) / (0.5 + 0.5 * RIB_BACK);
                TexelLook { cloth: false, light, height: RIB_HEIGHT * out }
            }
            FinishKind::Rib => CLOTH,
            FinishKind::Stitches => {
                let deep = (-(off / GROOVE[0]).powi(2)).exp();
                let thread = off < THREAD[1] && along.rem_euclid(STITCH) < THREAD[0];
                let light = if thread { THREAD_LIGHT } else { 1.0 - (1.0 - GROOVE_LIGHT) * deep };
                TexelLook { cloth: true, light, height: if thread { 0.0 } else { -GROOVE[1] * deep } }
            }
        }
    }
}

/// The picture of one panel.
#[derive(Debug)]
pub(super) struct PanelPicture {
    pub(super) pixels: RgbImage,
    /// Heights, metres, in rows from the top.
    heights: Vec<f32>,
    /// The upper left corner in the flat panel's coordinates.
    corner: Point2,
    /// Side of a texel, metres.
    texel: f64,
}

impl PanelPicture {
    /// Of a panel's flat vertices in cloth, with finished edges; ribs have the colour `rib`.
    pub(super) fn new(
        flat: &[Point2],
        swatch: &Swatch,
        finishes: &[EdgeFinish],
        rib: Colour,
    ) -> PanelPicture {
        let (lo, hi) = flat
            .iter()
            .fold((Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN)), |(lo, hi), p| {
                (lo.inf(p), hi.sup(p))
            });
        let texel = swatch.texel;
        // Texels are those of the cloth, which begins at the origin of every panel.
        let corner = Point2::new((lo.x / texel).floor() * texel, (hi.y / texel).ceil() * texel);
        let count = |length: f64| (length / texel).ceil().max(1.0) as usize + 1;
        let (width, height) = (count(hi.x - corner.x), count(corner.y - lo.y));
        let near = NearestFinish::of(finishes, corner, texel, [width, height]);
        let [i0, j0] = [corner.x, -corner.y].map(|l| (l / texel).round() as i64);
        let mut pixels = RgbImage::new(width as u32, height as u32);
        let mut heights = vec![0.0; width * height];
        let rows = pixels.par_chunks_mut(3 * width).zip(heights.par_chunks_mut(width));
        rows.enumerate().for_each(|(j, (row, heights))| {
            for (i, (pixel, height)) in row.chunks_exact_mut(3).zip(heights).enumerate() {
                let (own, threads) = swatch.at(i0 + i as i64, j0 + j as i64);
                let look = near.look(finishes, j * width + i);
                let colour = if look.cloth { own } else { rib };
                *height = look.height as f32 + if look.cloth { threads } else { 0.0 };
                pixel.copy_from_slice(&colour.map(|c| encode(c * look.light as f32)));
            }
        });
        PanelPicture { pixels, heights, corner, texel }
    }

    /// The normal map of threads, ribs and stitches.
    pub(super) fn normal_map(&self, strength: f64) -> RgbImage {
        let (width, height) = (self.pixels.width() as usize, self.pixels.height() as usize);
        Relief { heights: self.heights.clone(), width, height, texel: self.texel, repeats: false }
            .normal_map(strength)
    }

    /// Where a point of the flat panel lies in the picture.
    pub(super) fn uv(&self, p: &Point2) -> [f32; 2] {
        let (w, h) = self.pixels.dimensions();
        let at = |length: f64, px: u32| (length / (self.texel * f64::from(px))) as f32;
        [at(p.x - self.corner.x, w), at(self.corner.y - p.y, h)]
    }
}

/// For every texel the nearest finished edge in reach: which one, its distance and the place along
/// it, metres.
struct NearestFinish(Vec<Option<(u32, f32, f32)>>);

impl NearestFinish {
    fn of(finishes: &[EdgeFinish], corner: Point2, texel: f64, [width, height]: [usize; 2]) -> NearestFinish {
        let mut near = vec![None; width * height];
        for (k, finish) in finishes.iter().enumerate() {
            let mut begins = 0.0;
            for ends in finish.line.windows(2) {
                let (a, b) = (ends[0], ends[1]);
                let (low, high, reach) = (a.inf(&b), a.sup(&b), finish.reach());
                let texels = |from: f64, to: f64, count: usize| {
                    let at = |l: f64| ((l / texel).floor().max(0.0) as usize).min(count);
                    at(from)..at(to + texel)
                };
                let columns = texels(low.x - reach - corner.x, high.x + reach - corner.x, width);
                for j in texels(corner.y - high.y - reach, corner.y - low.y + reach, height) {
                    for i in columns.clone() {
                        let p = Point2::new(
                            corner.x + (i as f64 + 0.5) * texel,
                            corner.y - (j as f64 + 0.5) * texel,
                        );
                        let (distance, along) = to_segment(p, a, b);
                        let cell: &mut Option<(u32, f32, f32)> = &mut near[j * width + i];
                        if distance <= reach && cell.is_none_or(|c| distance < f64::from(c.1)) {
                            *cell = Some((k as u32, distance as f32, (begins + along) as f32));
                        }
                    }
                }
                begins += (b - a).norm();
            }
        }
        NearestFinish(near)
    }

    fn look(&self, finishes: &[EdgeFinish], texel: usize) -> TexelLook {
        self.0[texel].map_or(CLOTH, |(k, distance, along)| {
            finishes[k as usize].look(f64::from(distance), f64::from(along))
        })
    }
}

/// Distance of a point from a segment, and how far along it the nearest place is.
fn to_segment(p: Point2, a: Point2, b: Point2) -> (f64, f64) {
    let (d, length) = (b - a, (b - a).norm());
    let t = if length > 0.0 { ((p - a).dot(&d) / (length * length)).clamp(0.0, 1.0) } else { 0.0 };
    ((p - (a + d * t)).norm(), t * length)
}

#[cfg(test)]
mod tests {
    use super::super::weave::{ClothKind, tile};
    use super::*;
    use proptest::prelude::*;

    const GREY: Colour = [0.2; 3];

    /// A panel of 6 x 8 cm with its lower edge finished.
    fn sheet(kind: FinishKind, width: f64) -> PanelPicture {
        let corners = [[0.0, 0.0], [0.06, 0.0], [0.06, 0.08], [0.0, 0.08]].map(|[x, y]| Point2::new(x, y));
        let line = vec![corners[0], corners[1]];
        let swatch = tile(ClothKind::Plain(GREY), 0.02, 256).swatch(0.08 / MOST_PX);
        PanelPicture::new(&corners, &swatch, &[EdgeFinish { kind, width, line }], GREY)
    }

    /// Mean light of a row, so many metres above the lower edge.
    fn row(sheet: &PanelPicture, above: f64) -> f64 {
        let j = ((sheet.corner.y - above) / sheet.texel) as u32;
        let w = sheet.pixels.width();
        (0..w).map(|i| f64::from(sheet.pixels.get_pixel(i, j).0[0])).sum::<f64>() / f64::from(w)
    }

    #[test]
    fn stitches_lie_in_a_groove_at_their_distance() {
        let sheet = sheet(FinishKind::Stitches, 0.02);
        let plain = row(&sheet, 0.05);
        assert!(row(&sheet, 0.02 + 0.001) < 0.95 * plain, "{} {plain}", row(&sheet, 0.021));
        assert!((row(&sheet, 0.01) - plain).abs() < 0.02 * plain, "the hem is of the cloth");
        let line: Vec<u8> = {
            let j = ((sheet.corner.y - 0.02) / sheet.texel) as u32;
            (0..sheet.pixels.width()).map(|i| sheet.pixels.get_pixel(i, j).0[0]).collect()
        };
        let bright = line.iter().filter(|v| f64::from(**v) > 1.05 * plain).count() as f64 / line.len() as f64;
        assert!((0.6..0.85).contains(&bright), "thread for 2.2 mm of 3: {bright}");
    }

    #[test]
    fn a_rib_has_columns_upright_on_its_edge() {
        let sheet = sheet(FinishKind::Rib, 0.02);
        let j = ((sheet.corner.y - 0.01) / sheet.texel) as u32;
        let at = |i: u32, j: u32| f64::from(sheet.pixels.get_pixel(i, j).0[0]);
        let across: Vec<f64> = (0..sheet.pixels.width()).map(|i| at(i, j)).collect();
        let turns = across.windows(3).filter(|w| w[1] > w[0] && w[1] >= w[2]).count() as f64;
        assert!((turns - 0.06 / RIB_PITCH).abs() <= 2.0, "{turns} columns");
        assert!((0..9).all(|k| (at(30, j) - at(30, j - k)).abs() < 1.0), "the same along a column");
        assert!(
            (row(&sheet, 0.01) - row(&sheet, 0.05)).abs() < 0.1 * row(&sheet, 0.05),
            "as bright as cloth"
        );
        assert!(row(&sheet, 0.02) < 0.9 * row(&sheet, 0.05), "its seam");
    }

    #[test]
    fn corners_of_the_panel_lie_in_the_picture() {
        let sheet = sheet(FinishKind::Rib, 0.02);
        for p in [Point2::origin(), Point2::new(0.06, 0.08)] {
            assert!(sheet.uv(&p).iter().all(|c| (0.0..=1.0).contains(c)), "{p} {:?}", sheet.uv(&p));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_edge_is_drawn(points in proptest::collection::vec([-0.1..0.2_f64, -0.1..0.2_f64], 0..6), width in 0.001..0.1_f64) {
            let line = points.into_iter().map(|[x, y]| Point2::new(x, y)).collect();
            let flat = [Point2::origin(), Point2::new(0.05, 0.03)];
            let swatch = tile(ClothKind::Twill(GREY), 0.02, 64).swatch(1e-3);
            let sheet = PanelPicture::new(&flat, &swatch, &[EdgeFinish { kind: FinishKind::Stitches, width, line }], GREY);
            prop_assert_eq!(sheet.heights.len(), sheet.pixels.len() / 3);
        }
    }
}
