//! A chain in rapier alone: in reduced coordinates, or by constraint rows.

use crate::chain::{Chain, DENSITY, GRAVITY, ORIGIN, PHYSICS_HZ, Solver};
use glam::{Quat, Vec3};
use rapier3d::dynamics::{
    CCDSolver, GenericJoint, GenericJointBuilder, ImpulseJointSet, IntegrationParameters,
    IslandManager, JointAxesMask, JointAxis, MotorModel, MultibodyIndex, MultibodyJointSet,
    RigidBodyBuilder, RigidBodyHandle, RigidBodySet, SoftBodySet,
};
use rapier3d::geometry::{
    BroadPhaseBvh, ColliderBuilder, ColliderSet, InteractionGroups, NarrowPhase,
};
use rapier3d::math::Pose;
use rapier3d::pipeline::PhysicsPipeline;
use serde::{Deserialize, Serialize};

/// Rapier's substeps in a physics step, as in this crate's default.
const SUBSTEPS: usize = 4;

/// The kind of rapier's joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Joints {
    Multibody,
    Impulse,
}

#[derive(Clone, Serialize, Deserialize)]
struct Sets {
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse: ImpulseJointSet,
    multibody: MultibodyJointSet,
}

pub(crate) struct Rapier {
    chain: Chain,
    /// Solver iterations over the rows of a substep.
    sweeps: usize,
    sets: Sets,
    links: Vec<RigidBodyHandle>,
    pipeline: PhysicsPipeline,
    soft: SoftBodySet,
    ccd: CCDSolver,
}

impl Rapier {
    pub(crate) fn new(chain: &Chain, joints: Joints, sweeps: usize) -> Self {
        let mut sets = Sets {
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            impulse: ImpulseJointSet::new(),
            multibody: MultibodyJointSet::new(),
        };
        let anchor = RigidBodyBuilder::fixed().translation(ORIGIN);
        let mut parent = sets.bodies.insert(anchor);
        let mut links = Vec::new();
        let start: Vec<f64> = chain.start.iter().map(|[q, _]| f64::from(*q)).collect();
        let stands = chain.forward(&start);
        let (mut spin, mut velocity) = (Vec3::ZERO, Vec3::ZERO);
        let mut reach = 0.0;
        for (k, bar) in chain.bars.iter().enumerate() {
            let (at, turn) = (stands[k].0.as_vec3(), stands[k].1.as_quat());
            let arm = turn * Vec3::X * bar.length;
            spin += turn * bar.axis * chain.start[k][1];
            let body = RigidBodyBuilder::dynamic()
                .pose(Pose::from_parts(at, turn))
                .linvel(velocity + spin.cross(0.5 * arm))
                .angvel(spin)
                .can_sleep(false)
                .allow_fast_rotation(true);
            velocity += spin.cross(arm);
            let body = sets.bodies.insert(body);
            let half = Vec3::new(0.5 * bar.length, bar.half, bar.half);
            let shape = ColliderBuilder::cuboid(half.x, half.y, half.z)
                .translation(Vec3::X * half.x)
                .density(DENSITY)
                .collision_groups(InteractionGroups::none());
            sets.colliders
                .insert_with_parent(shape, body, &mut sets.bodies);
            let joint = joint(chain, bar.axis, Vec3::X * reach, chain.start[k][0]);
            match joints {
                Joints::Multibody => {
                    sets.multibody.insert(parent, body, joint, true);
                }
                Joints::Impulse => {
                    sets.impulse.insert(parent, body, joint, true);
                }
            }
            links.push(body);
            (parent, reach) = (body, bar.length);
        }
        if joints == Joints::Multibody {
            begin(&mut sets, chain, links[0]);
        }
        Self {
            chain: chain.clone(),
            sweeps,
            sets,
            links,
            pipeline: PhysicsPipeline::new(),
            soft: SoftBodySet::new(),
            ccd: CCDSolver::new(),
        }
    }
}

fn joint(chain: &Chain, axis: Vec3, at: Vec3, target: f32) -> GenericJoint {
    let to_x = Quat::from_rotation_arc(Vec3::X, axis);
    let mut joint = GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES)
        .local_frame1(Pose::from_parts(at, to_x))
        .local_frame2(Pose::from_parts(Vec3::ZERO, to_x))
        .contacts_enabled(false);
    if let Some(limits) = chain.limits {
        joint = joint.limits(JointAxis::AngX, limits);
    }
    if let Some(motor) = chain.motor {
        joint = joint
            .motor_model(JointAxis::AngX, MotorModel::ForceBased)
            .motor_position(JointAxis::AngX, target, motor.stiffness, motor.damping)
            .motor_max_force(JointAxis::AngX, 1e6);
    }
    joint.build()
}

/// Puts a multibody at its angles, without the damping that rapier adds.
fn begin(sets: &mut Sets, chain: &Chain, first: RigidBodyHandle) {
    let link = sets.multibody.rigid_body_link(first).copied();
    let index: MultibodyIndex = link.expect("it was inserted").multibody;
    let tree = sets.multibody.get_multibody_mut(index);
    let tree = tree.expect("it was inserted");
    tree.forward_kinematics(&sets.bodies, true);
    let root = tree.ndofs() - chain.bars.len();
    let displacements: Vec<f32> = std::iter::repeat_n(0.0, root)
        .chain(chain.start.iter().map(|[q, _]| *q))
        .collect();
    tree.apply_displacements(&displacements);
    for (k, [_, velocity]) in chain.start.iter().enumerate() {
        tree.generalized_velocity_mut()[root + k] = *velocity;
    }
    tree.damping_mut().fill(0.0);
    for k in 0..chain.bars.len() {
        tree.frictions_mut()[root + k] = chain.friction;
    }
    tree.forward_kinematics(&sets.bodies, false);
    tree.update_rigid_bodies(&mut sets.bodies, true);
}

impl Solver for Rapier {
    fn steps(&mut self, control_steps: usize) {
        let parameters = IntegrationParameters {
            dt: 1.0 / PHYSICS_HZ as f32,
            num_solver_iterations: SUBSTEPS,
            num_internal_pgs_iterations: self.sweeps,
            ..IntegrationParameters::default()
        };
        for _ in 0..control_steps * PHYSICS_HZ / self.chain.control_hz {
            self.pipeline.step(
                Vec3::NEG_Y * GRAVITY,
                &parameters,
                &mut self.sets.islands,
                &mut self.sets.broad_phase,
                &mut self.sets.narrow_phase,
                &mut self.sets.bodies,
                &mut self.sets.colliders,
                &mut self.sets.impulse,
                &mut self.sets.multibody,
                &mut self.soft,
                &mut self.ccd,
                &(),
                &(),
            );
        }
    }

    fn angles(&self) -> Vec<f64> {
        let mut before = Quat::IDENTITY;
        let angle = |(bar, link): (&crate::chain::Bar, &RigidBodyHandle)| {
            let now = *self.sets.bodies[*link].rotation();
            let turn = before.inverse() * now;
            before = now;
            let sine = f64::from(Vec3::new(turn.x, turn.y, turn.z).dot(bar.axis));
            let angle = 2.0 * libm::atan2(sine, f64::from(turn.w));
            angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round()
        };
        self.chain.bars.iter().zip(&self.links).map(angle).collect()
    }

    fn rates(&self) -> Vec<f64> {
        let mut before = Vec3::ZERO;
        let rate = |(bar, link): (&crate::chain::Bar, &RigidBodyHandle)| {
            let body = &self.sets.bodies[*link];
            let own = body.angvel() - before;
            before = body.angvel();
            f64::from(own.dot(*body.rotation() * bar.axis))
        };
        self.chain.bars.iter().zip(&self.links).map(rate).collect()
    }

    fn energy_j(&self) -> f64 {
        let bodies = self.links.iter().map(|link| &self.sets.bodies[*link]);
        bodies
            .map(|body| {
                let height = f64::from(body.center_of_mass().y);
                let potential = f64::from(body.mass()) * f64::from(GRAVITY) * height;
                f64::from(body.kinetic_energy()) + potential
            })
            .sum()
    }

    fn bits(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.sets).expect("rapier's sets are plain data")
    }

    fn restored(&self) -> Box<dyn Solver> {
        Box::new(Self {
            chain: self.chain.clone(),
            sweeps: self.sweeps,
            sets: postcard::from_bytes(&self.bits()).expect("it was written just now"),
            links: self.links.clone(),
            pipeline: PhysicsPipeline::new(),
            soft: SoftBodySet::new(),
            ccd: CCDSolver::new(),
        })
    }
}
