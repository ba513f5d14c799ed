//! Where the steps of instructions are carried out.

use super::planned_step::{LegEndAction, PlannedLeg, StepTarget};
use crate::actions::DiscreteAction;
use crate::episode::EpisodeGoal;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::{NavigationGoal, SuccessRule, cells_in_reach, goal_region};
use crate::world::World;
use dwell_scene::navigation::NavCell;
use dwell_scene::{Aabb, AgentBody, AgentId, ObjectId, RoomId};
use dwell_semantics::instruct::{InstructionGoal, StepCondition};
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Cells from which a thing must be reached: from fewer, a view that turns by steps may miss it everywhere.
const LEAST_CELLS: usize = 6;
/// Distance from a room's borders at which a thing is dropped in it, m: it falls an arm's length before the agent.
pub(super) const DROP_M: f32 = 0.8;
/// Least rise of a step of stairs, and height from which ground is that of another storey, m.
const STEP_M: f32 = 0.1;
const STOREY_M: f32 = 2.0;

/// Eight directions in plan.
const AROUND: [(f32, f32); 8] = {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    [
        (1.0, 0.0),
        (half, half),
        (0.0, 1.0),
        (-half, half),
        (-1.0, 0.0),
        (-half, -half),
        (0.0, -1.0),
        (half, -half),
    ]
};

/// The places of rooms, and of things that a hand reaches or that are found; those that were asked for.
#[derive(Debug, Default)]
pub(super) struct StepPlaces {
    rooms: BTreeMap<RoomId, Arc<NavigationGoal>>,
    /// Where a thing that is dropped stays in a room.
    drops: BTreeMap<RoomId, Arc<NavigationGoal>>,
    in_reach: BTreeMap<ObjectId, Arc<NavigationGoal>>,
    found: BTreeMap<ObjectId, Arc<NavigationGoal>>,
}

fn goal(cells: Vec<NavCell>, asked: InstructionGoal) -> Arc<NavigationGoal> {
    Arc::new(NavigationGoal {
        cells,
        success: SuccessRule::Fulfilled(asked),
        told: EpisodeGoal::default(),
        instruction: None,
    })
}

/// Places of stairs on which `cells`, or the ground around them, lie: what falls there rolls on.
fn steps_near(ground: &LargestIslandIndex<'_>, cells: &[NavCell], floor_y: f32) -> Vec<Vec3> {
    let position = |cell: &NavCell| ground.grid.position(*cell);
    let around = Aabb::from_points(cells.iter().map(position)).grown(DROP_M);
    let near = ground.cells_around(&around).into_iter();
    let near = near.map(|cell| ground.grid.position(cell));
    near.filter(|at| (STEP_M..STOREY_M).contains(&(at.y - floor_y).abs()))
        .collect()
}

/// Where a hand reaches a thing as it lies now, for an agent that looks at it.
fn reach_goal(
    world: &World,
    agent: AgentId,
    ground: &LargestIslandIndex<'_>,
    object: ObjectId,
) -> Arc<NavigationGoal> {
    let reach_m = world
        .state()
        .agents
        .get(agent)
        .map_or(0.0, |own| own.body.reach_m);
    Arc::new(NavigationGoal {
        cells: cells_in_reach(world, agent, ground, object),
        success: SuccessRule::Fulfilled(InstructionGoal::objects(vec![object], reach_m)),
        told: EpisodeGoal {
            position: Some(world.house().object_bounds(world.state(), object).center()),
            ..EpisodeGoal::default()
        },
        instruction: None,
    })
}

/// A finder of places in a house at its start.
pub(super) struct PlaceFinder<'a> {
    pub(super) world: &'a World,
    pub(super) agent: AgentId,
    pub(super) body: AgentBody,
    pub(super) ground: LargestIslandIndex<'a>,
    pub(super) places: StepPlaces,
}

impl PlaceFinder<'_> {
    /// Returns whether a hand reaches a thing that the agent looks at, from enough places.
    pub(super) fn is_in_reach(&mut self, object: ObjectId) -> bool {
        let (world, agent, ground) = (self.world, self.agent, &self.ground);
        let known = self.places.in_reach.entry(object);
        let reached = known.or_insert_with(|| reach_goal(world, agent, ground, object));
        reached.cells.len() >= LEAST_CELLS
    }

    /// Returns whether a thing can be found.
    pub(super) fn is_findable(&mut self, object: ObjectId) -> bool {
        let (world, agent, ground) = (self.world, self.agent, &self.ground);
        let known = self.places.found.entry(object);
        let found = known.or_insert_with(|| {
            let asked = StepCondition::find_object_goal(object);
            goal(goal_region(world, agent, ground, &asked), asked)
        });
        !found.cells.is_empty()
    }

    /// Returns whether one can go to a room.
    pub(super) fn is_room_reachable(&mut self, room: RoomId) -> bool {
        let (house, ground) = (self.world.house(), &self.ground);
        let known = self.places.rooms.entry(room);
        let walkable = known.or_insert_with(|| {
            let cells = ground.cells_in_rooms(house, &[room]);
            let asked = InstructionGoal::rooms(vec![room]);
            let steps = steps_near(ground, &cells, house.rooms[room].floor_y);
            let inner = cells.iter().filter(|cell| {
                let at = ground.grid.position(**cell);
                let is_level = steps.iter().all(|step| step.distance(at) > DROP_M);
                is_level
                    && AROUND.into_iter().all(|(dx, dz)| {
                        let beside =
                            house.room_at(at + DROP_M * Vec3::new(dx, 0.0, dz) + 0.1 * Vec3::Y);
                        beside.is_none_or(|beside| beside == room)
                    })
            });
            let inner: Vec<NavCell> = inner.copied().collect();
            // A small room has no such place.
            let drops = if inner.is_empty() {
                cells.clone()
            } else {
                inner
            };
            self.places.drops.insert(room, goal(drops, asked.clone()));
            goal(cells, asked)
        });
        !walkable.cells.is_empty()
    }

    /// Returns whether the agent can pick a thing up.
    pub(super) fn can_pick_up(&mut self, object: ObjectId) -> bool {
        let (house, state) = (self.world.house(), self.world.state());
        let size = house.object_bounds(state, object).size().max_element();
        let part = house.objects[object].first_part;
        let mass_kg = self.world.physics.body_mass_kg(part);
        size <= self.body.max_carry_size_m
            && mass_kg.is_some_and(|mass_kg| mass_kg <= self.body.lift_kg)
            && self.is_in_reach(object)
    }
}

impl StepPlaces {
    /// How a condition is brought about; `None` where its places were not found. `opens_first`: a container that must be opened.
    pub(super) fn target(
        &self,
        condition: StepCondition,
        opens_first: impl Fn(ObjectId) -> bool,
    ) -> Option<StepTarget> {
        let leg = |goal: &Arc<NavigationGoal>, end| PlannedLeg {
            goal: goal.clone(),
            end,
            unless: None,
        };
        let hand = |action, object| {
            let reached = self.in_reach.get(&object)?;
            Some(leg(reached, LegEndAction::Hand(action, object)))
        };
        let unless = |leg: PlannedLeg, condition| PlannedLeg {
            unless: Some(condition),
            ..leg
        };
        let pick = |object| {
            let leg = hand(DiscreteAction::Pick, object)?;
            Some(unless(leg, StepCondition::Held(object)))
        };
        let legs = match condition {
            StepCondition::AgentIn(room) => vec![leg(self.rooms.get(&room)?, LegEndAction::Arrive)],
            StepCondition::Found(object) | StepCondition::Faced(object) => {
                vec![leg(self.found.get(&object)?, LegEndAction::Arrive)]
            }
            StepCondition::PointedAt(object) => {
                let end = LegEndAction::Hand(DiscreteAction::Point, object);
                vec![leg(self.found.get(&object)?, end)]
            }
            StepCondition::Held(object) => vec![hand(DiscreteAction::Pick, object)?],
            StepCondition::Open(object) => vec![hand(DiscreteAction::Open, object)?],
            StepCondition::Closed(object) => vec![hand(DiscreteAction::Close, object)?],
            StepCondition::SwitchedOn(object) | StepCondition::SwitchedOff(object) => {
                vec![hand(DiscreteAction::Toggle, object)?]
            }
            StepCondition::LeftIn(object, room) => {
                vec![
                    pick(object)?,
                    leg(self.drops.get(&room)?, LegEndAction::Drop),
                ]
            }
            StepCondition::On(object, support) => {
                let end = LegEndAction::Above(DiscreteAction::Place, support);
                vec![pick(object)?, leg(self.in_reach.get(&support)?, end)]
            }
            StepCondition::Inside(object, container) => {
                let mut legs = Vec::new();
                if opens_first(container) {
                    let open = hand(DiscreteAction::Open, container)?;
                    legs.push(unless(open, StepCondition::Open(container)));
                }
                legs.extend([pick(object)?, hand(DiscreteAction::PutIn, container)?]);
                legs
            }
        };
        Some(StepTarget { condition, legs })
    }
}
