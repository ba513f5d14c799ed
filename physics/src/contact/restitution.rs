//! Restitution of impacts.
//!
//! rapier gives back a share of the speed that a body had when the step began in which it hits: without what gravity adds on
//! the last bit of the way, half a step's on the mean at every rebound, and with what it added beyond the surface to a body
//! that was stopped there. A body that flew into something leaves it as fast as it met it, times the restitution, at the
//! surface. What hangs on joints gives way as its joints do, and takes its part of the blow: it is looked at after its tree was
//! put together again.
//!
//! # Source
//! Newton's law of restitution, `v' = -e v` along the normal. B. Mirtich, J. Canny, Impulse-based simulation of rigid bodies (1995):
//! how a point answers an impulse. E. Catto, Fast and simple physics using sequential impulses (GDC 2006): sweeps over the points,
//! each of which keeps the sum of its impulses within its bounds.

use super::approach::{ApproachMotion, speed_after};
use super::body_motion::{BodyMotion, motion_before};
use super::collider_entry::{ColliderMetadata, ContactEntity, entry_index};
use crate::engine::{RapierWorld, points};
use crate::joints::{ImpulseDynamics, ImpulsePoint, JointKinematics, KinematicTree, PhysicsJoint};
use glam::Vec3;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::geometry::{Collider, ColliderHandle, ContactManifold, ContactPair};
use std::collections::BTreeMap;

/// Sweeps over the points of a step's impacts: a box that lands on a face has four, and each changes the others.
const SWEEPS: usize = 16;
/// Bisection steps for the share of a rebound that the energy allows.
const HALVINGS: usize = 8;
/// Relative energy gain that rounding can feign.
const ROUNDING: f32 = 1e-5;

/// A point at which a body hit something in a step.
struct ImpactPoint {
    pair: (ContactEntity, ContactEntity),
    /// The first and the second body.
    sides: [ImpactSide; 2],
    /// Effective mass: 1 N·s along the normal changes the relative velocity by its inverse, kg.
    mass_kg: f32,
    /// Required separation speed, m/s.
    parting: f32,
    /// Normal impulse applied by rapier, N·s.
    pushed: f32,
    /// Added normal impulse, N·s; negative where rapier applied too much.
    added: f32,
}

/// One of two bodies at an impact point.
struct ImpactSide {
    body: Option<RigidBodyHandle>,
    /// From its centre of mass to the point, m: as rapier has it, at the beginning of the step.
    arm: Vec3,
    /// The direction of the impulse on it.
    way: Vec3,
    /// The point on its kinematic tree, if joints move it.
    joined: Option<TreeImpactPoint>,
}

/// An impact point on a kinematic tree.
struct TreeImpactPoint {
    /// Index among the trees of the impact.
    tree: usize,
    point: ImpulsePoint,
    /// The point at which rapier applied its impulse.
    pushed_at: ImpulsePoint,
}

/// The corrections made in a step.
pub(crate) struct RestitutionResult {
    /// Impulses added to the pairs' normal impulses, N·s.
    pub(crate) added_impulses: BTreeMap<(ContactEntity, ContactEntity), f32>,
    /// Set if bodies of trees were placed again.
    pub(crate) moved_trees: bool,
}

/// The impacts of a body in free flight.
struct FreeFlightImpact {
    body: RigidBodyHandle,
    hits: Vec<ImpactPoint>,
    /// Its energy before the impact, J; `None` where the other body may transfer energy to it.
    max_energy_j: Option<f32>,
}

/// The inputs of a step's correction.
pub(crate) struct RestitutionContext<'a> {
    /// Before the step.
    pub(crate) motions: &'a [BodyMotion],
    pub(crate) entries: &'a [ColliderMetadata],
    pub(crate) trees: &'a [KinematicTree],
    pub(crate) joints: &'a [PhysicsJoint],
    /// Each joint's coordinates before the step.
    pub(crate) joints_before: &'a [JointKinematics],
    /// Length of the step, s.
    pub(crate) dt_s: f32,
}

impl RestitutionContext<'_> {
    /// Corrects the rebounds of bodies that hit something in free flight in the last step. `joint_coordinates`: the
    /// coordinates of each of the world's joints.
    pub(crate) fn correct(
        &self,
        engine: &mut RapierWorld,
        landed: &[RigidBodyHandle],
        joint_coordinates: &mut [JointKinematics],
    ) -> RestitutionResult {
        let mut added = BTreeMap::new();
        let mut struck: Vec<ImpulseDynamics> = Vec::new();
        for (index, body) in landed.iter().enumerate() {
            // For two bodies in free flight that hit each other, the second one counts the points.
            let later = &landed[index + 1..];
            let Some(mut landing) =
                self.collect_impacts(engine, *body, later, (&mut struck, joint_coordinates))
            else {
                continue;
            };
            landing.solve(engine, &mut struck);
            for hit in landing.hits {
                *added.entry(hit.pair).or_insert(0.0) += hit.added;
            }
        }
        let mut placed = false;
        for tree in struck {
            placed |= tree.write_velocities(engine, self.trees, self.joints, joint_coordinates);
        }
        RestitutionResult {
            added_impulses: added,
            moved_trees: placed,
        }
    }

    /// Returns the impacts of a body, apart from those with `later`; `None` where nothing bounces.
    fn collect_impacts(
        &self,
        engine: &RapierWorld,
        body: RigidBodyHandle,
        later: &[RigidBodyHandle],
        (struck, joint_coordinates): (&mut Vec<ImpulseDynamics>, &[JointKinematics]),
    ) -> Option<FreeFlightImpact> {
        let rigid = engine.bodies.get(body)?;
        let (mut hits, mut stands) = (Vec::new(), true);
        for pair in engine.contact_pairs_of(rigid) {
            let other = [pair.collider1, pair.collider2]
                .into_iter()
                .filter_map(|collider| parent(engine, collider))
                .find(|other| *other != body);
            if other.is_some_and(|other| later.contains(&other)) {
                continue;
            }
            let before = hits.len();
            self.add_hits(engine, pair, (&mut *struck, joint_coordinates), &mut hits);
            let moves = other.and_then(|other| engine.bodies.get(other));
            stands &= hits.len() == before || moves.is_none_or(|other| !other.is_moving());
        }
        let before = motion_before(self.motions, Some(body));
        let bounces = hits.iter().any(|hit| hit.parting > 0.0);
        bounces.then(|| FreeFlightImpact {
            body,
            hits,
            max_energy_j: stands.then(|| before.energy_j(rigid.mass())),
        })
    }

    fn add_hits(
        &self,
        engine: &RapierWorld,
        pair: &ContactPair,
        (struck, joint_coordinates): (&mut Vec<ImpulseDynamics>, &[JointKinematics]),
        hits: &mut Vec<ImpactPoint>,
    ) {
        let contact_entity = |collider: ColliderHandle| {
            let entry = self
                .entries
                .get(entry_index(engine.colliders.get(collider)?))?;
            entry.contact_entity
        };
        let (Some(a), Some(b)) = (
            contact_entity(pair.collider1),
            contact_entity(pair.collider2),
        ) else {
            return;
        };
        let bodies = [pair.collider1, pair.collider2].map(|collider| parent(engine, collider));
        let [one, two] = bodies.map(|body| motion_before(self.motions, body));
        for plane in pair.solver_manifolds() {
            let normal = -plane.data.normal;
            for (contact, point) in points(plane).filter(|(_, point)| point.impulse > 0.0) {
                let approach = ApproachMotion::of(plane, contact, &engine.bodies, (&one, &two));
                let meets_s = approach.time_of_impact_s.clamp(0.0, self.dt_s);
                let sides = [(0, &two), (1, &one)].map(|(side, other)| {
                    let way = if side == 0 { normal } else { -normal };
                    // Position of the other one when they meet; rapier applied its impulse at its position when the step began.
                    let ahead = other.center_after(meets_s) - other.center;
                    let joined = bodies[side].and_then(|body| {
                        let tree =
                            self.find_or_add_tree(engine, body, (&mut *struck, joint_coordinates))?;
                        let tree_of = &mut struck[tree];
                        let [point, pushed_at] = [ahead, Vec3::ZERO]
                            .map(|ahead| tree_of.point(body, approach.midpoint + ahead, way));
                        Some(TreeImpactPoint {
                            tree,
                            point: point?,
                            pushed_at: pushed_at?,
                        })
                    });
                    ImpactSide {
                        body: bodies[side],
                        arm: approach.lever_arms[side],
                        way,
                        joined,
                    }
                });
                let yields: f32 = sides
                    .iter()
                    .map(|side| side.inverse_effective_mass(engine))
                    .sum();
                if yields <= 0.0 {
                    continue;
                }
                hits.push(ImpactPoint {
                    pair: (a.min(b), a.max(b)),
                    sides,
                    // 1/m_eff is the sum of both sides'.
                    mass_kg: yields.recip(),
                    parting: self.target_separation_speed(
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

    /// Returns the index of a body's tree among those of the impact; `None` for a body without a joint.
    fn find_or_add_tree(
        &self,
        engine: &RapierWorld,
        body: RigidBodyHandle,
        (struck, joint_coordinates): (&mut Vec<ImpulseDynamics>, &[JointKinematics]),
    ) -> Option<usize> {
        engine.joints.attached_joints(body).next()?;
        let tree = ImpulseDynamics::tree_of(self.trees, self.joints, body)?;
        let known = struck.iter().position(|known| known.tree() == tree);
        known.or_else(|| {
            let found = ImpulseDynamics::of(
                engine,
                (self.trees, tree),
                self.joints,
                (self.joints_before, joint_coordinates),
            )?;
            struck.push(found);
            Some(struck.len() - 1)
        })
    }

    /// Returns the separation speed of two surfaces after the step, m/s; 0 for those that were in contact before.
    fn target_separation_speed(
        &self,
        engine: &RapierWorld,
        plane: &ContactManifold,
        approach: &ApproachMotion,
        bodies: [(Option<RigidBodyHandle>, &BodyMotion); 2],
    ) -> f32 {
        let restitution = plane.data.restitution;
        if restitution <= 0.0
            || approach.approach_speed_m_s <= 0.0
            || approach.time_of_impact_s < -self.dt_s
        {
            return 0.0;
        }
        let normal = plane.data.normal;
        let pull = (bodies[0].1.gravity - bodies[1].1.gravity).dot(normal);
        // The velocity that gravity adds since they met, however far rapier moved them after that.
        let [one, two] = bodies.map(|(body, motion)| {
            body.and_then(|body| engine.bodies.get(body))
                .filter(|_| motion.is_recorded)
                .map_or(Vec3::ZERO, |body| {
                    body.center_of_mass() - motion.center_after(approach.time_of_impact_s)
                })
        });
        let way_m = (one - two).dot(normal);
        // e times the speed at which they met, and what gravity made of it since.
        speed_after(restitution * approach.impact_speed_m_s, pull, way_m)
    }
}

impl FreeFlightImpact {
    /// Applies the rebound. The restitution of several points that hit together, with friction between, may need more
    /// energy than there was (Kane's paradox): then all part more slowly, by the same share.
    ///
    /// # Source
    /// T. R. Kane, D. A. Levinson, Dynamics: Theory and Applications (1985), on collisions with friction under Newton's law of
    /// restitution.
    fn solve(&mut self, engine: &mut RapierWorld, struck: &mut [ImpulseDynamics]) {
        let Some(rigid) = engine.bodies.get(self.body) else {
            return;
        };
        let (linear, angular) = (rigid.linvel(), rigid.angvel());
        self.move_tree_impulses(struck);
        let trees: Vec<Vec<f64>> = struck.iter().map(ImpulseDynamics::velocities).collect();
        self.apply_sequential_impulses(engine, struck, 1.0);
        let Some(max_energy_j) = self.max_energy_j else {
            return;
        };
        if self.energy_j(engine) <= max_energy_j * (1.0 + ROUNDING) {
            return;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for trial in 0..=HALVINGS {
            if let Some(rigid) = engine.bodies.get_mut(self.body) {
                rigid.set_linvel(linear, false);
                rigid.set_angvel(angular, false);
            }
            for (tree, before) in struck.iter_mut().zip(&trees) {
                tree.restore_velocities(before);
            }
            for hit in &mut self.hits {
                hit.added = 0.0;
            }
            // The last share is known to be within the bound.
            let share = if trial == HALVINGS {
                low
            } else {
                0.5 * (low + high)
            };
            self.apply_sequential_impulses(engine, struck, share);
            if self.energy_j(engine) <= max_energy_j {
                low = share;
            } else {
                high = share;
            }
        }
    }

    /// Moves rapier's impulses on trees to the impact points.
    fn move_tree_impulses(&self, struck: &mut [ImpulseDynamics]) {
        for hit in self.hits.iter().filter(|hit| hit.parting > 0.0) {
            for joined in hit.sides.iter().filter_map(|side| side.joined.as_ref()) {
                let pushed = f64::from(hit.pushed);
                struck[joined.tree].apply_impulse(&joined.point, pushed);
                struck[joined.tree].apply_impulse(&joined.pushed_at, -pushed);
            }
        }
    }

    /// Iterates over the points until they part with a share of their speeds.
    fn apply_sequential_impulses(
        &mut self,
        engine: &mut RapierWorld,
        struck: &mut [ImpulseDynamics],
        share: f32,
    ) {
        for _ in 0..SWEEPS {
            for hit in &mut self.hits {
                hit.solve(engine, struck, share);
            }
        }
    }

    fn energy_j(&self, engine: &RapierWorld) -> f32 {
        engine.bodies.get(self.body).map_or(0.0, |rigid| {
            let falls = engine.gravity * rigid.gravity_scale();
            rigid.kinetic_energy() - rigid.mass() * falls.dot(rigid.center_of_mass())
        })
    }
}

impl ImpactPoint {
    /// Gives the two bodies a share of their required separation speed.
    fn solve(&mut self, engine: &mut RapierWorld, struck: &mut [ImpulseDynamics], share: f32) {
        let [one, two] = [0, 1].map(|side: usize| self.sides[side].speed(engine, struck));
        let lacks = self.parting * share - (one + two);
        // A point that does not bounce is kept from penetrating, and not held.
        let least = if self.parting > 0.0 {
            -self.pushed
        } else {
            0.0
        };
        // dP = m_eff (wanted - found), and the sum of all dP within its bound.
        let added = (self.added + self.mass_kg * lacks).max(least);
        let push = added - self.added;
        self.added = added;
        for side in &self.sides {
            side.push(engine, struck, push);
        }
    }
}

impl ImpactSide {
    /// Returns its speed in its direction, m/s.
    fn speed(&self, engine: &RapierWorld, struck: &[ImpulseDynamics]) -> f32 {
        if let Some(joined) = &self.joined {
            return struck[joined.tree].point_speed(&joined.point) as f32;
        }
        let body = self.body.and_then(|body| engine.bodies.get(body));
        body.map_or(0.0, |body| {
            (body.linvel() + body.angvel().cross(self.arm)).dot(self.way)
        })
    }

    /// Returns its inverse effective mass: its speed after 1 N·s in its direction, m/s.
    fn inverse_effective_mass(&self, engine: &RapierWorld) -> f32 {
        match (&self.joined, self.body) {
            (Some(joined), _) => joined.point.inverse_effective_mass() as f32,
            (None, Some(body)) => inverse_effective_mass(engine, body, self.arm.cross(self.way)),
            (None, None) => 0.0,
        }
    }

    /// Applies an impulse in its direction, N·s.
    fn push(&self, engine: &mut RapierWorld, struck: &mut [ImpulseDynamics], impulse: f32) {
        if let Some(joined) = &self.joined {
            struck[joined.tree].apply_impulse(&joined.point, impulse.into());
        } else if let Some(body) = self.body.filter(|body| is_impulse_movable(engine, *body))
            && let Some(body) = engine.bodies.get_mut(body)
        {
            let push = self.way * impulse;
            body.apply_impulse(push, false);
            body.apply_torque_impulse(self.arm.cross(push), false);
        }
    }
}

fn parent(engine: &RapierWorld, collider: ColliderHandle) -> Option<RigidBodyHandle> {
    engine.colliders.get(collider).and_then(Collider::parent)
}

/// Returns whether an impulse moves a body: no fixed, sleeping, kinematic or jointed one.
fn is_impulse_movable(engine: &RapierWorld, body: RigidBodyHandle) -> bool {
    let loose = engine.joints.attached_joints(body).next().is_none();
    let rigid = engine.bodies.get(body);
    loose && rigid.is_some_and(|rigid| rigid.is_dynamic() && !rigid.is_sleeping())
}

/// Returns the speed of a body's point along a direction after 1 N·s along it, m/s. `turn`: cross product of the arm to the
/// point with the direction.
fn inverse_effective_mass(engine: &RapierWorld, body: RigidBodyHandle, turn: Vec3) -> f32 {
    let Some(rigid) = engine
        .bodies
        .get(body)
        .filter(|_| is_impulse_movable(engine, body))
    else {
        return 0.0;
    };
    let properties = rigid.mass_properties();
    // 1/m + (r x n)^T I^-1 (r x n).
    properties.effective_inv_mass.x + turn.dot(properties.effective_world_inv_inertia * turn)
}
