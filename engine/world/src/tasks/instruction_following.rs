//! Do what the instruction says: go to a room, or find a thing; then stop.
//!
//! Reward: the decrease of the geodesic distance to the goal (m), minus 0.01 a step, plus 2.5 for stopping where the
//! instruction is fulfilled. The episode ends with `stop`.

use super::door_leaves::DoorLeaves;
use super::goal_cells::LargestIslandIndex;
use super::standing_room::FreeStartCells;
use super::{Task, TaskKind, TaskSetup};
use crate::actions::{DiscreteAction, StepSizes};
use crate::episode::{Episode, StepResult};
use crate::error::WorldError;
use crate::expert::{ShortestPathFollower, action_towards_object};
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::interrupt::{self, PollEvery};
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, Pose, State};
use dwell_semantics::instruct::{self, Instruction, InstructionKind};
use glam::{Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const NAME: &str = "InstructionFollowing";
/// Reward for success, and for every step (habitat-lab's defaults for navigation).
const SUCCESS_REWARD: f64 = 2.5;
const SLACK_REWARD: f64 = -0.01;
/// Distance from a place where the expert looked in vain within which goals are not tried again, m.
const ELSEWHERE_M: f32 = 0.3;
/// Cells between checks for cancellation.
const CELLS_PER_CHECK: usize = 256;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Follow an instruction: go to a room or find a thing, then stop.",
    has_goal: true,
    max_steps: 1000,
    sensors: &[
        "rgb",
        "depth",
        "semantic",
        "audio",
        "instruction",
        "instruction_tokens",
    ],
    settings: schema::fields_of::<InstructionFollowingSettings>,
    build,
};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct InstructionFollowingSettings {
    /// Kinds of instructions to draw from; default all.
    kinds: Vec<InstructionKind>,
    /// The nearest a start may lie to the goal, geodesic m; default 1.
    min_distance_m: f64,
    /// The furthest, m; default 30.
    max_distance_m: f64,
}

impl Default for InstructionFollowingSettings {
    fn default() -> Self {
        Self {
            kinds: InstructionKind::ALL.to_vec(),
            min_distance_m: 1.0,
            max_distance_m: 30.0,
        }
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: InstructionFollowingSettings = if value.is_null() {
        InstructionFollowingSettings::default()
    } else {
        crate::parse_settings::parse_settings("task_settings", value)?
    };
    if settings.kinds.is_empty() {
        let allowed = "at least one of go_to_room, find_object".to_owned();
        return Err(WorldError::Config {
            field: "kinds",
            found: "none".to_owned(),
            allowed,
        });
    }
    let (least, most) = (settings.min_distance_m, settings.max_distance_m);
    if least > most {
        return Err(WorldError::Config {
            field: "min_distance_m",
            found: least.to_string(),
            allowed: format!("at most max_distance_m, which is {most}"),
        });
    }
    Ok(Box::new(InstructionFollowing {
        settings,
        setup,
        offers: Vec::new(),
        active: None,
    }))
}

/// An instruction that can be played, and the cells where it is fulfilled.
#[derive(Clone, Debug)]
struct PlayableInstruction {
    instruction: Instruction,
    goals: Vec<NavCell>,
}

#[derive(Clone, Debug)]
struct ActiveInstruction {
    instruction: Instruction,
    /// The guide that measures the remaining distance.
    guide: ShortestPathFollower,
    /// The expert's guide, to those goals from which it has not looked in vain.
    expert_path: ShortestPathFollower,
    goals: Vec<NavCell>,
}

impl ActiveInstruction {
    /// Leads to goals elsewhere from now on; `false` when there are none. Of a cell on whose border the agent stands the
    /// thing may be hidden, though it is seen from the middle.
    fn leave_out_goals_here(&mut self, world: &World, stride: &StepSizes) -> bool {
        let id = self.expert_path.agent();
        let Some(agent) = world.state().agents.get(id) else {
            return false;
        };
        let grid = self.expert_path.grid().clone();
        let before = self.goals.len();
        self.goals
            .retain(|cell| (grid.position(*cell) - agent.position).length() > ELSEWHERE_M);
        if self.goals.is_empty() || self.goals.len() == before {
            return false;
        }
        self.expert_path = ShortestPathFollower::new(id, grid, &self.goals, *stride);
        true
    }
}

#[derive(Debug)]
struct InstructionFollowing {
    settings: InstructionFollowingSettings,
    setup: TaskSetup,
    /// Instructions that are playable at the house's start; found once.
    offers: Vec<PlayableInstruction>,
    active: Option<ActiveInstruction>,
}

impl InstructionFollowing {
    fn body(&self, world: &World) -> Result<AgentBody, WorldError> {
        let id = self.setup.agent;
        let agent = world.state().agents.get(id);
        let none = || WorldError::InvalidCall(format!("{NAME} needs a world with agent {}", id.0));
        Ok(agent.ok_or_else(none)?.body)
    }

    /// All at once: who is stopped on the way has found nothing.
    fn find_playable(&self, world: &World, grid: &NavGrid) -> Vec<PlayableInstruction> {
        let mut offers = Vec::new();
        let ground = LargestIslandIndex::of(grid);
        let engines = world.engines().clone();
        let state: &State = world.state();
        let scene = engines.semantics().scene(state);
        for kind in &self.settings.kinds {
            for instruction in instruct::candidates(&scene, *kind) {
                let goals = goal_cells(world, self.setup.agent, &ground, &instruction);
                if !goals.is_empty() {
                    offers.push(PlayableInstruction { instruction, goals });
                }
            }
        }
        offers
    }
}

/// The walkable cells of the largest island in which an instruction is fulfilled by someone who looks the right way.
fn goal_cells(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    instruction: &Instruction,
) -> Vec<NavCell> {
    if !instruction.goal.rooms.is_empty() {
        return ground.cells_in_rooms(world.house(), &instruction.goal.rooms);
    }
    let (house, state, grid) = (world.house(), world.state(), ground.grid);
    let scene = world.engines().semantics().scene(state);
    let eye_m = state
        .agents
        .get(agent)
        .map_or(1.25, |agent| agent.body.eye_height_m);
    // A little nearer than asked, so that an agent that stops on the cell's border still counts.
    let radius_m = instruction.goal.radius_m * 0.8;
    let mut pace = PollEvery::new(CELLS_PER_CHECK);
    let mut goals = Vec::new();
    for object in &instruction.goal.objects {
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

impl Task for InstructionFollowing {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.offers.is_empty() {
            let grid = world.engines().nav_grid(&self.body(world)?)?;
            self.offers = self.find_playable(world, &grid);
        }
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        let agent = self.setup.agent;
        let body = self.body(world)?;
        let grid = world.engines().nav_grid(&body)?;
        let unplayable = |why: &str| WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why: why.to_owned(),
        };
        let leaves = DoorLeaves::of(world, &grid);
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        let mut order: Vec<usize> = (0..self.offers.len()).collect();
        key.child("order").stream().shuffle(&mut order);
        let found = order.into_iter().find_map(|k| {
            interrupt::unwind_if_cancelled();
            let offer = &self.offers[k];
            let guide =
                ShortestPathFollower::new(agent, grid.clone(), &offer.goals, self.setup.stride);
            let range = self.settings.min_distance_m..=self.settings.max_distance_m;
            let allowed = |cell: NavCell| {
                grid.island(cell) == Some(0)
                    && guide.distance_at(cell).is_some_and(|d| range.contains(&d))
                    && !leaves.is_blocked(&grid, cell)
            };
            let start = room.sample(&grid, key.child("start"), allowed)?;
            Some((offer, guide, start))
        });
        let Some((offer, guide, start)) = found else {
            return Err(unplayable(
                "no instruction has a goal that can be walked to from the asked distance",
            ));
        };
        let engines = world.engines().clone();
        let offered = std::slice::from_ref(&offer.instruction);
        let instruction = instruct::choose(engines.semantics(), offered, key)
            .ok_or_else(|| unplayable("no wording fits"))?;
        let yaw_rad = key
            .child("yaw")
            .stream()
            .range(-std::f32::consts::PI, std::f32::consts::PI);
        let position = grid.position(start);
        world.place_agent(agent, position, yaw_rad)?;
        let distance_m = guide.distance_at(start);
        let episode = Episode {
            agent,
            instruction: instruction.text.clone(),
            tokens: instruction.tokens()?,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, distance_m),
        };
        let (expert_path, goals) = (guide.clone(), offer.goals.clone());
        self.active = Some(ActiveInstruction {
            instruction,
            guide,
            expert_path,
            goals,
        });
        Ok(episode)
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        action: DiscreteAction,
    ) -> StepResult {
        let (Some(active), Some(agent)) =
            (&self.active, world.state().agents.get(self.setup.agent))
        else {
            return StepResult::default();
        };
        let gain = episode.progress.advance(
            agent.position,
            active.guide.distance_m(world),
            agent.collided,
        );
        let mut verdict = StepResult {
            reward: gain + SLACK_REWARD,
            ..StepResult::default()
        };
        if action == DiscreteAction::Stop {
            let scene = world.engines().semantics().scene(world.state());
            let judged = active
                .instruction
                .verify_at_stop(&scene, world.rays(), self.setup.agent);
            verdict.terminated = true;
            verdict.success = judged == instruct::InstructionProgress::Success;
            if verdict.success {
                verdict.reward += SUCCESS_REWARD;
            }
        }
        verdict
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        if let Some(step) = active.expert_path.next_action(world) {
            return step;
        }
        let Some(object) = active.instruction.goal.objects.first() else {
            return DiscreteAction::Stop;
        };
        if let Some(turn) =
            action_towards_object(world, self.setup.agent, *object, &self.setup.stride)
        {
            return turn;
        }
        let scene = world.engines().semantics().scene(world.state());
        let judged = (active.instruction).verify(&scene, world.rays(), self.setup.agent);
        if judged == instruct::InstructionProgress::Continue
            && active.leave_out_goals_here(world, &self.setup.stride)
        {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_nearest_start_beyond_the_furthest_is_refused() {
        let setup = TaskSetup {
            agent: AgentId(0),
            stride: StepSizes::default(),
        };
        let made = |settings| build(&settings, setup).map(|_| ());
        made(json!({"min_distance_m": 3.0, "max_distance_m": 3.0})).unwrap();
        let told = made(json!({"min_distance_m": 5.0, "max_distance_m": 2.0}));
        assert_eq!(
            told.unwrap_err().to_string(),
            "min_distance_m is 5; allowed is at most max_distance_m, which is 2"
        );
    }
}
