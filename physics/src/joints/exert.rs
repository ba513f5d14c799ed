//! The efforts that act along joints: motors and hands, damping, friction, stops and linkages.
//!
//! rapier's own motors are solved in turn with the rows that hold joints together, and creep under load. Here the efforts
//! of a whole tree are computed once a physics step, implicitly and together, so that stiff gains stay stable and a robot
//! at rest is held, and are given to rapier as forces.

use super::convex::{Element, Problem};
use super::element::{Freedom, Pull};
use super::motion::{Axis, Lump, Motion, Moving};
use super::tree::Tree;
use super::{Joint, element};
use crate::engine::Engine;
use dwell_scene::{JointId, JointKind};
use glam::{DVec3, Vec3};
use rapier3d::dynamics::RigidBody;

/// A way within a step, rad or m, below which a tree counts as standing.
const AT_REST: f64 = 1e-5;

/// What joints do in a step, beside the bodies.
pub(crate) struct Drivers<'a> {
    pub(crate) joints: &'a [Joint],
    /// What pulls at each. Shape (joint,).
    pub(crate) pulls: &'a [Option<Pull>],
    /// About where each stands, rad or m: picks the turn of hinges.
    pub(crate) near: &'a dyn Fn(JointId) -> f32,
    pub(crate) dt_s: f32,
}

/// Gives rapier the efforts of a tree for the next step.
pub(crate) fn exert(engine: &mut Engine, tree: &Tree, drivers: &Drivers<'_>) {
    let free: Vec<usize> = (0..tree.joints.len())
        .filter(|k| {
            let child = drivers.joints[tree.joints[*k]].child_handle;
            let body = engine.bodies.get(child);
            body.is_some_and(|body| body.is_dynamic() && !body.is_sleeping())
        })
        .collect();
    // What swings freely is rapier's alone.
    let acts = |k: &usize| {
        let place = tree.joints[*k];
        let joint = &drivers.joints[place];
        drivers.pulls[place].is_some()
            || joint.values.friction > 0.0
            || joint.values.damping > 0.0
            || joint.values.armature > 0.0
            || joint.own_stop.is_some()
            || tree.follows[*k].is_some()
    };
    if !free.iter().any(acts) {
        return;
    }
    let (motion, positions) = look(engine, tree, &free, drivers);
    let joints: Vec<&Joint> = free
        .iter()
        .map(|k| &drivers.joints[tree.joints[*k]])
        .collect();
    let bodies = Bodies {
        tree,
        free: &free,
        joints: &joints,
        positions: &positions,
    };
    let now: Vec<f64> = motion.axes.iter().map(|axis| axis.velocity).collect();
    let dt_s = f64::from(drivers.dt_s);
    let mut step = bodies.solve(&motion, &now, drivers);
    let mut motion = motion;
    let fastest = now.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if fastest * dt_s > AT_REST && motion.free_root.is_none() {
        // The midpoint rule: what turns fast is where it is for half of the step only.
        motion = motion.later(&step.gained, 0.5 * dt_s);
        step = bodies.solve(&motion, &now, drivers);
        for (axis, (before, gained)) in motion.axes.iter_mut().zip(now.iter().zip(&step.gained)) {
            axis.velocity = before + 0.5 * dt_s * gained;
        }
    }
    let Step { gained, efforts } = step;
    if motion.free_root.is_none() {
        // Every body gets all that acts on it, the reactions of its joints included: rapier's rows, which are solved in
        // turn and would give way under a long chain, then find nothing left to do.
        let wrenches = motion.wrenches(&gained);
        for (joint, (force, torque)) in joints.iter().zip(wrenches) {
            if let Some(body) = engine.bodies.get_mut(joint.child_handle) {
                body.add_force(force.as_vec3(), false);
                body.add_torque(torque.as_vec3(), false);
            }
        }
        return;
    }
    for (k, joint) in joints.iter().enumerate() {
        // What the armature takes is not given to the bodies.
        let effort = efforts[k] - f64::from(joint.values.armature) * gained[k];
        let direction = motion.axes[k].direction.as_vec3();
        apply(engine, joint, direction, effort as f32);
    }
}

/// The free joints of a tree.
struct Bodies<'a> {
    tree: &'a Tree,
    free: &'a [usize],
    joints: &'a [&'a Joint],
    positions: &'a [f64],
}

/// Accelerations of the free joints in a step, and the efforts along them. Shape (freedom,) each.
struct Step {
    gained: Vec<f64>,
    efforts: Vec<f64>,
}

impl Bodies<'_> {
    /// The step that begins with velocities `now`, with inertia and loads as in `motion`.
    fn solve(&self, motion: &Motion, now: &[f64], drivers: &Drivers<'_>) -> Step {
        let dt_s = f64::from(drivers.dt_s);
        let (bias, weights) = motion.bias();
        let mut inertia = motion.inertia();
        for (k, joint) in self.joints.iter().enumerate() {
            inertia.add(k, k, f64::from(joint.values.armature).max(1e-9));
        }
        let freedoms: Vec<Freedom> = (0..self.free.len())
            .map(|k| Freedom {
                index: k,
                position: self.positions[k],
                inertia: inertia.get(k, k),
                weight: weights[k],
                dt_s,
            })
            .collect();
        let falling = inertia.factor().solve(&bias);
        let solution = Problem {
            inertia,
            free: now
                .iter()
                .zip(&falling)
                .map(|(v, a)| v - dt_s * a)
                .collect(),
            elements: self.elements(&freedoms, drivers),
            dt_s,
        }
        .solve();
        let pairs = solution.velocity.iter().zip(now);
        Step {
            gained: pairs
                .map(|(after, before)| (after - before) / dt_s)
                .collect(),
            efforts: solution.efforts,
        }
    }

    /// All that acts along the joints.
    fn elements(&self, freedoms: &[Freedom], drivers: &Drivers<'_>) -> Vec<Element> {
        let mut elements = Vec::with_capacity(2 * freedoms.len());
        for ((joint, freedom), place) in self.joints.iter().zip(freedoms).zip(self.free) {
            if joint.values.damping > 0.0 {
                elements.push(freedom.damping(joint.values.damping.into()));
            }
            if joint.values.friction > 0.0 {
                elements.push(freedom.friction(joint.values.friction.into()));
            }
            if let Some(pull) = &drivers.pulls[self.tree.joints[*place]] {
                elements.push(freedom.pull(pull));
            }
            if let Some([low, high]) = joint.own_stop {
                elements.push(freedom.stop(low.into(), 1.0));
                elements.push(freedom.stop(high.into(), -1.0));
            }
            if let Some((leader, multiplier, offset)) = self.tree.follows[*place]
                && let Some(leader) = self.free.iter().position(|other| *other == leader)
            {
                let leader = &freedoms[leader];
                elements.push(freedom.follow(leader, multiplier.into(), offset.into()));
            }
        }
        elements
    }
}

/// A tree as it moves, and where its free joints stand.
fn look(engine: &Engine, tree: &Tree, free: &[usize], drivers: &Drivers<'_>) -> (Motion, Vec<f64>) {
    let body = |handle| engine.bodies.get(handle);
    let mut positions = Vec::with_capacity(free.len());
    let (mut axes, mut masses, mut angular) = (Vec::new(), Vec::new(), Vec::new());
    for k in free {
        let joint = &drivers.joints[tree.joints[*k]];
        let (direction, at) = super::line(engine, joint);
        let (position, velocity) = super::read(engine, joint, (drivers.near)(joint.id));
        positions.push(f64::from(position));
        axes.push(Axis {
            kind: joint.kind,
            direction: direction.as_dvec3().normalize_or(DVec3::Y),
            at: at.as_dvec3(),
            parent: tree.parents[*k].and_then(|parent| free.iter().position(|f| *f == parent)),
            velocity: velocity.into(),
        });
        let child = body(joint.child_handle);
        masses.push(child.map_or_else(Lump::default, Lump::of));
        angular.push(child.map_or(DVec3::ZERO, |child| child.angvel().as_dvec3()));
    }
    let root = body(tree.root);
    let evenly = |root: &RigidBody| {
        Moving::evenly(root.center_of_mass().as_dvec3(), root.angvel().as_dvec3())
    };
    let motion = Motion {
        axes,
        masses,
        angular,
        root: root.map_or_else(Moving::default, evenly),
        free_root: root.filter(|root| root.is_dynamic()).map(Lump::of),
        gravity: engine.gravity.as_dvec3(),
    };
    (motion, positions)
}

fn apply(engine: &mut Engine, joint: &Joint, axis: Vec3, effort: f32) {
    let Some(at) = engine
        .bodies
        .get(joint.child_handle)
        .map(RigidBody::center_of_mass)
    else {
        return;
    };
    for (handle, share) in [(joint.child_handle, effort), (joint.parent_handle, -effort)] {
        let Some(body) = engine.bodies.get(handle).filter(|body| body.is_dynamic()) else {
            continue;
        };
        let none = body.user_force() == Vec3::ZERO && body.user_torque() == Vec3::ZERO;
        if effort == 0.0 && none {
            continue;
        }
        if let Some(body) = engine.bodies.get_mut(handle) {
            match joint.kind {
                JointKind::Hinge => body.add_torque(axis * share, false),
                JointKind::Slide => body.add_force_at_point(axis * share, at, false),
            }
        }
    }
}

/// Takes the efforts of the last step back, before new ones are given.
pub(crate) fn relax(engine: &mut Engine, joint: &Joint) {
    for handle in [joint.child_handle, joint.parent_handle] {
        let awake = engine.bodies.get(handle).is_some_and(|body| {
            body.is_dynamic()
                && !body.is_sleeping()
                && (body.user_force() != Vec3::ZERO || body.user_torque() != Vec3::ZERO)
        });
        if awake && let Some(body) = engine.bodies.get_mut(handle) {
            body.reset_forces(false);
            body.reset_torques(false);
        }
    }
}

/// The stops of a joint that rapier does not keep.
pub(super) fn own_stop(kind: JointKind, limits: Option<[f32; 2]>) -> Option<[f32; 2]> {
    limits.filter(|limits| !element::rapier_holds(kind, *limits))
}
