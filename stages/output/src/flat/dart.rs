//! Darts of flat pieces: none, proposed, or made.

use super::fault::flatten_fault;
use super::file::list;
use super::sheet::GarmentPieces;
use toile_core::prelude::*;
use toile_flatten::care::{Dart, DartOptions, Objective, propose_darts};
use toile_flatten::flatteners::Placement;

/// What becomes of cloth that cannot lie flat.
#[choice]
#[derive(Copy)]
pub enum Darts {
    /// It strains.
    None,
    /// Darts are drawn where the strain passes 1.5 per cent, and told with what each saves; none is
    /// cut.
    Propose,
    /// Darts are cut until the strain falls below a limit, or none saves enough.
    Auto {
        /// The strain that the cloth bears, spread over a neighbourhood, per cent: 0.01 to 100.
        max_strain: f64,
    },
}

impl Darts {
    /// Refuses a strain that is none.
    pub(super) fn checked(self) -> Result<(), StageError> {
        match self {
            Darts::Auto { max_strain } if !(0.01..=100.0).contains(&max_strain) => {
                let what = format!("a strain of {max_strain} per cent is not between 0.01 and 100");
                Err(StageError::new(ErrorCode::InvalidParameter, what)
                    .hint("1.5 suits woven cloth")
                    .at("darts"))
            }
            _ => Ok(()),
        }
    }

    fn options(self) -> Option<DartOptions> {
        let defaults = DartOptions::default();
        match self {
            Darts::None => None,
            Darts::Propose => Some(defaults),
            Darts::Auto { max_strain } => Some(DartOptions { max_strain: max_strain / 1e2, ..defaults }),
        }
    }
}

/// The darts of each piece as vertices from the boundary to the tip, each told.
pub(super) fn dart_paths(
    sheet: &GarmentPieces,
    objective: &Objective,
    placements: &[Placement],
    darts: Darts,
    cx: &Context,
) -> Result<Vec<Vec<Vec<u32>>>, StageError> {
    darts.checked()?;
    let Some(options) = darts.options() else { return Ok(Vec::new()) };
    let one = |i: usize| {
        cx.check()?;
        propose_darts(&sheet.pieces.pieces[i].surface, objective, &placements[i], options)
            .map_err(|e| flatten_fault(&e, &sheet.names[i]))
    };
    let found = cx.parallel_map(placements.len(), one).into_iter().collect::<Result<Vec<_>, _>>()?;
    if let Some(what) = told(&sheet.names, &found) {
        // Darts that are only proposed are the user's to judge.
        match darts {
            Darts::Propose => cx.warn(format!("darts would help, and none is cut: {what}")),
            Darts::None | Darts::Auto { .. } => cx.note(format!("darts are cut: {what}")),
        }
    }
    cx.figure("darts", found.iter().map(Vec::len).sum::<usize>() as f64, "");
    Ok(found.into_iter().map(|darts| darts.into_iter().map(|d| d.path).collect()).collect())
}

/// All darts in one sentence, pieces with the same ones together:
/// `dart 1 of "left" and "right" takes the strain from 2.1 % to 0.4 %`.
fn told(names: &[String], found: &[Vec<Dart>]) -> Option<String> {
    let mut by_words: Vec<(String, Vec<&str>)> = Vec::new();
    for (name, darts) in names.iter().zip(found).filter(|(_, darts)| !darts.is_empty()) {
        let words =
            darts.iter().enumerate().map(|(k, dart)| words(k + 1, dart)).collect::<Vec<_>>().join(", ");
        match by_words.iter_mut().find(|(w, _)| *w == words) {
            Some((_, pieces)) => pieces.push(name),
            None => by_words.push((words, vec![name])),
        }
    }
    let one = |(words, pieces): &(String, Vec<&str>)| format!("on {} {words}", list(pieces.iter().copied()));
    (!by_words.is_empty()).then(|| by_words.iter().map(one).collect::<Vec<_>>().join("; "))
}

fn words(number: usize, dart: &Dart) -> String {
    let [before, after] = dart.strain.map(|s| s * 1e2);
    let with = dart.mirror.map_or_else(String::new, |m| format!(" with its mirror image, dart {}", m + 1));
    format!("dart {number}{with} takes the strain from {before:.1} % to {after:.1} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_and_right_pieces_are_told_once() {
        let dart = |before: f64| Dart { path: vec![0, 1], strain: [before, 0.004], saves: 0.5, mirror: None };
        let names = ["left", "back", "right"].map(str::to_owned);
        let found = [vec![dart(0.021)], vec![], vec![dart(0.021)]];
        assert_eq!(
            told(&names, &found).unwrap_or_default(),
            "on \"left\" and \"right\" dart 1 takes the strain from 2.1 % to 0.4 %"
        );
        assert_eq!(told(&names, &[vec![], vec![], vec![]]), None);
    }
}
