//! Goals of navigation: where they are reached, and how that is judged.

use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::world::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::interrupt::PollEvery;
use dwell_scene::navigation::NavCell;
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
    /// The things of which one must be looked at.
    pub(in crate::tasks) fn objects(&self) -> &[ObjectId] {
        match &self.success {
            SuccessRule::Within(_) => &[],
            SuccessRule::Fulfilled(goal) => &goal.objects,
        }
    }
}

/// The walkable cells of the largest island in which a goal is reached by someone who looks the right way.
pub(in crate::tasks) fn cells_that_reach(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    goal: &InstructionGoal,
) -> Vec<NavCell> {
    if !goal.rooms.is_empty() {
        return ground.cells_in_rooms(world.house(), &goal.rooms);
    }
    let (house, state, grid) = (world.house(), world.state(), ground.grid);
    let scene = world.engines().semantics().scene(state);
    let eye_m = state
        .agents
        .get(agent)
        .map_or(1.25, |agent| agent.body.eye_height_m);
    // A little nearer than asked, so that an agent that stops on the cell's border still counts.
    let radius_m = goal.radius_m * 0.8;
    let mut pace = PollEvery::new(CELLS_PER_CHECK);
    let mut goals = Vec::new();
    for object in &goal.objects {
        let extent = scene.extent(*object);
        let entity = house.entity_of_object(*object);
        let found = ground.cells_around(&extent.bounds.grown(radius_m + 0.01));
        goals.extend(found.into_iter().filter(|cell| {
            pace.turn();
            let at = grid.position(*cell);
            if extent.footprint.distance_to(Vec2::new(at.x, at.z)) > radius_m {
                return false;
            }
            let edge = grid.config().cell_m;
            let sides = [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
            sides.iter().all(|(dx, dz)| {
                let beside = Vec3::new(*dx, 0.0, *dz) * (0.5 * edge);
                let eye = at + beside + Vec3::Y * eye_m;
                let ray = Ray::new(eye, extent.bounds.center() - eye);
                let hit = world.rays().closest(&ray, RayMask::EYE);
                hit.is_some_and(|hit| world.rays().surface(&hit).entity == entity)
            })
        }));
    }
    goals.sort_unstable();
    goals.dedup();
    goals
}
