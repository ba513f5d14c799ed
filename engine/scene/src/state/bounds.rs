//! Bounds of a house's objects in a state.

use super::State;
use crate::bounds::Aabb;
use crate::house::House;
use crate::ids::{ObjectId, PartId};

impl House {
    /// Returns the box around a part in `state`, m.
    pub fn part_bounds(&self, state: &State, id: PartId) -> Aabb {
        let part = &self.parts[id];
        let world_from_mesh = state.part_pose[id].to_affine() * part.part_from_mesh;
        let mesh = &self.meshes[part.mesh];
        Aabb::from_points(
            mesh.positions
                .iter()
                .map(|p| world_from_mesh.transform_point3(*p)),
        )
    }

    /// Returns the box around an object in `state`, m.
    pub fn object_bounds(&self, state: &State, id: ObjectId) -> Aabb {
        self.objects[id].parts().fold(Aabb::EMPTY, |bounds, part| {
            bounds.union(&self.part_bounds(state, part))
        })
    }

    /// Returns the boxes around all objects in `state`, m. Shape (object,).
    pub fn object_boxes(&self, state: &State) -> Vec<Aabb> {
        let ids = self.objects.ids();
        ids.map(|id| self.object_bounds(state, id)).collect()
    }
}
