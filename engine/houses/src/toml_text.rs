//! TOML. What is told of a fault shows nothing of the text: a HOUSE may name any file as a map.

use serde::de::DeserializeOwned;

use crate::error::HousesError;
use crate::report::FileLocation;

/// The value of a TOML text; `at`: the file, for errors.
///
/// # Errors
/// [`HousesError::Syntax`] with line, column and the kind of fault.
pub(crate) fn from_str<T: DeserializeOwned>(
    text: &str,
    at: &FileLocation,
) -> Result<T, HousesError> {
    toml::from_str(text).map_err(|error: toml::de::Error| {
        let kind = without_content(&crate::plain_parse_error(error.message()));
        let Some(span) = error.span() else {
            return HousesError::Syntax {
                at: at.clone(),
                message: kind,
            };
        };
        let before = text.get(..span.start).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default();
        HousesError::Syntax {
            at: at.line(u32::try_from(line).unwrap_or(u32::MAX)),
            message: format!("column {}: {kind}", column.chars().count() + 1),
        }
    })
}

/// The kind of a fault without what was found: that stands in quotes, before what is expected.
fn without_content(fault: &str) -> String {
    let (found, expected) = fault.split_at(fault.rfind(", expected").unwrap_or(fault.len()));
    let kind = found.split(['"', '`']).next().unwrap_or_default();
    kind.trim_end().to_owned() + expected
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn a_fault_is_told_by_its_place_and_kind_alone() {
        let at = FileLocation::file("m.toml");
        let told = |text: &str| {
            from_str::<BTreeMap<String, u8>>(text, &at)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            told("# ä\npassword = hunter2 and more\n"),
            "m.toml:2: column 12: string values must be quoted, expected literal string"
        );
        assert_eq!(
            told("a = 1\nb = \"hunter2, expected\"\n"),
            "m.toml:2: column 5: invalid type: string, expected a whole number from 0"
        );
        assert_eq!(
            told("hunter2 = 300\n"),
            "m.toml:1: column 11: invalid value: integer, expected a whole number from 0 to 255"
        );
        let twice = told("hunter2 = 1\nhunter2 = 2\n");
        assert!(
            twice.starts_with("m.toml:2: column 1: ") && !twice.contains("hunter2"),
            "{twice}"
        );
        assert!(told("a = [1\n").starts_with("m.toml:"));
    }
}
