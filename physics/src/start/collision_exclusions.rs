//! Collision exclusions of joints' leaves.

use super::overlap::penetration_depth;
use super::{CLEARANCE_M, PenetrationResolver};
use crate::contact::{ColliderMetadata, CollisionExclusions, ContactEntity, entry_index};
use crate::error::PhysicsError;
use crate::limits;
use crate::model::{BodyDefinition, PhysicsModel, PieceOwner, shapes};
use crate::report::{PassThroughJoint, StartReport};
use dwell_scene::interrupt;
use dwell_scene::{Mobility, ObjectId};
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;
use std::collections::{BTreeMap, BTreeSet};

/// Distance from a leaf within which a thing may be one that it passes through, m.
const LEAF_MARGIN_M: f32 = 0.01;

impl PenetrationResolver<'_> {
    /// Returns the collision exclusions of joints' leaves: their own object, and the things that they overlap at the start.
    /// A robot's links have fewer: the links that they are jointed to, and the things that they are inside of at the start.
    ///
    /// # Errors
    /// [`PhysicsError::TooMany`] for more pairs than a world holds.
    pub(crate) fn joint_exclusions(
        &self,
        report: &mut StartReport,
    ) -> Result<CollisionExclusions, PhysicsError> {
        let mut pairs: BTreeSet<(u32, u32)> = BTreeSet::new();
        let house = &self.model.house;
        let driven = house.joints.iter().filter(|joint| joint.servo.is_some());
        let robots: BTreeSet<ObjectId> = driven.map(|joint| joint.object).collect();
        let families = JointedObjectPieces::new(self.model, self.entries);
        for (index, plan) in self.model.bodies.iter().enumerate() {
            let Some(joint) = plan.joint else { continue };
            interrupt::unwind_if_cancelled();
            let robot = robots.contains(&plan.object);
            let mut through = BTreeSet::new();
            let place = self.body_pose(index);
            for piece in &plan.pieces {
                let world_from_piece = place * piece.pose;
                let near = shapes::bounds(&piece.shape, &world_from_piece).grown(LEAF_MARGIN_M);
                let aabb = rapier3d::geometry::Aabb::new(near.min, near.max);
                let queries = self.engine.queries(QueryFilter::default());
                for (_, collider) in queries.intersect_aabb_conservative(aabb) {
                    let entry = entry_index(collider);
                    let other = &self.entries[entry];
                    let same = self.same_object(other, plan);
                    // Free bodies are moved out of the way instead.
                    let free = other
                        .body
                        .is_some_and(|other| self.model.bodies[other as usize].joint.is_none());
                    if other.body == Some(index as u32) || (free && !same) {
                        continue;
                    }
                    let within = |margin_m: f32| {
                        query::distance(
                            collider.position(),
                            collider.shape(),
                            &world_from_piece,
                            &*piece.shape,
                        )
                        .is_ok_and(|found| found.distance <= margin_m)
                    };
                    let inside = || {
                        penetration_depth(
                            collider.position(),
                            collider.shape(),
                            &world_from_piece,
                            &*piece.shape,
                            self.owner(entry),
                        )
                        .is_some_and(|overlap| self.exceeds_tolerance(&overlap))
                    };
                    let touches = match (robot, same) {
                        (true, true) => within(CLEARANCE_M),
                        (true, false) => !self.is_movable(plan) && inside(),
                        (false, true) => true,
                        (false, false) => within(LEAF_MARGIN_M),
                    };
                    if touches {
                        pairs.insert((index as u32, entry as u32));
                        if let Some(owner) = other.contact_entity.filter(|_| !same) {
                            through.insert(self.entity_name(owner));
                        }
                    }
                }
            }
            // Its own object's other parts may come near only later.
            let number = index as u32;
            if robot {
                pairs.extend(
                    families
                        .joined(self.model, number)
                        .map(|entry| (number, entry)),
                );
            } else {
                pairs.extend(
                    families
                        .pieces_of_other_bodies(plan.object, number)
                        .map(|entry| (number, entry)),
                );
            }
            limits::check_excluded_pairs(&self.model.house, plan.object, pairs.len())?;
            if !through.is_empty() {
                report.passing.push(PassThroughJoint {
                    joint,
                    through: through.into_iter().collect(),
                });
            }
        }
        Ok(CollisionExclusions {
            entries: pairs.into_iter().collect(),
            carriers: Vec::new(),
        })
    }

    /// Returns whether a body's object has a free root.
    fn is_movable(&self, plan: &BodyDefinition) -> bool {
        self.model.house.objects[plan.object].mobility == Mobility::Movable
    }

    fn same_object(&self, entry: &ColliderMetadata, plan: &BodyDefinition) -> bool {
        match entry.contact_entity {
            Some(ContactEntity::Part(part)) => self.model.house.parts[part].object == plan.object,
            _ => false,
        }
    }

    fn entity_name(&self, contact_entity: ContactEntity) -> String {
        let owner = match contact_entity {
            ContactEntity::Structure(id) => PieceOwner::Structure(id),
            ContactEntity::Part(id) => PieceOwner::Part(id),
            ContactEntity::Agent(id) => return format!("agent {}", id.0),
        };
        owner.name(&self.model.house)
    }
}

/// The pieces of objects with joints, by object and body (`None`: static ones), and their parents.
struct JointedObjectPieces {
    pieces: BTreeMap<(ObjectId, Option<u32>), Vec<u32>>,
    children: BTreeMap<u32, Vec<u32>>,
}

impl JointedObjectPieces {
    fn new(model: &PhysicsModel, entries: &[ColliderMetadata]) -> Self {
        let joints = model.house.joints.iter();
        let jointed: BTreeSet<ObjectId> = joints.map(|joint| joint.object).collect();
        let mut pieces: BTreeMap<_, Vec<u32>> = BTreeMap::new();
        for (number, entry) in entries.iter().enumerate() {
            if let Some(ContactEntity::Part(part)) = entry.contact_entity {
                let object = model.house.parts[part].object;
                if jointed.contains(&object) {
                    let own = pieces.entry((object, entry.body)).or_default();
                    own.push(number as u32);
                }
            }
        }
        let mut children: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (index, plan) in model.bodies.iter().enumerate() {
            if let Some(parent) = parent(model, plan).flatten() {
                children.entry(parent).or_default().push(index as u32);
            }
        }
        Self { pieces, children }
    }

    /// Returns the pieces of an object but those of one of its bodies.
    fn pieces_of_other_bodies(&self, object: ObjectId, body: u32) -> impl Iterator<Item = u32> {
        let all = self.pieces.range((object, None)..=(object, Some(u32::MAX)));
        let others = all.filter(move |((_, owner), _)| *owner != Some(body));
        others.flat_map(|(_, pieces)| pieces.iter().copied())
    }

    /// Returns the pieces of an object that a joint connects with one of its bodies, or the object's static ones.
    fn joined(&self, model: &PhysicsModel, body: u32) -> impl Iterator<Item = u32> {
        let plan = &model.bodies[body as usize];
        let children = self.children.get(&body).into_iter().flatten();
        let joined = parent(model, plan)
            .into_iter()
            .chain(children.map(|child| Some(*child)));
        let pieces = joined.filter_map(|owner| self.pieces.get(&(plan.object, owner)));
        pieces.flatten().copied()
    }
}

/// The parent of a body by a joint: another body, or fixed structure (`Some(None)`); `None` where it has no joint.
#[expect(
    clippy::option_option,
    reason = "hanging on nothing is not hanging on what stands"
)]
fn parent(model: &PhysicsModel, plan: &BodyDefinition) -> Option<Option<u32>> {
    let part = model.house.joints[plan.joint?].parent;
    Some(part.and_then(|part| model.body_of_part[part]))
}
