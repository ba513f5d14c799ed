//! The efforts that act along joints: motors and hands, damping, friction, stops and linkages.
//!
//! rapier's own motors are solved in turn with the rows that hold joints together, and creep under load. Here the efforts
//! of a whole tree are computed once a physics step, implicitly and together, so that stiff gains stay stable and a robot
//! at rest is held, and are given to rapier as forces. A tree that nothing touches is then put where its joints go: rapier
//! holds joints together after the fact, which costs energy.

use super::Joint;
use super::chain::Chain;
use super::course::{Course, Freedoms};
use super::element::Pull;
use super::place;
use super::project;
use super::tree::Tree;
use crate::engine::Engine;
use crate::laws::{JointLoad, LinkStep, Push, Resistance};
use dwell_scene::JointId;
use glam::Vec3;

/// How far from its course something else may have taken a joint before it is left there: rad or m, and as a share of
/// the way.
const OFF_COURSE: (f64, f64) = (2e-3, 0.1);

/// What joints do in a step, beside the bodies.
pub(crate) struct Drivers<'a> {
    pub(crate) joints: &'a [Joint],
    /// What pulls at each. Shape (joint,).
    pub(crate) pulls: &'a [Option<Pull>],
    /// About where each stands, rad or m: picks the turn of hinges.
    pub(crate) near: &'a dyn Fn(JointId) -> f32,
    /// How laws change what a joint resists with; `None`: no law does.
    pub(crate) resist: Option<&'a Resist<'a>>,
    /// How laws push at the bodies that joints move; `None`: no law does.
    pub(crate) push: Option<&'a Pushing<'a>>,
    pub(crate) dt_s: f32,
}

/// How laws push at a body.
pub(crate) type Pushing<'a> = dyn Fn(LinkStep) -> Push + 'a;

/// Changes what a joint resists with under a load.
pub(crate) type Resist<'a> = dyn Fn(JointId, &JointLoad, &mut Resistance) + 'a;

/// Where one joint goes in a step.
#[derive(Clone, Copy, Debug)]
struct Going {
    /// Its place in the world's joints.
    joint: usize,
    /// Before and after the step, rad or m.
    positions: [f64; 2],
    /// After the step, rad/s or m/s.
    velocity: f64,
}

/// What is expected of a tree in a step.
#[derive(Clone, Debug)]
pub(crate) struct Outlook {
    /// The joints that may move, by their places in the tree.
    free: Vec<usize>,
    /// Where they go if nothing touches them, parents first; nothing for a tree that stands still or whose root moves.
    course: Vec<Going>,
    /// Whether something pressed on the tree, or its root is free.
    loose: bool,
}

/// Gives rapier the efforts of a tree for the next step. `None` for a tree that is asleep or shut.
pub(crate) fn exert(engine: &mut Engine, tree: &Tree, drivers: &Drivers<'_>) -> Option<Outlook> {
    let free: Vec<usize> = (0..tree.joints.len())
        .filter(|k| {
            let child = drivers.joints[tree.joints[*k]].child_handle;
            let body = engine.bodies.get(child);
            body.is_some_and(|body| body.is_dynamic() && !body.is_sleeping())
        })
        .collect();
    if free.is_empty() {
        return None;
    }
    let joints: Vec<&Joint> = free
        .iter()
        .map(|k| &drivers.joints[tree.joints[*k]])
        .collect();
    let (positions, velocities): (Vec<f64>, Vec<f64>) = joints
        .iter()
        .map(|joint| {
            let (position, velocity) = super::read(engine, joint, (drivers.near)(joint.id));
            (f64::from(position), f64::from(velocity))
        })
        .unzip();
    let chain = Chain::of(engine, tree, &free, drivers);
    let freedoms = Freedoms {
        tree,
        free: &free,
        joints: &joints,
        drivers,
    };
    let course = freedoms.course(&chain, &positions, &velocities);
    carry(engine, tree, &joints, &course);
    let loose = course.answer.is_some() || !course.middle.touches.is_empty();
    let going = |(k, place): (usize, &usize)| Going {
        joint: tree.joints[*place],
        positions: [positions[k], course.positions[k]],
        velocity: course.velocities[k],
    };
    let course = if course.moves {
        free.iter().enumerate().map(going).collect()
    } else {
        Vec::new()
    };
    Some(Outlook {
        free,
        course,
        loose,
    })
}

/// Gives every body all that acts on it, the reactions of its joints included: rapier's rows, which are solved in turn and
/// would give way under a long chain, then find nothing left to do.
fn carry(engine: &mut Engine, tree: &Tree, joints: &[&Joint], course: &Course) {
    let (wrenches, root) = course
        .middle
        .wrenches(&course.gained, course.answer.as_ref());
    let handles = joints.iter().map(|joint| joint.child_handle);
    let all = handles
        .zip(wrenches)
        .chain(root.map(|root| (tree.root, root)));
    for (handle, wrench) in all {
        if let Some(body) = engine.bodies.get_mut(handle) {
            body.add_force(wrench.force.as_vec3(), false);
            body.add_torque(wrench.moment.as_vec3(), false);
        }
    }
}

/// Puts a tree that nothing touched in the step where its joints went, and holds one together that something did. Returns
/// whether it was moved.
pub(crate) fn settle(
    engine: &mut Engine,
    tree: &Tree,
    drivers: &Drivers<'_>,
    outlook: &Outlook,
) -> bool {
    let on_course = outlook.course.iter().all(|going| {
        let joint = &drivers.joints[going.joint];
        let [before, after] = going.positions;
        let (position, _) = super::read(engine, joint, after as f32);
        let off = (f64::from(position) - after).abs();
        off <= OFF_COURSE.0 + OFF_COURSE.1 * (after - before).abs() && untouched(engine, joint)
    });
    if on_course && !outlook.loose {
        for going in &outlook.course {
            let joint = &drivers.joints[going.joint];
            place::put(engine, joint, (going.positions[1], going.velocity), false);
        }
        return !outlook.course.is_empty();
    }
    project::project(engine, tree, &outlook.free, drivers);
    true
}

/// Whether a joint's body moves freely and nothing pressed on it in the last step.
fn untouched(engine: &Engine, joint: &Joint) -> bool {
    let Some(body) = engine.bodies.get(joint.child_handle) else {
        return false;
    };
    let pressed = |handle| {
        let mut pairs = engine.narrow_phase.contact_pairs_with(handle);
        pairs.any(|pair| pair.total_impulse_magnitude() > 0.0)
    };
    body.is_dynamic() && !body.is_sleeping() && !body.colliders().iter().any(|c| pressed(*c))
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
