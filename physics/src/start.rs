//! Overlaps at the start: found on the collision pieces, resolved by small moves, or frozen, and reported.

use crate::body::{Body, Hold};
use crate::config::Settings;
use crate::contact::{Entry, Excluded, entry_index};
use crate::convert::from_rapier;
use crate::engine::Engine;
use crate::model::{BodyPlan, Owner, PhysicsModel, shapes};
use crate::report::{FrozenObject, MovedObject, PassingJoint, StartReport};
use dwell_scene::{Aabb, Mobility, ObjectId};
use glam::Vec3;
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;
use std::collections::{BTreeMap, BTreeSet};

/// Gap that a resolved overlap is left with, m.
const CLEARANCE_M: f32 = 5e-4;
/// Pushes that are tried before lifting.
const MOST_PUSHES: usize = 24;
/// Heights that are tried when pushing does not help.
const LIFTS: usize = 10;
/// How near to a leaf something stands that it passes through, m.
const LEAF_MARGIN_M: f32 = 0.01;

/// The deepest overlap of a body somewhere.
#[derive(Clone, Copy, Debug)]
struct Overlap {
    depth_m: f32,
    /// Away from the other thing.
    normal: Vec3,
    other: Owner,
}

/// A thing that stands where it is while others are resolved.
struct Placed {
    body: u32,
    bounds: Aabb,
    place: RapierPose,
}

pub(crate) struct Start<'a> {
    pub(crate) engine: &'a Engine,
    pub(crate) model: &'a PhysicsModel,
    pub(crate) entries: &'a [Entry],
    pub(crate) bodies: &'a [Body],
    pub(crate) settings: &'a Settings,
}

/// Where a body ends up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Resolved {
    pub(crate) place: RapierPose,
    pub(crate) hold: Hold,
}

impl Start<'_> {
    fn place(&self, body: usize) -> RapierPose {
        let handle = self.bodies[body].handle;
        self.engine
            .bodies
            .get(handle)
            .map_or(RapierPose::IDENTITY, |rigid| *rigid.position())
    }

    /// What the leaves of joints pass through: their own object, and what they overlap where they stand. A robot's links
    /// pass through fewer things: the links they are joined with, and what they are inside of at the start.
    pub(crate) fn passing(&self, report: &mut StartReport) -> Excluded {
        let mut pairs: BTreeSet<(u32, u32)> = BTreeSet::new();
        for (index, plan) in self.model.bodies.iter().enumerate() {
            let Some(joint) = plan.joint else { continue };
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
            Some(crate::contact::Toucher::Part(part)) => {
                self.model.house.parts[part].object == plan.object
            }
            _ => false,
        }
    }

    fn toucher_name(&self, toucher: crate::contact::Toucher) -> String {
        let owner = match toucher {
            crate::contact::Toucher::Structure(id) => Owner::Structure(id),
            crate::contact::Toucher::Part(id) => Owner::Part(id),
            crate::contact::Toucher::Agent(id) => return format!("agent {}", id.0),
        };
        owner.name(&self.model.house)
    }

    /// Frees every body from what it overlaps, from the lowest up.
    pub(crate) fn resolve(&self, report: &mut StartReport) -> Vec<Resolved> {
        let mut resolved: Vec<Resolved> = (0..self.bodies.len())
            .map(|body| Resolved {
                place: self.place(body),
                hold: Hold::Free,
            })
            .collect();
        let bounds = |body: usize| self.model.bodies[body].bounds(&resolved[body].place);
        let mut order: Vec<(f32, usize)> = Vec::new();
        let mut placed = Vec::new();
        for (index, plan) in self.model.bodies.iter().enumerate() {
            let bounds = bounds(index);
            if plan.joint.is_some() {
                placed.push(Placed {
                    body: index as u32,
                    bounds,
                    place: resolved[index].place,
                });
            } else {
                order.push((bounds.min.y, index));
            }
        }
        order.sort_by(|a, b| {
            let by_number = || {
                self.model.bodies[a.1]
                    .order()
                    .cmp(&self.model.bodies[b.1].order())
            };
            a.0.total_cmp(&b.0).then_with(by_number)
        });
        let mut moved: BTreeMap<ObjectId, MovedObject> = BTreeMap::new();
        for (_, index) in order {
            let plan = &self.model.bodies[index];
            let start = resolved[index].place;
            let found = self.overlap(plan, &start, &placed);
            if let Some(overlap) = found.filter(|overlap| self.counts(overlap)) {
                report.overlaps += 1;
                if let Some(place) = self.free(plan, start, &placed) {
                    resolved[index].place = place;
                    let entry = moved.entry(plan.object).or_insert(MovedObject {
                        object: plan.object,
                        overlap_m: 0.0,
                        distance_m: 0.0,
                    });
                    entry.overlap_m = entry.overlap_m.max(overlap.depth_m);
                    let distance = (place.translation - start.translation).length();
                    entry.distance_m = entry.distance_m.max(distance);
                } else {
                    resolved[index].hold = Hold::Frozen;
                    report.frozen.push(FrozenObject {
                        object: plan.object,
                        overlap_m: overlap.depth_m,
                        with: overlap.other.name(&self.model.house),
                    });
                }
            }
            placed.push(Placed {
                body: index as u32,
                bounds: plan.bounds(&resolved[index].place),
                place: resolved[index].place,
            });
        }
        report.moved = moved.into_values().collect();
        report.frozen.sort_by_key(|frozen| frozen.object);
        resolved
    }

    fn counts(&self, overlap: &Overlap) -> bool {
        overlap.depth_m > self.settings.config.overlap_tolerance_m
    }

    /// A place near `start` where a body overlaps nothing; `None` when there is none within the bound.
    fn free(&self, plan: &BodyPlan, start: RapierPose, placed: &[Placed]) -> Option<RapierPose> {
        let bound = self.settings.config.max_start_shift_m;
        let clear = |place: &RapierPose| {
            self.overlap(plan, place, placed)
                .is_none_or(|overlap| !self.counts(&overlap))
        };
        let pushed = self.push(plan, start, placed, bound);
        let lifted = || {
            (1..=LIFTS).find_map(|k| {
                let mut place = start;
                place.translation.y += bound * k as f32 / LIFTS as f32;
                clear(&place).then_some(place)
            })
        };
        let place = pushed.or_else(lifted)?;
        from_rapier(&place).is_valid().then_some(place)
    }

    /// Pushes a body out of the deepest overlap again and again.
    fn push(
        &self,
        plan: &BodyPlan,
        start: RapierPose,
        placed: &[Placed],
        bound: f32,
    ) -> Option<RapierPose> {
        let mut place = start;
        for _ in 0..MOST_PUSHES {
            let Some(overlap) = self
                .overlap(plan, &place, placed)
                .filter(|overlap| self.counts(overlap))
            else {
                return Some(place);
            };
            // Never down: what sinks into a thin floor must come back up.
            let n = overlap.normal;
            let direction = if n.y.abs() > 0.5 {
                Vec3::Y
            } else {
                Vec3::new(n.x, n.y.max(0.0), n.z).normalize_or(Vec3::Y)
            };
            place.translation += direction * (overlap.depth_m + CLEARANCE_M);
            if (place.translation - start.translation).length() > bound {
                return None;
            }
        }
        None
    }

    /// The deepest overlap of a body under a pose with static pieces and with bodies that have their place.
    fn overlap(&self, plan: &BodyPlan, place: &RapierPose, placed: &[Placed]) -> Option<Overlap> {
        let mut worst: Option<Overlap> = None;
        let mut add = |overlap: Option<Overlap>| {
            if let Some(overlap) = overlap
                && worst.is_none_or(|worst| overlap.depth_m > worst.depth_m)
            {
                worst = Some(overlap);
            }
        };
        let is_static = |_, collider: &rapier3d::geometry::Collider| {
            self.entries[entry_index(collider)].body.is_none()
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&is_static));
        for piece in &plan.pieces {
            let at = *place * piece.place;
            let bounds = shapes::bounds(&piece.shape, &at);
            let aabb = rapier3d::geometry::Aabb::new(bounds.min, bounds.max);
            let mut near: Vec<_> = queries.intersect_aabb_conservative(aabb).collect();
            near.sort_by_key(|(_, collider)| collider.user_data);
            for (_, collider) in near {
                if !is_static(rapier3d::geometry::ColliderHandle::invalid(), collider) {
                    continue;
                }
                let owner = self.owner(entry_index(collider));
                add(depth(
                    collider.position(),
                    collider.shape(),
                    &at,
                    &*piece.shape,
                    owner,
                ));
            }
            for other in placed {
                // A lid may lie on its own pot, and a robot's trunk is not moved away from its own links.
                let own = self.model.bodies[other.body as usize].object == plan.object;
                if own || !other.bounds.intersects(&bounds) {
                    continue;
                }
                for obstacle in &self.model.bodies[other.body as usize].pieces {
                    let there = other.place * obstacle.place;
                    add(depth(
                        &there,
                        &*obstacle.shape,
                        &at,
                        &*piece.shape,
                        obstacle.owner,
                    ));
                }
            }
        }
        worst
    }

    fn owner(&self, entry: usize) -> Owner {
        match self.entries[entry].toucher {
            Some(crate::contact::Toucher::Structure(id)) => Owner::Structure(id),
            Some(crate::contact::Toucher::Part(id)) => Owner::Part(id),
            _ => Owner::LastBox,
        }
    }
}

fn depth(
    there: &RapierPose,
    obstacle: &dyn rapier3d::geometry::Shape,
    at: &RapierPose,
    piece: &dyn rapier3d::geometry::Shape,
    other: Owner,
) -> Option<Overlap> {
    let contact = query::contact(there, obstacle, at, piece, 0.0)
        .ok()
        .flatten()?;
    (contact.dist < 0.0 && contact.normal1.is_finite()).then_some(Overlap {
        depth_m: -contact.dist,
        normal: contact.normal1,
        other,
    })
}
