//! The drivers as tables, CSV and JSON.

use super::{Driver, Power, Report, Row, Scene};
use crate::table::Table;
use std::fmt;

/// The first line of the CSV.
const HEAD: &str = "scene,driver,solver,particles,dt_s,error,cpu_s,refused";

impl Scene {
    fn title(self) -> &'static str {
        match self {
            Self::Swing => "swing of a hanging strip, one period (error: r.m.s. over the swing's)",
            Self::Catenary => "catenary at rest (error: of the sag, in lengths)",
        }
    }
}

impl Driver {
    fn title(self) -> &'static str {
        match self {
            Self::Particles => "particles at a fixed step",
            Self::Step => "step at fixed particles",
        }
    }
}

impl Report {
    /// As JSON, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// The runs, a line each under a head.
    #[must_use]
    pub fn to_csv(&self) -> String {
        std::iter::once(HEAD.to_owned()).chain(self.rows.iter().map(line)).map(|l| l + "\n").collect()
    }
}

fn line(r: &Row) -> String {
    let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.4e}"));
    let quoted = |s: &str| format!("\"{}\"", s.replace('"', "'"));
    [
        format!("{:?}", r.scene).to_lowercase(),
        format!("{:?}", r.driver).to_lowercase(),
        quoted(&r.way.name()),
        r.particles.to_string(),
        number(r.dt),
        number(r.error),
        format!("{:.5}", r.seconds),
        r.refused.as_deref().map_or(String::new(), quoted),
    ]
    .join(",")
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for rows in self.rows.chunk_by(|a, b| (a.scene, a.driver) == (b.scene, b.driver)) {
            writeln!(f, "{}: {}\n\n{}", rows[0].scene.title(), rows[0].driver.title(), runs(rows))?;
        }
        writeln!(
            f,
            "Powers of the driver, with the points' scatter about the law as a factor:\n\n{}",
            self.powers()
        )?;
        write!(f, "X: refused by its limit; .: too long or not solved, see the CSV.")
    }
}

/// A row a solver, a column a value of the driver: error in CPU time.
fn runs(rows: &[Row]) -> Table {
    let by_way: Vec<&[Row]> = rows.chunk_by(|a, b| a.way == b.way).collect();
    let longest = by_way.iter().max_by_key(|r| r.len()).copied().unwrap_or_default();
    let value = |r: &Row| match (r.driver, r.dt) {
        (Driver::Step, Some(dt)) => format!("{dt} s"),
        _ => r.particles.to_string(),
    };
    let head: Vec<String> =
        std::iter::once("error in CPU s".to_owned()).chain(longest.iter().map(value)).collect();
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for way in by_way {
        let at = match (way[0].driver, way[0].dt) {
            (Driver::Particles, Some(dt)) => format!(" at {dt} s"),
            _ => String::new(),
        };
        let mut cells = vec![format!("{}{at}", way[0].way.name())];
        cells.extend(way.iter().map(cell));
        cells.resize(head.len(), String::new());
        table.cells(cells);
    }
    table
}

fn cell(r: &Row) -> String {
    match (r.error, &r.refused) {
        (Some(e), _) => format!("{e:.1e} in {:.3}", r.seconds),
        (None, Some(why)) if why.contains("unstable") => "X".into(),
        _ => ".".into(),
    }
}

impl Report {
    fn powers(&self) -> Table {
        let mut table = Table::new(&["scene", "driver", "solver", "time", "error"]);
        let power =
            |p: Option<Power>| p.map_or("-".into(), |p| format!("{:+.2} (x{:.2})", p.exponent, p.scatter));
        for fit in &self.fits {
            table.row([
                format!("{:?}", fit.scene).to_lowercase(),
                format!("{:?}", fit.driver).to_lowercase(),
                fit.way.name(),
                power(fit.time),
                power(fit.error),
            ]);
        }
        table
    }
}
