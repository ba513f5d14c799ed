//! The common part of tasks of navigation: get from a start to a goal, then stop.
//!
//! A kind of goal ([`GoalKind`]) says which goals a house offers, and what an episode asks for; starts, rewards, success and the
//! expert are the same for all.

mod goal;
mod leg;
mod settings;
mod stated;

pub(super) use goal::{
    NavigationGoal, SuccessRule, cells_in_reach, cells_in_reach_fraction, goal_region,
};
pub(super) use leg::{BESIDE_M, ELSEWHERE_M, Leg};
pub(super) use settings::{NavigationRewards, NavigationRules, navigation_settings};
pub(super) use stated::StatedPoint;

use super::door_leaves::DoorLeaves;
use super::goal_cells::LargestIslandIndex;
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, StepResult};
use crate::episode_spec::{EpisodeSpec, StatedGoal};
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

    /// The goal that an episode states.
    ///
    /// # Errors
    /// [`WorldError::Config`] for one that the house does not have, and of kinds whose goals cannot be stated.
    fn stated(
        &self,
        _site: &GoalContext<'_>,
        _asked: &StatedGoal,
    ) -> Result<Arc<NavigationGoal>, WorldError> {
        Err(WorldError::Config {
            field: "episode.goal",
            found: "stated".to_owned(),
            allowed: format!(
                "in {} one that is drawn; PointNav, ObjectNav and AudioNav state theirs",
                Self::NAME
            ),
        })
    }

    /// Arranges the world for a goal that was chosen, and says what is asked. `asked`: the goal as it is stated, where it is.
    ///
    /// # Errors
    /// [`WorldError`] where the world cannot be arranged.
    fn begin(
        &self,
        world: &mut World,
        goal: &NavigationGoal,
        asked: Option<&StatedGoal>,
        key: RandomKey,
    ) -> Result<String, WorldError>;
}

/// Where a stated goal is looked for.
pub(super) struct GoalContext<'a> {
    pub(super) world: &'a World,
    /// Who goes there.
    pub(super) agent: AgentId,
    pub(super) grid: &'a NavGrid,
    /// The goals that the house offers at its start.
    pub(super) offers: &'a [Arc<NavigationGoal>],
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

/// A start of an episode: a point and a heading, rad.
type Start = (StatedPoint, f32);

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
            let position = leg.guide.grid().position(cell);
            world.place_agent(self.setup.agent, position, yaw_rad)?;
            if !leg.is_reached(world, leg.guide.distance_at(cell)) {
                return Ok(Some((StatedPoint { cell, position }, yaw_rad)));
            }
        }
        Ok(None)
    }

    /// Places the agent at a stated start, if an episode may start there; `states_goal`: whether the goal is stated, too, and whatever
    /// its distance.
    fn place_stated(
        &self,
        world: &mut World,
        leg: &Leg,
        (start, yaw_rad): Start,
        states_goal: bool,
    ) -> Result<Option<Start>, WorldError> {
        let may_start = if states_goal {
            leg.guide.distance_at(start.cell).is_some()
        } else {
            self.is_start(leg, start.cell)
        };
        if !may_start {
            return Ok(None);
        }
        world.place_agent(self.setup.agent, start.position, yaw_rad)?;
        let is_reached = || leg.is_reached(world, leg.guide.distance_at(start.cell));
        Ok((states_goal || !is_reached()).then_some((start, yaw_rad)))
    }

    /// Why no episode could begin. `seen`: how many goals were tried.
    fn unplayable(&self, world: &World, seen: usize, spec: &EpisodeSpec) -> WorldError {
        let [least, most] = self.rules.distance_m;
        if let (Some(start), Some(_)) = (&spec.start, &spec.goal) {
            return WorldError::Config {
                field: "episode.goal",
                found: format!(
                    "one to which no way leads from the start, {:?}",
                    start.position
                ),
                allowed: "a goal that can be walked to from there".to_owned(),
            };
        }
        let why = match (seen, spec.start) {
            (0, _) => K::LACKS.to_owned(),
            (_, Some(start)) => format!(
                "none of {seen} goals can be walked to from {least} to {most} m away, from {:?}, with the other settings",
                start.position
            ),
            (_, None) => format!(
                "none of {seen} goals can be walked to from {least} to {most} m away with the other settings"
            ),
        };
        WorldError::TaskNotPlayable {
            task: K::NAME,
            house: world.house().name.clone(),
            why,
        }
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
        self.reset_stated(world, placed, key, &EpisodeSpec::default())
    }

    fn reset_stated(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
        spec: &EpisodeSpec,
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
        let stated_start = match &spec.start {
            Some(start) => Some(stated::stated_start(&grid, start, &leaves, &room)?),
            None => None,
        };
        let site = GoalContext {
            world,
            agent,
            grid: &grid,
            offers: &self.offers,
        };
        let stated = match &spec.goal {
            Some(asked) => Some(self.kind.stated(&site, asked)?),
            None => None,
        };
        let most = if stated.is_some() { 0 } else { DRAWS };
        order.truncate(if stated.is_some() { 0 } else { order.len() });
        let surveyed = order.into_iter().map(|k| self.offers[k].clone());
        let drawn = (0..most).map_while(|k| {
            let goal = self.kind.draw(&grid, key.child("goal").child(k), &free)?;
            Some(Arc::new(goal))
        });
        let (mut seen, mut found) = (0_usize, None);
        for goal in stated.into_iter().chain(surveyed).chain(drawn) {
            interrupt::unwind_if_cancelled();
            seen += 1;
            let leg = Leg::new(agent, grid.clone(), goal, self.setup.stride);
            let sample = |key: RandomKey| {
                room.sample(&grid, key, |cell| free(cell) && self.is_start(&leg, cell))
            };
            let start = match stated_start {
                Some(start) => self.place_stated(world, &leg, start, spec.goal.is_some())?,
                None => self.place(world, &leg, key, sample)?,
            };
            if let Some(start) = start {
                found = Some((leg, start));
                break;
            }
        }
        let Some((leg, (start, yaw_rad))) = found else {
            return Err(self.unplayable(world, seen, spec));
        };
        let instruction = self.kind.begin(world, &leg.goal, spec.goal.as_ref(), key)?;
        let StatedPoint { cell, position } = start;
        let episode = Episode {
            agent,
            tokens: vocabulary::tokenize(&instruction)?,
            instruction,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, leg.guide.distance_at(cell)),
            goal: leg.goal.told.clone(),
        };
        self.active = Some(leg);
        Ok(episode)
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
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
        let stops = played.is_stop();
        let is_reached = || active.is_reached(world, left_m);
        self.rules
            .step_result((gain_m, agent.collided), stops, is_reached)
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(leg) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        if let Some(step) = leg.approach(world) {
            let walks_on = step == DiscreteAction::MoveForward && leg.oversteps_goal(world);
            return if walks_on { DiscreteAction::Stop } else { step };
        }
        let looks_in_vain = !leg.goal.objects().is_empty() && !leg.is_reached(world, None);
        if looks_in_vain && leg.exclude_goals_within(world, ELSEWHERE_M) {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }
}
