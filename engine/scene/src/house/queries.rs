//! Questions about a house that need no state.

use super::House;
use super::data::Room;
use crate::ids::{AgentId, Entity, EntityId, Id, JointId, ObjectId, PartId, RoomId, StructureId};
use crate::state::State;
use glam::{Vec2, Vec3};

impl Room {
    /// The area of the floor, m².
    pub fn area_m2(&self) -> f32 {
        self.footprint
            .iter()
            .map(|[a, b, c]| (*b - *a).perp_dot(*c - *a).abs() * 0.5)
            .sum()
    }

    /// Whether the point (x, z) lies over the floor, border included.
    pub fn contains_xz(&self, point: Vec2) -> bool {
        self.footprint.iter().any(|[a, b, c]| {
            let turn = |p: Vec2, q: Vec2| (q - p).perp_dot(point - p);
            let (s, t, u) = (turn(*a, *b), turn(*b, *c), turn(*c, *a));
            (s >= 0.0 && t >= 0.0 && u >= 0.0) || (s <= 0.0 && t <= 0.0 && u <= 0.0)
        })
    }

    /// The most fitting word for it; `"room"` when nothing is known.
    pub fn kind(&self) -> &str {
        self.kinds.first().map_or("room", String::as_str)
    }
}

impl House {
    /// The sensors' id of a structure piece.
    pub fn entity_of_structure(&self, id: StructureId) -> EntityId {
        EntityId(1 + id.0 as i32)
    }

    /// The sensors' id of an object.
    pub fn entity_of_object(&self, id: ObjectId) -> EntityId {
        EntityId((1 + self.structure.len() + id.index()) as i32)
    }

    /// The sensors' id of an agent.
    pub fn entity_of_agent(&self, id: AgentId) -> EntityId {
        EntityId((1 + self.structure.len() + self.objects.len() + id.index()) as i32)
    }

    /// What an id names; `None` for a negative one. Ids beyond the objects are agents.
    pub fn entity(&self, id: EntityId) -> Option<Entity> {
        let index = usize::try_from(id.0).ok()?;
        let (structure, objects) = (self.structure.len(), self.objects.len());
        Some(match index {
            0 => Entity::Void,
            k if k <= structure => Entity::Structure(StructureId::from_index(k - 1)),
            k if k <= structure + objects => {
                Entity::Object(ObjectId::from_index(k - 1 - structure))
            }
            k => Entity::Agent(AgentId::from_index(k - 1 - structure - objects)),
        })
    }

    /// The object called `name`.
    pub fn object_named(&self, name: &str) -> Option<ObjectId> {
        self.objects
            .iter_ids()
            .find(|(_, object)| object.name == name)
            .map(|(id, _)| id)
    }

    /// The room that holds `point`: over its floor, between floor and ceiling (0.3 m below to 0.3 m above), the smallest
    /// one where rooms overlap.
    pub fn room_at(&self, point: Vec3) -> Option<RoomId> {
        let holds = |room: &Room| {
            point.y >= room.floor_y - 0.3
                && point.y <= room.ceiling_y + 0.3
                && room.contains_xz(Vec2::new(point.x, point.z))
        };
        self.rooms
            .iter_ids()
            .filter(|(_, room)| holds(room))
            .min_by(|(_, a), (_, b)| a.area_m2().total_cmp(&b.area_m2()))
            .map(|(id, _)| id)
    }

    /// The joints of an object, in order.
    pub fn joints_of(&self, object: ObjectId) -> impl Iterator<Item = JointId> + '_ {
        self.joints
            .iter_ids()
            .filter(move |(_, joint)| joint.object == object)
            .map(|(id, _)| id)
    }

    /// The box around a part where it stands in `state`, m.
    pub fn part_bounds(&self, state: &State, id: PartId) -> crate::Aabb {
        let part = &self.parts[id];
        let world_from_mesh = state.part_pose[id].to_affine() * part.part_from_mesh;
        let mesh = &self.meshes[part.mesh];
        crate::Aabb::from_points(
            mesh.positions
                .iter()
                .map(|p| world_from_mesh.transform_point3(*p)),
        )
    }

    /// The box around an object where it stands in `state`, m.
    pub fn object_bounds(&self, state: &State, id: ObjectId) -> crate::Aabb {
        self.objects[id]
            .parts()
            .fold(crate::Aabb::EMPTY, |bounds, part| {
                bounds.union(&self.part_bounds(state, part))
            })
    }

    /// The number of triangles that a picture of the whole house shows: structure and every instance.
    pub fn triangle_count(&self) -> usize {
        let structure = self
            .structure
            .iter()
            .map(|piece| self.meshes[piece.mesh].triangles.len());
        structure
            .chain(
                self.parts
                    .iter()
                    .map(|part| self.meshes[part.mesh].triangles.len()),
            )
            .sum()
    }
}
