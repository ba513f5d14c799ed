//! A way to one goal, and the expert's manoeuvres on it.

use super::goal::{NavigationGoal, SuccessRule};
use crate::actions::{DiscreteAction, StepSizes};
use crate::expert::{
    LookAction, LookTarget, ShortestPathFollower, action_towards_object, action_towards_point,
    look_at, look_at_surface,
};
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::space::{forward_from_yaw, yaw_from_forward};
use dwell_scene::{AgentId, AgentState, ObjectId};
use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Distance from a place where the expert looked in vain within which goals are not tried again, m.
pub(in crate::tasks) const ELSEWHERE_M: f32 = 0.3;
/// The same where the expert's view, which turns by steps, missed a thing that is small from there.
pub(in crate::tasks) const BESIDE_M: f32 = 0.1;

/// How far it steps back from places that it tried in vain, m, and to which sides of where it looks, rad.
const STEP_BACK_M: std::ops::Range<f32> = 0.4..0.8;
const SIDES: [f32; 3] = [FRAC_PI_2, -FRAC_PI_2, PI];

/// Distance to which what is carried is kept from everything, m, and the highest view to which it is raised, rad.
const HAND_MARGIN_M: f32 = 0.01;
const HIGHEST_RAD: f32 = 0.5;
/// Directions around a place in which it looks for room for what it picks up.
const DIRECTIONS: u16 = 12;

/// How the expert first turns on a way.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FirstTurn {
    /// To the nearer side, as always.
    Nearer,
    /// To the other side, once it turns.
    Farther,
    /// To this side until it is ahead.
    Towards(DiscreteAction),
}

/// Where the expert walks to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Destination {
    Goals,
    /// Some steps from them, to come to them from another side.
    Aside,
}

/// The way to a goal.
#[derive(Clone, Debug)]
pub(in crate::tasks) struct Leg {
    pub(in crate::tasks) goal: Arc<NavigationGoal>,
    /// The guide that measures the remaining distance.
    pub(in crate::tasks) guide: ShortestPathFollower,
    /// The expert's guide, to those goals from which it has not looked in vain.
    expert_path: ShortestPathFollower,
    /// Those goals.
    expert_cells: Vec<NavCell>,
    /// True once the expert has raised what it carries: the hand follows the view.
    is_raised: bool,
    /// The side to which the expert first turns with what it carries, where that is not the nearer one.
    first_turn: FirstTurn,
    /// True once only those goals are left where it has room to turn with what it picks up.
    has_room_to_turn: bool,
    /// True once only those goals are left from which steps of the view meet the thing.
    is_narrowed: bool,
    destination: Destination,
    stride: StepSizes,
}

impl Leg {
    pub(in crate::tasks) fn new(
        agent: AgentId,
        grid: Arc<NavGrid>,
        goal: Arc<NavigationGoal>,
        stride: StepSizes,
    ) -> Self {
        let guide = ShortestPathFollower::new(agent, grid, &goal.cells, stride);
        Self {
            expert_path: guide.clone(),
            expert_cells: goal.cells.clone(),
            is_raised: false,
            first_turn: FirstTurn::Nearer,
            has_room_to_turn: false,
            is_narrowed: false,
            destination: Destination::Goals,
            guide,
            goal,
            stride,
        }
    }

    /// The agent's steps and turns.
    pub(in crate::tasks) fn stride(&self) -> StepSizes {
        self.stride
    }

    /// The straight distance of a cell to the nearest goal, m.
    pub(in crate::tasks) fn straight_m(&self, cell: NavCell) -> f64 {
        let grid = self.guide.grid();
        let from = grid.position(cell);
        let straight = self.goal.cells.iter();
        let straight = straight.map(|to| grid.position(*to).distance(from));
        f64::from(straight.fold(f32::INFINITY, f32::min))
    }

    /// Leads to goals further than `radius_m` from here from now on; `false` when there are none. Of a cell on whose border the agent
    /// stands the thing may be hidden, though it is seen from the middle.
    pub(in crate::tasks) fn exclude_goals_within(&mut self, world: &World, radius_m: f32) -> bool {
        let agent = world.state().agents.get(self.expert_path.agent());
        agent.is_some_and(|agent| {
            let position = agent.position;
            self.retain_goals(|cell| cell.distance(position) > radius_m)
        })
    }

    /// Leads to goals further than `radius_m` from all of `tried` from now on, where there are any.
    pub(in crate::tasks) fn avoid_goals_near(&mut self, tried: &[Vec3], radius_m: f32) {
        let is_far = |cell: Vec3| tried.iter().all(|place| place.distance(cell) > radius_m);
        if !self.retain_goals(is_far) {
            self.restore_all_goals();
        }
    }

    /// Leads to those goals whose positions are `wanted` from now on; `false` when there are none, or when that are all.
    fn retain_goals(&mut self, wanted: impl Fn(Vec3) -> bool) -> bool {
        let grid = self.expert_path.grid().clone();
        let cells = self.expert_cells.iter().copied();
        self.keep_goals(cells.filter(|cell| wanted(grid.position(*cell))).collect())
    }

    /// Leads to these of its goals alone from now on; `false` when they are none or all.
    fn keep_goals(&mut self, kept: Vec<NavCell>) -> bool {
        if kept.is_empty() || kept.len() == self.expert_cells.len() {
            return false;
        }
        self.expert_cells = kept;
        let (id, grid) = (self.guide.agent(), self.guide.grid().clone());
        self.expert_path = ShortestPathFollower::new(id, grid, &self.expert_cells, self.stride);
        true
    }

    /// Leads to all goals again.
    pub(in crate::tasks) fn restore_all_goals(&mut self) {
        self.expert_cells.clone_from(&self.goal.cells);
        self.expert_path = self.guide.clone();
        self.is_narrowed = false;
        self.destination = Destination::Goals;
    }

    /// Leads some steps away, to another side with each `round`, and then to all goals again: who comes from elsewhere stands elsewhere
    /// in a cell. `false` where there is nowhere to step to.
    pub(in crate::tasks) fn step_back(&mut self, world: &World, round: u32) -> bool {
        let Some(agent) = world.state().agents.get(self.guide.agent()) else {
            return false;
        };
        let grid = self.guide.grid();
        let island = |cell: NavCell| grid.island(cell);
        let here = grid.nearest(agent.position, 0.6).and_then(island);
        let away = |cell: &NavCell| grid.position(*cell) - agent.position;
        let is_near = |cell: &NavCell| STEP_BACK_M.contains(&away(cell).length());
        let near = grid.walkable().filter(is_near);
        let near: Vec<NavCell> = near.filter(|cell| island(*cell) == here).collect();
        let side = forward_from_yaw(agent.yaw_rad + SIDES[round as usize % SIDES.len()]);
        let beside = near.iter().copied();
        let beside = beside.filter(|cell| away(cell).normalize_or_zero().dot(side) > 0.7);
        let beside: Vec<NavCell> = beside.collect();
        let cells = if beside.is_empty() { near } else { beside };
        if cells.is_empty() {
            return false;
        }
        self.destination = Destination::Aside;
        let (id, grid) = (self.guide.agent(), grid.clone());
        self.expert_path = ShortestPathFollower::new(id, grid, &cells, self.stride);
        true
    }

    /// Returns whether the agent has reached the goal; `distance_m`: how far it is from there.
    pub(in crate::tasks) fn is_reached(&self, world: &World, distance_m: Option<f64>) -> bool {
        match &self.goal.success {
            SuccessRule::Within(radius_m) => distance_m.is_some_and(|left| left < *radius_m),
            SuccessRule::Fulfilled(asked) => {
                let scene = world.engines().semantics().scene(world.state());
                asked.is_reached(&scene, world.rays(), self.guide.agent())
            }
        }
    }

    /// The way of the same agent to another goal.
    pub(in crate::tasks) fn with_goal(&self, goal: Arc<NavigationGoal>) -> Self {
        Self::new(
            self.guide.agent(),
            self.guide.grid().clone(),
            goal,
            self.stride,
        )
    }

    /// The expert's next step on the way; `None` where it ends. What is in the hand is raised first, over what stands on tables.
    pub(in crate::tasks) fn walk(&mut self, world: &World) -> Option<DiscreteAction> {
        let mut step = self.expert_path.next_action(world);
        if step.is_none() && self.destination == Destination::Aside {
            self.restore_all_goals();
            step = self.expert_path.next_action(world);
        }
        let step = step?;
        let agent = world.state().agents.get(self.expert_path.agent())?;
        let looks_down = agent.pitch_rad < -0.5 * self.stride.look_deg.to_radians();
        self.is_raised |= agent.holding.is_none() || !looks_down;
        if !self.is_raised {
            return Some(DiscreteAction::LookUp);
        }
        let agent = *agent;
        let step = self.turned(step);
        Some(self.keep_hand_clear(world, &agent, step))
    }

    /// A step, or one that keeps what is in the hand from where that step would bring it against something: it is raised, or
    /// carried round the other way.
    fn keep_hand_clear(
        &mut self,
        world: &World,
        agent: &AgentState,
        step: DiscreteAction,
    ) -> DiscreteAction {
        let id = self.guide.agent();
        let has_room =
            |holder: &AgentState| world.physics.has_room_in_hand(id, holder, HAND_MARGIN_M);
        let is_on_the_way = matches!(self.first_turn, FirstTurn::Towards(_));
        if agent.holding.is_none() || is_on_the_way || !has_room(agent) {
            return step;
        }
        // How far to turn to which side, the nearer one first; none of what is no turn.
        let turn_rad = self.stride.turn_deg.to_radians();
        let nearer_rad = self.expert_path.turn_to_aim_rad(agent).abs();
        let turns = |angle_rad: f32| (angle_rad / turn_rad).round().max(1.0) as u32;
        let sides = match other_side(step) {
            None => vec![(step, 1)],
            Some(other) => vec![(step, turns(nearer_rad)), (other, turns(TAU - nearer_rad))],
        };
        let is_free = |from: &AgentState, (side, count): (DiscreteAction, u32)| {
            let mut holder = *from;
            (0..count).all(|_| {
                holder = self.stride.after(&holder, side);
                has_room(&holder)
            })
        };
        let free_side = |from: &AgentState| sides.iter().find(|side| is_free(from, **side));
        if let Some((side, _)) = free_side(agent) {
            if *side != step {
                self.first_turn = FirstTurn::Towards(*side);
            }
            return *side;
        }
        let raised = self.stride.after(agent, DiscreteAction::LookUp);
        let can_raise = raised.pitch_rad < HIGHEST_RAD && has_room(&raised);
        if can_raise && free_side(&raised).is_some() {
            return DiscreteAction::LookUp;
        }
        step
    }

    /// A step of the way, or the turn to the other side.
    fn turned(&mut self, step: DiscreteAction) -> DiscreteAction {
        let Some(other) = other_side(step) else {
            self.first_turn = FirstTurn::Nearer;
            return step;
        };
        if self.first_turn == FirstTurn::Farther {
            self.first_turn = FirstTurn::Towards(other);
        }
        match self.first_turn {
            FirstTurn::Towards(side) => side,
            _ => step,
        }
    }

    /// Turns to the other side first: what was carried was lost on the nearer one, where something is in its way.
    pub(in crate::tasks) fn turn_the_other_way(&mut self) {
        self.first_turn = FirstTurn::Farther;
    }

    /// What brings the middle of the view onto a thing from here.
    pub(in crate::tasks) fn look_at(&self, world: &World, object: ObjectId) -> LookAction {
        self.look(world, (object, LookTarget::Anywhere), &[])
    }

    /// What brings the middle of the view onto a level surface of a thing from here, away from the points that were tried in vain
    /// where there is such a place.
    pub(in crate::tasks) fn look_at_level_surface(
        &self,
        world: &World,
        object: ObjectId,
        tried: &[Vec3],
    ) -> LookAction {
        self.look(world, (object, LookTarget::LevelSurface), tried)
    }

    fn look(&self, world: &World, at: (ObjectId, LookTarget), tried: &[Vec3]) -> LookAction {
        match world.state().agents.get(self.guide.agent()) {
            Some(agent) => look_at(world, agent, at, tried, &self.stride),
            None => LookAction::Missed,
        }
    }

    /// Leads to those goals alone from which steps of the view meet a thing most surely, the first time that it was missed; `false`
    /// later, and where these are none or all.
    pub(in crate::tasks) fn keep_goals_that_see(
        &mut self,
        world: &World,
        at: (ObjectId, LookTarget),
    ) -> bool {
        let Some(agent) = world.state().agents.get(self.guide.agent()).copied() else {
            return false;
        };
        if std::mem::replace(&mut self.is_narrowed, true) {
            return false;
        }
        let (grid, stride) = (self.guide.grid(), self.stride);
        // Of five points of a cell, where it may come to stand, from how many.
        let beside_m = 0.25 * grid.config().cell_m;
        let points = [
            (0.0, 0.0),
            (-1.0, -1.0),
            (1.0, -1.0),
            (-1.0, 1.0),
            (1.0, 1.0),
        ];
        let points = points.map(|(x, z)| beside_m * Vec3::new(x, 0.0, z));
        let seen_from = |cell: &NavCell| {
            let from = points.iter().filter(|beside| {
                let position = grid.position(*cell) + **beside;
                look_at(world, &AgentState { position, ..agent }, at, &[], &stride)
                    != LookAction::Missed
            });
            from.count()
        };
        let counts: Vec<usize> = self.expert_cells.iter().map(seen_from).collect();
        let most = counts.iter().copied().max().unwrap_or(0);
        if most == 0 {
            return false;
        }
        let cells = self.expert_cells.iter().zip(&counts);
        let kept = cells.filter(|(_, count)| 2 * **count > most);
        let kept: Vec<NavCell> = kept.map(|(cell, _)| *cell).collect();
        self.keep_goals(kept)
    }

    /// Leads to those goals alone at which there is most room around to turn with a thing that is picked up there; looks for them the
    /// first time that it is asked.
    pub(in crate::tasks) fn keep_goals_to_turn_at(&mut self, world: &World, object: ObjectId) {
        if std::mem::replace(&mut self.has_room_to_turn, true) {
            return;
        }
        let id = self.guide.agent();
        let Some(agent) = world.state().agents.get(id) else {
            return;
        };
        let grid = self.guide.grid();
        let middle = world.house().object_bounds(world.state(), object).center();
        let part = world.house().objects[object].first_part;
        let room_at = |cell: &NavCell| {
            let position = grid.position(*cell);
            let holder = AgentState {
                position,
                yaw_rad: yaw_from_forward(middle - position),
                pitch_rad: 0.0,
                ..*agent
            };
            let physics = &world.physics;
            physics.directions_with_room(part, (id, &holder), DIRECTIONS, HAND_MARGIN_M)
        };
        let rooms: Vec<usize> = self.expert_cells.iter().map(room_at).collect();
        let most = rooms.iter().copied().max().unwrap_or(0);
        let cells = self.expert_cells.iter().zip(&rooms);
        let kept = cells.filter(|(_, room)| 4 * **room >= 3 * most);
        let kept = kept.map(|(cell, _)| *cell).collect();
        self.keep_goals(kept);
    }

    /// What brings the middle of the view onto the level surface at a point, at most `around_m` from it.
    pub(in crate::tasks) fn look_at_surface(
        &self,
        world: &World,
        point: Vec3,
        around_m: f32,
    ) -> LookAction {
        look_at_surface(world, self.guide.agent(), (point, around_m), &self.stride)
    }

    /// The turn or tilt that brings a point into the middle of the view; `None` once it is there.
    pub(in crate::tasks) fn face(&self, world: &World, point: Vec3) -> Option<DiscreteAction> {
        action_towards_point(world, self.guide.agent(), point, &self.stride)
    }

    /// The expert's next step on the way, and then towards the nearest thing of the goal; `None` once it stands and looks right.
    pub(in crate::tasks) fn approach(&mut self, world: &World) -> Option<DiscreteAction> {
        if let Some(step) = self.walk(world) {
            return Some(step);
        }
        let agent = self.guide.agent();
        let object = nearest(world, agent, self.goal.objects())?;
        action_towards_object(world, agent, object, &self.stride)
    }

    /// Returns whether the agent has reached a place and a step forward would bring it no nearer: a stride may be longer than what is
    /// left of the way.
    pub(in crate::tasks) fn oversteps_goal(&self, world: &World) -> bool {
        let Some(agent) = world.state().agents.get(self.guide.agent()) else {
            return false;
        };
        let left_m = self.guide.distance_m(world);
        if !self.goal.objects().is_empty() || !self.is_reached(world, left_m) {
            return false;
        }
        let forward = forward_from_yaw(agent.yaw_rad) * self.stride.forward_m;
        let grid = self.guide.grid();
        let ahead = grid.nearest(agent.position + forward, 0.5);
        let then_m = ahead.and_then(|cell| self.guide.distance_at(cell));
        then_m.is_none_or(|then_m| left_m.is_some_and(|left_m| then_m >= left_m))
    }

    /// The expert's next step to open a thing in front of which it stands.
    pub(in crate::tasks) fn open(&mut self, world: &World, object: ObjectId) -> DiscreteAction {
        self.expert_path.action_to_open(world, object)
    }
}

/// The turn to the other side; `None` of what is no turn.
fn other_side(step: DiscreteAction) -> Option<DiscreteAction> {
    match step {
        DiscreteAction::TurnLeft => Some(DiscreteAction::TurnRight),
        DiscreteAction::TurnRight => Some(DiscreteAction::TurnLeft),
        _ => None,
    }
}

/// The nearest of some things to an agent.
fn nearest(world: &World, agent: AgentId, objects: &[ObjectId]) -> Option<ObjectId> {
    let here = world.state().agents.get(agent)?.position;
    let distance = |object: &ObjectId| {
        let bounds = world.house().object_bounds(world.state(), *object);
        here.clamp(bounds.min, bounds.max).distance(here)
    };
    let mut nearest = objects.iter().copied();
    let first = nearest.next()?;
    Some(nearest.fold(first, |best, other| {
        if distance(&other) < distance(&best) {
            other
        } else {
            best
        }
    }))
}
