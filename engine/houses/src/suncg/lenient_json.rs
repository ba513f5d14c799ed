//! Values as derived files write them: numbers as strings, flags as anything, `null` for NaN.

use serde::{Deserialize, Deserializer};
use serde_json::Value;

use super::file::BinaryFlag;

/// A scalar of any kind, or nothing usable.
fn scalar<'de, D: Deserializer<'de>, T>(
    from: D,
    expected: &str,
    read: impl Fn(&Value) -> Option<T>,
) -> Result<Option<T>, D::Error> {
    let value = Value::deserialize(from)?;
    if value.is_null() {
        return Ok(None);
    }
    read(&value)
        .map(Some)
        .ok_or_else(|| wrong(&value, expected))
}

fn wrong<E: serde::de::Error>(value: &Value, expected: &str) -> E {
    // The two halves are taken apart again for the report.
    E::custom(format!("{}{SEPARATOR}{expected}", shorten(value)))
}

/// Parts "found" and "expected" of an error made here.
pub(super) const SEPARATOR: &str = "\u{1f}";

/// A value, at most 40 characters long.
pub(super) fn shorten(value: &Value) -> String {
    let text = match value {
        Value::Array(items) if items.len() > 4 => format!("an array of {}", items.len()),
        Value::Object(fields) if !fields.is_empty() => {
            format!("an object of {} fields", fields.len())
        }
        value => value.to_string(),
    };
    if text.chars().count() > 40 {
        text.chars().take(39).chain(['…']).collect()
    } else {
        text
    }
}

fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => number.as_f64(),
        Value::String(text) => text.trim().parse().ok().filter(|x: &f64| x.is_finite()),
        Value::Bool(flag) => Some(f64::from(u8::from(*flag))),
        _ => None,
    }
}

fn as_text(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// A number, also written as a string.
pub(super) fn number<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    scalar(from, "a number", as_number)
}

/// Text, also written as a number (model ids are).
pub(super) fn text<'de, D: Deserializer<'de>>(from: D) -> Result<Option<String>, D::Error> {
    scalar(from, "a string", as_text)
}

/// 1, 0, true, false, "1", "0", "true", "false".
pub(super) fn flag<'de, D: Deserializer<'de>>(from: D) -> Result<Option<BinaryFlag>, D::Error> {
    scalar(from, "1 or 0", |value| match value {
        Value::String(text) if text.eq_ignore_ascii_case("true") => Some(BinaryFlag(true)),
        Value::String(text) if text.eq_ignore_ascii_case("false") || text.is_empty() => {
            Some(BinaryFlag(false))
        }
        value => as_number(value).map(|number| BinaryFlag(number != 0.0)),
    })
}

/// Numbers, also written as strings; an entry that is none becomes NaN and is reported by whoever needs it.
pub(super) fn numbers<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec<f64>>, D::Error> {
    scalar(from, "a list of numbers", |value| {
        let items = value.as_array()?;
        Some(
            items
                .iter()
                .map(|item| as_number(item).unwrap_or(f64::NAN))
                .collect(),
        )
    })
}

/// Strings; one string alone is a list of one, entries that are none are left out.
pub(super) fn texts<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec<String>>, D::Error> {
    scalar(from, "a list of strings", |value| match value {
        Value::Array(items) => Some(items.iter().filter_map(as_text).collect()),
        value => as_text(value).map(|text| vec![text]),
    })
}
