//! A guide that knows the house: it follows shortest paths, opens doors, turns to things.

mod blocked_door;
mod door_opening;
mod look_at;

pub(crate) use blocked_door::BlockedDoors;
pub(crate) use look_at::{LookAction, LookTarget, look_at, look_at_surface, point_in_view_centre};

use crate::actions::{DiscreteAction, StepSizes};
use crate::world::World;
use door_opening::DoorOpening;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math::wrap_angle;
use dwell_scene::navigation::{DistanceField, NavCell, NavGrid};
use dwell_scene::space::{pitch_from_forward, yaw_from_forward};
use dwell_scene::{AgentId, AgentState, Entity, ObjectId};
use glam::Vec3;
use std::sync::Arc;

/// Distance ahead at which it looks for closed doors, m: further than a door leaf is wide, nearer than its arm is long.
const DOOR_AHEAD_M: f32 = 1.4;
/// Look-ahead distance on the path, m.
const AIM_AHEAD_M: f32 = 2.5;
/// Share of a turn within which something is ahead; of a place further than `FAR_M` that it walks to, so that it does not turn to and
/// fro between the two directions beside it with every step.
const AHEAD: f32 = 0.51;
const WALKING: f32 = 0.75;
const FAR_M: f32 = 0.2;
/// A door is open enough to pass from this share on.
const PASSABLE: f32 = 0.8;

/// A path of one agent to a set of cells.
#[derive(Clone, Debug)]
pub struct ShortestPathFollower {
    agent: AgentId,
    grid: Arc<NavGrid>,
    field: Arc<DistanceField>,
    stride: StepSizes,
    /// Number of recent blocked steps.
    blocked: u32,
    /// Steps of the manoeuvre that frees it, counted down.
    escape: u32,
    /// Number of manoeuvres so far; they alternate left and right.
    escapes: u32,
    /// The door that it opens now.
    opening: Option<DoorOpening>,
    /// The cell to which it walks straight on.
    aim: Option<NavCell>,
}

impl ShortestPathFollower {
    /// A guide that leads `agent` to the nearest of `goals`.
    pub fn new(agent: AgentId, grid: Arc<NavGrid>, goals: &[NavCell], stride: StepSizes) -> Self {
        let field = Arc::new(grid.distance_field(goals));
        Self {
            agent,
            grid,
            field,
            stride,
            blocked: 0,
            escape: 0,
            escapes: 0,
            opening: None,
            aim: None,
        }
    }

    /// The grid on which it leads.
    pub fn grid(&self) -> &Arc<NavGrid> {
        &self.grid
    }

    /// The agent that it leads.
    pub fn agent(&self) -> AgentId {
        self.agent
    }

    /// Geodesic distance of the agent to the goals, m; `None` off the grid or without a way.
    pub fn distance_m(&self, world: &World) -> Option<f64> {
        let here = world.state().agents.get(self.agent)?.position;
        self.field.at(self.grid.nearest(here, 0.5)?)
    }

    /// Geodesic distance of a cell to the goals, m.
    pub fn distance_at(&self, cell: NavCell) -> Option<f64> {
        self.field.at(cell)
    }

    /// The next step of the path; `None` when it stands on a goal or there is no path.
    pub fn next_action(&mut self, world: &World) -> Option<DiscreteAction> {
        let agent = *world.state().agents.get(self.agent)?;
        let here = self.grid.nearest(agent.position, 0.6)?;
        if self.field.at(here)? <= 0.0 {
            return None;
        }
        if let Some(step) = self.avoid_swinging_door(world, here) {
            return Some(step);
        }
        if let Some(door) = self.closed_door_ahead(world, here) {
            return Some(self.open(world, door));
        }
        self.follow(&self.field.clone(), &agent, here)
    }

    /// A step down a distance field, or one that frees the agent where it is stuck.
    fn follow(
        &mut self,
        field: &DistanceField,
        agent: &AgentState,
        here: NavCell,
    ) -> Option<DiscreteAction> {
        if let Some(step) = self.escape(agent.collided) {
            self.aim = None;
            return Some(step);
        }
        let aim = self.next_waypoint(field, here, agent)?;
        self.aim = Some(aim);
        let direction = self.grid.position(aim) - agent.position;
        let tolerance = if direction.length() > FAR_M {
            WALKING
        } else {
            AHEAD
        };
        Some(
            turn_towards(agent.yaw_rad, direction, (tolerance, &self.stride))
                .unwrap_or(DiscreteAction::MoveForward),
        )
    }

    /// Steps out of the way of a door that swings towards it, and from there opens it wholly; `None` when no door is held up.
    fn avoid_swinging_door(&mut self, world: &World, here: NavCell) -> Option<DiscreteAction> {
        let opening = self.opening.take()?;
        let open = world.state().openness(world.house(), opening.door);
        if open.is_none_or(|open| open >= PASSABLE) {
            return None;
        }
        let (door, clear_cells_field) = (opening.door, opening.distance_to_clear_cells.clone());
        let is_within_reach = opening.is_within_reach;
        let opening = self.opening.insert(opening);
        let agent = *world.state().agents.get(self.agent)?;
        let clear_cells_field = clear_cells_field?;
        if clear_cells_field.at(here)? <= 0.0 {
            if is_within_reach {
                let step = self.open_from_here(world, door);
                // From here it is hidden: the way is gone anew.
                self.opening = self.opening.take().filter(|_| step.is_some());
                return step;
            }
            if opening.stands_still(world) {
                // It begins anew.
                self.opening = None;
                return None;
            }
            return Some(DiscreteAction::Wait);
        }
        self.follow(&clear_cells_field, &agent, here)
    }

    /// Frees the agent after grazing a corner or a door: some turns away from the path and a few steps usually suffice.
    fn escape(&mut self, collided: bool) -> Option<DiscreteAction> {
        self.blocked = if collided {
            self.blocked + 1
        } else {
            self.blocked.saturating_sub(1)
        };
        if self.blocked > 4 && self.escape == 0 {
            (self.blocked, self.escape, self.escapes) = (0, 8, self.escapes + 1);
        }
        self.escape = self.escape.checked_sub(1)?;
        let turn = if self.escapes.is_multiple_of(2) {
            DiscreteAction::TurnLeft
        } else {
            DiscreteAction::TurnRight
        };
        Some(if self.escape >= 3 {
            turn
        } else {
            DiscreteAction::MoveForward
        })
    }

    /// The cell of the path that it walks to next: the furthest one within reach of the eye. It keeps to the one before until it has
    /// come to it, or sees one that is further on the way: from beside the middle of a cell others seem nearest with each step.
    fn next_waypoint(
        &self,
        field: &DistanceField,
        here: NavCell,
        agent: &AgentState,
    ) -> Option<NavCell> {
        let way = self.grid.follow_gradient(field, here)?;
        let away_m = |cell: NavCell| self.grid.position(cell).distance(agent.position);
        let near = way.iter().take_while(|cell| away_m(**cell) <= AIM_AHEAD_M);
        let ahead: Vec<NavCell> = near.copied().collect();
        let mut ahead = ahead.into_iter().rev();
        let free = ahead.find(|cell| self.grid.is_straight_free(here, *cell));
        let next = *way.get(1).or(way.first())?;
        let furthest = free.filter(|cell| *cell != here).unwrap_or(next);
        let left_m = |cell: NavCell| field.at(cell).unwrap_or(f64::INFINITY);
        let is_ahead = |cell: &NavCell| {
            !agent.collided
                && away_m(*cell) > 0.5 * self.stride.forward_m
                && left_m(*cell) < left_m(here)
                && left_m(*cell) <= left_m(furthest)
        };
        Some(self.aim.filter(is_ahead).unwrap_or(furthest))
    }

    /// The turn to where it walks straight on, rad, positive to the left; 0 where it does not.
    pub(crate) fn turn_to_aim_rad(&self, agent: &AgentState) -> f32 {
        self.aim.map_or(0.0, |aim| {
            let direction = self.grid.position(aim) - agent.position;
            wrap_angle(yaw_from_forward(direction) - agent.yaw_rad)
        })
    }

    /// A jointed thing that stands in the way and is not open.
    fn closed_door_ahead(&self, world: &World, here: NavCell) -> Option<ObjectId> {
        let way = self.grid.follow_gradient(&self.field, here)?;
        let agent = world.state().agents.get(self.agent)?;
        let mut from = agent.position;
        let mut walked = 0.0;
        for cell in way {
            let to = self.grid.position(cell);
            walked += (to - from).length();
            if walked > DOOR_AHEAD_M {
                return None;
            }
            let lift = Vec3::Y * (agent.body.height_m * 0.6);
            let ray = Ray::segment(from + lift, to + lift, 0.0);
            if let Some(hit) = world.rays().closest(&ray, RayMask::AGENT)
                && let Some(Entity::Object(object)) =
                    world.house().entity(world.rays().surface(&hit).entity)
                && world
                    .state()
                    .openness(world.house(), object)
                    .is_some_and(|open| open < PASSABLE)
            {
                return Some(object);
            }
            from = to;
        }
        None
    }

    /// The next step of opening a thing in front of which it stands: towards it, or out of the way of its leaf.
    pub fn action_to_open(&mut self, world: &World, thing: ObjectId) -> DiscreteAction {
        let agent = world.state().agents.get(self.agent);
        let here = agent.and_then(|agent| self.grid.nearest(agent.position, 0.6));
        let aside = here.and_then(|here| self.avoid_swinging_door(world, here));
        aside.unwrap_or_else(|| self.open(world, thing))
    }

    /// Turns to a door and opens it, or walks towards it where it is hidden; waits while it opens.
    fn open(&mut self, world: &World, door: ObjectId) -> DiscreteAction {
        let step = self.open_from_here(world, door);
        step.or_else(|| action_towards_object(world, self.agent, door, &self.stride))
            .unwrap_or(DiscreteAction::MoveForward)
    }

    /// Turns to a door and opens it; `None` where its view cannot meet it.
    fn open_from_here(&mut self, world: &World, door: ObjectId) -> Option<DiscreteAction> {
        let agent = world.state().agents.get(self.agent)?;
        match look_at(
            world,
            agent,
            (door, LookTarget::Anywhere),
            &[],
            &self.stride,
        ) {
            LookAction::Turn(step) => return Some(step),
            LookAction::Missed => return None,
            LookAction::Done => {}
        }
        let opening = self.opening.take().filter(|opening| opening.door == door);
        let mut opening = opening.unwrap_or_else(|| DoorOpening::new(door));
        opening.count_open_request(world, &self.grid, self.agent);
        self.opening = Some(opening);
        Some(DiscreteAction::Open)
    }
}

/// The turn that brings `direction` ahead; `None` when it already is, within a share of a turn's step.
fn turn_towards(
    yaw_rad: f32,
    direction: Vec3,
    (tolerance, stride): (f32, &StepSizes),
) -> Option<DiscreteAction> {
    let error = wrap_angle(yaw_from_forward(direction) - yaw_rad);
    if error.abs() <= stride.turn_deg.to_radians() * tolerance {
        return None;
    }
    Some(if error > 0.0 {
        DiscreteAction::TurnLeft
    } else {
        DiscreteAction::TurnRight
    })
}

/// The turn or tilt that brings a point into the middle of an agent's view; `None` when it already is there.
pub(crate) fn action_towards_point(
    world: &World,
    agent: AgentId,
    target: Vec3,
    stride: &StepSizes,
) -> Option<DiscreteAction> {
    let agent = world.state().agents.get(agent)?;
    let direction = target - agent.eye_position();
    if let Some(turn) = turn_towards(agent.yaw_rad, direction, (AHEAD, stride)) {
        return Some(turn);
    }
    let error = pitch_from_forward(direction) - agent.pitch_rad;
    if error.abs() <= stride.look_deg.to_radians() * AHEAD {
        return None;
    }
    Some(if error > 0.0 {
        DiscreteAction::LookUp
    } else {
        DiscreteAction::LookDown
    })
}

/// The turn or tilt that brings an object into the middle of an agent's view; `None` when it already is there.
pub fn action_towards_object(
    world: &World,
    agent: AgentId,
    object: ObjectId,
    stride: &StepSizes,
) -> Option<DiscreteAction> {
    action_towards_point(
        world,
        agent,
        world.house().object_bounds(world.state(), object).center(),
        stride,
    )
}
