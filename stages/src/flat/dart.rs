//! Darts of flat pieces: none, proposed, or made.

use super::fault::flatten_fault;
use super::sheet::Sheet;
use toile_core::prelude::*;
use toile_flatten::care::{Dart, DartOptions, Objective, propose_darts};
use toile_flatten::flatteners::Placement;

/// What becomes of cloth that cannot lie flat.
#[choice]
#[derive(Copy)]
pub enum Darts {
    /// It strains.
    None,
    /// Darts are drawn where the strain passes 1.5 per cent, and told with what each saves; none is cut.
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
    sheet: &Sheet,
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
    for (name, darts) in sheet.names.iter().zip(&found) {
        darts.iter().enumerate().for_each(|(k, dart)| cx.warn(words(name, k + 1, dart)));
    }
    cx.figure("darts", found.iter().map(Vec::len).sum::<usize>() as f64, "");
    Ok(found.into_iter().map(|darts| darts.into_iter().map(|d| d.path).collect()).collect())
}

fn words(piece: &str, number: usize, dart: &Dart) -> String {
    let [before, after] = dart.strain.map(|s| s * 1e2);
    let with = dart.mirror.map_or_else(String::new, |m| format!(" with its mirror image, dart {}", m + 1));
    let saves = dart.saves * 1e2;
    format!(
        "dart {number} of \"{piece}\"{with} saves {saves:.0} % of the energy, strain {before:.2} % to {after:.2} %"
    )
}
