//! Actions of the hand as people and programs write them: a kind, its target, and its fields.

use super::target::TargetRequest;
use super::{ActionKind, all};
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_physics::{ActionOutcome, DelayedOutcome, HandAction};
use dwell_scene::AgentId;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// An action of the hand, as data. `World::act_on` reads it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct HandActionRequest {
    /// The name of one of [`all`] that is of the hand.
    pub kind: String,
    /// The fields of a [`TargetRequest`], where the kind is done to a thing, and those of the kind.
    #[serde(flatten)]
    pub fields: Map<String, Value>,
}

impl HandActionRequest {
    /// The kind.
    ///
    /// # Errors
    /// [`WorldError::Unknown`] lists the kinds there are.
    fn kind(&self) -> Result<&'static ActionKind, WorldError> {
        let hands = || all().iter().filter(|kind| kind.is_hand_action());
        hands()
            .find(|kind| kind.name == self.kind)
            .ok_or_else(|| WorldError::Unknown {
                kind: "action",
                name: self.kind.clone(),
                known: hands().map(|kind| kind.name.to_owned()).collect(),
            })
    }
}

/// Returns the names of the fields that a request for a kind may have.
fn allowed_fields(kind: &ActionKind) -> Vec<&'static str> {
    let of_target: &[&str] = if kind.takes_target() {
        schema::field_names::<TargetRequest>()
    } else {
        &[]
    };
    of_target
        .iter()
        .copied()
        .chain(kind.field_names())
        .collect()
}

impl World {
    /// Reads an action for an agent.
    ///
    /// # Errors
    /// [`WorldError::Unknown`] for a kind, [`WorldError::UnknownOfMany`] for an object or part that no one has; [`WorldError::Config`] for what the kind does
    /// not take or needs; [`WorldError::Settings`] for a field that cannot be read; [`WorldError::Render`] for an
    /// impossible camera.
    pub fn read_action(
        &self,
        agent: AgentId,
        request: &HandActionRequest,
    ) -> Result<Box<dyn HandAction>, WorldError> {
        let kind = request.kind()?;
        let allowed = allowed_fields(kind);
        let given = || request.fields.keys();
        if let Some(name) = given().find(|name| !allowed.contains(&name.as_str())) {
            let name_of_kind = kind.name;
            return Err(WorldError::Config {
                field: "action",
                found: format!("{name_of_kind} with {name}"),
                allowed: match allowed.len() {
                    0 => format!("{name_of_kind} alone"),
                    _ => format!("{name_of_kind} with {}", allowed.join(", ")),
                },
            });
        }
        let mut own = request.fields.clone();
        let mut of_target = Map::new();
        for name in schema::field_names::<TargetRequest>() {
            if kind.takes_target()
                && let Some(value) = own.remove(*name)
            {
                of_target.insert((*name).to_owned(), value);
            }
        }
        let target: TargetRequest =
            crate::parse_settings::parse_settings("action", &Value::Object(of_target))?;
        kind.parse_hand_action(target.resolve(self, agent)?, own)
    }

    /// Performs an agent's requested action, without a step of time.
    ///
    /// # Errors
    /// As [`World::read_action`]; an impossible action is no error but an outcome with the reason.
    pub fn act_on(
        &mut self,
        agent: AgentId,
        request: &HandActionRequest,
    ) -> Result<ActionOutcome, WorldError> {
        let action = self.read_action(agent, request)?;
        Ok(self.act(agent, &*action))
    }

    /// Returns the outcomes, in the last step, of actions that take time.
    pub fn delayed_outcomes(&self) -> &[DelayedOutcome] {
        self.physics().delayed_outcomes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Engines, WorldConfig};
    use dwell_physics::actions::{Drop, Open, Pick, Place};
    use dwell_physics::{OutcomeCode, Target};
    use dwell_scene::{EntityId, House, ShoeboxMaterials};
    use glam::Vec3;
    use std::sync::Arc;

    fn world() -> World {
        let house = House::shoebox([6.0, 3.0, 6.0], &ShoeboxMaterials::default()).unwrap();
        let engines = Engines::new(Arc::new(house));
        let mut world = World::new(engines, &WorldConfig::default()).unwrap();
        world
            .place_agent(AgentId(0), Vec3::new(3.0, 0.0, 5.0), 0.0)
            .unwrap();
        world
    }

    fn read(text: &str) -> Result<String, String> {
        let request: HandActionRequest = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let action = world().read_action(AgentId(0), &request);
        action
            .map(|action| format!("{action:?}"))
            .map_err(|error| error.to_string())
    }

    #[track_caller]
    fn assert_reads(text: &str, action: &dyn HandAction) {
        assert_eq!(read(text), Ok(format!("{action:?}")));
    }

    #[test]
    fn requests_are_read_and_what_does_not_belong_is_named() {
        assert_reads(r#"{"kind": "drop"}"#, &Drop {});
        let (target, fraction) = (EntityId(3).into(), 0.25);
        assert_reads(
            r#"{"kind": "open", "object": 3, "fraction": 0.25}"#,
            &Open { target, fraction },
        );
        assert_reads(r#"{"kind": "pick"}"#, &Pick::new(Target::Gaze));
        assert_reads(r#"{"kind": "place"}"#, &Place { target: None });
        for (text, part) in [
            (r#"{"kind": "fly"}"#, "no action \"fly\"; there are"),
            (
                r#"{"kind": "pick", "object": "mug"}"#,
                "no object \"mug\"; there are none",
            ),
            (
                r#"{"kind": "drop", "object": 1}"#,
                "drop with object; allowed is drop alone",
            ),
            (
                r#"{"kind": "pick", "force_n": 1}"#,
                "pick with force_n; allowed is pick with object, part, pixel, camera, origin, direction, grasp",
            ),
            (r#"{"kind": "place_at"}"#, "place_at without a point"),
            (
                r#"{"kind": "pick", "pixel": [128, 0]}"#,
                "pixel is [128, 0]; allowed is [0 to 127, 0 to 127]",
            ),
            (
                r#"{"kind": "pick", "pixel": [1, 0], "object": 1}"#,
                "more than one of object, pixel and direction",
            ),
            (
                r#"{"kind": "pick", "colour": 1}"#,
                "pick with colour; allowed",
            ),
            (
                r#"{"kind": "throw", "speed_m_s": "fast"}"#,
                "action: speed_m_s is \"fast\": found string \"fast\", expected a number",
            ),
            (
                r#"{"kind": "pick", "direction": [1e39, 0, 0]}"#,
                "direction is [inf, 0.0, 0.0]; allowed is finite numbers of 32 bits",
            ),
            (
                r#"{"kind": "pick", "pixel": [1, 1], "camera": {"fov_deg": 500}}"#,
                "fov_deg",
            ),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }

    /// The pixel below and left of the middle of a 2 x 2 image with 90 degrees looks 45 degrees / 2 down in slope 1/2.
    #[test]
    fn a_pixel_points_where_the_camera_sees_it() {
        let mut world = world();
        let request: HandActionRequest = serde_json::from_str(
            r#"{"kind": "point", "pixel": [0, 1], "camera": {"width": 2, "height": 2, "fov_deg": 90}}"#,
        )
        .unwrap();
        let told = world.act_on(AgentId(0), &request).unwrap();
        assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
        // Slopes of -1/2 left and -1/2 down from (3, 1.25, 5): the floor is met 2.5 m ahead.
        let pointed = told.pointed.unwrap();
        assert!(
            (pointed.point - Vec3::new(1.75, 0.0, 2.5)).length() < 1e-3,
            "{}",
            pointed.point
        );
        let told = world.act(AgentId(3), &Drop {});
        assert_eq!(told.code, OutcomeCode::UnknownAgent);
    }
}
