//! What a house offers to be asked for, found once at its start.

use super::planned_step::{PlannedStep, StepTarget};
use super::step_places::{PlaceFinder, StepPlaces};
use crate::actions::{ActionSet, DiscreteAction};
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::world::World;
use dwell_scene::interrupt;
use dwell_scene::navigation::NavGrid;
use dwell_scene::{Aabb, AgentBody, AgentId, House, ObjectId, ReceptacleKind, RoomId, State};
use dwell_semantics::SemanticScene;
use dwell_semantics::Term;
use dwell_semantics::form::Description;
use dwell_semantics::instruct::{self, InstructionStep, StepCondition, StepKind, ThingGroup};
use dwell_semantics::refer::{refer, refer_to_room};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Things that a group leaves to do, at most: their best order is found by trying all.
pub(super) const MOST_THINGS: usize = 4;
/// Height of a surface below the eyes from which things are put on it, m.
const BELOW_EYES_M: f32 = 0.15;
/// Edge of a thing that is imagined on a surface, m.
const SMALL_M: f32 = 0.1;

/// Several things that are asked for by number, and the room that they are brought to.
#[derive(Debug)]
pub(super) struct GroupCandidate {
    pub(super) kind: StepKind,
    pub(super) group: ThingGroup,
    pub(super) to: Option<RoomId>,
}

impl GroupCandidate {
    /// How many things are left to do.
    pub(super) fn count(&self) -> usize {
        if self.group.is_exact {
            self.group.needed
        } else {
            self.group.undone.len()
        }
    }
}

/// What a house offers to be asked for.
#[derive(Debug, Default)]
pub(super) struct StepCandidates {
    places: StepPlaces,
    rooms: BTreeMap<RoomId, Description>,
    /// Words for things that can be told from all others.
    things: BTreeMap<ObjectId, Description>,
    /// What can be done to which of them.
    pub(super) by_kind: BTreeMap<StepKind, Vec<ObjectId>>,
    /// What things are put on and into: the sizes of the places, m.
    surfaces: BTreeMap<ObjectId, Vec<Vec3>>,
    containers: BTreeMap<ObjectId, Vec<Vec3>>,
    /// The sizes of things that are carried, m.
    sizes: BTreeMap<ObjectId, Vec3>,
    /// Containers that are closed at the start.
    closed: BTreeSet<ObjectId>,
    pub(super) groups: Vec<GroupCandidate>,
    /// Things of which one says that they are in one of two states.
    pub(super) state_things: Vec<(ObjectId, [&'static str; 2])>,
}

/// The action that carries a kind of step out, beside walking and looking.
fn action_of(kind: StepKind) -> Option<DiscreteAction> {
    Some(match kind {
        StepKind::GoToRoom | StepKind::FindObject | StepKind::Face => return None,
        StepKind::PointAt => DiscreteAction::Point,
        StepKind::PickUp => DiscreteAction::Pick,
        StepKind::Open => DiscreteAction::Open,
        StepKind::Close => DiscreteAction::Close,
        StepKind::SwitchOn | StepKind::SwitchOff => DiscreteAction::Toggle,
        StepKind::Bring => DiscreteAction::Drop,
        StepKind::PutOn => DiscreteAction::Place,
        StepKind::PutIn => DiscreteAction::PutIn,
    })
}

/// Returns whether an agent with some actions can carry out a kind of step.
pub(super) fn can_carry_out(kind: StepKind, actions: ActionSet) -> bool {
    let carries = matches!(kind, StepKind::Bring | StepKind::PutOn | StepKind::PutIn);
    action_of(kind).is_none_or(|action| actions.contains(action))
        && (!carries || actions.contains(DiscreteAction::Pick))
}

impl StepCandidates {
    /// What `world` offers at its start of some kinds.
    pub(super) fn from_world(
        world: &World,
        (agent, body): (AgentId, AgentBody),
        grid: &NavGrid,
        kinds: &[StepKind],
        with_groups: bool,
    ) -> Self {
        let scene = world.engines().semantics().scene(world.state());
        let mut finder = PlaceFinder {
            world,
            agent,
            body,
            ground: LargestIslandIndex::of(grid),
            places: StepPlaces::default(),
        };
        let mut pool = Self::default();
        for room in world.house().rooms.ids() {
            if let Some(words) = refer_to_room(&scene, room)
                && finder.is_room_reachable(room)
            {
                pool.rooms.insert(room, words);
            }
        }
        for object in world.house().objects.ids() {
            let category = scene.facts(object).category;
            if !category.is_some_and(instruct::is_search_target) || scene.room_of(object).is_none()
            {
                continue;
            }
            interrupt::unwind_if_cancelled();
            let applies = |kind: &&StepKind| kind.applies(&scene, object);
            let own: Vec<StepKind> = kinds.iter().filter(applies).copied().collect();
            let can: Vec<StepKind> = own
                .into_iter()
                .filter(|kind| is_possible(&mut finder, *kind, object))
                .collect();
            let is_destination = pool.add_destination(&scene, &mut finder, kinds, object);
            let states = instruct::states_of(&scene, object).filter(|_| finder.is_findable(object));
            if can.is_empty() && !is_destination && states.is_none() {
                continue;
            }
            // Some milliseconds each.
            let Some(words) = refer(&scene, object) else {
                pool.surfaces.remove(&object);
                pool.containers.remove(&object);
                continue;
            };
            pool.things.insert(object, words);
            pool.state_things
                .extend(states.map(|states| (object, states)));
            let size = world.house().object_bounds(world.state(), object).size();
            pool.sizes.insert(object, size);
            for kind in can {
                pool.by_kind.entry(kind).or_default().push(object);
            }
        }
        if with_groups {
            pool.add_groups(&scene, &mut finder, kinds);
        }
        pool.places = finder.places;
        pool
    }

    /// Takes a thing in as a place for others; returns whether it is one.
    fn add_destination(
        &mut self,
        scene: &SemanticScene<'_>,
        finder: &mut PlaceFinder<'_>,
        kinds: &[StepKind],
        object: ObjectId,
    ) -> bool {
        let house = scene.house();
        let state = finder.world.state();
        // A tray that is carried about is no place to find.
        if house.objects[object].pickable {
            return false;
        }
        let floor_y = scene
            .room_of(object)
            .map_or(0.0, |room| house.rooms[room].floor_y);
        let eye_y = floor_y + finder.body.eye_height_m;
        let (mut on, mut within) = (Vec::new(), Vec::new());
        for place in house.receptacles_of(object) {
            let space = place
                .space_in_part
                .transformed(&state.part_pose[place.part].to_affine());
            match place.holding {
                // What stands on a board within a bookcase is in it.
                ReceptacleKind::On
                    if space.min.y < eye_y - BELOW_EYES_M
                        && !is_within(house, state, object, &space) =>
                {
                    on.push(space.size());
                }
                ReceptacleKind::In if space.min.y < eye_y => within.push(space.size()),
                _ => {}
            }
        }
        on.retain(|_| kinds.contains(&StepKind::PutOn));
        within.retain(|_| kinds.contains(&StepKind::PutIn));
        if (on.is_empty() && within.is_empty()) || !finder.is_in_reach(object) {
            return false;
        }
        if StepKind::Open.applies(scene, object) {
            self.closed.insert(object);
        }
        if !on.is_empty() {
            self.surfaces.insert(object, on);
        }
        if !within.is_empty() {
            self.containers.insert(object, within);
        }
        true
    }

    fn add_groups(
        &mut self,
        scene: &SemanticScene<'_>,
        finder: &mut PlaceFinder<'_>,
        kinds: &[StepKind],
    ) {
        let rooms: Vec<(RoomId, Description)> = self
            .rooms
            .iter()
            .map(|(room, words)| (*room, words.clone()))
            .collect();
        let counted = [
            StepKind::PointAt,
            StepKind::Open,
            StepKind::Close,
            StepKind::SwitchOn,
            StepKind::SwitchOff,
            StepKind::Bring,
        ];
        let sets = instruct::thing_sets(scene, &rooms);
        for kind in counted.into_iter().filter(|kind| kinds.contains(kind)) {
            // Each thing is asked about once, in order.
            let mut known: BTreeMap<ObjectId, bool> = BTreeMap::new();
            for object in scene.house().objects.ids() {
                if kind.applies(scene, object) {
                    known.insert(object, is_possible(finder, kind, object));
                }
            }
            let can = |object: ObjectId| known.get(&object).is_some_and(|can| *can);
            let destinations: Vec<Option<RoomId>> = match kind {
                StepKind::Bring => rooms.iter().map(|(room, _)| Some(*room)).collect(),
                _ => vec![None],
            };
            for to in destinations {
                let found = instruct::groups(scene, kind, &sets, to, can);
                let short = found
                    .into_iter()
                    .filter(|group| group.is_exact || group.undone.len() <= MOST_THINGS);
                self.groups
                    .extend(short.map(|group| GroupCandidate { kind, group, to }));
            }
        }
    }

    /// Returns whether a kind of step can be asked.
    pub(super) fn has(&self, kind: StepKind) -> bool {
        match kind {
            StepKind::GoToRoom => !self.rooms.is_empty(),
            kind => self.by_kind.contains_key(&kind),
        }
    }

    pub(super) fn description(&self, object: ObjectId) -> Option<Description> {
        self.things.get(&object).cloned()
    }

    /// The rooms that one can go to.
    pub(super) fn rooms(&self) -> Vec<RoomId> {
        self.rooms.keys().copied().collect()
    }

    /// The things on or into which another can be put by its size.
    pub(super) fn destinations(&self, kind: StepKind, object: ObjectId) -> Vec<ObjectId> {
        let of_kind = match kind {
            StepKind::PutOn => &self.surfaces,
            _ => &self.containers,
        };
        let Some(size) = self.sizes.get(&object) else {
            return Vec::new();
        };
        let holds = |space: &Vec3| {
            let fits = |a: f32, b: f32| a <= space.x && b <= space.z;
            let flat = fits(size.x, size.z) || fits(size.z, size.x);
            flat && (kind == StepKind::PutOn || size.y <= space.y)
        };
        let fitting = of_kind
            .iter()
            .filter(|(own, spaces)| **own != object && spaces.iter().any(holds));
        fitting.map(|(own, _)| *own).collect()
    }

    /// The step to go to a room.
    pub(super) fn go_to_step(&self, room: RoomId) -> Option<InstructionStep> {
        Some(InstructionStep::go_to(room, self.rooms.get(&room)?.clone()))
    }

    /// The step to do something to a thing.
    pub(super) fn object_step(&self, kind: StepKind, object: ObjectId) -> Option<InstructionStep> {
        InstructionStep::on_object(kind, object, self.description(object)?)
    }

    /// The step to take a thing somewhere.
    pub(super) fn transport_step(
        &self,
        kind: StepKind,
        object: ObjectId,
        to: Term,
    ) -> Option<InstructionStep> {
        let destination = match to {
            Term::Room(room) => self.rooms.get(&room)?.clone(),
            to => self.description(to.object()?)?,
        };
        InstructionStep::to_destination(
            kind,
            (object, self.description(object)?),
            (to, destination),
        )
    }

    /// The step of a group.
    pub(super) fn group_step(&self, offer: &GroupCandidate) -> Option<InstructionStep> {
        let to = match offer.to {
            Some(room) => Some((room, self.rooms.get(&room)?.clone())),
            None => None,
        };
        InstructionStep::on_group(offer.kind, &offer.group, to)
    }

    /// How a step is played: the conditions with numbers in `planned`, in that order.
    pub(super) fn plan(&self, step: InstructionStep, planned: &[usize]) -> Option<PlannedStep> {
        let target = |number: &usize| self.target(step.conditions[*number]);
        let targets: Option<Vec<StepTarget>> = planned.iter().map(target).collect();
        Some(PlannedStep {
            targets: targets?,
            step,
        })
    }

    fn target(&self, condition: StepCondition) -> Option<StepTarget> {
        let opens_first = |object: ObjectId| self.closed.contains(&object);
        self.places.target(condition, opens_first)
    }
}

/// Returns whether the agent can do what a kind of step asks of a thing.
fn is_possible(finder: &mut PlaceFinder<'_>, kind: StepKind, object: ObjectId) -> bool {
    match kind {
        StepKind::GoToRoom => false,
        StepKind::FindObject | StepKind::Face | StepKind::PointAt => finder.is_findable(object),
        StepKind::PickUp | StepKind::Bring | StepKind::PutOn | StepKind::PutIn => {
            finder.can_pick_up(object)
        }
        StepKind::Open | StepKind::Close | StepKind::SwitchOn | StepKind::SwitchOff => {
            finder.is_in_reach(object)
        }
    }
}

/// Returns whether a small thing in the middle of a level space of an object would be in it rather than on it.
fn is_within(house: &House, state: &State, object: ObjectId, space: &Aabb) -> bool {
    let foot = space.center().with_y(space.min.y);
    let half = Vec3::new(0.5 * SMALL_M, 0.0, 0.5 * SMALL_M);
    let small = Aabb::new(foot - half, foot + half + Vec3::Y * SMALL_M);
    house.encloses(state, object, &house.object_bounds(state, object), &small)
}
