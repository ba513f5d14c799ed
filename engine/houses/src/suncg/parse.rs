//! Parsing of `house.json` into [`SuncgHouse`], node by node, so that one bad field costs that field only.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::file::{SuncgHouse, SuncgLevel, SuncgMaterial, SuncgNode};
use super::lenient_json::{SEPARATOR, shorten};
use crate::error::HousesError;
use crate::limits::MAX_NODES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Parses the text of a `house.json`.
///
/// `name` names the file in errors and in the report.
///
/// # Errors
/// [`HousesError::Syntax`] with the line when the text is no JSON, [`HousesError::Field`] when there are no levels,
/// [`HousesError::TooLarge`] for too many nodes.
pub fn parse(text: &[u8], name: &str, report: &mut LoadReport) -> Result<SuncgHouse, HousesError> {
    let at = FileLocation::file(name);
    let value = crate::json::value_of_unique_keys(text).map_err(|error| HousesError::Syntax {
        at: at.line(u32::try_from(error.line()).unwrap_or(u32::MAX)),
        message: format!("no valid JSON: {error}"),
    })?;
    let Value::Object(mut top) = value else {
        return Err(HousesError::Field {
            at,
            expected: "an object with levels",
            found: shorten(&value),
        });
    };
    let levels = match top.remove("levels") {
        Some(Value::Array(levels)) => levels,
        other => {
            let found = other.map_or_else(|| "nothing".to_owned(), |value| shorten(&value));
            return Err(HousesError::Field {
                at: at.field("levels"),
                expected: "a list of levels",
                found,
            });
        }
    };
    let node_count: usize = levels
        .iter()
        .filter_map(|level| level.get("nodes")?.as_array())
        .map(Vec::len)
        .sum();
    if node_count > MAX_NODES {
        let (found, allowed) = (node_count as u64, MAX_NODES as u64);
        return Err(HousesError::TooLarge {
            at: at.field("levels"),
            what: "node count",
            found,
            allowed,
        });
    }
    let materials = list::<SuncgMaterial>(top.remove("materials"), &at, "materials", report);
    let mut house: SuncgHouse = parse_fields_leniently(top, &at, report);
    house.materials = materials.unwrap_or_default();
    for (i, level) in levels.into_iter().enumerate() {
        let at = at.field(format_args!("levels[{i}]"));
        // A level that is no object stays as an empty one: later levels keep their index.
        house.levels.push(match level {
            Value::Object(fields) => read_level(fields, &at, report),
            other => {
                bad_field(&other, "an object", at, report);
                SuncgLevel::default()
            }
        });
    }
    Ok(house)
}

fn read_level(
    mut object: Map<String, Value>,
    at: &FileLocation,
    report: &mut LoadReport,
) -> SuncgLevel {
    let nodes = object.remove("nodes");
    let mut level: SuncgLevel = parse_fields_leniently(object, at, report);
    match nodes {
        Some(Value::Array(nodes)) => {
            for (i, node) in nodes.into_iter().enumerate() {
                level.nodes.push(read_node(
                    node,
                    &at.field(format_args!("nodes[{i}]")),
                    report,
                ));
            }
        }
        None | Some(Value::Null) => {}
        Some(other) => bad_field(&other, "a list of nodes", at.field("nodes"), report),
    }
    level
}

fn read_node(node: Value, at: &FileLocation, report: &mut LoadReport) -> SuncgNode {
    let Value::Object(mut object) = node else {
        bad_field(&node, "an object", at.clone(), report);
        return SuncgNode {
            valid: Some(super::file::BinaryFlag(false)),
            ..SuncgNode::default()
        };
    };
    let materials = list(object.remove("materials"), at, "materials", report);
    let node: SuncgNode = parse_fields_leniently(object, at, report);
    SuncgNode { materials, ..node }
}

/// A list of structs whose bad entries count as empty ones, because positions matter.
fn list<T: DeserializeOwned + Default>(
    value: Option<Value>,
    at: &FileLocation,
    field: &str,
    report: &mut LoadReport,
) -> Option<Vec<T>> {
    match value {
        Some(Value::Array(items)) => Some(
            items
                .into_iter()
                .enumerate()
                .map(|(i, item)| {
                    let at = at.field(format_args!("{field}[{i}]"));
                    match item {
                        Value::Object(object) => parse_fields_leniently(object, &at, report),
                        Value::Null => T::default(),
                        other => {
                            bad_field(&other, "an object", at, report);
                            T::default()
                        }
                    }
                })
                .collect(),
        ),
        None | Some(Value::Null) => None,
        Some(other) => {
            bad_field(&other, "a list", at.field(field), report);
            None
        }
    }
}

/// Reads a struct field by field when it cannot be read as a whole; fields that cannot be read are reported and count
/// as absent.
fn parse_fields_leniently<T: DeserializeOwned + Default>(
    object: Map<String, Value>,
    at: &FileLocation,
    report: &mut LoadReport,
) -> T {
    let whole = Value::Object(object);
    if let Ok(value) = T::deserialize(&whole) {
        return value;
    }
    let Value::Object(mut object) = whole else {
        return T::default();
    };
    object.retain(|key, value| {
        let alone = Value::Object(Map::from_iter([(key.clone(), value.clone())]));
        let Err(error) = T::deserialize(&alone) else {
            return true;
        };
        let message = error.to_string();
        let (found, expected) = if let Some((found, expected)) = message.split_once(SEPARATOR) {
            (found.to_owned(), expected.to_owned())
        } else {
            let told = crate::plain_parse_error(message);
            let expected = told.rsplit_once("expected ");
            let expected = expected.map_or(told.as_str(), |(_, expected)| expected);
            (shorten(value), expected.to_owned())
        };
        report.warn(at.field(key), WarningKind::BadField { found, expected });
        false
    });
    T::deserialize(Value::Object(object)).unwrap_or_default()
}

fn bad_field(found: &Value, expected: &str, at: FileLocation, report: &mut LoadReport) {
    report.warn(
        at,
        WarningKind::BadField {
            found: shorten(found),
            expected: expected.to_owned(),
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::suncg::file::BinaryFlag;

    fn read(text: &str) -> (SuncgHouse, LoadReport) {
        let mut report = LoadReport::new();
        let house = parse(text.as_bytes(), "house.json", &mut report).unwrap();
        (house, report)
    }

    #[test]
    fn numbers_and_flags_are_read_in_every_spelling() {
        let (house, report) = read(
            r#"{"scaleToMeters":"1.0","levels":[{"id":0,"valid":true,"nodes":[
                {"valid":"1","modelId":83,"state":"1","nodeIndices":["1",2,3.0,"x"],"roomTypes":"Kitchen","isMirrored":false},
                {"valid":"0"},{"valid":0},{"valid":null,"transform":[null,1],"someTool":{"a":1}}]}]}"#,
        );
        assert!(report.is_empty(), "{report}");
        assert_eq!(house.scale_to_meters, Some(1.0));
        let nodes = &house.levels[0].nodes;
        assert_eq!(
            nodes.iter().map(SuncgNode::is_valid).collect::<Vec<_>>(),
            [true, false, false, true]
        );
        assert_eq!(
            (
                nodes[0].model_id.as_deref(),
                nodes[0].state,
                nodes[0].is_mirrored
            ),
            (Some("83"), Some(1.0), Some(BinaryFlag(false)))
        );
        assert_eq!(
            nodes[0].node_indices.as_deref().map(|i| &i[..3]),
            Some([1.0, 2.0, 3.0].as_slice())
        );
        assert!(
            nodes[0].node_indices.as_ref().unwrap()[3].is_nan()
                && nodes[3].transform.as_ref().unwrap()[0].is_nan()
        );
        assert_eq!(nodes[0].room_types, Some(vec!["Kitchen".to_owned()]));
    }

    #[test]
    fn a_bad_field_costs_that_field_only() {
        let (house, report) = read(
            r#"{"levels":[{"nodes":[{"id":"0_0","modelId":["83"],"transform":"no","bbox":3},7]},"x"]}"#,
        );
        assert_eq!(house.levels.len(), 2);
        assert_eq!(house.levels[0].nodes[0].id.as_deref(), Some("0_0"));
        assert!(!house.levels[0].nodes[1].is_valid());
        assert_eq!(
            report.to_string(),
            "house.json: levels[0].nodes[0].bbox: found 3, expected values by name; treated as absent\n\
             house.json: levels[0].nodes[0].modelId: found [\"83\"], expected a string; treated as absent\n\
             house.json: levels[0].nodes[0].transform: found \"no\", expected a list of numbers; treated as absent\n\
             house.json: levels[0].nodes[1]: found 7, expected an object; treated as absent\n\
             house.json: levels[1]: found \"x\", expected an object; treated as absent\n"
        );
    }

    #[test]
    fn files_without_levels_are_refused_with_the_place() {
        let message = |text: &str| {
            parse(text.as_bytes(), "house.json", &mut LoadReport::new())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            message("{}"),
            "house.json: levels: expected a list of levels, found nothing"
        );
        assert_eq!(
            message("[1]"),
            "house.json: expected an object with levels, found [1]"
        );
        assert_eq!(
            message("{\n\"levels\": [\n"),
            "house.json:3: no valid JSON: EOF while parsing a list at line 3 column 0"
        );
    }
}
