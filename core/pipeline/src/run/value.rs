//! Values of output ports during a run: each artifact is in memory, in the cache, or both.

use crate::cache::{Blob, Cache, Fed, KeptValue, Lost};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{Artifact, Kind};
use toile_core::{Card, PortValue};

/// One artifact.
#[derive(Debug, Clone)]
pub(super) struct ArtifactSlot {
    kind: Kind,
    /// Its digest and where it lies; none where nothing was kept.
    blob: Option<Blob>,
    /// Itself, once something needed it.
    value: Option<Arc<dyn Artifact>>,
}

/// The value of a port.
#[derive(Debug, Clone)]
pub(super) enum HeldValue {
    /// A single artifact.
    One(ArtifactSlot),
    /// A named set.
    Set(Kind, BTreeMap<String, ArtifactSlot>),
    /// Nothing is known of it but its kind (in a forecast).
    Unknown,
}

impl ArtifactSlot {
    fn new(kind: Kind, blob: Option<Blob>, value: Option<Arc<dyn Artifact>>) -> Self {
        ArtifactSlot { kind, blob, value }
    }

    /// An artifact that has yet to be made.
    pub(super) fn unknown(kind: Kind) -> Self {
        ArtifactSlot::new(kind, None, None)
    }

    fn ensure(&mut self, cache: Option<&Cache>) -> Result<(), Lost> {
        if self.value.is_none() {
            let (Some(cache), Some(blob)) = (cache, &self.blob) else { return Err(Lost::Gone) };
            self.value = Some(cache.load(self.kind, blob)?);
        }
        Ok(())
    }
}

impl HeldValue {
    /// What a stage made on one port, or what the cache says of it, or both.
    pub(super) fn of(kind: Kind, value: Option<&PortValue>, kept: Option<&KeptValue>) -> Self {
        let blob_of = |name: &str| match kept {
            Some(KeptValue::Set(set)) => set.get(name).copied(),
            _ => None,
        };
        match (value, kept) {
            (Some(PortValue::One(artifact)), Some(KeptValue::One(blob))) => {
                HeldValue::One(ArtifactSlot::new(kind, Some(*blob), Some(artifact.clone())))
            }
            (Some(PortValue::One(artifact)), _) => {
                HeldValue::One(ArtifactSlot::new(kind, None, Some(artifact.clone())))
            }
            (Some(PortValue::Set(_, set)), _) => {
                let slot = |(n, a): (&String, &Arc<dyn Artifact>)| {
                    (n.clone(), ArtifactSlot::new(kind, blob_of(n), Some(a.clone())))
                };
                HeldValue::Set(kind, set.iter().map(slot).collect())
            }
            (None, Some(KeptValue::One(blob))) => HeldValue::One(ArtifactSlot::new(kind, Some(*blob), None)),
            (None, Some(KeptValue::Set(set))) => {
                let slot = |(n, b): (&String, &Blob)| (n.clone(), ArtifactSlot::new(kind, Some(*b), None));
                HeldValue::Set(kind, set.iter().map(slot).collect())
            }
            (None, None) => HeldValue::Unknown,
        }
    }

    /// The names of its set.
    pub(super) fn names(&self) -> Option<Vec<String>> {
        match self {
            HeldValue::Set(_, set) => Some(set.keys().cloned().collect()),
            _ => None,
        }
    }

    /// Its digests: of one entry where `entry` names one of a set.
    pub(super) fn fed(&self, entry: Option<&str>) -> Fed {
        let hash = |slot: &ArtifactSlot| slot.blob.map(|b| b.digest);
        let one = |slot: Option<&ArtifactSlot>| slot.and_then(hash).map_or(Fed::Unknown, Fed::One);
        match (self, entry) {
            (HeldValue::One(slot), _) => one(Some(slot)),
            (HeldValue::Set(_, set), Some(entry)) => one(set.get(entry)),
            (HeldValue::Set(_, set), None) => {
                let all = set.iter().map(|(n, s)| Some((n.clone(), hash(s)?)));
                all.collect::<Option<_>>().map_or(Fed::Unknown, Fed::Set)
            }
            (HeldValue::Unknown, _) => Fed::Unknown,
        }
    }

    /// Brings its artifacts into memory (of those entries only, where some are named); returns the
    /// names of those that must be made, each with the damage if it is one.
    pub(super) fn ensure(
        &mut self,
        entries: Option<&[String]>,
        cache: Option<&Cache>,
    ) -> Vec<(String, Option<String>)> {
        let wanted = |name: &String| entries.is_none_or(|e| e.contains(name));
        let lost = |name: &str, slot: &mut ArtifactSlot| {
            let why = match slot.ensure(cache) {
                Ok(()) => return None,
                Err(Lost::Gone) => None,
                Err(Lost::Damaged(why)) => Some(why),
            };
            Some((name.to_owned(), why))
        };
        match self {
            HeldValue::One(slot) => lost("", slot).into_iter().collect(),
            HeldValue::Set(_, set) => {
                set.iter_mut().filter(|(n, _)| wanted(n)).filter_map(|(n, s)| lost(n, s)).collect()
            }
            HeldValue::Unknown => Vec::new(),
        }
    }

    /// Puts in what was made anew; `entry` is empty for a stage that is not mapped.
    pub(super) fn restore(&mut self, entry: &str, made: &PortValue) {
        match (self, made) {
            (HeldValue::One(slot), PortValue::One(a)) => slot.value = Some(a.clone()),
            (HeldValue::Set(_, set), PortValue::One(a)) => {
                if let Some(slot) = set.get_mut(entry) {
                    slot.value = Some(a.clone());
                }
            }
            (HeldValue::Set(_, set), PortValue::Set(_, all)) => {
                for (slot, a) in set.iter_mut().filter_map(|(n, s)| Some((s, all.get(n)?))) {
                    slot.value = Some(a.clone());
                }
            }
            _ => {}
        }
    }

    /// As a port's value, of one entry where `entry` names one; none while something of it is not
    /// in memory.
    pub(super) fn value(&self, entry: Option<&str>) -> Option<PortValue> {
        match (self, entry) {
            (HeldValue::One(slot), _) => slot.value.clone().map(PortValue::One),
            (HeldValue::Set(_, set), Some(entry)) => set.get(entry)?.value.clone().map(PortValue::One),
            (HeldValue::Set(kind, set), None) => {
                let all = set.iter().map(|(n, s)| Some((n.clone(), s.value.clone()?)));
                all.collect::<Option<_>>().map(|set| PortValue::Set(*kind, set))
            }
            (HeldValue::Unknown, _) => None,
        }
    }
}

/// The values of a mapped stage's ports, put together from its entries.
pub(super) fn gather(card: &Card, entries: &[(String, Vec<HeldValue>)]) -> Vec<HeldValue> {
    let port = |(i, out): (usize, &toile_core::OutPort)| {
        let slot = |(name, held): &(String, Vec<HeldValue>)| match held.get(i) {
            Some(HeldValue::One(slot)) => Some((name.clone(), slot.clone())),
            Some(HeldValue::Unknown) => Some((name.clone(), ArtifactSlot::unknown(out.kind))),
            _ => None,
        };
        HeldValue::Set(out.kind, entries.iter().filter_map(slot).collect())
    };
    card.outputs.iter().enumerate().map(port).collect()
}
