//! A map as text with commas: one line per cell.

use super::Map;
use super::cell::{Cell, Outcome};

/// The first line.
const HEAD: &str = "solver,edge_m,stiffness_n_per_m,dt_s,explicit_limit_s,outcome,error_lengths,speed_m_s,steps,cpu_s,refused_as";

impl Map {
    /// The cells, a line each under a head.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let lines = self.cells.iter().map(line);
        std::iter::once(HEAD.to_owned()).chain(lines).map(|l| l + "\n").collect()
    }

    /// All of it as JSON, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

fn line(c: &Cell) -> String {
    let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.4e}"));
    let refused = match &c.outcome {
        Outcome::Refused { error_name, .. } => error_name.as_str(),
        _ => "",
    };
    [
        c.scheme.key().to_owned(),
        format!("{:.4e}", c.edge),
        format!("{:.4e}", c.stiffness),
        number(c.dt),
        format!("{:.4e}", c.limit),
        c.outcome.word().to_owned(),
        number(c.error),
        number(c.speed),
        c.steps.to_string(),
        format!("{:.4}", c.seconds),
        refused.to_owned(),
    ]
    .join(",")
}
