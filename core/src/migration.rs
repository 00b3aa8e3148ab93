//! A change of a stage's name or parameters, as its crate lists it.

/// One change of a stage's name or parameters.
#[derive(Debug, Clone, Copy)]
pub struct Migration {
    /// The stage: its old name where that changed, else the one it has.
    pub stage: &'static str,
    /// What changed.
    pub change: Change,
}

/// What changed.
#[derive(Debug, Clone, Copy)]
pub enum Change {
    /// The stage has another name.
    Stage {
        /// The new name.
        to: &'static str,
        /// The argument that says what the old name said, `style: Vest`; empty where there is none.
        with: &'static str,
    },
    /// A parameter has another name, and its value may be written in another way.
    Param {
        /// The old name.
        from: &'static str,
        /// The new name.
        to: &'static str,
        /// The new value from the old one, both as RON; none where the value is no such thing.
        convert: fn(&str) -> Option<String>,
    },
    /// A parameter was removed.
    Removed {
        /// Its name.
        param: &'static str,
        /// What does its work now.
        why: &'static str,
    },
}

impl Migration {
    /// The stage `from` is now called `to`.
    pub const fn stage(from: &'static str, to: &'static str) -> Self {
        Self::joined(from, to, "")
    }

    /// The stage `from` is now `to` with the argument `with`, `style: Vest`.
    pub const fn joined(from: &'static str, to: &'static str, with: &'static str) -> Self {
        Migration { stage: from, change: Change::Stage { to, with } }
    }

    /// The parameter `from` is now called `to`.
    pub fn renamed(stage: &'static str, from: &'static str, to: &'static str) -> Self {
        Self::converted(stage, from, to, |value| Some(value.to_owned()))
    }

    /// The parameter `from` is now `to`, with its value written in another way.
    pub const fn converted(
        stage: &'static str,
        from: &'static str,
        to: &'static str,
        convert: fn(&str) -> Option<String>,
    ) -> Self {
        Migration { stage, change: Change::Param { from, to, convert } }
    }

    /// The parameter was removed; `why` says what does its work now.
    pub const fn removed(stage: &'static str, param: &'static str, why: &'static str) -> Self {
        Migration { stage, change: Change::Removed { param, why } }
    }

    /// True where it is about that parameter of that stage.
    pub fn of_param(&self, stage: &str, param: &str) -> bool {
        let name = match self.change {
            Change::Stage { .. } => return false,
            Change::Param { from, .. } => from,
            Change::Removed { param, .. } => param,
        };
        self.stage == stage && name == param
    }
}
