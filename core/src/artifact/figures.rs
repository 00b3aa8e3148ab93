//! What a finished garment is judged by.

use super::{Artifact, ArtifactType, Kind, Measures};
use crate::ErrorCode;
use crate::artifact::store::sound::finite_figure;
use serde::Serialize;
use std::collections::BTreeMap;

/// How true a panel stayed, 2D to 3D.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PanelFigures {
    /// `(S2 - S3) / S2`: share of the flat area lost in space.
    pub area_error: f64,
    /// `(L2 - L3) / L2`: share of the flat outline's length lost in space.
    pub outline_error: f64,
}

/// Absolute strain of the mesh edges.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StrainFigures {
    /// Median.
    pub p50: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Greatest.
    pub max: f64,
}

/// Vertices inside the body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PenetrationFigures {
    /// How many are deeper than 0.1 mm.
    pub vertices: usize,
    /// Greatest depth, metres.
    pub max_m: f64,
}

/// The tape around a garment and around its body, at the same height.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct GirthFigures {
    /// Cloth, as long as it was cut, metres.
    pub cloth_m: f64,
    /// The body's measure, metres.
    pub body_m: f64,
}

/// The garment's figures, SI units; the names are those of `metrics.json`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct GarmentFigures {
    /// Vertices, each panel counted for itself.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Greatest distance between the two sides of a seam.
    pub seam_gap_max_m: f64,
    /// Strain of edges.
    pub edge_strain: StrainFigures,
    /// 99th percentile of the strain of the edges that the body stretches; `None` without a body.
    pub tight_p99: Option<f64>,
    /// Vertices inside the body; `None` without a body.
    pub body_penetration: Option<PenetrationFigures>,
    /// Pairs of a triangle of the garment and one of the body that cross; `None` without a body.
    pub body_crossings: Option<usize>,
    /// Pairs of triangles that cross; `None` where nothing looked.
    pub self_crossings: Option<usize>,
    /// The share that is still in its place on the body, of the panel that has slid farthest;
    /// `None` where it was not measured.
    pub on_body: Option<f64>,
    /// By level (`bust`, `waist`, `hip`): where the garment closes around its body.
    pub girths: BTreeMap<String, GirthFigures>,
    /// Elastic and gravitational energy.
    pub energy_j: f64,
    /// Greatest speed of a vertex at the end.
    pub max_speed_m_s: f64,
    /// Solver steps.
    pub steps: usize,
    /// True where every stop rule was met.
    pub converged: bool,
}

/// A quality limit that the result misses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shortfall {
    /// The stable word.
    pub code: ErrorCode,
    /// What is wrong, with the figure and the limit.
    pub message: String,
}

/// The judgement of a garment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figures {
    /// By panel name.
    pub panels: BTreeMap<String, PanelFigures>,
    /// The whole garment.
    pub garment: GarmentFigures,
    /// By name of a piece that was laid flat: how far the flat piece is from the garment; empty
    /// where nothing was laid flat.
    pub flat: BTreeMap<String, PanelFigures>,
    /// The limits that are missed; empty for a good result.
    pub shortfalls: Vec<Shortfall>,
}

impl ArtifactType for Figures {
    const KIND: Kind = Kind("figures");
    const IN_SETS: bool = false;
}

impl Artifact for Figures {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let g = &self.garment;
        let mut m = Measures::new();
        for (name, p) in &self.panels {
            m.push(&format!("{name}.area_error"), p.area_error * 1e2, "%", 0.3);
            m.push(&format!("{name}.outline_error"), p.outline_error * 1e2, "%", 0.3);
        }
        m.push("seam_gap_max", g.seam_gap_max_m * 1e3, "mm", 0.5);
        m.push("strain_p99", g.edge_strain.p99 * 1e2, "%", 1.0);
        for (level, girth) in &g.girths {
            m.push(&format!("cloth_at_{level}"), girth.cloth_m * 1e3, "mm", 5.0);
        }
        if let Some(p) = &g.body_penetration {
            m.count("vertices_in_body", p.vertices);
        }
        if let Some(crossings) = g.body_crossings {
            m.count("body_crossings", crossings);
        }
        if let Some(crossings) = g.self_crossings {
            m.count("self_crossings", crossings);
        }
        m.count("shortfalls", self.shortfalls.len());
        m
    }

    fn check(&self) -> Result<(), String> {
        let panels =
            self.panels.values().chain(self.flat.values()).flat_map(|p| [p.area_error, p.outline_error]);
        panels.into_iter().try_for_each(|e| finite_figure("error of a panel", e))?;
        finite_figure("seam gap", self.garment.seam_gap_max_m)
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}
