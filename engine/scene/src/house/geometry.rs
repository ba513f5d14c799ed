//! The triangles of a house, prepared for rays once and shared by all of its worlds.

use super::data::HouseData;
use crate::bvh::{TriangleAttributes, TriangleBvh};
use crate::ids::{EntityId, Id, IdVec, MaterialId, MeshId, PartId, StructureId};
use crate::interrupt;
use crate::mesh::Mesh;
use crate::parallel::Threads;
use glam::{Affine3A, Mat3A, Vec3};
use std::sync::Arc;

/// The owner of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceOwner {
    /// A wall, floor or ceiling piece.
    Structure(StructureId),
    /// A part of an object.
    Part(PartId),
}

/// A mesh placed in the house: a structure piece or a part.
#[derive(Clone, Debug)]
pub struct PlacedMesh {
    /// Its owner.
    pub owner: SurfaceOwner,
    /// The entity id.
    pub entity: EntityId,
    /// Its mesh.
    pub mesh: MeshId,
    /// Its transform; for parts that move, that at the start.
    pub world_from_mesh: Affine3A,
    /// The rest of the transform after the rigid `world_from_part`, for parts that move.
    pub part_from_mesh: Affine3A,
}

/// The origin of a static triangle.
#[derive(Clone, Copy, Debug)]
pub struct StaticTriangleSource {
    /// Position in [`Geometry::placed`].
    pub placed: u32,
    /// Position in the mesh.
    pub triangle: u32,
}

/// Static geometry baked flat in world space, and the meshes of the parts that move.
#[derive(Debug)]
pub struct Geometry {
    /// All triangles that never move.
    pub static_bvh: Arc<TriangleBvh>,
    /// The origin of each static triangle. Shape (static triangle,).
    pub static_triangles: Vec<StaticTriangleSource>,
    /// Structure pieces in order, then parts in order.
    pub placed: Vec<PlacedMesh>,
    /// The parts that move, in order: instance `k` of a [`RayScene`](crate::rays::RayScene) is `movable[k]`.
    pub movable: Vec<PartId>,
    /// The trees of the meshes of moving parts.
    pub mesh_bvh: IdVec<MeshId, Option<Arc<TriangleBvh>>>,
    structure_count: usize,
}

impl Geometry {
    /// Bakes the tables of a checked house.
    pub(super) fn bake(data: &HouseData, threads: Threads) -> Self {
        let structure_count = data.structure.len();
        let mut placed = Vec::with_capacity(structure_count + data.parts.len());
        for (id, piece) in data.structure.iter_ids() {
            placed.push(PlacedMesh {
                owner: SurfaceOwner::Structure(id),
                entity: EntityId(1 + id.0 as i32),
                mesh: piece.mesh,
                world_from_mesh: Affine3A::IDENTITY,
                part_from_mesh: Affine3A::IDENTITY,
            });
        }
        let mut movable = Vec::new();
        let mut moves: IdVec<MeshId, bool> = IdVec::filled(false, data.meshes.len());
        for (id, part) in data.parts.iter_ids() {
            placed.push(PlacedMesh {
                owner: SurfaceOwner::Part(id),
                entity: EntityId((1 + structure_count + part.object.index()) as i32),
                mesh: part.mesh,
                world_from_mesh: part.world_from_part.to_affine() * part.part_from_mesh,
                part_from_mesh: part.part_from_mesh,
            });
            if !part.fixed {
                movable.push(id);
                moves[part.mesh] = true;
            }
        }
        let ((static_bvh, static_triangles), mesh_bvh) = threads.join(
            || bake_static(data, &placed),
            || {
                threads.map(data.meshes.len(), |k| {
                    let mesh = &data.meshes[MeshId::from_index(k)];
                    moves[MeshId::from_index(k)]
                        .then(|| Arc::new(TriangleBvh::build(&mesh.positions, &mesh.triangles)))
                })
            },
        );
        Self {
            static_bvh: Arc::new(static_bvh),
            static_triangles,
            placed,
            movable,
            mesh_bvh: mesh_bvh.into(),
            structure_count,
        }
    }

    /// The entry of [`Self::placed`] for a part.
    pub fn placed_part(&self, part: PartId) -> &PlacedMesh {
        &self.placed[self.structure_count + part.index()]
    }
}

/// The triangles that never move, in world space, and the origin of each.
fn bake_static(
    data: &HouseData,
    placed: &[PlacedMesh],
) -> (TriangleBvh, Vec<StaticTriangleSource>) {
    let mut baked = Mesh::default();
    let mut sources = Vec::new();
    for (k, thing) in placed.iter().enumerate() {
        if let SurfaceOwner::Part(part) = thing.owner
            && !data.parts[part].fixed
        {
            continue;
        }
        interrupt::unwind_if_cancelled();
        let mesh = &data.meshes[thing.mesh];
        let base = baked.positions.len() as u32;
        baked.positions.extend(
            mesh.positions
                .iter()
                .map(|p| thing.world_from_mesh.transform_point3(*p)),
        );
        baked
            .triangles
            .extend(mesh.triangles.iter().map(|t| t.map(|vertex| vertex + base)));
        let triangles = 0..mesh.triangles.len() as u32;
        sources.extend(triangles.map(|triangle| StaticTriangleSource {
            placed: k as u32,
            triangle,
        }));
    }
    let tag =
        |index: usize| TriangleAttributes::new(placed[sources[index].placed as usize].entity.0);
    let bvh = TriangleBvh::build_tagged(&baked.positions, &baked.triangles, tag);
    (bvh, sources)
}

/// The surface that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// The entity id.
    pub entity: EntityId,
    /// Its owner.
    pub owner: SurfaceOwner,
    /// The material of the triangle's slot.
    pub material: MaterialId,
    /// The mesh.
    pub mesh: MeshId,
    /// The triangle in the mesh.
    pub triangle: u32,
    /// The triangle's normal in world space, unit length, towards the side from which its corners run
    /// counter-clockwise in the model (mirrored instances keep their model's front).
    pub normal: Vec3,
}

/// The map of normals for a map of points: its inverse transpose.
pub(crate) fn normal_matrix(world_from_mesh: &Affine3A) -> Mat3A {
    world_from_mesh.matrix3.inverse().transpose()
}
