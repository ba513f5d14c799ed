//! A house's triangles as they stand, for programs that show them: one mesh for each room and material.

use crate::world::World;
use dwell_scene::{House, MaterialId, Mesh, RoomId, State, StructureKind};
use glam::{Affine3A, Vec2, Vec3, Vec3A};
use std::collections::BTreeMap;

/// All triangles of a material in a room, in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomMaterialMesh {
    /// The room; `None`: the building where no room is known, and what stands outside.
    pub room: Option<RoomId>,
    /// True for a ceiling, which hides the room from above.
    pub ceiling: bool,
    /// The material.
    pub material: MaterialId,
    /// m. Shape (vertex,).
    pub positions: Vec<Vec3>,
    /// Unit length. Shape (vertex,).
    pub normals: Vec<Vec3>,
    /// Texture coordinates, v **up** from the image's lower edge, repeating. Shape (vertex,).
    pub uvs: Vec<Vec2>,
    /// Vertices, counter-clockwise from the front. Shape (triangle,).
    pub triangles: Vec<[u32; 3]>,
}

/// The triangles of structure and objects as they stand in a world, by room (that of the object's middle) and material, ceilings
/// apart. Their
/// number is [`House::triangle_count`].
pub fn room_surfaces(world: &World) -> Vec<RoomMaterialMesh> {
    let (house, state) = (world.house(), world.state());
    let mut all = SurfaceBuilder::new();
    for piece in &house.structure {
        let mesh = &house.meshes[piece.mesh];
        let ceiling = piece.kind == StructureKind::Ceiling;
        all.add(
            mesh,
            &Affine3A::IDENTITY,
            (piece.room, ceiling),
            &piece.materials,
        );
    }
    for (id, object) in house.objects.iter_ids() {
        let room = room_of(house, state, id);
        for part in object.parts() {
            let own = &house.parts[part];
            let world_from_mesh = state.part_pose[part].to_affine() * own.part_from_mesh;
            all.add(
                &house.meshes[own.mesh],
                &world_from_mesh,
                (room, false),
                &own.materials,
            );
        }
    }
    all.0.into_values().collect()
}

fn room_of(house: &House, state: &State, object: dwell_scene::ObjectId) -> Option<RoomId> {
    house.room_at(house.object_bounds(state, object).center())
}

/// Room, whether it is a ceiling, material.
type SurfaceKey = (Option<RoomId>, bool, MaterialId);

/// Meshes in the making.
struct SurfaceBuilder(BTreeMap<SurfaceKey, RoomMaterialMesh>);

impl SurfaceBuilder {
    fn new() -> Self {
        Self(BTreeMap::new())
    }

    fn add(
        &mut self,
        mesh: &Mesh,
        world_from_mesh: &Affine3A,
        (room, ceiling): (Option<RoomId>, bool),
        materials: &[MaterialId],
    ) {
        let turn = world_from_mesh.matrix3.inverse().transpose();
        let mirrored = world_from_mesh.matrix3.determinant() < 0.0;
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let Some(material) = materials.get(usize::from(mesh.slot(k))) else {
                continue;
            };
            let surface =
                self.0
                    .entry((room, ceiling, *material))
                    .or_insert_with(|| RoomMaterialMesh {
                        room,
                        ceiling,
                        material: *material,
                        positions: Vec::new(),
                        normals: Vec::new(),
                        uvs: Vec::new(),
                        triangles: Vec::new(),
                    });
            let first = surface.positions.len() as u32;
            let corners = triangle.map(|vertex| {
                let point = mesh.positions[vertex as usize];
                world_from_mesh.transform_point3(point)
            });
            let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let face = if mirrored { -face } else { face }.normalize_or(Vec3::Y);
            for (corner, vertex) in corners.into_iter().zip(triangle) {
                let vertex = *vertex as usize;
                let normal = mesh.normals.get(vertex).map_or(face, |normal| {
                    Vec3::from(turn * Vec3A::from(*normal)).normalize_or(face)
                });
                surface.positions.push(corner);
                surface.normals.push(normal);
                surface
                    .uvs
                    .push(mesh.uvs.get(vertex).copied().unwrap_or_default());
            }
            let order = if mirrored { [0, 2, 1] } else { [0, 1, 2] };
            surface.triangles.push(order.map(|corner| first + corner));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use crate::engines::Engines;
    use std::sync::Arc;

    /// Every triangle once, each where rays meet it, and its normal on the side from which it is seen first.
    #[test]
    fn all_triangles_of_a_house_are_there_once() {
        let (house, _) = dwell_houses::open("builtin:studio").unwrap();
        let config = WorldConfig {
            agents: Vec::new(),
            ..WorldConfig::default()
        };
        let world = World::new(Engines::new(Arc::new(house)), &config).unwrap();
        let surfaces = room_surfaces(&world);
        let count: usize = surfaces.iter().map(|one| one.triangles.len()).sum();
        assert_eq!(count, world.house().triangle_count());
        let (mut area, mut turned) = (0.0, 0.0);
        for surface in &surfaces {
            assert_eq!(surface.positions.len(), 3 * surface.triangles.len());
            for triangle in &surface.triangles {
                let [a, b, c] = triangle.map(|k| surface.positions[k as usize]);
                let face = (b - a).cross(c - a);
                let normals = triangle.map(|k| surface.normals[k as usize]);
                let sum: Vec3 = normals.into_iter().sum();
                area += face.length() * 0.5;
                if face.dot(sum) < 0.0 {
                    turned += face.length() * 0.5;
                }
            }
        }
        assert!(
            area > 100.0 && turned < 1e-3 * area,
            "{turned} of {area} m2"
        );
        let floor = world.house().rooms.iter().next().unwrap().floor_y;
        let low = surfaces.iter().flat_map(|one| &one.positions);
        let low = low.map(|p| p.y).fold(f32::INFINITY, f32::min);
        assert!(low < floor + 0.01);
    }
}
