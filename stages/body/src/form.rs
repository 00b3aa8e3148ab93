//! What sets women, men and children apart beyond their girths: sections of the trunk and a few
//! factors.
//!
//! Mean proportions of standing adults after the tables of Gordon and others (1989), children after
//! Snyder and others (1977), simplified. Girths follow the measures that are asked for; a form
//! gives their share in width and depth.

/// A row of the trunk: level, half width, depth in front and behind the axis, metres on the adult
/// of [`crate::shape::ADULT`].
pub(crate) type TrunkRow = [f64; 4];

/// Sections of the trunk.
pub(crate) const ROWS: usize = 14;

/// The row at the fullest place of the seat.
pub(crate) const HIP_ROW: usize = 3;

/// Forms that can be mixed: a girl of 145 cm is half a child's and half a woman's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BodyForm {
    /// Sections of the trunk, from the fork of the legs to the neck.
    pub trunk: [TrunkRow; ROWS],
    /// Size of the breasts where bust and waist differ as a woman's do.
    pub breast: f64,
    /// Height of the chest's muscles, metres.
    pub chest: f64,
    /// Height of the belly's fullness, metres.
    pub belly: f64,
    /// Size of the seat.
    pub seat: f64,
    /// Thickness of arms and shoulders.
    pub arm: f64,
    /// Size of the hands.
    pub hand: f64,
    /// Size of the feet.
    pub foot: f64,
    /// Width of the jaw.
    pub jaw: f64,
    /// Relief of bones and muscles.
    pub relief: f64,
    /// Shares of height and bust that make the shoulder width where none is given.
    pub shoulders: [f64; 2],
    /// Shares of height and bust that make the neck's girth where none is given.
    pub neck: [f64; 2],
}

pub(crate) const WOMAN: BodyForm = BodyForm {
    trunk: [
        [0.490, 0.148, 0.066, 0.078],
        [0.537, 0.170, 0.084, 0.098],
        [0.575, 0.179, 0.095, 0.108],
        [0.598, 0.178, 0.100, 0.108],
        [0.640, 0.163, 0.103, 0.096],
        [0.690, 0.135, 0.099, 0.074],
        [0.725, 0.122, 0.094, 0.066],
        [0.765, 0.126, 0.092, 0.072],
        [0.800, 0.135, 0.092, 0.086],
        [0.828, 0.140, 0.090, 0.096],
        [0.870, 0.143, 0.084, 0.104],
        [0.910, 0.136, 0.068, 0.101],
        [0.945, 0.108, 0.046, 0.088],
        [0.970, 0.070, 0.030, 0.068],
    ],
    breast: 1.0,
    chest: 0.0,
    belly: 0.005,
    seat: 1.0,
    arm: 0.97,
    hand: 0.98,
    foot: 0.97,
    jaw: 0.93,
    relief: 0.9,
    shoulders: [0.13, 0.185],
    neck: [0.085, 0.225],
};

pub(crate) const MAN: BodyForm = BodyForm {
    trunk: [
        [0.490, 0.140, 0.068, 0.076],
        [0.537, 0.160, 0.088, 0.094],
        [0.575, 0.168, 0.100, 0.106],
        [0.598, 0.168, 0.104, 0.108],
        [0.640, 0.155, 0.104, 0.096],
        [0.690, 0.131, 0.096, 0.078],
        [0.725, 0.122, 0.092, 0.072],
        [0.765, 0.130, 0.096, 0.078],
        [0.800, 0.139, 0.100, 0.090],
        [0.828, 0.145, 0.102, 0.099],
        [0.870, 0.150, 0.096, 0.108],
        [0.910, 0.144, 0.076, 0.106],
        [0.945, 0.116, 0.052, 0.092],
        [0.970, 0.076, 0.034, 0.070],
    ],
    breast: 0.0,
    chest: 0.013,
    belly: 0.002,
    seat: 0.90,
    arm: 1.06,
    hand: 1.06,
    foot: 1.03,
    jaw: 1.06,
    relief: 1.15,
    shoulders: [0.13, 0.185],
    neck: [0.085, 0.225],
};

pub(crate) const CHILD: BodyForm = BodyForm {
    trunk: [
        [0.490, 0.142, 0.078, 0.080],
        [0.537, 0.158, 0.098, 0.104],
        [0.575, 0.162, 0.110, 0.118],
        [0.598, 0.160, 0.116, 0.118],
        [0.640, 0.150, 0.120, 0.104],
        [0.690, 0.126, 0.110, 0.084],
        [0.725, 0.118, 0.102, 0.080],
        [0.765, 0.126, 0.100, 0.086],
        [0.800, 0.134, 0.100, 0.096],
        [0.828, 0.140, 0.100, 0.104],
        [0.870, 0.142, 0.092, 0.110],
        [0.910, 0.134, 0.072, 0.104],
        [0.945, 0.106, 0.048, 0.088],
        [0.970, 0.070, 0.032, 0.068],
    ],
    breast: 0.0,
    chest: 0.0,
    belly: 0.012,
    seat: 0.88,
    arm: 1.0,
    hand: 1.0,
    foot: 1.0,
    jaw: 0.95,
    relief: 0.5,
    shoulders: [0.13, 0.185],
    neck: [0.085, 0.225],
};

impl BodyForm {
    /// The mixture with another: a share of 0 is this form, 1 the other.
    pub(crate) fn towards(&self, other: &BodyForm, share: f64) -> BodyForm {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let both = |a: [f64; 2], b: [f64; 2]| [mix(a[0], b[0]), mix(a[1], b[1])];
        BodyForm {
            trunk: std::array::from_fn(|r| std::array::from_fn(|c| mix(self.trunk[r][c], other.trunk[r][c]))),
            breast: mix(self.breast, other.breast),
            chest: mix(self.chest, other.chest),
            belly: mix(self.belly, other.belly),
            seat: mix(self.seat, other.seat),
            arm: mix(self.arm, other.arm),
            hand: mix(self.hand, other.hand),
            foot: mix(self.foot, other.foot),
            jaw: mix(self.jaw, other.jaw),
            relief: mix(self.relief, other.relief),
            shoulders: both(self.shoulders, other.shoulders),
            neck: both(self.neck, other.neck),
        }
    }
}
