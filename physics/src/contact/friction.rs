//! Friction impulses of a step.
//!
//! rapier keeps the friction of the last substep alone. The total contact impulse on a body is its change of momentum less
//! gravity; without the normal impulses, which rapier sums over all substeps, that is friction. So friction is exact for a
//! body with one contact; with several, each is estimated from the last substep.

use super::collector::ContactReport;
use crate::engine::{FrictionImpulseLayout, points};
use glam::Vec3;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::geometry::ContactManifold;
use std::collections::BTreeSet;

impl FrictionImpulseLayout {
    /// Returns the friction of a plane in the last substep, N·s, on its first body.
    pub(super) fn last_substep_friction(self, plane: &ContactManifold) -> Vec3 {
        let each = points(plane).map(|(_, point)| point.warmstart_tangent_world);
        if self.patch_friction {
            // A new point holds none yet.
            each.fold(Vec3::ZERO, |most, one| {
                if one.length_squared() > most.length_squared() {
                    one
                } else {
                    most
                }
            })
        } else {
            each.sum()
        }
    }

    /// Estimates the friction of a plane in a run of rapier, N·s, at the ratio to the normal impulse of the last substep.
    pub(super) fn estimated_step_friction(self, plane: &ContactManifold) -> f32 {
        let (mut all, mut last) = (0.0, 0.0);
        for (_, point) in points(plane) {
            all += point.impulse;
            last += point.warmstart_impulse;
        }
        let substeps = if last > 0.0 {
            (all / last).max(1.0)
        } else {
            1.0
        };
        self.last_substep_friction(plane).length() * substeps
    }
}

/// Replaces estimates by the friction that a body's change of momentum gives. `reports`: of one run, sorted by pair.
pub(super) fn friction_from_momentum(reports: &mut [ContactReport]) {
    // Bodies with more than one contact partner.
    let (mut touched, mut shared) = (BTreeSet::new(), BTreeSet::new());
    let number = |(body, _): (RigidBodyHandle, Vec3)| body.into_raw_parts();
    for group in reports.chunk_by(|a, b| a.pair == b.pair) {
        let bodies: BTreeSet<(u32, u32)> = group
            .iter()
            .flat_map(|report| report.impulse_on_bodies)
            .flatten()
            .map(number)
            .collect();
        for body in bodies {
            if !touched.insert(body) {
                shared.insert(body);
            }
        }
    }
    for group in reports.chunk_by_mut(|a, b| a.pair == b.pair) {
        let pressed: Vec3 = group
            .iter()
            .map(|report| report.normal_impulse_on_second)
            .sum();
        let alone = |side: usize| {
            let pushed = group[0].impulse_on_bodies[side]?;
            // All pieces of the pair move with one body.
            let one = group.iter().all(|report| {
                report.impulse_on_bodies[side].is_some_and(|other| number(other) == number(pushed))
            });
            (one && !shared.contains(&number(pushed))).then_some(pushed.1)
        };
        let second = alone(1).map(|pushed| pushed - pressed);
        let friction = second.or_else(|| alone(0).map(|pushed| pushed + pressed));
        if let Some(friction) = friction {
            for report in group.iter_mut() {
                report.tangential = 0.0;
            }
            group[0].tangential = friction.length();
        }
    }
}
