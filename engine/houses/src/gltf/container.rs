//! GLB and glTF bytes into the JSON tables and the binary chunk.
//!
//! Our own because the `gltf` crate (1.4) subtracts the header's size from a length that a file states, which panics.

use ::gltf::json::{Root, deserialize};
use serde_json::Value;

use super::indices;
use crate::json::without_byte_order_mark;
use crate::limits::MAX_TEXT_BYTES;

/// The tables and the binary chunk, empty when there is none. Text without the GLB header is glTF.
///
/// # Errors
/// A sentence when the bytes are neither.
pub(super) fn split_glb(bytes: &[u8]) -> Result<(Root, &[u8]), String> {
    if bytes.is_empty() {
        return Err("the file is empty; expected a GLB, or glTF 2.0 as JSON".to_owned());
    }
    let (text, blob) = json_and_bin_chunks(bytes)?;
    if text.len() as u64 > MAX_TEXT_BYTES {
        return Err(format!(
            "{} bytes of JSON; {MAX_TEXT_BYTES} are read",
            text.len()
        ));
    }
    let invalid = |error: serde_json::Error| {
        format!("no valid glTF 2.0: {}", crate::plain_parse_error(&error))
    };
    indices::check_index_widths(text).map_err(invalid)?;
    // Only files that need it are read as a tree: that is slower, and places in the text are lost.
    let mut json: Root = if contains(text, BASISU.as_bytes()) {
        let mut tree: Value = serde_json::from_slice(text).map_err(invalid)?;
        set_basisu_sources(&mut tree);
        serde_json::from_value(tree).map_err(invalid)?
    } else {
        deserialize::from_slice(text).map_err(invalid)?
    };
    json.extensions_required.retain(|name| name != BASISU);
    Ok((json, blob))
}

/// The text of the tables, and the binary chunk.
///
/// # Errors
/// A sentence when the bytes begin as a GLB and are none.
pub(super) fn json_and_bin_chunks(bytes: &[u8]) -> Result<(&[u8], &[u8]), String> {
    if bytes.starts_with(b"glTF") {
        chunks(bytes)
    } else {
        Ok((without_byte_order_mark(bytes), &[]))
    }
}

/// Textures whose image is compressed by Basis Universal, as in Habitat's and other data sets.
const BASISU: &str = "KHR_texture_basisu";

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window == word)
}

/// Names the image of `KHR_texture_basisu` as the texture's own, which the extension lets a file leave out: the image is
/// then found, and what cannot be decoded is reported like any other image.
fn set_basisu_sources(tree: &mut Value) {
    let textures = tree.get_mut("textures").and_then(Value::as_array_mut);
    for texture in textures.into_iter().flatten() {
        let source = texture["extensions"][BASISU]["source"].clone();
        if let Value::Object(fields) = texture
            && source.is_u64()
        {
            fields.entry("source").or_insert(source);
        }
    }
}

fn chunks(bytes: &[u8]) -> Result<(&[u8], &[u8]), String> {
    let word = |at: usize| {
        let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
        word.map(u32::from_le_bytes)
            .ok_or_else(|| format!("ends at byte {}, inside a header", bytes.len()))
    };
    if word(4)? != 2 {
        return Err(format!("GLB version {}; only 2 is read", word(4)?));
    }
    let stated = word(8)? as usize;
    if stated > bytes.len() {
        return Err(format!(
            "{} bytes, but the header states {stated}",
            bytes.len()
        ));
    }
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = word(at)? as usize;
        let found = bytes.get(at + 4..at + 8).unwrap_or_default();
        if found != kind {
            return Err(format!(
                "chunk {:?} at byte {at}, expected {:?}",
                String::from_utf8_lossy(found),
                String::from_utf8_lossy(kind)
            ));
        }
        // A length is below 2^32, so the sums fit.
        bytes
            .get(at + 8..at + 8 + length)
            .ok_or_else(|| format!("chunk at byte {at} reaches beyond the file"))
    };
    let text = chunk(12, b"JSON")?;
    let next = (20 + text.len()).next_multiple_of(4);
    let blob = if next + 8 <= stated {
        chunk(next, b"BIN\0")?
    } else {
        &[]
    };
    Ok((text, blob))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_containers_say_what_is_wrong() {
        let message = |bytes: &[u8]| split_glb(bytes).unwrap_err();
        assert_eq!(
            message(b"glTF\x02\0\0\0"),
            "ends at byte 8, inside a header"
        );
        assert_eq!(
            message(b"glTF\x01\0\0\0\x0c\0\0\0"),
            "GLB version 1; only 2 is read"
        );
        assert_eq!(
            message(b"glTF\x02\0\0\0\xff\0\0\0"),
            "12 bytes, but the header states 255"
        );
        // A stated length below the header's own makes the crate's reader panic.
        assert_eq!(
            message(b"glTF\x02\0\0\0\x04\0\0\0"),
            "ends at byte 12, inside a header"
        );
        assert_eq!(
            message(b"glTF\x02\0\0\0\x14\0\0\0\x01\0\0\0JSOX"),
            "chunk \"JSOX\" at byte 12, expected \"JSON\""
        );
        assert_eq!(
            message(b"glTF\x02\0\0\0\x14\0\0\0\x09\0\0\0JSON"),
            "chunk at byte 12 reaches beyond the file"
        );
        assert_eq!(
            message(b""),
            "the file is empty; expected a GLB, or glTF 2.0 as JSON"
        );
        let marked = b"\xef\xbb\xbf{\"asset\": {\"version\": \"2.0\"}}";
        assert!(split_glb(marked).is_ok());
        assert!(message(b"{").starts_with("no valid glTF 2.0: EOF"));
        // Other shapes than an object with a list of textures, on the way that reads a tree.
        for text in ["[\"KHR_texture_basisu\"]", "\"KHR_texture_basisu\""] {
            assert!(message(text.as_bytes()).starts_with("no valid glTF 2.0"));
        }
    }
}
