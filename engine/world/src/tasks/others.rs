//! What tasks of several agents share: walks from place to place, and who sees whom.

use super::standing_room::sample_start;
use super::{TaskSetup, door_leaves, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::error::WorldError;
use crate::expert::ShortestPathFollower;
use crate::world::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, LevelId};
use glam::Vec3;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Nearest next place of a tour, m.
const NEXT_PLACE_M: f32 = 3.0;

/// A walk from place to place, each drawn from a key.
#[derive(Clone, Debug, Default)]
pub(super) struct Patrol {
    way: Option<ShortestPathFollower>,
    memory: PatrolState,
}

/// Where a tour has come to. A guide to its place is made anew from it, and only forgets a manoeuvre that it was about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PatrolState {
    /// Number of places so far.
    places: u64,
    /// The present one, m.
    goal: Option<[f32; 3]>,
    /// The storey that it keeps to.
    storey: Option<LevelId>,
}

impl Patrol {
    /// A walk that keeps to a storey, or with `None` goes anywhere.
    pub(super) fn on_storey(storey: Option<LevelId>) -> Self {
        Self {
            way: None,
            memory: PatrolState {
                storey,
                ..PatrolState::default()
            },
        }
    }

    /// Returns the next step; `wait` where the next place has just been chosen.
    pub(super) fn next_action(
        &mut self,
        world: &World,
        (setup, grid): (&TaskSetup, &Arc<NavGrid>),
        key: RandomKey,
    ) -> DiscreteAction {
        let step = self.way.as_mut().and_then(|way| way.next_action(world));
        if let Some(step) = step {
            return step;
        }
        let here = position(world, setup.agent);
        let place = key.child("tour").child(self.memory.places);
        let storey = self.memory.storey;
        let goal = grid.sample(place, |cell| {
            grid.island(cell) == Some(0)
                && (storey.is_none() || grid.level(cell) == storey)
                && grid.position(cell).distance(here) >= NEXT_PLACE_M
        });
        self.memory = PatrolState {
            places: self.memory.places + 1,
            goal: goal.map(|cell| grid.position(cell).to_array()),
            storey,
        };
        self.way = goal.map(|cell| follower_to(setup, grid, &[cell]));
        DiscreteAction::Wait
    }

    /// What is kept of it in snapshots.
    pub(super) fn memory(&self) -> PatrolState {
        self.memory
    }

    /// The tour that has come to where `memory` says.
    pub(super) fn restored(memory: PatrolState, setup: &TaskSetup, grid: &Arc<NavGrid>) -> Self {
        let cell = memory.goal.and_then(|goal| grid.nearest(goal.into(), 0.5));
        Self {
            way: cell.map(|cell| follower_to(setup, grid, &[cell])),
            memory,
        }
    }
}

/// Returns what a task keeps of an episode and of a tour, as bytes for snapshots.
pub(super) fn episode_bytes<M: Serialize>(memory: &M, tour: &Patrol) -> Vec<u8> {
    postcard::to_stdvec(&(memory, tour.memory)).expect("plain data can always be written to memory")
}

/// Returns what [`episode_bytes`] kept, of the agent of a task.
///
/// # Errors
/// [`WorldError::Snapshot`] for bytes that are none.
pub(super) fn restored_episode<M: DeserializeOwned>(
    world: &World,
    (setup, task): (&TaskSetup, &str),
    bytes: &[u8],
) -> Result<(M, Patrol), WorldError> {
    let (memory, tour) = postcard::from_bytes(bytes)
        .map_err(|_| WorldError::Snapshot(format!("what {task} keeps of its episode is none")))?;
    let grid = world.engines().nav_grid(&setup.body(world, task)?)?;
    Ok((memory, Patrol::restored(tour, setup, &grid)))
}

/// Opens all doors, and places an agent anywhere on the largest piece of floor, or on one storey of it, looking anywhere. Returns where, m, and its heading, rad.
///
/// # Errors
/// [`WorldError::TaskNotPlayable`] where there is no room for it.
pub(super) fn place_anywhere(
    world: &mut World,
    placed: &[AgentId],
    (setup, task): (&TaskSetup, &'static str),
    (storey, key): (Option<LevelId>, RandomKey),
) -> Result<(Vec3, f32), WorldError> {
    let body = setup.body(world, task)?;
    let grid = world.engines().nav_grid(&body)?;
    door_leaves::open_all(world, &grid)?;
    let start = sample_start(world, placed, (&grid, &body, storey), key.child("start"));
    let Some(cell) = start else {
        return Err(WorldError::TaskNotPlayable {
            task,
            house: world.house().name.clone(),
            why: "nobody of the agent's size can stand anywhere".to_owned(),
        });
    };
    let (feet, yaw_rad) = (grid.position(cell), random_yaw_rad(key));
    world.place_agent(setup.agent, feet, yaw_rad)?;
    Ok((feet, yaw_rad))
}

/// Returns where an agent stands, m.
pub(super) fn position(world: &World, agent: AgentId) -> Vec3 {
    let state = world.state().agents.get(agent);
    state.map_or(Vec3::ZERO, |agent| agent.position)
}

/// Returns a guide to the nearest of some cells.
pub(super) fn follower_to(
    setup: &TaskSetup,
    grid: &Arc<NavGrid>,
    cells: &[NavCell],
) -> ShortestPathFollower {
    ShortestPathFollower::new(setup.agent, grid.clone(), cells, setup.stride)
}

/// Returns whether an agent sees the head or the middle of another one: within `half_view_rad` of where it looks, `most_m` away, and with
/// nothing of the house in between.
pub(super) fn sees(
    world: &World,
    (viewer, other): (AgentId, AgentId),
    half_view_rad: f32,
    most_m: f32,
) -> bool {
    let agents = &world.state().agents;
    let (Some(viewer), Some(other)) = (agents.get(viewer), agents.get(other)) else {
        return false;
    };
    let eye = viewer.world_from_eye();
    let ahead = eye.transform_vector(Vec3::NEG_Z);
    let middle = other.position + Vec3::Y * (0.5 * other.height_m());
    [other.eye_position(), middle].into_iter().any(|point| {
        let way = point - eye.position;
        let distance_m = way.length();
        if distance_m > most_m || distance_m < 1e-3 {
            return false;
        }
        let cosine = way.dot(ahead) / distance_m;
        if cosine < dwell_scene::math::cos(half_view_rad) {
            return false;
        }
        let ray = Ray::new(eye.position, way).with_range(0.0, distance_m - other.body.radius_m);
        world.rays().closest(&ray, RayMask::EYE).is_none()
    })
}
