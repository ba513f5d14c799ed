//! Actions as people and programs write them: things by name, id, pixel or ray.

use crate::error::WorldError;
use crate::world::World;
use dwell_physics::{Action, ActionOutcome, DelayedOutcome, Grasp, Target};
use dwell_render::{Camera, Projection};
use dwell_scene::{AgentId, EntityId, House, ObjectId, PartId, Pose};
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// The kinds of action and what each may say besides its kind, in the order in which they are told.
const KINDS: [(&str, &[&str]); 12] = [
    ("pick", &["target", "grasp"]),
    ("drop", &[]),
    ("place", &["target"]),
    ("place_at", &["point"]),
    ("put_in", &["target"]),
    ("throw", &["direction", "speed_m_s"]),
    ("push", &["target", "force_n"]),
    ("pull", &["target", "force_n"]),
    ("open", &["target", "fraction"]),
    ("close", &["target"]),
    ("toggle", &["target"]),
    ("point", &["target"]),
];
/// How many names an error lists, the nearest first.
const NAMES: usize = 12;

/// A thing by its name in the house, or by the sensors' id.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ObjectRef {
    /// The sensors' id, as instance images have it.
    Id(i32),
    /// The name.
    Name(String),
}

/// The camera to which a pixel belongs; it stands at the agent's eye.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PixelCamera {
    /// Pixels across, default 128.
    pub width: u32,
    /// Pixels down, default 128.
    pub height: u32,
    /// Full angle from the left to the right edge, degrees; by default that of the agent's camera.
    pub fov_deg: Option<f32>,
    /// The kind of camera with its numbers, in place of `fov_deg`.
    pub projection: Option<Projection>,
    /// Where the camera is against the eye: to the right, up, back, m.
    pub position_m: [f32; 3],
    /// How it is turned there, degrees to the left.
    pub yaw_deg: f32,
    /// Then up, degrees.
    pub pitch_deg: f32,
    /// Then about its own axis, degrees, counter-clockwise as it looks.
    pub roll_deg: f32,
}

impl Default for PixelCamera {
    fn default() -> Self {
        Self {
            width: 128,
            height: 128,
            fov_deg: None,
            projection: None,
            position_m: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            roll_deg: 0.0,
        }
    }
}

/// An action of the hand, as data: a kind and what it needs. `World::act_on` reads it.
///
/// What it is done to is an `object` (and one `part` of it), a `pixel` of a `camera`, or a ray from `origin` along
/// `direction`; without any of them it is what the agent looks at.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ActionRequest {
    /// `pick`, `drop`, `place`, `place_at`, `put_in`, `throw`, `push`, `pull`, `open`, `close`, `toggle` or `point`.
    pub kind: String,
    /// The thing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub object: Option<ObjectRef>,
    /// One part of the thing, by name: one drawer of several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Column and row of a pixel, counted from 0 at the top left; its middle is meant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixel: Option<[f32; 2]>,
    /// The pixel's camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<PixelCamera>,
    /// Where a ray starts, m; default the agent's eye.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<[f32; 3]>,
    /// Where a ray or a throw goes, in world space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f32; 3]>,
    /// Where to put something down, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<[f32; 3]>,
    /// Of a throw, m/s; default 3.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f32>,
    /// Of a push or pull, N; default all the agent has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_n: Option<f32>,
    /// How far to open, 0 to 1; default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fraction: Option<f32>,
    /// How to hold what is picked: `"kinematic"` or `{"spring": {"frequency_hz": 4, "damping_ratio": 1}}`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grasp: Option<Grasp>,
}

impl ActionRequest {
    /// The names of all kinds.
    pub fn kinds() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|(kind, _)| *kind)
    }

    /// Returns what is said besides the kind.
    fn given_fields(&self) -> Vec<&'static str> {
        let throws = self.kind == "throw";
        let target = self.object.is_some()
            || self.part.is_some()
            || self.pixel.is_some()
            || self.camera.is_some()
            || self.origin.is_some()
            || (self.direction.is_some() && !throws);
        [
            ("target", target),
            ("direction", self.direction.is_some() && throws),
            ("point", self.point.is_some()),
            ("speed_m_s", self.speed_m_s.is_some()),
            ("force_n", self.force_n.is_some()),
            ("fraction", self.fraction.is_some()),
            ("grasp", self.grasp.is_some()),
        ]
        .into_iter()
        .filter_map(|(name, said)| said.then_some(name))
        .collect()
    }

    fn check(&self) -> Result<(), WorldError> {
        let Some((kind, allowed)) = KINDS.iter().find(|(kind, _)| *kind == self.kind) else {
            return Err(WorldError::Unknown {
                kind: "action",
                name: self.kind.clone(),
                known: Self::kinds().map(str::to_owned).collect(),
            });
        };
        match self
            .given_fields()
            .into_iter()
            .find(|said| !allowed.contains(said))
        {
            None => Ok(()),
            Some(found) => Err(WorldError::Config {
                field: "action",
                found: format!("{kind} with a {found}"),
                allowed: match allowed.len() {
                    0 => format!("{kind} alone"),
                    _ => format!("{kind} with {}", allowed.join(", ")),
                },
            }),
        }
    }

    fn target(&self, world: &World, agent: AgentId) -> Result<Option<Target>, WorldError> {
        let house = world.house();
        let ways = [
            self.object.is_some(),
            self.pixel.is_some(),
            self.direction.is_some(),
        ];
        if ways.iter().filter(|way| **way).count() > 1 {
            return Err(WorldError::Config {
                field: "action",
                found: "more than one of object, pixel and direction".to_owned(),
                allowed: "one way to say what is meant".to_owned(),
            });
        }
        if let Some(named) = &self.object {
            let target = match named {
                ObjectRef::Id(id) => Target::Entity(EntityId(*id)),
                ObjectRef::Name(name) => Target::Object(object_named(house, name)?),
            };
            let Some(part) = &self.part else {
                return Ok(Some(target));
            };
            let object = match target {
                Target::Object(object) => Some(object),
                Target::Entity(id) => match house.entity(id) {
                    Some(dwell_scene::Entity::Object(object)) => Some(object),
                    _ => None,
                },
                _ => None,
            };
            return match object {
                Some(object) => part_named(house, object, part).map(|part| Some(part.into())),
                None => Ok(Some(target)),
            };
        }
        if let Some([column, row]) = self.pixel {
            let camera = self.camera.unwrap_or_default();
            let state = world.state();
            let own = state.agents.get(agent).map(|_| state.camera_fov_deg(agent));
            let fov_deg = camera.fov_deg.or(own).unwrap_or(90.0);
            let angles = [camera.yaw_deg, camera.pitch_deg, camera.roll_deg];
            let mount = crate::sensors::mount(camera.position_m, angles);
            let camera = match camera.projection {
                Some(projection) => Camera::new(camera.width, camera.height, projection)?,
                None => Camera::from_fov(camera.width, camera.height, fov_deg)?,
            };
            return world
                .pixel_target(agent, &camera, mount, [column, row])
                .map(Some);
        }
        if let Some(direction) = self.direction {
            let eye = world
                .state()
                .agents
                .get(agent)
                .map(dwell_scene::AgentState::eye_position);
            let origin = self.origin.map(Vec3::from_array).or(eye);
            return Ok(Some(Target::Ray {
                origin: origin.unwrap_or_default(),
                direction: Vec3::from_array(direction),
            }));
        }
        Ok(None)
    }
}

/// The names that may have been meant.
fn similar_names<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Vec<String> {
    let near = dwell_houses::nearest(name, known, NAMES);
    near.into_iter().map(str::to_owned).collect()
}

fn object_named(house: &House, name: &str) -> Result<ObjectId, WorldError> {
    house.object_named(name).ok_or_else(|| WorldError::Unknown {
        kind: "object",
        name: name.to_owned(),
        known: similar_names(
            name,
            house.objects.iter().map(|object| object.name.as_str()),
        ),
    })
}

fn part_named(house: &House, object: ObjectId, name: &str) -> Result<PartId, WorldError> {
    let mut parts = house.objects[object].parts();
    parts
        .find(|part| house.parts[*part].name == name)
        .ok_or_else(|| WorldError::Unknown {
            kind: "part",
            name: name.to_owned(),
            known: similar_names(
                name,
                house.objects[object]
                    .parts()
                    .map(|part| house.parts[part].name.as_str()),
            ),
        })
}

fn missing(kind: &str, field: &str) -> WorldError {
    WorldError::Config {
        field: "action",
        found: format!("{kind} without a {field}"),
        allowed: format!("{kind} with a {field}"),
    }
}

impl World {
    /// Returns what a pixel of a camera at an agent's eye shows, as a target.
    ///
    /// `eye_from_camera`: where the camera is mounted.
    /// `pixel`: column and row, counted from 0 at the top left; the middle of the pixel is meant.
    ///
    /// # Errors
    /// [`WorldError::Config`] for a pixel outside the image, [`WorldError::Usage`] for an agent that does not exist.
    pub fn pixel_target(
        &self,
        agent: AgentId,
        camera: &Camera,
        eye_from_camera: Pose,
        [column, row]: [f32; 2],
    ) -> Result<Target, WorldError> {
        let (width, height) = (camera.width() as f32, camera.height() as f32);
        if !(0.0..width).contains(&column) || !(0.0..height).contains(&row) {
            return Err(WorldError::Config {
                field: "pixel",
                found: format!("[{column}, {row}]"),
                allowed: format!("[0 to {}, 0 to {}]", width - 1.0, height - 1.0),
            });
        }
        let Some(state) = self.state().agents.get(agent) else {
            return Err(WorldError::Usage(format!(
                "no agent {}; there are {}",
                agent.0,
                self.state().agents.len()
            )));
        };
        let eye = state.world_from_eye() * eye_from_camera;
        let (start, direction) = camera.ray_in_camera(Vec2::new(column + 0.5, row + 0.5));
        if direction == Vec3::ZERO {
            return Err(WorldError::Config {
                field: "pixel",
                found: format!("[{column}, {row}]"),
                allowed: "a pixel that sees something".to_owned(),
            });
        }
        Ok(Target::Ray {
            origin: eye.transform_point(start),
            direction: eye.transform_vector(direction),
        })
    }

    /// Reads an action for an agent.
    ///
    /// # Errors
    /// [`WorldError::Unknown`] for a kind, object or part that no one has; [`WorldError::Config`] for what the kind does
    /// not take or needs; [`WorldError::Render`] for an impossible camera.
    pub fn read_action(
        &self,
        agent: AgentId,
        request: &ActionRequest,
    ) -> Result<Action, WorldError> {
        request.check()?;
        let on = request.target(self, agent)?;
        let target = on.unwrap_or_default();
        let force_n = request.force_n;
        Ok(match request.kind.as_str() {
            "pick" => Action::Pick {
                target,
                grasp: request.grasp.unwrap_or_default(),
            },
            "place" => Action::Place { on },
            "place_at" => {
                let point = request.point.ok_or_else(|| missing("place_at", "point"))?;
                Action::PlaceAt {
                    point: Vec3::from_array(point),
                }
            }
            "put_in" => Action::PutIn { container: target },
            "throw" => {
                let eye = self.state().agents.get(agent);
                let ahead = eye.map_or(Vec3::NEG_Z, |agent| {
                    agent.world_from_eye().transform_vector(Vec3::NEG_Z)
                });
                Action::Throw {
                    direction: request.direction.map_or(ahead, Vec3::from_array),
                    speed_m_s: request.speed_m_s.unwrap_or(3.0),
                }
            }
            "push" => Action::Push { target, force_n },
            "pull" => Action::Pull { target, force_n },
            "open" => Action::Open {
                target,
                fraction: request.fraction.unwrap_or(1.0),
            },
            "close" => Action::Close { target },
            "toggle" => Action::Toggle { target },
            "point" => Action::Point { target },
            _ => Action::Drop,
        })
    }

    /// Lets an agent do what a request says, without a step of time.
    ///
    /// # Errors
    /// As [`World::read_action`]; an action that cannot be is no error but an outcome that says why.
    pub fn act_on(
        &mut self,
        agent: AgentId,
        request: &ActionRequest,
    ) -> Result<ActionOutcome, WorldError> {
        let action = self.read_action(agent, request)?;
        Ok(self.act(agent, &action))
    }

    /// Returns what became, in the last step, of actions that take time.
    pub fn notices(&self) -> &[DelayedOutcome] {
        self.physics().notices()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Engines, WorldConfig};
    use dwell_physics::OutcomeCode;
    use dwell_scene::ShoeboxMaterials;
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

    fn read(text: &str) -> Result<Action, String> {
        let request: ActionRequest = serde_json::from_str(text).map_err(|e| e.to_string())?;
        world()
            .read_action(AgentId(0), &request)
            .map_err(|e| e.to_string())
    }

    #[test]
    fn requests_are_read_and_what_does_not_belong_is_named() {
        assert_eq!(read(r#"{"kind": "drop"}"#), Ok(Action::Drop));
        assert_eq!(
            read(r#"{"kind": "open", "object": 3, "fraction": 0.25}"#),
            Ok(Action::Open {
                target: EntityId(3).into(),
                fraction: 0.25
            })
        );
        assert_eq!(read(r#"{"kind": "pick"}"#), Ok(Action::pick(Target::Gaze)));
        assert_eq!(read(r#"{"kind": "place"}"#), Ok(Action::Place { on: None }));
        for (text, part) in [
            (r#"{"kind": "fly"}"#, "no action \"fly\"; there are"),
            (r#"{"kind": "pick", "object": "mug"}"#, "no object \"mug\""),
            (
                r#"{"kind": "drop", "object": 1}"#,
                "drop with a target; allowed is drop alone",
            ),
            (
                r#"{"kind": "pick", "force_n": 1}"#,
                "pick with a force_n; allowed is pick with target, grasp",
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
            (r#"{"kind": "pick", "colour": 1}"#, "unknown field `colour`"),
            (
                r#"{"kind": "pick", "pixel": [1, 1], "camera": {"fov_deg": 500}}"#,
                "horizontal_fov_deg",
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
        let request: ActionRequest = serde_json::from_str(
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
        let told = world.act(AgentId(3), &Action::Drop);
        assert_eq!(told.code, OutcomeCode::UnknownAgent);
    }
}
