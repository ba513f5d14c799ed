//! Ray queries of a house in the state of one world: the one way in which cameras, sound and hands find surfaces.

mod agent_meshes;

pub use agent_meshes::{BODY_PIECES, CAPSULE_PIECES, PlacedPiece, body_meshes, body_trees};

use crate::bvh::{Hit, Instance, InstanceSet, PacketHits, Ray, RayMask, RayPacket, SceneBvh};
use crate::house::{House, PlacedMesh, SurfaceHit, SurfaceOwner, normal_matrix};
use crate::ids::{EntityId, Id, MaterialId, PartId};
use crate::state::State;
use glam::{Affine3A, Mat3A, Vec2, Vec3};
use std::sync::Arc;

/// Rays in a fan: they share an origin, as those of a pinhole camera do.
pub const PACKET_SIZE: usize = 16;

/// The surfaces of a house in the state of one world.
///
/// Static geometry is shared by all worlds over the house; a scene costs a few hundred bytes a moving part.
#[derive(Clone, Debug)]
pub struct RayScene {
    house: Arc<House>,
    moving: InstanceSet,
    /// Transforms of each moving part, then of the pieces of agents' bodies. Shape (instance,).
    world_from_mesh: Vec<Affine3A>,
    /// Of the pieces of agents' bodies, those of persons. Shape (agent x piece,).
    pieces: Vec<Option<PlacedPiece>>,
}

impl RayScene {
    /// The house in its initial state.
    pub fn new(house: Arc<House>) -> Self {
        let geometry = house.geometry();
        let start: Vec<Affine3A> = geometry
            .movable
            .iter()
            .map(|part| geometry.placed_part(*part).world_from_mesh)
            .collect();
        Self {
            moving: InstanceSet::new(moving_part_instances(&house)),
            world_from_mesh: start,
            pieces: Vec::new(),
            house,
        }
    }

    /// Moves the parts and the agents' bodies to their poses in `state`. Allocates nothing after the first call, unless the
    /// number of agents changed.
    pub fn update(&mut self, state: &State) {
        let parts = self.house.geometry().movable.len();
        if self.world_from_mesh.len() != parts + state.agents.len() * BODY_PIECES {
            self.rebuild_instances(state);
        }
        let transforms = self.world_from_mesh[parts..].chunks_exact_mut(BODY_PIECES);
        let pieces = self.pieces.chunks_exact_mut(BODY_PIECES);
        for (agent, (transforms, pieces)) in state.agents.iter_ids().zip(transforms.zip(pieces)) {
            let placed = agent_meshes::place_body((&self.house, state), agent, pieces);
            transforms.copy_from_slice(&placed);
        }
        let geometry = self.house.geometry();
        for (place, part) in self.world_from_mesh.iter_mut().zip(&geometry.movable) {
            *place =
                state.part_pose[*part].to_affine() * geometry.placed_part(*part).part_from_mesh;
        }
        self.moving.set_poses(&self.world_from_mesh);
    }

    /// Adapts to another number of agents.
    fn rebuild_instances(&mut self, state: &State) {
        let house = &self.house;
        let instances = moving_part_instances(house).chain(state.agents.ids().flat_map(|id| {
            let entity = house.entity_of_agent(id).0;
            body_trees().iter().map(move |mesh| Instance {
                mesh: mesh.clone(),
                world_from_mesh: Affine3A::IDENTITY,
                id: entity,
                mask: RayMask::BODY,
            })
        }));
        self.moving = InstanceSet::new(instances);
        self.world_from_mesh
            .resize(self.moving.len(), Affine3A::IDENTITY);
        self.pieces = vec![None; state.agents.len() * BODY_PIECES];
    }

    /// Returns the trees of the scene.
    pub fn bvh(&self) -> SceneBvh<'_> {
        SceneBvh {
            fixed: &self.house.geometry().static_bvh,
            moving: &self.moving,
        }
    }

    /// Returns the transform of an instance's mesh, if there are that many.
    pub fn world_from_mesh(&self, instance: usize) -> Option<&Affine3A> {
        self.world_from_mesh.get(instance)
    }

    /// Where an instance that is a piece of a person stands, and its colour; `None` for all others.
    #[inline]
    pub fn person_piece(&self, instance: u32) -> Option<&PlacedPiece> {
        let parts = self.house.geometry().movable.len();
        let piece = (instance as usize).checked_sub(parts)?;
        self.pieces.get(piece)?.as_ref()
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        &self.house
    }

    /// Returns the nearest surface on the ray whose mask meets `mask`. Surfaces that coincide within 0.1 mm count as one: the lower id.
    pub fn closest(&self, ray: &Ray, mask: RayMask) -> Option<Hit> {
        self.bvh().closest(ray, mask)
    }

    /// As [`Self::closest`], ignoring the entity `hidden`.
    pub fn closest_excluding(&self, ray: &Ray, mask: RayMask, hidden: EntityId) -> Option<Hit> {
        self.bvh().closest_excluding(ray, mask, hidden.0)
    }

    /// Returns whether a surface whose mask meets `mask` lies on the ray.
    pub fn occluded(&self, ray: &Ray, mask: RayMask) -> bool {
        self.bvh().occluded(ray, mask)
    }

    /// As [`Self::closest_excluding`] for all rays of a packet, much faster when their directions are similar.
    ///
    /// `hidden`: [`EntityId::VOID`] hides nothing.
    pub fn closest_packet<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        mask: RayMask,
        hidden: EntityId,
        hits: &mut PacketHits<N>,
    ) {
        self.bvh().closest_packet(rays, mask, Some(hidden.0), hits);
    }

    /// Returns the full hit of one ray of a packet, as [`Self::closest_excluding`] would.
    pub fn packet_hit<const N: usize>(
        &self,
        rays: &RayPacket<N>,
        hits: &PacketHits<N>,
        k: usize,
    ) -> Option<Hit> {
        self.bvh().packet_hit(rays, hits, k)
    }

    /// Returns the part of a moving instance.
    ///
    /// # Panics
    /// For a piece of an agent's body, which only rays with [`RayMask::BODY`] hit; as do [`Self::surface`], [`Self::uv`]
    /// and [`Self::shading_normal`].
    pub fn part_of_instance(&self, instance: u32) -> PartId {
        self.house.geometry().movable[instance as usize]
    }

    fn placed(&self, hit: &Hit) -> (&PlacedMesh, u32, Affine3A) {
        let geometry = self.house.geometry();
        if let Some(instance) = hit.instance {
            let place = self.world_from_mesh[instance as usize];
            (
                geometry.placed_part(self.part_of_instance(instance)),
                hit.triangle,
                place,
            )
        } else {
            let source = geometry.static_triangles[hit.triangle as usize];
            let placed = &geometry.placed[source.placed as usize];
            (placed, source.triangle, placed.world_from_mesh)
        }
    }

    /// Returns the surface of a hit.
    pub fn surface(&self, hit: &Hit) -> SurfaceHit {
        let (placed, triangle, world_from_mesh) = self.placed(hit);
        let mesh = &self.house.meshes[placed.mesh];
        let [a, b, c] = mesh.corners(triangle as usize);
        let normal = normal_matrix(&world_from_mesh) * glam::Vec3A::from((b - a).cross(c - a));
        SurfaceHit {
            entity: placed.entity,
            owner: placed.owner,
            material: self
                .house
                .slot_material(placed.owner, mesh.slot(triangle as usize)),
            mesh: placed.mesh,
            triangle,
            normal: Vec3::from(normal).normalize_or_zero(),
        }
    }

    /// Returns the owner and the material of the surface of a hit; cheaper than [`Self::surface`], which also finds its normal.
    pub fn owner_and_material(&self, hit: &Hit) -> (SurfaceOwner, MaterialId) {
        let geometry = self.house.geometry();
        let (placed, triangle) = if let Some(instance) = hit.instance {
            let part = self.part_of_instance(instance);
            (geometry.placed_part(part), hit.triangle)
        } else {
            let source = geometry.static_triangles[hit.triangle as usize];
            (&geometry.placed[source.placed as usize], source.triangle)
        };
        let slot = self.house.meshes[placed.mesh].slot(triangle as usize);
        (placed.owner, self.house.slot_material(placed.owner, slot))
    }

    /// The texture coordinates at the hit; zero where the mesh has none.
    pub fn uv(&self, hit: &Hit) -> Vec2 {
        let (placed, triangle, _) = self.placed(hit);
        let mesh = &self.house.meshes[placed.mesh];
        if mesh.uvs.is_empty() {
            return Vec2::ZERO;
        }
        let [a, b, c] = mesh.triangles[triangle as usize].map(|vertex| mesh.uvs[vertex as usize]);
        a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v
    }

    /// The interpolated normal at the hit in world space, unit length; the triangle's own where the mesh has none.
    pub fn shading_normal(&self, hit: &Hit) -> Vec3 {
        let (placed, triangle, world_from_mesh) = self.placed(hit);
        let mesh = &self.house.meshes[placed.mesh];
        if mesh.normals.is_empty() {
            return self.surface(hit).normal;
        }
        let [a, b, c] =
            mesh.triangles[triangle as usize].map(|vertex| mesh.normals[vertex as usize]);
        let normal = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        let normals: Mat3A = normal_matrix(&world_from_mesh);
        let turned = Vec3::from(normals * glam::Vec3A::from(normal)).normalize_or_zero();
        if turned == Vec3::ZERO {
            self.surface(hit).normal
        } else {
            turned
        }
    }
}

/// Returns the parts that move, at their initial poses.
fn moving_part_instances(house: &House) -> impl Iterator<Item = Instance> + '_ {
    let geometry = house.geometry();
    geometry.movable.iter().map(|part| {
        let placed = geometry.placed_part(*part);
        Instance {
            mesh: geometry.mesh_bvh[placed.mesh].clone().unwrap_or_default(),
            world_from_mesh: placed.world_from_mesh,
            id: placed.entity.0,
            mask: RayMask::ALL,
        }
    })
}

impl House {
    /// Returns the material of a slot of a placed mesh.
    pub fn slot_material(&self, owner: SurfaceOwner, slot: u16) -> MaterialId {
        match owner {
            SurfaceOwner::Structure(id) => self.structure[id].materials[usize::from(slot)],
            SurfaceOwner::Part(id) => self.parts[id].materials[usize::from(slot)],
        }
    }

    /// Returns the moving instance of a part; `None` for a fixed one.
    pub fn instance_of_part(&self, part: PartId) -> Option<u32> {
        self.geometry()
            .movable
            .binary_search_by_key(&part.index(), |id| id.index())
            .ok()
            .map(|k| k as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ShoeboxMaterials;

    #[test]
    fn a_ray_in_a_room_meets_the_wall_it_points_at() {
        let house =
            Arc::new(House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap());
        let scene = RayScene::new(house.clone());
        let ray = Ray::new(Vec3::new(1.0, 1.0, 2.0), Vec3::X);
        let hit = scene.closest(&ray, RayMask::ALL).unwrap();
        let surface = scene.surface(&hit);
        assert!((hit.distance_m - 5.0).abs() < 1e-5);
        assert_eq!(house.materials[surface.material].name, "east");
        let owned = (surface.owner, surface.material);
        assert_eq!(scene.owner_and_material(&hit), owned);
        assert!((surface.normal - Vec3::NEG_X).length() < 1e-6);
        assert!(
            scene.occluded(&ray, RayMask::ALL)
                && !scene.occluded(&ray.with_range(0.0, 4.9), RayMask::ALL)
        );
    }
}
