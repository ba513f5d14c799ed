//! Contact forces on the bodies of a tree, besides the support of a free root.
//!
//! Joints' efforts depend on the velocity at the end of a step. A finger that presses on an object does not get the
//! velocity that it would have alone, and a motor that assumed so would hardly press. So the equations of a tree include
//! the contact forces of the last step; from step to step these converge to those that its motors give.

use super::support;
use super::tree_dynamics::Wrench;
use crate::engine::RapierWorld;
use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::geometry::{Collider, ContactManifold, ContactPair};

/// Largest separation speed of surfaces that are taken to press on each other in the next step too, m/s.
const PARTING_M_S: f64 = 0.02;

/// A surface that presses on a body of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExternalContact {
    /// The joint whose body is touched; `None`: the root.
    pub(super) link: Option<usize>,
    /// Point of application, m.
    pub(super) point: DVec3,
    /// Normal force and friction, and torsional friction about `at`.
    wrench: Wrench,
}

impl ExternalContact {
    /// Returns force and moment about a point.
    pub(super) fn wrench_about(&self, point: DVec3) -> Wrench {
        let Wrench {
            force,
            torque: moment,
        } = self.wrench;
        Wrench {
            force,
            torque: moment + (self.point - point).cross(force),
        }
    }

    /// Returns the same about the world's origin.
    pub(super) fn wrench_about_origin(&self) -> Wrench {
        self.wrench_about(DVec3::ZERO)
    }
}

/// Returns the contact forces on the bodies of a tree, in a fixed order. `stands`: whether support from below is left out;
/// contacts within the tree never are, or it would press on itself one way only.
pub(super) fn tree_contacts(
    engine: &RapierWorld,
    bodies: &[(RigidBodyHandle, Option<usize>)],
    stands: bool,
) -> Vec<ExternalContact> {
    let mut found: Vec<ExternalContact> = Vec::new();
    for (handle, link) in bodies {
        let Some(body) = engine.bodies.get(*handle) else {
            continue;
        };
        let mut own: Vec<ExternalContact> = Vec::new();
        for collider in body.colliders() {
            for pair in engine.narrow_phase.contact_pairs_with(*collider) {
                let first = pair.collider1 == *collider;
                let other = if first {
                    pair.collider2
                } else {
                    pair.collider1
                };
                let Some(parent) = engine.colliders.get(other).and_then(Collider::parent) else {
                    continue;
                };
                for plane in pair.solver_manifolds() {
                    let itself = bodies.iter().any(|(handle, _)| *handle == parent);
                    if stands
                        && !itself
                        && support::supports_from_below(engine, *collider, plane, first)
                    {
                        continue;
                    }
                    let touch = of_plane(engine, (body, *link), parent, (pair, plane), first);
                    own.extend(touch);
                }
            }
        }
        own.sort_by(|a, b| {
            a.point
                .x
                .total_cmp(&b.point.x)
                .then(a.point.y.total_cmp(&b.point.y))
                .then(a.point.z.total_cmp(&b.point.z))
        });
        found.extend(own);
    }
    found
}

fn of_plane(
    engine: &RapierWorld,
    (body, link): (&RigidBody, Option<usize>),
    other: RigidBodyHandle,
    (pair, plane): (&ContactPair, &ContactManifold),
    first: bool,
) -> Option<ExternalContact> {
    let side = if first { -1.0 } else { 1.0 };
    let normal = plane.data.normal * side;
    let per_s = f64::from(engine.substep_s()).recip();
    let (mut press, mut moment) = (0.0, DVec3::ZERO);
    let (mut friction, mut twist, mut count) = (DVec3::ZERO, 0.0, 0.0);
    for contact in &plane.data.solver_contacts {
        let Some(point) = plane.points.get(contact.contact_indices()[0] as usize) else {
            continue;
        };
        // That of the last substep: an impact's earlier impulse is over.
        let push = f64::from(point.data.warmstart_impulse) * per_s;
        press += push;
        moment += support::contact_position(engine, pair, plane, contact) * push;
        friction += point.data.warmstart_tangent_world.as_dvec3() * per_s;
        twist += f64::from(point.data.warmstart_twist_impulse) * per_s;
        count += 1.0;
    }
    if press <= 0.0 {
        return None;
    }
    if engine.friction_storage().patch_friction {
        // Each point holds the friction of the whole patch.
        friction /= count;
        twist /= count;
    }
    let (at, normal) = (moment / press, normal.as_dvec3());
    let other = engine.bodies.get(other)?;
    let velocity = |body: &RigidBody| {
        let arm = at - body.center_of_mass().as_dvec3();
        body.linvel().as_dvec3() + body.angvel().as_dvec3().cross(arm)
    };
    if (velocity(body) - velocity(other)).dot(normal) > PARTING_M_S {
        return None;
    }
    // rapier keeps the impulse on the first body, and turns it about the normal that points into it.
    Some(ExternalContact {
        link,
        point: at,
        wrench: Wrench {
            force: normal * press - friction * f64::from(side),
            torque: normal * twist,
        },
    })
}
