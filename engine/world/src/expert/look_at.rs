//! Turns and tilts of a view that moves by steps, until its middle is on a thing.

use crate::actions::{DiscreteAction, StepSizes};
use crate::world::World;
use dwell_scene::bvh::Ray;
use dwell_scene::math::wrap_angle;
use dwell_scene::space::{pitch_from_forward, rotation_from_yaw_pitch, yaw_from_forward};
use dwell_scene::{AgentId, AgentState, ObjectId};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// Steps of the view beyond the corners of a thing's box that are tried.
const BEYOND: i32 = 1;
/// The most steps to either side that are tried.
const MOST: i32 = 20;
/// Vertical part of the normal of a level surface.
const LEVEL: f32 = 0.9;
/// Angle from the middle of the view within which a place to put something down is free, where there is such a place, rad.
const BESIDE_RAD: f32 = 0.1;
/// From points where something was put down in vain the next are further away, m.
const AWAY_M: f32 = 0.12;
/// Largest difference of a surface's height from that of a point on it, m.
const SAME_HEIGHT_M: f32 = 0.05;
/// Steepest view, rad; as far as necks of `dwell_physics` go.
const STEEPEST_RAD: f32 = 1.5;

/// What brings the middle of the view onto a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LookAction {
    /// Nothing: it is there.
    Done,
    /// A turn or tilt.
    Turn(DiscreteAction),
    /// No number of steps from here does: the thing is too small between two of them, or hidden.
    Missed,
}

impl LookAction {
    /// The first of so many turns to the left and tilts upwards.
    fn of_steps(steps: (i32, i32)) -> Self {
        match steps {
            (0, 0) => Self::Done,
            (across, _) if across > 0 => Self::Turn(DiscreteAction::TurnLeft),
            (across, _) if across < 0 => Self::Turn(DiscreteAction::TurnRight),
            (_, up) if up > 0 => Self::Turn(DiscreteAction::LookUp),
            _ => Self::Turn(DiscreteAction::LookDown),
        }
    }
}

/// What of a thing is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LookTarget {
    /// Anything.
    Anywhere,
    /// A level surface, on which things can be put.
    LevelSurface,
}

/// The next turn or tilt that brings the middle of an agent's view onto the level surface at the height of a point, as near to
/// it as steps of the view go, at most `around_m` from it. What is in the hand is looked past.
pub(crate) fn look_at_surface(
    world: &World,
    agent: AgentId,
    (point, around_m): (Vec3, f32),
    stride: &StepSizes,
) -> LookAction {
    let Some(agent) = world.state().agents.get(agent) else {
        return LookAction::Missed;
    };
    let eye = agent.eye_position();
    let (turn, look) = (stride.turn_deg.to_radians(), stride.look_deg.to_radians());
    let to_point = point - eye;
    // No less than the angle that the surface around the point takes, as asin x is no more than x π / 2.
    let wide = FRAC_PI_2 * (around_m / to_point.length().max(0.1)).min(1.0);
    let span = |angle: f32, step: f32| {
        ((angle - wide) / step).floor() as i32..=((angle + wide) / step).ceil() as i32
    };
    let across = span(wrap_angle(yaw_from_forward(to_point) - agent.yaw_rad), turn);
    let up = span(pitch_from_forward(to_point) - agent.pitch_rad, look);
    let distance_m = |yaw_rad: f32, pitch_rad: f32| {
        let forward = rotation_from_yaw_pitch(yaw_rad, pitch_rad) * Vec3::NEG_Z;
        let ray = Ray::new(eye, forward);
        let hit = world.closest_past_hand(agent, &ray)?;
        let at = ray.point_at(hit.distance_m);
        let is_level = world.rays().surface(&hit).normal.y.abs() > LEVEL;
        let is_there = (at.y - point.y).abs() <= SAME_HEIGHT_M && at.distance(point) <= around_m;
        (is_level && is_there).then(|| at.distance(point))
    };
    let mut best: Option<((bool, f32), (i32, i32))> = None;
    for steps in across.flat_map(|across| up.clone().map(move |up| (across, up))) {
        let yaw_rad = agent.yaw_rad + steps.0 as f32 * turn;
        let pitch_rad = agent.pitch_rad + steps.1 as f32 * look;
        if pitch_rad.abs() > STEEPEST_RAD {
            continue;
        }
        let Some(away_m) = distance_m(yaw_rad, pitch_rad) else {
            continue;
        };
        let beside = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
        let is_at_rim = beside.into_iter().any(|(x, y)| {
            distance_m(yaw_rad + x * BESIDE_RAD, pitch_rad + y * BESIDE_RAD).is_none()
        });
        let rank = (is_at_rim, away_m);
        if best.is_none_or(|(other, _)| rank < other) {
            best = Some((rank, steps));
        }
    }
    best.map_or(LookAction::Missed, |(_, steps)| LookAction::of_steps(steps))
}

/// What the middle of an agent's view is on, looked past what is in its hand.
pub(crate) fn point_in_view_centre(world: &World, agent: AgentId) -> Option<Vec3> {
    let agent = world.state().agents.get(agent)?;
    let eye = agent.world_from_eye();
    let ray = Ray::new(eye.position, eye.transform_vector(Vec3::NEG_Z));
    let hit = world.closest_past_hand(agent, &ray)?;
    Some(ray.point_at(hit.distance_m))
}

/// The next turn or tilt of the shortest way by steps that brings the middle of an agent's view onto a thing, as the agent stands
/// or would stand; away from the points that were tried in vain where there is such a place.
pub(crate) fn look_at(
    world: &World,
    agent: &AgentState,
    (object, part): (ObjectId, LookTarget),
    tried: &[Vec3],
    stride: &StepSizes,
) -> LookAction {
    let eye = agent.eye_position();
    let entity = world.house().entity_of_object(object);
    let (turn, look) = (stride.turn_deg.to_radians(), stride.look_deg.to_radians());
    let bounds = world.house().object_bounds(world.state(), object);
    let middle = bounds.center() - eye;
    let corners = bounds.corners();
    let yaw = yaw_from_forward(middle);
    // Steps of the view from where it is to the corners' directions.
    let turns = corners.map(|corner| {
        let beside = wrap_angle(yaw_from_forward(corner - eye) - yaw);
        (wrap_angle(yaw - agent.yaw_rad) + beside) / turn
    });
    let tilts = corners.map(|corner| (pitch_from_forward(corner - eye) - agent.pitch_rad) / look);
    let span = |steps: [f32; 8]| {
        let low = steps.into_iter().fold(f32::INFINITY, f32::min).floor() as i32;
        let high = steps.into_iter().fold(f32::NEG_INFINITY, f32::max).ceil() as i32;
        (low - BEYOND).max(-MOST)..=(high + BEYOND).min(MOST)
    };
    let hits = |yaw_rad: f32, pitch_rad: f32, away_m: f32| {
        if pitch_rad.abs() > STEEPEST_RAD {
            return false;
        }
        let ray = Ray::new(
            eye,
            rotation_from_yaw_pitch(yaw_rad, pitch_rad) * Vec3::NEG_Z,
        );
        let hit = world.closest_past_hand(agent, &ray);
        hit.is_some_and(|hit| {
            let surface = world.rays().surface(&hit);
            let fits = part == LookTarget::Anywhere || surface.normal.y.abs() > LEVEL;
            let at = ray.point_at(hit.distance_m);
            let is_new = tried.iter().all(|point| point.distance(at) >= away_m);
            surface.entity == entity && fits && is_new
        })
    };
    let meets = |(across, up): (i32, i32), (beside_rad, away_m): (f32, f32)| {
        let yaw_rad = agent.yaw_rad + across as f32 * turn;
        let pitch_rad = agent.pitch_rad + up as f32 * look;
        let around = [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
        let mut around = around
            .into_iter()
            .map(|(x, y)| (x * beside_rad, y * beside_rad));
        around.all(|(x, y)| hits(yaw_rad + x, pitch_rad + y, away_m))
    };
    let tilts = span(tilts);
    let steps = span(turns).flat_map(|across| tilts.clone().map(move |up| (across, up)));
    let mut steps: Vec<(i32, i32)> = steps.collect();
    steps.sort_by_key(|(across, up)| (across.abs() + up.abs(), *across, *up));
    let find = |beside_rad: f32, away_m: f32| {
        let mut steps = steps.iter().copied();
        steps.find(|own| meets(*own, (beside_rad, away_m)))
    };
    // Where something is put down, a place with room around it comes first.
    let found = match part {
        LookTarget::Anywhere => find(0.0, 0.0),
        LookTarget::LevelSurface => find(BESIDE_RAD, AWAY_M)
            .or_else(|| find(0.0, AWAY_M))
            .or_else(|| find(0.0, 0.0)),
    };
    found.map_or(LookAction::Missed, LookAction::of_steps)
}
