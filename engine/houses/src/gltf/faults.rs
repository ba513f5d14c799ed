//! Faults found by the `gltf` crate, with the file's value at their place.

use serde_json::Value;

use super::container;

/// At most so many places are told.
const MAX_TOLD: usize = 5;

/// The sentence of an error: for each place what is wrong, what was found, and what is allowed where that is known.
pub(super) fn error_sentence(error: &::gltf::Error, bytes: &[u8]) -> String {
    let ::gltf::Error::Validation(places) = error else {
        return error.to_string();
    };
    let text = container::json_and_bin_chunks(bytes).map_or(&[][..], |(text, _)| text);
    let tables: Value = serde_json::from_slice(text).unwrap_or_default();
    let told: Vec<String> = places
        .iter()
        .take(MAX_TOLD)
        .map(|(place, what)| {
            let place = place.as_str();
            // Some places of the crate end in the value itself.
            let (field, stated) = match place.split_once(" = ") {
                Some((field, value)) => (field, Some(value.to_owned())),
                None => (place, None),
            };
            let found = stated.or_else(|| value_at(&tables, field).map(shortened));
            let found = found.map_or_else(String::new, |found| format!("; found {found}"));
            let allowed = allowed(field).map_or_else(String::new, |a| format!("; allowed is {a}"));
            let what = what.to_string().to_lowercase();
            format!("{field}: {what}{found}{allowed}")
        })
        .collect();
    let more = places.len().saturating_sub(MAX_TOLD);
    let more = (more > 0).then(|| format!("; and {more} more"));
    told.join("; ") + &more.unwrap_or_default()
}

/// The value at a place such as `meshes[0].primitives[2].mode`.
fn value_at<'a>(tables: &'a Value, place: &str) -> Option<&'a Value> {
    let words = place.split(['.', '[', ']']).filter(|word| !word.is_empty());
    let pointer: String = words.flat_map(|word| ["/", word]).collect();
    tables.pointer(&pointer)
}

/// The value as its file writes it, at most 60 characters of it.
fn shortened(value: &Value) -> String {
    const MAX_CHARS: usize = 60;
    let text = value.to_string();
    if text.chars().count() > MAX_CHARS {
        text.chars().take(MAX_CHARS - 1).chain(['…']).collect()
    } else {
        text
    }
}

/// The values that glTF 2.0 allows in a field, where these are few; `None` where the sentence alone says it.
fn allowed(place: &str) -> Option<&'static str> {
    let field = place.rsplit('.').next().unwrap_or(place);
    Some(match field {
        "mode" => "0 to 6",
        "byteStride" => "4 to 252, a multiple of 4",
        "alphaMode" => "\"OPAQUE\", \"MASK\" or \"BLEND\"",
        "componentType" => "5120, 5121, 5122, 5123, 5125 or 5126",
        "type" if place.starts_with("accessors") => {
            "a type of elements such as \"SCALAR\", \"VEC3\" or \"MAT4\""
        }
        "scene" => "the number of one of the file's scenes",
        "target" if place.starts_with("bufferViews") => "34962 or 34963",
        _ => return None,
    })
}
