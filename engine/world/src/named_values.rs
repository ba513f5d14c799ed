//! Values by name: no list stands for them, although derived readers would take one by position.

use serde_json::Value;

/// The first list in `value` where the schema of a whole type, `root`, has named values, with its place: `reward`, `cameras[0].pose`.
pub(crate) fn list_for_names<'a>(root: &Value, value: &'a Value) -> Option<(String, &'a Value)> {
    find(root, root, value, "")
}

fn find<'a>(
    root: &Value,
    schema: &Value,
    value: &'a Value,
    at: &str,
) -> Option<(String, &'a Value)> {
    match value {
        Value::Array(items) => {
            let forms = alternatives(root, schema);
            let takes = |named: fn(&Value) -> bool| forms.iter().any(|form| named(form));
            if takes(|form| form["properties"].is_object())
                && !takes(|form| has_type(form, "array"))
            {
                return Some((at.to_owned(), value));
            }
            let own = forms.iter().find(|form| form["items"].is_object())?;
            let mut items = items.iter().enumerate();
            items.find_map(|(k, item)| find(root, &own["items"], item, &format!("{at}[{k}]")))
        }
        Value::Object(fields) => {
            let forms = alternatives(root, schema);
            fields.iter().find_map(|(name, part)| {
                let field = |form: &&Value| form["properties"][name].is_object();
                let own = forms.iter().copied().find(field)?;
                let at = if at.is_empty() {
                    name.clone()
                } else {
                    format!("{at}.{name}")
                };
                find(root, &own["properties"][name], part, &at)
            })
        }
        _ => None,
    }
}

fn has_type(schema: &Value, name: &str) -> bool {
    match &schema["type"] {
        Value::String(own) => own == name,
        Value::Array(all) => all.iter().any(|own| own == name),
        _ => false,
    }
}

/// The schemas of which a value fits one, with references followed.
fn alternatives<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a Value> {
    if let Some(place) = schema["$ref"].as_str() {
        let place = place.trim_start_matches('#');
        return root
            .pointer(place)
            .map_or_else(Vec::new, |own| alternatives(root, own));
    }
    let mut all = vec![schema];
    for key in ["anyOf", "oneOf", "allOf"] {
        let own = schema[key].as_array().into_iter().flatten();
        all.extend(own.flat_map(|one| alternatives(root, one)));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn lists_are_found_where_names_are_meant() {
        let root = json!({
            "properties": {
                "reward": {"$ref": "#/$defs/Reward"},
                "place": {"anyOf": [{"$ref": "#/$defs/Reward"}, {"type": "array"}]},
                "maybe": {"anyOf": [{"$ref": "#/$defs/Reward"}, {"type": "null"}]},
                "many": {"type": "array", "items": {"$ref": "#/$defs/Reward"}},
                "sounds": {"type": "array", "items": {"type": "string"}},
            },
            "$defs": {"Reward": {"type": "object", "properties": {"step": {"type": "number"}}}},
        });
        for (value, place) in [
            (
                json!({"reward": {"step": 1}, "sounds": ["a"], "unknown": [1]}),
                None,
            ),
            (json!({"reward": [1]}), Some("reward")),
            (json!({"maybe": [1]}), Some("maybe")),
            (json!({"place": [1]}), None),
            (json!({"many": [{"step": 1}, [2]]}), Some("many[1]")),
            (json!([1]), Some("")),
        ] {
            let found = list_for_names(&root, &value);
            assert_eq!(found.map(|(at, _)| at).as_deref(), place, "{value}");
        }
    }
}
