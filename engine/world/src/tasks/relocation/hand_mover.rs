//! An agent's hand that moves things before an episode begins. What it did from where one can stand, the agent can undo.

use super::movable_things::{LEAST_CELLS, MovableThing, cells_near};
use crate::error::WorldError;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::cells_in_reach;
use crate::world::World;
use dwell_physics::actions::{Drop, Pick, Place, PlaceAt, PlaceInPose};
use dwell_physics::{AgentPlacement, BodyState};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::navigation::NavCell;
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::space::{pitch_from_forward, yaw_from_forward};
use dwell_scene::{Aabb, AgentBody, AgentId, ObjectId, Pose, SurfaceOwner, Velocity};
use glam::Vec3;

/// Points of a piece of furniture that are tried.
const POINTS: usize = 24;
/// Places from which they are tried.
const STANDS: usize = 6;
/// Share of the reach that it uses.
const REACH_SHARE: f32 = 0.95;
/// Half of an edge of the floor around a cell on which points are tried, m.
const FLOOR_M: f32 = 0.3;
/// Distance around a thing on the floor at which one can walk, m.
const AROUND_M: f32 = 0.6;
/// Least room between a thing and the places that are kept free, m.
const APART_M: f32 = 0.02;
/// Steepest surface that counts as level: least upward part of its normal.
const LEVEL: f32 = 0.95;

/// Where a thing is moved to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tasks) enum MoveTarget {
    /// A level surface of furniture.
    Object(ObjectId),
    /// The floor, anywhere.
    Floor,
}

/// Moves things by an agent's hand.
pub(in crate::tasks) struct HandMover<'a> {
    pub(in crate::tasks) world: &'a mut World,
    pub(in crate::tasks) agent: AgentId,
    pub(in crate::tasks) body: AgentBody,
    pub(in crate::tasks) ground: &'a LargestIslandIndex<'a>,
    /// Whether the agent can stand on a cell.
    pub(in crate::tasks) is_free: &'a dyn Fn(NavCell) -> bool,
    /// Boxes where nothing may be put, m.
    pub(in crate::tasks) kept_free: Vec<Aabb>,
}

impl HandMover<'_> {
    /// Puts the agent on a cell, ahead of a point.
    fn stand(&mut self, cell: NavCell, ahead: Vec3) -> Result<(), WorldError> {
        let feet = self.ground.grid.position(cell);
        let yaw_rad = yaw_from_forward(ahead - feet);
        self.world.place_agent(self.agent, feet, yaw_rad)
    }

    fn holds(&self, object: ObjectId) -> bool {
        let agent = self.world.state().agents.get(self.agent);
        agent.is_some_and(|agent| agent.holding == Some(object))
    }

    fn pose(&self, object: ObjectId) -> Pose {
        let part = self.world.house().objects[object].first_part;
        self.world.state().part_pose[part]
    }

    fn bounds(&self, object: ObjectId) -> Aabb {
        let world = &self.world;
        world.house().object_bounds(world.state(), object)
    }

    /// Takes a thing from a cell.
    fn take(&mut self, object: ObjectId, cell: NavCell) -> Result<bool, WorldError> {
        self.stand(cell, self.bounds(object).center())?;
        let taken = self.world.act(self.agent, &Pick::new(object));
        Ok(taken.success)
    }

    /// Puts a thing where it was before, out of the hand.
    fn give_up(&mut self, object: ObjectId, pose: Pose) -> Result<(), WorldError> {
        if self.holds(object) {
            self.world.act(self.agent, &Drop {});
        }
        let part = self.world.house().objects[object].first_part;
        self.world.set_bodies(&[BodyState {
            part,
            pose,
            velocity: Velocity::default(),
        }])
    }

    /// Takes a thing and puts it back, from one of its cells; returns that cell where this works. The thing then lies as hands put it.
    pub(in crate::tasks) fn try_put_back(
        &mut self,
        thing: &MovableThing,
        stream: &mut RandomStream,
    ) -> Result<Option<NavCell>, WorldError> {
        let (object, before) = (thing.object, self.pose(thing.object));
        for _ in 0..2 {
            let Some(cell) = stream
                .choose(&thing.cells)
                .filter(|cell| (self.is_free)(**cell))
            else {
                continue;
            };
            if !self.take(object, *cell)? {
                continue;
            }
            let back = PlaceInPose {
                world_from_part: before,
            };
            if self.world.act(self.agent, &back).success {
                return Ok(Some(*cell));
            }
            self.give_up(object, before)?;
        }
        Ok(None)
    }

    /// Takes a thing and puts it down again on the level surface at which it looks, from one of its cells; returns that cell where the
    /// thing then lies as `is_right` says. Where it does not it lies as before.
    pub(in crate::tasks) fn try_put_down(
        &mut self,
        thing: &MovableThing,
        stream: &mut RandomStream,
        is_right: &dyn Fn(&World) -> bool,
    ) -> Result<Option<NavCell>, WorldError> {
        let (object, before) = (thing.object, self.pose(thing.object));
        let bounds = self.bounds(object);
        let foot = bounds.center().with_y(bounds.min.y);
        for _ in 0..2 {
            let cell = stream.choose(&thing.cells).copied();
            let Some(cell) = cell.filter(|cell| (self.is_free)(*cell)) else {
                continue;
            };
            if !self.take(object, cell)? {
                continue;
            }
            let feet = self.ground.grid.position(cell);
            let down = foot - (feet + Vec3::Y * self.body.eye_height_m);
            self.world.set_agents(&[AgentPlacement {
                pitch_rad: pitch_from_forward(down),
                ..AgentPlacement::at_rest(self.agent, feet, yaw_from_forward(down))
            }])?;
            let put = self.world.act(self.agent, &Place::default());
            if put.success && is_right(self.world) {
                return Ok(Some(cell));
            }
            self.give_up(object, before)?;
        }
        Ok(None)
    }

    /// Moves a thing that [`Self::try_put_back`] from `cell` to one of some targets. Returns whether it was moved; else it lies as before.
    ///
    /// `is_allowed`: whether it may lie at a point of a target.
    pub(in crate::tasks) fn try_move_to(
        &mut self,
        (object, cell): (ObjectId, NavCell),
        targets: &[MoveTarget],
        stream: &mut RandomStream,
        is_allowed: &dyn Fn(&World, MoveTarget, Vec3) -> bool,
    ) -> Result<bool, WorldError> {
        let before = self.pose(object);
        let radius_m = 0.5 * self.bounds(object).size().length();
        for _ in 0..STANDS {
            dwell_scene::interrupt::unwind_if_cancelled();
            let Some(target) = stream.choose(targets).copied() else {
                return Ok(false);
            };
            let Some(bounds) = self.bounds_of(target, stream) else {
                continue;
            };
            let eye_m = self.body.eye_height_m;
            let reach_m = REACH_SHARE * self.body.reach_m;
            let near = cells_near(self.ground, &bounds, (eye_m, reach_m));
            let stand = stream.choose(&near).copied();
            let Some(stand) = stand.filter(|cell| (self.is_free)(*cell)) else {
                continue;
            };
            let eye = self.ground.grid.position(stand) + Vec3::Y * eye_m;
            let points: Vec<Vec3> = (0..POINTS)
                .filter_map(|_| self.level_point(eye, &bounds, target, stream))
                .filter(|point| self.is_clear(*point, radius_m))
                .filter(|point| is_allowed(self.world, target, *point))
                .take(POINTS / 6)
                .collect();
            if points.is_empty() || !self.take(object, cell)? {
                continue;
            }
            for point in points {
                self.stand(stand, point)?;
                if !self.holds(object) {
                    break;
                }
                if self.world.act(self.agent, &PlaceAt { point }).success {
                    if self.is_reached(object) {
                        return Ok(true);
                    }
                    break;
                }
            }
            self.give_up(object, before)?;
        }
        Ok(false)
    }

    /// The box of furniture, or of a piece of floor that is drawn, m.
    fn bounds_of(&self, target: MoveTarget, stream: &mut RandomStream) -> Option<Aabb> {
        match target {
            MoveTarget::Object(object) => Some(self.bounds(object)),
            MoveTarget::Floor => {
                let grid = self.ground.grid;
                let key = RandomKey::root(stream.bits());
                let cell = grid.sample(key, |cell| (self.is_free)(cell) && self.is_open(cell))?;
                let at = grid.position(cell);
                let reach = Vec3::new(FLOOR_M, 0.0, FLOOR_M);
                Some(Aabb::new(at - reach, at + reach))
            }
        }
    }

    /// Returns whether one can walk around a cell, so that what lies there bars no way.
    fn is_open(&self, cell: NavCell) -> bool {
        let grid = self.ground.grid;
        let at = grid.position(cell);
        let sides = [-1, 0, 1].map(|x| [-1, 0, 1].map(|z| Vec3::new(x as f32, 0.0, z as f32)));
        let mut around = sides.as_flattened().iter();
        around.all(|side| {
            let there = grid.nearest(at + AROUND_M * *side, grid.config().cell_m);
            there.is_some_and(|there| grid.island(there) == Some(0))
        })
    }

    /// A level point of a target that an eye sees and a hand reaches.
    fn level_point(
        &self,
        eye: Vec3,
        bounds: &Aabb,
        target: MoveTarget,
        stream: &mut RandomStream,
    ) -> Option<Vec3> {
        let (low, high) = (bounds.min, bounds.max);
        let to = low
            + (high - low)
                * Vec3::new(
                    stream.uniform_f32(),
                    stream.uniform_f32(),
                    stream.uniform_f32(),
                );
        let ray = Ray::new(eye, to - eye);
        let hit = self.world.rays().closest(&ray, RayMask::EYE)?;
        let surface = self.world.rays().surface(&hit);
        let is_target = match (target, surface.owner) {
            (MoveTarget::Object(object), SurfaceOwner::Part(part)) => {
                self.world.house().parts[part].object == object
            }
            (MoveTarget::Floor, SurfaceOwner::Structure(_)) => true,
            _ => false,
        };
        let near = hit.distance_m <= REACH_SHARE * self.body.reach_m;
        (is_target && near && surface.normal.y.abs() >= LEVEL).then(|| ray.point_at(hit.distance_m))
    }

    fn is_clear(&self, point: Vec3, radius_m: f32) -> bool {
        let around = Aabb::new(point, point).grown(radius_m + APART_M);
        !self.kept_free.iter().any(|other| other.intersects(&around))
    }

    /// Returns whether a thing can be taken from enough places.
    fn is_reached(&self, object: ObjectId) -> bool {
        cells_in_reach(self.world, self.agent, self.ground, object).len() >= LEAST_CELLS
    }
}
