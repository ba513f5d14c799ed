//! A tree in numbers: the bodies that each joint moves, and forward kinematics for given positions.

use super::PhysicsJoint;
use super::efforts::LinkWrenchFn;
use super::external_contact::{self, ExternalContact};
use super::frame::RigidTransform;
use super::support::{self, SupportPoint};
use super::tree::KinematicTree;
use super::tree_dynamics::{JointAxisState, LinkMotion, SpatialInertia, TreeDynamics};
use super::{ExternalWrench, LinkState};
use crate::engine::RapierWorld;
use dwell_scene::JointKind;
use glam::{DMat3, DQuat, DVec3};
use rapier3d::dynamics::RigidBodyHandle;

/// A body and the joint that moves it.
#[derive(Clone, Copy, Debug)]
struct ChainLink {
    /// Index of the body's plan in the model.
    body: u32,
    kind: JointKind,
    /// In the joint's frame, unit length.
    axis: DVec3,
    /// The free joint that moves its parent.
    parent: Option<usize>,
    parent_handle: RigidBodyHandle,
    /// The parent body, where no free joint moves it.
    world_from_parent: RigidTransform,
    parent_from_joint: RigidTransform,
    joint_from_child: RigidTransform,
    /// Mass, and centre and inertia in the body's own frame.
    lump: SpatialInertia,
}

/// The wrenches of laws on a tree, and the time of their evaluation within a step.
#[derive(Clone, Copy)]
pub(super) struct LawWrenchEvaluator<'a> {
    pub(super) wrench_fn: &'a LinkWrenchFn<'a>,
    /// Length of the step, s.
    pub(super) dt_s: f64,
    /// Evaluates at the middle of the step, else at its beginning.
    pub(super) at_midpoint: bool,
}

/// The free joints of a tree, parents first. Shape (freedom,).
#[derive(Clone, Debug)]
pub(super) struct FreeJointChain {
    links: Vec<ChainLink>,
    root: LinkMotion,
    root_velocity: DVec3,
    free_root: Option<SpatialInertia>,
    /// Index of a free root's plan in the model.
    root_body: Option<u32>,
    supports: Vec<SupportPoint>,
    touches: Vec<ExternalContact>,
    /// Set if its root is not dynamic and does not move.
    stands: bool,
    gravity: DVec3,
}

impl FreeJointChain {
    /// `free`: the tree's joints that may move.
    pub(super) fn of(
        engine: &RapierWorld,
        tree: &KinematicTree,
        free: &[usize],
        joints: &[PhysicsJoint],
    ) -> Self {
        let body = |handle| engine.bodies.get(handle);
        let link = |k: &usize| {
            let joint = &joints[tree.joints[*k]];
            ChainLink {
                body: joint.child,
                kind: joint.kind,
                axis: joint.unit_axis(),
                parent: tree.parents[*k].and_then(|parent| free.iter().position(|f| *f == parent)),
                parent_handle: joint.parent_handle,
                world_from_parent: RigidTransform::IDENTITY,
                parent_from_joint: RigidTransform::of(&joint.parent_from_joint),
                joint_from_child: RigidTransform::of(&joint.child_from_joint).inverse(),
                lump: body(joint.child_handle)
                    .map_or_else(SpatialInertia::default, SpatialInertia::in_body_frame),
            }
        };
        let mut chain = Self {
            links: free.iter().map(link).collect(),
            root: LinkMotion::default(),
            root_velocity: DVec3::ZERO,
            free_root: None,
            root_body: tree.root_body,
            supports: Vec::new(),
            touches: Vec::new(),
            stands: true,
            gravity: engine.gravity.as_dvec3(),
        };
        chain.read_root_motion(engine, tree);
        chain.find_contacts(engine, tree, free, joints);
        chain
    }

    /// Reads the pose and motion of the root, and of parents that no free joint moves.
    pub(super) fn read_root_motion(&mut self, engine: &RapierWorld, tree: &KinematicTree) {
        for link in self.links.iter_mut().filter(|link| link.parent.is_none()) {
            let parent = engine.bodies.get(link.parent_handle);
            link.world_from_parent = parent.map_or(RigidTransform::IDENTITY, |parent| {
                RigidTransform::of(parent.position())
            });
        }
        let Some(root) = engine.bodies.get(tree.root) else {
            return;
        };
        let center = root.center_of_mass().as_dvec3();
        self.root = LinkMotion::at_constant_velocity(center, root.angvel().as_dvec3());
        self.root_velocity = root.linvel().as_dvec3();
        self.free_root = root.is_dynamic().then(|| SpatialInertia::of(root));
        self.stands = !root.is_dynamic()
            && root.linvel() == glam::Vec3::ZERO
            && root.angvel() == glam::Vec3::ZERO;
    }

    /// Finds the support and contact forces on the tree.
    fn find_contacts(
        &mut self,
        engine: &RapierWorld,
        tree: &KinematicTree,
        free: &[usize],
        joints: &[PhysicsJoint],
    ) {
        let child = |k: &usize| joints[tree.joints[*k]].child_handle;
        let mut handles: Vec<RigidBodyHandle> = free.iter().map(child).collect();
        let floats = self.free_root.is_some();
        if floats {
            handles.push(tree.root);
        }
        let link_of = |k: usize| (k < free.len()).then_some(k);
        if floats {
            for (k, handle) in handles.iter().enumerate() {
                let supports = support::support_points(engine, *handle, link_of(k), &handles);
                self.supports.extend(supports);
            }
        }
        let bodies = handles.iter().enumerate();
        let bodies: Vec<_> = bodies.map(|(k, handle)| (*handle, link_of(k))).collect();
        self.touches = external_contact::tree_contacts(engine, &bodies, floats);
    }

    /// Returns whether the root is not dynamic and at rest.
    pub(super) fn is_root_at_rest(&self) -> bool {
        self.stands
    }

    /// Returns the tree with its joints at these positions, rad or m, and velocities. Shape (freedom,) each. `pushed`:
    /// `None` where no law exerts a wrench.
    pub(super) fn dynamics_at(
        &self,
        positions: &[f64],
        velocities: &[f64],
        pushed: Option<LawWrenchEvaluator<'_>>,
    ) -> TreeDynamics<'_> {
        let count = self.links.len();
        let mut frames: Vec<RigidTransform> = Vec::with_capacity(count);
        let mut axes = Vec::with_capacity(count);
        let mut masses = Vec::with_capacity(count);
        let mut angular: Vec<DVec3> = Vec::with_capacity(count);
        for (k, link) in self.links.iter().enumerate() {
            let (parent, carried) = match link.parent {
                Some(parent) => (frames[parent], angular[parent]),
                None => (link.world_from_parent, self.root.angular),
            };
            let world_from_joint = parent.compose(&link.parent_from_joint);
            let frame = world_from_joint
                .compose(&RigidTransform::joint_displacement(
                    link.kind,
                    link.axis,
                    positions[k],
                ))
                .compose(&link.joint_from_child);
            let direction = world_from_joint.rotation * link.axis;
            axes.push(JointAxisState {
                kind: link.kind,
                direction,
                anchor: world_from_joint.translation,
                parent: link.parent,
                velocity: velocities[k],
            });
            let turn = DMat3::from_quat(frame.rotation.normalize());
            masses.push(SpatialInertia {
                center: frame.translation + frame.rotation * link.lump.center,
                inertia: turn * link.lump.inertia * turn.transpose(),
                ..link.lump
            });
            angular.push(match link.kind {
                JointKind::Hinge => carried + direction * velocities[k],
                JointKind::Slide => carried,
            });
            frames.push(frame);
        }
        let (pushes, root_push) = match &pushed {
            Some(pushed) => (
                self.law_wrenches(pushed, (&axes, &masses, &angular)),
                self.root_law_wrench(pushed),
            ),
            None => (Vec::new(), ExternalWrench::default()),
        };
        TreeDynamics {
            law_wrenches: pushes,
            root_law_wrench: root_push,
            axes,
            masses,
            angular,
            root: self.root,
            free_root: self.free_root,
            root_velocity: self.root_velocity,
            supports: &self.supports,
            external_contacts: &self.touches,
            gravity: self.gravity,
        }
    }
}

impl LawWrenchEvaluator<'_> {
    /// Returns the wrench of laws on a body with this velocity and angular velocity.
    fn at(&self, body: u32, lump: &SpatialInertia, velocity: DVec3, spin: DVec3) -> ExternalWrench {
        (self.wrench_fn)(LinkState {
            body,
            mass_kg: lump.mass,
            inertia: lump.inertia,
            velocity,
            angular_velocity: spin,
            dt_s: self.dt_s,
            is_midpoint: self.at_midpoint,
            time_s: 0.0,
        })
    }
}

impl FreeJointChain {
    /// Returns the wrench of laws on a free root, evaluated at the beginning of the step.
    fn root_law_wrench(&self, pushed: &LawWrenchEvaluator<'_>) -> ExternalWrench {
        let (Some(lump), Some(body)) = (&self.free_root, self.root_body) else {
            return ExternalWrench::default();
        };
        let begins = LawWrenchEvaluator {
            at_midpoint: false,
            ..*pushed
        };
        begins.at(body, lump, self.root_velocity, self.root.angular)
    }

    /// Returns the wrenches of laws on each joint's body. Shape (freedom,).
    fn law_wrenches(
        &self,
        pushed: &LawWrenchEvaluator<'_>,
        (axes, masses, angular): (&[JointAxisState], &[SpatialInertia], &[DVec3]),
    ) -> Vec<ExternalWrench> {
        let mut linear: Vec<DVec3> = Vec::with_capacity(axes.len());
        let mut pushes = Vec::with_capacity(axes.len());
        for (k, axis) in axes.iter().enumerate() {
            let (velocity, spin, from) = match axis.parent {
                Some(parent) => (linear[parent], angular[parent], masses[parent].center),
                None => (self.root_velocity, self.root.angular, self.root.center),
            };
            let center = masses[k].center;
            let (along, _) = axis.unit_velocity_at(center);
            linear.push(velocity + spin.cross(center - from) + along * axis.velocity);
            pushes.push(pushed.at(self.links[k].body, &masses[k], linear[k], angular[k]));
        }
        pushes
    }
}

impl RigidTransform {
    const IDENTITY: Self = Self {
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
    };

    /// The displacement of a joint about or along its axis.
    pub(super) fn joint_displacement(kind: JointKind, axis: DVec3, position: f64) -> Self {
        match kind {
            JointKind::Hinge => Self {
                translation: DVec3::ZERO,
                rotation: {
                    let (sin, cos) = libm::sincos(0.5 * position);
                    let part = axis * sin;
                    DQuat::from_xyzw(part.x, part.y, part.z, cos)
                },
            },
            JointKind::Slide => Self {
                translation: axis * position,
                rotation: DQuat::IDENTITY,
            },
        }
    }
}
