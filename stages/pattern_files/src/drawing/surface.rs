//! What a piece is drawn on, whatever the format: lines, polygons, circles and texts, in
//! millimetres, y up.

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Style {
    /// Its width, mm.
    pub width: f64,
    /// From black at 0 to white at 1.
    pub grey: f64,
    /// Lengths of dashes and of gaps, mm; empty for a solid line.
    pub dash: &'static [f32],
    /// Whether the cloth is cut along it.
    pub cut: bool,
}

impl Style {
    pub(crate) const fn solid(width: f64) -> Self {
        Style { width, grey: 0.0, dash: &[], cut: false }
    }

    pub(crate) const fn dashed(width: f64, dash: &'static [f32]) -> Self {
        Style { width, grey: 0.0, dash, cut: false }
    }

    pub(crate) const fn grey(self, grey: f64) -> Self {
        Style { grey, ..self }
    }

    pub(crate) const fn cut(self) -> Self {
        Style { cut: true, ..self }
    }
}

/// Where a text is held: at its start or its middle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextAnchor {
    Start,
    Middle,
}

/// How a text is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Type {
    /// Its size, mm.
    pub size: f64,
    pub bold: bool,
    pub hold: TextAnchor,
    /// Whether it runs upwards.
    pub upright: bool,
    pub grey: f64,
}

impl Type {
    pub(crate) const fn plain(size: f64) -> Self {
        Type { size, bold: false, hold: TextAnchor::Start, upright: false, grey: 0.0 }
    }

    pub(crate) const fn bold(size: f64) -> Self {
        Type { bold: true, ..Type::plain(size) }
    }

    pub(crate) const fn held(self, hold: TextAnchor) -> Self {
        Type { hold, ..self }
    }

    pub(crate) const fn grey(self, grey: f64) -> Self {
        Type { grey, ..self }
    }

    pub(crate) const fn upright(self, upright: bool) -> Self {
        Type { upright, ..self }
    }
}

/// A page, or a plot, that takes lines and texts, mm.
pub(crate) trait DrawingSurface {
    /// An open line.
    fn line(&mut self, points: &[[f64; 2]], style: Style);

    /// A closed line.
    fn closed(&mut self, points: &[[f64; 2]], style: Style);

    /// A filled polygon.
    fn filled(&mut self, points: &[[f64; 2]], grey: f64);

    /// A circle, white inside.
    fn circle(&mut self, centre: [f64; 2], r: f64, style: Style);

    /// A text whose base line begins or is halved there.
    fn text(&mut self, at: [f64; 2], kind: Type, text: &str);
}
