//! Unoccluded pixels: how many a thing would have without all others.

use super::CpuRenderer;
use super::camera_rays::{CameraRayGenerator, CameraRayPacket, LANES, PACKET_COLUMNS, PACKET_ROWS};
use crate::frame::View;
use dwell_scene::bvh::{Instance, InstanceSet, RayMask, SceneBvh, TriangleBvh};
use dwell_scene::rays::{BODY_PIECES, RayScene};
use dwell_scene::{AgentId, Entity, EntityId, Id, MeshId, ObjectId, State};
use glam::{Affine3A, Vec2};
use std::sync::{Arc, LazyLock};

static NOTHING: LazyLock<TriangleBvh> = LazyLock::new(TriangleBvh::default);

impl CpuRenderer {
    /// Returns the number of pixels of a view that would show a thing if nothing else were there: those whose middle's ray meets it within
    /// the camera's range. 0 for what is neither an object nor an agent.
    pub fn unoccluded_pixel_count(
        &self,
        scene: &RayScene,
        state: &State,
        view: &View,
        entity: EntityId,
    ) -> u32 {
        let set = match self.house().entity(entity) {
            Some(Entity::Object(object)) => self.object_instances(state, object),
            Some(Entity::Agent(agent)) => agent_instances(scene, self, agent),
            _ => return 0,
        };
        let alone = SceneBvh {
            fixed: &NOTHING,
            moving: &set,
        };
        let rays = CameraRayGenerator::new(&View {
            hidden_entity: None,
            ..*view
        });
        let (columns, rows) = image_bounds(view, &set);
        let (mut packet, mut count) = (CameraRayPacket::new(), 0);
        let end = (view.camera.width() as usize, view.camera.height() as usize);
        for top in rows.step_by(PACKET_ROWS) {
            for left in columns.clone().step_by(PACKET_COLUMNS) {
                rays.cast(alone, (left, top), end, &mut packet);
                count += (0..LANES).filter(|lane| packet.has_hit(*lane)).count() as u32;
            }
        }
        count
    }

    /// The instances of an object's parts.
    fn object_instances(&self, state: &State, object: ObjectId) -> InstanceSet {
        let (house, geometry) = (self.house(), self.house().geometry());
        let thing = &house.objects[object];
        let first = thing.first_part.index();
        let parts = first..first + thing.part_count as usize;
        InstanceSet::new(parts.map(|part| {
            let part = dwell_scene::PartId::from_index(part);
            let placed = geometry.placed_part(part);
            let world_from_mesh = if house.parts[part].fixed {
                placed.world_from_mesh
            } else {
                state.part_pose[part].to_affine() * placed.part_from_mesh
            };
            Instance {
                mesh: self.tree(placed.mesh),
                world_from_mesh,
                id: placed.entity.0,
                mask: RayMask::ALL,
            }
        }))
    }

    /// The tree of a mesh.
    fn tree(&self, mesh: MeshId) -> Arc<TriangleBvh> {
        if let Some(tree) = &self.house().geometry().mesh_bvh[mesh] {
            return tree.clone();
        }
        let build = || {
            let mesh = &self.house().meshes[mesh];
            Arc::new(TriangleBvh::build(&mesh.positions, &mesh.triangles))
        };
        self.trees[mesh.index()].get_or_init(build).clone()
    }
}

/// The instances of an agent's body.
fn agent_instances(scene: &RayScene, renderer: &CpuRenderer, agent: AgentId) -> InstanceSet {
    let mut set = scene.bvh().moving.clone();
    let parts = renderer.house().geometry().movable.len();
    let own = parts + agent.index() * BODY_PIECES..parts + (agent.index() + 1) * BODY_PIECES;
    for instance in (0..set.len()).filter(|k| !own.contains(k)) {
        // Out of every ray's way, and out of the tree.
        set.set_pose(instance as u32, &Affine3A::ZERO);
    }
    set
}

/// Columns and rows of the image outside which nothing of a set appears; they begin where packets do.
fn image_bounds(
    view: &View,
    set: &InstanceSet,
) -> (std::ops::Range<usize>, std::ops::Range<usize>) {
    let camera = &view.camera;
    let (width, height) = (camera.width() as usize, camera.height() as usize);
    let bounds = (0..set.len() as u32)
        .map(|instance| set.bounds_of(instance))
        .reduce(|a, b| a.union(&b))
        .unwrap_or(dwell_scene::Aabb::EMPTY);
    if bounds.is_empty() {
        return (0..0, 0..0);
    }
    let all = (0..width, 0..height);
    // Only there straight lines stay straight, so that corners bound what lies between them.
    if !camera.projection().preserves_straight_lines() {
        return all;
    }
    let camera_from_world = view.world_from_camera.inverse();
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for corner in bounds.corners() {
        let Some((image, _)) = camera.project(camera_from_world.transform_point(corner)) else {
            return all;
        };
        (low, high) = (low.min(image), high.max(image));
    }
    let cut = |low: f32, high: f32, size: usize, step: usize| {
        // Negative and not a number become 0.
        let first = (low - 1.0) as usize / step * step;
        let end = ((high + 2.0) as usize).min(size);
        first.min(end)..end
    };
    (
        cut(low.x, high.x, width, PACKET_COLUMNS),
        cut(low.y, high.y, height, PACKET_ROWS),
    )
}
