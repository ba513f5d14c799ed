//! Steps with the ways on which they are carried out.

use super::active_instruction::geodesic_between_m;
use crate::actions::DiscreteAction;
use crate::tasks::navigation::NavigationGoal;
use dwell_scene::ObjectId;
use dwell_scene::navigation::NavGrid;
use dwell_semantics::instruct::{InstructionStep, StepCondition};
use std::sync::Arc;

/// What the expert does where a leg ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LegEndAction {
    /// Nothing: to stand there and to look is enough.
    Arrive,
    /// An action of the hand on a thing that it looks at.
    Hand(DiscreteAction, ObjectId),
    /// An action of the hand on a thing that it looks down on: its level surface.
    Above(DiscreteAction, ObjectId),
    /// Let go of what it holds.
    Drop,
}

/// A way of a step, and what is done at its end.
#[derive(Clone, Debug)]
pub(super) struct PlannedLeg {
    pub(super) goal: Arc<NavigationGoal>,
    pub(super) end: LegEndAction,
    /// What makes it unnecessary: a thing that is held already need not be picked up.
    pub(super) unless: Option<StepCondition>,
}

/// A thing, room or place of a step, with the legs that bring its condition about.
#[derive(Clone, Debug)]
pub(super) struct StepTarget {
    pub(super) condition: StepCondition,
    pub(super) legs: Vec<PlannedLeg>,
}

impl StepTarget {
    /// The walkable way from where the thing is picked up, m; 0 where it is not taken elsewhere.
    fn transport_m(&self, grid: &NavGrid) -> f64 {
        let picks =
            |leg: &&PlannedLeg| matches!(leg.end, LegEndAction::Hand(DiscreteAction::Pick, _));
        let before = self.legs.iter().take_while(|leg| !picks(leg)).count();
        let carried = self.legs.get(before..).unwrap_or_default();
        let ways_m = carried
            .windows(2)
            .map(|pair| geodesic_between_m(&pair[0].goal, &pair[1].goal, grid));
        ways_m.sum()
    }
}

/// A step that can be played in the house, and how: of as many things as are needed, in the order of the plan.
#[derive(Clone, Debug)]
pub(super) struct PlannedStep {
    pub(super) step: InstructionStep,
    pub(super) targets: Vec<StepTarget>,
}

impl PlannedStep {
    /// Returns whether it leaves a thing in the hand.
    pub(super) fn leaves_object_held(&self) -> bool {
        let held = |target: &StepTarget| matches!(target.condition, StepCondition::Held(_));
        self.targets.iter().any(held)
    }

    /// The longest walkable way on which a thing is carried, m; 0 where nothing is.
    pub(super) fn transport_m(&self, grid: &NavGrid) -> f64 {
        let ways_m = self.targets.iter().map(|target| target.transport_m(grid));
        ways_m.fold(0.0, f64::max)
    }

    /// Returns whether it is about a thing.
    pub(super) fn is_about(&self, object: ObjectId) -> bool {
        let mut conditions = self.step.conditions.iter();
        conditions.any(|condition| condition.objects().contains(&object))
    }
}
