//! Settings from JSON, refused in plain words: the field, what was found, what is allowed.

use crate::error::WorldError;
use crate::named_values::list_for_names;
use crate::plain_json_error::plain_json_error;
use crate::schema;
use schemars::JsonSchema;
use serde::de::{DeserializeOwned, Error as _, Unexpected};
use serde_json::{Value, json};

/// Values of a list or mapping beyond which none is looked for that cannot be read: each is tried.
const MOST_TRIED: usize = 64;

/// Reads settings whose fields all have defaults.
///
/// # Errors
/// [`WorldError::Settings`] names the field that cannot be read.
pub(crate) fn parse_settings<T: DeserializeOwned + JsonSchema>(
    of: &'static str,
    value: &Value,
) -> Result<T, WorldError> {
    if let Some((place, list)) = list_for_names(&schema::root::<T>(), value) {
        let found = match &place[..] {
            "" => list.to_string(),
            place => format!("{place} is {list}"),
        };
        let error = serde_json::Error::invalid_type(Unexpected::Seq, &"values by name");
        return Err(WorldError::Settings { of, found, error });
    }
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
pub(crate) fn parse_task_settings<T: DeserializeOwned + JsonSchema + Default>(
    value: &Value,
) -> Result<T, WorldError> {
    if value.is_null() {
        return Ok(T::default());
    }
    parse_settings("task_settings", value)
}

/// Reads a configuration whose fields have defaults.
///
/// # Errors
/// What was found and what is expected, after the fields that lead there: `world.sound_rate_hz: found ...`.
pub fn parse_config<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    serde_json::from_str(text).map_err(|error| {
        let told = plain_json_error(&error);
        let value = serde_json::from_str(text).unwrap_or_default();
        let mut path = unreadable_place::<T>(&value);
        if told.starts_with("unknown field") {
            // It is named already.
            path.pop();
        }
        if path.is_empty() {
            return told;
        }
        format!("{}: {told}", written(&path))
    })
}

/// A way from a value into it.
#[derive(Clone, Debug)]
enum Step {
    Field(String),
    Row(usize),
}

impl Step {
    fn value_in<'a>(&self, value: &'a mut Value) -> Option<&'a mut Value> {
        match self {
            Self::Field(name) => value.get_mut(name),
            Self::Row(row) => value.get_mut(row),
        }
    }

    fn remove_from(&self, value: &mut Value) {
        match (self, value) {
            (Self::Field(name), Value::Object(fields)) => drop(fields.remove(name)),
            (Self::Row(row), Value::Array(rows)) => drop(rows.remove(*row)),
            _ => {}
        }
    }
}

/// The place of the innermost value without which all else can be read; empty without one.
fn unreadable_place<T: DeserializeOwned>(root: &Value) -> Vec<Step> {
    fn inside<'a>(root: &'a mut Value, path: &[Step]) -> Option<&'a mut Value> {
        path.iter()
            .try_fold(root, |value, step| step.value_in(value))
    }
    let mut path: Vec<Step> = Vec::new();
    loop {
        let mut whole = root.clone();
        let steps: Vec<Step> = match inside(&mut whole, &path) {
            Some(Value::Object(fields)) => fields.keys().cloned().map(Step::Field).collect(),
            Some(Value::Array(rows)) => (0..rows.len()).map(Step::Row).collect(),
            _ => Vec::new(),
        };
        if steps.len() > MOST_TRIED {
            break;
        }
        let is_at_fault = |step: &Step| {
            let mut rest = root.clone();
            if let Some(holder) = inside(&mut rest, &path) {
                step.remove_from(holder);
            }
            serde_json::from_value::<T>(rest).is_ok()
        };
        match steps.into_iter().find(is_at_fault) {
            Some(step) => path.push(step),
            None => break,
        }
    }
    path
}

/// A path as people write it: `world.laws[0]`.
fn written(path: &[Step]) -> String {
    let words = path.iter().enumerate().map(|(k, step)| match step {
        Step::Field(name) if k == 0 => name.clone(),
        Step::Field(name) => format!(".{name}"),
        Step::Row(row) => format!("[{row}]"),
    });
    words.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Default, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    struct SampleSettings {
        width: u32,
        gain: f32,
    }

    #[test]
    fn a_value_of_a_configuration_is_named_with_the_fields_it_is_in() {
        use crate::env_config::EnvConfig;
        let told = |text: &str| parse_config::<EnvConfig>(text).unwrap_err();
        assert_eq!(
            told(r#"{"task": "Free", "world": {"control_rate_hz": 10.0, "sound_rate_hz": -1}}"#),
            "world.sound_rate_hz: found integer `-1`, expected a whole number from 0"
        );
        assert_eq!(
            told(r#"{"sensors": [{"kind": "gps"}, 5]}"#),
            "sensors[1]: found integer `5`, expected values by name"
        );
        assert_eq!(told("5"), "found integer `5`, expected values by name");
        let nope = told(r#"{"world": {"nope": 1}}"#);
        let expected = "world: unknown field `nope`, expected";
        assert!(nope.starts_with(expected), "{nope}");
        let nope = told(r#"{"nope": 1}"#);
        assert!(nope.starts_with("unknown field `nope`, expected"), "{nope}");
        assert_eq!(
            told(r#"{"world": {"laws": [{"id": "drag"}]}}"#),
            "world.laws[0]: missing field `version`"
        );
        // Of two faults neither is the one without which all else can be read.
        let both = told(r#"{"task": 5, "world": {"sound_rate_hz": -1}}"#);
        assert!(both.starts_with("found integer"), "{both}");
        // Long lists are not searched.
        let long = format!(
            r#"{{"sensors": [{}5]}}"#,
            r#"{"kind": "gps"},"#.repeat(1000)
        );
        assert!(
            told(&long).starts_with("sensors: found integer"),
            "{}",
            told(&long)
        );
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
