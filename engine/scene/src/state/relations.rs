//! Support and containment relations, derived from contacts, poses and geometry. The one definition of "in"; engines and
//! language use it.

use super::State;
use crate::bounds::Aabb;
use crate::fixtures::{Receptacle, ReceptacleKind};
use crate::house::{House, HouseData};
use crate::ids::{Id, ObjectId, PartId};
use crate::space::Pose;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The share of an object's box that must lie in the container's.
const INSIDE_SHARE: f32 = 0.8;
/// Largest height by which an object may stick out of a container's box, m.
const MAX_PROTRUSION_M: f32 = 0.02;
/// Largest distance of an object's middle from a marked space, m.
const SPACE_MARGIN_M: f32 = 0.01;
/// Number of the rays from an object's middle to the four sides and down that must hit its container.
const MIN_ENCLOSING_RAYS: usize = 4;

/// The support relation of two things in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SupportDirection {
    /// Neither supports the other.
    #[default]
    NoSupport,
    /// `a` rests on `b`: some contact normal is at most 60 degrees from upright.
    AOnB,
    /// `b` rests on `a`.
    BOnA,
}

/// Two things in contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// The part whose number is lower.
    pub a: PartId,
    /// The other part; `None`: the structure of the house.
    pub b: Option<PartId>,
    /// The support relation.
    pub support_relation: SupportDirection,
}

impl State {
    /// Returns the supports of an object: objects in order, `None` for the building. Empty while it is held, flies, or
    /// never moves (physics finds no contacts between things that cannot move).
    pub fn supports_of(&self, house: &House, object: ObjectId) -> Vec<Option<ObjectId>> {
        if self.held_by[object].is_some() {
            return Vec::new();
        }
        let mut carriers: Vec<Option<ObjectId>> = self
            .support_pairs(house)
            .filter_map(|(carried, by)| (carried == object).then_some(by))
            .collect();
        carriers.sort_unstable();
        carriers.dedup();
        carriers
    }

    /// Returns the supports of each object, as [`State::supports_of`] of one, in one pass over the contacts. Shape (object,).
    pub fn supports_of_all(&self, house: &House) -> Vec<Vec<Option<ObjectId>>> {
        let mut all = vec![Vec::new(); house.objects.len()];
        for (carried, by) in self.support_pairs(house) {
            if self.held_by[carried].is_none() {
                all[carried.index()].push(by);
            }
        }
        for carriers in &mut all {
            carriers.sort_unstable();
            carriers.dedup();
        }
        all
    }

    /// Returns the supported object and its support of each contact in which one thing supports another.
    fn support_pairs(&self, house: &House) -> impl Iterator<Item = (ObjectId, Option<ObjectId>)> {
        let owner = |part: PartId| house.parts[part].object;
        let pairs = self.contacts.iter().filter_map(move |contact| {
            let (a, b) = (owner(contact.a), contact.b.map(owner));
            match contact.support_relation {
                SupportDirection::AOnB => Some((a, b)),
                SupportDirection::BOnA => b.map(|b| (b, Some(a))),
                SupportDirection::NoSupport => None,
            }
        });
        pairs.filter(|(carried, by)| *by != Some(*carried))
    }

    /// Returns the objects that contain an object, in order. A held object is in nothing.
    ///
    /// `boxes`: the boxes around all objects, shape (object,), as [`House::object_boxes`] gives them.
    pub fn containers_of(&self, house: &House, object: ObjectId, boxes: &[Aabb]) -> Vec<ObjectId> {
        if self.held_by[object].is_some() {
            return Vec::new();
        }
        let inner = boxes[object.index()];
        let middle = inner.center();
        house
            .objects
            .ids()
            .filter(|container| *container != object)
            .filter(|container| {
                let outer = boxes[container.index()];
                // An object of which four fifths lie inside has its middle inside.
                outer.grown(2.0 * MAX_PROTRUSION_M).contains(middle)
                    && house.encloses(self, *container, &outer, &inner)
            })
            .collect()
    }
}

impl House {
    /// Returns whether the box `inner` (m, world space) lies in an object whose box is `outer`.
    ///
    /// Four fifths of it lie in the object's box (grown by 2 cm), it is the smaller of the two, and either its middle lies
    /// in a receptacle of the object that holds things inside, or the object is around it: of the five rays from the middle
    /// to the four sides (along the object's own axes) and down, at least four hit the object. So a bowl, a drawer, a sink
    /// and a shelf's compartment (open in front) contain things; a table does not contain things under it.
    pub fn encloses(&self, state: &State, container: ObjectId, outer: &Aabb, inner: &Aabb) -> bool {
        let pose = |part: PartId| state.part_pose[part];
        let spaces = || self.receptacles_of(container);
        encloses(self.data(), &pose, spaces, (container, outer), inner)
    }

    /// Returns whether [`Self::encloses`] can hold between the boxes: four fifths of `inner` lie in `outer`, the larger
    /// one, grown by 2 cm.
    pub fn fits_in(outer: &Aabb, inner: &Aabb) -> bool {
        // The smaller volume is the content; this makes the relation asymmetric.
        inner.volume() < outer.volume()
            && share_inside(inner, &outer.grown(MAX_PROTRUSION_M)) >= INSIDE_SHARE
    }
}

impl HouseData {
    /// As [`House::encloses`], with every part at its initial pose.
    pub fn encloses_at_start(&self, container: ObjectId, outer: &Aabb, inner: &Aabb) -> bool {
        let pose = |part: PartId| self.parts[part].world_from_part;
        let spaces = || {
            let all = self.receptacles.iter();
            all.filter(|space| space.object == container)
        };
        encloses(self, &pose, spaces, (container, outer), inner)
    }
}

fn encloses<'a, I: Iterator<Item = &'a Receptacle>>(
    data: &HouseData,
    pose: &dyn Fn(PartId) -> Pose,
    spaces: impl FnOnce() -> I,
    (container, outer): (ObjectId, &Aabb),
    inner: &Aabb,
) -> bool {
    let middle = inner.center();
    let marked = |space: &Receptacle| {
        space.holding == ReceptacleKind::In && {
            let part_from_world = pose(space.part).inverse();
            space
                .space_in_part
                .grown(SPACE_MARGIN_M)
                .contains(part_from_world.transform_point(middle))
        }
    };
    House::fits_in(outer, inner)
        && (spaces().any(marked) || surrounds(data, pose, container, middle))
}

fn surrounds(
    data: &HouseData,
    pose: &dyn Fn(PartId) -> Pose,
    container: ObjectId,
    point: Vec3,
) -> bool {
    let root = data.objects[container].first_part;
    let axes = pose(root).rotation;
    let rays = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Y].map(|axis| axes * axis);
    let mut met = [false; 5];
    for id in data.objects[container].parts() {
        let part = &data.parts[id];
        let mesh = &data.meshes[part.mesh];
        let world_from_mesh = pose(id).to_affine() * part.part_from_mesh;
        for triangle in 0..mesh.triangles.len() {
            let corners = mesh
                .corners(triangle)
                .map(|corner| world_from_mesh.transform_point3(corner));
            for (met, ray) in met.iter_mut().zip(rays) {
                *met = *met || ray_meets(corners, point, ray);
            }
            if met.iter().filter(|met| **met).count() >= MIN_ENCLOSING_RAYS {
                return true;
            }
        }
    }
    false
}

fn share_inside(inner: &Aabb, outer: &Aabb) -> f32 {
    let low = inner.min.max(outer.min);
    let high = inner.max.min(outer.max);
    let size = inner.size().max(Vec3::splat(1e-4));
    ((high - low).max(Vec3::ZERO) / size)
        .min(Vec3::ONE)
        .element_product()
}

/// Returns whether the ray from `origin` along `direction` hits the triangle from either side, at a positive distance.
///
/// # Source
/// T. Möller, B. Trumbore, J. Graphics Tools 2, 21 (1997).
fn ray_meets([a, b, c]: [Vec3; 3], origin: Vec3, direction: Vec3) -> bool {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-12 {
        return false;
    }
    let offset = origin - a;
    let u = offset.dot(p) / determinant;
    let q = offset.cross(ab);
    let v = direction.dot(q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(q) / determinant > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ShoeboxMaterials;

    #[test]
    fn rays_meet_what_lies_ahead_from_both_sides() {
        let triangle = [
            Vec3::new(0.0, -1.0, -1.0),
            Vec3::new(0.0, 1.0, -1.0),
            Vec3::new(0.0, 0.0, 1.0),
        ];
        assert!(ray_meets(triangle, Vec3::new(-1.0, 0.0, 0.0), Vec3::X));
        assert!(ray_meets(triangle, Vec3::new(1.0, 0.0, 0.0), Vec3::NEG_X));
        assert!(!ray_meets(triangle, Vec3::new(1.0, 0.0, 0.0), Vec3::X));
        assert!(!ray_meets(triangle, Vec3::new(-1.0, 2.0, 0.0), Vec3::X));
    }

    #[test]
    fn a_share_counts_the_volume_that_lies_inside() {
        let outer = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let inner = Aabb::new(Vec3::splat(0.5), Vec3::new(0.75, 0.75, 1.5));
        assert!((share_inside(&inner, &outer) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn who_carries_whom_follows_the_contacts_and_the_hand() {
        let house = House::shoebox([4.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let state = State::new(&house);
        assert!(house.objects.is_empty() && state.contacts.is_empty());
        // Contacts name parts; two objects of one part each.
        let mut data = house.data().clone();
        let mesh = data.meshes.push(std::sync::Arc::new(crate::Mesh::cuboid(
            Vec3::ZERO,
            Vec3::ONE,
        )));
        let material = crate::MaterialId(0);
        for k in 0..2_u32 {
            data.parts.push(crate::Part {
                object: ObjectId(k),
                name: "body".to_owned(),
                fixed: false,
                world_from_part: crate::Pose::IDENTITY,
                mesh,
                part_from_mesh: glam::Affine3A::IDENTITY,
                materials: vec![material],
                colliders: Vec::new(),
                mass_kg: Some(1.0),
                density_kg_m3: 100.0,
                inertial: None,
            });
            data.objects.push(crate::Object {
                name: format!("thing_{k}"),
                source_id: String::new(),
                model: String::new(),
                category: crate::Category::default(),
                level: crate::LevelId(0),
                room: None,
                mobility: crate::Mobility::Movable,
                pickable: true,
                switch: None,
                first_part: PartId::from_index(k as usize),
                part_count: 1,
            });
        }
        let house = House::new(data).unwrap();
        let mut state = State::new(&house);
        let contact = |a: u32, b: Option<u32>, rest| Contact {
            a: PartId(a),
            b: b.map(PartId),
            support_relation: rest,
        };
        state.contacts = vec![
            contact(0, None, SupportDirection::NoSupport),
            contact(0, Some(1), SupportDirection::AOnB),
            contact(1, None, SupportDirection::AOnB),
        ];
        assert_eq!(state.supports_of(&house, ObjectId(0)), [Some(ObjectId(1))]);
        assert_eq!(state.supports_of(&house, ObjectId(1)), [None]);
        assert_eq!(
            state.supports_of_all(&house),
            [vec![Some(ObjectId(1))], vec![None]]
        );
        state.held_by[ObjectId(0)] = Some(crate::AgentId(0));
        assert!(state.supports_of(&house, ObjectId(0)).is_empty());
        assert_eq!(state.supports_of_all(&house), [vec![], vec![None]]);
    }
}
