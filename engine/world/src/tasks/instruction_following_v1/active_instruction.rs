//! The instruction of an episode: what is done of it, and what the expert does next.

use super::planned_step::{LegEndAction, PlannedStep};
use super::step_places::DROP_M;
use crate::actions::{DiscreteAction, StepSizes};
use crate::error::WorldError;
use crate::expert::{BlockedDoors, LookAction, LookTarget, point_in_view_centre};
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::moved_things::{RestState, box_centre, rest_state, was_moved};
use crate::tasks::navigation::{BESIDE_M, ELSEWHERE_M, Leg, NavigationGoal, cells_in_reach};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::space::forward_from_yaw;
use dwell_scene::{AgentId, ObjectId};
use dwell_semantics::instruct::{ConditionContext, StepCondition};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Control steps for which the expert waits for what its hand has begun.
const PATIENCE: u32 = 60;
/// How often the expert tries all places of a leg again.
const ROUNDS: u32 = 3;
/// Control steps for which it keeps opening a thing.
const OPENING: u32 = 240;

/// The place of a leg: its step, target and number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LegPlace {
    step: usize,
    target: usize,
    leg: usize,
}

/// What has come about of an instruction, beside what is so in the world.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct StepProgress {
    /// Steps that are done, in order.
    done: usize,
    /// The conditions of the step after them that were so once, where that is enough.
    met: Vec<bool>,
    /// True once something was done that was not to be done.
    is_broken: bool,
    /// Of a leg to a thing that was moved: where it lies now.
    moved: Option<MovedThing>,
}

/// A thing that was moved since its places were found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct MovedThing {
    /// The middle of its box.
    lies_at: Vec3,
    /// The cells from which the hand reaches it, rising; of none, the places before are kept.
    cells: Vec<NavCell>,
}

/// Where the hand acted.
#[derive(Clone, Copy, Debug)]
struct TriedPlace {
    at: LegPlace,
    /// Where the agent stood.
    stood: Vec3,
    /// What the middle of its view was on.
    looked_at: Option<Vec3>,
}

/// The instruction of the episode that is played.
#[derive(Debug)]
pub(super) struct ActiveInstruction {
    pub(super) steps: Vec<PlannedStep>,
    /// What must never be so.
    forbidden: Vec<StepCondition>,
    progress: StepProgress,
    /// The leg that is gone.
    at: LegPlace,
    leg: Leg,
    /// Doors that what the expert carries keeps from opening.
    doors: BlockedDoors,
    /// The walkable way from the end of each leg to the end of the last one, m. Shape (step, target, leg).
    later_m: Vec<Vec<Vec<f64>>>,
    /// Control steps for which the expert has been busy with its hand.
    busy: u32,
    /// How often it has tried all places of the leg in vain.
    rounds: u32,
    /// Turns that it has made to let go of something inwards.
    turns_inwards: u32,
    /// Where the hand acted on legs of the step that is done now: of one that has to be gone again it did so in vain.
    tried: Vec<TriedPlace>,
}

impl ActiveInstruction {
    /// Begins with the first leg of the first step.
    pub(super) fn new(
        steps: Vec<PlannedStep>,
        forbidden: Vec<StepCondition>,
        (agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes),
    ) -> Self {
        let first = steps[0].targets[0].legs[0].goal.clone();
        Self {
            later_m: later_distances(&steps, grid),
            leg: Leg::new(agent, grid.clone(), first, stride),
            doors: BlockedDoors::new((agent, grid, stride)),
            steps,
            forbidden,
            progress: StepProgress::default(),
            at: LegPlace::default(),
            busy: 0,
            rounds: 0,
            turns_inwards: 0,
            tried: Vec::new(),
        }
    }

    /// The straight distance of a cell to the nearest place of the first leg, and the walkable way from there on, m.
    pub(super) fn straight_line_from_m(&self, cell: NavCell) -> f64 {
        self.leg.straight_m(cell) + self.later_m[0][0][0]
    }

    /// The walkable way of the whole instruction from a cell, m.
    pub(super) fn geodesic_from_m(&self, cell: NavCell) -> Option<f64> {
        Some(self.leg.guide.distance_at(cell)? + self.later_m[0][0][0])
    }

    /// Returns whether all steps are done.
    fn is_done(&self) -> bool {
        self.progress.done == self.steps.len()
    }

    /// Returns whether something was done that was not to be done.
    pub(super) fn is_violated(&self) -> bool {
        self.progress.is_broken
    }

    /// The share of the conditions of all steps that hold, 0 to 1; 0 once something was done that was not to be done.
    pub(super) fn condition_success(&self, world: &World, agent: AgentId) -> f64 {
        if self.progress.is_broken {
            return 0.0;
        }
        let scene = world.engines().semantics().scene(world.state());
        let view = ConditionContext {
            scene: &scene,
            rays: world.rays(),
            agent,
            pointed_at: None,
        };
        let needed = |step: &PlannedStep| step.step.needed;
        let all: usize = self.steps.iter().map(needed).sum();
        let met = self.progress.met.iter().filter(|met| **met).count();
        let of_step = |step: usize| self.lasting(step, &view).min(self.steps[step].step.needed);
        let done = (0..self.progress.done).map(of_step);
        (done.sum::<usize>() + met) as f64 / all as f64
    }

    /// Counts the steps that are done; returns how many became so. `pointed_at`: what the agent has just pointed at.
    pub(super) fn advance(
        &mut self,
        world: &World,
        agent: AgentId,
        pointed_at: Option<ObjectId>,
    ) -> usize {
        let before = self.progress.done;
        let scene = world.engines().semantics().scene(world.state());
        let mut view = ConditionContext {
            scene: &scene,
            rays: world.rays(),
            agent,
            pointed_at,
        };
        let progress = &mut self.progress;
        progress.is_broken |= self
            .forbidden
            .iter()
            .any(|condition| condition.holds(&view));
        while let Some(PlannedStep { step, .. }) = self.steps.get(progress.done) {
            progress.met.resize(step.conditions.len(), false);
            for (condition, met) in step.conditions.iter().zip(&mut progress.met) {
                let was = *met && condition.is_transient();
                *met = was || condition.holds(&view);
            }
            if progress.met.iter().filter(|met| **met).count() < step.needed {
                break;
            }
            progress.done += 1;
            progress.met.clear();
            // What happened counts for one step alone.
            view.pointed_at = None;
        }
        let at = self.leg_place(&view);
        if at != self.at {
            let planned = &self.steps[at.step].targets[at.target].legs[at.leg];
            self.leg = self.leg.with_goal(planned.goal.clone());
            self.progress.moved = None;
            if at.step != self.at.step {
                self.tried.clear();
            }
            // What was lost on the way is carried the other way round every second time.
            let before = LegPlace {
                leg: at.leg.wrapping_sub(1),
                ..at
            };
            let takes = self.tried.iter().filter(|tried| tried.at == before);
            if matches!(takes.count(), takes if takes > 0 && takes % 2 == 0) {
                self.leg.turn_the_other_way();
            }
            self.at = at;
            self.begin_leg();
        }
        self.follow_moved_thing(world, agent);
        self.progress.done - before
    }

    /// Leads to where the thing that is to be picked up lies now, where it was moved: it was put down elsewhere, or pushed.
    fn follow_moved_thing(&mut self, world: &World, agent: AgentId) {
        let LegPlace { step, target, leg } = self.at;
        let planned = &self.steps[step].targets[target].legs[leg];
        let LegEndAction::Hand(DiscreteAction::Pick, object) = planned.end else {
            return;
        };
        let known = self.progress.moved.as_ref().map(|moved| moved.lies_at);
        let known = known.or(planned.goal.told.position);
        if rest_state(world, object) != RestState::AtRest
            || known.is_some_and(|known| !was_moved(world, object, known))
        {
            return;
        }
        let lies_at = box_centre(world, object);
        let ground = LargestIslandIndex::of(self.leg.guide.grid());
        let cells = cells_in_reach(world, agent, &ground, object);
        self.lead_to_moved(MovedThing { lies_at, cells });
    }

    /// Leads to where a thing lies now.
    fn lead_to_moved(&mut self, moved: MovedThing) {
        if !moved.cells.is_empty() {
            let goal = NavigationGoal {
                cells: moved.cells.clone(),
                ..self.leg.goal.as_ref().clone()
            };
            self.leg = self.leg.with_goal(Arc::new(goal));
            self.begin_leg();
        }
        self.progress.moved = Some(moved);
    }

    /// Begins the leg, away from where the hand acted in vain.
    fn begin_leg(&mut self) {
        let tried = self.tried.iter().filter(|tried| tried.at == self.at);
        let tried: Vec<Vec3> = tried.map(|tried| tried.stood).collect();
        if !tried.is_empty() {
            self.leg.avoid_goals_near(&tried, ELSEWHERE_M);
        }
        (self.busy, self.rounds, self.turns_inwards) = (0, 0, 0);
    }

    /// The leg that is to be gone: of the first target of the plan that is not as it should be.
    fn leg_place(&self, view: &ConditionContext<'_>) -> LegPlace {
        let Some(planned) = self.steps.get(self.progress.done) else {
            return self.at;
        };
        let conditions = &planned.step.conditions;
        let is_met = |condition: StepCondition| {
            let number = conditions.iter().position(|own| *own == condition);
            number.is_some_and(|number| self.progress.met[number])
        };
        let targets = &planned.targets;
        let left = targets.iter().position(|target| !is_met(target.condition));
        let target = left.unwrap_or(targets.len() - 1);
        let legs = &targets[target].legs;
        let is_needed = |condition: &Option<StepCondition>| {
            condition.is_none_or(|condition| !condition.holds(view))
        };
        let leg = legs.iter().position(|leg| is_needed(&leg.unless));
        LegPlace {
            step: self.progress.done,
            target,
            leg: leg.unwrap_or(legs.len() - 1),
        }
    }

    /// The walkable way that is left, m.
    pub(super) fn distance_m(&self, world: &World) -> Option<f64> {
        if self.is_done() {
            return Some(0.0);
        }
        let LegPlace { step, target, leg } = self.at;
        Some(self.leg.guide.distance_m(world)? + self.later_m[step][target][leg])
    }

    /// Returns whether all is done, and still so, and nothing that was not to be done.
    pub(super) fn is_fulfilled(&self, world: &World, agent: AgentId) -> bool {
        if self.progress.is_broken || !self.is_done() {
            return false;
        }
        let scene = world.engines().semantics().scene(world.state());
        let view = ConditionContext {
            scene: &scene,
            rays: world.rays(),
            agent,
            pointed_at: None,
        };
        (0..self.steps.len()).all(|step| self.is_still_done(step, &view))
    }

    /// Returns whether a step that was done is as it should be at the end.
    fn is_still_done(&self, number: usize, view: &ConditionContext<'_>) -> bool {
        let step = &self.steps[number].step;
        let lasting = self.lasting(number, view);
        lasting == step.needed || (lasting > step.needed && !step.is_exact)
    }

    /// Of how many of its things a step that was done is as it should be at the end: of all that were needed, or more, where it is.
    fn lasting(&self, number: usize, view: &ConditionContext<'_>) -> usize {
        let step = &self.steps[number].step;
        let is_last = number + 1 == self.steps.len();
        if step.conditions[0].is_transient() {
            // Where the agent is and looks counts for the last step alone, and for one place: it cannot be at two.
            let lasts = is_last && step.conditions.len() == 1 && !step.conditions[0].is_event();
            return if !lasts || step.conditions[0].holds(view) {
                step.needed
            } else {
                0
            };
        }
        // Of things that a later step is about nothing is asked any more.
        let later = &self.steps[number + 1..];
        let is_undone = |condition: &StepCondition| {
            let object = condition.object();
            let changes = |planned: &PlannedStep| {
                let own = planned.step.conditions.iter();
                let mut own = own.filter(|condition| !condition.is_transient());
                own.any(|condition| condition.object() == object)
            };
            later.iter().any(changes)
        };
        let so = |condition: &&StepCondition| is_undone(condition) || condition.holds(view);
        step.conditions.iter().filter(so).count()
    }

    /// The action of the expert.
    pub(super) fn expert_action(&mut self, world: &World) -> DiscreteAction {
        if self.is_done() {
            return self.wait_for_rest(world);
        }
        if let Some(action) = self.doors.next_action(world) {
            return action;
        }
        let action = self.action_of_leg(world);
        self.doors.count(world, action);
        action
    }

    /// Ends once what it brought lies still.
    fn wait_for_rest(&mut self, world: &World) -> DiscreteAction {
        self.busy += 1;
        let moves = |object: ObjectId| rest_state(world, object) == RestState::Moving;
        let last = self.steps.last().map_or(&[][..], |last| &last.targets);
        let brought = last.iter().filter_map(|target| match target.condition {
            StepCondition::LeftIn(object, _) => Some(object),
            _ => None,
        });
        if self.busy < PATIENCE && brought.into_iter().any(moves) {
            DiscreteAction::Wait
        } else {
            DiscreteAction::Stop
        }
    }

    /// The action of the leg: the way, then the hand.
    fn action_of_leg(&mut self, world: &World) -> DiscreteAction {
        let LegPlace { step, target, leg } = self.at;
        let end = self.steps[step].targets[target].legs[leg].end;
        if let LegEndAction::Hand(DiscreteAction::Open, object) = end
            && self.busy > 0
        {
            self.busy += 1;
            if self.busy < OPENING {
                return self.leg.open(world, object);
            }
            return self.elsewhere(world, ELSEWHERE_M);
        }
        if self.busy > 0 {
            self.busy += 1;
            if self.busy < PATIENCE {
                return DiscreteAction::Wait;
            }
            return self.elsewhere(world, ELSEWHERE_M);
        }
        match end {
            LegEndAction::Arrive => {
                let step = self.leg.approach(world);
                step.unwrap_or_else(|| self.elsewhere(world, ELSEWHERE_M))
            }
            LegEndAction::Drop => {
                let step = self.leg.walk(world).or_else(|| self.turn_inwards(world));
                step.unwrap_or_else(|| self.act(world, DiscreteAction::Drop))
            }
            LegEndAction::Hand(action, object) => {
                if action == DiscreteAction::Pick {
                    self.leg.keep_goals_to_turn_at(world, object);
                }
                if let Some(step) = self.leg.walk(world) {
                    return step;
                }
                let look = self.leg.look_at(world, object);
                self.use_hand(world, look, (action, object, LookTarget::Anywhere))
            }
            LegEndAction::Above(action, object) => {
                if let Some(step) = self.leg.walk(world) {
                    return step;
                }
                let tried = self.tried.iter().filter(|tried| tried.at == self.at);
                let tried: Vec<Vec3> = tried.filter_map(|tried| tried.looked_at).collect();
                let look = self.leg.look_at_level_surface(world, object, &tried);
                self.use_hand(world, look, (action, object, LookTarget::LevelSurface))
            }
        }
    }

    /// The turn that brings more of the room ahead, into which what it carries falls; `None` once it is, and after a whole turn.
    fn turn_inwards(&mut self, world: &World) -> Option<DiscreteAction> {
        let LegPlace { step, target, .. } = self.at;
        let StepCondition::LeftIn(_, room) = self.steps[step].targets[target].condition else {
            return None;
        };
        let agent = world.state().agents.get(self.leg.guide.agent())?;
        let ahead = agent.position + DROP_M * forward_from_yaw(agent.yaw_rad) + 0.1 * Vec3::Y;
        let turns = (360.0 / self.leg.stride().turn_deg.max(1.0)).ceil() as u32;
        if world.house().room_at(ahead) == Some(room) || self.turns_inwards >= turns {
            return None;
        }
        self.turns_inwards += 1;
        Some(DiscreteAction::TurnLeft)
    }

    /// Looks where the hand is to act, then uses it; goes elsewhere where it cannot look there.
    fn use_hand(
        &mut self,
        world: &World,
        look: LookAction,
        (action, object, part): (DiscreteAction, ObjectId, LookTarget),
    ) -> DiscreteAction {
        match look {
            LookAction::Turn(step) => step,
            LookAction::Missed if self.leg.keep_goals_that_see(world, (object, part)) => {
                DiscreteAction::Wait
            }
            LookAction::Missed => self.elsewhere(world, BESIDE_M),
            LookAction::Done => self.act(world, action),
        }
    }

    /// Uses the hand here.
    fn act(&mut self, world: &World, action: DiscreteAction) -> DiscreteAction {
        self.busy = 1;
        if let Some(agent) = world.state().agents.get(self.leg.guide.agent()) {
            self.tried.push(TriedPlace {
                at: self.at,
                stood: agent.position,
                looked_at: point_in_view_centre(world, self.leg.guide.agent()),
            });
        }
        action
    }

    /// Goes on from another place; gives up where there is none.
    fn elsewhere(&mut self, world: &World, radius_m: f32) -> DiscreteAction {
        self.busy = 0;
        if self.leg.exclude_goals_within(world, radius_m) {
            return DiscreteAction::Wait;
        }
        if self.rounds < ROUNDS && self.leg.step_back(world, self.rounds) {
            self.rounds += 1;
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }

    /// What it keeps beside the world.
    pub(super) fn snapshot(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.progress).expect("plain data can always be written to memory")
    }

    /// Takes over what a snapshot keeps.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] for bytes that are none of this instruction.
    pub(super) fn restore(
        &mut self,
        world: &World,
        agent: AgentId,
        bytes: &[u8],
    ) -> Result<(), WorldError> {
        let grid = self.leg.guide.grid().clone();
        let is_of_this = |progress: &StepProgress| {
            let conditions = self.steps.get(progress.done);
            let conditions = conditions.map_or(0, |own| own.step.conditions.len());
            let moved = progress.moved.iter();
            progress.done <= self.steps.len()
                && [0, conditions].contains(&progress.met.len())
                && moved
                    .flat_map(|moved| &moved.cells)
                    .all(|cell| grid.is_walkable(*cell))
        };
        let read = postcard::from_bytes::<StepProgress>(bytes).ok();
        let Some(progress) = read.filter(is_of_this) else {
            return Err(WorldError::Snapshot(
                "what is done of its instruction is of another one".to_owned(),
            ));
        };
        let moved = progress.moved.clone();
        self.progress = progress;
        self.advance(world, agent, None);
        if let Some(moved) = moved {
            self.lead_to_moved(moved);
        }
        Ok(())
    }
}

/// The walkable way from the end of each leg to the end of the last one, m: from the nearest cell of one goal to the next goal.
fn later_distances(steps: &[PlannedStep], grid: &NavGrid) -> Vec<Vec<Vec<f64>>> {
    let mut later_m: Vec<Vec<Vec<f64>>> = steps
        .iter()
        .map(|step| {
            step.targets
                .iter()
                .map(|own| vec![0.0; own.legs.len()])
                .collect()
        })
        .collect();
    let mut after_m = 0.0;
    let mut next: Option<&NavigationGoal> = None;
    for (step, planned) in steps.iter().enumerate().rev() {
        for (target, own) in planned.targets.iter().enumerate().rev() {
            for (leg, planned) in own.legs.iter().enumerate().rev() {
                if let Some(next) = next {
                    after_m += geodesic_between_m(&planned.goal, next, grid);
                }
                later_m[step][target][leg] = after_m;
                next = Some(&planned.goal);
            }
        }
    }
    later_m
}

/// The walkable way from the nearest cell of a goal to another goal, m; 0 where there is none.
pub(super) fn geodesic_between_m(
    from: &NavigationGoal,
    to: &NavigationGoal,
    grid: &NavGrid,
) -> f64 {
    let field = grid.distance_field(&to.cells);
    let ways = from.cells.iter().filter_map(|cell| field.at(*cell));
    let shortest = ways.fold(f64::INFINITY, f64::min);
    if shortest.is_finite() { shortest } else { 0.0 }
}
