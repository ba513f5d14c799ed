//! Contacts of rolling cylinders.
//!
//! For a cylinder on a flat surface, the general search for nearest points finds the line of contact only to a tenth of a
//! radian (its distance hardly changes there), and with it a tilted normal: a cart on such wheels jerks, and stops on a
//! slope. While a cylinder turns about its axis, its line of contact is computed from the flat face instead.

use super::collider_entry::{ColliderMetadata, entry_index};
use crate::body::BodyHandle;
use crate::engine::RapierWorld;
use crate::model::RollableCylinder;
use glam::Vec3;
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{Collider, ColliderHandle, Cylinder, TypedShape};
use rapier3d::pipeline::{ActiveHooks, ModifiableManifold};

/// Sine of the largest tilt at which a cylinder lies on its side.
const MAX_TILT_SIN: f32 = 0.2;
/// Cosine of the largest angle between the normal found and a face's own.
const MIN_NORMAL_COS: f32 = 0.99;
/// Contact points move with the side up from the face, by `r (1 - cos w t)` in a step; rapier knows a drift at a steady
/// rate only. This share of the displacement at the end of a step keeps the error smallest over all substeps.
const LIFT_SHARE: f32 = 0.75;

/// Makes rapier ask the hook about a cylinder while it `rolls`. `asked`: whether it asks about an entry at other times.
/// Returns whether that changed.
pub(crate) fn set_rolling_hook(
    engine: &mut RapierWorld,
    rolls: bool,
    own: Option<ColliderHandle>,
    asked: impl Fn(usize) -> bool,
) -> bool {
    let Some(own) = own else {
        return false;
    };
    let Some(collider) = engine.colliders.get(own) else {
        return false;
    };
    let hooks = collider.active_hooks();
    let flag = ActiveHooks::MODIFY_SOLVER_CONTACTS;
    if rolls == hooks.contains(flag) {
        return false;
    }
    let wanted = rolls || asked(entry_index(collider));
    if wanted == hooks.contains(flag) {
        return false;
    }
    if let Some(collider) = engine.colliders.get_mut(own) {
        let mut hooks = hooks;
        hooks.set(flag, wanted);
        collider.set_active_hooks(hooks);
    }
    true
}

/// Makes rapier ask the hook about the cylinders that rolled at the time of a snapshot. `built`: the rebuilt world, with
/// its bodies in order and its entries; `bodies`: those of the snapshot.
pub(crate) fn restore_rolling_hooks(
    rollers: &[RollableCylinder],
    built: (&mut RapierWorld, &[BodyHandle], &[ColliderMetadata]),
    bodies: &RigidBodySet,
    asked: impl Fn(&ColliderMetadata) -> bool,
) {
    let (engine, handles, entries) = built;
    for roller in rollers {
        let handle = handles[roller.body()].handle;
        let own = engine.bodies.get(handle);
        let own = own.and_then(|body| roller.collider(body));
        let asked = |index: usize| entries.get(index).is_some_and(&asked);
        let rolls = bodies
            .get(handle)
            .is_some_and(|body| roller.is_rolling(body));
        set_rolling_hook(engine, rolls, own, asked);
    }
}

/// Moves the contacts of a cylinder on a flat surface to its line of contact, and makes the normal upright. `turns`:
/// angular velocities of the first and second body, rad/s.
pub(super) fn correct_line_contact(
    plane: &mut ModifiableManifold<'_>,
    (one, two): (&Collider, &Collider),
    turns: (Vec3, Vec3),
    dt_s: f32,
) {
    let as_cylinder = |collider: &Collider| collider.shape().as_cylinder().copied();
    let (cylinder, own, other, first) = match (as_cylinder(one), as_cylinder(two)) {
        (Some(cylinder), None) => (cylinder, one, two, true),
        (None, Some(cylinder)) => (cylinder, two, one, false),
        _ => return,
    };
    let Cylinder {
        half_height,
        radius,
    } = cylinder;
    let place = own.position();
    let axis = place.rotation * Vec3::Y;
    let found = if first { *plane.normal } else { -*plane.normal };
    if axis.dot(found).abs() > MAX_TILT_SIN {
        return;
    }
    let subshape = if first {
        plane.manifold.subshape2
    } else {
        plane.manifold.subshape1
    };
    let Some((face, point)) = face(other, -found, subshape) else {
        return;
    };
    let way = -face;
    let Some(radial) = (way - axis * axis.dot(way)).try_normalize() else {
        return;
    };
    let spin = (if first { turns.0 } else { turns.1 }).dot(axis);
    let drift = way * (LIFT_SHARE * 0.5 * radius * spin * spin * dt_s);
    for contact in plane.solver_contacts.iter_mut() {
        let middle = (contact.anchor1 + contact.anchor2) * 0.5;
        let along = (middle - place.translation).dot(axis);
        let side =
            place.translation + axis * along.clamp(-half_height, half_height) + radial * radius;
        let gap = (point - side).dot(way);
        let below = side + way * gap;
        (contact.anchor1, contact.anchor2) = if first { (side, below) } else { (below, side) };
        contact.dist = gap;
        contact.tangent_velocity += if first { drift } else { -drift };
    }
    *plane.normal = if first { way } else { -way };
}

/// Returns the normal and a point of a shape's face that is directed along `wanted`, in the world; `None` without one.
fn face(collider: &Collider, wanted: Vec3, subshape: u32) -> Option<(Vec3, Vec3)> {
    let place = collider.position();
    let looks = place.rotation.inverse() * wanted;
    let (normal, point) = match collider.shape().as_typed_shape() {
        TypedShape::Cuboid(cuboid) => {
            let k = looks.abs().max_position();
            let mut normal = Vec3::ZERO;
            normal[k] = looks[k].signum();
            (normal, normal * cuboid.half_extents[k])
        }
        TypedShape::TriMesh(mesh) => {
            let corners = mesh.indices().get(subshape as usize)?;
            let [a, b, c] = corners.map(|k| mesh.vertices()[k as usize]);
            let normal = (b - a).cross(c - a).try_normalize()?;
            (normal * normal.dot(looks).signum(), a)
        }
        TypedShape::ConvexPolyhedron(hull) => {
            let faces = hull.faces().iter();
            let face = faces.max_by(|a, b| a.normal.dot(looks).total_cmp(&b.normal.dot(looks)))?;
            let corner = hull
                .vertices_adj_to_face()
                .get(face.first_vertex_or_edge as usize)?;
            (face.normal, hull.points()[*corner as usize])
        }
        _ => return None,
    };
    (normal.dot(looks) > MIN_NORMAL_COS).then(|| {
        let normal = place.rotation * normal;
        (normal, place.rotation * point + place.translation)
    })
}
