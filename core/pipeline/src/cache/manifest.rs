//! What the cache keeps of one run of a stage: digests of what it made, the files that it read, and
//! what it said.
//!
//! The text form is a line with the BLAKE3 digest of the rest, then the rest as JSON: a file that
//! was cut short or changed is found out before any of it is believed.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_core::Remarks;
use toile_core::artifact::{Digest, Measure};
use toile_core::text::intern;

/// One run of a stage, on one entry of its named sets where it is mapped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Manifest {
    /// Files that it read, with the digest of their content; `None` for one that was not there.
    pub(crate) reads: Vec<(String, Option<Digest>)>,
    /// What it made, in the order of its ports.
    pub(crate) outputs: Vec<KeptValue>,
    /// Figures that it gave.
    figures: Vec<StoredFigure>,
    /// What it told.
    #[serde(flatten)]
    pub(crate) remarks: Remarks,
}

/// The value of an output port.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum KeptValue {
    /// A single artifact.
    One(Blob),
    /// A named set.
    Set(BTreeMap<String, Blob>),
}

/// One artifact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Blob {
    /// Its digest; of one that is not stored, a digest of what it was made from.
    pub(crate) digest: Digest,
    /// True where its bytes lie in the cache under that name.
    pub(crate) stored: bool,
}

impl KeptValue {
    /// Its artifacts.
    pub(crate) fn blobs(&self) -> Vec<Blob> {
        match self {
            KeptValue::One(blob) => vec![*blob],
            KeptValue::Set(set) => set.values().copied().collect(),
        }
    }
}

/// A figure; its numbers as bits, so that they come back as they were.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct StoredFigure(String, u64, String, u64);

impl Manifest {
    pub(crate) fn new(
        reads: Vec<(String, Option<Digest>)>,
        outputs: Vec<KeptValue>,
        figures: &[Measure],
        remarks: &Remarks,
    ) -> Self {
        let figure = |m: &Measure| {
            StoredFigure(m.name.clone(), m.value.to_bits(), m.unit.into(), m.tolerance.to_bits())
        };
        let figures = figures.iter().map(figure).collect();
        Manifest { reads, outputs, figures, remarks: remarks.clone() }
    }

    /// The figures that the stage gave.
    pub(crate) fn figures(&self) -> Vec<Measure> {
        let measure = |f: &StoredFigure| Measure {
            name: f.0.clone(),
            value: f64::from_bits(f.1),
            unit: intern(&f.2),
            tolerance: f64::from_bits(f.3),
        };
        self.figures.iter().map(measure).collect()
    }

    /// Its text form.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        sealed(self)
    }

    /// From its text form.
    ///
    /// Errors: what is wrong with it, in a few words.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        unsealed(bytes)
    }
}

/// A value as JSON behind a line with its digest.
pub(super) fn sealed<T: Serialize>(value: &T) -> Vec<u8> {
    // Names and numbers alone: writing them to memory cannot fail.
    seal(&serde_json::to_vec(value).unwrap_or_default())
}

/// Bytes behind a line with their digest.
pub(super) fn seal(body: &[u8]) -> Vec<u8> {
    let mut bytes = Digest::of(body).hex().into_bytes();
    bytes.push(b'\n');
    bytes.extend_from_slice(body);
    bytes
}

/// The bytes behind [`seal`].
pub(super) fn open(bytes: &[u8]) -> Result<&[u8], String> {
    let split = bytes.iter().position(|b| *b == b'\n').ok_or("it has no digest")?;
    let (head, body) = (&bytes[..split], &bytes[split + 1..]);
    let digest = std::str::from_utf8(head).ok().and_then(Digest::from_hex).ok_or("it has no digest")?;
    match Digest::of(body) == digest {
        true => Ok(body),
        false => Err("its content does not have its digest".into()),
    }
}

/// The value behind [`sealed`].
pub(super) fn unsealed<T: for<'de> Deserialize<'de>>(bytes: &[u8]) -> Result<T, String> {
    let body = open(bytes)?;
    serde_json::from_slice(body).map_err(|e| format!("it cannot be read: {e}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn manifest() -> Manifest {
        let blob = Blob { digest: Digest::of(b"made"), stored: true };
        let set = BTreeMap::from([("back".to_owned(), blob), ("front".to_owned(), blob)]);
        let figure =
            Measure { name: "threshold".into(), value: 0.1 + 0.2, unit: "grey levels", tolerance: 0.0 };
        Manifest::new(
            vec![("a.jpg".into(), Some(Digest::of(b"a"))), ("gone.mtl".into(), None)],
            vec![KeptValue::One(blob), KeptValue::Set(set)],
            &[figure, Measure { name: "none".into(), value: f64::NAN, unit: "", tolerance: 0.0 }],
            &Remarks { notes: vec!["a vest".into()], warnings: vec!["dark".into()] },
        )
    }

    #[test]
    fn a_manifest_comes_back_as_it_was_to_the_bit() {
        let back = Manifest::from_bytes(&manifest().to_bytes()).unwrap();
        assert_eq!(back, manifest());
        let figures = back.figures();
        assert_eq!((figures[0].value, figures[0].unit), (0.1 + 0.2, "grey levels"));
        assert!(figures[1].value.is_nan());
    }

    #[test]
    fn what_is_wrong_is_said() {
        let whole = manifest().to_bytes();
        let says = |bytes: &[u8]| Manifest::from_bytes(bytes).unwrap_err();
        assert_eq!(says(b""), "it has no digest");
        assert_eq!(says(b"abc\n{}"), "it has no digest");
        assert_eq!(says(&whole[..whole.len() - 1]), "its content does not have its digest");
        assert!(says(&sealed(&"text")).starts_with("it cannot be read: invalid type"), "another shape");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            prop_assert!(Manifest::from_bytes(&bytes).is_err());
            prop_assert!(unsealed::<Manifest>(&sealed(&bytes)).is_err());
        }

        #[test]
        fn no_changed_byte_goes_unseen(at in 0usize..400, bit in 0u8..8) {
            let mut bytes = manifest().to_bytes();
            let at = at % bytes.len();
            bytes[at] ^= 1 << bit;
            // A capital digit of the digest is the same digit.
            prop_assume!(at >= 64 || !bytes[at].is_ascii_uppercase());
            prop_assert!(Manifest::from_bytes(&bytes).is_err());
        }
    }
}
