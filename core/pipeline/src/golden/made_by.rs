//! What a sheet was made by: every stage with its version and its parameters, so that a difference
//! can be told to be the user's own.

use super::GoldenSheet;
use crate::load::{Pipeline, differing};

/// A stage that made something of a sheet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MadeBy {
    /// Its id.
    pub id: String,
    /// Its name.
    pub stage: String,
    /// The version of its algorithm.
    pub version: u32,
    /// Its parameters as RON on one line, defaults included.
    pub params: String,
}

impl MadeBy {
    /// The value of its line in a sheet: `GridMesher 2 (edge:"16 mm")`.
    pub(super) fn value(&self) -> String {
        format!("{} {} {}", self.stage, self.version, self.params)
    }

    /// From such a value; none where it is none.
    pub(super) fn parsed(id: &str, value: &str) -> Option<Self> {
        let mut words = value.splitn(3, ' ');
        let (stage, version, params) = (words.next()?, words.next()?, words.next()?);
        let is_word = |text: &str| !text.is_empty() && !text.contains(' ');
        (is_word(id) && is_word(stage)).then_some(())?;
        Some(MadeBy {
            id: id.to_owned(),
            stage: stage.to_owned(),
            version: version.parse().ok()?,
            params: params.to_owned(),
        })
    }

    /// What is otherwise in `now`, a line each: `GridMesher: edge "16 mm" -> "12 mm"`.
    fn changes(&self, now: &MadeBy) -> Vec<String> {
        let id = &self.id;
        if self.stage != now.stage {
            return vec![format!("{id}: stage {} -> {}", self.stage, now.stage)];
        }
        let version = (self.version != now.version)
            .then(|| format!("{id}: version {} -> {} of its algorithm", self.version, now.version));
        let none = |text: Option<String>| text.unwrap_or_else(|| "(none)".to_owned());
        let fields = differing(&self.params, &now.params);
        let fields = fields.into_iter().map(|d| match d.path.is_empty() {
            true => format!("{id}: {} -> {}", none(d.was), none(d.is)),
            false => format!("{id}: {} {} -> {}", d.path, none(d.was), none(d.is)),
        });
        version.into_iter().chain(fields).collect()
    }
}

impl GoldenSheet {
    /// The sheet with what its artifacts are made by in this pipeline.
    #[must_use]
    pub fn made_by(mut self, pipeline: &Pipeline) -> Self {
        let nodes = pipeline.nodes.iter().filter(|n| self.sections.iter().any(|s| s.stage == n.id));
        let made_by = |n: &toile_core::Node| MadeBy {
            id: n.id.clone(),
            stage: n.card.name.to_owned(),
            version: n.card.version,
            params: n.stage.params().replace('\n', " "),
        };
        self.stages = nodes.map(made_by).collect();
        self
    }
}

/// What is made by other parameters, or by another version of a stage, than in the golden; nothing
/// of a golden that does not say.
pub(super) fn changes(golden: &GoldenSheet, now: &GoldenSheet) -> Vec<String> {
    let change = |was: &MadeBy| {
        let is = now.stages.iter().find(|is| is.id == was.id);
        is.map_or_else(Vec::new, |is| was.changes(is))
    };
    golden.stages.iter().flat_map(change).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made_by(params: &str, version: u32) -> MadeBy {
        MadeBy { id: "Photos".into(), stage: "Photos".into(), version, params: params.into() }
    }

    #[test]
    fn each_field_that_differs_is_named_as_deep_as_it_lies() {
        let was =
            made_by(r#"(photos:{"front":(file:"a.jpg",width:"52 cm"),"back":MirrorOf("front")},k:1)"#, 1);
        let is = made_by(
            r#"(photos:{"front":(file:"a.jpg",width:"50 cm"),"back":MirrorOf("front")},k:2,l:[3])"#,
            2,
        );
        assert_eq!(was.changes(&was), [""; 0]);
        assert_eq!(
            was.changes(&is),
            [
                "Photos: version 1 -> 2 of its algorithm",
                "Photos: photos.front.width \"52 cm\" -> \"50 cm\"",
                "Photos: k 1 -> 2",
                "Photos: l (none) -> [3]",
            ]
        );
        let other = MadeBy { stage: "Scene".into(), ..is };
        assert_eq!(was.changes(&other), ["Photos: stage Photos -> Scene"]);
    }

    #[test]
    fn a_line_reads_back() {
        let one = made_by("(a:\"x = y\", b:(1, 2))", 3);
        assert_eq!(MadeBy::parsed("Photos", &one.value()), Some(one));
        for none in ["", "Photos", "Photos 1", "Photos x ()", " 1 ()"] {
            assert_eq!(MadeBy::parsed("Photos", none), None, "{none}");
        }
    }
}
