//! Where the steps of instructions are carried out, and which can be.

use super::active_instruction::{EndOfLeg, PlannedLeg, StepOffer};
use crate::actions::DiscreteAction;
use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::{NavigationGoal, SuccessRule, cells_in_reach, cells_that_reach};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentBody, AgentId, ObjectId, RoomId};
use dwell_semantics::instruct::{InstructionGoal, InstructionStep, StepCondition, StepKind};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Cells from which a thing must be reached: from fewer, a view that turns by steps may miss it everywhere.
const LEAST_CELLS: usize = 6;

/// The places that steps lead to, found when they are asked for.
pub(super) struct StepPlaces<'a> {
    world: &'a World,
    agent: AgentId,
    body: AgentBody,
    ground: LargestIslandIndex<'a>,
    in_reach: RefCell<BTreeMap<ObjectId, Arc<NavigationGoal>>>,
    found: RefCell<BTreeMap<ObjectId, Arc<NavigationGoal>>>,
    rooms: RefCell<BTreeMap<RoomId, Arc<NavigationGoal>>>,
}

fn goal(cells: Vec<NavCell>, asked: InstructionGoal) -> Arc<NavigationGoal> {
    Arc::new(NavigationGoal {
        cells,
        success: SuccessRule::Fulfilled(asked),
        told: EpisodeGoal::default(),
        instruction: None,
    })
}

impl<'a> StepPlaces<'a> {
    pub(super) fn new(
        world: &'a World,
        agent: AgentId,
        body: AgentBody,
        grid: &'a NavGrid,
    ) -> Self {
        Self {
            world,
            agent,
            body,
            ground: LargestIslandIndex::of(grid),
            in_reach: RefCell::default(),
            found: RefCell::default(),
            rooms: RefCell::default(),
        }
    }

    /// Where a hand reaches a thing that the agent looks at.
    fn in_reach(&self, object: ObjectId) -> Arc<NavigationGoal> {
        let mut known = self.in_reach.borrow_mut();
        let make = || {
            let cells = cells_in_reach(self.world, self.agent, &self.ground, object);
            goal(
                cells,
                InstructionGoal::objects(vec![object], self.body.reach_m),
            )
        };
        known.entry(object).or_insert_with(make).clone()
    }

    /// Where a thing is found.
    fn found(&self, object: ObjectId) -> Arc<NavigationGoal> {
        let mut known = self.found.borrow_mut();
        let make = || {
            let asked = StepCondition::found_goal(object);
            goal(
                cells_that_reach(self.world, self.agent, &self.ground, &asked),
                asked,
            )
        };
        known.entry(object).or_insert_with(make).clone()
    }

    fn room(&self, room: RoomId) -> Arc<NavigationGoal> {
        let mut known = self.rooms.borrow_mut();
        let make = || {
            let cells = self.ground.cells_in_rooms(self.world.house(), &[room]);
            goal(cells, InstructionGoal::rooms(vec![room]))
        };
        known.entry(room).or_insert_with(make).clone()
    }

    /// Returns whether the agent can do what a kind of step asks of a thing.
    pub(super) fn is_possible(&self, kind: StepKind, object: ObjectId) -> bool {
        match kind {
            StepKind::GoToRoom => false,
            StepKind::FindObject => !self.found(object).cells.is_empty(),
            StepKind::PickUp | StepKind::Bring => {
                let (house, state) = (self.world.house(), self.world.state());
                let size = house.object_bounds(state, object).size().max_element();
                let part = house.objects[object].first_part;
                let mass_kg = self.world.physics.body_mass_kg(part);
                size <= self.body.max_carry_size_m
                    && mass_kg.is_some_and(|mass_kg| mass_kg <= self.body.lift_kg)
                    && self.in_reach(object).cells.len() >= LEAST_CELLS
            }
            StepKind::Open | StepKind::Close | StepKind::SwitchOn | StepKind::SwitchOff => {
                self.in_reach(object).cells.len() >= LEAST_CELLS
            }
        }
    }

    /// How a step is played; `None` where nobody gets there.
    pub(super) fn offer(&self, step: InstructionStep) -> Option<StepOffer> {
        let hand = |action, object| PlannedLeg {
            goal: self.in_reach(object),
            end: EndOfLeg::Hand(action, object),
        };
        let legs = match step.condition {
            StepCondition::AgentIn(room) => vec![PlannedLeg {
                goal: self.room(room),
                end: EndOfLeg::Arrive,
            }],
            StepCondition::Found(object) => vec![PlannedLeg {
                goal: self.found(object),
                end: EndOfLeg::Arrive,
            }],
            StepCondition::Held(object) => vec![hand(DiscreteAction::Pick, object)],
            StepCondition::Open(object) => vec![hand(DiscreteAction::Open, object)],
            StepCondition::Closed(object) => vec![hand(DiscreteAction::Close, object)],
            StepCondition::SwitchedOn(object) | StepCondition::SwitchedOff(object) => {
                vec![hand(DiscreteAction::Toggle, object)]
            }
            StepCondition::LeftIn(object, room) => vec![
                hand(DiscreteAction::Pick, object),
                PlannedLeg {
                    goal: self.room(room),
                    end: EndOfLeg::Drop,
                },
            ],
        };
        let reachable = legs.iter().all(|leg| !leg.goal.cells.is_empty());
        reachable.then_some(StepOffer { step, legs })
    }
}
