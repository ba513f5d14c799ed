//! Indices and codes of glTF: whole numbers of 32 bits.
//!
//! The `gltf` crate (1.4) cuts off what is above, so that 2^32 would be index 0.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// Fields that hold an index or a code, alone or in a list.
const FIELDS: [&str; 29] = [
    "scene",
    "nodes",
    "children",
    "mesh",
    "skin",
    "skeleton",
    "joints",
    "inverseBindMatrices",
    "camera",
    "light",
    "source",
    "sampler",
    "index",
    "texCoord",
    "material",
    "indices",
    "bufferView",
    "buffer",
    "node",
    "input",
    "output",
    "componentType",
    "mode",
    "target",
    "magFilter",
    "minFilter",
    "wrapS",
    "wrapT",
    "variants",
];
/// Fields whose own fields, under any name, hold one.
const TABLES: [&str; 2] = ["attributes", "targets"];

/// Checks all indices and codes of a text.
///
/// # Errors
/// Those of JSON, and for a number of more than 32 bits.
pub(super) fn check_index_widths(text: &[u8]) -> Result<(), serde_json::Error> {
    let mut json = serde_json::Deserializer::from_slice(text);
    IndexWidthValidator::default().deserialize(&mut json)?;
    json.end()
}

#[derive(Debug, Default, Clone, Copy)]
struct IndexWidthValidator {
    is_index: bool,
    is_table: bool,
}

impl<'de> DeserializeSeed<'de> for IndexWidthValidator {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<(), D::Error> {
        from.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for IndexWidthValidator {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("glTF")
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<(), E> {
        if self.is_index && value > u64::from(u32::MAX) {
            let most = u32::MAX;
            return Err(E::custom(format_args!(
                "an index or code of {value}; allowed are 0 to {most}"
            )));
        }
        Ok(())
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        while items.next_element_seed(self)?.is_some() {}
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<(), A::Error> {
        while let Some(name) = fields.next_key::<String>()? {
            if name == "extras" {
                fields.next_value::<IgnoredAny>()?;
                continue;
            }
            fields.next_value_seed(Self {
                is_index: self.is_table || FIELDS.contains(&name.as_str()),
                is_table: TABLES.contains(&name.as_str()),
            })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_of_more_than_32_bits_are_refused() {
        for text in [
            r#"{"nodes": [{"mesh": 4294967296}]}"#,
            r#"{"nodes": [{"children": [0, 4294967297]}]}"#,
            r#"{"meshes": [{"primitives": [{"attributes": {"POSITION": 4294967296}}]}]}"#,
            r#"{"meshes": [{"primitives": [{"mode": 4294967300}]}]}"#,
            r#"{"meshes": [{"primitives": [{"targets": [{"NORMAL": 4294967296}]}]}]}"#,
        ] {
            let told = check_index_widths(text.as_bytes()).unwrap_err().to_string();
            assert!(told.contains("; allowed are 0 to 4294967295"), "{told}");
        }
        for text in [
            r#"{"nodes": [{"mesh": 4294967295, "extras": {"mesh": 4294967296}}]}"#,
            r#"{"accessors": [{"max": [5000000000, -1, 0.5]}], "buffers": [{"byteLength": 5000000000}]}"#,
        ] {
            assert!(check_index_widths(text.as_bytes()).is_ok(), "{text}");
        }
    }
}
