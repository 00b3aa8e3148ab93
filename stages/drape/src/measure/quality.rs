//! Figures of the garment against its quality limits.
//!
//! Area and outline errors are those of Fan et al. 1999, `(S2 - S3) / S2` and `(L2 - L3) / L2`;
//! strain is that of the mesh edges. What the body stretches is judged by itself (see `tight`).
//! Vertices in the body and self-contact are asked of the pipeline's collider, what crosses the
//! body between its vertices is found on the body's own triangles; without collider or body they
//! are not measured, and `metrics.json` says so with a null. A garment that a flattener stands
//! behind is judged by the pattern that it was sewn from; the flat pieces have figures of their
//! own.

use super::tight::Tight;
use super::{girth, looks, on_body, parts, shortfalls, with_pattern};
use crate::collide::body_crossings;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::artifact::{
    BodyContact, GarmentFigures, PanelFigures, PenetrationFigures, StrainFigures, quantile,
};
use toile_core::prelude::*;

/// Depth below which a vertex on the skin does not count as inside the body, metres.
const SKIN_TOLERANCE: f64 = 1e-4;

/// Measures the garment and compares it with its quality limits.
///
/// A pipeline gets this stage by itself; name it in the file to set other limits. A result that
/// misses a limit is written all the same, with exit code 4: so does a garment that has slid off
/// the body or has come apart. Where a flattener stands behind, the garment is judged by the
/// pattern that it was sewn from; the flat pieces have figures of their own, `flat`. What looks odd
/// on a garment within its limits is reported in warnings: seams that stand out as fins, shoulders
/// that stand off, an uneven hem, a photo that is drawn out.
#[stage(
    role = Writer,
    version = 9,
    source = "Fan, Zhou, Wang, Yuen 1999",
    contracts(Deterministic, ThreadInvariant),
    example = "Measure(max_strain: 0.08)"
)]
pub struct Measure {
    /// Greatest seam gap.
    #[param(default = Length::mm(1.0), min = 0.0, max = 1.0)]
    max_gap: Length,
    /// Greatest area error of a panel, as a share; triangles that the body stretches count as they
    /// were cut.
    #[param(default = 0.03, min = 0.0, max = 1.0)]
    max_area_error: f64,
    /// Greatest outline error of a panel, as a share; edges that the body stretches count as they
    /// were cut.
    #[param(default = 0.03, min = 0.0, max = 1.0)]
    max_outline_error: f64,
    /// Greatest 99th percentile of the edge strain, as a share; edges that the body stretches count
    /// as not strained.
    #[param(default = 0.05, min = 0.0, max = 10.0)]
    max_strain: f64,
    /// Greatest 99th percentile of the strain of a panel's edges that the body stretches, as a
    /// share: they lie on the body or are connected with it through cloth that is stretched by 0.5
    /// % and more, and the cloth there is longer in some direction than it was cut, by at least as
    /// much. Beyond it the garment is too small for the body (woven cotton tears at some 25 %);
    /// from `max_strain` on a warning names the panel.
    #[param(default = 0.25, min = 0.0, max = 10.0)]
    max_tight: f64,
    /// Least share of every panel that must still be in its place on the body. It is 1 less the
    /// share by which the panel with all that it is sewn to has come down: in the mean (of cloth
    /// that starts lying, its upper edge), from where it started or from the top of the body under
    /// it, as a share of the height of the tallest of these pieces.
    #[param(default = 0.8, min = 0.0, max = 1.0)]
    least_on_body: f64,
    /// Most pairs of a triangle of the garment and one of the body that cross.
    #[param(default = 0, min = 0, max = 1_000_000, unit = "pairs")]
    max_body_crossings: usize,
}

#[stage]
impl Measure {
    fn run(
        &self,
        #[sewn] garment: &Garment,
        collider: Option<&Collider>,
        body: Option<&Body>,
        flat: Option<&Garment>,
        #[original] start: Option<&Garment>,
        cx: &Context,
    ) -> Result<Figures, StageError> {
        let laid = flat.filter(|flat| flat.rest != garment.rest);
        let garment = with_pattern(garment, laid);
        garment.check_solvable()?;
        let tight = Tight::of(garment, collider);
        let mut figures = Figures {
            panels: panel_figures(garment, None)?,
            garment: garment_figures(garment, collider, body),
            flat: laid.map_or_else(|| Ok(BTreeMap::new()), |flat| panel_figures(flat, None))?,
            shortfalls: Vec::new(),
        };
        figures.garment.tight_p99 = collider.map(|_| tight.taut());
        let loose = panel_figures(garment, Some(&tight))?;
        figures.shortfalls = self.limits().missed(garment, &figures.garment, &loose, tight.rest());
        figures.shortfalls.extend(tight.judge(garment, self.max_strain, self.max_tight, cx));
        girth::tell(&figures.garment.girths, cx);
        looks::tell(garment, collider, cx);
        figures.shortfalls.extend(on_body::shortfalls(garment, self.least_on_body));
        figures.shortfalls.extend(start.and_then(|start| parts::come_apart(start, garment)));
        Ok(figures)
    }

    fn limits(&self) -> shortfalls::FigureLimits {
        shortfalls::FigureLimits {
            gap: self.max_gap,
            area_error: self.max_area_error,
            outline_error: self.max_outline_error,
            strain: self.max_strain,
            body_crossings: self.max_body_crossings,
        }
    }
}

/// The vertices along elastic bands, which are there to draw cloth in.
fn drawn_in(garment: &Garment) -> BTreeSet<u32> {
    let elastic = garment.seams.iter().filter(|s| matches!(s.kind, SeamKind::Elastic { .. }));
    elastic.flat_map(|s| s.pairs.iter().flatten().copied()).collect()
}

/// Figures of each panel; what is `tight` counts as long and as large as it was cut, and so does an
/// edge that an elastic band draws in.
///
/// # Errors
/// A panel has no area or no outline.
pub fn panel_figures(
    garment: &Garment,
    tight: Option<&Tight>,
) -> Result<BTreeMap<String, PanelFigures>, StageError> {
    let error = |(flat, now): (f64, f64)| (flat - now) / flat;
    let drawn = drawn_in(garment);
    let figures = |p: &GarmentPanel| {
        if garment.panel_areas(p).0 <= 0.0 || garment.panel_boundaries(p).0 <= 0.0 {
            let text = format!("panel \"{}\" has no area or no outline to be judged by", p.name);
            return Err(StageError::new(ErrorCode::DegenerateTriangles, text).hint("mesh the panel again"));
        }
        let figures = PanelFigures {
            area_error: error(garment.panel_areas_but(p, |t, flat, now| {
                tight.is_some_and(|tight| tight.stretches_triangle(t, flat, now))
            })),
            outline_error: error(garment.panel_boundaries_but(p, |e| {
                let is_drawn = || e.iter().all(|v| drawn.contains(v));
                tight.is_some_and(|tight| tight.stretches_edge(e) || is_drawn())
            })),
        };
        Ok((p.name.clone(), figures))
    };
    garment.panels.iter().map(figures).collect()
}

fn garment_figures(garment: &Garment, collider: Option<&Collider>, body: Option<&Body>) -> GarmentFigures {
    let strains = garment.edge_strains();
    GarmentFigures {
        vertices: garment.positions.len(),
        triangles: garment.triangles.len(),
        seam_gap_max_m: garment.seam_gap_max(),
        edge_strain: StrainFigures {
            p50: quantile(&strains, 0.5),
            p99: quantile(&strains, 0.99),
            max: strains.last().copied().unwrap_or(0.0),
        },
        tight_p99: None,
        body_penetration: collider.map(|c| penetration(garment, c)),
        body_crossings: body.map(|b| body_crossings(&garment.positions, &garment.triangles, b)),
        self_crossings: collider.map(|c| crossings(garment, c)),
        on_body: on_body::least(garment),
        girths: body.map(|b| girth::girths(garment, b)).unwrap_or_default(),
        energy_j: garment.status.energy,
        max_speed_m_s: garment.status.max_speed,
        steps: garment.status.steps,
        converged: garment.status.converged,
    }
}

fn penetration(garment: &Garment, collider: &Collider) -> PenetrationFigures {
    let mut contacts: Vec<BodyContact> = Vec::new();
    collider.scheme.body_contacts(&garment.positions, 0.0, &mut contacts);
    let depths = contacts.iter().map(|c| -c.distance);
    PenetrationFigures {
        vertices: depths.clone().filter(|&d| d > SKIN_TOLERANCE).count(),
        max_m: depths.fold(0.0, f64::max),
    }
}

fn crossings(garment: &Garment, collider: &Collider) -> usize {
    let welded: Vec<[u32; 3]> =
        garment.triangles.iter().map(|t| t.map(|i| garment.weld[i as usize])).collect();
    collider.scheme.self_crossings(&garment.positions, &welded).len()
}
