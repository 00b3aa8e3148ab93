//! Turns what stages promise into tests.
//!
//! A stage's card declares contracts; this kit runs the stage on a shared suite of inputs, hard
//! ones included, and holds it to them. A stage crate names the kit in its dev-dependencies,
//!
//! ```toml
//! [dev-dependencies]
//! toile-core = { version = "0.1", features = ["testkit"] }
//! ```
//!
//! and writes one line in a test file, which makes a `#[test]` for each stage and contract:
//!
//! ```ignore
//! use my_crate::{MyMesher, MySmoother};
//! toile_core::contracts!(MyMesher, MySmoother);
//! ```
//!
//! - [`suite`]: the inputs. [`shapes`], [`dress`], [`capsules`]: what they are made of. [`files`]:
//!   those that examples name.
//! - [`contract`]: one check for each contract, and which of them the kit can check for a card.
//! - [`motion`]: artifacts moved, turned and scaled.
//! - [`trial`]: a single run and its outcome.
//!
//! Method: properties over fixed inputs, no random ones, so that a failure comes back. Cost: each
//! case of a stage is run two to five times a contract. Limits: a contract is checked on the suite
//! and not proved; equivariance is checked where the kit knows how to move what a stage takes and
//! how to compare what it gives.

pub mod capsules;
pub mod contract;
pub mod dress;
pub mod files;
pub mod motion;
pub mod shapes;
pub mod suite;
pub mod trial;

pub use contract::{check, checked, is_checked};
pub use shapes::{mask, noisy_photo, outline, photo};
pub use suite::{Case, cases};
pub use trial::{Trial, TrialOutcome};

use crate::artifact::{Artifact, ArtifactType};
use crate::{Card, Context, Inputs, Registry, Stage, StageError};
use std::any::Any;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Runs a stage with a single required input on one artifact and gives its first output.
///
/// Errors: the stage's own; `internal` where it takes or gives something else.
pub fn run_one<T: ArtifactType + Clone>(
    stage: &dyn Stage,
    input: &(impl ArtifactType + Clone),
) -> Result<T, StageError> {
    let input: Arc<dyn Artifact> = Arc::new(input.clone());
    let value = |port: &crate::InPort| (port.kind == input.kind()).then(|| suite::value(port, &input));
    first_output(stage, &Inputs(stage.card().inputs.iter().map(value).collect()))
}

/// Runs a stage that takes nothing and gives its first output.
///
/// Errors: the stage's own; `internal` where it gives something else.
pub fn run_bare<T: ArtifactType + Clone>(stage: &dyn Stage) -> Result<T, StageError> {
    first_output(stage, &Inputs::default())
}

fn first_output<T: ArtifactType + Clone>(stage: &dyn Stage, inputs: &Inputs) -> Result<T, StageError> {
    let made = stage.run_ports(inputs, &Context::quiet())?;
    let first = made.first().and_then(|v| v.entries().first().map(|(_, a)| (*a).clone()));
    let typed = first.as_ref().and_then(|a| typed::<T>(a.as_ref()));
    typed.cloned().ok_or_else(|| StageError::internal("the stage gives something else"))
}

/// An artifact as what it is; nothing where it is something else.
pub fn typed<T: 'static>(artifact: &dyn Artifact) -> Option<&T> {
    let any: &dyn Any = artifact;
    any.downcast_ref()
}

/// The stage of a card as its example sets it, with the files that the example names laid into
/// `folder`.
///
/// Errors: why the example cannot be loaded.
pub fn from_example(registry: &Registry, card: &Card, folder: &Path) -> Result<Box<dyn Stage>, String> {
    files::files_for(registry, card.example, folder)?;
    let arguments = card.example.strip_prefix(card.name).unwrap_or(card.example);
    let stage = registry.make(card, arguments)?;
    match stage.card().name == card.name && stage.card().role == card.role {
        true => Ok(stage),
        false => Err(format!("the example of {} makes another stage", card.name)),
    }
}

/// A folder that is gone when it is dropped.
///
/// Errors: the system's.
pub fn folder() -> Result<(tempfile::TempDir, PathBuf), String> {
    let dir = tempfile::tempdir().map_err(|e| format!("no folder for the test's files: {e}"))?;
    let path = dir.path().to_owned();
    Ok((dir, path))
}

/// Makes a `#[test]` for each of the stages and contracts; those that a stage does not promise say
/// so.
///
/// Use it once in a file.
#[macro_export]
macro_rules! contracts {
    ($($stage:ident),+ $(,)?) => {
        mod contracts {
            $(
                #[allow(non_snake_case)]
                mod $stage {
                    $crate::contracts!(@one $stage: deterministic Deterministic, thread_invariant ThreadInvariant,
                        translation_equivariant TranslationEquivariant,
                        rotation_equivariant RotationEquivariant, scale_equivariant ScaleEquivariant,
                        idempotent Idempotent, boundary_preserving BoundaryPreserving, refuses_empty RefusesEmpty,
                        cancellable Cancellable, improves Improves);
                }
            )+
        }
    };
    (@one $stage:ident: $($test:ident $contract:ident),+) => {
        $(
            #[test]
            fn $test() {
                $crate::testkit::contract::assert_kept::<super::super::$stage>($crate::Contract::$contract);
            }
        )+
    };
}
