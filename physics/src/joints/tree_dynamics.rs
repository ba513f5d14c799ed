//! Dynamics of a kinematic tree: joint-space inertia, and the efforts of gravity and rotation.
//!
//! The equation of motion is `H q'' + C = tau`: the joint-space inertia matrix H, the bias C of gravity and of velocities, and the
//! efforts tau along the joints. In the comments, S is the motion of a joint's body for each unit of its velocity, lambda a body's
//! parent, I its inertia, and I^c that of it and all beyond it as one body.
//!
//! # Source
//! R. Featherstone, Rigid Body Dynamics Algorithms (2008): the composite-rigid-body algorithm (section 6.2, table 6.2) for H, and
//! the recursive Newton-Euler algorithm (section 5.3, table 5.1) for C, written here in world coordinates about centres of mass.

use super::ExternalWrench;
use super::base_contacts::BaseResponse;
use super::convex_solver::SymmetricMatrix;
use super::external_contact::ExternalContact;
use super::floating_base::FloatingBase;
use super::support::{self, SupportPoint};
use dwell_scene::JointKind;
use glam::{DMat3, DVec3};
use rapier3d::dynamics::RigidBody;

/// The mass properties of a body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SpatialInertia {
    /// kg.
    pub(super) mass: f64,
    /// Mass that gravity acts on, kg: less under water.
    pub(super) weight_mass: f64,
    /// Centre of mass, m.
    pub(super) center: DVec3,
    /// About the centre of mass, world axes, kg·m².
    pub(super) inertia: DMat3,
}

impl SpatialInertia {
    pub(super) fn of(body: &RigidBody) -> Self {
        let own = Self::in_body_frame(body);
        let turn = DMat3::from_quat(body.position().rotation.as_dquat().normalize());
        Self {
            center: body.center_of_mass().as_dvec3(),
            inertia: turn * own.inertia * turn.transpose(),
            ..own
        }
    }

    /// Returns the same in the body's own frame.
    pub(super) fn in_body_frame(body: &RigidBody) -> Self {
        let local = &body.mass_properties().local_mprops;
        let principal = local.principal_inertia().as_dvec3();
        let turn = local.principal_inertia_local_frame.as_dquat();
        let turn = DMat3::from_quat(turn.normalize());
        Self {
            mass: body.mass().into(),
            weight_mass: f64::from(body.mass() * body.gravity_scale()),
            center: local.local_com.as_dvec3(),
            inertia: turn * DMat3::from_diagonal(principal) * turn.transpose(),
        }
    }

    /// Returns two bodies as one.
    pub(super) fn combined_with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return *self;
        }
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        Self {
            mass,
            weight_mass: self.weight_mass + other.weight_mass,
            center,
            inertia: self.inertia_about(center) + other.inertia_about(center),
        }
    }

    /// The inertia about another point (Steiner): `I_p = I_c + m (|d|^2 1 - d d^T)`.
    fn inertia_about(&self, point: DVec3) -> DMat3 {
        let d = self.center - point;
        let outer = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        self.inertia + (DMat3::from_diagonal(DVec3::splat(d.length_squared())) - outer) * self.mass
    }
}

/// The axis of one degree of freedom in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointAxisState {
    pub(super) kind: JointKind,
    pub(super) direction: DVec3,
    /// A point on it, m.
    pub(super) anchor: DVec3,
    /// The free joint that moves its parent.
    pub(super) parent: Option<usize>,
    pub(super) velocity: f64,
}

impl JointAxisState {
    /// Returns the velocity of a point, and the angular velocity, for each unit of this joint's velocity.
    pub(super) fn unit_velocity_at(&self, point: DVec3) -> (DVec3, DVec3) {
        // S at the point: (z x r, z) about an axis z, (z, 0) along one.
        match self.kind {
            JointKind::Hinge => (self.direction.cross(point - self.anchor), self.direction),
            JointKind::Slide => (self.direction, DVec3::ZERO),
        }
    }

    /// Returns the generalized force of a wrench about the origin: its component along the joint.
    pub(super) fn generalized_force_of(&self, wrench: &Wrench) -> f64 {
        let Wrench {
            force,
            torque: moment,
        } = *wrench;
        // S^T f.
        match self.kind {
            JointKind::Hinge => self.direction.dot(moment - self.anchor.cross(force)),
            JointKind::Slide => self.direction.dot(force),
        }
    }
}

/// The motion of a body, with accelerations as if no joint accelerated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LinkMotion {
    pub(super) center: DVec3,
    pub(super) angular: DVec3,
    pub(super) acceleration: DVec3,
    pub(super) angular_acceleration: DVec3,
}

impl LinkMotion {
    /// A body at rest or at constant velocity.
    pub(super) fn at_constant_velocity(center: DVec3, angular: DVec3) -> Self {
        Self {
            center,
            angular,
            ..Self::default()
        }
    }

    fn acceleration_at(&self, point: DVec3) -> DVec3 {
        let arm = point - self.center;
        // a_p = a_c + alpha x r + omega x (omega x r).
        self.acceleration
            + self.angular_acceleration.cross(arm)
            + self.angular.cross(self.angular.cross(arm))
    }
}

/// A tree at one moment. Shape (freedom,) each.
pub(super) struct TreeDynamics<'a> {
    /// Wrenches of laws on the joints' bodies; empty where none acts.
    pub(super) law_wrenches: Vec<ExternalWrench>,
    /// Wrench of laws on a free root.
    pub(super) root_law_wrench: ExternalWrench,
    pub(super) axes: Vec<JointAxisState>,
    pub(super) masses: Vec<SpatialInertia>,
    pub(super) angular: Vec<DVec3>,
    /// The motion of the root.
    pub(super) root: LinkMotion,
    /// The root's own mass if it is free, its joints' efforts reacting on it.
    pub(super) free_root: Option<SpatialInertia>,
    /// The velocity of the root's centre of mass, m/s.
    pub(super) root_velocity: DVec3,
    /// The support points of a tree whose root is free.
    pub(super) supports: &'a [SupportPoint],
    /// Other contact forces on the tree.
    pub(super) external_contacts: &'a [ExternalContact],
    pub(super) gravity: DVec3,
}

impl TreeDynamics<'_> {
    /// Returns the mass that each joint moves, and its momentum for each unit of the joint's velocity. Shape (freedom,) each.
    fn composite_bodies(&self) -> (Vec<SpatialInertia>, Vec<(DVec3, DVec3)>) {
        let mut carried = self.masses.clone();
        for k in (0..carried.len()).rev() {
            if let Some(parent) = self.axes[k].parent {
                // I^c_lambda += I^c_k, from the leaves to the root (table 6.2).
                carried[parent] = carried[parent].combined_with(&carried[k]);
            }
        }
        // F_k = I^c_k S_k (table 6.2).
        let momentum = |(axis, lump): (&JointAxisState, &SpatialInertia)| {
            let (linear, angular) = axis.unit_velocity_at(lump.center);
            (linear * lump.mass, lump.inertia * angular)
        };
        let momenta = self.axes.iter().zip(&carried).map(momentum).collect();
        (carried, momenta)
    }

    /// Returns the joint-space inertia matrix. Shape (freedom, freedom).
    pub(super) fn joint_space_inertia(&self) -> SymmetricMatrix {
        let mut inertia = self.fixed_base_inertia();
        if let Some(floating) = self.floating_base() {
            floating.subtract_base_inertia(&mut inertia);
        }
        inertia
    }

    /// Returns the same while the root is held. Shape (freedom, freedom).
    pub(super) fn fixed_base_inertia(&self) -> SymmetricMatrix {
        let n = self.axes.len();
        let (carried, momenta) = self.composite_bodies();
        let mut inertia = SymmetricMatrix::zero(n);
        for (k, momentum) in momenta.iter().enumerate() {
            let mut other = Some(k);
            while let Some(j) = other {
                // H_kj = F_k^T S_j, for k itself and every joint between it and the root (table 6.2).
                let (linear, angular) = self.axes[j].unit_velocity_at(carried[k].center);
                inertia.set(k, j, momentum.0.dot(linear) + momentum.1.dot(angular));
                other = self.axes[j].parent;
            }
        }
        inertia
    }

    /// Returns the floating base; `None` for a root that is not free.
    pub(super) fn floating_base(&self) -> Option<FloatingBase> {
        let root = self.free_root.as_ref()?;
        let (carried, momenta) = self.composite_bodies();
        Some(FloatingBase::of(root, &self.axes, &carried, &momenta))
    }

    /// Returns the motion of every body when the joints accelerate at this rate. Shape (freedom,).
    fn link_motions(&self, accelerations: &[f64]) -> Vec<LinkMotion> {
        self.moving_over(self.root, accelerations)
    }

    fn moving_over(&self, root: LinkMotion, accelerations: &[f64]) -> Vec<LinkMotion> {
        let mut moving: Vec<LinkMotion> = Vec::with_capacity(self.axes.len());
        for (k, axis) in self.axes.iter().enumerate() {
            let parent = axis.parent.map_or(root, |parent| moving[parent]);
            let turn = axis.direction * axis.velocity;
            let gain = axis.direction * accelerations[k];
            let center = self.masses[k].center;
            let mut body = LinkMotion::at_constant_velocity(center, self.angular[k]);
            // a_k = a_lambda + S_k q''_k + v_k x S_k q'_k (table 5.1), in three dimensions.
            match axis.kind {
                JointKind::Hinge => {
                    // alpha = alpha_lambda + omega_lambda x z q' + z q''.
                    body.angular_acceleration =
                        parent.angular_acceleration + parent.angular.cross(turn) + gain;
                    let arm = center - axis.anchor;
                    body.acceleration = parent.acceleration_at(axis.anchor)
                        + body.angular_acceleration.cross(arm)
                        + body.angular.cross(body.angular.cross(arm));
                }
                JointKind::Slide => {
                    // With Coriolis' 2 omega_lambda x z q'.
                    body.angular_acceleration = parent.angular_acceleration;
                    body.acceleration =
                        parent.acceleration_at(center) + 2.0 * parent.angular.cross(turn) + gain;
                }
            }
            moving.push(body);
        }
        moving
    }

    /// Returns the generalized forces of the last step's contacts: on the joints, shape (freedom,), and on a free root's six freedoms.
    pub(super) fn generalized_contact_forces(
        &self,
        floating: Option<&FloatingBase>,
    ) -> (Vec<f64>, [f64; 6]) {
        let mut efforts = vec![0.0; self.axes.len()];
        let mut whole = Wrench::default();
        for touch in self.external_contacts {
            let wrench = touch.wrench_about_origin();
            whole = whole.add_scaled(&wrench, 1.0);
            let mut link = touch.link;
            while let Some(k) = link {
                // tau_k = S_k^T f for every joint between the touched body and the root.
                efforts[k] += self.axes[k].generalized_force_of(&wrench);
                link = self.axes[k].parent;
            }
        }
        let root = floating.map_or([0.0; 6], |floating| floating.generalized_force(&whole));
        (efforts, root)
    }

    /// Returns the force on each body besides its weight and support, and the moment about its centre of mass besides the
    /// gyroscopic one, with which joints and root accelerate at this rate: those of the joints' bodies, shape (freedom,),
    /// and that of a free root. Within a tree over a free root they sum to the wrenches of laws.
    pub(super) fn wrenches(
        &self,
        accelerations: &[f64],
        answer: Option<&BaseResponse>,
    ) -> (Vec<Wrench>, Option<Wrench>) {
        let root = match (self.floating_base(), answer) {
            (Some(floating), Some(answer)) => {
                floating.base_motion_at(&self.root, &answer.accelerations)
            }
            _ => self.root,
        };
        let moving = self.moving_over(root, accelerations);
        // Newton's m a - m g and Euler's I alpha; rapier adds omega x I omega itself.
        let wrench = |body: &LinkMotion, lump: &SpatialInertia| Wrench {
            force: body.acceleration * lump.mass - self.gravity * lump.weight_mass,
            torque: lump.inertia * body.angular_acceleration,
        };
        let mut wrenches: Vec<Wrench> = moving
            .iter()
            .zip(&self.masses)
            .map(|(body, lump)| wrench(body, lump))
            .collect();
        let mut of_root = self.free_root.as_ref().map(|lump| wrench(&root, lump));
        for touch in self.external_contacts {
            let (wrench, center) = match (touch.link, &mut of_root, &self.free_root) {
                (Some(link), _, _) => (&mut wrenches[link], self.masses[link].center),
                (None, Some(root), Some(own)) => (root, own.center),
                (None, _, _) => continue,
            };
            *wrench = wrench.add_scaled(&touch.wrench_about(center), -1.0);
        }
        if let (Some(answer), Some(own)) = (answer, &self.free_root) {
            for (k, support) in self.supports.iter().enumerate() {
                let (wrench, center) = match (support.link, &mut of_root) {
                    (Some(link), _) => (&mut wrenches[link], self.masses[link].center),
                    (None, Some(root)) => (root, own.center),
                    (None, None) => continue,
                };
                *wrench = wrench.add_scaled(&answer.wrench(k, support.position, center), -1.0);
            }
        }
        (wrenches, of_root)
    }

    /// Returns the loads of all bodies at zero joint and root acceleration.
    pub(super) fn loads(&self) -> TreeLoads {
        let n = self.axes.len();
        // f^B = I a + v x* I v less what acts from outside (table 5.1), about the origin: here the weight, below what laws push with.
        let own = |body: &LinkMotion, lump: &SpatialInertia| {
            let weight = -self.gravity * lump.weight_mass;
            let force = body.acceleration * lump.mass + weight;
            let moment = lump.inertia * body.angular_acceleration
                + body.angular.cross(lump.inertia * body.angular)
                + lump.center.cross(force);
            let weight = Wrench {
                force: weight,
                torque: lump.center.cross(weight),
            };
            [
                Wrench {
                    force,
                    torque: moment,
                },
                weight,
            ]
        };
        let moving = self.link_motions(&vec![0.0; n]);
        let pairs = moving.iter().zip(&self.masses);
        let mut links: Vec<[Wrench; 2]> = pairs.map(|(body, lump)| own(body, lump)).collect();
        let pushed = |load: &mut [Wrench; 2], push: &ExternalWrench, lump: &SpatialInertia| {
            let push = Wrench {
                force: push.force,
                torque: push.torque + lump.center.cross(push.force),
            };
            load[0] = load[0].add_scaled(&push, -1.0);
        };
        for ((link, push), lump) in links.iter_mut().zip(&self.law_wrenches).zip(&self.masses) {
            pushed(link, push, lump);
        }
        let mut root = [Wrench::default(); 2];
        if let Some(lump) = &self.free_root {
            root = own(&self.root, lump);
            pushed(&mut root, &self.root_law_wrench, lump);
        }
        let mut carried = Vec::new();
        if let Some(lump) = &self.free_root {
            let all = links
                .iter()
                .fold(root[1], |all, link| all.add_scaled(&link[1], 1.0));
            let masses = self.masses.iter();
            let whole = masses.fold(*lump, |whole, mass| whole.combined_with(mass));
            carried = support::support_forces(self.supports, &all, whole.center);
            for (support, force) in self.supports.iter().zip(&carried) {
                let force = DVec3::Y * *force;
                let moment = support.position.cross(force);
                let load = match support.link {
                    Some(k) => &mut links[k],
                    None => &mut root,
                };
                load[1] = load[1].add_scaled(
                    &Wrench {
                        force,
                        torque: moment,
                    },
                    -1.0,
                );
            }
        }
        for k in (0..n).rev() {
            let below = links[k];
            let above = match self.axes[k].parent {
                Some(parent) => &mut links[parent],
                None => &mut root,
            };
            // f_lambda += f_k, from the leaves to the root (table 5.1).
            for (load, below) in above.iter_mut().zip(below) {
                *load = load.add_scaled(&below, 1.0);
            }
        }
        TreeLoads {
            links,
            root,
            support_weights: carried,
        }
    }

    /// Returns the efforts that bear the loads with motion (0) or of weight (1). Shape (freedom,).
    pub(super) fn generalized_forces(&self, loads: &TreeLoads, which: usize) -> Vec<f64> {
        let pairs = self.axes.iter().zip(&loads.links);
        // tau_k = S_k^T f_k (table 5.1).
        pairs
            .map(|(axis, load)| axis.generalized_force_of(&load[which]))
            .collect()
    }

    /// Returns the efforts that carry weight: a free root is supported where it or a joint's body stands on something, and
    /// gives way otherwise. Shape (freedom,).
    pub(super) fn weight_support_efforts(&self, loads: &TreeLoads) -> Vec<f64> {
        let mut efforts = self.generalized_forces(loads, 1);
        if let Some(floating) = self.floating_base() {
            floating.subtract_base_load(&loads.root[1], &mut efforts);
        }
        efforts
    }
}

/// A force, N, and a moment, N·m.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wrench {
    pub(super) force: DVec3,
    pub(super) torque: DVec3,
}

impl Wrench {
    pub(super) fn add_scaled(&self, other: &Self, times: f64) -> Self {
        Self {
            force: self.force + other.force * times,
            torque: self.torque + other.torque * times,
        }
    }
}

/// Wrenches about the world's origin: with motion, and of weight and support alone.
pub(super) struct TreeLoads {
    /// On each joint's body and all beyond it. Shape (freedom,).
    pub(super) links: Vec<[Wrench; 2]>,
    /// On the whole tree.
    pub(super) root: [Wrench; 2],
    /// The weight on each support, N.
    pub(super) support_weights: Vec<f64>,
}
