//! What is asked of a setting: an error, a time, or both.

/// What is asked of a setting.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Wish {
    /// 95 % of the surface this near to the reference, mm.
    pub max_error_mm: Option<f64>,
    /// A run no longer than this, seconds by the record's clock.
    pub max_time_s: Option<f64>,
}

impl Wish {
    /// Whether figures keep it.
    pub fn is_kept(&self, error_mm: f64, seconds: f64) -> bool {
        self.max_error_mm.is_none_or(|e| error_mm <= e) && self.max_time_s.is_none_or(|t| seconds <= t)
    }

    /// In words: `an error of at most 2 mm and a time of at most 1 s`.
    pub fn words(&self) -> String {
        let error = self.max_error_mm.map(|e| format!("an error of at most {e} mm"));
        let time = self.max_time_s.map(|t| format!("a time of at most {t} s"));
        error.into_iter().chain(time).collect::<Vec<_>>().join(" and ")
    }
}
