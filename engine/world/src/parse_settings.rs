//! Settings from JSON, refused in plain words: the field, what was found, what is allowed.

use crate::error::WorldError;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Reads settings whose fields all have defaults.
///
/// # Errors
/// [`WorldError::Settings`] names the field that cannot be read.
pub(crate) fn parse_settings<T: DeserializeOwned>(
    of: &'static str,
    value: &Value,
) -> Result<T, WorldError> {
    serde_json::from_value(value.clone()).map_err(|error| {
        // A reader of the whole object does not report the field; reading one field alone does.
        let mut alone = value
            .as_object()
            .into_iter()
            .flatten()
            .filter_map(|(key, part)| {
                let error = serde_json::from_value::<T>(json!({ key.as_str(): part })).err()?;
                Some((format!("{key} is {part}"), error))
            });
        let (found, error) = alone.next().unwrap_or_else(|| (value.to_string(), error));
        WorldError::Settings { of, found, error }
    })
}

/// Reads the settings of a task; `null` gives the defaults.
///
/// # Errors
/// Those of [`parse_settings`].
pub(crate) fn parse_task_settings<T: DeserializeOwned + Default>(
    value: &Value,
) -> Result<T, WorldError> {
    if value.is_null() {
        return Ok(T::default());
    }
    parse_settings("task_settings", value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Default, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    struct SampleSettings {
        width: u32,
        gain: f32,
    }

    #[test]
    fn the_field_is_named_and_what_it_may_be() {
        let told = |value: Value| {
            parse_settings::<SampleSettings>("settings", &value)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            told(json!({"gain": 1.0, "width": "x"})),
            "settings: width is \"x\": found string \"x\", expected a whole number from 0"
        );
        assert_eq!(
            told(json!({"gain": {}})),
            "settings: gain is {}: found map, expected a number"
        );
        assert_eq!(
            told(json!(5)),
            "settings: 5: found integer `5`, expected values by name"
        );
        assert!(
            told(json!({"nope": 1})).contains("unknown field `nope`, expected `width` or `gain`")
        );
    }
}
