//! How the bodies of a tree move: inertia along its joints, and what gravity and rotation ask of them.
//!
//! # Source
//! R. Featherstone, Rigid Body Dynamics Algorithms (2008): the composite-rigid-body method (6.2) and the recursive
//! Newton-Euler method (5.3), written here in world coordinates about centres of mass.

use super::convex::Inertia;
use dwell_scene::JointKind;
use glam::{DMat3, DQuat, DVec3};
use rapier3d::dynamics::RigidBody;

/// A body as the dynamics see it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lump {
    /// kg.
    pub(super) mass: f64,
    /// kg that gravity pulls at: less under water.
    pub(super) heavy: f64,
    /// Centre of mass, m.
    pub(super) center: DVec3,
    /// About the centre of mass, world axes, kg·m².
    pub(super) inertia: DMat3,
}

impl Lump {
    pub(super) fn of(body: &RigidBody) -> Self {
        let local = &body.mass_properties().local_mprops;
        let principal = local.principal_inertia().as_dvec3();
        let turn = body.position().rotation * local.principal_inertia_local_frame;
        let turn = DMat3::from_quat(turn.as_dquat().normalize());
        Self {
            mass: body.mass().into(),
            heavy: f64::from(body.mass() * body.gravity_scale()),
            center: body.center_of_mass().as_dvec3(),
            inertia: turn * DMat3::from_diagonal(principal) * turn.transpose(),
        }
    }

    /// Two bodies as one.
    pub(super) fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return *self;
        }
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        Self {
            mass,
            heavy: self.heavy + other.heavy,
            center,
            inertia: self.about(center) + other.about(center),
        }
    }

    /// The inertia about another point (Steiner).
    fn about(&self, point: DVec3) -> DMat3 {
        let d = self.center - point;
        let outer = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        self.inertia + (DMat3::from_diagonal(DVec3::splat(d.length_squared())) - outer) * self.mass
    }
}

/// One degree of freedom in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) kind: JointKind,
    pub(super) direction: DVec3,
    /// A point on it, m.
    pub(super) at: DVec3,
    /// Which of the tree's free joints moves its parent.
    pub(super) parent: Option<usize>,
    pub(super) velocity: f64,
}

impl Axis {
    /// Velocity of a point, and rotation, for each unit of this joint's velocity.
    fn moves(&self, point: DVec3) -> (DVec3, DVec3) {
        match self.kind {
            JointKind::Hinge => (self.direction.cross(point - self.at), self.direction),
            JointKind::Slide => (self.direction, DVec3::ZERO),
        }
    }
}

/// How a body moves, with accelerations as if no joint accelerated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moving {
    pub(super) center: DVec3,
    pub(super) angular: DVec3,
    acceleration: DVec3,
    angular_acceleration: DVec3,
}

impl Moving {
    /// A body that stands or moves evenly.
    pub(super) fn evenly(center: DVec3, angular: DVec3) -> Self {
        Self {
            center,
            angular,
            ..Self::default()
        }
    }

    fn acceleration_at(&self, point: DVec3) -> DVec3 {
        let arm = point - self.center;
        self.acceleration
            + self.angular_acceleration.cross(arm)
            + self.angular.cross(self.angular.cross(arm))
    }
}

/// A tree at one moment. Shape (freedom,) each.
pub(super) struct Motion {
    pub(super) axes: Vec<Axis>,
    pub(super) masses: Vec<Lump>,
    pub(super) angular: Vec<DVec3>,
    /// How the root moves.
    pub(super) root: Moving,
    /// The root's own mass if it is free to answer, its joints' efforts pushing back on it.
    pub(super) free_root: Option<Lump>,
    pub(super) gravity: DVec3,
}

impl Motion {
    /// What the joints resist with. Shape (freedom, freedom).
    pub(super) fn inertia(&self) -> Inertia {
        let n = self.axes.len();
        let mut carried = self.masses.clone();
        for k in (0..n).rev() {
            if let Some(parent) = self.axes[k].parent {
                carried[parent] = carried[parent].with(&carried[k]);
            }
        }
        let mut inertia = Inertia::zero(n);
        let mut momenta = Vec::with_capacity(n);
        for (k, axis) in self.axes.iter().enumerate() {
            let (linear, angular) = axis.moves(carried[k].center);
            let momentum = (linear * carried[k].mass, carried[k].inertia * angular);
            let mut other = Some(k);
            while let Some(j) = other {
                let (linear, angular) = self.axes[j].moves(carried[k].center);
                inertia.set(k, j, momentum.0.dot(linear) + momentum.1.dot(angular));
                other = self.axes[j].parent;
            }
            momenta.push(momentum);
        }
        if let Some(root) = &self.free_root {
            lighten(&mut inertia, root, &self.axes, &carried, &momenta);
        }
        inertia
    }

    /// How every body moves when the joints accelerate like this. Shape (freedom,).
    fn moving(&self, accelerations: &[f64]) -> Vec<Moving> {
        let mut moving: Vec<Moving> = Vec::with_capacity(self.axes.len());
        for (k, axis) in self.axes.iter().enumerate() {
            let parent = axis.parent.map_or(self.root, |parent| moving[parent]);
            let turn = axis.direction * axis.velocity;
            let gain = axis.direction * accelerations[k];
            let center = self.masses[k].center;
            let mut body = Moving::evenly(center, self.angular[k]);
            match axis.kind {
                JointKind::Hinge => {
                    body.angular_acceleration =
                        parent.angular_acceleration + parent.angular.cross(turn) + gain;
                    let arm = center - axis.at;
                    body.acceleration = parent.acceleration_at(axis.at)
                        + body.angular_acceleration.cross(arm)
                        + body.angular.cross(body.angular.cross(arm));
                }
                JointKind::Slide => {
                    body.angular_acceleration = parent.angular_acceleration;
                    body.acceleration =
                        parent.acceleration_at(center) + 2.0 * parent.angular.cross(turn) + gain;
                }
            }
            moving.push(body);
        }
        moving
    }

    /// The tree a moment later, when its joints accelerate like this. Second order in `h_s` for places, first for the rest.
    pub(super) fn later(&self, accelerations: &[f64], h_s: f64) -> Self {
        let moving = self.moving(accelerations);
        let mut speeds: Vec<DVec3> = Vec::with_capacity(moving.len());
        let (mut axes, mut masses) = (self.axes.clone(), self.masses.clone());
        let mut angular = self.angular.clone();
        for (k, axis) in self.axes.iter().enumerate() {
            let (parent, carries) = axis
                .parent
                .map_or((&self.root, DVec3::ZERO), |p| (&moving[p], speeds[p]));
            let with_parent = |point: DVec3| carries + parent.angular.cross(point - parent.center);
            let center = self.masses[k].center;
            let speed = match axis.kind {
                JointKind::Hinge => with_parent(axis.at) + self.angular[k].cross(center - axis.at),
                JointKind::Slide => with_parent(center) + axis.direction * axis.velocity,
            };
            speeds.push(speed);
            let body = &moving[k];
            let turned = |body: &Moving| {
                DQuat::from_scaled_axis(
                    (body.angular + body.angular_acceleration * (0.5 * h_s)) * h_s,
                )
            };
            let turn = DMat3::from_quat(turned(body));
            masses[k].center += (speed + body.acceleration * (0.5 * h_s)) * h_s;
            masses[k].inertia = turn * self.masses[k].inertia * turn.transpose();
            angular[k] += body.angular_acceleration * h_s;
            let root_stands = axis.parent.is_none();
            let bent = if root_stands {
                DQuat::IDENTITY
            } else {
                turned(parent)
            };
            let shift = if root_stands {
                DVec3::ZERO
            } else {
                (with_parent(axis.at) + parent.acceleration_at(axis.at) * (0.5 * h_s)) * h_s
            };
            axes[k].direction = bent * axis.direction;
            axes[k].at += shift;
            axes[k].velocity += accelerations[k] * h_s;
        }
        Self {
            axes,
            masses,
            angular,
            ..*self
        }
    }

    /// The force on each body besides its weight, and the moment about its centre of mass besides the gyroscopic one, with
    /// which the joints accelerate like this. Shape (freedom,).
    pub(super) fn wrenches(&self, accelerations: &[f64]) -> Vec<(DVec3, DVec3)> {
        let moving = self.moving(accelerations);
        let wrench = |(body, lump): (&Moving, &Lump)| {
            let force = body.acceleration * lump.mass - self.gravity * lump.heavy;
            (force, lump.inertia * body.angular_acceleration)
        };
        moving.iter().zip(&self.masses).map(wrench).collect()
    }

    /// The efforts that keep every joint from accelerating, and the part of them that carries weight. The root is taken as
    /// carried by something.
    pub(super) fn bias(&self) -> (Vec<f64>, Vec<f64>) {
        let n = self.axes.len();
        // Force and moment about the world's origin, with motion and of weight alone.
        let mut loads = Vec::with_capacity(n);
        for (body, lump) in self.moving(&vec![0.0; n]).iter().zip(&self.masses) {
            let weight = -self.gravity * lump.heavy;
            let force = body.acceleration * lump.mass + weight;
            let moment = lump.inertia * body.angular_acceleration
                + body.angular.cross(lump.inertia * body.angular)
                + lump.center.cross(force);
            loads.push([(force, moment), (weight, lump.center.cross(weight))]);
        }
        for k in (0..n).rev() {
            if let Some(parent) = self.axes[k].parent {
                let below = loads[k];
                for (load, below) in loads[parent].iter_mut().zip(below) {
                    *load = (load.0 + below.0, load.1 + below.1);
                }
            }
        }
        let along = |which: usize| {
            let effort = |(axis, load): (&Axis, &[(DVec3, DVec3); 2])| {
                let (force, moment) = load[which];
                match axis.kind {
                    JointKind::Hinge => axis.direction.dot(moment - axis.at.cross(force)),
                    JointKind::Slide => axis.direction.dot(force),
                }
            };
            self.axes.iter().zip(&loads).map(effort).collect()
        };
        (along(0), along(1))
    }
}

/// Takes off what the joints' inertia loses because the root gives way (Schur's complement of its six freedoms).
fn lighten(
    inertia: &mut Inertia,
    root: &Lump,
    axes: &[Axis],
    carried: &[Lump],
    momenta: &[(DVec3, DVec3)],
) {
    let children = axes
        .iter()
        .zip(carried)
        .filter(|(axis, _)| axis.parent.is_none());
    let whole = children.fold(*root, |whole, (_, mass)| whole.with(mass));
    let mut own = Inertia::zero(6);
    for k in 0..3 {
        own.set(k, k, whole.mass);
        for j in 0..3 {
            own.set(3 + k, 3 + j, whole.inertia.col(j)[k]);
        }
    }
    let factor = own.factor();
    // About the centre of mass of all, linear and angular momentum are apart.
    let columns: Vec<[f64; 6]> = momenta
        .iter()
        .zip(carried)
        .map(|((linear, angular), mass)| {
            let angular = *angular + (mass.center - whole.center).cross(*linear);
            [
                linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
            ]
        })
        .collect();
    for (k, column) in columns.iter().enumerate() {
        let answer = factor.solve(column);
        for (j, other) in columns.iter().enumerate().take(k + 1) {
            let lost: f64 = answer.iter().zip(other).map(|(a, b)| a * b).sum();
            inertia.set(k, j, inertia.get(k, j) - lost);
        }
    }
}
