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
pub const WALK_RATIO: f32 = 0.39;
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
        let motion = if walks {
            (way, turned)
        } else {
            (Vec2::ZERO, 0.0)
        };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::person::{LegJoints, PersonSkeleton, skeleton_of};
    use crate::random::RandomKey;
    use crate::{AgentBody, AgentId, AgentState, House, PersonState, ShoeboxMaterials};

    /// A person who walks along a line, step by step: its joints.
    fn walk(speed_m_s: f32, yaw_rad: f32, steps: usize) -> Vec<PersonSkeleton> {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let body = AgentBody::person(1.7);
        let agent = AgentState::new(body, Vec3::ZERO, yaw_rad);
        let id: AgentId = state.agents.push(agent);
        let person = PersonState::new(body.person.unwrap(), RandomKey::root(1));
        state.persons.insert(id, person);
        let ahead = crate::space::forward_from_yaw(yaw_rad);
        let mut seen = Vec::new();
        for _ in 0..steps {
            let before = [(state.agents[id].position, yaw_rad)];
            state.agents[id].position += ahead * (speed_m_s * 0.05);
            advance_persons(&mut state, &before, 0.05);
            seen.push(skeleton_of(&house, &state, id).unwrap());
        }
        seen
    }

    /// The foot that carries slides by less than 10 mm while the body goes 60 (where heels come down; else by none), and left and right do so in turn, as often as people's at that speed: at 1.2
    /// m/s steps of 0.684 m.
    #[test]
    fn feet_stand_in_turn() {
        let (speed, yaw_rad) = (1.2, 0.7);
        let seen = walk(speed, yaw_rad, 400);
        let steady = &seen[20..];
        let mut last = None;
        let mut turns = 0;
        for pair in steady.windows(2) {
            // Of the toes, or of the heel while the toes come down.
            let slip = [0, 1].map(|leg| {
                let [a, b] = [0, 1].map(|k| pair[k].legs[leg]);
                let heel = |leg: &LegJoints| leg.ankle + leg.foot * Vec3::new(0.0, -0.0663, 0.0);
                let heels = heel(&b).distance(heel(&a));
                b.toe.distance(a.toe).min(heels)
            });
            assert!(slip[0].min(slip[1]) < 0.01, "{slip:?}");
            let stands = usize::from(slip[1] < slip[0]);
            // In double support both stand.
            if slip[0].max(slip[1]) > 0.01 && last.replace(stands) != Some(stands) {
                turns += 1;
            }
        }
        let way_m = speed * 0.05 * steady.len() as f32;
        let expected = way_m / (0.39_f32 * speed).sqrt();
        assert!((turns as f32 - expected).abs() < 2.0, "{turns} {expected}");
    }

    #[test]
    fn legs_and_arms_keep_their_lengths_and_soles_stay_above_the_floor() {
        for (speed, steps) in [(0.3, 90), (1.2, 90), (5.0, 30)] {
            for joints in walk(speed, -0.4, steps) {
                for (leg, arm) in joints.legs.iter().zip(&joints.arms) {
                    // Of Winter's figure 4.1, times 1.7 m.
                    for (a, b, length) in [
                        (leg.hip, leg.knee, 0.4165),
                        (leg.knee, leg.ankle, 0.4182),
                        (arm.shoulder, arm.elbow, 0.3162),
                        (arm.elbow, arm.wrist, 0.2482),
                        (arm.wrist, arm.finger_tip, 0.1836),
                    ] {
                        let found = a.distance(b);
                        assert!((found - length).abs() < 1e-4, "{found} {length}");
                    }
                    assert!(leg.toe.y > -1e-3 && leg.ankle.y > 0.03);
                }
            }
        }
    }

    #[test]
    fn who_stops_stands_upright() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let body = AgentBody::person(1.6);
        let id = state.agents.push(AgentState::new(body, Vec3::ZERO, 0.0));
        let mut person = PersonState::new(body.person.unwrap(), RandomKey::root(1));
        person.gait = PersonGait {
            phase: 0.3,
            stride_m: 1.2,
            direction: Vec2::Y,
        };
        state.persons.insert(id, person);
        for _ in 0..10 {
            advance_persons(&mut state, &[(Vec3::ZERO, 0.0)], 0.05);
        }
        let joints = skeleton_of(&house, &state, id).unwrap();
        let [left, right] = joints.legs;
        assert!((left.toe.z - right.toe.z).abs() < 1e-5);
        assert!((joints.eyes.y - 0.936 * 1.6).abs() < 1e-4);
        assert!(joints.eyes.with_y(0.0).length() < 1e-4);
    }
}
