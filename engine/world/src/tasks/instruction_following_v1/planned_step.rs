//! Steps with the ways on which they are carried out.

use crate::actions::DiscreteAction;
use crate::tasks::navigation::NavigationGoal;
use dwell_scene::ObjectId;
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

    /// Returns whether it is about a thing.
    pub(super) fn is_about(&self, object: ObjectId) -> bool {
        let mut conditions = self.step.conditions.iter();
        conditions.any(|condition| condition.objects().contains(&object))
    }
}
