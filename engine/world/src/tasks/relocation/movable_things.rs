//! What a house has that can be moved by hand, and furniture that it can be put on.

use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::{NavigationGoal, SuccessRule, cells_in_reach};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{Aabb, AgentBody, AgentId, Id, Mobility, ObjectId, ReceptacleKind};
use dwell_semantics::instruct::InstructionGoal;
use glam::Vec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Cells from which a thing must be reached: from fewer, a view that turns by steps may miss it everywhere.
pub(super) const LEAST_CELLS: usize = 6;
/// Share of the reach at which a spot is reached from all over a cell.
const REACH_SHARE: f32 = 0.9;
/// Longest edge of what is carried through doors without getting stuck, m.
const LARGEST_M: f32 = 0.5;
/// Least room between a thing and who puts it down, m.
const BESIDE_M: f32 = 0.1;

/// A thing that can be moved.
#[derive(Clone, Debug)]
pub(in crate::tasks) struct MovableThing {
    pub(in crate::tasks) object: ObjectId,
    /// Where a hand reaches it as it stands at the house's start, and the floor of its place, too.
    pub(in crate::tasks) cells: Vec<NavCell>,
}

/// What a house offers at its start.
#[derive(Debug, Default)]
pub(in crate::tasks) struct MovableThings {
    /// Light, small, in reach with the spot on which they stand, and with nothing on them or in them.
    pub(in crate::tasks) things: Vec<MovableThing>,
    /// Furniture that carries things.
    pub(in crate::tasks) supports: Vec<ObjectId>,
}

impl MovableThings {
    /// Looks at the world as it is.
    pub(in crate::tasks) fn of(
        world: &World,
        (agent, body): (AgentId, &AgentBody),
        grid: &NavGrid,
    ) -> Self {
        let (house, state) = (world.house(), world.state());
        let ground = LargestIslandIndex::of(grid);
        let carriers = state.supports_of_all(house);
        let boxes = house.object_boxes(state);
        let mut loaded: BTreeSet<ObjectId> = carriers.iter().flatten().flatten().copied().collect();
        let mut supports = BTreeSet::new();
        let mut light = Vec::new();
        for object in house.objects.ids().filter(|id| house.objects[*id].pickable) {
            let own = &carriers[object.index()];
            let inside = state.containers_of(house, object, &boxes);
            loaded.extend(&inside);
            supports.extend(own.iter().flatten());
            let alone = house.objects[object].mobility == Mobility::Movable
                && house.objects[object].part_count == 1;
            let size_m = boxes[object.index()].size().max_element();
            let mass_kg = world.physics.body_mass_kg(house.objects[object].first_part);
            if alone
                && !own.is_empty()
                && size_m <= body.max_carry_size_m.min(LARGEST_M)
                && mass_kg.is_some_and(|mass_kg| mass_kg <= body.lift_kg)
            {
                light.push(object);
            }
        }
        let of_house = house.receptacles.iter();
        let surfaces = of_house.filter(|space| space.holding == ReceptacleKind::On);
        supports.extend(surfaces.map(|space| space.object));
        supports.retain(|object| !house.objects[*object].pickable);
        let light = light.into_iter().filter(|object| !loaded.contains(object));
        let things = light.filter_map(|object| {
            dwell_scene::interrupt::unwind_if_cancelled();
            let bounds = &boxes[object.index()];
            let foot = bounds.center().with_y(bounds.min.y);
            let mut cells = cells_in_reach(world, agent, &ground, object);
            cells.retain(|cell| {
                let feet = grid.position(*cell);
                let eye = feet + Vec3::Y * body.eye_height_m;
                // Who stands in the place of a thing cannot put it there.
                let beside = feet.clamp(bounds.min, bounds.max).with_y(feet.y);
                eye.distance(foot) <= REACH_SHARE * body.reach_m
                    && beside.distance(feet) >= body.radius_m + BESIDE_M
            });
            (cells.len() >= LEAST_CELLS).then_some(MovableThing { object, cells })
        });
        Self {
            things: things.collect(),
            supports: supports.into_iter().collect(),
        }
    }
}

/// The goal to stand on one of some cells.
pub(super) fn cells_goal(cells: Vec<NavCell>, reach_m: f32) -> Arc<NavigationGoal> {
    Arc::new(NavigationGoal {
        cells,
        success: SuccessRule::Fulfilled(InstructionGoal::objects(Vec::new(), reach_m)),
        told: EpisodeGoal::default(),
        instruction: None,
    })
}

/// The cells of the largest island on which an eye is within `reach_m` of a box.
pub(super) fn cells_near(
    ground: &LargestIslandIndex<'_>,
    bounds: &Aabb,
    (eye_m, reach_m): (f32, f32),
) -> Vec<NavCell> {
    let mut cells = ground.cells_around(&bounds.grown(reach_m));
    cells.retain(|cell| {
        let eye = ground.grid.position(*cell) + Vec3::Y * eye_m;
        eye.clamp(bounds.min, bounds.max).distance(eye) <= reach_m
    });
    cells.sort_unstable();
    cells
}
