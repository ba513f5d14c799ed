//! Penetration resolution: by a push, a lift, moving neighbours, or another place near by.

use super::overlap::Penetration;
use super::placed_bodies::{PlacedBody, PlacedBodyIndex};
use super::{CLEARANCE_M, PenetrationResolver, ResolvedBody};
use crate::body::BodyStatus;
use crate::contact::entry_index;
use crate::convert::from_rapier;
use crate::model::{BodyDefinition, PieceOwner};
use dwell_scene::math::sin_cos;
use glam::Vec3;
use rapier3d::geometry::{Collider, Ray};
use rapier3d::math::Pose as RapierPose;
use rapier3d::pipeline::QueryFilter;
use std::f32::consts::TAU;

/// Pushes that are tried before lifting.
const MOST_PUSHES: usize = 24;
/// Heights that are tried when pushing does not help.
const LIFTS: usize = 10;
/// Distances and directions of the final search.
const DISTANCES: usize = 8;
const DIRECTIONS: usize = 12;
/// Most pushes from each of its places.
const MOST_PUSHES_BESIDE: usize = 3;
/// Depth of the search for a floor below, m.
const FLOOR_M: f32 = 100.0;

impl PenetrationResolver<'_> {
    /// Returns a place near `start` where a body overlaps nothing, on the same side of walls, floors and ceilings; `None`
    /// when there is none within the bound.
    pub(super) fn free_pose_near(
        &self,
        plan: &BodyDefinition,
        start: RapierPose,
        placed: &PlacedBodyIndex,
    ) -> Option<RapierPose> {
        let lifted = || {
            let place = self.lift(plan, start, placed)?;
            self.is_reached(plan, &start, &place).then_some(place)
        };
        self.push_up_or_down(plan, start, placed, self.push_limits())
            .or_else(lifted)
    }

    /// Lifts a body out of something that it has sunk into by more than half, where no floor is below it.
    pub(super) fn lift_out(
        &self,
        plan: &BodyDefinition,
        start: RapierPose,
        placed: &PlacedBodyIndex,
    ) -> Option<RapierPose> {
        if self.has_floor(plan, &start) {
            return None;
        }
        let pushed = self.push(plan, start, placed, (Vec3::Y, self.push_limits()));
        pushed.or_else(|| self.lift(plan, start, placed))
    }

    fn push_limits(&self) -> (f32, usize) {
        (self.settings.config.max_start_shift_m, MOST_PUSHES)
    }

    fn lift(
        &self,
        plan: &BodyDefinition,
        start: RapierPose,
        placed: &PlacedBodyIndex,
    ) -> Option<RapierPose> {
        let bound = self.settings.config.max_start_shift_m;
        (1..=LIFTS).find_map(|k| {
            let mut place = start;
            place.translation.y += bound * k as f32 / LIFTS as f32;
            self.is_clear(plan, &place, placed).then_some(place)
        })
    }

    /// Pushes a body to the side or up, or down from under something, but never through a wall, floor or ceiling.
    fn push_up_or_down(
        &self,
        plan: &BodyDefinition,
        start: RapierPose,
        placed: &PlacedBodyIndex,
        limits: (f32, usize),
    ) -> Option<RapierPose> {
        let push = |way| {
            let place = self.push(plan, start, placed, (way, limits))?;
            self.is_reached(plan, &start, &place).then_some(place)
        };
        let down = || {
            let floor = self.has_floor(plan, &start);
            floor.then(|| push(Vec3::NEG_Y)).flatten()
        };
        push(Vec3::Y).or_else(down)
    }

    /// Pushes a body out of its deepest overlap repeatedly: to the side, or where it lies on or under something, the `way`
    /// up or down. `limits`: the distance, m, and the number.
    fn push(
        &self,
        plan: &BodyDefinition,
        start: RapierPose,
        placed: &PlacedBodyIndex,
        (way, (bound, most)): (Vec3, (f32, usize)),
    ) -> Option<RapierPose> {
        let mut place = start;
        for _ in 0..=most {
            let Some(overlap) = self
                .overlap(plan, &place, placed)
                .filter(|overlap| self.exceeds_tolerance(overlap))
            else {
                return from_rapier(&place).is_valid().then_some(place);
            };
            let n = overlap.normal;
            let direction = if n.y.abs() > 0.5 {
                way
            } else {
                let along = way * n.dot(way).max(0.0);
                (Vec3::new(n.x, 0.0, n.z) + along).normalize_or(way)
            };
            place.translation += direction * (overlap.depth_m + CLEARANCE_M);
            if (place.translation - start.translation).length() > bound {
                return None;
            }
        }
        None
    }

    fn is_clear(
        &self,
        plan: &BodyDefinition,
        place: &RapierPose,
        placed: &PlacedBodyIndex,
    ) -> bool {
        let overlap = self.overlap(plan, place, placed);
        overlap.is_none_or(|overlap| !self.exceeds_tolerance(&overlap))
            && from_rapier(place).is_valid()
    }

    /// Returns whether a body's middle moves straight to another place through no wall, floor or ceiling.
    fn is_reached(&self, plan: &BodyDefinition, start: &RapierPose, place: &RapierPose) -> bool {
        let way = place.translation - start.translation;
        !self.is_barred(plan.bounds(start).center(), way)
    }

    fn has_floor(&self, plan: &BodyDefinition, place: &RapierPose) -> bool {
        self.is_barred(plan.bounds(place).center(), Vec3::NEG_Y * FLOOR_M)
    }

    /// Moves placed bodies that a body overlaps out of its way. Returns them, with their overlaps; `None`, and nothing is
    /// changed, when that does not help.
    pub(super) fn move_neighbours(
        &self,
        index: usize,
        resolved: &mut [ResolvedBody],
        placed: &mut PlacedBodyIndex,
    ) -> Option<Vec<(usize, Penetration)>> {
        let plan = &self.model.bodies[index];
        let start = resolved[index].pose;
        let mut others: Vec<(PlacedBody, Penetration)> = Vec::new();
        for one in placed.intersecting(&plan.bounds(&start)) {
            let other = one.body as usize;
            let movable = self.model.bodies[other].joint.is_none()
                && resolved[other].status == BodyStatus::Free;
            let found = self.overlap_of_two(plan, &start, &one);
            others.extend(
                found
                    .filter(|overlap| movable && self.exceeds_tolerance(overlap))
                    .map(|overlap| (one, overlap)),
            );
        }
        if others.is_empty() {
            return None;
        }
        for (other, _) in &others {
            placed.remove(other.body as usize);
        }
        let ways = self.separating_poses(index, start, &others, placed);
        placed.remove(index);
        for (other, _) in &others {
            placed.reinsert(*other);
        }
        let (place, ways) = ways?;
        resolved[index].pose = place;
        for ((other, _), way) in others.iter().zip(ways) {
            let other = other.body as usize;
            resolved[other].pose = way;
            placed.insert(self.model, other, way);
        }
        let told = others.into_iter();
        Some(
            told.map(|(other, overlap)| (other.body as usize, overlap))
                .collect(),
        )
    }

    /// Returns the displacement of a body from `start`, and of the bodies that it overlaps there, each out of the way of those before.
    fn separating_poses(
        &self,
        index: usize,
        start: RapierPose,
        others: &[(PlacedBody, Penetration)],
        standing: &mut PlacedBodyIndex,
    ) -> Option<(RapierPose, Vec<RapierPose>)> {
        let plan = &self.model.bodies[index];
        let place = self.push_up_or_down(plan, start, standing, self.push_limits())?;
        standing.insert(self.model, index, place);
        let mut ways = Vec::with_capacity(others.len());
        for (other, _) in others {
            let other = other.body as usize;
            let plan = &self.model.bodies[other];
            let way =
                self.push_up_or_down(plan, self.body_pose(other), standing, self.push_limits())?;
            standing.insert(self.model, other, way);
            ways.push(way);
        }
        Some((place, ways))
    }

    /// Returns the nearest place beside a body where it overlaps nothing; never behind a wall.
    pub(super) fn nearest_free_pose(
        &self,
        plan: &BodyDefinition,
        start: RapierPose,
        placed: &PlacedBodyIndex,
    ) -> Option<RapierPose> {
        let bound = self.settings.config.max_start_shift_m;
        (0..DISTANCES * DIRECTIONS).find_map(|k| {
            let distance = bound * (k / DIRECTIONS + 1) as f32 / DISTANCES as f32;
            let (sin, cos) = sin_cos(TAU * (k % DIRECTIONS) as f32 / DIRECTIONS as f32);
            let mut place = start;
            place.translation += Vec3::new(cos, 0.0, sin) * distance;
            let near = bound - distance;
            let place = self.push_up_or_down(plan, place, placed, (near, MOST_PUSHES_BESIDE))?;
            self.is_reached(plan, &start, &place).then_some(place)
        })
    }

    /// Returns whether a wall, floor or ceiling is in the way.
    fn is_barred(&self, from: Vec3, way: Vec3) -> bool {
        let is_structure = |_, collider: &Collider| {
            matches!(self.owner(entry_index(collider)), PieceOwner::Structure(_))
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&is_structure));
        queries.cast_ray(&Ray::new(from, way), 1.0, true).is_some()
    }
}
