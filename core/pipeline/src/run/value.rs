//! Values of output ports during a run: each artifact is in memory, in the cache, or both.

use crate::cache::{Blob, Cache, Fed, Kept, Lost};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{Artifact, Kind};
use toile_core::{Card, PortValue};

/// One artifact.
#[derive(Debug, Clone)]
pub(super) struct Slot {
    kind: Kind,
    /// Its digest and where it lies; none where nothing was kept.
    blob: Option<Blob>,
    /// Itself, once something needed it.
    value: Option<Arc<dyn Artifact>>,
}

/// The value of a port.
#[derive(Debug, Clone)]
pub(super) enum Held {
    /// A single artifact.
    One(Slot),
    /// A named set.
    Set(Kind, BTreeMap<String, Slot>),
    /// Nothing is known of it but its kind (in a forecast).
    Unknown,
}

impl Slot {
    fn new(kind: Kind, blob: Option<Blob>, value: Option<Arc<dyn Artifact>>) -> Self {
        Slot { kind, blob, value }
    }

    /// An artifact that has yet to be made.
    pub(super) fn unknown(kind: Kind) -> Self {
        Slot::new(kind, None, None)
    }

    fn ensure(&mut self, cache: Option<&Cache>) -> Result<(), Lost> {
        if self.value.is_none() {
            let (Some(cache), Some(blob)) = (cache, &self.blob) else { return Err(Lost::Gone) };
            self.value = Some(cache.load(self.kind, blob)?);
        }
        Ok(())
    }
}

impl Held {
    /// What a stage made on one port, or what the cache says of it, or both.
    pub(super) fn of(kind: Kind, value: Option<&PortValue>, kept: Option<&Kept>) -> Self {
        let blob_of = |name: &str| match kept {
            Some(Kept::Set(set)) => set.get(name).copied(),
            _ => None,
        };
        match (value, kept) {
            (Some(PortValue::One(artifact)), Some(Kept::One(blob))) => {
                Held::One(Slot::new(kind, Some(*blob), Some(artifact.clone())))
            }
            (Some(PortValue::One(artifact)), _) => Held::One(Slot::new(kind, None, Some(artifact.clone()))),
            (Some(PortValue::Set(_, set)), _) => {
                let slot = |(n, a): (&String, &Arc<dyn Artifact>)| {
                    (n.clone(), Slot::new(kind, blob_of(n), Some(a.clone())))
                };
                Held::Set(kind, set.iter().map(slot).collect())
            }
            (None, Some(Kept::One(blob))) => Held::One(Slot::new(kind, Some(*blob), None)),
            (None, Some(Kept::Set(set))) => {
                let slot = |(n, b): (&String, &Blob)| (n.clone(), Slot::new(kind, Some(*b), None));
                Held::Set(kind, set.iter().map(slot).collect())
            }
            (None, None) => Held::Unknown,
        }
    }

    /// The names of its set.
    pub(super) fn names(&self) -> Option<Vec<String>> {
        match self {
            Held::Set(_, set) => Some(set.keys().cloned().collect()),
            _ => None,
        }
    }

    /// Its digests: of one entry where `entry` names one of a set.
    pub(super) fn fed(&self, entry: Option<&str>) -> Fed {
        let hash = |slot: &Slot| slot.blob.map(|b| b.digest);
        let one = |slot: Option<&Slot>| slot.and_then(hash).map_or(Fed::Unknown, Fed::One);
        match (self, entry) {
            (Held::One(slot), _) => one(Some(slot)),
            (Held::Set(_, set), Some(entry)) => one(set.get(entry)),
            (Held::Set(_, set), None) => {
                let all = set.iter().map(|(n, s)| Some((n.clone(), hash(s)?)));
                all.collect::<Option<_>>().map_or(Fed::Unknown, Fed::Set)
            }
            (Held::Unknown, _) => Fed::Unknown,
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
        let lost = |name: &str, slot: &mut Slot| {
            let why = match slot.ensure(cache) {
                Ok(()) => return None,
                Err(Lost::Gone) => None,
                Err(Lost::Damaged(why)) => Some(why),
            };
            Some((name.to_owned(), why))
        };
        match self {
            Held::One(slot) => lost("", slot).into_iter().collect(),
            Held::Set(_, set) => {
                set.iter_mut().filter(|(n, _)| wanted(n)).filter_map(|(n, s)| lost(n, s)).collect()
            }
            Held::Unknown => Vec::new(),
        }
    }

    /// Puts in what was made anew; `entry` is empty for a stage that is not mapped.
    pub(super) fn restore(&mut self, entry: &str, made: &PortValue) {
        match (self, made) {
            (Held::One(slot), PortValue::One(a)) => slot.value = Some(a.clone()),
            (Held::Set(_, set), PortValue::One(a)) => {
                if let Some(slot) = set.get_mut(entry) {
                    slot.value = Some(a.clone());
                }
            }
            (Held::Set(_, set), PortValue::Set(_, all)) => {
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
            (Held::One(slot), _) => slot.value.clone().map(PortValue::One),
            (Held::Set(_, set), Some(entry)) => set.get(entry)?.value.clone().map(PortValue::One),
            (Held::Set(kind, set), None) => {
                let all = set.iter().map(|(n, s)| Some((n.clone(), s.value.clone()?)));
                all.collect::<Option<_>>().map(|set| PortValue::Set(*kind, set))
            }
            (Held::Unknown, _) => None,
        }
    }
}

/// The values of a mapped stage's ports, put together from its entries.
pub(super) fn gather(card: &Card, entries: &[(String, Vec<Held>)]) -> Vec<Held> {
    let port = |(i, out): (usize, &toile_core::OutPort)| {
        let slot = |(name, held): &(String, Vec<Held>)| match held.get(i) {
            Some(Held::One(slot)) => Some((name.clone(), slot.clone())),
            Some(Held::Unknown) => Some((name.clone(), Slot::unknown(out.kind))),
            _ => None,
        };
        Held::Set(out.kind, entries.iter().filter_map(slot).collect())
    };
    card.outputs.iter().enumerate().map(port).collect()
}
