//! How fast things bounce.
//!
//! rapier gives back a share of the speed that a body had when the step began in which it hits: without what gravity adds on
//! the last bit of the way, half a step's on the mean at every rebound, and with what it added beyond the surface to a body
//! that was stopped there. A body that flew into something leaves it as fast as it met it, times the restitution, at the
//! surface. What hangs on a joint counts as standing: a leaf that gives way takes a part of the rebound.

use super::approach::{Approach, speed_after};
use super::entry::{Entry, Toucher, entry_index};
use super::motion::{Motion, before};
use crate::engine::{Engine, points};
use glam::Vec3;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::geometry::{Collider, ColliderHandle, ContactManifold, ContactPair};
use std::collections::BTreeMap;

/// Sweeps over the points of a step's impacts: a box that lands on a face has four, and each changes the others.
const SWEEPS: usize = 16;
/// Trials of how much of a rebound the energy allows.
const HALVINGS: usize = 8;
/// How much energy rounding may seem to make.
const ROUNDING: f32 = 1e-5;

/// A point in which a body hit something in a step.
struct Hit {
    pair: (Toucher, Toucher),
    /// The first and the second body.
    bodies: [Option<RigidBodyHandle>; 2],
    /// From the second to the first.
    normal: Vec3,
    /// From their centres of mass to where they hit, m: as rapier has them, at the beginning of the step.
    arms: [Vec3; 2],
    /// What moves with 1 m/s after 1 N·s along the normal, kg.
    mass_kg: f32,
    /// How fast the two are to part, m/s.
    parting: f32,
    /// What rapier pushed, N·s.
    pushed: f32,
    /// What has been added, N·s; negative where rapier gave too much.
    added: f32,
}

/// What a body that flew has hit.
struct Landing {
    body: RigidBodyHandle,
    hits: Vec<Hit>,
    /// Its energy before it hit, J; `None` where what it hit may give it some.
    most_j: Option<f32>,
}

/// What the correction of a step knows.
pub(crate) struct Rebounds<'a> {
    /// Before the step.
    pub(crate) motions: &'a [Motion],
    pub(crate) entries: &'a [Entry],
    /// Length of the step, s.
    pub(crate) dt_s: f32,
}

impl Rebounds<'_> {
    /// Corrects how bodies bounce that flew freely into something in the last step. Returns what was added to the pairs' normal
    /// impulses, N·s.
    pub(crate) fn correct(
        &self,
        engine: &mut Engine,
        landed: &[RigidBodyHandle],
    ) -> BTreeMap<(Toucher, Toucher), f32> {
        let mut added = BTreeMap::new();
        for (index, body) in landed.iter().enumerate() {
            // Of two that flew into each other the second one counts the points.
            let Some(mut landing) = self.landing(engine, *body, &landed[index + 1..]) else {
                continue;
            };
            landing.solve(engine);
            for hit in landing.hits {
                *added.entry(hit.pair).or_insert(0.0) += hit.added;
            }
        }
        added
    }

    /// What a body hit, apart from those `later`; `None` where nothing bounces.
    fn landing(
        &self,
        engine: &Engine,
        body: RigidBodyHandle,
        later: &[RigidBodyHandle],
    ) -> Option<Landing> {
        let rigid = engine.bodies.get(body)?;
        let (mut hits, mut stands) = (Vec::new(), true);
        for pair in engine.pairs_of(rigid) {
            let other = [pair.collider1, pair.collider2]
                .into_iter()
                .filter_map(|collider| parent(engine, collider))
                .find(|other| *other != body);
            if other.is_some_and(|other| later.contains(&other)) {
                continue;
            }
            let before = hits.len();
            self.add_hits(engine, pair, &mut hits);
            let moves = other.and_then(|other| engine.bodies.get(other));
            stands &= hits.len() == before || moves.is_none_or(|other| !other.is_moving());
        }
        let before = before(self.motions, Some(body));
        let bounces = hits.iter().any(|hit| hit.parting > 0.0);
        bounces.then(|| Landing {
            body,
            hits,
            most_j: stands.then(|| before.energy_j(rigid.mass())),
        })
    }

    fn add_hits(&self, engine: &Engine, pair: &ContactPair, hits: &mut Vec<Hit>) {
        let toucher = |collider: ColliderHandle| {
            let entry = self
                .entries
                .get(entry_index(engine.colliders.get(collider)?))?;
            entry.toucher
        };
        let (Some(a), Some(b)) = (toucher(pair.collider1), toucher(pair.collider2)) else {
            return;
        };
        let bodies = [pair.collider1, pair.collider2].map(|collider| parent(engine, collider));
        let [one, two] = bodies.map(|body| before(self.motions, body));
        for plane in pair.solver_manifolds() {
            let normal = -plane.data.normal;
            for (contact, point) in points(plane).filter(|(_, point)| point.impulse > 0.0) {
                let approach = Approach::of(plane, contact, &engine.bodies, (&one, &two));
                let yields: f32 = bodies
                    .into_iter()
                    .zip(approach.arms)
                    .filter_map(|(body, arm)| Some(yields(engine, body?, arm.cross(normal))))
                    .sum();
                if yields <= 0.0 {
                    continue;
                }
                hits.push(Hit {
                    pair: (a.min(b), a.max(b)),
                    bodies,
                    arms: approach.arms,
                    normal,
                    mass_kg: yields.recip(),
                    parting: self.parting(
                        engine,
                        plane,
                        &approach,
                        [(bodies[0], &one), (bodies[1], &two)],
                    ),
                    pushed: point.impulse,
                    added: 0.0,
                });
            }
        }
    }

    /// How fast two surfaces part where they stand after the step, m/s; 0 for those that had not been apart.
    fn parting(
        &self,
        engine: &Engine,
        plane: &ContactManifold,
        approach: &Approach,
        bodies: [(Option<RigidBodyHandle>, &Motion); 2],
    ) -> f32 {
        let restitution = plane.data.restitution;
        if restitution <= 0.0 || approach.speed <= 0.0 || approach.meets_s < -self.dt_s {
            return 0.0;
        }
        let normal = plane.data.normal;
        let pull = (bodies[0].1.gravity - bodies[1].1.gravity).dot(normal);
        // What gravity takes on the way from where they met, however far rapier let them go on.
        let [one, two] = bodies.map(|(body, motion)| {
            body.and_then(|body| engine.bodies.get(body))
                .filter(|_| motion.awake)
                .map_or(Vec3::ZERO, |body| {
                    body.center_of_mass() - motion.center_after(approach.meets_s)
                })
        });
        let way_m = (one - two).dot(normal);
        speed_after(restitution * approach.meeting, pull, way_m)
    }
}

impl Landing {
    /// Lets the body bounce. The restitution of several points that hit together, with friction between, may ask for more
    /// energy than there was (Kane's paradox): then they part more slowly, all by the same share.
    ///
    /// # Source
    /// T. R. Kane, D. A. Levinson, Dynamics: Theory and Applications (1985), on collisions with friction under Newton's law of
    /// restitution.
    fn solve(&mut self, engine: &mut Engine) {
        let Some(rigid) = engine.bodies.get(self.body) else {
            return;
        };
        let (linear, angular) = (rigid.linvel(), rigid.angvel());
        self.part(engine, 1.0);
        let Some(most_j) = self.most_j else {
            return;
        };
        if self.energy_j(engine) <= most_j * (1.0 + ROUNDING) {
            return;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for trial in 0..=HALVINGS {
            if let Some(rigid) = engine.bodies.get_mut(self.body) {
                rigid.set_linvel(linear, false);
                rigid.set_angvel(angular, false);
            }
            for hit in &mut self.hits {
                hit.added = 0.0;
            }
            // The last one is one that is known to be within.
            let share = if trial == HALVINGS {
                low
            } else {
                0.5 * (low + high)
            };
            self.part(engine, share);
            if self.energy_j(engine) <= most_j {
                low = share;
            } else {
                high = share;
            }
        }
    }

    /// Sweeps over the points until they part with a share of their speeds.
    fn part(&mut self, engine: &mut Engine, share: f32) {
        for _ in 0..SWEEPS {
            for hit in &mut self.hits {
                hit.solve(engine, share);
            }
        }
    }

    fn energy_j(&self, engine: &Engine) -> f32 {
        engine.bodies.get(self.body).map_or(0.0, |rigid| {
            let falls = engine.gravity * rigid.gravity_scale();
            rigid.kinetic_energy() - rigid.mass() * falls.dot(rigid.center_of_mass())
        })
    }
}

impl Hit {
    /// Gives the two bodies a share of the speed at which they are to part.
    fn solve(&mut self, engine: &mut Engine, share: f32) {
        let velocity = |side: usize| {
            let body = self.bodies[side].and_then(|body| engine.bodies.get(body));
            body.map_or(Vec3::ZERO, |body| {
                body.linvel() + body.angvel().cross(self.arms[side])
            })
        };
        let (one, two) = (velocity(0), velocity(1));
        let lacks = self.parting * share - (one - two).dot(self.normal);
        // A point that does not bounce is kept from sinking in, and not held.
        let least = if self.parting > 0.0 {
            -self.pushed
        } else {
            0.0
        };
        let added = (self.added + self.mass_kg * lacks).max(least);
        let push = self.normal * (added - self.added);
        self.added = added;
        for (side, push) in [push, -push].into_iter().enumerate() {
            if let Some(body) = self.bodies[side].filter(|body| moves(engine, *body))
                && let Some(body) = engine.bodies.get_mut(body)
            {
                body.apply_impulse(push, false);
                body.apply_torque_impulse(self.arms[side].cross(push), false);
            }
        }
    }
}

fn parent(engine: &Engine, collider: ColliderHandle) -> Option<RigidBodyHandle> {
    engine.colliders.get(collider).and_then(Collider::parent)
}

/// Whether a push moves a body: not what stands, sleeps, is led or hangs on joints.
fn moves(engine: &Engine, body: RigidBodyHandle) -> bool {
    let loose = engine.joints.attached_joints(body).next().is_none();
    let rigid = engine.bodies.get(body);
    loose && rigid.is_some_and(|rigid| rigid.is_dynamic() && !rigid.is_sleeping())
}

/// How fast a point of a body goes along a direction after 1 N·s along it, m/s. `turn`: of the arm to the point with the
/// direction.
fn yields(engine: &Engine, body: RigidBodyHandle, turn: Vec3) -> f32 {
    let Some(rigid) = engine.bodies.get(body).filter(|_| moves(engine, body)) else {
        return 0.0;
    };
    let properties = rigid.mass_properties();
    properties.effective_inv_mass.x + turn.dot(properties.effective_world_inv_inertia * turn)
}
