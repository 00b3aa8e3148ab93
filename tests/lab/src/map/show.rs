//! A map as tables: a grid of signs a solver and edge length, then the quickest cells.

use super::cell::{Cell, Outcome};
use super::quickest::Quickest;
use super::scheme::Scheme;
use super::{Map, OFF};
use crate::table::Table;
use std::fmt;

impl fmt::Display for Map {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for scheme in self.schemes().into_iter().filter(|s| s.steps_in_time()) {
            writeln!(f, "{}: {}\n", scheme.name(), scheme.theory())?;
            for &along in &self.along {
                self.grid(scheme, along).map_or(Ok(()), |table| writeln!(f, "{table}"))?;
            }
        }
        writeln!(
            f,
            "Numbers: digits of the answer, -log10 of its error in lengths, at rest within {OFF}. off: at rest farther away; \
             drifts: not at rest, or flown away; X: refused; .: too long.\n"
        )?;
        writeln!(f, "CPU s, of the time steps the quickest that keeps an error of {} lengths:\n", self.keep)?;
        write!(f, "{}", self.times())
    }
}

impl Map {
    /// The solvers that have cells, in order.
    #[must_use]
    pub fn schemes(&self) -> Vec<Scheme> {
        let mut schemes: Vec<Scheme> = self.cells.iter().map(|c| c.scheme).collect();
        schemes.dedup();
        schemes
    }

    /// Stiffness down, time step across; none where no cell ran.
    fn grid(&self, scheme: Scheme, along: usize) -> Option<Table> {
        let cells: Vec<&Cell> =
            self.cells.iter().filter(|c| c.scheme == scheme && c.along == along).collect();
        let edge = format!("edge {:.1} mm, N/m", 1e3 * cells.first()?.edge);
        let steps = self.steps.iter().map(|dt| format!("{dt:.0e} s"));
        let head: Vec<String> = std::iter::once(edge).chain(steps).chain(["2/omega_max".into()]).collect();
        let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
        for row in cells.chunk_by(|a, b| a.stiffness.to_bits() == b.stiffness.to_bits()) {
            let mut signs: Vec<String> = row.iter().map(|c| sign(c)).collect();
            signs.resize(self.steps.len(), String::new());
            let (name, limit) = (format!("{:.3}", row[0].stiffness), format!("{:.1e} s", row[0].limit));
            table.cells([vec![name], signs, vec![limit]].concat());
        }
        Some(table)
    }

    /// A row a sheet, a column a solver.
    fn times(&self) -> Table {
        let schemes = self.schemes();
        let names = schemes.iter().map(|s| s.name());
        let mut table = Table::new(&["edge mm", "N/m"].into_iter().chain(names).collect::<Vec<_>>());
        for first in self.quickest.iter().filter(|q| Some(&q.scheme) == schemes.first()) {
            let edge = self.cells.iter().find(|c| c.along == first.along).map_or(0.0, |c| 1e3 * c.edge);
            let is_here =
                |q: &&Quickest| q.along == first.along && q.stiffness.to_bits() == first.stiffness.to_bits();
            let time = |s: &Scheme| {
                self.quickest.iter().filter(is_here).find(|q| q.scheme == *s).map_or(String::new(), time)
            };
            let place = [format!("{edge:.1}"), format!("{:.3}", first.stiffness)];
            table.cells(place.into_iter().chain(schemes.iter().map(time)).collect());
        }
        table
    }
}

fn time(q: &Quickest) -> String {
    let at = |dt: Option<f64>| dt.map_or(String::new(), |dt| format!(" at {dt:.0e} s"));
    q.best.map_or("-".into(), |b| format!("{:.4}{}", b.seconds, at(b.dt)))
}

fn sign(c: &Cell) -> String {
    match (&c.outcome, c.error) {
        (Outcome::Converges, Some(e)) => format!("{:.1}", -e.max(1e-12).log10()),
        (Outcome::Off, Some(e)) => format!("off {e:.2}"),
        (Outcome::Refused { .. }, _) => "X".into(),
        (Outcome::TooLong, _) => ".".into(),
        _ => "drifts".into(),
    }
}
