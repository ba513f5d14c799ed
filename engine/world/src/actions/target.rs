//! Targets of actions, as people and programs say them: a thing by name, id, pixel or ray.

use crate::error::WorldError;
use crate::world::World;
use dwell_physics::Target;
use dwell_render::{Camera, Projection};
use dwell_scene::{AgentId, EntityId, House, ObjectId, PartId};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Number of names that an error lists, the nearest first.
const NAMES: usize = 12;

/// A thing by its name in the house, or by the sensors' id.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ObjectRef {
    /// The sensors' id, as instance images have it.
    Id(i32),
    /// The name.
    Name(String),
}

/// The camera to which a pixel belongs; it stands at the agent's eye.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PixelCamera {
    /// Pixels across, default 128.
    pub width: u32,
    /// Pixels down, default 128.
    pub height: u32,
    /// Full angle from the left to the right edge, degrees; by default that of the agent's camera.
    pub fov_deg: Option<f32>,
    /// The kind of camera with its numbers, in place of `fov_deg`.
    #[schemars(with = "Option<serde_json::Map<String, serde_json::Value>>")]
    pub projection: Option<Projection>,
    /// Position of the camera relative to the eye: to the right, up, back, m.
    pub position_m: [f32; 3],
    /// Rotation of the camera relative to the eye: yaw, degrees to the left.
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

/// The target of an action: an `object` (and one `part` of it), a `pixel` of a `camera`, or a ray from `origin` along
/// `direction`; without any of them what the agent looks at.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TargetRequest {
    /// The thing.
    pub object: Option<ObjectRef>,
    /// One part of the thing, by name: one drawer of several.
    pub part: Option<String>,
    /// Column and row of a pixel, counted from 0 at the top left; its middle is meant.
    pub pixel: Option<[f32; 2]>,
    /// The pixel's camera.
    pub camera: Option<PixelCamera>,
    /// Origin of a ray, m; default the agent's eye.
    pub origin: Option<[f32; 3]>,
    /// Direction of a ray, in world space.
    pub direction: Option<[f32; 3]>,
}

impl TargetRequest {
    /// Returns the target; `None` where none is stated.
    ///
    /// # Errors
    /// [`WorldError::UnknownOfMany`] for an object or part that no one has; [`WorldError::Config`] for several ways at once or a
    /// direction that 32 bits do not hold; [`WorldError::Render`] for an impossible camera.
    pub(super) fn resolve(
        &self,
        world: &World,
        agent: AgentId,
    ) -> Result<Option<Target>, WorldError> {
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
            let ends = [direction, self.origin.unwrap_or_default()];
            if !ends.as_flattened().iter().all(|number| number.is_finite()) {
                return Err(WorldError::Config {
                    field: "direction",
                    found: match self.origin {
                        Some(origin) => format!("{direction:?} from {origin:?}"),
                        None => format!("{direction:?}"),
                    },
                    allowed: "finite numbers of 32 bits".to_owned(),
                });
            }
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

/// The error for a name that nothing has.
fn unknown_of_many<'a>(
    kind: &'static str,
    name: &str,
    known: impl Iterator<Item = &'a str>,
) -> WorldError {
    let known: Vec<&str> = known.collect();
    let near = dwell_houses::nearest_names(name, known.iter().copied(), NAMES);
    WorldError::UnknownOfMany {
        kind,
        name: name.to_owned(),
        of: known.len(),
        near: near.into_iter().map(str::to_owned).collect(),
    }
}

fn object_named(house: &House, name: &str) -> Result<ObjectId, WorldError> {
    house.object_named(name).ok_or_else(|| {
        let known = house.objects.iter().map(|object| object.name.as_str());
        unknown_of_many("object", name, known)
    })
}

fn part_named(house: &House, object: ObjectId, name: &str) -> Result<PartId, WorldError> {
    let mut parts = house.objects[object].parts();
    parts
        .find(|part| house.parts[*part].name == name)
        .ok_or_else(|| {
            let parts = house.objects[object].parts();
            unknown_of_many(
                "part",
                name,
                parts.map(|part| house.parts[part].name.as_str()),
            )
        })
}
