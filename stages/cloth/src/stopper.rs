//! Lets a caller stop a solver within steps.

use crate::error::ClothError;
use std::fmt;
use std::sync::Arc;

/// Says whether the caller has asked a solver to stop. Solvers check it between the parts of a
/// step, so that a long step ends soon. The default never stops.
#[derive(Clone, Default)]
pub struct Stopper(Option<Arc<dyn Fn() -> bool + Send + Sync>>);

impl Stopper {
    /// Stops when `asks` returns true.
    pub fn when(asks: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(asks)))
    }

    /// Whether to stop.
    #[must_use]
    pub fn is_up(&self) -> bool {
        self.0.as_ref().is_some_and(|asks| asks())
    }

    /// # Errors
    /// [`ClothError::Stopped`] where it is time to stop.
    pub fn check(&self) -> Result<(), ClothError> {
        if self.is_up() { Err(ClothError::Stopped) } else { Ok(()) }
    }
}

impl fmt::Debug for Stopper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Stopper({})", self.is_up())
    }
}
