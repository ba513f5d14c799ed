//! Goals of navigation: where they are reached, and how that is judged.

use super::stated::StatedPoint;
use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::world::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentId, ObjectId};
use dwell_semantics::instruct::{Instruction, InstructionGoal};
use glam::{Vec2, Vec3};

/// Cells between checks for cancellation.
const CELLS_PER_CHECK: usize = 256;

/// When a goal is reached.
#[derive(Clone, Debug)]
pub(in crate::tasks) enum SuccessRule {
    /// Nearer than this to the goal, geodesic m.
    Within(f64),
    /// In one of some rooms, or near one of some things and looking at it.
    Fulfilled(InstructionGoal),
}

/// A goal that an episode can have.
#[derive(Clone, Debug)]
pub(in crate::tasks) struct NavigationGoal {
    /// Where it is reached by an agent that looks the right way; rising.
    pub(in crate::tasks) cells: Vec<NavCell>,
    pub(in crate::tasks) success: SuccessRule,
    /// What sensors and infos tell of it.
    pub(in crate::tasks) told: EpisodeGoal,
    /// Of goals in words.
    pub(in crate::tasks) instruction: Option<Instruction>,
}

impl NavigationGoal {
    /// The goal to be where `asked` is fulfilled; `None` where that is nowhere on the largest island.
    pub(in crate::tasks) fn from_instruction_goal(
        (world, agent): (&World, AgentId),
        ground: &LargestIslandIndex<'_>,
        asked: InstructionGoal,
        told: EpisodeGoal,
    ) -> Option<Self> {
        let cells = goal_region(world, agent, ground, &asked);
        (!cells.is_empty()).then_some(Self {
            cells,
            success: SuccessRule::Fulfilled(asked),
            told,
            instruction: None,
        })
    }

    /// The goal to come near the middle of a cell.
    pub(in crate::tasks) fn at_cell(
        kind: &'static str,
        grid: &NavGrid,
        cell: NavCell,
        success_distance_m: f64,
    ) -> Self {
        let position = grid.position(cell);
        Self::at_point(kind, StatedPoint { cell, position }, success_distance_m)
    }

    /// The goal to come near a point.
    pub(in crate::tasks) fn at_point(
        kind: &'static str,
        StatedPoint { cell, position }: StatedPoint,
        success_distance_m: f64,
    ) -> Self {
        Self {
            cells: vec![cell],
            success: SuccessRule::Within(success_distance_m),
            told: EpisodeGoal {
                kind,
                position: Some(position),
                ..EpisodeGoal::default()
            },
            instruction: None,
        }
    }

    /// The things of which one must be looked at.
    pub(in crate::tasks) fn objects(&self) -> &[ObjectId] {
        match &self.success {
            SuccessRule::Within(_) => &[],
            SuccessRule::Fulfilled(goal) => &goal.objects,
        }
    }
}

/// The walkable cells of the largest island in which a goal is reached by someone who looks the right way.
pub(in crate::tasks) fn goal_region(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    goal: &InstructionGoal,
) -> Vec<NavCell> {
    if !goal.rooms.is_empty() {
        return ground.cells_in_rooms(world.house(), &goal.rooms);
    }
    let scene = world.engines().semantics().scene(world.state());
    // A little nearer than asked, so that an agent that stops on the cell's border still counts.
    let radius_m = goal.radius_m * 0.8;
    let mut cells = Vec::new();
    for object in &goal.objects {
        let footprint = &scene.extent(*object).footprint;
        let near = |feet: Vec3| footprint.distance_to(Vec2::new(feet.x, feet.z)) <= radius_m;
        cells.extend(cells_in_sight(
            world,
            agent,
            ground,
            (*object, radius_m),
            near,
        ));
    }
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// The walkable cells of the largest island from which a hand reaches a thing in sight.
pub(in crate::tasks) fn cells_in_reach(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    object: ObjectId,
) -> Vec<NavCell> {
    // A little less than the whole reach, as from the border of a cell.
    cells_in_reach_fraction(world, agent, ground, (object, 0.85))
}

/// As [`cells_in_reach`], with a share of the reach.
pub(in crate::tasks) fn cells_in_reach_fraction(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    (object, share): (ObjectId, f32),
) -> Vec<NavCell> {
    let Some(body) = world.state().agents.get(agent).map(|agent| agent.body) else {
        return Vec::new();
    };
    // Reach is measured from the eye to the nearest point.
    let reach_m = body.reach_m * share;
    let bounds = world.house().object_bounds(world.state(), object);
    let near = |feet: Vec3| {
        let eye = feet + Vec3::Y * body.eye_height_m;
        eye.clamp(bounds.min, bounds.max).distance(eye) <= reach_m
    };
    cells_in_sight(world, agent, ground, (object, reach_m), near)
}

/// The cells around a thing that are `near` and from all over which one looks at the middle of its box; rising.
fn cells_in_sight(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    (object, radius_m): (ObjectId, f32),
    near: impl Fn(Vec3) -> bool,
) -> Vec<NavCell> {
    let (state, grid) = (world.state(), ground.grid);
    let scene = world.engines().semantics().scene(state);
    let eye_m = state
        .agents
        .get(agent)
        .map_or(1.25, |agent| agent.body.eye_height_m);
    let bounds = scene.extent(object).bounds;
    let entity = world.house().entity_of_object(object);
    let edge = grid.config().cell_m;
    let mut pace = CancelPoller::new(CELLS_PER_CHECK);
    let mut cells = ground.cells_around(&bounds.grown(radius_m + 0.01));
    cells.retain(|cell| {
        pace.count_one();
        let at = grid.position(*cell);
        let sides = [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
        near(at)
            && sides.iter().all(|(dx, dz)| {
                let beside = Vec3::new(*dx, 0.0, *dz) * (0.5 * edge);
                let eye = at + beside + Vec3::Y * eye_m;
                let ray = Ray::new(eye, bounds.center() - eye);
                let hit = world.rays().closest(&ray, RayMask::EYE);
                hit.is_some_and(|hit| world.rays().surface(&hit).entity == entity)
            })
    });
    cells.sort_unstable();
    cells
}
