//! The sleeping-island cache: bodies at rest are fixed until something comes near.
//!
//! rapier keeps, for each pair of near colliders, contact points and solver data: some 1.5 KB a pair, for sleeping bodies
//! too, which is most of a world's memory. A sleeping body needs none of it. So it is made fixed, for which rapier keeps
//! pairs with moving bodies only; its contacts are stored here. Whatever comes within its reach, extrapolated by one step,
//! makes it a free body again before that step, and so on along all contacts: nothing ever collides with it as a fixed
//! body, and a body that rests on it falls when it is taken away.
//!
//! Bodies connected by joints are cached together, and wake together.

use super::RapierWorld;
use super::workspace::Workspace;
use dwell_scene::Contact;
use glam::Vec3;
use rapier3d::dynamics::{IntegrationParameters, RigidBody, RigidBodyHandle, RigidBodyType};
use rapier3d::geometry::{Aabb, Collider, ColliderHandle};
use rapier3d::math::Vector;
use rapier3d::parry::bounding_volume::BoundingVolume;
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Distance below which bodies count as touching, m: more than contacts leave between bodies at rest.
const TOUCH_M: f32 = 2e-3;
/// Look-ahead factor on the displacement in a step at the present velocity: gravity and pushes add to that.
const LOOK_AHEAD: f32 = 1.5;
/// Displacement of a box that rapier notices, m; its margin in units of its length unit.
const BOX_STEP_M: f32 = 1e-3;
const RAPIER_SKIN: f32 = 0.04;

/// A contact of a cached body.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct CachedContact {
    bodies: [RigidBodyHandle; 2],
    contact: Contact,
}

/// The cached bodies and contacts.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct SleepingIslandCache {
    /// Sorted.
    bodies: Vec<RigidBodyHandle>,
    contacts: Vec<CachedContact>,
}

impl SleepingIslandCache {
    fn search_body(&self, body: RigidBodyHandle) -> Result<usize, usize> {
        let key = |body: &RigidBodyHandle| body.into_raw_parts();
        self.bodies.binary_search_by_key(&key(&body), key)
    }

    pub(crate) fn contains(&self, body: RigidBodyHandle) -> bool {
        self.search_body(body).is_ok()
    }

    /// Returns the contacts of cached bodies, among themselves and with fixed ones.
    pub(crate) fn contacts(&self) -> impl Iterator<Item = Contact> {
        self.contacts.iter().map(|kept| kept.contact)
    }

    /// Stores the contacts of bodies to be cached.
    pub(crate) fn store_contacts(
        &mut self,
        contacts: impl Iterator<Item = ([RigidBodyHandle; 2], Contact)>,
    ) {
        let kept = contacts.map(|(bodies, contact)| CachedContact { bodies, contact });
        self.contacts.extend(kept);
    }

    fn add(&mut self, body: RigidBodyHandle) {
        if let Err(place) = self.search_body(body) {
            self.bodies.insert(place, body);
        }
    }

    /// Returns whether it was cached. Its contacts are kept.
    fn remove(&mut self, body: RigidBodyHandle) -> bool {
        let Ok(place) = self.search_body(body) else {
            return false;
        };
        self.bodies.remove(place);
        true
    }

    /// Drops the contacts of bodies that are no longer cached.
    fn forget_contacts(&mut self, of: &BodyIndexSet) {
        if !of.is_empty() {
            let has = |body: &RigidBodyHandle| of.contains(&body.into_raw_parts());
            self.contacts.retain(|kept| !kept.bodies.iter().any(has));
        }
    }
}

/// Bodies, as rapier numbers them.
type BodyIndexSet = BTreeSet<(u32, u32)>;

/// The pending operation for a body that wakes.
enum WakeRequest {
    /// A cached body, and those jointed to it, are freed.
    Free(RigidBodyHandle),
    /// rapier wakes it.
    Wake(RigidBodyHandle),
}

impl RapierWorld {
    /// Returns whether a body is free and sleeps: in rapier, or in the cache.
    pub(crate) fn is_sleeping(&self, body: RigidBodyHandle) -> bool {
        let rigid = self.bodies.get(body);
        self.sleeping_cache.contains(body)
            || rigid.is_some_and(|rigid| rigid.is_dynamic() && rigid.is_sleeping())
    }

    /// Wakes a body, and those jointed to it.
    pub(crate) fn wake(&mut self, body: RigidBodyHandle) {
        self.wake_each([body]);
    }

    fn wake_each(&mut self, bodies: impl IntoIterator<Item = RigidBodyHandle>) {
        let mut woken = BodyIndexSet::new();
        for body in bodies {
            self.free_and_wake(body, &mut woken);
        }
        self.sleeping_cache.forget_contacts(&woken);
    }

    /// Wakes a body, and those jointed to it; adds those that were cached to `woken`, whose contacts are to be dropped.
    fn free_and_wake(&mut self, body: RigidBodyHandle, woken: &mut BodyIndexSet) {
        let mut left = vec![WakeRequest::Wake(body), WakeRequest::Free(body)];
        while let Some(next) = left.pop() {
            let now = match next {
                WakeRequest::Wake(now) => {
                    self.islands.wake_up(&mut self.bodies, now, true);
                    continue;
                }
                WakeRequest::Free(now) => now,
            };
            if !self.sleeping_cache.remove(now) {
                continue;
            }
            woken.insert(now.into_raw_parts());
            if let Some(rigid) = self.bodies.get_mut(now) {
                rigid.set_body_type(RigidBodyType::Dynamic, false);
            }
            // It is woken after those jointed to it.
            if now != body {
                left.push(WakeRequest::Wake(now));
            }
            let attached = self.attached(now).into_iter().rev();
            left.extend(attached.map(WakeRequest::Free));
        }
    }

    /// Wakes all cached bodies.
    pub(crate) fn wake_cached(&mut self) {
        let mut woken = BodyIndexSet::new();
        while let Some(body) = self.sleeping_cache.bodies.last() {
            self.free_and_wake(*body, &mut woken);
        }
        self.sleeping_cache.forget_contacts(&woken);
    }

    /// Returns the bodies that are jointed to a body.
    fn attached(&self, body: RigidBodyHandle) -> Vec<RigidBodyHandle> {
        let joints = self.joints.attached_joints(body);
        joints
            .map(|(one, two, ..)| if one == body { two } else { one })
            .collect()
    }

    /// Wakes a body that is about to be moved, and the cached ones around it.
    pub(crate) fn wake_around(&mut self, body: RigidBodyHandle) {
        self.wake(body);
        self.wake_each(self.cached_within(body, TOUCH_M));
    }

    /// Wakes bodies within reach of anything that moves in the next step, and those in contact with them, and so on.
    /// `kinematic_bodies`: agents, which are kinematic.
    pub(crate) fn wake_bodies_in_reach(
        &mut self,
        kinematic_bodies: impl Iterator<Item = RigidBodyHandle>,
    ) {
        if self.sleeping_cache.bodies.is_empty() {
            return;
        }
        let awake = self.islands.active_bodies();
        let mut movers: Vec<RigidBodyHandle> = awake
            .filter(|body| !self.sleeping_cache.contains(*body))
            .collect();
        movers.extend(kinematic_bodies);
        let mut woken = BodyIndexSet::new();
        while let Some(mover) = movers.pop() {
            let Some(reach_m) = self.reach_m(mover) else {
                continue;
            };
            for near in self.cached_within(mover, reach_m) {
                self.free_and_wake(near, &mut woken);
                movers.push(near);
            }
        }
        self.sleeping_cache.forget_contacts(&woken);
    }

    /// Returns the distance from a body beyond which nothing meets it in the next step, m; `None` for a body that does not move.
    fn reach_m(&self, body: RigidBodyHandle) -> Option<f32> {
        let rigid = self.bodies.get(body)?;
        let dt_s = self.step_s();
        if rigid.is_dynamic() {
            let spin = rigid.angvel().length() * rigid.mass_properties().max_extent();
            let fastest = rigid.linvel().length() + spin + self.gravity.length() * dt_s;
            return Some(TOUCH_M + LOOK_AHEAD * fastest * dt_s);
        }
        if rigid.body_type() != RigidBodyType::KinematicPositionBased {
            return None;
        }
        // An agent at rest disturbs what it overlaps, as after being placed or standing up.
        let goes_m = (rigid.next_position().translation - rigid.position().translation).length();
        Some(if goes_m > 0.0 {
            TOUCH_M + LOOK_AHEAD * goes_m
        } else {
            0.0
        })
    }

    /// Returns the cached bodies of which a piece is nearer than `reach_m` to one of a body's, in order.
    fn cached_within(&self, body: RigidBodyHandle, reach_m: f32) -> Vec<RigidBodyHandle> {
        let Some(rigid) = self.bodies.get(body) else {
            return Vec::new();
        };
        let own: Vec<(&Collider, Aabb)> = rigid
            .colliders()
            .iter()
            .filter_map(|collider| self.colliders.get(*collider))
            .map(|collider| (collider, loosened(&collider.compute_aabb(), reach_m)))
            .collect();
        let Some(around) = own
            .iter()
            .map(|(_, aabb)| *aabb)
            .reduce(|a, b| Aabb::new(a.mins.min(b.mins), a.maxs.max(b.maxs)))
        else {
            return Vec::new();
        };
        let mut near: BTreeMap<(u32, u32), RigidBodyHandle> = BTreeMap::new();
        let queries = self.queries(QueryFilter::default());
        for (_, other) in queries.intersect_aabb_conservative(around) {
            let Some(parent) = other
                .parent()
                .filter(|parent| self.sleeping_cache.contains(*parent))
            else {
                continue;
            };
            if near.contains_key(&parent.into_raw_parts()) || parent == body {
                continue;
            }
            let there = other.compute_aabb();
            let meets = own.iter().any(|(piece, aabb)| {
                aabb.intersects(&there)
                    && query::distance(
                        piece.position(),
                        piece.shape(),
                        other.position(),
                        other.shape(),
                    )
                    .is_ok_and(|gap| gap.distance <= reach_m)
            });
            if meets {
                near.insert(parent.into_raw_parts(), parent);
            }
        }
        near.into_values().collect()
    }

    /// Removes those that touch, or are jointed to, a free body that stays one: rapier wakes it when its contacts change.
    /// They then stay free themselves.
    pub(crate) fn exclude_bodies_touching_free(&self, asleep: &mut Vec<RigidBodyHandle>) {
        let mut sleeping_cache: BodyIndexSet =
            asleep.iter().map(|body| body.into_raw_parts()).collect();
        let stays = |sleeping_cache: &BodyIndexSet, body: &RigidBodyHandle| {
            let rigid = self.bodies.get(*body);
            rigid.is_some_and(RigidBody::is_dynamic)
                && !sleeping_cache.contains(&body.into_raw_parts())
        };
        let touches_one = |body: &&RigidBodyHandle| {
            let mut others = self.touching_or_attached(**body).into_iter();
            others.any(|other| stays(&sleeping_cache, &other))
        };
        let mut left: Vec<RigidBodyHandle> = asleep.iter().filter(touches_one).copied().collect();
        for body in &left {
            sleeping_cache.remove(&body.into_raw_parts());
        }
        while let Some(body) = left.pop() {
            for other in self.touching_or_attached(body) {
                if sleeping_cache.remove(&other.into_raw_parts()) {
                    left.push(other);
                }
            }
        }
        asleep.retain(|body| sleeping_cache.contains(&body.into_raw_parts()));
    }

    /// Returns the bodies in contact with one, and those jointed to it.
    fn touching_or_attached(&self, body: RigidBodyHandle) -> Vec<RigidBodyHandle> {
        let mut others = self.attached(body);
        let Some(rigid) = self.bodies.get(body) else {
            return others;
        };
        let parent = |collider| self.colliders.get(collider).and_then(Collider::parent);
        for pair in self.contact_pairs_of(rigid) {
            if pair.has_any_active_contact() {
                others.extend(
                    [pair.collider1, pair.collider2]
                        .into_iter()
                        .filter_map(parent),
                );
            }
        }
        others
    }

    /// Returns the number of pairs of a body's colliders, touching or near.
    pub(crate) fn pair_count(&self, body: RigidBodyHandle) -> usize {
        let rigid = self.bodies.get(body);
        rigid.map_or(0, |rigid| self.contact_pairs_of(rigid).count())
    }

    /// Releases the memory of pairs that are gone, which rapier keeps for the next ones.
    pub(crate) fn shrink_pair_storage(&mut self) {
        let bytes = postcard::to_stdvec(&self.narrow_phase)
            .expect("rapier's sets are plain data that postcard can always write to memory");
        self.narrow_phase = postcard::from_bytes(&bytes).expect("it was written just now");
        self.broad_phase = self.broad_phase.clone();
        self.islands = self.islands.clone();
        self.workspace = Workspace::new();
    }

    /// Makes sleeping bodies fixed.
    pub(crate) fn cache_bodies(&mut self, bodies: &[RigidBodyHandle]) {
        for body in bodies {
            self.sleeping_cache.add(*body);
            if let Some(rigid) = self.bodies.get_mut(*body) {
                rigid.set_linvel(Vec3::ZERO, false);
                rigid.set_angvel(Vec3::ZERO, false);
                rigid.set_body_type(RigidBodyType::KinematicVelocityBased, false);
            }
        }
    }

    /// Moves the boxes of bodies' colliders in rapier's tree to where they touch nothing, or back. rapier drops a pair when
    /// a box leaves the other, and does not make it again between two fixed bodies.
    pub(crate) fn move_broad_phase_proxies(&mut self, bodies: &[RigidBodyHandle], away: bool) {
        let parameters = IntegrationParameters {
            length_unit: BOX_STEP_M / RAPIER_SKIN,
            ..*self.parameters()
        };
        for body in bodies {
            let colliders = self.bodies.get(*body).map(RigidBody::colliders);
            for collider in colliders.unwrap_or_default() {
                if let Some(aabb) = self.broad_phase_aabb(*collider, away) {
                    self.broad_phase.set_aabb(&parameters, *collider, aabb);
                }
            }
        }
    }

    fn broad_phase_aabb(&self, collider: ColliderHandle, away: bool) -> Option<Aabb> {
        let shape = self.colliders.get(collider)?;
        let aabb = shape.compute_broad_phase_aabb(self.parameters(), &self.bodies);
        if !aabb.mins.is_finite() || !aabb.maxs.is_finite() {
            return None;
        }
        // Each has its own place far below the house, so that they do not make pairs there either.
        let number = collider.into_raw_parts().0 as f32;
        let far = Vector::new(4.0 * number, -1e6, 0.0);
        Some(if away { Aabb::new(far, far) } else { aabb })
    }
}

fn loosened(aabb: &Aabb, by_m: f32) -> Aabb {
    let by = Vector::splat(by_m);
    Aabb::new(aabb.mins - by, aabb.maxs + by)
}
