//! Start positions of agents.

use super::movement::agent_queries;
use super::{Agents, current_body};
use crate::dynamics::Dynamics;
use crate::error::PhysicsError;
use crate::report::MovedAgent;
use dwell_scene::{AgentBody, AgentId, House, Id, State};
use glam::{Vec2, Vec3};

/// Spacing of the positions that are tried, m, and their largest number: in large houses they are further apart.
const SPACING_M: f32 = 0.1;
const MOST_PLACES: f32 = 20_000.0;

/// Gap between the bodies of agents that start beside each other, m.
const GAP_M: f32 = 0.1;

/// Start positions for one body, nearest first; agents with the same body continue where the previous one was placed.
struct SpawnSearch {
    body: AgentBody,
    from: Vec3,
    places: Vec<Vec3>,
    next: usize,
}

impl Agents {
    /// Moves each agent that would overlap something immovable, or an agent before it, to the nearest free position on a
    /// room's floor; where only agents are in the way and no position is left, they share one. A house without rooms does
    /// not define its floors: there agents stay.
    ///
    /// # Errors
    /// [`PhysicsError::Range`] for a body that fits into no room.
    pub(crate) fn resolve_spawn_overlaps(
        &self,
        dynamics: &mut Dynamics,
        state: &mut State,
    ) -> Result<Vec<MovedAgent>, PhysicsError> {
        let house = dynamics.model.house.clone();
        let mut moved = Vec::new();
        let mut search: Option<SpawnSearch> = None;
        for index in 0..state.agents.len() {
            let id = AgentId::from_index(index);
            let (body, from) = (current_body(&state.agents[id]), state.agents[id].position);
            let taken = |place: Vec3| {
                let others = state.agents.iter().take(index);
                others.into_iter().any(|other| {
                    let near_m = other.body.radius_m + body.radius_m + GAP_M;
                    let beside = (other.position - place).with_y(0.0).length() < near_m;
                    let height_m = other.body.height_m.max(body.height_m);
                    beside && (other.position.y - place.y).abs() < height_m
                })
            };
            let place = find_spawn_point(dynamics, &house, (id, body, from), taken, &mut search)?;
            if place == from {
                continue;
            }
            state.agents[id].position = place;
            if let Some(rigid) = dynamics.engine.bodies.get_mut(self.list[index].handle) {
                rigid.set_translation(place, false);
            }
            moved.push(MovedAgent {
                agent: id,
                distance_m: place.distance(from),
            });
        }
        Ok(moved)
    }
}

fn find_spawn_point(
    dynamics: &Dynamics,
    house: &House,
    (id, body, from): (AgentId, AgentBody, Vec3),
    taken: impl Fn(Vec3) -> bool,
    search: &mut Option<SpawnSearch>,
) -> Result<Vec3, PhysicsError> {
    let probe = agent_queries(dynamics, body, id, &[]);
    let cramped = |place: Vec3| probe.is_cylinder_blocked(place);
    if house.rooms.is_empty() || (!taken(from) && !cramped(from)) {
        return Ok(from);
    }
    let again = search
        .take()
        .filter(|last| (last.body, last.from) == (body, from));
    let search = search.insert(again.unwrap_or_else(|| {
        let mut places = floor_places(house);
        let order = |place: &Vec3| place.distance_squared(from);
        places.sort_by(|a, b| order(a).total_cmp(&order(b)));
        SpawnSearch {
            body,
            from,
            places,
            next: 0,
        }
    }));
    let fits = |place: Vec3| !cramped(place) && probe.has_surface_below(place);
    let left = search.places.iter().skip(search.next).copied();
    let found = left
        .enumerate()
        .find(|(_, place)| !taken(*place) && fits(*place));
    if let Some((k, place)) = found {
        search.next += k;
        return Ok(place);
    }
    search.next = search.places.len();
    if !cramped(from) {
        return Ok(from);
    }
    let mut all = search.places.iter().copied();
    all.find(|place| fits(*place))
        .ok_or_else(|| PhysicsError::Range {
            at: format!("agent {}", id.index()),
            field: "body",
            found: format!(
                "radius {} m, height {} m, steps of {} m: no room of the house has place for it",
                body.radius_m, body.height_m, body.step_height_m
            ),
            allowed: "a body that stands in no wall, ceiling or furniture somewhere in the house",
        })
}

/// Returns positions all over the rooms' floors, m: room by room, triangle by triangle, in rows.
fn floor_places(house: &House) -> Vec<Vec3> {
    let triangles = || house.rooms.iter().flat_map(|room| &room.footprint);
    let area_m2: f32 = triangles()
        .map(|[a, b, c]| 0.5 * (*b - *a).perp_dot(*c - *a).abs())
        .sum();
    let spacing = (area_m2 / MOST_PLACES).sqrt().max(SPACING_M);
    let mut places = Vec::new();
    for room in &house.rooms {
        for corners in &room.footprint {
            let [a, b, c] = *corners;
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            if !(low.is_finite() && high.is_finite()) {
                continue;
            }
            let [first, last] = [low, high].map(|corner| (corner / spacing).floor());
            let (columns, rows) = ((last.x - first.x) as u32, (last.y - first.y) as u32);
            for row in 0..=rows {
                for column in 0..=columns {
                    let at = (first + Vec2::new(column as f32, row as f32)) * spacing;
                    if is_within(at, corners) {
                        places.push(Vec3::new(at.x, room.floor_y, at.y));
                    }
                }
            }
            // A triangle between the rows has a position, too.
            let middle = (a + b + c) / 3.0;
            places.push(Vec3::new(middle.x, room.floor_y, middle.y));
        }
    }
    places
}

fn is_within(at: Vec2, [a, b, c]: &[Vec2; 3]) -> bool {
    let side = |a: &Vec2, b: &Vec2| (*b - *a).perp_dot(at - *a);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}
