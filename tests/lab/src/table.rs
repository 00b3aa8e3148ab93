//! Text tables in the form of Markdown, with columns lined up.

use std::fmt;

/// Rows of cells under a head.
pub(super) struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// With this head.
    pub(super) fn new(head: &[&str]) -> Self {
        Self { rows: vec![head.iter().map(|h| (*h).into()).collect()] }
    }

    /// Adds a row; as many cells as the head has.
    pub(super) fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push(cells.into());
    }

    /// The same, where the number of columns is not known beforehand.
    pub(super) fn cells(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows[0].len();
        let width =
            |c: usize| self.rows.iter().map(|r| r.get(c).map_or(0, |s| s.chars().count())).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(|c| width(c).max(3)).collect();
        for (k, row) in self.rows.iter().enumerate() {
            for (cell, w) in row.iter().zip(&widths) {
                write!(f, "| {cell:w$} ")?;
            }
            writeln!(f, "|")?;
            if k == 0 {
                let line: String = widths.iter().map(|w| format!("|{}", "-".repeat(w + 2))).collect();
                writeln!(f, "{line}|")?;
            }
        }
        Ok(())
    }
}
