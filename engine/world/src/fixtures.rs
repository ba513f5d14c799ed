//! Lamps, sources of sound, joints and boxes of a world as they stand, for programs that show them.

use crate::error::WorldError;
use crate::world::World;
use dwell_scene::{JointKind, LightShape, Pose};
use serde::Serialize;

/// The lamps, sounds, joints and boxes of a house, in world space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneOverlay {
    /// Lamps' lights.
    pub lamps: Vec<LampFixture>,
    /// Sources of sound.
    pub sources: Vec<SoundSource>,
    /// Joints.
    pub joints: Vec<JointOverlay>,
    /// Around objects.
    pub boxes: Vec<ObjectBox>,
}

/// A light of a lamp.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LampFixture {
    /// The lamp's name.
    pub name: String,
    /// Position of the light, m; of a line its middle.
    pub position: [f32; 3],
    /// Linear light, each 0 to 1.
    pub color: [f32; 3],
    /// W.
    pub power_w: f32,
    /// True if it is on.
    pub on: bool,
}

/// A place from which sound comes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SoundSource {
    /// The thing's name.
    pub name: String,
    /// m.
    pub position: [f32; 3],
    /// The name of the sound.
    pub signal: String,
    /// dB SPL at 1 m.
    pub level_db: f32,
    /// True if it sounds.
    pub on: bool,
}

/// A joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointOverlay {
    /// Its object's name and its own, with `/` between.
    pub name: String,
    /// Turning (`hinge`) or sliding (`slide`).
    pub kind: &'static str,
    /// Position, m.
    pub position: [f32; 3],
    /// Its axis, unit length.
    pub axis: [f32; 3],
    /// rad or m.
    pub value: f32,
}

/// The box around an object, turned as its first part is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectBox {
    /// The sensors' id.
    pub id: i32,
    /// The object's name.
    pub name: String,
    /// The coarse category.
    pub category: String,
    /// The room that holds its middle.
    pub room: Option<String>,
    /// m.
    pub center: [f32; 3],
    /// Edges, m.
    pub size: [f32; 3],
    /// (x, y, z, w).
    pub rotation: [f32; 4],
}

/// Lamps, sources of sound, joints and boxes as they stand.
///
/// # Errors
/// As [`Engines::cpu_renderer`](crate::Engines::cpu_renderer).
pub fn scene_overlay(world: &World) -> Result<SceneOverlay, WorldError> {
    let (house, state) = (world.house(), world.state());
    let lamps = house.lights.iter().map(|light| {
        let middle = match light.shape {
            LightShape::Line { end } => (light.position + end) * 0.5,
            _ => light.position,
        };
        LampFixture {
            name: house.objects[light.object].name.clone(),
            position: state.part_pose[light.part]
                .transform_point(middle)
                .to_array(),
            color: light.color,
            power_w: light.power_w,
            on: state.is_on(house, light.object),
        }
    });
    let sources = house.emitters.iter().map(|emitter| {
        let pose = state.part_pose[emitter.part];
        SoundSource {
            name: house.objects[emitter.object].name.clone(),
            position: pose.transform_point(emitter.position).to_array(),
            signal: emitter.signal.clone(),
            level_db: emitter.level_db,
            on: state.is_on(house, emitter.object),
        }
    });
    let joints = house.joints.iter_ids().map(|(id, joint)| {
        let parent = joint.parent.map(|parent| state.part_pose[parent]);
        let world_from_joint = parent.unwrap_or(Pose::IDENTITY) * joint.parent_from_joint;
        JointOverlay {
            name: format!("{}/{}", house.objects[joint.object].name, joint.name),
            kind: match joint.kind {
                JointKind::Hinge => "hinge",
                JointKind::Slide => "slide",
            },
            position: world_from_joint.position.to_array(),
            axis: world_from_joint.transform_vector(joint.axis).to_array(),
            value: state.joint_position[id],
        }
    });
    let renderer = world.engines().cpu_renderer()?;
    let boxes = house.objects.iter_ids().filter_map(|(id, object)| {
        let entity = house.entity_of_object(id);
        let found = renderer.oriented_box(state, entity)?;
        let center = found.world_from_box.position;
        Some(ObjectBox {
            id: entity.0,
            name: object.name.clone(),
            category: object.category.coarse.clone(),
            room: house
                .room_at(center)
                .map(|room| house.rooms[room].name.clone()),
            center: center.to_array(),
            size: found.size.to_array(),
            rotation: found.world_from_box.rotation.to_array(),
        })
    });
    Ok(SceneOverlay {
        lamps: lamps.collect(),
        sources: sources.collect(),
        joints: joints.collect(),
        boxes: boxes.collect(),
    })
}
