//! The instruction of an episode: what is done of it, and what the expert does next.

use crate::actions::{DiscreteAction, StepSizes};
use crate::expert::LookStep;
use crate::tasks::navigation::{BESIDE_M, ELSEWHERE_M, Leg, NavigationGoal};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentId, ObjectId};
use dwell_semantics::instruct::{InstructionStep, StepCondition};
use std::sync::Arc;

/// Control steps for which the expert waits for what its hand has begun.
const PATIENCE: u32 = 60;
/// How often the expert tries all places of a leg again.
const ROUNDS: u32 = 2;
/// Control steps for which it keeps opening a thing.
const OPENING: u32 = 240;

/// What the expert does where a leg ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EndOfLeg {
    /// Nothing: to stand there and to look is enough.
    Arrive,
    /// An action of the hand on a thing that it looks at.
    Hand(DiscreteAction, ObjectId),
    /// Let go of what it holds.
    Drop,
}

/// A way of a step, and what is done at its end.
#[derive(Clone, Debug)]
pub(super) struct PlannedLeg {
    pub(super) goal: Arc<NavigationGoal>,
    pub(super) end: EndOfLeg,
}

/// A step that can be played in the house, and how.
#[derive(Clone, Debug)]
pub(super) struct StepOffer {
    pub(super) step: InstructionStep,
    pub(super) legs: Vec<PlannedLeg>,
}

/// The instruction of the episode that is played.
#[derive(Debug)]
pub(super) struct ActiveInstruction {
    pub(super) steps: Vec<StepOffer>,
    /// Steps that are done, in order.
    pub(super) done: usize,
    /// The leg that is gone, by step and its place in the step.
    at: (usize, usize),
    leg: Leg,
    /// The walkable way from the end of each leg to the end of the last one, m. Shape (step, leg).
    later_m: Vec<Vec<f64>>,
    /// Control steps for which the expert has been busy with its hand.
    busy: u32,
    /// How often it has tried all places of the leg in vain.
    rounds: u32,
}

impl ActiveInstruction {
    /// Begins with the first leg of the first step.
    pub(super) fn new(
        steps: Vec<StepOffer>,
        (agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes),
    ) -> Self {
        let first = steps[0].legs[0].goal.clone();
        Self {
            later_m: later_distances(&steps, grid),
            leg: Leg::new(agent, grid.clone(), first, stride),
            steps,
            done: 0,
            at: (0, 0),
            busy: 0,
            rounds: 0,
        }
    }

    /// The straight distance of a cell to the nearest place of the first leg, and the walkable way from there on, m.
    pub(super) fn straight_from(&self, cell: NavCell) -> f64 {
        self.leg.straight_m(cell) + self.later_m[0][0]
    }

    /// The walkable way of the whole instruction from a cell, m.
    pub(super) fn way_from(&self, cell: NavCell) -> Option<f64> {
        Some(self.leg.guide.distance_at(cell)? + self.later_m[0][0])
    }

    fn condition(&self, step: usize) -> StepCondition {
        self.steps[step].step.condition
    }

    /// Counts the steps that are done; returns how many became so.
    pub(super) fn advance(&mut self, world: &World, agent: AgentId) -> usize {
        let before = self.done;
        let scene = world.engines().semantics().scene(world.state());
        while self.done < self.steps.len()
            && self.condition(self.done).holds(&scene, world.rays(), agent)
        {
            self.done += 1;
        }
        let step = self.done.min(self.steps.len() - 1);
        let legs = self.steps[step].legs.len();
        // What is brought is carried once it is held.
        let object = self.condition(step).object();
        let carries = object
            .is_some_and(|object| StepCondition::Held(object).holds(&scene, world.rays(), agent));
        let at = (step, if carries { legs - 1 } else { 0 });
        if at != self.at {
            let goal = self.steps[at.0].legs[at.1].goal.clone();
            self.leg = self.leg.to(goal);
            (self.at, self.busy, self.rounds) = (at, 0, 0);
        }
        self.done - before
    }

    /// The walkable way that is left, m.
    pub(super) fn distance_m(&self, world: &World) -> Option<f64> {
        if self.done == self.steps.len() {
            return Some(0.0);
        }
        Some(self.leg.guide.distance_m(world)? + self.later_m[self.at.0][self.at.1])
    }

    /// Returns whether all is done, and still so.
    pub(super) fn is_fulfilled(&self, world: &World, agent: AgentId) -> bool {
        let scene = world.engines().semantics().scene(world.state());
        let last = self.steps.len() - 1;
        let still = |step: usize| {
            let condition = self.condition(step);
            let undone = (step + 1..=last).any(|later| {
                let later = self.condition(later);
                !later.is_passing() && later.object() == condition.object()
            });
            let counts = step == last || !(condition.is_passing() || undone);
            !counts || condition.holds(&scene, world.rays(), agent)
        };
        self.done == self.steps.len() && (0..=last).all(still)
    }

    /// The action of the expert: the way, then the hand.
    pub(super) fn expert(&mut self, world: &World) -> DiscreteAction {
        if self.done == self.steps.len() {
            return DiscreteAction::Stop;
        }
        let end = self.steps[self.at.0].legs[self.at.1].end;
        if let EndOfLeg::Hand(DiscreteAction::Open, object) = end
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
            EndOfLeg::Arrive => {
                let step = self.leg.approach(world);
                step.unwrap_or_else(|| self.elsewhere(world, ELSEWHERE_M))
            }
            EndOfLeg::Drop => self.leg.walk(world).unwrap_or_else(|| {
                self.busy = 1;
                DiscreteAction::Drop
            }),
            EndOfLeg::Hand(action, object) => {
                if let Some(step) = self.leg.walk(world) {
                    return step;
                }
                match self.leg.look_at(world, object) {
                    LookStep::Turn(step) => step,
                    LookStep::Missed => self.elsewhere(world, BESIDE_M),
                    LookStep::Done => {
                        self.busy = 1;
                        action
                    }
                }
            }
        }
    }

    /// Goes on from another place; gives up where there is none.
    fn elsewhere(&mut self, world: &World, radius_m: f32) -> DiscreteAction {
        self.busy = 0;
        if self.leg.leave_out_goals_here(world, radius_m) {
            return DiscreteAction::Wait;
        }
        // It stands elsewhere in a cell when it comes again.
        if self.rounds < ROUNDS {
            self.rounds += 1;
            self.leg.try_all_goals_again();
            if self.leg.leave_out_goals_here(world, radius_m) {
                return DiscreteAction::Wait;
            }
        }
        DiscreteAction::Stop
    }
}

/// The walkable way from the end of each leg to the end of the last one, m: from the nearest cell of one goal to the next goal.
fn later_distances(steps: &[StepOffer], grid: &NavGrid) -> Vec<Vec<f64>> {
    let mut later_m: Vec<Vec<f64>> = Vec::new();
    let mut after_m = 0.0;
    let mut next: Option<&NavigationGoal> = None;
    for offer in steps.iter().rev() {
        let mut of_step = Vec::new();
        for planned in offer.legs.iter().rev() {
            if let Some(next) = next {
                let field = grid.distance_field(&next.cells);
                let ways = planned.goal.cells.iter();
                let ways = ways.filter_map(|cell| field.at(*cell));
                let shortest = ways.fold(f64::INFINITY, f64::min);
                after_m += if shortest.is_finite() { shortest } else { 0.0 };
            }
            of_step.insert(0, after_m);
            next = Some(&planned.goal);
        }
        later_m.insert(0, of_step);
    }
    later_m
}
