//! JSON with the byte order marks of editors.

use serde::de::{DeserializeOwned, Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};
use std::fmt;

use crate::error::HousesError;
use crate::report::FileLocation;

/// Some editors begin a text with a byte order mark.
pub(crate) fn without_byte_order_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// The value of a JSON text in UTF-8.
///
/// # Errors
/// Those of the JSON reader.
pub(crate) fn from_slice<T: DeserializeOwned>(text: &[u8]) -> serde_json::Result<T> {
    serde_json::from_slice(without_byte_order_mark(text))
}

/// As [`from_slice`], of any JSON whose objects have each key once: of a key that stands twice nobody knows which value is meant.
///
/// # Errors
/// Those of the JSON reader; of a key that stands twice its line.
pub(crate) fn value_of_unique_keys(text: &[u8]) -> serde_json::Result<Value> {
    from_slice(text).map(|UniqueKeys(value)| value)
}

/// A JSON value whose objects have each key once.
struct UniqueKeys(Value);

impl<'de> Deserialize<'de> for UniqueKeys {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        reader.deserialize_any(UniqueKeysVisitor)
    }
}

struct UniqueKeysVisitor;

impl<'de> Visitor<'de> for UniqueKeysVisitor {
    type Value = UniqueKeys;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E>(self, value: bool) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys(value.into()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys(value.into()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys(value.into()))
    }

    fn visit_f64<E>(self, value: f64) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys(value.into()))
    }

    fn visit_str<E>(self, value: &str) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys(value.into()))
    }

    fn visit_unit<E>(self) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys(Value::Null))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<UniqueKeys, A::Error> {
        let mut found = Vec::new();
        while let Some(UniqueKeys(item)) = items.next_element()? {
            found.push(item);
        }
        Ok(UniqueKeys(found.into()))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<UniqueKeys, A::Error> {
        let mut found = Map::new();
        while let Some((key, UniqueKeys(value))) = fields.next_entry::<String, _>()? {
            if found.contains_key(&key) {
                return Err(A::Error::custom(format_args!(
                    "duplicate field `{key:.200}`"
                )));
            }
            found.insert(key, value);
        }
        Ok(UniqueKeys(found.into()))
    }
}

/// [`HousesError::Syntax`] in the line of the file `at` where a reader stopped.
pub(crate) fn syntax(at: &FileLocation) -> impl Fn(serde_json::Error) -> HousesError {
    let at = at.clone();
    move |error| HousesError::Syntax {
        at: at.line(u32::try_from(error.line()).unwrap_or(u32::MAX)),
        message: crate::plain_parse_error(&error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_before_the_text_changes_nothing() {
        assert_eq!(from_slice::<Vec<u8>>(b"\xef\xbb\xbf[1]").unwrap(), [1]);
        let told = |text: &[u8]| from_slice::<Vec<u8>>(text).unwrap_err().to_string();
        assert_eq!(told(b"\xef\xbb\xbf[\n1"), told(b"[\n1"));
        assert!(value_of_unique_keys(b"{\"a\": [{\"b\": 1, \"c\": null}, {\"b\": 2.5}]}").is_ok());
        let told = value_of_unique_keys(b"{\"a\": [\n{\"b\": 1, \"b\": 2}]}").unwrap_err();
        assert_eq!(told.to_string(), "duplicate field `b` at line 2 column 16");
        // One mark is no part of the text; a second one is.
        assert!(from_slice::<Vec<u8>>(b"\xef\xbb\xbf\xef\xbb\xbf[1]").is_err());
    }
}
