//! Efforts along joints: motors and hands, damping, friction, stops and mimic joints.
//!
//! rapier's own motors are solved in turn with the constraint rows of joints, and creep under load. Here the efforts of a
//! whole tree are computed once a physics step, implicitly and together, so that stiff gains stay stable and a robot at
//! rest is held, and are given to rapier as forces. A tree that nothing touches is then put at its predicted joint
//! positions: rapier closes joints after the fact, which costs energy.

use super::PhysicsJoint;
use super::effort_term::JointActuation;
use super::forward_kinematics;
use super::integration::{REST_DISPLACEMENT, TreeIntegration, TreeSolver};
use super::joint_state::{JointKinematics, JointReading, is_contact_free};
use super::tree::KinematicTree;
use super::tree_step::TreeStep;
use super::{ExternalWrench, JointLoad, JointResistance, LinkState};
use crate::engine::RapierWorld;
use dwell_scene::JointId;
use glam::Vec3;

/// Largest deviation of a joint from its predicted motion up to which it is moved back: rad or m, and as a share of the
/// displacement.
const MAX_DEVIATION: (f64, f64) = (2e-3, 0.1);

/// The actuation of joints in a step, besides the bodies.
pub(crate) struct JointStepInputs<'a> {
    pub(crate) joints: &'a [PhysicsJoint],
    /// The actuation of each joint. Shape (joint,).
    pub(crate) actuations: &'a [Option<JointActuation>],
    /// Each joint's coordinates after the last step. Shape (joint,).
    pub(crate) joint_coordinates: &'a [JointKinematics],
    /// Changes of joint resistance by laws; `None`: no law changes it.
    pub(crate) resistance_fn: Option<&'a ResistanceFn<'a>>,
    /// Wrenches of laws on the bodies that joints move; `None`: no law exerts one.
    pub(crate) wrench_fn: Option<&'a LinkWrenchFn<'a>>,
    pub(crate) dt_s: f32,
}

/// The wrench of laws on a body.
pub(crate) type LinkWrenchFn<'a> = dyn Fn(LinkState) -> ExternalWrench + 'a;

/// Changes a joint's resistance under a load.
pub(crate) type ResistanceFn<'a> = dyn Fn(JointId, &JointLoad, &mut JointResistance) + 'a;

/// The predicted motion of one joint in a step.
#[derive(Clone, Copy, Debug)]
struct PredictedJoint {
    /// Its index among the world's joints.
    joint: usize,
    /// Before and after the step, rad or m.
    positions: [f64; 2],
    /// After the step, rad/s or m/s.
    velocity: f64,
}

/// The predicted motion of a tree in a step.
#[derive(Clone, Debug)]
pub(crate) struct TreePrediction {
    standing: TreeStep,
    /// Its joints' motion if nothing touches them, parents first. Shape (freedom,).
    course: Vec<PredictedJoint>,
    /// Set if any joint moves, over a root at rest.
    moves: bool,
    /// Set if something pressed on the tree, or its root is free.
    loose: bool,
}

/// Gives rapier the efforts of a tree for the next step. Returns `None` for a tree that is asleep or latched.
pub(crate) fn apply_efforts(
    engine: &mut RapierWorld,
    tree: &KinematicTree,
    drivers: &JointStepInputs<'_>,
) -> Option<TreePrediction> {
    let standing = TreeStep::of(engine, tree, drivers.joints, drivers.joint_coordinates)?;
    let (positions, velocities) = (standing.positions(), standing.velocities());
    let joints = standing.joints(tree, drivers.joints);
    let freedoms = TreeSolver {
        tree,
        free: &standing.free,
        joints: &joints,
        drivers,
    };
    let course = freedoms.integrate(&standing.chain, &positions, &velocities);
    apply_body_wrenches(engine, tree, &joints, &course);
    let loose =
        course.base_response.is_some() || !course.midpoint_dynamics.external_contacts.is_empty();
    let going = |(k, place): (usize, &usize)| PredictedJoint {
        joint: tree.joints[*place],
        positions: [positions[k], course.positions[k]],
        velocity: course.velocities[k],
    };
    let moves = course.is_moving;
    let course = standing.free.iter().enumerate().map(going).collect();
    Some(TreePrediction {
        standing,
        course,
        moves,
        loose,
    })
}

/// Applies to every body all forces on it, the reactions of its joints included: rapier's rows, which are solved in turn
/// and would give way under a long chain, then have nothing left to do.
fn apply_body_wrenches(
    engine: &mut RapierWorld,
    tree: &KinematicTree,
    joints: &[&PhysicsJoint],
    course: &TreeIntegration<'_>,
) {
    let (wrenches, root) = course
        .midpoint_dynamics
        .wrenches(&course.mean_accelerations, course.base_response.as_ref());
    let handles = joints.iter().map(|joint| joint.child_handle);
    let all = handles
        .zip(wrenches)
        .chain(root.map(|root| (tree.root, root)));
    for (handle, wrench) in all {
        if let Some(body) = engine.bodies.get_mut(handle) {
            body.add_force(wrench.force.as_vec3(), false);
            body.add_torque(wrench.torque.as_vec3(), false);
        }
    }
}

impl PredictedJoint {
    /// Returns whether a joint that was at `before` came to `now` as predicted. rapier takes a whole step for the impact at
    /// a stop, and may leave the joint short of it.
    fn moved_as_predicted(
        &self,
        engine: &RapierWorld,
        before: &JointReading,
        now: &JointReading,
    ) -> bool {
        let [from, to] = self.positions;
        let way = before.step_displacement(engine, self.velocity);
        let misses = |expected: f64, way: f64| {
            (now.position - expected).abs() > MAX_DEVIATION.0 + MAX_DEVIATION.1 * way.abs()
        };
        !misses(to, to - from) || !misses(from + way, way)
    }
}

/// Puts a tree that nothing touched in the step at its predicted joint positions, and closes the joints of one that was
/// touched; `joint_coordinates` then holds its joints' values. Returns whether it was moved.
pub(crate) fn correct_tree_positions(
    engine: &mut RapierWorld,
    tree: &KinematicTree,
    joints: &[PhysicsJoint],
    outlook: TreePrediction,
    joint_coordinates: &mut [JointKinematics],
) -> bool {
    let TreePrediction {
        mut standing,
        course,
        moves,
        loose,
    } = outlook;
    let before = standing.update_readings(engine, tree, joints);
    for (going, now) in course.iter().zip(&standing.readings) {
        joint_coordinates[going.joint] = now.coordinate();
    }
    let free = |going: &PredictedJoint| is_contact_free(engine, &joints[going.joint]);
    let untouched = || course.iter().all(free);
    let pairs = before.iter().zip(&standing.readings);
    let struck = || {
        let mut ways = pairs
            .clone()
            .map(|(b, now)| b.step_displacement(engine, now.velocity));
        ways.any(|way| way.abs() > REST_DISPLACEMENT) && !untouched()
    };
    if !moves && !loose && !struck() {
        return false;
    }
    if !loose && !engine.has_multiple_solver_calls() && untouched() {
        place_as_predicted(engine, joints, &course, joint_coordinates);
        return true;
    }
    let came_true: Vec<bool> = course
        .iter()
        .zip(pairs)
        .map(|(going, (before, now))| going.moved_as_predicted(engine, before, now))
        .collect();
    if !loose && came_true.iter().all(|came| *came) && untouched() {
        place_as_predicted(engine, joints, &course, joint_coordinates);
        return true;
    }
    if standing.is_at_rest(engine, tree, joints, &before) {
        return false;
    }
    let ends = course.iter().zip(&came_true);
    let ends: Vec<Option<f64>> = ends
        .map(|(going, came)| {
            let [from, to] = going.positions;
            (*came && (to - from).abs() > MAX_DEVIATION.0).then_some(to)
        })
        .collect();
    standing.project(engine, tree, joints, &ends, joint_coordinates);
    true
}

/// Puts the bodies of a tree at its joints' predicted positions.
fn place_as_predicted(
    engine: &mut RapierWorld,
    joints: &[PhysicsJoint],
    course: &[PredictedJoint],
    joint_coordinates: &mut [JointKinematics],
) {
    for going in course {
        let ([_, position], velocity) = (going.positions, going.velocity);
        joint_coordinates[going.joint] = JointKinematics { position, velocity };
        forward_kinematics::place_child(engine, &joints[going.joint], (position, velocity), false);
    }
}

/// Closes the joints of a tree that slept when the step began and was woken in it. Returns whether it was moved.
pub(crate) fn project_woken(
    engine: &mut RapierWorld,
    tree: &KinematicTree,
    joints: &[PhysicsJoint],
    joint_coordinates: &mut [JointKinematics],
) -> bool {
    let Some(standing) = TreeStep::of(engine, tree, joints, joint_coordinates) else {
        return false;
    };
    let ends = vec![None; standing.free.len()];
    standing.project(engine, tree, joints, &ends, joint_coordinates);
    true
}

/// Removes the efforts of the last step, before new ones are applied.
pub(crate) fn clear_efforts(engine: &mut RapierWorld, joint: &PhysicsJoint) {
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
