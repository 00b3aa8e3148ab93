//! Figures that describe an artifact in a golden sheet or a report.

/// One figure with its unit and the change that a golden accepts.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// What is measured, in snake case: `area`, `boundary_loops`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit, empty for counts and ratios.
    pub unit: &'static str,
    /// The absolute difference under which two values count as equal.
    pub tolerance: f64,
}

/// The figures of one artifact, in the order in which they are shown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measures(pub Vec<Measure>);

impl Measures {
    /// No figures yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a count, which must agree exactly.
    pub fn count(&mut self, name: &str, value: usize) -> &mut Self {
        self.push(name, value as f64, "", 0.0)
    }

    /// Adds a figure with unit and absolute tolerance.
    pub fn push(&mut self, name: &str, value: f64, unit: &'static str, tolerance: f64) -> &mut Self {
        self.0.push(Measure { name: name.to_owned(), value, unit, tolerance });
        self
    }

    /// The figure of that name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|m| m.name == name).map(|m| m.value)
    }
}
