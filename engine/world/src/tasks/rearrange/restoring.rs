//! The expert: it fetches one misplaced thing after the other and puts it where it was, furniture first.

use super::energy::{ThingGoal, TrackedThing};
use crate::actions::{DiscreteAction, StepSizes};
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::cells_in_reach;
use crate::tasks::relocation::{Carrier, Errand, HandMover, MovableThing};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{Aabb, AgentId, ObjectId, Pose};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Share of the reach at which a place is reached from all over a cell.
const REACH_SHARE: f32 = 0.9;

/// The place of a thing before it was moved.
#[derive(Clone, Debug)]
pub(super) struct PlaceToRestore {
    /// Of the thing's first part.
    pub(super) world_from_part: Pose,
    /// The middle of the box around it there, m.
    middle: Vec3,
    /// From where a hand reaches it.
    cells: Vec<NavCell>,
}

impl PlaceToRestore {
    /// The place of a thing that had a box and a pose there.
    pub(super) fn new(
        mover: &HandMover<'_>,
        thing: &MovableThing,
        (bounds, world_from_part): (Aabb, Pose),
    ) -> Self {
        let middle = bounds.center();
        let foot = middle.with_y(bounds.min.y);
        let reach_m = REACH_SHARE * mover.body.reach_m;
        let reaches = |cell: &&NavCell| {
            let feet = mover.ground.grid.position(**cell);
            (feet + Vec3::Y * mover.body.eye_height_m).distance(foot) <= reach_m
        };
        let near: Vec<NavCell> = thing.cells.iter().filter(reaches).copied().collect();
        Self {
            world_from_part,
            middle,
            cells: if near.is_empty() {
                thing.cells.clone()
            } else {
                near
            },
        }
    }
}

/// The expert of an episode.
#[derive(Debug)]
pub(super) struct Restoring {
    agent: AgentId,
    grid: Arc<NavGrid>,
    stride: StepSizes,
    places: BTreeMap<ObjectId, PlaceToRestore>,
    /// Where a hand reaches furniture.
    openable: BTreeMap<ObjectId, Vec<NavCell>>,
    carrier: Option<Carrier>,
    /// What it has given up.
    left: BTreeSet<ObjectId>,
}

impl Restoring {
    pub(super) fn new(
        (agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes),
        places: BTreeMap<ObjectId, PlaceToRestore>,
        openable: BTreeMap<ObjectId, Vec<NavCell>>,
    ) -> Self {
        Self {
            agent,
            grid: grid.clone(),
            stride,
            places,
            openable,
            carrier: None,
            left: BTreeSet::new(),
        }
    }

    /// The next action while some things are misplaced.
    pub(super) fn next(&mut self, world: &World, misplaced: &[&TrackedThing]) -> DiscreteAction {
        let held = world.state().agents.get(self.agent).and_then(|agent| agent.holding);
        let is_misplaced = |object: ObjectId| misplaced.iter().any(|thing| thing.object == object);
        if let Some(carrier) = &self.carrier {
            let is_over = match carrier.errand {
                Errand::Take(object) => held == Some(object) || !is_misplaced(object),
                Errand::Put(object, _) => held != Some(object),
                Errand::Open(object) | Errand::Close(object) => !is_misplaced(object),
            };
            if is_over {
                self.carrier = None;
            }
        }
        // Each round begins an errand or gives a thing up.
        for _ in 0..=misplaced.len() + 1 {
            if self.carrier.is_none() {
                self.carrier = self.begin(world, held, misplaced);
            }
            let Some(carrier) = &mut self.carrier else {
                break;
            };
            if let Some(action) = carrier.next(world) {
                return action;
            }
            let (Errand::Take(object)
            | Errand::Put(object, _)
            | Errand::Open(object)
            | Errand::Close(object)) = carrier.errand;
            self.left.insert(object);
            self.carrier = None;
        }
        if held.is_some_and(|object| self.left.contains(&object)) {
            return DiscreteAction::Drop;
        }
        DiscreteAction::Stop
    }

    /// The next errand; `None` where there is none.
    fn begin(
        &mut self,
        world: &World,
        held: Option<ObjectId>,
        misplaced: &[&TrackedThing],
    ) -> Option<Carrier> {
        let setup = |errand, cells| {
            let setup = (self.agent, &self.grid, self.stride);
            Some(Carrier::new(errand, cells, setup))
        };
        if let Some(object) = held {
            if self.left.contains(&object) {
                return None;
            }
            let place = self.places.get(&object)?;
            return setup(Errand::Put(object, place.middle), place.cells.clone());
        }
        let here = world.state().agents.get(self.agent)?.position;
        let here = self.grid.nearest(here, 0.6)?;
        let ways = self.grid.distance_field(&[here]);
        let ground = LargestIslandIndex::of(&self.grid);
        let mut best: Option<((bool, f64), Errand, Vec<NavCell>)> = None;
        for thing in misplaced {
            let object = thing.object;
            if self.left.contains(&object) {
                continue;
            }
            let (errand, cells) = match thing.goal {
                ThingGoal::Pose { .. } if self.places.contains_key(&object) => {
                    let cells = cells_in_reach(world, self.agent, &ground, object);
                    (Errand::Take(object), cells)
                }
                ThingGoal::Pose { .. } => continue,
                ThingGoal::Openness(goal) => {
                    let cells = self.openable.get(&object).cloned().unwrap_or_default();
                    let errand = if goal > 0.5 {
                        Errand::Open(object)
                    } else {
                        Errand::Close(object)
                    };
                    (errand, cells)
                }
            };
            let way_m = cells.iter().filter_map(|cell| ways.at(*cell));
            let way_m = way_m.fold(f64::INFINITY, f64::min);
            if !way_m.is_finite() {
                continue;
            }
            // What stands open may hide a place, or bar the way.
            let rank = (matches!(errand, Errand::Take(_)), way_m);
            if best.as_ref().is_none_or(|(other, ..)| rank < *other) {
                best = Some((rank, errand, cells));
            }
        }
        let (_, errand, cells) = best?;
        setup(errand, cells)
    }
}
