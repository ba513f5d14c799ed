//! What the leaves of joints pass through.

use super::overlap::depth;
use super::{CLEARANCE_M, Start};
use crate::contact::{Entry, Excluded, Toucher, entry_index};
use crate::model::{BodyPlan, Owner, shapes};
use crate::report::{PassingJoint, StartReport};
use dwell_scene::interrupt;
use dwell_scene::{Mobility, ObjectId};
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;
use std::collections::BTreeSet;

/// How near to a leaf something stands that it passes through, m.
const LEAF_MARGIN_M: f32 = 0.01;

impl Start<'_> {
    /// What the leaves of joints pass through: their own object, and what they overlap where they stand. A robot's links
    /// pass through fewer things: the links they are joined with, and what they are inside of at the start.
    pub(crate) fn passing(&self, report: &mut StartReport) -> Excluded {
        let mut pairs: BTreeSet<(u32, u32)> = BTreeSet::new();
        for (index, plan) in self.model.bodies.iter().enumerate() {
            let Some(joint) = plan.joint else { continue };
            interrupt::check();
            let robot = self.is_robot(plan.object);
            let mut through = BTreeSet::new();
            let place = self.place(index);
            for piece in &plan.pieces {
                let world_from_piece = place * piece.place;
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
                        depth(
                            collider.position(),
                            collider.shape(),
                            &world_from_piece,
                            &*piece.shape,
                            self.owner(entry),
                        )
                        .is_some_and(|overlap| self.counts(&overlap))
                    };
                    let touches = match (robot, same) {
                        (true, true) => within(CLEARANCE_M),
                        (true, false) => !self.is_free(plan) && inside(),
                        (false, true) => true,
                        (false, false) => within(LEAF_MARGIN_M),
                    };
                    if touches {
                        pairs.insert((index as u32, entry as u32));
                        if let Some(owner) = other.toucher.filter(|_| !same) {
                            through.insert(self.toucher_name(owner));
                        }
                    }
                }
            }
            // Its own object's other parts may come near only later.
            for (entry, other) in self.entries.iter().enumerate() {
                if other.body != Some(index as u32)
                    && self.same_object(other, plan)
                    && (!robot || self.are_joined(index, other))
                {
                    pairs.insert((index as u32, entry as u32));
                }
            }
            if !through.is_empty() {
                report.passing.push(PassingJoint {
                    joint,
                    through: through.into_iter().collect(),
                });
            }
        }
        Excluded {
            entries: pairs.into_iter().collect(),
            carriers: Vec::new(),
        }
    }

    /// Whether an object has motors of its own.
    fn is_robot(&self, object: ObjectId) -> bool {
        let mut joints = self.model.house.joints.iter();
        joints.any(|joint| joint.object == object && joint.servo.is_some())
    }

    /// Whether a body's object stands on its own feet.
    fn is_free(&self, plan: &BodyPlan) -> bool {
        self.model.house.objects[plan.object].mobility == Mobility::Movable
    }

    /// Whether a joint joins a body with another one, or with what of its own object never moves.
    fn are_joined(&self, body: usize, other: &Entry) -> bool {
        let parent = |body: usize| {
            let joint = self.model.bodies[body].joint?;
            let part = self.model.house.joints[joint].parent;
            Some(part.and_then(|part| self.model.body_of_part[part]))
        };
        let other_parent = other.body.and_then(|other| parent(other as usize));
        parent(body) == Some(other.body) || other_parent == Some(Some(body as u32))
    }

    fn same_object(&self, entry: &Entry, plan: &BodyPlan) -> bool {
        match entry.toucher {
            Some(Toucher::Part(part)) => self.model.house.parts[part].object == plan.object,
            _ => false,
        }
    }

    fn toucher_name(&self, toucher: Toucher) -> String {
        let owner = match toucher {
            Toucher::Structure(id) => Owner::Structure(id),
            Toucher::Part(id) => Owner::Part(id),
            Toucher::Agent(id) => return format!("agent {}", id.0),
        };
        owner.name(&self.model.house)
    }
}
