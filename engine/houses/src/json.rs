//! JSON with the byte order marks of editors.

use serde::de::DeserializeOwned;

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
        // One mark is no part of the text; a second one is.
        assert!(from_slice::<Vec<u8>>(b"\xef\xbb\xbf\xef\xbb\xbf[1]").is_err());
    }
}
