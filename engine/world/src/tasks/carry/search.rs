//! Ways of a thing with its carriers through a house, and goals that can be reached.

use super::formation::CarryFormation;
use crate::world::World;
use dwell_scene::Pose;
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};
use std::f32::consts::TAU;

/// Steps of the search: m, and turns of a whole one.
const STEP_M: f32 = 0.2;
const TURNS: i32 = 12;
/// Most places that are looked at, and how many between checks for cancellation.
const MOST_PLACES: usize = 6000;
const PLACES_PER_CHECK: usize = 64;
/// What a turn by one step costs, as m of a walk.
const TURN_COST_M: f32 = 0.5;

/// Steps of the middle along the thing's own axes at the start, and of its turn.
type Place = [i32; 3];

/// A place with the length of the way to it, the shortest first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Open {
    cost_m: f32,
    place: Place,
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        let cost = self.cost_m.total_cmp(&other.cost_m);
        cost.then(self.place.cmp(&other.place))
    }
}

/// Yaw of a place, rad.
fn yaw_rad(place: Place) -> f32 {
    TAU * place[2] as f32 / TURNS as f32
}

/// Way of the middle from the start to a place, m.
fn way(formation: &CarryFormation, place: Place) -> Vec3 {
    let own = Vec3::new(place[0] as f32, 0.0, place[1] as f32) * STEP_M;
    (formation.start.rotation * own).with_y(0.0)
}

fn pose(formation: &CarryFormation, place: Place) -> Pose {
    formation.pose(way(formation, place), yaw_rad(place))
}

/// Draws a goal that can be reached, from `distances_m` away on, and the way to it: poses one after another, the last the goal. `None` where
/// there is none near enough to be found.
pub(super) fn sample_path(
    world: &World,
    formation: &CarryFormation,
    distances_m: [f32; 2],
    key: RandomKey,
) -> Option<Vec<Pose>> {
    if !formation.carriers_have_room(world, &formation.start) {
        return None;
    }
    let mut pace = CancelPoller::new(PLACES_PER_CHECK);
    let start: Place = [0; 3];
    let mut room: BTreeMap<Place, bool> = BTreeMap::from([(start, true)]);
    let mut from: BTreeMap<Place, (f32, Place)> = BTreeMap::from([(start, (0.0, start))]);
    let mut open = BinaryHeap::from([Reverse(Open {
        cost_m: 0.0,
        place: start,
    })]);
    let mut goals = Vec::new();
    while let Some(Reverse(next)) = open.pop() {
        if from[&next.place].0 < next.cost_m {
            continue;
        }
        let away_m = way(formation, next.place).length();
        if (distances_m[0]..=distances_m[1]).contains(&away_m) {
            goals.push(next.place);
        }
        for [x, z, turn] in STEPS {
            let [px, pz, pt] = next.place;
            let to = [px + x, pz + z, (pt + turn).rem_euclid(TURNS)];
            if way(formation, to).length() > distances_m[1] + STEP_M {
                continue;
            }
            if !room.contains_key(&to) {
                if room.len() >= MOST_PLACES {
                    continue;
                }
                pace.count_one();
                let has_room = formation.has_room(world, &pose(formation, to));
                room.insert(to, has_room);
            }
            let between = || {
                let half = yaw_rad(next.place) + 0.5 * TAU * turn as f32 / TURNS as f32;
                let at = formation.pose(way(formation, to), half);
                formation.has_room(world, &at)
            };
            if !room[&to] || (turn != 0 && !between()) {
                continue;
            }
            let step_m = if turn == 0 {
                way(formation, [x, z, 0]).length()
            } else {
                TURN_COST_M
            };
            let cost_m = next.cost_m + step_m;
            if from.get(&to).is_none_or(|(known_m, _)| cost_m < *known_m) {
                from.insert(to, (cost_m, next.place));
                open.push(Reverse(Open { cost_m, place: to }));
            }
        }
    }
    if goals.is_empty() {
        return None;
    }
    goals.sort_unstable();
    let goal = goals[key.stream().below(goals.len())];
    let mut way_back = vec![goal];
    while let Some(last) = way_back.last().copied().filter(|last| *last != start) {
        way_back.push(from[&last].1);
    }
    way_back.reverse();
    Some(
        way_back
            .into_iter()
            .map(|place| pose(formation, place))
            .collect(),
    )
}

/// Steps from a place: straight, aslant, and a turn either way.
const STEPS: [[i32; 3]; 10] = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [1, 1, 0],
    [1, -1, 0],
    [-1, 1, 0],
    [-1, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
];
