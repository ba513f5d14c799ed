//! Support of a tree with a free root: its contact points with the ground.

use super::convex_solver::SymmetricMatrix;
use super::tree_dynamics::Wrench;
use crate::engine::RapierWorld;
use glam::{DVec3, Vec3};
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::geometry::{
    Collider, ColliderHandle, ContactManifold, ContactPair, SolverContact, TypedShape,
};

/// Distance from a surface within which a point is in contact, m.
const CONTACT_GAP_M: f32 = 1e-3;
/// Least vertical component of the normal of a supporting surface.
const MIN_NORMAL_Y: f32 = 0.5;
/// Sine of the largest tilt at which a cylinder lies on its side.
const MAX_TILT_SIN: f32 = 0.2;
/// Relative regularization of the three equations where fewer than three points support.
const REGULARIZATION: f64 = 1e-9;

/// A contact point on which a tree stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupportPoint {
    /// The joint whose body is supported; `None`: the root.
    pub(super) link: Option<usize>,
    /// m.
    pub(super) position: DVec3,
    pub(super) friction: f64,
}

/// Returns the points where a body stands on something outside its tree.
pub(super) fn support_points(
    engine: &RapierWorld,
    handle: RigidBodyHandle,
    link: Option<usize>,
    tree: &[RigidBodyHandle],
) -> Vec<SupportPoint> {
    let mut supports = Vec::new();
    let colliders = engine.bodies.get(handle).map_or(&[][..], |b| b.colliders());
    for own in colliders {
        for pair in engine.narrow_phase.contact_pairs_with(*own) {
            let first = pair.collider1 == *own;
            let other = if first {
                pair.collider2
            } else {
                pair.collider1
            };
            let parent = engine.colliders.get(other).and_then(Collider::parent);
            if parent.is_none_or(|parent| tree.contains(&parent)) {
                continue;
            }
            for plane in pair.solver_manifolds() {
                if !supports_from_below(engine, *own, plane, first) {
                    continue;
                }
                for contact in &plane.data.solver_contacts {
                    if contact.dist > CONTACT_GAP_M {
                        continue;
                    }
                    let at = contact_position(engine, pair, plane, contact);
                    supports.push(SupportPoint {
                        link,
                        position: at,
                        friction: plane.data.friction.into(),
                    });
                }
            }
        }
    }
    supports.sort_by(|a, b| {
        a.position
            .x
            .total_cmp(&b.position.x)
            .then(a.position.z.total_cmp(&b.position.z))
    });
    supports
}

/// Returns whether a contact plane supports a body from below on fixed points. A wheel's does not: it stands on another
/// line in every step. `first`: whether the body's is the first of its colliders.
pub(super) fn supports_from_below(
    engine: &RapierWorld,
    own: ColliderHandle,
    plane: &ContactManifold,
    first: bool,
) -> bool {
    let normal = if first {
        -plane.data.normal
    } else {
        plane.data.normal
    };
    let on_its_side = |own: &Collider| {
        let axis = own.position().rotation * Vec3::Y;
        own.shape().as_cylinder().is_some() && axis.dot(normal).abs() < MAX_TILT_SIN
    };
    normal.y >= MIN_NORMAL_Y && !engine.colliders.get(own).is_some_and(on_its_side)
}

/// Returns the present position of a contact point's surfaces, m. Flat bodies carry their points along; on rolling ones
/// they stay where it is nearest.
pub(super) fn contact_position(
    engine: &RapierWorld,
    pair: &ContactPair,
    plane: &ContactManifold,
    contact: &SolverContact,
) -> DVec3 {
    let point = plane.points.get(contact.contact_indices()[0] as usize);
    let on = |collider, body: Option<RigidBodyHandle>, arm: Option<Vec3>, outward: Vec3| {
        let collider = engine.colliders.get(collider)?;
        match collider.shape().as_typed_shape() {
            TypedShape::Ball(ball) => Some(collider.position().translation + outward * ball.radius),
            TypedShape::Cylinder(_) | TypedShape::Capsule(_) | TypedShape::Cone(_) => {
                let body = body.and_then(|body| engine.bodies.get(body))?;
                Some(body.center_of_mass() + arm?)
            }
            _ => None,
        }
    };
    let (data, normal) = (&plane.data, plane.data.normal);
    let arms = point.map(|point| (point.data.solver_dp1, point.data.solver_dp2));
    let (first, second) = (arms.map(|arms| arms.0), arms.map(|arms| arms.1));
    let rolled = on(pair.collider1, data.rigid_body1, first, normal)
        .or_else(|| on(pair.collider2, data.rigid_body2, second, -normal))
        .map(Vec3::as_dvec3);
    rolled.unwrap_or_else(|| {
        let (p, q) = plane
            .data
            .solver_contact_world_points(contact, &engine.bodies);
        0.5 * (p.as_dvec3() + q.as_dvec3())
    })
}

/// The vertical forces with the least squares that carry a weight (about the origin), as far as pushes can: with the balance
/// `A f = w` of force and two moments, `f = A^T (A A^T)^-1 w`. Shape (support,), N.
pub(super) fn support_forces(
    supports: &[SupportPoint],
    weight: &Wrench,
    center: DVec3,
) -> Vec<f64> {
    let mut carries = vec![true; supports.len()];
    let mut forces = vec![0.0; supports.len()];
    let moment = weight.torque - center.cross(weight.force);
    let needed = [weight.force.y, moment.x, moment.z];
    let row = |support: &SupportPoint| {
        let arm = support.position - center;
        [1.0, -arm.z, arm.x]
    };
    // Each iteration releases at least one point that would have to pull.
    for _ in 0..supports.len() {
        let mut squares = SymmetricMatrix::zero(3);
        for (support, _) in supports
            .iter()
            .zip(&carries)
            .filter(|(_, carries)| **carries)
        {
            let row = row(support);
            for (j, a) in row.iter().enumerate() {
                for (k, b) in row.iter().enumerate().take(j + 1) {
                    squares.add(j, k, a * b);
                }
            }
        }
        let ridge = REGULARIZATION * squares.get(0, 0).max(1e-9);
        for k in 0..3 {
            squares.add(k, k, ridge);
        }
        // (A A^T)^-1 w.
        let shares = squares.cholesky().solve(&needed);
        let mut pulls = false;
        for (k, support) in supports.iter().enumerate() {
            let force: f64 = row(support).iter().zip(&shares).map(|(a, b)| a * b).sum();
            forces[k] = if carries[k] { force.max(0.0) } else { 0.0 };
            if carries[k] && force < 0.0 {
                carries[k] = false;
                pulls = true;
            }
        }
        if !pulls {
            break;
        }
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, z: f64) -> SupportPoint {
        SupportPoint {
            link: None,
            position: DVec3::new(x, 0.0, z),
            friction: 0.5,
        }
    }

    fn weight(newton: f64, x: f64, z: f64) -> Wrench {
        let force = DVec3::Y * newton;
        Wrench {
            force,
            torque: DVec3::new(x, 0.3, z).cross(force),
        }
    }

    /// On four feet the forces balance the weight and its moment; nearer feet carry more; on the edge the far ones nothing.
    #[test]
    fn feet_carry_a_weight_in_balance() {
        let feet = [at(-1.0, -1.0), at(1.0, -1.0), at(-1.0, 1.0), at(1.0, 1.0)];
        for (x, z) in [(0.0, 0.0), (0.5, 0.2), (-0.9, 0.05), (0.999, 0.0)] {
            let found = support_forces(&feet, &weight(100.0, x, z), DVec3::new(0.2, 0.4, 0.1));
            let sum: f64 = found.iter().sum();
            let along = |of: fn(&SupportPoint) -> f64| -> f64 {
                feet.iter()
                    .zip(&found)
                    .map(|(foot, force)| of(foot) * force)
                    .sum()
            };
            assert!((sum - 100.0).abs() < 1e-5, "{found:?}");
            assert!(
                (along(|s| s.position.x) - 100.0 * x).abs() < 1e-4,
                "{found:?}"
            );
            assert!(
                (along(|s| s.position.z) - 100.0 * z).abs() < 1e-4,
                "{found:?}"
            );
            assert!(found.iter().all(|force| *force >= 0.0), "{found:?}");
        }
        let tips = support_forces(&feet, &weight(100.0, 3.0, 0.0), DVec3::ZERO);
        assert!(
            tips.iter().all(|force| *force >= 0.0) && tips[0] == 0.0,
            "{tips:?}"
        );
    }
}
