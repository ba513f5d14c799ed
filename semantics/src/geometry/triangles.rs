//! Triangles where they stand, and rays against them.

use dwell_scene::{Aabb, House, ObjectId, State, StructureId};
use glam::Vec3;

/// The triangles of an object where it stands in a state: each vertex is placed once.
pub(crate) struct PlacedTriangles {
    /// Vertices in world space, m.
    pub(crate) positions: Vec<Vec3>,
    /// The vertices of each triangle.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl PlacedTriangles {
    /// Places the triangles of `object` as it stands in `state`.
    pub(crate) fn gather(house: &House, state: &State, object: ObjectId) -> Self {
        let mut placed = Self {
            positions: Vec::new(),
            triangles: Vec::new(),
        };
        for id in house.objects[object].parts() {
            let part = &house.parts[id];
            let world_from_mesh = state.part_pose[id].to_affine() * part.part_from_mesh;
            let mesh = &house.meshes[part.mesh];
            let before = placed.positions.len() as u32;
            let vertices = mesh.positions.iter();
            placed
                .positions
                .extend(vertices.map(|vertex| world_from_mesh.transform_point3(*vertex)));
            let own = mesh.triangles.iter();
            placed
                .triangles
                .extend(own.map(|corners| corners.map(|vertex| before + vertex)));
        }
        placed
    }

    /// The vertices that triangles have, each once.
    pub(crate) fn used_positions(&self) -> impl Iterator<Item = Vec3> + '_ {
        let mut is_used = vec![false; self.positions.len()];
        for vertex in self.triangles.iter().flatten() {
            is_used[*vertex as usize] = true;
        }
        let all = self.positions.iter().zip(is_used);
        all.filter_map(|(position, is_used)| is_used.then_some(*position))
    }

    /// The corners of every triangle, m.
    pub(crate) fn corners(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        let corner = |vertex: u32| self.positions[vertex as usize];
        self.triangles
            .iter()
            .map(move |triangle| triangle.map(corner))
    }
}

/// Calls `visit` with the corners of the triangles of an object where it stands in `state`, in world space, m, without most of those that
/// do not reach into `reach`.
pub(crate) fn object_triangles_near(
    house: &House,
    state: &State,
    object: ObjectId,
    reach: &Aabb,
    mut visit: impl FnMut([Vec3; 3]),
) {
    // Wider by more than rounding.
    let wider = |bounds: Aabb| {
        let furthest = bounds.min.abs().max(bounds.max.abs()).max_element();
        bounds.grown(1e-5 * furthest)
    };
    for id in house.objects[object].parts() {
        let part = &house.parts[id];
        let world_from_mesh = state.part_pose[id].to_affine() * part.part_from_mesh;
        let mesh_from_world = world_from_mesh.inverse();
        let reach = wider(wider(reach.grown(1e-3)).transformed(&mesh_from_world));
        // The transform of a flattened mesh has no inverse.
        let all = !mesh_from_world.is_finite() || reach.is_empty();
        let mesh = &house.meshes[part.mesh];
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            if all || (low.cmple(reach.max).all() && high.cmpge(reach.min).all()) {
                visit([a, b, c].map(|corner| world_from_mesh.transform_point3(corner)));
            }
        }
    }
}

/// Calls `visit` with the corners of every triangle of a structure piece, m.
pub(crate) fn structure_triangles(
    house: &House,
    piece: StructureId,
    mut visit: impl FnMut([Vec3; 3]),
) {
    let mesh = &house.meshes[house.structure[piece].mesh];
    for triangle in 0..mesh.triangles.len() {
        visit(mesh.corners(triangle));
    }
}

/// The area of a triangle, m².
pub(crate) fn triangle_area_m2([a, b, c]: [Vec3; 3]) -> f64 {
    f64::from((b - a).cross(c - a).length()) * 0.5
}

/// The height at which a vertical line through (x, z) of `point` meets the triangle, if the triangle is flatter than 60
/// degrees; m.
pub(crate) fn height_under([a, b, c]: [Vec3; 3], point: Vec3) -> Option<f32> {
    let normal = (b - a).cross(c - a);
    if normal.y.abs() < 0.5 * normal.length() || normal.y == 0.0 {
        return None;
    }
    let turn = |p: Vec3, q: Vec3| (q.x - p.x) * (point.z - p.z) - (q.z - p.z) * (point.x - p.x);
    let (s, t, u) = (turn(a, b), turn(b, c), turn(c, a));
    let inside = (s >= 0.0 && t >= 0.0 && u >= 0.0) || (s <= 0.0 && t <= 0.0 && u <= 0.0);
    inside.then(|| a.y - (normal.x * (point.x - a.x) + normal.z * (point.z - a.z)) / normal.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_lie_on_the_plane_and_steep_faces_have_none() {
        let slope = [
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(2.0, 1.0, 0.0),
            Vec3::new(0.0, 0.0, 2.0),
        ];
        assert!((height_under(slope, Vec3::new(0.5, 9.0, 0.5)).unwrap() - 0.25).abs() < 1e-6);
        assert_eq!(height_under(slope, Vec3::new(-0.1, 0.0, 0.5)), None);
        let wall = [Vec3::ZERO, Vec3::Y, Vec3::new(0.1, 1.0, 1.0)];
        assert_eq!(height_under(wall, Vec3::new(0.03, 0.0, 0.5)), None);
    }
}
