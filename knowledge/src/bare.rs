//! Fields that may be left out and are written without `Some`: absent means "not known".

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the value itself. For fields with `skip_serializing_if = "Option::is_none"`.
pub(crate) fn serialize<T: Serialize, S: Serializer>(value: &Option<T>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(value) => value.serialize(serializer),
        None => serializer.serialize_none(),
    }
}

/// Reads the value itself. For fields with `default`.
pub(crate) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}
