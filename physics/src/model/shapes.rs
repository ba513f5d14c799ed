//! Collision shapes from the scene's colliders and meshes.

use crate::convert::to_rapier;
use dwell_scene::{Aabb, Collider, Mesh, Pose};
use glam::{Affine3A, Vec3};
use rapier3d::geometry::{SharedShape, TriMeshFlags};
use rapier3d::math::Pose as RapierPose;

/// Half the thickness below which a solid piece is thickened, m: thinner ones tunnel and have no volume.
const THINNEST_HALF_EDGE_M: f32 = 0.001;
/// Corners of a hull beyond which only the outermost ones along fixed directions are kept.
const MOST_HULL_CORNERS: usize = 96;
/// Twice the area below which a triangle is left out: it has no normal, m².
const FLAT_TRIANGLE: f32 = 1e-9;

/// A shape and its pose on its part; the triangles kept, for a mesh.
pub(crate) struct PlacedShape {
    pub(crate) shape: SharedShape,
    pub(crate) part_from_shape: RapierPose,
    /// For each triangle of the shape, the triangle of the mesh. Empty for a convex piece.
    pub(crate) triangles: Vec<u32>,
}

impl PlacedShape {
    fn convex(shape: SharedShape, part_from_shape: RapierPose) -> Self {
        Self {
            shape,
            part_from_shape,
            triangles: Vec::new(),
        }
    }
}

/// Returns the shape of a convex piece; `None` for [`Collider::ExactMesh`] and for pieces without extent.
pub(crate) fn convex_shape(piece: &Collider) -> Option<PlacedShape> {
    match piece {
        Collider::Cuboid {
            part_from_box,
            half_extents,
        } => {
            let half = half_extents.abs().max(Vec3::splat(THINNEST_HALF_EDGE_M));
            let shape = SharedShape::cuboid(half.x, half.y, half.z);
            (half.is_finite() && part_from_box.is_valid())
                .then(|| PlacedShape::convex(shape, to_rapier(part_from_box)))
        }
        Collider::Ball { center, radius } => {
            (center.is_finite() && radius.is_finite()).then(|| {
                let radius = radius.max(THINNEST_HALF_EDGE_M);
                PlacedShape::convex(
                    SharedShape::ball(radius),
                    RapierPose::from_translation(*center),
                )
            })
        }
        Collider::Cylinder {
            part_from_cylinder,
            half_height,
            radius,
        } => {
            let finite =
                half_height.is_finite() && radius.is_finite() && part_from_cylinder.is_valid();
            finite.then(|| {
                let shape = SharedShape::cylinder(
                    half_height.max(THINNEST_HALF_EDGE_M),
                    radius.max(THINNEST_HALF_EDGE_M),
                );
                PlacedShape::convex(shape, to_rapier(part_from_cylinder))
            })
        }
        Collider::Hull { points } => convex_hull(points),
        Collider::ExactMesh => None,
    }
}

/// Returns the convex hull of points, or their box where they span no volume; `None` without a finite point.
pub(crate) fn convex_hull(points: &[Vec3]) -> Option<PlacedShape> {
    let bounds = Aabb::from_points(points.iter().copied());
    if bounds.is_empty() {
        return None;
    }
    let thick = bounds.size().min_element() > 2.0 * THINNEST_HALF_EDGE_M;
    let hull = thick
        .then(|| SharedShape::convex_hull(&outermost(points)))
        .flatten();
    // A slanted sheet has a fat box and no volume.
    let hull = hull.filter(|shape| {
        let volume = shape.mass_properties(1.0).mass();
        volume.is_finite() && volume > 1e-3 * bounds.volume()
    });
    Some(if let Some(shape) = hull {
        PlacedShape::convex(shape, RapierPose::IDENTITY)
    } else {
        let half = (bounds.size() * 0.5).max(Vec3::splat(THINNEST_HALF_EDGE_M));
        let shape = SharedShape::cuboid(half.x, half.y, half.z);
        PlacedShape::convex(shape, RapierPose::from_translation(bounds.center()))
    })
}

/// Returns the points themselves, or the outermost ones along evenly spread directions where there are many.
fn outermost(points: &[Vec3]) -> Vec<Vec3> {
    let finite: Vec<Vec3> = points.iter().copied().filter(|p| p.is_finite()).collect();
    if finite.len() <= MOST_HULL_CORNERS {
        return finite;
    }
    // Directions of a spherical Fibonacci lattice.
    let golden = std::f32::consts::PI * (5.0_f32.sqrt() - 1.0);
    let mut kept: Vec<usize> = (0..MOST_HULL_CORNERS)
        .filter_map(|k| {
            let y = 1.0 - 2.0 * (k as f32 + 0.5) / MOST_HULL_CORNERS as f32;
            let (s, c) = dwell_scene::math::sin_cos(golden * k as f32);
            let r = (1.0 - y * y).max(0.0).sqrt();
            let direction = Vec3::new(r * c, y, r * s);
            (0..finite.len()).max_by(|a, b| {
                direction
                    .dot(finite[*a])
                    .total_cmp(&direction.dot(finite[*b]))
            })
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|k| finite[k]).collect()
}

/// Returns the triangles of a mesh under `part_from_mesh`, two-sided; `None` when none has an area.
pub(crate) fn triangle_mesh(mesh: &Mesh, part_from_mesh: &Affine3A) -> Option<PlacedShape> {
    let corners: Vec<Vec3> = mesh
        .positions
        .iter()
        .map(|p| part_from_mesh.transform_point3(*p))
        .collect();
    let mirrored = part_from_mesh.matrix3.determinant() < 0.0;
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    let mut indices = Vec::with_capacity(mesh.triangles.len());
    for (k, [a, b, c]) in mesh.triangles.iter().copied().enumerate() {
        let [p, q, r] = [a, b, c].map(|vertex| corners[vertex as usize]);
        let area = (q - p).cross(r - p).length();
        if area.is_finite() && area > FLAT_TRIANGLE {
            triangles.push(k as u32);
            indices.push(if mirrored { [a, c, b] } else { [a, b, c] });
        }
    }
    if indices.is_empty() {
        return None;
    }
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;
    let shape = SharedShape::trimesh_with_flags(corners, indices, flags).ok()?;
    Some(PlacedShape {
        shape,
        part_from_shape: RapierPose::IDENTITY,
        triangles,
    })
}

/// Returns a shape's box under a pose, m.
pub(crate) fn bounds(shape: &SharedShape, world_from_shape: &RapierPose) -> Aabb {
    let aabb = shape.compute_aabb(world_from_shape);
    Aabb::new(aabb.mins, aabb.maxs)
}

/// Gap between a house and the fallback box, m.
const LAST_GAP_M: f32 = 0.5;
/// Thickness of that box's sides, m: more than anything falls in a physics step.
const LAST_SIDE_M: f32 = 1.0;

/// Returns the sides of the fallback box: objects that leave the house through an open door or window stay in it.
pub(crate) fn bounding_box_walls(house_bounds: &Aabb) -> [(SharedShape, Pose); 6] {
    let inner = house_bounds.grown(LAST_GAP_M);
    let (half, center) = (inner.size() * 0.5, inner.center());
    let side = |axis: usize, sign: f32| {
        let mut side_half = half + LAST_SIDE_M;
        side_half[axis] = 0.5 * LAST_SIDE_M;
        let mut place = center;
        place[axis] += sign * (half[axis] + 0.5 * LAST_SIDE_M);
        let shape = SharedShape::cuboid(side_half.x, side_half.y, side_half.z);
        (shape, Pose::from_position(place))
    };
    [
        (1, -1.0),
        (1, 1.0),
        (0, -1.0),
        (0, 1.0),
        (2, -1.0),
        (2, 1.0),
    ]
    .map(|(axis, sign)| side(axis, sign))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_of_a_box_has_its_volume_and_a_sheet_becomes_a_thin_box() {
        let corners = Aabb::new(Vec3::ZERO, Vec3::new(1.0, 2.0, 0.5)).corners();
        let shaped = convex_hull(&corners).unwrap();
        assert!((shaped.shape.mass_properties(1.0).mass() - 1.0).abs() < 1e-5);
        let sheet = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(1.0, 1.0, 1.0),
            Vec3::new(0.0, 1.0, 1.0),
        ];
        assert!(convex_hull(&sheet).unwrap().shape.as_cuboid().is_some());
        assert!(convex_hull(&[Vec3::splat(f32::NAN)]).is_none());
    }

    #[test]
    fn a_hull_of_many_points_keeps_most_of_its_volume() {
        // Points on a unit sphere: the kept hull has at least 90 % of 4/3 pi.
        let mut stream = dwell_scene::random::RandomKey::root(1).stream();
        let points: Vec<Vec3> = (0..5000).map(|_| stream.direction()).collect();
        let volume = convex_hull(&points)
            .unwrap()
            .shape
            .mass_properties(1.0)
            .mass();
        assert!(volume > 0.9 * 4.0 / 3.0 * std::f32::consts::PI, "{volume}");
    }

    #[test]
    fn flat_triangles_are_left_out_and_the_others_keep_their_numbers() {
        let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        mesh.triangles.insert(3, [0, 0, 1]);
        let shaped = triangle_mesh(&mesh, &Affine3A::IDENTITY).unwrap();
        assert_eq!(shaped.triangles.len(), 12);
        assert_eq!(&shaped.triangles[..4], [0, 1, 2, 4]);
    }
}
