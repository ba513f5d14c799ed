//! A tree as numbers: what moves with each joint, and where all of it is for given positions.

use super::exert::Pushing;
use super::frame::Frame;
use super::motion::{Axis, Lump, Motion, Moving};
use super::support::{self, Support};
use super::touch::{self, Touch};
use super::tree::Tree;
use super::{Drivers, Joint};
use crate::engine::Engine;
use crate::laws::{LinkStep, Push};
use dwell_scene::JointKind;
use glam::{DMat3, DQuat, DVec3};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};

/// A body and the joint that moves it.
#[derive(Clone, Copy, Debug)]
struct Link {
    /// The number of the body's plan in the model.
    body: u32,
    kind: JointKind,
    /// In the joint's frame, unit length.
    axis: DVec3,
    /// Which of the free joints moves its parent.
    parent: Option<usize>,
    /// The parent body, where no free joint moves it.
    world_from_parent: Frame,
    parent_from_joint: Frame,
    joint_from_child: Frame,
    /// Mass, and centre and inertia in the body's own frame.
    lump: Lump,
}

/// When within a step a tree is looked at.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct When {
    /// Length of the step, s.
    pub(super) dt_s: f64,
    /// Whether it is its middle, else its beginning.
    pub(super) middle: bool,
}

/// The free joints of a tree, parents first. Shape (freedom,).
#[derive(Clone)]
pub(super) struct Chain<'a> {
    links: Vec<Link>,
    root: Moving,
    root_velocity: DVec3,
    free_root: Option<Lump>,
    supports: Vec<Support>,
    touches: Vec<Touch>,
    /// Whether what it hangs on stands.
    stands: bool,
    gravity: DVec3,
    push: Option<&'a Pushing<'a>>,
}

impl<'a> Chain<'a> {
    /// `free`: which of the tree's joints may move.
    pub(super) fn of(engine: &Engine, tree: &Tree, free: &[usize], drivers: &Drivers<'a>) -> Self {
        let body = |handle| engine.bodies.get(handle);
        let link = |k: &usize| {
            let joint: &Joint = &drivers.joints[tree.joints[*k]];
            let parent = body(joint.parent_handle);
            Link {
                body: joint.child,
                kind: joint.kind,
                axis: joint.axis.as_dvec3().normalize_or(DVec3::Y),
                parent: tree.parents[*k].and_then(|parent| free.iter().position(|f| *f == parent)),
                world_from_parent: parent
                    .map_or(Frame::IDENTITY, |parent| Frame::of(parent.position())),
                parent_from_joint: Frame::of(&joint.parent_from_joint),
                joint_from_child: Frame::of(&joint.child_from_joint).inverse(),
                lump: body(joint.child_handle).map_or_else(Lump::default, Lump::own),
            }
        };
        let root = body(tree.root);
        let evenly = |root: &RigidBody| {
            Moving::evenly(root.center_of_mass().as_dvec3(), root.angvel().as_dvec3())
        };
        let still = |root: &RigidBody| {
            !root.is_dynamic()
                && root.linvel() == glam::Vec3::ZERO
                && root.angvel() == glam::Vec3::ZERO
        };
        let free_root = root.filter(|root| root.is_dynamic()).map(Lump::of);
        let child = |k: &usize| drivers.joints[tree.joints[*k]].child_handle;
        let mut handles: Vec<RigidBodyHandle> = free.iter().map(child).collect();
        if free_root.is_some() {
            handles.push(tree.root);
        }
        let link_of = |k: usize| (k < free.len()).then_some(k);
        let mut supports = Vec::new();
        if free_root.is_some() {
            for (k, handle) in handles.iter().enumerate() {
                supports.extend(support::of_body(engine, *handle, link_of(k), &handles));
            }
        }
        let bodies = handles.iter().enumerate();
        let bodies: Vec<_> = bodies.map(|(k, handle)| (*handle, link_of(k))).collect();
        let touches = touch::of_tree(engine, &bodies, free_root.is_some());
        Self {
            links: free.iter().map(link).collect(),
            root: root.map_or_else(Moving::default, evenly),
            root_velocity: root.map_or(DVec3::ZERO, |root| root.linvel().as_dvec3()),
            free_root,
            supports,
            touches,
            stands: root.is_none_or(still),
            gravity: engine.gravity.as_dvec3(),
            push: drivers.push,
        }
    }

    /// Whether what the tree hangs on stands.
    pub(super) fn stands(&self) -> bool {
        self.stands
    }

    /// The tree with its joints at these positions, rad or m, and velocities. Shape (freedom,) each.
    pub(super) fn at(&self, positions: &[f64], velocities: &[f64], when: When) -> Motion {
        let count = self.links.len();
        let mut frames: Vec<Frame> = Vec::with_capacity(count);
        let mut axes = Vec::with_capacity(count);
        let mut masses = Vec::with_capacity(count);
        let mut angular: Vec<DVec3> = Vec::with_capacity(count);
        for (k, link) in self.links.iter().enumerate() {
            let (parent, carried) = match link.parent {
                Some(parent) => (frames[parent], angular[parent]),
                None => (link.world_from_parent, self.root.angular),
            };
            let world_from_joint = parent.then(&link.parent_from_joint);
            let frame = world_from_joint
                .then(&Frame::along(link.kind, link.axis, positions[k]))
                .then(&link.joint_from_child);
            let direction = world_from_joint.turn * link.axis;
            axes.push(Axis {
                kind: link.kind,
                direction,
                at: world_from_joint.at,
                parent: link.parent,
                velocity: velocities[k],
            });
            let turn = DMat3::from_quat(frame.turn.normalize());
            masses.push(Lump {
                center: frame.at + frame.turn * link.lump.center,
                inertia: turn * link.lump.inertia * turn.transpose(),
                ..link.lump
            });
            angular.push(match link.kind {
                JointKind::Hinge => carried + direction * velocities[k],
                JointKind::Slide => carried,
            });
            frames.push(frame);
        }
        let pushes = match self.push {
            Some(push) => self.pushes(push, (&axes, &masses, &angular), when),
            None => Vec::new(),
        };
        Motion {
            pushes,
            axes,
            masses,
            angular,
            root: self.root,
            free_root: self.free_root,
            root_velocity: self.root_velocity,
            supports: self.supports.clone(),
            touches: self.touches.clone(),
            gravity: self.gravity,
        }
    }
}

impl Chain<'_> {
    /// How laws push at each joint's body. Shape (freedom,).
    fn pushes(
        &self,
        push: &Pushing<'_>,
        (axes, masses, angular): (&[Axis], &[Lump], &[DVec3]),
        when: When,
    ) -> Vec<Push> {
        let mut linear: Vec<DVec3> = Vec::with_capacity(axes.len());
        let mut pushes = Vec::with_capacity(axes.len());
        for (k, axis) in axes.iter().enumerate() {
            let (velocity, spin, from) = match axis.parent {
                Some(parent) => (linear[parent], angular[parent], masses[parent].center),
                None => (self.root_velocity, self.root.angular, self.root.center),
            };
            let center = masses[k].center;
            let (along, _) = axis.moves(center);
            linear.push(velocity + spin.cross(center - from) + along * axis.velocity);
            pushes.push(push(LinkStep {
                body: self.links[k].body,
                mass_kg: masses[k].mass,
                inertia: masses[k].inertia,
                velocity: linear[k],
                spin: angular[k],
                dt_s: when.dt_s,
                middle: when.middle,
                time_s: 0.0,
            }));
        }
        pushes
    }
}

impl Frame {
    const IDENTITY: Self = Self {
        at: DVec3::ZERO,
        turn: DQuat::IDENTITY,
    };

    /// The motion of a joint about or along its axis.
    pub(super) fn along(kind: JointKind, axis: DVec3, position: f64) -> Self {
        match kind {
            JointKind::Hinge => Self {
                at: DVec3::ZERO,
                turn: {
                    let (sin, cos) = libm::sincos(0.5 * position);
                    let part = axis * sin;
                    DQuat::from_xyzw(part.x, part.y, part.z, cos)
                },
            },
            JointKind::Slide => Self {
                at: axis * position,
                turn: DQuat::IDENTITY,
            },
        }
    }
}
