//! What one has passed on a route.

use crate::form::TurnDirection;
use crate::instruct::StepCondition;
use dwell_scene::{ObjectId, RoomId};
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

/// Radius of the circle around the place of a turn whose crossing shows the turn, m.
pub(super) const TURN_M: f32 = 1.2;

/// A place on a route, or what is done there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RouteMilestone {
    /// Out of a room, into any other.
    Left(RoomId),
    /// Into a room by a door: the room changes within 1.5 m of the door's middle.
    Through {
        /// The door.
        door: ObjectId,
        /// The room behind it.
        to: RoomId,
    },
    /// Into a room from any other.
    Entered(RoomId),
    /// Across the circle of 1.2 m around a place: from where one was nearest to it out of the circle in another direction than one came
    /// there from where one entered it; out of that around the start in another direction than one looked.
    Turned {
        /// The side.
        direction: TurnDirection,
        /// The place, m.
        place: Vec3,
        /// Where one looks at the start, seen from above (x, z), where the place is the start.
        before: Option<Vec2>,
    },
    /// By a thing: into the strip of 1.5 m around its outline and out of it at least 1 m further on, with the thing in sight meanwhile.
    Passed(ObjectId),
    /// At the end: a condition of where the agent stands and looks.
    Reached(StepCondition),
}

/// What counts for a milestone.
#[derive(Clone, Copy, Debug)]
pub(super) struct MilestoneThresholds {
    /// Least and largest change of direction of a turn to a side, rad.
    turn_rad: [f32; 2],
    /// Least change of direction of a turn around, rad.
    around_rad: f32,
    /// Largest distance from the outline of a thing that one passes, m.
    pub(super) past_m: f32,
    /// Least distance between where one comes near to it and where one goes away from it, m.
    pub(super) past_apart_m: f32,
    /// Largest distance from the middle of a door where the room changes, m.
    pub(super) door_m: f32,
}

impl MilestoneThresholds {
    /// What counts of somebody who follows a route.
    pub(super) const FOLLOWED: Self = Self {
        turn_rad: [PI / 6.0, 5.0 * PI / 6.0],
        around_rad: 0.6 * PI,
        past_m: 1.5,
        past_apart_m: 1.0,
        door_m: 1.5,
    };
    /// What counts of the way that a route is told of: stricter, so that those who walk beside that way have followed it, too.
    pub(super) const TOLD: Self = Self {
        turn_rad: [5.0 * PI / 18.0, 13.0 * PI / 18.0],
        around_rad: 7.0 * PI / 9.0,
        past_m: 1.2,
        past_apart_m: 1.2,
        door_m: 1.0,
    };

    /// Returns whether one who goes on along `after` instead of `before` has turned to a side; both seen from above, as (x, z).
    pub(super) fn is_turn(&self, direction: TurnDirection, before: Vec2, after: Vec2) -> bool {
        // X to the right, Z towards the viewer: a positive angle is to the right.
        let right_rad = dwell_scene::math::atan2(before.perp_dot(after), before.dot(after));
        let [least, most] = self.turn_rad;
        match direction {
            TurnDirection::Right => (least..=most).contains(&right_rad),
            TurnDirection::Left => (least..=most).contains(&-right_rad),
            TurnDirection::Around => right_rad.abs() >= self.around_rad,
        }
    }
}
