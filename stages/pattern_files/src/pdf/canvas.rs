//! Lines and texts on a page, millimetres from its lower left corner, y up.

use crate::drawing::{DrawingSurface, Style, TextAnchor, Type};
use crate::font;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Name, Str};

/// Points of PDF in a millimetre.
pub(super) const POINTS: f64 = 72.0 / 25.4;
/// The names of both fonts, and of the sheet, among a page's resources.
pub(super) const PLAIN: Name<'static> = Name(b"F1");
pub(super) const BOLD: Name<'static> = Name(b"F2");
pub(super) const SHEET: Name<'static> = Name(b"S");
/// Control points of a quarter of a circle, as a share of its radius.
const QUARTER: f64 = 0.552_284_75;

/// What is drawn on a page.
pub(super) struct Canvas(pub Content);

impl Canvas {
    /// A page whose unit is the millimetre.
    pub(super) fn page() -> Self {
        let mut content = Content::new();
        let k = POINTS as f32;
        content.transform([k, 0.0, 0.0, k, 0.0, 0.0]);
        Canvas(content)
    }

    /// A drawing that pages put on themselves.
    pub(super) fn drawing() -> Self {
        Canvas(Content::new())
    }

    pub(super) fn bytes(self) -> Vec<u8> {
        self.0.finish().into_vec()
    }

    fn set(&mut self, style: Style) {
        self.0.set_line_width(style.width as f32).set_stroke_gray(style.grey as f32);
        self.0.set_line_cap(LineCapStyle::ButtCap).set_line_join(LineJoinStyle::MiterJoin);
        self.0.set_dash_pattern(style.dash.iter().copied(), 0.0);
    }

    fn path(&mut self, points: &[[f64; 2]]) {
        for (k, [x, y]) in points.iter().enumerate() {
            let (x, y) = (*x as f32, *y as f32);
            if k == 0 {
                self.0.move_to(x, y)
            } else {
                self.0.line_to(x, y)
            };
        }
    }
}

impl DrawingSurface for Canvas {
    fn line(&mut self, points: &[[f64; 2]], style: Style) {
        if points.len() > 1 {
            self.set(style);
            self.path(points);
            self.0.stroke();
        }
    }

    fn closed(&mut self, points: &[[f64; 2]], style: Style) {
        if points.len() > 1 {
            self.set(style);
            self.path(points);
            self.0.close_and_stroke();
        }
    }

    fn filled(&mut self, points: &[[f64; 2]], grey: f64) {
        if points.len() > 2 {
            self.0.set_fill_gray(grey as f32);
            self.path(points);
            self.0.close_path().fill_nonzero();
        }
    }

    fn circle(&mut self, [x, y]: [f64; 2], r: f64, style: Style) {
        self.set(style);
        self.0.set_fill_gray(1.0);
        let c = r * QUARTER;
        self.0.move_to((x + r) as f32, y as f32);
        let quarters = [
            [r, c, c, r, 0.0, r],
            [-c, r, -r, c, -r, 0.0],
            [-r, -c, -c, -r, 0.0, -r],
            [c, -r, r, -c, r, 0.0],
        ];
        for q in quarters {
            let at = |k: usize| (if k.is_multiple_of(2) { x + q[k] } else { y + q[k] }) as f32;
            self.0.cubic_to(at(0), at(1), at(2), at(3), at(4), at(5));
        }
        self.0.close_fill_nonzero_and_stroke();
    }

    fn text(&mut self, [x, y]: [f64; 2], kind: Type, text: &str) {
        let width = font::width(text, kind.size, kind.bold);
        let back = match kind.hold {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => width / 2.0,
        };
        let (matrix, size) = match kind.upright {
            false => ([1.0, 0.0, 0.0, 1.0, (x - back) as f32, y as f32], kind.size as f32),
            true => ([0.0, 1.0, -1.0, 0.0, x as f32, (y - back) as f32], kind.size as f32),
        };
        self.0.set_fill_gray(kind.grey as f32);
        self.0.begin_text().set_font(if kind.bold { BOLD } else { PLAIN }, size);
        self.0.set_text_matrix(matrix).show(Str(&font::encoded(text))).end_text();
    }
}
