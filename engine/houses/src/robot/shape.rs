//! Conversion of shapes into triangles and collision pieces.

use dwell_scene::{Collider, Mesh, Pose, math};
use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::{PI, TAU};

use super::model::{LinkShape, ShapeGeometry};
use crate::import::convex_pieces;

/// Corners around a cylinder, and bands of a half ball.
const AROUND: u32 = 32;
const BANDS: u32 = 8;

impl ShapeGeometry {
    /// Its sizes, m.
    pub(super) fn dimensions(&self) -> Vec<f32> {
        match self {
            Self::Cuboid { half } => half.to_array().to_vec(),
            Self::Ball { radius } => vec![*radius],
            Self::Cylinder {
                half_height,
                radius,
            }
            | Self::Capsule {
                half_height,
                radius,
            } => vec![*half_height, *radius],
            Self::Ellipsoid { radii } => radii.to_array().to_vec(),
            Self::Mesh { scale, .. } => scale.abs().to_array().to_vec(),
        }
    }

    /// Returns whether its sizes are finite and positive.
    pub(super) fn is_valid(&self) -> bool {
        self.dimensions()
            .iter()
            .all(|x| (1e-6..=1000.0).contains(x))
    }

    /// Its surface.
    pub(crate) fn surface(&self) -> Mesh {
        match self {
            Self::Cuboid { half } => {
                let cuboid = Mesh::cuboid(-*half, *half);
                Mesh {
                    positions: cuboid.positions,
                    triangles: cuboid.triangles,
                    ..Mesh::default()
                }
            }
            Self::Ball { radius } => revolve(&capsule_profile(*radius, 0.0)),
            Self::Ellipsoid { radii } => {
                let mut mesh = revolve(&capsule_profile(1.0, 0.0));
                mesh.positions.iter_mut().for_each(|p| *p *= *radii);
                mesh
            }
            Self::Capsule {
                half_height,
                radius,
            } => revolve(&capsule_profile(*radius, *half_height)),
            Self::Cylinder {
                half_height,
                radius,
            } => revolve(&[
                (0.0, -half_height),
                (*radius, -half_height),
                (*radius, *half_height),
                (0.0, *half_height),
            ]),
            Self::Mesh { mesh, scale } => {
                let mut mesh = Mesh::clone(mesh);
                mesh.positions.iter_mut().for_each(|p| *p *= *scale);
                if scale.element_product() < 0.0 {
                    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
                }
                mesh
            }
        }
    }
}

/// The outline (distance from the axis, height) of a ball whose halves stand apart.
fn capsule_profile(radius: f32, apart: f32) -> Vec<(f32, f32)> {
    let half = |from: f32, shift: f32| {
        (0..=BANDS).map(move |k| {
            let (s, c) = math::sin_cos(from + 0.5 * PI * k as f32 / BANDS as f32);
            (radius * c.max(0.0), radius * s + shift)
        })
    };
    let lower = half(-0.5 * PI, -apart);
    let upper = half(0.0, apart).skip(usize::from(apart == 0.0));
    lower.chain(upper).collect()
}

/// An outline turned about Z, from its lowest point up.
fn revolve(outline: &[(f32, f32)]) -> Mesh {
    let mut mesh = Mesh::default();
    for (radius, height) in outline {
        for k in 0..AROUND {
            let (s, c) = math::sin_cos(TAU * k as f32 / AROUND as f32);
            mesh.positions
                .push(Vec3::new(radius * c, radius * s, *height));
        }
    }
    for ring in 0..outline.len() as u32 - 1 {
        for k in 0..AROUND {
            let (a, b) = (ring * AROUND + k, ring * AROUND + (k + 1) % AROUND);
            let (c, d) = (a + AROUND, b + AROUND);
            if outline[ring as usize].0 > 1e-9 {
                mesh.triangles.push([a, b, d]);
            }
            if outline[ring as usize + 1].0 > 1e-9 {
                mesh.triangles.push([a, d, c]);
            }
        }
    }
    mesh
}

/// Rotates Y, along which our cylinders stand, into Z.
fn z_from_y() -> Pose {
    Pose::new(Vec3::ZERO, Quat::from_rotation_arc(Vec3::Y, Vec3::Z))
}

/// The collision pieces of a shape at a pose.
pub(super) fn colliders(shape: &LinkShape, part_from_shape: &Pose) -> Vec<Collider> {
    let ball = |along: f32, radius: f32| Collider::Ball {
        center: part_from_shape.transform_point(Vec3::Z * along),
        radius,
    };
    let cylinder = |half_height: f32, radius: f32| Collider::Cylinder {
        part_from_cylinder: *part_from_shape * z_from_y(),
        half_height,
        radius,
    };
    match &shape.geometry {
        ShapeGeometry::Cuboid { half } => vec![Collider::Cuboid {
            part_from_box: *part_from_shape,
            half_extents: *half,
        }],
        ShapeGeometry::Ball { radius } => vec![ball(0.0, *radius)],
        ShapeGeometry::Cylinder {
            half_height,
            radius,
        } => vec![cylinder(*half_height, *radius)],
        ShapeGeometry::Capsule {
            half_height,
            radius,
        } => vec![
            cylinder(*half_height, *radius),
            ball(*half_height, *radius),
            ball(-half_height, *radius),
        ],
        ShapeGeometry::Ellipsoid { .. } => {
            convex_pieces(&shape.geometry.surface(), &part_from_shape.to_affine())
        }
        ShapeGeometry::Mesh { mesh, scale } => {
            let map = part_from_shape.to_affine() * Affine3A::from_scale(*scale);
            convex_pieces(mesh, &map)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed surfaces with the volume of the solid (inscribed polygons lack a little: 32 corners, 0.6 %).
    #[test]
    fn surfaces_are_closed_and_look_outwards() {
        let (r, h) = (0.2_f64, 0.3_f64);
        let ball = 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
        let tube = 2.0 * h * std::f64::consts::PI * r * r;
        let solids = [
            (ShapeGeometry::Ball { radius: 0.2 }, ball),
            (
                ShapeGeometry::Cylinder {
                    half_height: 0.3,
                    radius: 0.2,
                },
                tube,
            ),
            (
                ShapeGeometry::Capsule {
                    half_height: 0.3,
                    radius: 0.2,
                },
                ball + tube,
            ),
        ];
        for (solid, volume) in solids {
            let mesh = solid.surface();
            mesh.check("solid").unwrap();
            let share = mesh.enclosed_volume_m3() / volume;
            assert!((0.96..1.0).contains(&share), "{solid:?}: {share}");
        }
    }
}
