//! The expert: it brings one thing after the other to where it is to be, furniture first.

use super::MovableThing;
use super::manipulation::{Manipulation, OngoingManipulation};
use crate::actions::{DiscreteAction, StepSizes};
use crate::expert::BlockedDoors;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::moved_things::{RestState, box_centre, rest_state, was_moved};
use crate::tasks::navigation::{cells_in_reach, cells_in_reach_fraction};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{Aabb, AgentId, ObjectId, Pose};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// How often it takes a thing.
const TAKES: u32 = 6;
/// Share of the reach at which it takes what is reached from nowhere nearer, as flat things on the floor.
const FAR_SHARE: f32 = 0.97;
/// Control steps for which it carries a thing; then it is stuck, and takes it anew.
const CARRYING: u32 = 500;
/// From where it put a thing down in vain it does not try again, m.
const ELSEWHERE_M: f32 = 0.25;

/// Control steps for which it waits for a thing that it is to take to lie still.
const SETTLING: u32 = 60;

/// Around the box of furniture what stands in it may reach out, m.
const NEAR_M: f32 = 0.05;

/// The order of errands, the least first: whether it was put off, or has to wait for others; whether it takes something, and the
/// way there, m.
type ErrandRank = (u8, bool, f64);

/// The place of a thing before it was moved.
#[derive(Clone, Debug)]
pub(in crate::tasks) struct OriginalPlace {
    /// Of the thing's first part.
    pub(in crate::tasks) world_from_part: Pose,
    /// The middle of the lower side of the box around it there, m.
    foot: Vec3,
    /// From where a hand reaches it.
    cells: Vec<NavCell>,
}

impl OriginalPlace {
    /// The place of a thing that had a box and a pose there.
    pub(in crate::tasks) fn new(
        thing: &MovableThing,
        (bounds, world_from_part): (Aabb, Pose),
    ) -> Self {
        Self {
            world_from_part,
            foot: bounds.center().with_y(bounds.min.y),
            cells: thing.cells.clone(),
        }
    }

    /// The middle of the lower side of the thing's box there, m.
    pub(in crate::tasks) fn foot(&self) -> Vec3 {
        self.foot
    }
}

/// What is not as it is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tasks) enum Misplacement {
    /// A thing that lies elsewhere.
    Thing(ObjectId),
    /// Furniture that is to be closed, or with `true` opened.
    Furniture(ObjectId, bool),
}

impl Misplacement {
    fn object(self) -> ObjectId {
        match self {
            Self::Thing(object) | Self::Furniture(object, _) => object,
        }
    }
}

/// The expert of an episode.
#[derive(Debug)]
pub(in crate::tasks) struct RestoreExpert {
    agent: AgentId,
    grid: Arc<NavGrid>,
    stride: StepSizes,
    places: BTreeMap<ObjectId, OriginalPlace>,
    /// Other places that are as right for a thing, the last first.
    spare_places: BTreeMap<ObjectId, Vec<OriginalPlace>>,
    /// Where a hand reaches furniture.
    furniture: BTreeMap<ObjectId, Vec<NavCell>>,
    /// True if what is held is put where the view has a level surface, and not where it belongs.
    by_view: bool,
    carrier: Option<OngoingManipulation>,
    /// The middle of the box of what it goes to take, as it lay when it began.
    lies_at: Vec3,
    /// Control steps for which it has been carrying, and waiting for things to lie still.
    carrying: u32,
    settling: u32,
    doors: BlockedDoors,
    takes: BTreeMap<ObjectId, u32>,
    /// What it brings back after all else.
    postponed: BTreeSet<ObjectId>,
    /// What it has given up.
    left: BTreeSet<ObjectId>,
}

impl RestoreExpert {
    pub(in crate::tasks) fn new(
        (agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes),
        places: BTreeMap<ObjectId, OriginalPlace>,
        furniture: BTreeMap<ObjectId, Vec<NavCell>>,
    ) -> Self {
        Self {
            agent,
            grid: grid.clone(),
            stride,
            places,
            spare_places: BTreeMap::new(),
            furniture,
            by_view: false,
            carrier: None,
            lies_at: Vec3::ZERO,
            carrying: 0,
            settling: 0,
            doors: BlockedDoors::new((agent, grid, stride)),
            takes: BTreeMap::new(),
            postponed: BTreeSet::new(),
            left: BTreeSet::new(),
        }
    }

    /// The expert of an agent whose `place` goes by its view alone.
    pub(in crate::tasks) fn placing_by_view(self) -> Self {
        Self {
            by_view: true,
            ..self
        }
    }

    /// The expert of an agent that may put things elsewhere, too: where it gives up a place, the last of these is next.
    pub(in crate::tasks) fn with_spare_places(
        self,
        spare_places: BTreeMap<ObjectId, Vec<OriginalPlace>>,
    ) -> Self {
        Self {
            spare_places,
            ..self
        }
    }

    /// Goes on with another place for a thing; `false` where there is none.
    fn use_spare_place(&mut self, object: ObjectId) -> bool {
        let spare = self.spare_places.get_mut(&object).and_then(Vec::pop);
        match spare {
            Some(place) => {
                self.places.insert(object, place);
                self.takes.remove(&object);
                true
            }
            None => false,
        }
    }

    /// The next action while some things are misplaced.
    pub(in crate::tasks) fn next_action(
        &mut self,
        world: &World,
        misplaced: &[Misplacement],
    ) -> DiscreteAction {
        let holder = world.state().agents.get(self.agent);
        let held = holder.and_then(|agent| agent.holding);
        if let Some(action) = self.doors.next_action(world) {
            if action == DiscreteAction::Drop {
                self.carrier = None;
            }
            return action;
        }
        self.carrying = if held.is_some() { self.carrying + 1 } else { 0 };
        if self.carrying > CARRYING {
            self.carrier = None;
            held.map(|object| self.use_spare_place(object));
            return DiscreteAction::Drop;
        }
        let is_misplaced = |object: ObjectId| misplaced.iter().any(|one| one.object() == object);
        if let Some(carrier) = &self.carrier {
            let is_over = match carrier.errand {
                Manipulation::Take(object) => {
                    held == Some(object)
                        || !is_misplaced(object)
                        || was_moved(world, object, self.lies_at)
                }
                Manipulation::Put(object, _) => held != Some(object),
                Manipulation::Open(object) | Manipulation::Close(object) => !is_misplaced(object),
            };
            if is_over {
                if let (Manipulation::Put(object, _), Some(agent)) = (carrier.errand, holder)
                    && let Some(place) = self.places.get_mut(&object)
                {
                    let grid = &self.grid;
                    let is_elsewhere = |cell: &NavCell| {
                        grid.position(*cell).distance(agent.position) > ELSEWHERE_M
                    };
                    let others = place.cells.iter().copied().filter(is_elsewhere);
                    let others: Vec<NavCell> = others.collect();
                    if !others.is_empty() {
                        place.cells = others;
                    }
                }
                self.carrier = None;
            }
        }
        if self.carrier.is_none() && self.waits_for_rest(world, misplaced) {
            return DiscreteAction::Wait;
        }
        // Each round begins an errand or gives a thing up.
        let spare: usize = self.spare_places.values().map(Vec::len).sum();
        for _ in 0..=TAKES as usize * (misplaced.len() + spare + 1) {
            if self.carrier.is_none() {
                self.carrier = self.begin(world, held, misplaced);
            }
            let Some(carrier) = &mut self.carrier else {
                break;
            };
            if let Some(action) = carrier.next_action(world) {
                self.doors.count(world, action);
                return action;
            }
            match carrier.errand {
                // What was kicked away meanwhile is reached from elsewhere; it counts how often it takes a thing.
                Manipulation::Take(_) => {}
                // Something may lie there that it puts in its own place first.
                Manipulation::Put(object, _) => {
                    if !self.use_spare_place(object) {
                        self.postponed.insert(object);
                        self.carrier = None;
                        return DiscreteAction::Drop;
                    }
                }
                Manipulation::Open(object) | Manipulation::Close(object) => {
                    self.left.insert(object);
                }
            }
            self.carrier = None;
        }
        if held.is_some_and(|object| self.left.contains(&object)) {
            return DiscreteAction::Drop;
        }
        DiscreteAction::Stop
    }

    /// Counts the steps for which something that it would take still moves; returns whether it waits for it.
    fn waits_for_rest(&mut self, world: &World, misplaced: &[Misplacement]) -> bool {
        let moves = misplaced.iter().any(|one| {
            matches!(one, Misplacement::Thing(_))
                && rest_state(world, one.object()) == RestState::Moving
        });
        self.settling = if moves { self.settling + 1 } else { 0 };
        moves && self.settling < SETTLING
    }

    /// Returns whether furniture that is to be closed has something in it that belongs elsewhere, or is missing something.
    fn would_lock_in(&self, world: &World, one: Misplacement, misplaced: &[Misplacement]) -> bool {
        let Misplacement::Furniture(furniture, false) = one else {
            return false;
        };
        let bounds = |object| world.house().object_bounds(world.state(), object);
        let within = bounds(furniture).grown(NEAR_M);
        misplaced.iter().any(|other| match other {
            Misplacement::Furniture(..) => false,
            Misplacement::Thing(thing) => {
                let place = self.places.get(thing).map(|place| place.foot);
                let given_up = self.left.contains(thing)
                    || self.takes.get(thing).is_some_and(|takes| *takes >= TAKES);
                !given_up
                    && (within.contains(bounds(*thing).center())
                        || place.is_some_and(|foot| within.contains(foot)))
            }
        })
    }

    /// The next errand; `None` where there is none.
    fn begin(
        &mut self,
        world: &World,
        held: Option<ObjectId>,
        misplaced: &[Misplacement],
    ) -> Option<OngoingManipulation> {
        let grid = self.grid.clone();
        let setup = (self.agent, &grid, self.stride);
        if let Some(object) = held {
            if self.left.contains(&object) {
                return None;
            }
            let place = self.places.get(&object)?;
            let errand = Manipulation::Put(object, place.foot);
            let mut carrier = OngoingManipulation::new(errand, place.cells.clone(), setup);
            // What was lost on the way is carried the other way round every second time.
            let takes = self.takes.get(&object).copied().unwrap_or(1);
            if takes.is_multiple_of(2) {
                carrier = carrier.turning_the_other_way();
            }
            return Some(if self.by_view {
                carrier.placing_by_view()
            } else {
                carrier
            });
        }
        let here = world.state().agents.get(self.agent)?.position;
        let here = grid.nearest(here, 0.6)?;
        let ways = grid.distance_field(&[here]);
        let ground = LargestIslandIndex::of(&grid);
        let mut best: Option<(ErrandRank, Manipulation, Vec<NavCell>)> = None;
        for one in misplaced {
            if self.left.contains(&one.object()) {
                continue;
            }
            let (errand, cells) = match *one {
                Misplacement::Thing(object) => {
                    let tries = self.takes.get(&object).copied().unwrap_or(0);
                    let is_given_up = tries >= TAKES && !self.use_spare_place(object);
                    if is_given_up || !self.places.contains_key(&object) {
                        continue;
                    }
                    let mut cells = cells_in_reach(world, self.agent, &ground, object);
                    if cells.is_empty() {
                        let far = (object, FAR_SHARE);
                        cells = cells_in_reach_fraction(world, self.agent, &ground, far);
                    }
                    (Manipulation::Take(object), cells)
                }
                Misplacement::Furniture(object, opens) => {
                    let cells = self.furniture.get(&object).cloned().unwrap_or_default();
                    let errand = if opens {
                        Manipulation::Open(object)
                    } else {
                        Manipulation::Close(object)
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
            let late = if self.would_lock_in(world, *one, misplaced) {
                2
            } else {
                u8::from(self.postponed.contains(&one.object()))
            };
            let rank = (late, matches!(errand, Manipulation::Take(_)), way_m);
            if best.as_ref().is_none_or(|(other, ..)| rank < *other) {
                best = Some((rank, errand, cells));
            }
        }
        let (_, errand, cells) = best?;
        if let Manipulation::Take(object) = errand {
            self.lies_at = box_centre(world, object);
            *self.takes.entry(object).or_default() += 1;
        }
        Some(OngoingManipulation::new(errand, cells, setup))
    }
}
