//! An expert that fetches things, puts them where it is told, and opens and closes furniture.

use super::movable_things::cells_goal;
use crate::actions::{DiscreteAction, StepSizes};
use crate::expert::{LookAction, LookTarget};
use crate::tasks::navigation::{BESIDE_M, ELSEWHERE_M, Leg};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentId, ObjectId};
use glam::Vec3;
use std::sync::Arc;

/// Control steps for which it waits for furniture to close, and for a thing to be in its hand.
const PATIENCE: u32 = 60;
const GRASPING: u32 = 3;
/// Places from which it tries to take a thing or put it down before it gives up: something may lie there.
const REFUSALS: u32 = 8;
/// From where its hand acted in vain it does not try again, m: what is in the way there is in the way beside, too.
const REFUSED_M: f32 = 0.4;
/// Control steps for which it turns to a point.
const FACING: u32 = 40;
/// Control steps for which it keeps opening or closing.
const SWINGING: u32 = 240;
/// Distance of what it looks at from the point where it puts something down, in the first round, m.
const AROUND_M: f32 = 0.4;
/// How often it tries all places of an errand again.
const ROUNDS: u32 = 2;

/// Something to do at the end of a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Manipulation {
    /// Take a thing.
    Take(ObjectId),
    /// Put what is held down, looking at a point.
    Put(ObjectId, Vec3),
    /// Open furniture.
    Open(ObjectId),
    /// Close furniture.
    Close(ObjectId),
}

/// An errand that is under way.
#[derive(Debug)]
pub(super) struct OngoingManipulation {
    pub(super) errand: Manipulation,
    leg: Leg,
    /// True if it puts things down only where the middle of the view is on a level surface at the height of the point.
    by_view: bool,
    /// Control steps for which its hand has been busy.
    busy: u32,
    /// How often its hand acted in vain.
    refused: u32,
    /// Control steps for which it has been turning to where it puts something.
    facing: u32,
    rounds: u32,
}

impl OngoingManipulation {
    /// Begins an errand that is done from one of some cells.
    pub(super) fn new(
        errand: Manipulation,
        cells: Vec<NavCell>,
        (agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes),
    ) -> Self {
        Self {
            errand,
            leg: Leg::new(agent, grid.clone(), cells_goal(cells, 0.0), stride),
            by_view: false,
            busy: 0,
            refused: 0,
            facing: 0,
            rounds: 0,
        }
    }

    /// The next action; `None` where it gives up.
    pub(super) fn next_action(&mut self, world: &World) -> Option<DiscreteAction> {
        match self.errand {
            Manipulation::Take(object) => {
                if self.busy > 0 {
                    self.busy += 1;
                    if self.busy < GRASPING {
                        return Some(DiscreteAction::Wait);
                    }
                    // It was just out of reach, or something was in the way.
                    return self.refused(world);
                }
                self.leg.keep_goals_to_turn_at(world, object);
                if let Some(step) = self.leg.walk(world) {
                    return Some(step);
                }
                match self.leg.look_at(world, object) {
                    LookAction::Turn(step) => Some(step),
                    LookAction::Missed => self.missed(world, object),
                    LookAction::Done => {
                        self.busy = 1;
                        Some(DiscreteAction::Pick)
                    }
                }
            }
            Manipulation::Put(_, point) => {
                if self.busy > 0 {
                    // It is done at once, or not at all.
                    return self.refused(world);
                }
                if let Some(step) = self.leg.walk(world) {
                    self.facing = 0;
                    return Some(step);
                }
                self.facing += 1;
                if self.by_view {
                    // At first where it was, then on what is around.
                    let around_m = AROUND_M * (1 + self.rounds) as f32;
                    match self.leg.look_at_surface(world, point, around_m) {
                        LookAction::Turn(step) if self.facing < FACING => return Some(step),
                        LookAction::Done => {}
                        _ => return self.elsewhere(world, BESIDE_M),
                    }
                } else {
                    // A point that is almost straight below is never quite ahead.
                    let turning = self.leg.face(world, point);
                    if let Some(step) = turning.filter(|_| self.facing < FACING) {
                        return Some(step);
                    }
                }
                self.busy = 1;
                Some(DiscreteAction::Place)
            }
            Manipulation::Open(object) => {
                if self.busy > 0 {
                    self.busy += 1;
                    if self.busy < SWINGING {
                        return Some(self.leg.open(world, object));
                    }
                    return self.elsewhere(world, ELSEWHERE_M);
                }
                self.look_and_use(world, object, DiscreteAction::Open)
            }
            Manipulation::Close(object) => {
                if self.busy > 0 {
                    return self.wait(world, PATIENCE);
                }
                self.look_and_use(world, object, DiscreteAction::Close)
            }
        }
    }

    /// The same errand, on whose way it turns to the other side first.
    pub(super) fn turning_the_other_way(mut self) -> Self {
        self.leg.turn_the_other_way();
        self
    }

    /// An errand of an agent whose `place` goes by its view alone.
    pub(super) fn placing_by_view(self) -> Self {
        Self {
            by_view: true,
            ..self
        }
    }

    fn look_and_use(
        &mut self,
        world: &World,
        object: ObjectId,
        action: DiscreteAction,
    ) -> Option<DiscreteAction> {
        if let Some(step) = self.leg.walk(world) {
            return Some(step);
        }
        match self.leg.look_at(world, object) {
            LookAction::Turn(step) => Some(step),
            LookAction::Missed => self.missed(world, object),
            LookAction::Done => {
                self.busy = 1;
                Some(action)
            }
        }
    }

    fn wait(&mut self, world: &World, longest: u32) -> Option<DiscreteAction> {
        self.busy += 1;
        if self.busy < longest {
            return Some(DiscreteAction::Wait);
        }
        self.elsewhere(world, ELSEWHERE_M)
    }

    /// Goes on from another place after steps of the view did not meet a thing.
    fn missed(&mut self, world: &World, object: ObjectId) -> Option<DiscreteAction> {
        let at = (object, LookTarget::Anywhere);
        if self.leg.keep_goals_that_see(world, at) {
            return Some(DiscreteAction::Wait);
        }
        self.elsewhere(world, BESIDE_M)
    }

    /// Goes on from another place after the hand acted in vain.
    fn refused(&mut self, world: &World) -> Option<DiscreteAction> {
        self.refused += 1;
        if self.refused >= REFUSALS {
            return None;
        }
        self.elsewhere(world, REFUSED_M)
    }

    /// Goes on from another place.
    fn elsewhere(&mut self, world: &World, radius_m: f32) -> Option<DiscreteAction> {
        self.busy = 0;
        if self.leg.exclude_goals_within(world, radius_m) {
            return Some(DiscreteAction::Wait);
        }
        if self.rounds < ROUNDS && self.leg.step_back(world, self.rounds) {
            self.rounds += 1;
            return Some(DiscreteAction::Wait);
        }
        None
    }
}
