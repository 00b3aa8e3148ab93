//! Artifacts as records: named fields of plain numbers, texts and further records.
//!
//! One form serves the cache, where a record becomes bytes ([`encode`], [`decode`]), and the border
//! of a plugin, where its lists are lent as they lie in memory. Whoever reads a record asks for
//! fields by name, so that a newer writer may add fields that an older reader does not know.
//!
//! Cost: a record borrows the artifact's lists; bytes cost one copy each way. Limits: little-endian
//! machines, nesting up to [`MAX_DEPTH`].

mod bytes;
#[cfg(test)]
mod every_field;
mod flat;
mod pattern;
mod plan;
mod solid;
#[cfg(test)]
pub(crate) mod tests;

pub use super::store::{Data, Listed, MemoryOwner, Reader, Record, RecordField};

use crate::artifact::{Artifact, ArtifactType, Kind};
use std::sync::Arc;

/// The deepest nesting of records; the artifacts need four.
pub const MAX_DEPTH: usize = 8;

/// An artifact type that can be made again from its record.
pub trait Stored: ArtifactType {
    /// Makes it from its fields.
    ///
    /// Errors: one sentence on the field at fault, such as "the field `positions` is missing". The
    /// artifact may still be unsound: whoever reads it asks [`Artifact::check`].
    fn from_record(fields: &Reader<'_>) -> Result<Self, String>;
}

/// The artifact as bytes, the same for equal artifacts on every machine; `None` for a service such
/// as a collider, and for the run log.
pub fn encode(artifact: &dyn Artifact) -> Option<Vec<u8>> {
    artifact.record().map(|record| bytes::write(artifact.kind(), &record))
}

/// An artifact from bytes that [`encode`] made.
///
/// Errors: one sentence on what is wrong with the bytes, or with the artifact that they hold.
pub fn decode(kind: Kind, bytes: &[u8]) -> Result<Arc<dyn Artifact>, String> {
    from_record(kind, &bytes::read(kind, bytes)?)
}

/// An artifact of that kind from its record, checked.
///
/// Errors: one sentence on the field at fault, or what [`Artifact::check`] says.
pub fn from_record(kind: Kind, record: &Record<'_>) -> Result<Arc<dyn Artifact>, String> {
    let artifact = from_trusted_record(kind, record)?;
    artifact.check()?;
    Ok(artifact)
}

/// The same for a record that comes from a checked artifact.
pub(crate) fn from_trusted_record(kind: Kind, record: &Record<'_>) -> Result<Arc<dyn Artifact>, String> {
    let maker = MAKERS.iter().find(|(k, _)| *k == kind);
    let (_, make) = maker.ok_or_else(|| format!("a {kind} cannot be made from a record"))?;
    make(record)
}

/// True of kinds that have a record; a service such as a collider has none.
pub fn is_stored(kind: Kind) -> bool {
    MAKERS.iter().any(|(k, _)| *k == kind)
}

/// The kind of that name.
pub fn kind_named(name: &str) -> Option<Kind> {
    let services = [crate::artifact::Collider::KIND, crate::RunLog::KIND];
    MAKERS.iter().map(|(k, _)| *k).chain(services).find(|k| k.0 == name)
}

type MakeArtifact = fn(&Record<'_>) -> Result<Arc<dyn Artifact>, String>;

/// Every kind that has a record.
const MAKERS: [(Kind, MakeArtifact); 13] = [
    maker::<crate::artifact::Photo>(),
    maker::<crate::artifact::Mask>(),
    maker::<crate::artifact::Outline>(),
    maker::<crate::artifact::Panel>(),
    maker::<crate::artifact::Body>(),
    maker::<crate::artifact::Garment>(),
    maker::<crate::artifact::Model>(),
    maker::<crate::artifact::Fabric>(),
    maker::<crate::artifact::Pattern>(),
    maker::<crate::artifact::SewingPlan>(),
    maker::<crate::artifact::Phases>(),
    maker::<crate::artifact::Figures>(),
    maker::<crate::artifact::OutputFiles>(),
];

const fn maker<T: Stored>() -> (Kind, MakeArtifact) {
    (T::KIND, make::<T>)
}

fn make<T: Stored>(record: &Record<'_>) -> Result<Arc<dyn Artifact>, String> {
    Ok(Arc::new(T::from_record(&Reader::new(record))?))
}
