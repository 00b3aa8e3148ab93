//! Pictures that many artifacts share, and that may lie in the memory of another library.

use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// A value that is shared and never changed, like an [`Arc`], and may be lent by its maker.
///
/// A picture that crosses the plugin ABI is not copied: it stays where it was made, and is freed
/// there once its last user is gone.
pub struct Shared<T: Default>(Arc<Inner<T>>);

struct Inner<T: Default> {
    value: T,
    /// Who owns the memory that `value` shows; `None` where `value` owns it.
    owner: Option<Arc<dyn Any + Send + Sync>>,
}

impl<T: Default> Shared<T> {
    /// Shares a value of one's own.
    pub fn new(value: T) -> Self {
        Shared(Arc::new(Inner { value, owner: None }))
    }

    /// Shares a value that shows memory of `owner`, which frees it when it is dropped. The value
    /// itself is never dropped.
    pub(crate) fn lent(value: T, owner: Arc<dyn Any + Send + Sync>) -> Self {
        Shared(Arc::new(Inner { value, owner: Some(owner) }))
    }
}

impl<T: Default> Shared<T> {
    /// True where both are one value.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T: Default + Send + Sync + 'static> Shared<T> {
    /// Something that keeps the value's memory.
    pub(crate) fn keeper(&self) -> Arc<dyn Any + Send + Sync> {
        Arc::new(self.clone())
    }
}

impl<T: Default> Drop for Inner<T> {
    fn drop(&mut self) {
        if self.owner.is_some() {
            std::mem::forget(std::mem::take(&mut self.value));
        }
    }
}

impl<T: Default> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Shared(self.0.clone())
    }
}

impl<T: Default> Deref for Shared<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0.value
    }
}

impl<T: Default> AsRef<T> for Shared<T> {
    fn as_ref(&self) -> &T {
        &self.0.value
    }
}

impl<T: Default> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Shared::new(value)
    }
}

impl<T: Default + PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Default + fmt::Debug> fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.value.fmt(f)
    }
}
