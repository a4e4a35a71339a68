//! Hashes of definitions, by which stale knowledge shows.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// An FNV-1a hash (64 bits) of a definition's kind, degrees, counts, and the bits of its numbers, little-endian.
///
/// Written `fnv1a64:` and 16 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fingerprint(u64);

impl Fingerprint {
    pub(crate) fn of(kind: &str) -> Self {
        let mut hash = Self(0xcbf2_9ce4_8422_2325); // the offset basis of FNV-1a
        hash.bytes(kind.as_bytes());
        hash
    }

    pub(crate) fn count(&mut self, n: usize) -> &mut Self {
        self.bytes(&(n as u64).to_le_bytes())
    }

    pub(crate) fn numbers(&mut self, values: &[f64]) -> &mut Self {
        for value in values {
            self.bytes(&value.to_bits().to_le_bytes());
        }
        self
    }

    fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3); // the prime of FNV-1a
        }
        self
    }
}

impl std::fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "fnv1a64:{:016x}", self.0)
    }
}

impl std::str::FromStr for Fingerprint {
    type Err = InvalidFingerprint;

    fn from_str(text: &str) -> Result<Self, InvalidFingerprint> {
        text.strip_prefix("fnv1a64:")
            .filter(|digits| digits.len() == 16 && digits.bytes().all(|b| b.is_ascii_hexdigit()))
            .and_then(|digits| u64::from_str_radix(digits, 16).ok())
            .map(Self)
            .ok_or_else(|| InvalidFingerprint { text: text.to_owned() })
    }
}

/// A text that is no fingerprint.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{text:?} is no fingerprint; one is written as fnv1a64: and 16 hexadecimal digits")]
pub struct InvalidFingerprint {
    /// The text.
    pub text: String,
}

impl Serialize for Fingerprint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Fingerprint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv_1a_and_its_text_reads_back() {
        // published test vector of FNV-1a 64: "foobar"
        let hash = Fingerprint::of("foobar");
        assert_eq!(hash.to_string(), "fnv1a64:85944171f73967e8");
        assert_eq!(hash.to_string().parse(), Ok(hash));
        assert!("fnv1a64:85944171f73967e".parse::<Fingerprint>().is_err());
        assert!("md5:85944171f73967e8".parse::<Fingerprint>().is_err());
    }
}
