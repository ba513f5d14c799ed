//! Binary buffers: the GLB's own, files beside it, and data in the text.

use std::borrow::Cow;

use ::gltf::json::{Root, buffer::View};

use super::glb::{LIBRARY_PREFIX, content_name};
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::limits::MAX_BUFFER_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The bytes of all buffers; one that cannot be read is empty and reported.
pub(super) struct Buffers<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    /// The GLB's own buffer, and those in the files that `library` holds under their content's name.
    pub(super) fn load_with_library(
        json: &Root,
        blob: &'a [u8],
        library: &DataRoot,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Result<Self, HousesError> {
        let read = |uri: &str| read_library_file(uri, library, MAX_BUFFER_BYTES);
        Self::read(json, blob, read, at, report)
    }

    /// Reads all buffers; files beside the text are read from `root`.
    pub(super) fn load(
        json: &Root,
        blob: &'a [u8],
        root: &DataRoot,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Result<Self, HousesError> {
        let read = |uri: &str| read_uri(uri, root, MAX_BUFFER_BYTES);
        Self::read(json, blob, read, at, report)
    }

    fn read(
        json: &Root,
        blob: &'a [u8],
        read: impl Fn(&str) -> Result<Vec<u8>, WarningKind>,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Result<Self, HousesError> {
        let total: u64 = json
            .buffers
            .iter()
            .fold(0, |sum, buffer| sum.saturating_add(buffer.byte_length.0));
        if total > MAX_BUFFER_BYTES {
            return Err(HousesError::TooLarge {
                at: at.field("buffers"),
                what: "buffer bytes",
                found: total,
                allowed: MAX_BUFFER_BYTES,
            });
        }
        let mut buffers = Vec::new();
        for (k, buffer) in json.buffers.iter().enumerate() {
            let at = at.field(format_args!("buffers[{k}]"));
            let bytes = match &buffer.uri {
                None => Cow::Borrowed(if k == 0 { blob } else { &[] }),
                Some(uri) => Cow::Owned(read(uri).unwrap_or_else(|damage| {
                    report.warn(at.clone(), damage);
                    Vec::new()
                })),
            };
            if (bytes.len() as u64) < buffer.byte_length.0 {
                let (found, expected) = (
                    format!("{} bytes", bytes.len()),
                    format!("{} bytes", buffer.byte_length.0),
                );
                report.warn(at, WarningKind::BadField { found, expected });
            }
            buffers.push(bytes);
        }
        Ok(Self { buffers })
    }

    /// The bytes of a view; `None` when it reaches beyond its buffer.
    pub(super) fn view(&self, view: &View) -> Option<&[u8]> {
        let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let length = usize::try_from(view.byte_length.0).ok()?;
        self.buffers
            .get(view.buffer.value())?
            .get(start..start.checked_add(length)?)
    }
}

/// The bytes behind a URI: `data:` or a path beside the file.
pub(super) fn read_uri(uri: &str, root: &DataRoot, max_bytes: u64) -> Result<Vec<u8>, WarningKind> {
    let short = || uri.chars().take(60).collect::<String>();
    let unreadable = |reason: String| WarningKind::UnreadableMesh {
        path: short(),
        reason,
    };
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
        return encoded
            .and_then(base64)
            .ok_or_else(|| unreadable("no valid base64 data".to_owned()));
    }
    let path = percent_decode(uri);
    let inside = DataRoot::resolve("", &path)
        .map_err(|_| WarningKind::PathRefused { path: path.clone() })?;
    if !root.exists(&inside) {
        return Err(WarningKind::MissingMesh { path: inside });
    }
    root.read(&inside, max_bytes)
        .map_err(|error| unreadable(error.reason()))
}

/// The bytes of a file of a library, which must be those that its name says.
pub(super) fn read_library_file(
    uri: &str,
    library: &DataRoot,
    max_bytes: u64,
) -> Result<Vec<u8>, WarningKind> {
    let short = || uri.chars().take(60).collect::<String>();
    let refused = || WarningKind::PathRefused { path: short() };
    let path = uri.strip_prefix(LIBRARY_PREFIX).ok_or_else(refused)?;
    let (folder, file) = path.split_once('/').ok_or_else(refused)?;
    let (name, _) = file.split_once('.').ok_or_else(refused)?;
    let is_name = name.len() == 32 && name.bytes().all(|byte| byte.is_ascii_hexdigit());
    if !(is_name && matches!(folder, "object" | "texture") && !file.contains(['/', '\\'])) {
        return Err(refused());
    }
    let unreadable = |reason: String| WarningKind::UnreadableMesh {
        path: short(),
        reason,
    };
    let bytes = library
        .read(path, max_bytes)
        .map_err(|error| unreadable(error.reason()))?;
    if content_name(&bytes) != name {
        return Err(unreadable(
            "its content is not what its name says".to_owned(),
        ));
    }
    Ok(bytes)
}

fn percent_decode(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let digit = |k: usize| after.get(k).and_then(|b| char::from(*b).to_digit(16));
        if let (b'%', Some(high), Some(low)) = (byte, digit(0), digit(1)) {
            bytes.push((high * 16 + low) as u8);
            rest = &after[2..];
        } else {
            bytes.push(byte);
            rest = after;
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Decodes base64 (RFC 4648, either alphabet); `None` for anything else.
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0_u32, 0);
    for byte in text.trim_end_matches('=').bytes() {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'\n' | b'\r' => continue,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_gives_the_published_vectors() {
        // RFC 4648, section 10.
        for (plain, encoded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(encoded).as_deref(), Some(plain.as_bytes()));
        }
        assert_eq!(base64("Zm9v!"), None);
    }

    #[test]
    fn percent_signs_are_decoded_where_digits_follow() {
        assert_eq!(percent_decode("my%20chair%2"), "my chair%2");
    }
}
