//! Sizes of bodies.

use crate::model::BodyDefinition;
use rapier3d::geometry::{SharedShape, TypedShape};
use std::f32::consts::PI;

/// The mean cross-section of a body's pieces: a quarter of their surface.
pub(super) fn cross_section_m2(plan: &BodyDefinition) -> f32 {
    plan.pieces
        .iter()
        .map(|piece| surface_m2(&piece.shape))
        .sum::<f32>()
        * 0.25
}

fn surface_m2(shape: &SharedShape) -> f32 {
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => 4.0 * PI * ball.radius * ball.radius,
        TypedShape::Cuboid(cuboid) => {
            let h = cuboid.half_extents;
            8.0 * (h.x * h.y + h.y * h.z + h.z * h.x)
        }
        TypedShape::Cylinder(cylinder) => {
            2.0 * PI * cylinder.radius * (2.0 * cylinder.half_height + cylinder.radius)
        }
        TypedShape::ConvexPolyhedron(hull) => {
            let (points, triangles) = hull.to_trimesh();
            let area = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|k| points[k as usize]);
                0.5 * (b - a).cross(c - a).length()
            };
            triangles.iter().map(area).sum()
        }
        _ => 0.0,
    }
}

/// The volume of a body's pieces.
pub(super) fn volume_m3(plan: &BodyDefinition) -> f32 {
    plan.pieces
        .iter()
        .map(|piece| piece.shape.mass_properties(1.0).mass())
        .sum()
}
