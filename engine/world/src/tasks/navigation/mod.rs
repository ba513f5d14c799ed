//! The common part of tasks of navigation: get from a start to a goal, then stop.
//!
//! A kind of goal ([`GoalKind`]) says which goals a house offers, and what an episode asks for; starts, rewards, success and the
//! expert are the same for all.

mod goal;
mod settings;

pub(super) use goal::{NavigationGoal, SuccessRule, cells_that_reach};
pub(super) use settings::{NavigationRewards, NavigationRules, navigation_settings};

use super::door_leaves::DoorLeaves;
use super::goal_cells::LargestIslandIndex;
use super::standing_room::FreeStartCells;
use super::{Task, TaskSetup};
use crate::actions::{DiscreteAction, StepSizes};
use crate::episode::{Episode, StepResult};
use crate::error::WorldError;
use crate::expert::{ShortestPathFollower, action_towards_object};
use crate::metrics::NavigationMetrics;
use crate::world::World;
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, Pose};
use dwell_semantics::vocabulary;
use std::fmt::Debug;
use std::sync::Arc;

/// Distance from a place where the expert looked in vain within which goals are not tried again, m.
const ELSEWHERE_M: f32 = 0.3;
/// Places that are tried as goals, where a kind draws them.
const DRAWS: u64 = 64;
/// Starts that are tried for a goal, where one has it reached already.
const STARTS: u64 = 8;

/// A kind of goal.
pub(super) trait GoalKind: Debug + Send + Sync {
    /// The task's name.
    const NAME: &'static str;
    /// What a house lacks in which there is nothing to ask for.
    const LACKS: &'static str;

    /// Returns its settings, with those of [`NavigationRules`].
    fn settings(&self) -> serde_json::Value;

    /// The goals that a house offers at its start; found once. None for kinds that draw places.
    fn survey(
        &self,
        _world: &World,
        _agent: AgentId,
        _ground: &LargestIslandIndex<'_>,
    ) -> Vec<NavigationGoal> {
        Vec::new()
    }

    /// A place as goal, of those that are allowed; `None` for kinds that survey the house.
    fn draw(
        &self,
        _grid: &NavGrid,
        _key: RandomKey,
        _allowed: &dyn Fn(NavCell) -> bool,
    ) -> Option<NavigationGoal> {
        None
    }

    /// Arranges the world for a goal that was chosen, and says what is asked.
    ///
    /// # Errors
    /// [`WorldError`] where the world cannot be arranged.
    fn begin(
        &self,
        world: &mut World,
        goal: &NavigationGoal,
        key: RandomKey,
    ) -> Result<String, WorldError>;
}

/// The goal of the episode that is played.
#[derive(Clone, Debug)]
struct ActiveGoal {
    goal: NavigationGoal,
    /// The guide that measures the remaining distance.
    guide: ShortestPathFollower,
    /// The expert's guide, to those goals from which it has not looked in vain.
    expert_path: ShortestPathFollower,
    /// Those goals.
    expert_cells: Vec<NavCell>,
}

impl ActiveGoal {
    /// Leads to goals elsewhere from now on; `false` when there are none. Of a cell on whose border the agent stands the
    /// thing may be hidden, though it is seen from the middle.
    fn leave_out_goals_here(&mut self, world: &World, stride: &StepSizes) -> bool {
        let id = self.expert_path.agent();
        let Some(agent) = world.state().agents.get(id) else {
            return false;
        };
        let grid = self.expert_path.grid().clone();
        let before = self.expert_cells.len();
        self.expert_cells
            .retain(|cell| (grid.position(*cell) - agent.position).length() > ELSEWHERE_M);
        if self.expert_cells.is_empty() || self.expert_cells.len() == before {
            return false;
        }
        self.expert_path = ShortestPathFollower::new(id, grid, &self.expert_cells, *stride);
        true
    }

    /// Returns whether the agent has reached the goal; `distance_m`: how far it is from there.
    fn is_reached(&self, world: &World, distance_m: Option<f64>) -> bool {
        is_reached(world, self.guide.agent(), &self.goal, distance_m)
    }
}

fn is_reached(
    world: &World,
    agent: AgentId,
    goal: &NavigationGoal,
    distance_m: Option<f64>,
) -> bool {
    match &goal.success {
        SuccessRule::Within(radius_m) => distance_m.is_some_and(|left| left < *radius_m),
        SuccessRule::Fulfilled(asked) => {
            let scene = world.engines().semantics().scene(world.state());
            asked.is_reached(&scene, world.rays(), agent)
        }
    }
}

/// A task of navigation.
#[derive(Debug)]
pub(super) struct NavigationTask<K> {
    kind: K,
    rules: NavigationRules,
    setup: TaskSetup,
    /// Goals that the house offers at its start; found once.
    offers: Vec<Arc<NavigationGoal>>,
    active: Option<ActiveGoal>,
}

impl<K: GoalKind> NavigationTask<K> {
    pub(super) fn new(kind: K, rules: NavigationRules, setup: TaskSetup) -> Self {
        Self {
            kind,
            rules,
            setup,
            offers: Vec::new(),
            active: None,
        }
    }

    fn body(&self, world: &World) -> Result<AgentBody, WorldError> {
        let id = self.setup.agent;
        let agent = world.state().agents.get(id);
        let none =
            || WorldError::InvalidCall(format!("{} needs a world with agent {}", K::NAME, id.0));
        Ok(agent.ok_or_else(none)?.body)
    }

    /// Returns whether an episode may start in a cell.
    fn is_start(&self, guide: &ShortestPathFollower, goal: &NavigationGoal, cell: NavCell) -> bool {
        let [least, most] = self.rules.distance_m;
        let Some(distance_m) = guide.distance_at(cell) else {
            return false;
        };
        let within = match goal.success {
            SuccessRule::Within(radius_m) => distance_m < radius_m,
            SuccessRule::Fulfilled(_) => false,
        };
        if within || !(least..=most).contains(&distance_m) {
            return false;
        }
        let ratio = self.rules.min_path_ratio;
        ratio <= 1.0 || {
            let grid = guide.grid();
            let from = grid.position(cell);
            let straight = goal
                .cells
                .iter()
                .map(|to| grid.position(*to).distance(from));
            let straight_m = straight.fold(f32::INFINITY, f32::min);
            distance_m >= ratio * f64::from(straight_m)
        }
    }
}

/// A start of an episode: a cell and a heading, rad.
type Start = (NavCell, f32);

impl<K: GoalKind> NavigationTask<K> {
    /// A start for a goal, of the cells that are allowed, in which the agent has not reached it; the agent stands there then.
    fn place(
        &self,
        world: &mut World,
        (goal, guide): (&NavigationGoal, &ShortestPathFollower),
        key: RandomKey,
        sample: impl Fn(RandomKey) -> Option<NavCell>,
    ) -> Result<Option<Start>, WorldError> {
        for attempt in 0..STARTS {
            let of = |name: &str| match attempt {
                0 => key.child(name),
                _ => key.child(name).child(attempt),
            };
            let Some(cell) = sample(of("start")) else {
                return Ok(None);
            };
            let (low, high) = (-std::f32::consts::PI, std::f32::consts::PI);
            let yaw_rad = of("yaw").stream().range(low, high);
            let agent = self.setup.agent;
            world.place_agent(agent, guide.grid().position(cell), yaw_rad)?;
            if !is_reached(world, agent, goal, guide.distance_at(cell)) {
                return Ok(Some((cell, yaw_rad)));
            }
        }
        Ok(None)
    }
}

impl<K: GoalKind> Task for NavigationTask<K> {
    fn settings(&self) -> serde_json::Value {
        self.kind.settings()
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.offers.is_empty() {
            let grid = world.engines().nav_grid(&self.body(world)?)?;
            let ground = LargestIslandIndex::of(&grid);
            let found = self.kind.survey(world, self.setup.agent, &ground);
            self.offers = found.into_iter().map(Arc::new).collect();
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
        let leaves = DoorLeaves::of(world, &grid);
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        let free = |cell: NavCell| grid.island(cell) == Some(0) && !leaves.is_blocked(&grid, cell);
        let mut order: Vec<usize> = (0..self.offers.len()).collect();
        key.child("order").stream().shuffle(&mut order);
        let surveyed = order.into_iter().map(|k| self.offers[k].clone());
        let drawn = (0..DRAWS).map_while(|k| {
            let goal = self.kind.draw(&grid, key.child("goal").child(k), &free)?;
            Some(Arc::new(goal))
        });
        let (mut seen, mut found) = (0_usize, None);
        for goal in surveyed.chain(drawn) {
            interrupt::unwind_if_cancelled();
            seen += 1;
            let guide =
                ShortestPathFollower::new(agent, grid.clone(), &goal.cells, self.setup.stride);
            let sample = |key: RandomKey| {
                room.sample(&grid, key, |cell| {
                    free(cell) && self.is_start(&guide, &goal, cell)
                })
            };
            if let Some(start) = self.place(world, (&goal, &guide), key, sample)? {
                found = Some((goal, guide, start));
                break;
            }
        }
        let Some((goal, guide, (start, yaw_rad))) = found else {
            let [least, most] = self.rules.distance_m;
            let why = match seen {
                0 => K::LACKS.to_owned(),
                _ => format!(
                    "none of {seen} goals can be walked to from {least} to {most} m away with the other settings"
                ),
            };
            return Err(WorldError::TaskNotPlayable {
                task: K::NAME,
                house: world.house().name.clone(),
                why,
            });
        };
        let goal = Arc::unwrap_or_clone(goal);
        let instruction = self.kind.begin(world, &goal, key)?;
        let position = grid.position(start);
        let episode = Episode {
            agent,
            tokens: vocabulary::tokenize(&instruction)?,
            instruction,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, guide.distance_at(start)),
            goal: goal.told.clone(),
        };
        self.active = Some(ActiveGoal {
            expert_path: guide.clone(),
            expert_cells: goal.cells.clone(),
            guide,
            goal,
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
        let left_m = active.guide.distance_m(world);
        let gain_m = episode
            .progress
            .advance(agent.position, left_m, agent.collided);
        let (rules, pay) = (&self.rules, &self.rules.rewards);
        let stops = action == DiscreteAction::Stop;
        let success = (stops || rules.ends_at_goal) && active.is_reached(world, left_m);
        let mut reward = pay.distance * gain_m + pay.step;
        if agent.collided {
            reward += pay.collision;
        }
        if success {
            reward += pay.success;
        } else if stops {
            reward += pay.wrong_stop;
        }
        StepResult {
            reward,
            terminated: stops || success,
            success,
        }
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let (agent, stride) = (self.setup.agent, self.setup.stride);
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        if let Some(step) = active.expert_path.next_action(world) {
            return step;
        }
        let Some(object) = nearest(world, agent, active.goal.objects()) else {
            return DiscreteAction::Stop;
        };
        if let Some(turn) = action_towards_object(world, agent, object, &stride) {
            return turn;
        }
        if !active.is_reached(world, None) && active.leave_out_goals_here(world, &stride) {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }
}

/// The nearest of some things to an agent.
fn nearest(
    world: &World,
    agent: AgentId,
    objects: &[dwell_scene::ObjectId],
) -> Option<dwell_scene::ObjectId> {
    let here = world.state().agents.get(agent)?.position;
    let distance = |object: &dwell_scene::ObjectId| {
        let bounds = world.house().object_bounds(world.state(), *object);
        here.clamp(bounds.min, bounds.max).distance(here)
    };
    objects
        .iter()
        .copied()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
