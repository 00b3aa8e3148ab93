use crate::artifact::{Artifact, Kind};
use std::sync::Arc;
pub(super) fn encode(_: &dyn Artifact) -> Option<Vec<u8>> { None }
pub(super) fn decode(_: Kind, _: &[u8]) -> Result<Arc<dyn Artifact>, String> { Err("stand-in".into()) }
