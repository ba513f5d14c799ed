//! The common part of tasks of navigation: get from a start to a goal, then stop.
//!
//! A kind of goal ([`GoalKind`]) says which goals a house offers, and what an episode asks for; starts, rewards, success and the
//! expert are the same for all.

mod goal;
mod leg;
mod settings;

pub(super) use goal::{
    NavigationGoal, SuccessRule, cells_in_reach, cells_in_share_of_reach, cells_that_reach,
};
pub(super) use leg::{BESIDE_M, ELSEWHERE_M, Leg};
pub(super) use settings::{NavigationRewards, NavigationRules, navigation_settings};

use super::door_leaves::DoorLeaves;
use super::goal_cells::LargestIslandIndex;
use super::standing_room::FreeStartCells;
use super::{Task, TaskSetup};
use crate::actions::{DiscreteAction, StepAction};
use crate::episode::{Episode, StepResult};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::world::World;
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::vocabulary;
use std::f32::consts::PI;
use std::fmt::Debug;
use std::sync::Arc;

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

/// A task of navigation.
#[derive(Debug)]
pub(super) struct NavigationTask<K> {
    kind: K,
    rules: NavigationRules,
    setup: TaskSetup,
    /// Goals that the house offers at its start; found once.
    offers: Vec<Arc<NavigationGoal>>,
    active: Option<Leg>,
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

    /// Returns whether an episode may start in a cell.
    fn is_start(&self, leg: &Leg, cell: NavCell) -> bool {
        let Some(way_m) = leg.guide.distance_at(cell) else {
            return false;
        };
        let within = match leg.goal.success {
            SuccessRule::Within(radius_m) => way_m < radius_m,
            SuccessRule::Fulfilled(_) => false,
        };
        !within && self.rules.allow_start(way_m, || leg.straight_m(cell))
    }
}

/// A start of an episode: a cell and a heading, rad.
type Start = (NavCell, f32);

impl<K: GoalKind> NavigationTask<K> {
    /// A start for a goal, of the cells that are allowed, in which the agent has not reached it; the agent stands there then.
    fn place(
        &self,
        world: &mut World,
        leg: &Leg,
        key: RandomKey,
        sample: impl Fn(RandomKey) -> Option<NavCell>,
    ) -> Result<Option<Start>, WorldError> {
        for attempt in 0..STARTS {
            let of = |key: RandomKey| match attempt {
                0 => key,
                _ => key.child(attempt),
            };
            let Some(cell) = sample(of(key.child("start"))) else {
                return Ok(None);
            };
            let yaw_rad = of(key.child("yaw")).stream().range(-PI, PI);
            let agent = self.setup.agent;
            world.place_agent(agent, leg.guide.grid().position(cell), yaw_rad)?;
            if !leg.is_reached(world, leg.guide.distance_at(cell)) {
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
            let grid = world
                .engines()
                .nav_grid(&self.setup.body(world, K::NAME)?)?;
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
        let body = self.setup.body(world, K::NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        self.rules.arrange_doors(world, &grid, &self.setup)?;
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
            let leg = Leg::new(agent, grid.clone(), goal, self.setup.stride);
            let sample = |key: RandomKey| {
                room.sample(&grid, key, |cell| free(cell) && self.is_start(&leg, cell))
            };
            if let Some(start) = self.place(world, &leg, key, sample)? {
                found = Some((leg, start));
                break;
            }
        }
        let Some((leg, (start, yaw_rad))) = found else {
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
        let instruction = self.kind.begin(world, &leg.goal, key)?;
        let position = grid.position(start);
        let episode = Episode {
            agent,
            tokens: vocabulary::tokenize(&instruction)?,
            instruction,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, leg.guide.distance_at(start)),
            goal: leg.goal.told.clone(),
        };
        self.active = Some(leg);
        Ok(episode)
    }

    fn judge(&mut self, world: &World, episode: &mut Episode, action: &StepAction) -> StepResult {
        let (Some(active), Some(agent)) =
            (&self.active, world.state().agents.get(self.setup.agent))
        else {
            return StepResult::default();
        };
        let left_m = active.guide.distance_m(world);
        let gain_m = episode
            .progress
            .advance(agent.position, left_m, agent.collided);
        let stops = action.action == DiscreteAction::Stop;
        let is_reached = || active.is_reached(world, left_m);
        self.rules
            .step_result((gain_m, agent.collided), stops, is_reached)
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(leg) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        if let Some(step) = leg.approach(world) {
            return step;
        }
        let looks_in_vain = !leg.goal.objects().is_empty() && !leg.is_reached(world, None);
        if looks_in_vain && leg.leave_out_goals_here(world, ELSEWHERE_M) {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }
}
