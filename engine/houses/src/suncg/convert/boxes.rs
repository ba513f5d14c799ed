//! Box nodes: twelve triangles with one slot a face.

use dwell_scene::Mesh;
use glam::{Vec2, Vec3};

/// The slots of the faces: +y 0, -y 1, -x 2, +x 3, +z 4, -z 5, as the format numbers them.
const FACES: [(usize, f32, u16); 6] = [
    (1, 1.0, 0),
    (1, -1.0, 1),
    (0, -1.0, 2),
    (0, 1.0, 3),
    (2, 1.0, 4),
    (2, -1.0, 5),
];

/// A box of full extents `size`, m, around the origin; texture coordinates in metres from a corner of each face.
pub(super) fn mesh(size: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    for (axis, side, slot) in FACES {
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let base = mesh.positions.len() as u32;
        let mut normal = Vec3::ZERO;
        normal[axis] = side;
        for (a, b) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
            let mut corner = Vec3::ZERO;
            corner[axis] = side * 0.5 * size[axis];
            corner[first] = a * size[first];
            corner[second] = b * size[second];
            mesh.positions.push(corner);
            mesh.normals.push(normal);
            mesh.uvs
                .push(Vec2::new((a + 0.5) * size[first], (b + 0.5) * size[second]));
        }
        let triangles = if side > 0.0 {
            [[0, 1, 2], [0, 2, 3]]
        } else {
            [[0, 2, 1], [0, 3, 2]]
        };
        mesh.triangles
            .extend(triangles.map(|triangle| triangle.map(|k: u32| base + k)));
        mesh.slots.extend([slot, slot]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_look_outwards_and_carry_the_slots_of_the_format() {
        let mesh = mesh(Vec3::new(1.0, 0.5, 0.3));
        assert!((mesh.enclosed_volume_m3() - 0.15).abs() < 1e-6);
        let expected = [
            Vec3::Y,
            Vec3::NEG_Y,
            Vec3::NEG_X,
            Vec3::X,
            Vec3::Z,
            Vec3::NEG_Z,
        ];
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(k);
            let normal = (b - a).cross(c - a).normalize();
            assert!(normal.abs_diff_eq(expected[usize::from(mesh.slots[k])], 1e-6));
            assert!(normal.abs_diff_eq(mesh.normals[triangle[0] as usize], 1e-6));
        }
        assert_eq!(
            mesh.uvs.iter().copied().reduce(Vec2::max),
            Some(Vec2::new(1.0, 1.0))
        );
    }
}
