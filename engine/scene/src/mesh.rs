//! Triangle meshes.

use crate::bounds::Aabb;
use crate::error::SceneError;
use glam::{Affine3A, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// A triangle mesh with per-triangle material slots, in mesh space.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Vertex positions, m. Shape (vertex,).
    pub positions: Vec<Vec3>,
    /// Vertex normals, unit length. Shape (vertex,) or empty: then shading is flat.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, u to the right, v **up** from the image's lower edge, repeating. Shape (vertex,) or empty.
    pub uvs: Vec<Vec2>,
    /// Vertex indices, counter-clockwise seen from the front. Shape (triangle,).
    pub triangles: Vec<[u32; 3]>,
    /// Material slot of each triangle. Shape (triangle,) or empty: then all have slot 0.
    pub slots: Vec<u16>,
}

impl Mesh {
    /// Frees unused capacity.
    pub fn shrink_to_fit(&mut self) {
        self.positions.shrink_to_fit();
        self.normals.shrink_to_fit();
        self.uvs.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.slots.shrink_to_fit();
    }

    /// Checks lengths, index ranges and finiteness.
    ///
    /// # Errors
    /// [`SceneError::Mesh`] names the first fault; `at`: the mesh's path.
    pub fn check(&self, at: &str) -> Result<(), SceneError> {
        let fault = |what: String| {
            Err(SceneError::Mesh {
                at: at.to_owned(),
                what,
            })
        };
        let vertices = self.positions.len();
        if !self.normals.is_empty() && self.normals.len() != vertices {
            return fault(format!(
                "expected {vertices} normals, one per vertex, or none; found {}",
                self.normals.len()
            ));
        }
        if !self.uvs.is_empty() && self.uvs.len() != vertices {
            return fault(format!(
                "expected {vertices} texture coordinates or none; found {}",
                self.uvs.len()
            ));
        }
        if !self.slots.is_empty() && self.slots.len() != self.triangles.len() {
            return fault(format!(
                "expected {} slots or none; found {}",
                self.triangles.len(),
                self.slots.len()
            ));
        }
        if let Some(index) = self
            .triangles
            .iter()
            .flatten()
            .find(|index| **index as usize >= vertices)
        {
            return fault(format!("vertex index {index} with {vertices} vertices"));
        }
        if let Some(k) = self.positions.iter().position(|p| !p.is_finite()) {
            return fault(format!("vertex {k} is not finite"));
        }
        Ok(())
    }

    /// Returns the material slot of triangle `triangle`.
    pub fn slot(&self, triangle: usize) -> u16 {
        self.slots.get(triangle).copied().unwrap_or(0)
    }

    /// Returns the number of material slots in use: one more than the largest.
    pub fn slot_count(&self) -> usize {
        if self.triangles.is_empty() {
            0
        } else {
            self.slots
                .iter()
                .max()
                .map_or(1, |max| usize::from(*max) + 1)
        }
    }

    /// The corners of triangle `triangle`, m.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    /// The smallest box around all vertices, in mesh space.
    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.positions.iter().copied())
    }

    /// The sum of all triangles' areas, m².
    pub fn area_m2(&self) -> f64 {
        (0..self.triangles.len())
            .map(|k| {
                let [a, b, c] = self.corners(k);
                f64::from((b - a).cross(c - a).length()) * 0.5
            })
            .sum()
    }

    /// The volume that a closed mesh encloses, m³, positive when its faces look outwards (divergence theorem).
    pub fn enclosed_volume_m3(&self) -> f64 {
        let origin = self.bounds().center().as_dvec3();
        (0..self.triangles.len())
            .map(|k| {
                let [a, b, c] = self.corners(k).map(|p| p.as_dvec3() - origin);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    /// Appends `other` with its slots raised by `slot_offset`.
    pub fn append(&mut self, other: &Self, slot_offset: u16) {
        let base = self.positions.len();
        let triangle_count = self.triangles.len();
        if self.normals.len() != base || other.normals.len() != other.positions.len() {
            self.normals.clear();
        } else {
            self.normals.extend_from_slice(&other.normals);
        }
        if self.uvs.len() == base {
            self.uvs.extend_from_slice(&other.uvs);
            if other.uvs.len() != other.positions.len() {
                self.uvs.resize(base + other.positions.len(), Vec2::ZERO);
            }
        }
        self.slots.resize(triangle_count, 0);
        self.slots
            .extend((0..other.triangles.len()).map(|k| other.slot(k) + slot_offset));
        self.positions.extend_from_slice(&other.positions);
        self.triangles.extend(
            other
                .triangles
                .iter()
                .map(|t| t.map(|vertex| vertex + base as u32)),
        );
    }

    /// Returns the surface transformed by `map`: normals follow, and a mirroring map reverses the winding, so that outward
    /// faces stay outward.
    #[must_use]
    pub fn transformed(&self, map: &Affine3A) -> Self {
        let mut moved = self.clone();
        for position in &mut moved.positions {
            *position = map.transform_point3(*position);
        }
        let normal_map = map.matrix3.inverse().transpose();
        for normal in &mut moved.normals {
            *normal = (normal_map * *normal).normalize_or(Vec3::Y);
        }
        if map.matrix3.determinant() < 0.0 {
            for triangle in &mut moved.triangles {
                triangle.swap(1, 2);
            }
        }
        moved
    }

    /// A flat rectangle of two triangles, counter-clockwise seen from its front, with texture coordinates in metres from
    /// the first corner; slot 0. `corners`: in that order, the second along the texture's width.
    pub fn rectangle(corners: [Vec3; 4]) -> Self {
        let [a, b, _, d] = corners;
        let (along, up) = (b - a, d - a);
        let (width, height) = (along.length(), up.length());
        Self {
            positions: corners.to_vec(),
            normals: vec![along.cross(up) / (width * height); 4],
            uvs: vec![
                Vec2::ZERO,
                Vec2::new(width, 0.0),
                Vec2::new(width, height),
                Vec2::new(0.0, height),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            slots: Vec::new(),
        }
    }

    /// An axis-aligned box with outward faces, flat normals and texture coordinates in metres; every face shows slot 0.
    pub fn cuboid(min: Vec3, max: Vec3) -> Self {
        let mut mesh = Self::default();
        for axis in 0..3 {
            for side in [false, true] {
                let (u_axis, v_axis) = if side {
                    ((axis + 1) % 3, (axis + 2) % 3)
                } else {
                    ((axis + 2) % 3, (axis + 1) % 3)
                };
                let base = mesh.positions.len() as u32;
                for (u, v) in [(false, false), (true, false), (true, true), (false, true)] {
                    let mut corner = Vec3::ZERO;
                    corner[axis] = if side { max[axis] } else { min[axis] };
                    corner[u_axis] = if u { max[u_axis] } else { min[u_axis] };
                    corner[v_axis] = if v { max[v_axis] } else { min[v_axis] };
                    mesh.positions.push(corner);
                    let mut normal = Vec3::ZERO;
                    normal[axis] = if side { 1.0 } else { -1.0 };
                    mesh.normals.push(normal);
                    // Sides of the box have their v axis along +Y, so that grain and bricks stand upright.
                    mesh.uvs.push(match axis {
                        1 => Vec2::new(corner.x, -corner.z),
                        0 => Vec2::new(corner.z, corner.y),
                        _ => Vec2::new(corner.x, corner.y),
                    });
                }
                mesh.triangles
                    .extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
            }
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cuboid_is_closed_and_looks_outwards() {
        let mesh = Mesh::cuboid(Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 4.0, 6.0));
        mesh.check("cuboid").unwrap();
        assert!((mesh.enclosed_volume_m3() - 6.0).abs() < 1e-6);
        assert!((mesh.area_m2() - 22.0).abs() < 1e-5);
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(k);
            assert!((b - a).cross(c - a).dot(mesh.normals[triangle[0] as usize]) > 0.0);
        }
    }

    #[test]
    fn faults_are_named() {
        let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        mesh.triangles[0][1] = 99;
        let message = mesh.check("meshes[3]").unwrap_err().to_string();
        assert_eq!(message, "meshes[3]: vertex index 99 with 24 vertices");
    }
}
