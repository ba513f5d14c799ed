//! How a body is read and written: as flat fields in text, of which those of a person are there for persons only, and without
//! those of a person in a state's bytes, which keep persons beside agents.

use super::person::{PersonBody, PersonColors, Side};
use super::{AgentBody, Locomotion};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// The kind of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum BodyKind {
    /// A capsule.
    #[default]
    Capsule,
    /// A jointed figure that is seen as a person; its body in physics is a capsule all the same.
    Person,
}

macro_rules! fields {
    ($($(#[$about:meta])* $field:ident: $type:ty,)*) => {
        /// A body in text.
        #[derive(Default, Serialize, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        struct TextFields {
            $(#[serde(skip_serializing_if = "Option::is_none")] $field: Option<$type>,)*
            #[serde(skip_serializing_if = "Option::is_none")]
            kind: Option<BodyKind>,
            #[serde(skip_serializing_if = "Option::is_none")]
            hand: Option<Side>,
            #[serde(skip_serializing_if = "Option::is_none")]
            colors: Option<PersonColors>,
        }

        /// A body in bytes.
        #[derive(Serialize, Deserialize)]
        struct ByteFields {
            $($field: $type,)*
        }

        /// A body in schemas.
        #[derive(Serialize, JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        #[allow(dead_code, reason = "only its schema is used")]
        struct SchemaFields {
            $($(#[$about])* $field: $type,)*
            /// `"capsule"` (default) or `"person"`: a jointed figure that is seen as a person.
            kind: BodyKind,
            /// The hand with which a person holds and reaches, default `"right"`.
            hand: Side,
            /// Colours of a person, sRGB, 0 to 255; what is not stated is drawn.
            colors: PersonColors,
        }

        impl Default for SchemaFields {
            fn default() -> Self {
                let AgentBody { $($field,)* person: _ } = AgentBody::default();
                Self {
                    $($field,)*
                    kind: BodyKind::default(),
                    hand: Side::default(),
                    colors: PersonColors::default(),
                }
            }
        }

        impl From<&AgentBody> for TextFields {
            fn from(body: &AgentBody) -> Self {
                Self {
                    $($field: Some(body.$field),)*
                    kind: body.person.map(|_| BodyKind::Person),
                    hand: body.person.map(|person| person.hand),
                    colors: body.person.map(|person| person.colors),
                }
            }
        }

        impl From<&AgentBody> for ByteFields {
            fn from(body: &AgentBody) -> Self {
                Self { $($field: body.$field,)* }
            }
        }

        impl From<ByteFields> for AgentBody {
            fn from(bytes: ByteFields) -> Self {
                Self { $($field: bytes.$field,)* person: None }
            }
        }

        impl TextFields {
            /// The body, with what is not stated as in `other`.
            fn or(self, other: &AgentBody) -> AgentBody {
                AgentBody { $($field: self.$field.unwrap_or(other.$field),)* person: other.person }
            }
        }
    };
}

fields! {
    /// Radius of the capsule, m; 0.05 to 1.
    radius_m: f32,
    /// Height of the capsule, m; at least twice the radius, at most 3; 1.45 to 2 of a person, default 1.7 there.
    height_m: f32,
    /// Height of eyes and ears above the feet, m; at most the height; of a person 0.936 of its height by default.
    eye_height_m: f32,
    /// The highest step that it climbs, m; 0 to 1.
    step_height_m: f32,
    /// The steepest slope that it walks up, rad; 0 to 1.4.
    max_slope_rad: f32,
    /// The heaviest object that it lifts, kg; 0 to 500. A heavier one falls from its hand in the next step.
    lift_kg: f32,
    /// Reach of its hand from its eye, m; 0.1 to 5.
    reach_m: f32,
    /// The force with which it pushes obstacles and with which its hand pushes and pulls, N; 0 to 10,000.
    push_force_n: f32,
    /// The strongest pull of its hand on a door or drawer, N·m or N; 0 to 10,000.
    hand_effort: f32,
    /// The largest edge of an object that it carries, m; 0.05 to 5.
    max_carry_size_m: f32,
    /// The horizontal field of view of the cameras at its eyes that state none of their own, degrees; 1 to 170, default 90.
    /// In a world it is the value of `agent/N/camera/fov_deg` until that is set: then it is that of all its cameras but those with a `projection`, whatever they state.
    camera_fov_deg: f32,
    /// Its locomotion; default: it walks.
    locomotion: Locomotion,
}

impl Serialize for AgentBody {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            TextFields::from(self).serialize(serializer)
        } else {
            ByteFields::from(self).serialize(serializer)
        }
    }
}

impl<'de> Deserialize<'de> for AgentBody {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if !deserializer.is_human_readable() {
            return Ok(ByteFields::deserialize(deserializer)?.into());
        }
        let fields = TextFields::deserialize(deserializer)?;
        let (hand, colors) = (fields.hand, fields.colors);
        if fields.kind.unwrap_or_default() == BodyKind::Person {
            let height_m = fields.height_m.unwrap_or(PersonBody::HEIGHT_M);
            let mut person = Self::person(height_m);
            person.person = Some(PersonBody {
                hand: hand.unwrap_or_default(),
                colors: colors.unwrap_or_default(),
            });
            return Ok(fields.or(&person));
        }
        let field = [
            hand.is_some().then_some("hand"),
            colors.is_some().then_some("colors"),
        ];
        if let Some(field) = field.into_iter().flatten().next() {
            return Err(serde::de::Error::custom(format!(
                "{field} is of bodies of the kind \"person\"; this body is a capsule"
            )));
        }
        Ok(fields.or(&Self::default()))
    }
}

impl JsonSchema for AgentBody {
    fn schema_name() -> Cow<'static, str> {
        "AgentBody".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        SchemaFields::json_schema(generator)
    }
}
