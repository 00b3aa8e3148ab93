//! What stands for a bucket in a program that was built without object stores: there is none.

use super::place::StorePlace;
use super::version::{FileVersion, StoreListing};
use toile_core::StageError;

/// A bucket that cannot be.
pub(super) enum NoBucket {}

impl NoBucket {
    pub(super) fn open(_: &StorePlace) -> Result<Self, StageError> {
        Err(StageError::invalid("this program was built without object stores")
            .hint("cargo install --path cli --features object-store"))
    }

    pub(super) fn read(&self, _: &str) -> Result<Option<Vec<u8>>, StageError> {
        match *self {}
    }

    pub(super) fn read_all(&self, _: &[String]) -> Result<Vec<Option<Vec<u8>>>, StageError> {
        match *self {}
    }

    pub(super) fn below(&self, _: &str) -> Result<StoreListing, StageError> {
        match *self {}
    }

    pub(super) fn in_folder(&self, _: &str) -> Result<StoreListing, StageError> {
        match *self {}
    }

    pub(super) fn version(&self, _: &str) -> Result<Option<FileVersion>, StageError> {
        match *self {}
    }

    pub(super) fn send_all(&self, _: &[(String, std::path::PathBuf)]) -> Result<(), StageError> {
        match *self {}
    }

    pub(super) fn send_if(&self, _: &str, _: Vec<u8>, _: Option<FileVersion>) -> Result<bool, StageError> {
        match *self {}
    }

    pub(super) fn remove_all(&self, _: &[String]) -> Result<(), StageError> {
        match *self {}
    }
}
