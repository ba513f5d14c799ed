//! Kinds of actions: the rows of the table of actions.

use super::step_sizes::StepSizes;
use crate::error::WorldError;
use crate::schema::{self, FieldSchema};
use dwell_physics::{AgentControl, HandAction, Target};
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// The field of a hand's action that states its target.
const TARGET: &str = "target";

/// A kind of action.
#[derive(Clone, Copy, Debug)]
pub struct ActionKind {
    /// The name, as in lists, requests and files.
    pub name: &'static str,
    about: DescriptionSource,
    control: ControlFn,
    hand: Option<HandActionParser>,
}

/// The source of the sentence about a kind.
#[derive(Clone, Copy, Debug)]
enum DescriptionSource {
    Here(&'static str),
    DocComment(fn() -> String),
}

/// The velocities of the body in a step of so many seconds.
pub(super) type ControlFn = fn(&StepSizes, f64) -> AgentControl;

/// The reader of an action of the hand.
#[derive(Clone, Copy, Debug)]
struct HandActionParser {
    field_names: fn() -> &'static [&'static str],
    fields: fn() -> Vec<FieldSchema>,
    read: fn(&Value) -> Result<Box<dyn HandAction>, WorldError>,
}

/// Returns an action of the feet or neck, or none at all, by the velocities that it makes.
pub(super) const fn movement(
    name: &'static str,
    about: &'static str,
    control: ControlFn,
) -> ActionKind {
    ActionKind {
        name,
        about: DescriptionSource::Here(about),
        control,
        hand: None,
    }
}

/// Returns an action of the hand; its doc comment, fields and ranges are those of its type.
pub(super) const fn hand<A>(name: &'static str) -> ActionKind
where
    A: HandAction + DeserializeOwned + JsonSchema + 'static,
{
    ActionKind {
        name,
        about: DescriptionSource::DocComment(schema::doc_comment::<A>),
        control: zero_velocity,
        hand: Some(HandActionParser {
            field_names: schema::field_names::<A>,
            fields: schema::fields_of::<A>,
            read: |fields| {
                let action: A = crate::parse_settings::parse_settings("action", fields)?;
                Ok(Box::new(action))
            },
        }),
    }
}

/// Returns zero velocities: those of an action that moves nothing but the hand.
pub(super) fn zero_velocity(_: &StepSizes, _: f64) -> AgentControl {
    AgentControl::default()
}

impl ActionKind {
    /// One sentence about it.
    pub fn description(&self) -> String {
        match self.about {
            DescriptionSource::Here(about) => about.to_owned(),
            DescriptionSource::DocComment(about) => about(),
        }
    }

    /// Returns whether it is an action of the hand, which requests can name.
    pub fn is_hand_action(&self) -> bool {
        self.hand.is_some()
    }

    /// The velocities of the body in a step of `step_s`.
    pub fn control(&self, stride: &StepSizes, step_s: f64) -> AgentControl {
        (self.control)(stride, step_s)
    }

    /// Returns whether it has a target.
    pub fn takes_target(&self) -> bool {
        self.all_field_names().contains(&TARGET)
    }

    /// The fields of a request for it, beside those of the target.
    pub fn fields(&self) -> Vec<FieldSchema> {
        let mut fields = self.hand.map_or_else(Vec::new, |hand| (hand.fields)());
        fields.retain(|field| field.name != TARGET);
        fields
    }

    /// The doc comment of its target; `None` without one.
    pub fn target_description(&self) -> Option<String> {
        let fields = self.hand.map_or_else(Vec::new, |hand| (hand.fields)());
        let target = fields.into_iter().find(|field| field.name == TARGET)?;
        Some(target.about)
    }

    /// The names of [`Self::fields`].
    pub(super) fn field_names(&self) -> impl Iterator<Item = &'static str> {
        let all = self.all_field_names().iter().copied();
        all.filter(|name| *name != TARGET)
    }

    fn all_field_names(&self) -> &'static [&'static str] {
        self.hand.map_or(&[], |hand| (hand.field_names)())
    }

    /// Returns the hand's action.
    ///
    /// `target`: its target, if one is stated.
    /// `fields`: the fields of the kind.
    ///
    /// # Errors
    /// [`WorldError::Config`] for a field that is missing, [`WorldError::Settings`] for one that cannot be read,
    /// [`WorldError::InvalidCall`] for an action that is not of the hand.
    pub(super) fn parse_hand_action(
        &self,
        target: Option<Target>,
        mut fields: Map<String, Value>,
    ) -> Result<Box<dyn HandAction>, WorldError> {
        let Some(hand) = self.hand else {
            let name = self.name;
            return Err(WorldError::InvalidCall(format!("{name}: no hand does it")));
        };
        if let Some(target) = target {
            fields.insert(TARGET.to_owned(), to_value(&target)?);
        }
        (hand.read)(&Value::Object(fields)).map_err(|error| self.say_what_is_missing(error))
    }

    fn say_what_is_missing(&self, error: WorldError) -> WorldError {
        let WorldError::Settings { error: told, .. } = &error else {
            return error;
        };
        let told = told.to_string();
        let Some((field, _)) = told
            .strip_prefix("missing field `")
            .and_then(|rest| rest.split_once('`'))
        else {
            return error;
        };
        let name = self.name;
        WorldError::Config {
            field: "action",
            found: format!("{name} without a {field}"),
            allowed: format!("{name} with a {field}"),
        }
    }
}

fn to_value(target: &impl Serialize) -> Result<Value, WorldError> {
    serde_json::to_value(target).map_err(|error| WorldError::InvalidCall(error.to_string()))
}
