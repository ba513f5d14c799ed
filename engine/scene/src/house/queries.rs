//! Queries of a house that need no state.

use super::House;
use super::data::Room;
use crate::bounds::Aabb;
use crate::ids::{AgentId, Entity, EntityId, Id, JointId, ObjectId, RoomId, StructureId};
use crate::random::RandomKey;
use glam::{Vec2, Vec3};

impl Room {
    /// Returns the area of the footprint, m²; [`House::exclusive_area_m2`] leaves out the area of smaller rooms.
    pub fn area_m2(&self) -> f32 {
        self.footprint
            .iter()
            .map(|[a, b, c]| (*b - *a).perp_dot(*c - *a).abs() * 0.5)
            // The sum of nothing is -0.
            .fold(0.0, std::ops::Add::add)
    }

    /// Returns whether the point (x, z) lies over the floor, border included. Degenerate triangles contain nothing.
    pub fn contains_xz(&self, point: Vec2) -> bool {
        let flat = |[a, b, c]: &[Vec2; 3]| (b - a).perp_dot(c - a) == 0.0;
        let mut triangles = self.footprint.iter().filter(|triangle| !flat(triangle));
        triangles.any(|[a, b, c]| {
            let turn = |p: Vec2, q: Vec2| (q - p).perp_dot(point - p);
            let (s, t, u) = (turn(*a, *b), turn(*b, *c), turn(*c, *a));
            (s >= 0.0 && t >= 0.0 && u >= 0.0) || (s <= 0.0 && t <= 0.0 && u <= 0.0)
        })
    }

    /// Returns its most fitting kind; `"room"` when none is known.
    pub fn kind(&self) -> &str {
        self.kinds.first().map_or("room", String::as_str)
    }
}

impl House {
    /// Returns the entity id of a structure piece.
    pub fn entity_of_structure(&self, id: StructureId) -> EntityId {
        EntityId(1 + id.0 as i32)
    }

    /// Returns the entity id of an object.
    pub fn entity_of_object(&self, id: ObjectId) -> EntityId {
        EntityId((1 + self.structure.len() + id.index()) as i32)
    }

    /// Returns the entity id of an agent.
    pub fn entity_of_agent(&self, id: AgentId) -> EntityId {
        EntityId((1 + self.structure.len() + self.objects.len() + id.index()) as i32)
    }

    /// Returns the thing that an id names; `None` for a negative one. Ids beyond the objects are agents.
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

    /// Returns the room that contains `point`: over its floor, between floor and ceiling (0.3 m below to 0.3 m above, if no
    /// other storey's room contains it without that), the smallest one where rooms overlap.
    pub fn room_at(&self, point: Vec3) -> Option<RoomId> {
        let index = self.room_index();
        let point_xz = Vec2::new(point.x, point.z);
        let strays = |room: &Room| point.y < room.floor_y - 0.01 || point.y > room.ceiling_y + 0.01;
        let mut best: Option<(bool, f32, RoomId)> = None;
        index.for_each_near(point, |id| {
            let room = &self.rooms[id];
            if room.contains_xz(point_xz) {
                let own = (strays(room), index.area_m2[id], id);
                let is_better = |(stray, area_m2, other): &(bool, f32, RoomId)| {
                    let by_area = own.1.total_cmp(area_m2);
                    own.0.cmp(stray).then(by_area).then(id.cmp(other)).is_lt()
                };
                if best.as_ref().is_none_or(is_better) {
                    best = Some(own);
                }
            }
        });
        best.map(|(_, _, id)| id)
    }

    /// Returns whether a point lies in no room; in a house without rooms: whether it lies beyond all walls. Nothing is
    /// outside a house with neither.
    pub fn is_outside(&self, point: Vec3) -> bool {
        if !self.rooms.is_empty() {
            return self.room_at(point).is_none();
        }
        let pieces = self.structure.iter();
        let bounds = pieces.fold(Aabb::EMPTY, |bounds, piece| {
            bounds.union(&self.meshes[piece.mesh].bounds())
        });
        !self.structure.is_empty() && !bounds.contains(point)
    }

    /// Returns points at half height over a room's floor, evenly spread by area: of `count`, those that lie in no smaller room.
    ///
    /// # Determinism
    /// The same points for the same house and count.
    pub fn points_in_room(&self, id: RoomId, count: usize) -> Vec<Vec3> {
        let room = &self.rooms[id];
        let mut stream = RandomKey::root(0)
            .child("floor")
            .child(u64::from(id.0))
            .stream();
        let total = room.area_m2();
        let mut points = Vec::with_capacity(count);
        crate::interrupt::unwind_if_cancelled();
        for k in 0..count {
            let mut left = (k as f32 + 0.5) / count as f32 * total;
            let triangle = room.footprint.iter().find(|[a, b, c]| {
                left -= (*b - *a).perp_dot(*c - *a).abs() * 0.5;
                left <= 0.0
            });
            let Some([a, b, c]) = triangle.or(room.footprint.last()) else {
                break;
            };
            let (mut u, mut v) = (stream.uniform_f32(), stream.uniform_f32());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let point = *a + (*b - *a) * u + (*c - *a) * v;
            let point = Vec3::new(point.x, room.floor_y.midpoint(room.ceiling_y), point.y);
            points.extend(Some(point).filter(|point| self.room_at(*point) == Some(id)));
        }
        points
    }

    /// Returns the area of a room's floor that lies in no smaller room, m²: the room's size as people see it. Where rooms
    /// overlap it is estimated from 256 points.
    pub fn exclusive_area_m2(&self, id: RoomId) -> f32 {
        const POINTS: usize = 256;
        let share = self.points_in_room(id, POINTS).len() as f32 / POINTS as f32;
        self.rooms[id].area_m2() * share
    }

    /// The joints of an object, in order.
    pub fn joints_of(&self, object: ObjectId) -> impl Iterator<Item = JointId> + '_ {
        self.joints
            .iter_ids()
            .filter(move |(_, joint)| joint.object == object)
            .map(|(id, _)| id)
    }

    /// Returns the number of triangles in a picture of the whole house: structure and every instance.
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

#[cfg(test)]
mod tests {
    use crate::random::RandomKey;
    use crate::{House, RoomId, ShoeboxMaterials};
    use glam::{Vec2, Vec3};

    /// Every point of a segment is on its border, and all of space is on the border of a triangle that is a single point.
    #[test]
    fn triangles_without_area_hold_nothing() {
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut room = house.rooms[RoomId(0)].clone();
        let (inside, outside) = (Vec2::new(1.0, 1.0), Vec2::new(9.0, 0.0));
        let before = [inside, outside].map(|point| room.contains_xz(point));
        assert_eq!(before, [true, false]);
        let [a, b] = [Vec2::ZERO, Vec2::new(4.0, 0.0)];
        room.footprint.insert(0, [a, a, a]);
        room.footprint.insert(0, [a, b, b]);
        room.footprint.insert(0, [a, b, b * 0.5]);
        let after = [inside, outside].map(|point| room.contains_xz(point));
        assert_eq!(after, before);
    }

    /// The bounding rectangles of the floors leave out no room that a comparison with each of them finds.
    #[test]
    fn the_room_at_a_point_is_that_of_all_rooms_compared() {
        let one = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let mut stream = RandomKey::root(5).child("rooms").stream();
        let mut somewhere = |size: f32| {
            let across = stream.uniform_f32() * 2.0 - 1.0;
            Vec2::new(across, stream.uniform_f32() * 2.0 - 1.0) * size
        };
        let mut data = one.data().clone();
        let room = data.rooms[RoomId(0)].clone();
        for k in 0..60 {
            let middle = somewhere(10.0);
            let mut room = room.clone();
            room.name = format!("room_{k}");
            room.footprint = vec![[(); 3].map(|()| middle + somewhere(4.0))];
            data.rooms.push(room);
        }
        let house = House::new(data).unwrap();
        let corners = house.rooms.iter().flat_map(|room| room.footprint.clone());
        let corners: Vec<Vec2> = corners.flatten().collect();
        let points = corners
            .into_iter()
            .chain((0..2000).map(|_| somewhere(14.0)));
        for point in points {
            let all = house.rooms.iter_ids();
            let smallest = all
                .filter(|(_, room)| room.contains_xz(point))
                .min_by(|(_, a), (_, b)| a.area_m2().total_cmp(&b.area_m2()));
            let found = house.room_at(Vec3::new(point.x, 1.0, point.y));
            assert_eq!(found, smallest.map(|(id, _)| id), "at {point}");
        }
    }
}
