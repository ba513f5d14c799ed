//! Routes that are drawn: an end, a start, and a way between them.

use super::step_candidates::StepCandidates;
use crate::tasks::door_leaves::DoorLeaves;
use crate::tasks::navigation::{NavigationGoal, NavigationRules};
use crate::tasks::random_yaw_rad;
use crate::tasks::standing_room::FreeStartCells;
use crate::world::World;
use dwell_scene::navigation::{DistanceField, NavCell, NavGrid};
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_semantics::SemanticScene;
use dwell_semantics::instruct::{
    DescribedPath, InstructionStep, RouteInstruction, StepCondition, StepKind, room_changes,
};
use glam::Vec3;
use std::sync::Arc;

/// One of so many routes ends in a room, the others at a thing.
const ENDS_IN_ROOM: usize = 4;
/// One of so many routes goes by a place that is drawn, the others the shortest way.
const GOES_BY: usize = 2;
/// Distance of the cell nearest to a place of the way, m.
const NEAR_M: f32 = 0.3;

/// A route before it has words.
pub(super) struct DrawnRoute {
    pub(super) route: RouteInstruction,
    /// What is so at its end.
    pub(super) end: StepCondition,
    /// Where that is.
    pub(super) goal: Arc<NavigationGoal>,
    pub(super) start: NavCell,
    pub(super) yaw_rad: f32,
}

/// A source of drawn routes.
pub(super) struct RouteSampler<'a> {
    pub(super) pool: &'a StepCandidates,
    pub(super) world: &'a World,
    pub(super) scene: &'a SemanticScene<'a>,
    pub(super) grid: &'a NavGrid,
    pub(super) rules: &'a NavigationRules,
    pub(super) leaves: &'a DoorLeaves,
    pub(super) room: &'a FreeStartCells,
    /// Height of the agent's eyes above its feet, m.
    pub(super) eye_m: f32,
}

impl RouteSampler<'_> {
    /// A route; `None` where that which was drawn cannot be told.
    pub(super) fn draw(&self, key: RandomKey) -> Option<DrawnRoute> {
        let grid = self.grid;
        let mut stream = key.stream();
        let planned = self.pool.plan(self.end(&mut stream)?, &[0])?;
        let end = planned.step.conditions[0];
        let goal = planned.targets[0].legs[0].goal.clone();
        let to_end = grid.distance_field(&goal.cells);
        let is_ground = |cell: NavCell| grid.island(cell) == Some(0);
        let via = if stream.below(GOES_BY) == 0 {
            let is_before = |cell| is_ground(cell) && to_end.at(cell).is_some();
            Some(grid.sample(key.child("by"), is_before)?)
        } else {
            None
        };
        let to_via = via.map(|via| (grid.distance_field(&[via]), to_end.at(via)));
        let way_m = |cell: NavCell| match &to_via {
            Some((field, rest_m)) => Some(field.at(cell)? + (*rest_m)?),
            None => to_end.at(cell),
        };
        let straight_m = |cell: NavCell| {
            let from = grid.position(cell);
            let straight = goal.cells.iter();
            let straight = straight.map(|to| grid.position(*to).distance(from));
            f64::from(straight.fold(f32::INFINITY, f32::min))
        };
        let allows = |cell: NavCell, way_m: f64| self.rules.allow_start(way_m, || straight_m(cell));
        let allowed = |cell: NavCell| {
            is_ground(cell)
                && way_m(cell).is_some_and(|way_m| allows(cell, way_m))
                && !self.leaves.is_blocked(grid, cell)
        };
        let start = self.room.sample(grid, key.child("start"), allowed)?;
        let to_via = to_via.map(|(field, _)| field);
        let corners = self.corners(start, via.zip(to_via.as_ref()), &to_end)?;
        let yaw_rad = random_yaw_rad(key);
        let way = DescribedPath {
            corners: &corners,
            yaw_rad,
            eye_m: self.eye_m,
            end,
        };
        let route = RouteInstruction::generate((self.scene, self.world.rays()), way, &mut stream)?;
        allows(start, route.length_m()).then_some(DrawnRoute {
            route,
            end,
            goal,
            start,
            yaw_rad,
        })
    }

    /// Where a route ends: a room, or a thing.
    fn end(&self, stream: &mut RandomStream) -> Option<InstructionStep> {
        let pool = self.pool;
        if stream.below(ENDS_IN_ROOM) == 0 {
            return pool.go_to_step(*stream.choose(&pool.rooms())?);
        }
        let things = pool.by_kind.get(&StepKind::FindObject)?;
        pool.object_step(StepKind::FindObject, *stream.choose(things)?)
    }

    /// The corners of the way: the shortest one, or the shortest one through the rooms that one goes through by a place.
    fn corners(
        &self,
        start: NavCell,
        via: Option<(NavCell, &DistanceField)>,
        to_end: &DistanceField,
    ) -> Option<Vec<Vec3>> {
        let grid = self.grid;
        let places = |cells: &[NavCell]| -> Vec<Vec3> {
            let corners = grid.corners(cells).into_iter();
            corners.map(|cell| grid.position(cell)).collect()
        };
        let Some((via, to_via)) = via else {
            return Some(places(&grid.follow_gradient(to_end, start)?));
        };
        let mut by_place = places(&grid.follow_gradient(to_via, start)?);
        by_place.extend(places(&grid.follow_gradient(to_end, via)?));
        let mut corners = Vec::new();
        let mut here = start;
        for entry in room_changes(self.scene, &by_place) {
            let next = grid.nearest(entry, NEAR_M)?;
            corners.extend(places(&grid.path(here, next)?));
            here = next;
        }
        corners.extend(places(&grid.follow_gradient(to_end, here)?));
        corners.dedup();
        Some(corners)
    }
}
