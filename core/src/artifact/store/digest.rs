//! Content digests: the same value gives the same digest on every machine and run.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A BLAKE3 digest of an artifact's content.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// The digest of bytes.
    #[cfg(feature = "digest")]
    pub fn of(bytes: &[u8]) -> Self {
        Digester::new().bytes(bytes).finish()
    }

    /// From 64 hexadecimal digits.
    pub fn from_hex(text: &str) -> Option<Self> {
        let digits = text.as_bytes();
        if digits.len() != 64 || !digits.iter().all(u8::is_ascii_hexdigit) {
            return None;
        }
        let mut bytes = [0; 32];
        for (i, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::from_str_radix(text.get(2 * i..2 * i + 2)?, 16).ok()?;
        }
        Some(Digest(bytes))
    }

    /// All of it in hexadecimal.
    pub fn hex(&self) -> String {
        self.0.iter().map(|b| format!("{b:02x}")).collect()
    }

    /// The first eight bytes in hexadecimal, enough to tell artifacts apart in a text sheet.
    pub fn short(&self) -> String {
        self.0[..8].iter().map(|b| format!("{b:02x}")).collect()
    }
}

impl std::fmt::Display for Digest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.hex())
    }
}

impl Serialize for Digest {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&self.hex())
    }
}

impl<'de> Deserialize<'de> for Digest {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let text = String::deserialize(d)?;
        Digest::from_hex(&text).ok_or_else(|| serde::de::Error::custom("a digest has 64 hexadecimal digits"))
    }
}

/// Collects an artifact's content into a [`Digest`].
///
/// Floats are fed as their bits, so that two values are equal only where every bit is.
///
/// Without the feature `digest` it takes everything and comes to nothing: a plugin's artifacts are
/// digested by the program.
#[derive(Debug, Default)]
pub struct Digester(#[cfg(feature = "digest")] blake3::Hasher);

impl Digester {
    /// An empty digester.
    pub fn new() -> Self {
        Self::default()
    }

    /// Feeds raw bytes.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        #[cfg(feature = "digest")]
        self.0.update(bytes);
        #[cfg(not(feature = "digest"))]
        let _ = bytes;
        self
    }

    /// Feeds a text with its length, so that neighbouring texts cannot run together.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.count(text.len()).bytes(text.as_bytes())
    }

    /// Feeds a count.
    pub fn count(&mut self, count: usize) -> &mut Self {
        self.bytes(&(count as u64).to_le_bytes())
    }

    /// Feeds floats by their bits.
    pub fn floats(&mut self, floats: impl IntoIterator<Item = f64>) -> &mut Self {
        for x in floats {
            self.bytes(&x.to_bits().to_le_bytes());
        }
        self
    }

    /// Feeds vertex indices.
    pub fn indices(&mut self, indices: impl IntoIterator<Item = u32>) -> &mut Self {
        for i in indices {
            self.bytes(&i.to_le_bytes());
        }
        self
    }

    /// The digest of all that was fed.
    #[cfg(feature = "digest")]
    pub fn finish(&self) -> Digest {
        Digest(*self.0.finalize().as_bytes())
    }
}
