//! Shading data of each triangle of a house, in the order in which hits name triangles.

use crate::material::ShadingMaterial;
use dwell_scene::bvh::flat::PackedRow;
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::rays::{BODY_PIECES, CAPSULE_PIECES, RayScene, body_meshes};
use dwell_scene::{House, Id, Mesh, PartId, PlacedMesh, Pose, State, SurfaceOwner};
use glam::{Affine3A, DVec3, Mat3A, Vec2, Vec3, Vec3A, Vec4};
use std::collections::BTreeMap;

/// Triangles between checks for cancellation.
const TRIANGLES_PER_CHECK: usize = 1 << 12;

/// One triangle; a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct TriangleShading {
    /// Maps a point on the triangle to its texture coordinates.
    uv: [Vec4; 2],
    /// Geometric normal by the winding, unit length; world space, or part space for parts that move.
    pub(crate) normal: Vec3,
    /// Texture area per surface area, 1/m²: times the image's pixels, texels per square metre.
    pub(crate) texture_density: f32,
    pub(crate) material: u32,
}

/// A triangle where it stands, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PosedTriangleShading {
    /// See [`TriangleShading::uv`].
    pub(crate) uv: [Vec4; 2],
    pub(crate) normal: Vec3,
}

impl TriangleShading {
    /// The triangle as posed with its part.
    #[inline]
    pub(crate) fn posed(&self, pose: Option<&Pose>) -> PosedTriangleShading {
        let Some(pose) = pose else {
            return PosedTriangleShading {
                uv: self.uv,
                normal: self.normal,
            };
        };
        let uv = self.uv.map(|row| {
            let gradient = pose.rotation * row.truncate();
            gradient.extend(row.w - gradient.dot(pose.position))
        });
        PosedTriangleShading {
            uv,
            normal: pose.rotation * self.normal,
        }
    }
}

impl PosedTriangleShading {
    /// Texture coordinates at a point on the triangle.
    #[inline]
    pub(crate) fn uv(&self, point: Vec3) -> Vec2 {
        let [u, v] = &self.uv;
        Vec2::new(
            coordinate(u, point.x, point.y, point.z),
            coordinate(v, point.x, point.y, point.z),
        )
    }
}

impl PosedTriangleShading {
    /// Returns the change of texture coordinates along a vector on the triangle.
    #[inline]
    pub(crate) fn uv_along(&self, way: Vec3) -> Vec2 {
        let [u, v] = &self.uv;
        Vec2::new(u.truncate().dot(way), v.truncate().dot(way))
    }
}

/// One texture coordinate at a point.
#[expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]
#[inline(always)]
pub(crate) fn coordinate(row: &Vec4, x: f32, y: f32, z: f32) -> f32 {
    ((row.x * x + row.y * y) + row.z * z) + row.w
}

/// Marks a triangle whose colour needs more than [`TriangleTable::uniform_color`].
pub(crate) const NEEDS_SHADING: u8 = 0;

/// Tables over all triangles: static ones first, then those of parts that move, once for all that look alike.
#[derive(Debug)]
pub(crate) struct TriangleTable {
    /// Shape (triangle,).
    triangles: Vec<TriangleShading>,
    /// Normals of the corners, packed; equal where the mesh has none. Shape (triangle,).
    corner_normals: Vec<[u32; 3]>,
    /// R, G, B of plain colours and 255, or [`NEEDS_SHADING`] as the last byte. Shape (triangle,).
    quick: Vec<[u8; 4]>,
    /// First triangle of each moving instance; the same for those that look alike. Shape (instance,).
    first: Vec<u32>,
    /// The part of each moving instance. Shape (instance,).
    movable: Vec<PartId>,
    /// First triangle of each piece of an agent's body; agents are the instances behind the parts that move.
    bodies: [u32; BODY_PIECES],
}

impl TriangleTable {
    pub(crate) fn new(house: &House, looks: &[ShadingMaterial]) -> Self {
        let geometry = house.geometry();
        let count = geometry.static_triangles.len();
        let mut all = Self {
            triangles: Vec::with_capacity(count),
            corner_normals: Vec::with_capacity(count),
            quick: Vec::with_capacity(count),
            first: Vec::with_capacity(geometry.movable.len()),
            movable: geometry.movable.clone(),
            bodies: [0; BODY_PIECES],
        };
        let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
        for source in &geometry.static_triangles {
            pace.count_one();
            let placed = &geometry.placed[source.placed as usize];
            all.add_house_triangle(
                house,
                placed,
                &placed.world_from_mesh,
                source.triangle as usize,
                looks,
            );
        }
        // Parts that look alike share their triangles: chairs around a table, houses side by side.
        let mut known = BTreeMap::new();
        for id in &geometry.movable {
            let placed = geometry.placed_part(*id);
            let part = &house.parts[*id];
            let shape = placed.part_from_mesh.to_cols_array().map(f32::to_bits);
            let next = all.triangles.len() as u32;
            let first = *known
                .entry((placed.mesh, shape, &part.materials))
                .or_insert(next);
            all.first.push(first);
            if first < next {
                continue;
            }
            for triangle in 0..house.meshes[placed.mesh].triangles.len() {
                pace.count_one();
                all.add_house_triangle(house, placed, &placed.part_from_mesh, triangle, looks);
            }
        }
        for (piece, mesh) in body_meshes().iter().enumerate() {
            all.bodies[piece] = all.triangles.len() as u32;
            let quick = (piece < CAPSULE_PIECES).then(|| looks[looks.len() - 1].opaque_srgb());
            for triangle in 0..mesh.triangles.len() {
                all.add_body_triangle(mesh, triangle, looks.len() - 1, quick.flatten());
            }
        }
        all
    }

    /// A triangle of agents' bodies. Pieces of capsules are only stretched along the axes of their symmetry, so that normals
    /// stay; those of persons are turned and grow evenly, and their colour is that of the person.
    fn add_body_triangle(
        &mut self,
        mesh: &Mesh,
        triangle: usize,
        material: usize,
        quick: Option<[u8; 3]>,
    ) {
        let [a, b, c] = mesh.corners(triangle);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        self.triangles.push(TriangleShading {
            uv: [Vec4::ZERO; 2],
            normal,
            texture_density: 0.0,
            material: material as u32,
        });
        self.corner_normals
            .push(corner_normals(mesh, triangle, &Affine3A::IDENTITY, normal));
        self.quick.push(match quick {
            Some([r, g, b]) => [r, g, b, 255],
            None => [0, 0, 0, NEEDS_SHADING],
        });
    }

    fn add_house_triangle(
        &mut self,
        house: &House,
        placed: &PlacedMesh,
        map: &Affine3A,
        triangle: usize,
        looks: &[ShadingMaterial],
    ) {
        let mesh = &house.meshes[placed.mesh];
        let materials = match placed.owner {
            SurfaceOwner::Structure(id) => &house.structure[id].materials,
            SurfaceOwner::Part(id) => &house.parts[id].materials,
        };
        let material = materials[usize::from(mesh.slot(triangle))].index();
        let corners = mesh
            .corners(triangle)
            .map(|p| map.transform_point3(p).as_dvec3());
        let area_normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // The model's front stays the front when the map mirrors.
        let mirror = if map.matrix3.determinant() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let normal = (area_normal * mirror).normalize_or_zero().as_vec3();
        let (uv, density) = texture_map(corners, area_normal, texture_coordinates(mesh, triangle));
        self.triangles.push(TriangleShading {
            uv,
            normal,
            texture_density: density,
            material: material as u32,
        });
        self.corner_normals
            .push(corner_normals(mesh, triangle, map, normal));
        self.quick.push(match looks[material].opaque_srgb() {
            Some([r, g, b]) => [r, g, b, 255],
            None => [0, 0, 0, NEEDS_SHADING],
        });
    }

    /// As rows, four a triangle: the map to texture coordinates, normal and density, material and normals of the corners.
    pub(crate) fn to_rows(&self) -> Vec<PackedRow> {
        let bits = |row: Vec4| row.to_array().map(f32::to_bits);
        let mut rows = Vec::with_capacity(self.triangles.len() * 4);
        for (triangle, [a, b, c]) in self.triangles.iter().zip(&self.corner_normals) {
            rows.extend(triangle.uv.map(bits));
            rows.push(bits(triangle.normal.extend(triangle.texture_density)));
            rows.push([triangle.material, *a, *b, *c]);
        }
        rows
    }

    /// The first triangle of each part that moves, and of each piece of an agent's body.
    pub(crate) fn first_triangles(&self) -> impl Iterator<Item = u32> {
        self.first.iter().chain(&self.bodies).copied()
    }

    /// Returns the position of a hit's triangle in the tables.
    #[inline]
    pub(crate) fn table_index(&self, instance: Option<u32>, triangle: u32) -> usize {
        match instance {
            None => triangle as usize,
            Some(instance) => {
                let first = match self.first.get(instance as usize) {
                    Some(first) => *first,
                    None => self.bodies[(instance as usize - self.first.len()) % BODY_PIECES],
                };
                first as usize + triangle as usize
            }
        }
    }

    /// The part of a moving instance; `None` for agents' bodies.
    pub(crate) fn part_of(&self, instance: u32) -> Option<PartId> {
        self.movable.get(instance as usize).copied()
    }

    /// The number of the agent whose body an instance belongs to, and that of its piece.
    pub(crate) fn agent_of(&self, instance: u32) -> Option<(usize, usize)> {
        let behind = (instance as usize).checked_sub(self.movable.len());
        behind.map(|piece| (piece / BODY_PIECES, piece % BODY_PIECES))
    }

    #[inline]
    pub(crate) fn triangle(&self, position: usize) -> &TriangleShading {
        &self.triangles[position]
    }

    #[inline]
    pub(crate) fn uniform_color(&self, position: usize) -> [u8; 4] {
        self.quick[position]
    }

    /// The interpolated normal at a hit, in the space of [`TriangleShading::normal`]; not of unit length.
    pub(crate) fn smooth_normal(&self, position: usize, u: f32, v: f32) -> Vec3 {
        let [a, b, c] = self.corner_normals[position].map(unpack_normal);
        a * (1.0 - u - v) + b * u + c * v
    }

    /// From the space of [`TriangleShading::normal`] to the world; `None` where that is the world, or turned as the world is.
    #[inline]
    pub(crate) fn pose<'a>(
        &self,
        instance: Option<u32>,
        (scene, state): (&'a RayScene, &'a State),
    ) -> Option<&'a Pose> {
        match self.part_of(instance?) {
            Some(part) => state.part_pose.get(part),
            None => scene.person_piece(instance?).map(|piece| &piece.pose),
        }
    }

    /// Memory held, bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.triangles.as_slice())
            + size_of_val(self.corner_normals.as_slice())
            + size_of_val(self.quick.as_slice())
    }
}

/// The map from points of a triangle's plane to texture coordinates, and the texture area per surface area.
fn texture_map(corners: [DVec3; 3], area_normal: DVec3, uv: [Vec2; 3]) -> ([Vec4; 2], f32) {
    let squared = area_normal.length_squared();
    if squared < 1e-30 {
        return (
            [uv[0].x, uv[0].y].map(|at| Vec4::new(0.0, 0.0, 0.0, at)),
            0.0,
        );
    }
    // The gradients of the weights of the second and third corner.
    let (e, f) = (corners[1] - corners[0], corners[2] - corners[0]);
    let (second, third) = (
        f.cross(area_normal) / squared,
        area_normal.cross(e) / squared,
    );
    let (du, dv) = ((uv[1] - uv[0]).as_dvec2(), (uv[2] - uv[0]).as_dvec2());
    // Images repeat: whole repetitions only cost digits.
    let whole = ((uv[0] + uv[1] + uv[2]) / 3.0).floor();
    let map = [0, 1].map(|k| {
        let gradient = second * du[k] + third * dv[k];
        let start = f64::from(uv[0][k] - whole[k]) - gradient.dot(corners[0]);
        gradient.extend(start).as_vec4()
    });
    (map, (du.perp_dot(dv).abs() / squared.sqrt()) as f32)
}

fn texture_coordinates(mesh: &Mesh, triangle: usize) -> [Vec2; 3] {
    if mesh.uvs.is_empty() {
        return [Vec2::ZERO; 3];
    }
    let uv = mesh.triangles[triangle].map(|vertex| mesh.uvs[vertex as usize]);
    if uv.iter().all(|uv| uv.is_finite()) {
        uv
    } else {
        [Vec2::ZERO; 3]
    }
}

fn corner_normals(mesh: &Mesh, triangle: usize, map: &Affine3A, flat: Vec3) -> [u32; 3] {
    if mesh.normals.is_empty() {
        return [pack_normal(flat); 3];
    }
    let normals: Mat3A = map.matrix3.inverse().transpose();
    mesh.triangles[triangle].map(|vertex| {
        let turned =
            Vec3::from(normals * Vec3A::from(mesh.normals[vertex as usize])).normalize_or_zero();
        pack_normal(if turned == Vec3::ZERO || !turned.is_finite() {
            flat
        } else {
            turned
        })
    })
}

/// A unit vector in 32 bits, exact to 5e-5 rad.
///
/// # Source
/// Z. H. Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 3 (2014), 2:
/// octahedral map.
fn pack_normal(normal: Vec3) -> u32 {
    let scale = normal.x.abs() + normal.y.abs() + normal.z.abs();
    if scale == 0.0 || !scale.is_finite() {
        return pack_normal(Vec3::Y);
    }
    let p = normal / scale;
    let (x, y) = if p.z >= 0.0 {
        (p.x, p.y)
    } else {
        (
            (1.0 - p.y.abs()).copysign(p.x),
            (1.0 - p.x.abs()).copysign(p.y),
        )
    };
    let quantize = |k: f32| u32::from((k * 32_767.0).round() as i16 as u16);
    quantize(x) | (quantize(y) << 16)
}

fn unpack_normal(packed: u32) -> Vec3 {
    let part = |bits: u32| f32::from(bits as u16 as i16) * (1.0 / 32_767.0);
    let (x, y) = (part(packed & 0xffff), part(packed >> 16));
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Textures;
    use dwell_scene::{EntityId, ShoeboxMaterials};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_packed_normal_points_the_same_way(x in -1.0_f32..1.0, y in -1.0_f32..1.0, z in -1.0_f32..1.0) {
            let Some(normal) = Vec3::new(x, y, z).try_normalize() else { return Ok(()) };
            let back = unpack_normal(pack_normal(normal));
            prop_assert!((back - normal).length() < 1e-4, "{} {}", normal, back);
        }
    }

    #[test]
    fn axes_are_packed_exactly() {
        for axis in [
            Vec3::X,
            Vec3::Y,
            Vec3::Z,
            Vec3::NEG_X,
            Vec3::NEG_Y,
            Vec3::NEG_Z,
        ] {
            assert_eq!(unpack_normal(pack_normal(axis)), axis);
        }
        assert!(unpack_normal(pack_normal(Vec3::ZERO)).is_normalized());
    }

    #[test]
    fn corners_have_their_texture_coordinates() {
        let corners = [
            Vec3::new(40.0, 1.0, 38.0),
            Vec3::new(40.5, 1.2, 38.1),
            Vec3::new(39.9, 1.9, 38.4),
        ];
        let uv = [
            Vec2::new(7.25, -3.5),
            Vec2::new(7.75, -3.25),
            Vec2::new(7.0, -2.75),
        ];
        let wide = corners.map(Vec3::as_dvec3);
        let area_normal = (wide[1] - wide[0]).cross(wide[2] - wide[0]);
        let (map, _) = texture_map(wide, area_normal, uv);
        let triangle = TriangleShading {
            uv: map,
            normal: Vec3::Y,
            texture_density: 0.0,
            material: 0,
        };
        for (corner, expected) in corners.into_iter().zip(uv) {
            let found = triangle.posed(None).uv(corner);
            assert!(
                (found - (expected - Vec2::new(7.0, -4.0))).length() < 1e-4,
                "{found} {expected}"
            );
        }
        let flat = texture_map([wide[0]; 3], DVec3::ZERO, uv);
        assert_eq!((flat.0[0].w, flat.1), (7.25, 0.0));
    }

    #[test]
    fn a_room_has_one_texture_unit_a_metre_and_normals_to_the_inside() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let mut looks = ShadingMaterial::all(&house, &Textures::new(&house).unwrap());
        looks.push(ShadingMaterial::agent_body());
        let surfaces = TriangleTable::new(&house, &looks);
        assert_eq!(surfaces.bodies[0], 12);
        for (k, source) in house.geometry().static_triangles.iter().enumerate() {
            let triangle = surfaces.triangle(surfaces.table_index(None, k as u32));
            assert!((triangle.texture_density - 1.0).abs() < 1e-5);
            let placed = &house.geometry().placed[source.placed as usize];
            assert_eq!(triangle.material as i32 + 1, EntityId(placed.entity.0).0);
            assert!((surfaces.smooth_normal(k, 0.2, 0.3) - triangle.normal).length() < 1e-4);
        }
    }
}
