//! An agent's hand that moves things before an episode begins. What it did from where one can stand, the agent can undo.

use super::movable_things::{LEAST_CELLS, MovableThing, cells_near};
use crate::error::WorldError;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::cells_in_reach;
use crate::world::World;
use dwell_physics::BodyState;
use dwell_physics::actions::{Drop, Pick, PlaceAt, PlaceInPose};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::navigation::NavCell;
use dwell_scene::random::RandomStream;
use dwell_scene::space::yaw_from_forward;
use dwell_scene::{Aabb, AgentBody, AgentId, ObjectId, Pose, Velocity};
use glam::Vec3;

/// Points of a piece of furniture that are tried.
const POINTS: usize = 24;
/// Places from which they are tried.
const STANDS: usize = 6;
/// Share of the reach that it uses, so that somebody beside reaches there, too.
const REACH_SHARE: f32 = 0.85;
/// Least room between a thing and the places that are kept free, m.
const APART_M: f32 = 0.02;
/// Steepest surface that counts as level: least upward part of its normal.
const LEVEL: f32 = 0.95;

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
    pub(in crate::tasks) fn puts_back(
        &mut self,
        thing: &MovableThing,
        stream: &mut RandomStream,
    ) -> Result<Option<NavCell>, WorldError> {
        let (object, before) = (thing.object, self.pose(thing.object));
        let cells: Vec<NavCell> = thing.cells.iter().copied().collect();
        for _ in 0..2 {
            let Some(cell) = stream.choose(&cells).filter(|cell| (self.is_free)(**cell)) else {
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

    /// Moves a thing that [`Self::puts_back`] from `cell` to one of some supports. Returns whether it was moved; else it lies as before.
    ///
    /// `is_allowed`: whether it may lie at a point.
    pub(in crate::tasks) fn move_to_support(
        &mut self,
        (object, cell): (ObjectId, NavCell),
        supports: &[ObjectId],
        stream: &mut RandomStream,
        is_allowed: &dyn Fn(&World, ObjectId, Vec3) -> bool,
    ) -> Result<bool, WorldError> {
        let before = self.pose(object);
        let size = self.bounds(object).size();
        let radius_m = 0.5 * size.length();
        for _ in 0..STANDS {
            dwell_scene::interrupt::unwind_if_cancelled();
            let Some(support) = stream.choose(supports).copied() else {
                return Ok(false);
            };
            let bounds = self.bounds(support);
            let eye_m = self.body.eye_height_m;
            let reach_m = REACH_SHARE * self.body.reach_m;
            let near = cells_near(self.ground, &bounds, (eye_m, reach_m));
            let Some(stand) = stream.choose(&near).copied() else {
                continue;
            };
            if !(self.is_free)(stand) {
                continue;
            }
            let eye = self.ground.grid.position(stand) + Vec3::Y * eye_m;
            let points: Vec<Vec3> = (0..POINTS)
                .filter_map(|_| self.level_point(eye, &bounds, support, stream))
                .filter(|point| self.is_clear(*point, radius_m))
                .filter(|point| is_allowed(self.world, support, *point))
                .take(4)
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

    /// A level point of an object that an eye sees and a hand reaches.
    fn level_point(
        &self,
        eye: Vec3,
        bounds: &Aabb,
        object: ObjectId,
        stream: &mut RandomStream,
    ) -> Option<Vec3> {
        let (low, high) = (bounds.min, bounds.max);
        let to = Vec3::new(
            stream.range(low.x, high.x),
            stream.range(low.y, high.y),
            stream.range(low.z, high.z),
        );
        let ray = Ray::new(eye, to - eye);
        let hit = self.world.rays().closest(&ray, RayMask::EYE)?;
        let surface = self.world.rays().surface(&hit);
        let own = surface.entity == self.world.house().entity_of_object(object);
        let near = hit.distance_m <= REACH_SHARE * self.body.reach_m;
        (own && near && surface.normal.y.abs() >= LEVEL).then(|| ray.point_at(hit.distance_m))
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
