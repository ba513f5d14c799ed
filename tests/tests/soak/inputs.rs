//! Random inputs: commands to agents and joints, and parameters of the world, mostly sensible.

use dwell::World;
use dwell_physics::{AgentControl, BodyState, Grasp, HandAction, Target, actions};
use dwell_scene::random::RandomStream;
use dwell_scene::{
    Address, AgentBody, EntityId, JointCommand, JointId, Locomotion, ObjectId, Parameter, PartId,
    Velocity,
};
use glam::Vec3;

/// Mostly forward, now and then anywhere; on legs sometimes faster than any leg, and sometimes low.
pub(crate) fn control(stream: &mut RandomStream, body: &AgentBody) -> AgentControl {
    let drive = matches!(body.locomotion, Locomotion::DifferentialDrive(_));
    let pitch_rate_rad_s = stream.range(-1.0, 1.0);
    if drive && stream.below(2) == 0 {
        return AgentControl {
            wheel_rad_s: Some([stream.range(-10.0, 25.0), stream.range(-10.0, 25.0)]),
            pitch_rate_rad_s,
            ..AgentControl::default()
        };
    }
    let right_m_s = stream.range(-1.0, 1.0);
    AgentControl {
        forward_m_s: stream.range(-1.0, 3.0),
        right_m_s: if drive { 0.0 } else { right_m_s },
        yaw_rate_rad_s: stream.range(-3.0, 3.0),
        pitch_rate_rad_s,
        crouch: !drive && stream.below(6) == 0,
        wheel_rad_s: None,
    }
}

/// Something to act on: mostly an object, now and then one that does not exist, or a ray that leads anywhere or nowhere.
fn target(stream: &mut RandomStream, objects: usize) -> Target {
    match stream.below(8) {
        0 => Target::Gaze,
        1 => Target::Ray {
            origin: stream.direction() * stream.range(0.0, 20.0),
            direction: stream.direction(),
        },
        2 => Target::Ray {
            origin: Vec3::NAN,
            direction: Vec3::ZERO,
        },
        3 => Target::Entity(EntityId(stream.below(2 * objects) as i32 - 5)),
        _ => Target::Object(ObjectId(stream.below(objects + 2) as u32)),
    }
}

/// Any action, with and without sense.
pub(crate) fn action(stream: &mut RandomStream, objects: usize) -> Box<dyn HandAction> {
    let target = target(stream, objects);
    let number = *stream
        .choose(&[0.0, 0.5, 3.0, -1.0, 1e30, f32::NAN])
        .unwrap_or(&0.0);
    match stream.below(17) {
        0..=4 => Box::new(actions::Pick {
            target,
            grasp: Grasp::default(),
        }),
        5 => Box::new(actions::Drop {}),
        6 => Box::new(actions::Place { target: None }),
        7 => Box::new(actions::Place {
            target: Some(target),
        }),
        8 => Box::new(actions::PlaceAt {
            point: stream.direction() * number,
        }),
        9 => Box::new(actions::PutIn { target }),
        10 => Box::new(actions::Throw {
            direction: Some(stream.direction()),
            speed_m_s: number,
        }),
        11 => Box::new(actions::Push {
            target,
            force_n: Some(number),
        }),
        12 => Box::new(actions::Pull {
            target,
            force_n: None,
        }),
        13 => Box::new(actions::Open {
            target,
            fraction: number,
        }),
        14 => Box::new(actions::Close { target }),
        15 => Box::new(actions::Point { target }),
        _ => Box::new(actions::Toggle { target }),
    }
}

/// Any joint and any command: doors know positions only, some numbers are none, and one joint does not exist.
pub(crate) fn command(stream: &mut RandomStream, joints: usize) -> (JointId, JointCommand) {
    let joint = JointId(stream.below(joints + 1) as u32);
    let number = stream.range(-2.0, 2.0);
    let command = match stream.below(6) {
        0 | 1 => JointCommand::Position(number),
        2 => JointCommand::Velocity(number),
        3 => JointCommand::Effort(5.0 * number),
        4 => JointCommand::Position(f32::NAN),
        _ => JointCommand::Off,
    };
    (joint, command)
}

/// Any parameter of the house and of laws: as it was, somewhat off, or no number that can be. A law that is not installed
/// comes in with a fiftieth of what it may have at most.
pub(crate) fn setting(stream: &mut RandomStream, known: &[(Address, Parameter)]) -> (Address, f64) {
    let (address, was) = &known[stream.below(known.len())];
    let share = f64::from(stream.range(0.0, 1.0));
    let value = match stream.below(8) {
        0..=2 => was.value,
        3 => f64::NAN,
        4 => was.high + 1.0,
        _ if was.value == 0.0 => (0.02 * share * was.high).clamp(was.low, was.high),
        _ => (was.value * (0.7 + 0.7 * share)).clamp(was.low, was.high),
    };
    (address.clone(), value)
}

/// A part as it is, but thrown; most parts cannot be.
pub(crate) fn thrown(stream: &mut RandomStream, world: &World) -> BodyState {
    let part = PartId(stream.below(world.state().part_pose.len()) as u32);
    BodyState {
        part,
        pose: world.state().part_pose[part],
        velocity: Velocity {
            linear: stream.direction() * stream.range(0.0, 4.0),
            angular: stream.direction() * stream.range(0.0, 10.0),
        },
    }
}

/// A joint with a place and a speed, now and then beyond its limits.
pub(crate) fn joint(stream: &mut RandomStream, world: &World) -> (JointId, f32, f32) {
    let joint = JointId(stream.below(world.house().joints.len()) as u32);
    let limits = world.house().joints[joint].limits;
    let [low, high] = limits.unwrap_or([-3.0, 3.0]);
    let beyond = 0.05 * (high - low);
    (
        joint,
        stream.range(low - beyond, high + beyond),
        stream.range(-1.0, 1.0),
    )
}
