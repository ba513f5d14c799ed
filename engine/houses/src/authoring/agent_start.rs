//! Start poses of agents.

use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::{AgentBody, AgentStart, Room, State};
use glam::{Vec2, Vec3};

use super::apply::EditSession;
use super::edit_errors::{check_range, checked_point, invalid_field};
use super::edits::SetAgentStart;
use super::surfaces;
use crate::error::HousesError;
use crate::report::FileLocation;

/// Largest distance from a room's floor of a place that counts as in the room, m.
const ROOM_M: f32 = 0.5;

/// Sets the start pose of an agent.
///
/// # Errors
/// [`HousesError::Spec`] for a room that does not exist, holds no place to stand or does not hold `at`, neither place nor room,
/// and an agent behind the next one.
pub(super) fn set(
    session: &mut EditSession<'_>,
    wanted: &SetAgentStart,
) -> Result<(), HousesError> {
    let yaw_rad =
        check_range("yaw_deg", wanted.yaw_deg, [-36_000.0, 36_000.0], "degrees")?.to_radians();
    let room = match &wanted.room {
        Some(name) => Some(surfaces::room(&session.data, "room", name)?),
        None => None,
    };
    let position = match (wanted.at, room) {
        (Some(at), room) => {
            let at = checked_point("at", at)?;
            if let Some(room) = room.map(|id| &session.data.rooms[id])
                && !holds(room, at)
            {
                let possible = format!(
                    "a place over the floor of {:?}, at {} m",
                    room.name, room.floor_y
                );
                return Err(invalid_field(
                    "at",
                    format_args!("{:?}", at.to_array()),
                    possible,
                ));
            }
            at
        }
        (None, Some(room)) => {
            let room = session.data.rooms[room].clone();
            free_place(session, &room)?.ok_or_else(|| {
                let found = format!("{:?}, where nobody can stand", room.name);
                invalid_field("room", found, "a room with free floor, or `at`")
            })?
        }
        (None, None) => return Err(invalid_field("at, room", "neither", "one of them, or both")),
    };
    let starts = &mut session.data.agent_starts;
    let next = starts.len();
    let agent = wanted.agent.map_or(next, |agent| agent as usize);
    let start = AgentStart { position, yaw_rad };
    match starts.get_mut(agent) {
        Some(old) => *old = start,
        None if agent == next && next < AgentStart::MAX_PER_HOUSE => starts.push(start),
        None => {
            let last = next.min(AgentStart::MAX_PER_HOUSE - 1);
            return Err(invalid_field("agent", agent, format!("0 to {last}")));
        }
    }
    Ok(())
}

fn holds(room: &Room, at: Vec3) -> bool {
    (at.y - room.floor_y).abs() <= ROOM_M && room.contains_xz(Vec2::new(at.x, at.z))
}

/// The place nearest to the middle of a room where someone of usual size can stand, as the house is now.
fn free_place(session: &EditSession<'_>, room: &Room) -> Result<Option<Vec3>, HousesError> {
    let house = session.build_house()?;
    let body = AgentBody::default();
    let config = NavConfig {
        radius_m: body.radius_m,
        height_m: body.height_m,
        step_m: body.step_height_m,
        doors: DoorPolicy::AsTheyStand,
        ..NavConfig::default()
    };
    let grid = NavGrid::build(&house, &State::new(&house), &config)
        .map_err(HousesError::scene(&FileLocation::file("edits")))?;
    let middle = middle(room);
    let places = grid.walkable().map(|cell| grid.position(cell));
    Ok(places.filter(|place| holds(room, *place)).min_by(|a, b| {
        a.distance_squared(middle)
            .total_cmp(&b.distance_squared(middle))
    }))
}

/// The middle of a room's floor, m.
fn middle(room: &Room) -> Vec3 {
    let (mut sum, mut whole) = (Vec2::ZERO, 0.0);
    for [a, b, c] in &room.footprint {
        let area = (*b - *a).perp_dot(*c - *a).abs();
        sum += (*a + *b + *c) / 3.0 * area;
        whole += area;
    }
    let middle = if whole > 0.0 { sum / whole } else { Vec2::ZERO };
    Vec3::new(middle.x, room.floor_y, middle.y)
}
