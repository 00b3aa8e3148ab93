//! A mixture of Gaussians over Lab colours.
//!
//! The colours are split in two along the axis of their largest spread, again and again, the
//! cluster with the largest spread first (Orchard and Bouman, Color quantization of images, IEEE
//! TSP 39(12), 1991), and the clusters are then settled by a few rounds of nearest-mean. Nothing is
//! drawn at random.

use super::small::Lab;
use nalgebra::Matrix3;

/// One Gaussian.
#[derive(Debug, Clone, Copy)]
struct Mode {
    mean: Lab,
    inverse: Matrix3<f64>,
    /// -ln(weight) + ln(det) / 2.
    offset: f64,
}

/// A mixture of Gaussians.
#[derive(Debug, Clone)]
pub(super) struct Mixture {
    modes: Vec<Mode>,
}

/// Added to the variance of each mode, squared Lab units: camera noise and the compression's
/// blocks, and what keeps a plain ground's mode from refusing a slight shade.
const LEAST_VARIANCE: f64 = 4.0;
/// Rounds of nearest-mean after the splits. More change little.
const ROUNDS: usize = 4;

impl Mixture {
    /// Fits `count` modes (fewer where the colours are fewer); modes that hold less than `least` of
    /// the colours are dropped. `None` for no colours.
    pub(super) fn fit(colours: &[Lab], count: usize, least: f64) -> Option<Mixture> {
        let mut clusters = vec![colours.to_vec()];
        while clusters.len() < count {
            let spreads = clusters.iter().map(|c| ColourSpread::of(c).map_or(0.0, |s| s.largest));
            let widest = spreads.enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
            let Some((i, _)) = widest.filter(|(_, s)| *s > LEAST_VARIANCE) else { break };
            let (below, above) = ColourSpread::of(&clusters[i])?.split(&clusters[i]);
            clusters[i] = below;
            clusters.push(above);
        }
        for _ in 0..ROUNDS {
            clusters = settle(&clusters, colours);
        }
        let total = colours.len() as f64;
        let large = |c: &&Vec<Lab>| !c.is_empty() && c.len() as f64 >= least * total;
        let modes: Vec<Mode> = clusters.iter().filter(large).filter_map(|c| Mode::of(c, total)).collect();
        (!modes.is_empty()).then_some(Mixture { modes })
    }

    /// -ln of the likelihood of a colour under its best mode, up to a constant that all mixtures
    /// share.
    pub(super) fn cost(&self, colour: &Lab) -> f64 {
        let cost = |m: &Mode| m.offset + 0.5 * m.distance2(colour);
        self.modes.iter().map(cost).fold(f64::INFINITY, f64::min)
    }

    /// The colour's distance from the nearest mode, in that mode's standard deviations.
    pub(super) fn distance(&self, colour: &Lab) -> f64 {
        self.modes.iter().map(|m| m.distance2(colour)).fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The distance where a shadow of a mode counts as that mode. A shadow is darker and has the
    /// same hue; `depth` is the share of the mode's lightness that it may take.
    pub(super) fn shaded_distance(&self, colour: &Lab, depth: f64) -> f64 {
        let distance2 = |m: &Mode| m.distance2(&m.lit(colour, depth));
        self.modes.iter().map(distance2).fold(f64::INFINITY, f64::min).sqrt()
    }
}

impl Mode {
    fn of(colours: &[Lab], total: f64) -> Option<Mode> {
        let spread = ColourSpread::of(colours)?;
        let covariance = spread.covariance + Matrix3::identity() * LEAST_VARIANCE;
        let inverse = covariance.try_inverse()?;
        let offset = covariance.determinant().ln() / 2.0 - (colours.len() as f64 / total).ln();
        Some(Mode { mean: spread.mean, inverse, offset })
    }

    /// A colour in this mode's light, if it may be a shadow. Less light scales all of a surface's
    /// X, Y, Z alike, and L + 16, a and b by the cube root of that.
    fn lit(&self, colour: &Lab, depth: f64) -> Lab {
        if colour.x >= self.mean.x || colour.x < (1.0 - depth) * self.mean.x {
            return *colour;
        }
        let scale = (self.mean.x + 16.0) / (colour.x + 16.0);
        Lab::new(self.mean.x, colour.y * scale, colour.z * scale)
    }

    fn distance2(&self, colour: &Lab) -> f64 {
        let d = colour - self.mean;
        d.dot(&(self.inverse * d))
    }
}

/// Mean and spread of some colours.
struct ColourSpread {
    mean: Lab,
    covariance: Matrix3<f64>,
    largest: f64,
    axis: Lab,
}

impl ColourSpread {
    fn of(colours: &[Lab]) -> Option<ColourSpread> {
        let n = colours.len() as f64;
        if colours.is_empty() {
            return None;
        }
        let mean = colours.iter().sum::<Lab>() / n;
        let covariance =
            colours.iter().map(|c| (c - mean) * (c - mean).transpose()).sum::<Matrix3<f64>>() / n;
        let eigen = covariance.symmetric_eigen();
        let i = eigen.eigenvalues.imax();
        Some(ColourSpread {
            mean,
            covariance,
            largest: eigen.eigenvalues[i],
            axis: eigen.eigenvectors.column(i).into_owned(),
        })
    }

    fn split(&self, colours: &[Lab]) -> (Vec<Lab>, Vec<Lab>) {
        colours.iter().partition(|c| (**c - self.mean).dot(&self.axis) <= 0.0)
    }
}

/// One round of nearest-mean.
fn settle(clusters: &[Vec<Lab>], colours: &[Lab]) -> Vec<Vec<Lab>> {
    let means: Vec<Lab> =
        clusters.iter().filter(|c| !c.is_empty()).map(|c| c.iter().sum::<Lab>() / c.len() as f64).collect();
    let mut settled = vec![Vec::new(); means.len()];
    for c in colours {
        let nearest = means
            .iter()
            .enumerate()
            .min_by(|a, b| (a.1 - c).norm_squared().total_cmp(&(b.1 - c).norm_squared()));
        if let Some((i, _)) = nearest {
            settled[i].push(*c);
        }
    }
    settled
}
