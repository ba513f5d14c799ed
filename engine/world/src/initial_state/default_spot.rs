//! Where agents stand that nobody has put anywhere yet.

use dwell_scene::{AgentBody, House, Room, State};
use glam::{Vec2, Vec3};

/// Room around a body, m.
const MARGIN_M: f32 = 0.05;
/// What is no higher is stood on, m: rugs.
const FLAT_M: f32 = 0.03;
/// Rows of points that are tried in each triangle of a floor.
const ROWS: usize = 8;

/// The first place on a floor where none of the bodies stands in furniture, by the boxes around it: the middle of the first room's
/// first triangle of floor, then points of all floors. Where there is none, that middle; without rooms, the origin.
pub(super) fn default_spot(house: &House, state: &State, bodies: &[AgentBody]) -> Vec3 {
    let largest = |of: fn(&AgentBody) -> f32| bodies.iter().map(of).fold(0.0, f32::max);
    let (radius_m, height_m) = (largest(|body| body.radius_m), largest(|body| body.height_m));
    let objects = house.objects.ids();
    let boxes: Vec<_> = objects
        .map(|object| house.object_bounds(state, object))
        .collect();
    let is_free = |spot: &Vec3| {
        let reach_m = radius_m + MARGIN_M;
        boxes.iter().all(|bounds| {
            let beside = spot.clamp(bounds.min, bounds.max).with_y(spot.y);
            let is_level = bounds.max.y > spot.y + FLAT_M && bounds.min.y < spot.y + height_m;
            !is_level || beside.distance(*spot) > reach_m
        })
    };
    let middles = house.rooms.iter().take(1).filter_map(middle);
    let others = house.rooms.iter().flat_map(points);
    let mut spots = middles.chain(others);
    let first = house.rooms.iter().find_map(middle);
    spots.find(is_free).or(first).unwrap_or_default()
}

/// The middle of a room's first triangle of floor.
fn middle(room: &Room) -> Option<Vec3> {
    let [a, b, c] = *room.footprint.first()?;
    Some(on_floor(room, (a + b + c) / 3.0))
}

/// Points of a room's floor, well within its triangles.
fn points(room: &Room) -> impl Iterator<Item = Vec3> + '_ {
    room.footprint.iter().flat_map(move |[a, b, c]| {
        (1..ROWS).flat_map(move |row| {
            (1..ROWS - row).map(move |column| {
                let (x, y) = (row as f32 / ROWS as f32, column as f32 / ROWS as f32);
                on_floor(room, *a * (1.0 - x - y) + *b * x + *c * y)
            })
        })
    })
}

fn on_floor(room: &Room, point: Vec2) -> Vec3 {
    Vec3::new(point.x, room.floor_y, point.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chair stood where nobody looked, and was thrown through the room with its table.
    #[test]
    fn nobody_stands_in_furniture_before_an_episode_begins() {
        let bodies = [AgentBody::default()];
        for name in [
            "seed:478?split=val",
            "builtin:apartment",
            "builtin:studio",
            "seed:3",
        ] {
            let house = dwell_houses::open(name).unwrap().0;
            let state = State::new(&house);
            let spot = default_spot(&house, &state, &bodies);
            for object in house.objects.ids() {
                let bounds = house.object_bounds(&state, object);
                let beside = spot.clamp(bounds.min, bounds.max);
                let is_over = bounds.min.y > spot.y + bodies[0].height_m;
                let is_flat = bounds.max.y < spot.y + FLAT_M;
                let away_m = beside.with_y(spot.y).distance(spot);
                let object = &house.objects[object].name;
                assert!(
                    is_over || is_flat || away_m > bodies[0].radius_m,
                    "{name}: {object} {away_m} m away"
                );
            }
        }
    }
}
