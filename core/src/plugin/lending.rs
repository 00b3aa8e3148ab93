//! Pictures that cross the border without a copy: they stay where they were made, and whoever made
//! them is told when the other side needs them no more.

use super::abi;
use crate::artifact::store::{KeptBytes, Lend};
use std::any::Any;
use std::ffi::c_void;
use std::mem::ManuallyDrop;
use std::sync::Arc;

type Keeper = Arc<dyn Any + Send + Sync>;

/// The owners of a record's lists, in C's form; boxed, since they are pointed at while the list
/// grows.
#[derive(Debug, Default)]
#[allow(clippy::vec_box)]
pub struct ListOwners(Vec<Box<abi::Owner>>);

impl ListOwners {
    /// Where the owner lies; good for as long as both live.
    pub fn lend(&mut self, keeper: &Keeper) -> *const abi::Owner {
        let ctx = std::ptr::from_ref(keeper).cast_mut().cast();
        self.0.push(Box::new(abi::Owner { ctx, retain: Some(retain), release: Some(release) }));
        self.0.last().map_or(std::ptr::null(), |o| &raw const **o)
    }
}

unsafe extern "C" fn retain(ctx: *mut c_void) -> *mut c_void {
    let keeper = unsafe { &*ctx.cast::<Keeper>() };
    Box::into_raw(Box::new(keeper.clone())).cast()
}

unsafe extern "C" fn release(handle: *mut c_void) {
    drop(unsafe { Box::from_raw(handle.cast::<Keeper>()) });
}

/// An owner who can be asked to keep a list.
#[derive(Clone)]
pub struct Lending(ListKeeper);

#[derive(Clone)]
enum ListKeeper {
    /// The other side.
    Foreign(abi::Owner),
    /// Memory that this side gave to the other for its output.
    Block(Keeper),
}

// Its functions may be called from any thread, by the rules of the border.
unsafe impl Send for Lending {}
unsafe impl Sync for Lending {}

impl std::fmt::Debug for Lending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Lending")
    }
}

/// A handle of the other side.
struct Handle {
    handle: *mut c_void,
    release: unsafe extern "C" fn(*mut c_void),
}

unsafe impl Send for Handle {}
unsafe impl Sync for Handle {}

impl Drop for Handle {
    fn drop(&mut self) {
        unsafe { (self.release)(self.handle) };
    }
}

impl Lending {
    /// The owner that the other side names, if it names one.
    ///
    /// # Safety
    /// The owner is there for as long as the result, or any copy of it, is asked.
    pub unsafe fn of(owner: *const abi::Owner) -> Option<Self> {
        let owner = unsafe { owner.as_ref() }?;
        Some(Lending(ListKeeper::Foreign(*owner)))
    }

    /// The owner of a block of this side.
    pub fn block(keeper: Keeper) -> Self {
        Lending(ListKeeper::Block(keeper))
    }
}

impl Lend for Lending {
    fn keep(&self, bytes: &[u8]) -> Option<KeptBytes> {
        let keeper = match &self.0 {
            ListKeeper::Block(keeper) => keeper.clone(),
            ListKeeper::Foreign(owner) => {
                let (retain, release) = (owner.retain?, owner.release?);
                let handle = unsafe { retain(owner.ctx) };
                (!handle.is_null()).then(|| Arc::new(Handle { handle, release }) as Keeper)?
            }
        };
        let shown = unsafe { Vec::from_raw_parts(bytes.as_ptr().cast_mut(), bytes.len(), bytes.len()) };
        Some((ManuallyDrop::new(shown), keeper))
    }
}
