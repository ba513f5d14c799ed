//! The fields of settings and actions, from the types that read them: one source for checks, types and pages.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::de::{Deserialize, DeserializeOwned, Deserializer, Visitor};
use serde::{Serialize, forward_to_deserialize_any};
use serde_json::Value;

/// A field of a struct that is read from data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FieldSchema {
    /// The name.
    pub name: &'static str,
    /// The doc comment, on one line.
    pub about: String,
    /// True if it must be given.
    pub required: bool,
    /// Type, range and default, as JSON Schema has them.
    pub schema: Value,
}

/// The doc comment of a type, on one line.
pub fn doc_comment<T: JsonSchema>() -> String {
    take_about(&mut root::<T>())
}

/// The fields of a struct, in the order in which it declares them.
pub fn fields_of<T: JsonSchema + DeserializeOwned>() -> Vec<FieldSchema> {
    let mut root = root::<T>();
    let is_required = |name: &str| {
        let required = root["required"].as_array();
        required.is_some_and(|names| names.iter().any(|other| other == name))
    };
    let required: Vec<bool> = field_names::<T>()
        .iter()
        .map(|name| is_required(name))
        .collect();
    let one = |(name, required): (&&'static str, bool)| {
        let mut schema = root["properties"][*name].take();
        FieldSchema {
            name,
            about: take_about(&mut schema),
            required,
            schema,
        }
    };
    field_names::<T>().iter().zip(required).map(one).collect()
}

/// A word that stands for a variant of an enum.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VariantSchema {
    /// The word.
    pub name: String,
    /// The doc comment, on one line.
    pub about: String,
}

/// The variants without fields of an enum, in the order in which it declares them.
pub fn variants_of<T: JsonSchema>() -> Vec<VariantSchema> {
    let mut root = root::<T>();
    let variants = root["oneOf"].as_array_mut().map(std::mem::take);
    let one = |mut variant: Value| {
        Some(VariantSchema {
            name: variant["const"].as_str()?.to_owned(),
            about: take_about(&mut variant),
        })
    };
    variants
        .unwrap_or_default()
        .into_iter()
        .filter_map(one)
        .collect()
}

/// The names of a struct's fields, in the order in which it declares them; none where it reads anything else.
pub(crate) fn field_names<'de, T: Deserialize<'de>>() -> &'static [&'static str] {
    let mut names: &'static [&'static str] = &[];
    // It never returns a value: only the request of `T` for a struct is wanted.
    let _ = T::deserialize(FieldNameRecorder(&mut names));
    names
}

pub(crate) fn root<T: JsonSchema>() -> Value {
    let settings =
        SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    settings
        .into_generator()
        .into_root_schema_for::<T>()
        .to_value()
}

/// Takes the doc comment out of a schema: links to other items as code.
fn take_about(schema: &mut Value) -> String {
    let about = schema
        .as_object_mut()
        .and_then(|schema| schema.remove("description"));
    let about = about.as_ref().and_then(Value::as_str).unwrap_or_default();
    let mut about = about.replace('\n', " ").replace("[`", "`");
    while let Some(at) = about.find("`]") {
        let rest = &about[at + 2..];
        let target = rest.strip_prefix('(').and_then(|rest| rest.find(')'));
        let end = at + 2 + target.map_or(0, |length| length + 2);
        about.replace_range(at + 1..end, "");
    }
    about
}

/// A deserializer that records the field names that a struct requests, and gives no value.
struct FieldNameRecorder<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for FieldNameRecorder<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
        Err(serde::de::Error::custom("no value"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Self::Error> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// What a thing is.
    ///
    /// [`Thing`] has two fields.
    #[derive(serde::Deserialize, JsonSchema)]
    #[expect(dead_code, reason = "only its declaration is looked at")]
    struct Thing {
        /// How much,
        /// m; see [`Thing`] and [`Thing::name`](Thing).
        #[schemars(range(min = 0.0, max = 2.0))]
        width_m: f32,
        /// Its name.
        #[serde(default)]
        name: Option<String>,
    }

    #[derive(serde::Deserialize, JsonSchema)]
    #[serde(rename_all = "snake_case")]
    enum Weight {
        /// As lead.
        VeryHeavy,
        /// As cork.
        Light,
    }

    #[test]
    fn fields_stand_in_order_with_their_text_type_and_range() {
        let [width, name] = fields_of::<Thing>().try_into().unwrap();
        assert_eq!((width.name, width.required), ("width_m", true));
        assert_eq!(width.about, "How much, m; see `Thing` and `Thing::name`.");
        assert_eq!(
            width.schema,
            json!({"type": "number", "format": "float", "minimum": 0.0, "maximum": 2.0})
        );
        assert_eq!((name.name, name.required), ("name", false));
        assert_eq!(
            name.schema,
            json!({"type": ["string", "null"], "default": null})
        );
        assert_eq!(
            doc_comment::<Thing>(),
            "What a thing is.  `Thing` has two fields."
        );
        assert_eq!(fields_of::<u32>(), []);
        let [heavy, light] = variants_of::<Weight>().try_into().unwrap();
        assert_eq!(
            (heavy.name.as_str(), heavy.about.as_str()),
            ("very_heavy", "As lead.")
        );
        assert_eq!(light.name, "light");
    }
}
