//! How persons' strides go on with the way that they walk.

use super::proportions::HIP_HEIGHT;
use crate::ids::Id;
use crate::math::wrap_angle;
use crate::state::{Locomotion, PersonGait, State};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Length of a step over the steps a second, m s, of a body 1.7 m high.
///
/// # Source
/// The walk ratio is the same at all speeds, 0.0065 m a step a minute: N. Sekiya, H. Nagasaki, H. Ito, T. Furuna, J. Orthop.
/// Sports Phys. Ther. 24, 1996.
const WALK_RATIO: f32 = 0.39;
/// The longest stride of a figure, as a part of its height.
const LONGEST_STRIDE: f32 = 0.82;
/// The stride of one who turns on the spot, as a part of the height.
const TURNING_STRIDE: f32 = 0.1;
/// A turn on the spot that takes a stride, rad.
const TURN_RAD: f32 = 0.5 * PI;
/// Speed below which nobody walks, m/s.
const SLOWEST_M_S: f32 = 0.02;
/// How fast strides get longer and shorter, as a part of the height, 1/s.
const STRIDE_RATE: f32 = 3.0;

/// Advances the strides of all persons by a control step, and takes hands back from what they reached. `before`: positions and
/// headings of all agents before the step.
pub fn advance_persons(state: &mut State, before: &[(Vec3, f32)], step_s: f32) {
    let State {
        persons, agents, ..
    } = state;
    for (id, person) in persons.iter_mut() {
        if let Some(reach) = &mut person.reach {
            reach.left_s -= step_s;
            if reach.left_s <= 0.0 {
                person.reach = None;
            }
        }
        let (Some(agent), Some((was, yaw_rad))) = (agents.get(*id), before.get(id.index())) else {
            continue;
        };
        let height_m = agent.body.height_m;
        let walks = agent.grounded && matches!(agent.body.locomotion, Locomotion::Walking(_));
        let way = agent.position - *was;
        let turned = wrap_angle(agent.yaw_rad - yaw_rad).abs();
        // In its own frame: to the right and ahead.
        let (sine, cosine) = crate::math::sin_cos(agent.yaw_rad);
        let way = Vec2::new(
            way.x * cosine - way.z * sine,
            -way.x * sine - way.z * cosine,
        );
        let crouch = 1.0 - agent.crouched_by_m / (HIP_HEIGHT * height_m);
        let motion = if walks { (way, turned) } else { (Vec2::ZERO, 0.0) };
        advance(&mut person.gait, motion, step_s, height_m * crouch.max(0.2));
    }
}

fn advance(gait: &mut PersonGait, (way, turned): (Vec2, f32), step_s: f32, height_m: f32) {
    let length = way.length();
    let speed = length / step_s;
    let walks = speed > SLOWEST_M_S;
    let wanted = if walks {
        let step = (WALK_RATIO * speed).sqrt() * height_m / 1.7;
        (2.0 * step).min(LONGEST_STRIDE * height_m)
    } else if turned > 1e-4 {
        TURNING_STRIDE * height_m
    } else {
        0.0
    };
    let most = STRIDE_RATE * height_m * step_s;
    gait.stride_m += (wanted - gait.stride_m).clamp(-most, most);
    if walks {
        gait.direction = way / length;
    } else if gait.direction == Vec2::ZERO {
        gait.direction = Vec2::Y;
    }
    let strides = if walks {
        length / gait.stride_m.max(1e-3)
    } else {
        turned / TURN_RAD
    };
    // Who stands begins with the swing of the right foot.
    if gait.stride_m == 0.0 {
        gait.phase = 0.0;
    }
    let phase = gait.phase + strides.min(0.5);
    gait.phase = phase - phase.floor();
}
