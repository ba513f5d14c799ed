//! Overlaps at the start: detected on the collision pieces, resolved by small moves, or frozen, and reported.

mod collision_exclusions;
mod depenetrate;
mod overlap;
mod placed_bodies;

use crate::body::{BodyHandle, BodyStatus};
use crate::config::ResolvedConfig;
use crate::contact::ColliderMetadata;
use crate::engine::RapierWorld;
use crate::model::{BodyDefinition, PhysicsModel};
use crate::report::{FrozenObject, MovedObject, StartReport};
use dwell_scene::ObjectId;
use overlap::Penetration;
use placed_bodies::PlacedBodyIndex;
use rapier3d::math::Pose as RapierPose;
use std::collections::BTreeMap;

/// Gap left by a resolved overlap, m.
const CLEARANCE_M: f32 = 5e-4;

/// Most things that a body may overlap for its overlap to be resolved: with more, no place is found within some
/// centimetres, and each try tests all of them.
const MOST_OVERLAPPED: usize = 32;

pub(crate) struct PenetrationResolver<'a> {
    pub(crate) engine: &'a RapierWorld,
    pub(crate) model: &'a PhysicsModel,
    pub(crate) entries: &'a [ColliderMetadata],
    pub(crate) bodies: &'a [BodyHandle],
    pub(crate) settings: &'a ResolvedConfig,
}

/// The resolved pose of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ResolvedBody {
    pub(crate) pose: RapierPose,
    pub(crate) status: BodyStatus,
}

impl PenetrationResolver<'_> {
    fn body_pose(&self, body: usize) -> RapierPose {
        let handle = self.bodies[body].handle;
        self.engine
            .bodies
            .get(handle)
            .map_or(RapierPose::IDENTITY, |rigid| *rigid.position())
    }

    /// Frees every body from its overlaps, from the lowest up.
    pub(crate) fn resolve(&self, report: &mut StartReport) -> Vec<ResolvedBody> {
        let mut resolved: Vec<ResolvedBody> = (0..self.bodies.len())
            .map(|body| ResolvedBody {
                pose: self.body_pose(body),
                status: BodyStatus::Free,
            })
            .collect();
        let bounds = |body: usize| self.model.bodies[body].bounds(&resolved[body].pose);
        let mut order: Vec<(f32, usize)> = Vec::new();
        let mut placed = PlacedBodyIndex::default();
        for (index, plan) in self.model.bodies.iter().enumerate() {
            if plan.joint.is_some() {
                placed.insert(self.model, index, resolved[index].pose);
            } else {
                order.push((bounds(index).min.y, index));
            }
        }
        order.sort_by(|a, b| {
            let by_number = || {
                self.model.bodies[a.1]
                    .sort_key()
                    .cmp(&self.model.bodies[b.1].sort_key())
            };
            a.0.total_cmp(&b.0).then_with(by_number)
        });
        let mut deepest: BTreeMap<usize, Penetration> = BTreeMap::new();
        for (_, index) in order {
            let plan = &self.model.bodies[index];
            let start = resolved[index].pose;
            let found = self.overlap(plan, &start, &placed);
            if let Some(overlap) = found.filter(|overlap| self.exceeds_tolerance(overlap)) {
                report.overlaps += 1;
                deepest.insert(index, overlap);
                if self.is_crowded(plan, &start, &placed) {
                    resolved[index].status = BodyStatus::Frozen;
                } else if let Some(place) = self.free_pose_near(plan, start, &placed) {
                    resolved[index].pose = place;
                } else if let Some(others) = self.move_neighbours(index, &mut resolved, &mut placed)
                {
                    for (other, overlap) in others {
                        deepest.entry(other).or_insert(overlap);
                    }
                } else if let Some(place) = self
                    .nearest_free_pose(plan, start, &placed)
                    .or_else(|| self.lift_out(plan, start, &placed))
                {
                    resolved[index].pose = place;
                } else {
                    resolved[index].status = BodyStatus::Frozen;
                }
            }
            placed.insert(self.model, index, resolved[index].pose);
        }
        self.report_overlaps(&deepest, &resolved, report);
        resolved
    }

    /// Returns whether a body overlaps too many others to be freed.
    fn is_crowded(
        &self,
        plan: &BodyDefinition,
        place: &RapierPose,
        placed: &PlacedBodyIndex,
    ) -> bool {
        let near = placed.intersecting(&plan.bounds(place));
        let found = near
            .iter()
            .filter_map(|other| self.overlap_of_two(plan, place, other));
        found
            .filter(|overlap| self.exceeds_tolerance(overlap))
            .nth(MOST_OVERLAPPED)
            .is_some()
    }

    /// Reports the bodies that overlapped something.
    fn report_overlaps(
        &self,
        deepest: &BTreeMap<usize, Penetration>,
        resolved: &[ResolvedBody],
        report: &mut StartReport,
    ) {
        let mut moved: BTreeMap<ObjectId, MovedObject> = BTreeMap::new();
        for (index, overlap) in deepest {
            let object = self.model.bodies[*index].object;
            if resolved[*index].status == BodyStatus::Frozen {
                report.frozen.push(FrozenObject {
                    object,
                    overlap_m: overlap.depth_m,
                    with: overlap.other.name(&self.model.house),
                });
                continue;
            }
            let entry = moved.entry(object).or_insert(MovedObject {
                object,
                overlap_m: 0.0,
                distance_m: 0.0,
            });
            entry.overlap_m = entry.overlap_m.max(overlap.depth_m);
            let way = resolved[*index].pose.translation - self.body_pose(*index).translation;
            entry.distance_m = entry.distance_m.max(way.length());
        }
        report.moved = moved.into_values().collect();
        report.frozen.sort_by_key(|frozen| frozen.object);
    }

    fn exceeds_tolerance(&self, overlap: &Penetration) -> bool {
        overlap.depth_m > self.settings.config.overlap_tolerance_m
    }
}
