//! Construction of a world: resolves overlaps, attaches joints, latches doors.

use super::PhysicsWorld;
use crate::body;
use crate::error::PhysicsError;
use crate::joints;
use crate::limits;
use crate::model::PhysicsModel;
use crate::report::StartReport;
use crate::start::PenetrationResolver;
use dwell_scene::State;
use rapier3d::dynamics::RigidBodyHandle;

impl PhysicsWorld {
    /// Resolves overlaps, attaches joints and latches doors.
    pub(super) fn initialize(
        &mut self,
        state: &mut State,
        anchor: RigidBodyHandle,
    ) -> Result<StartReport, PhysicsError> {
        let mut report = StartReport {
            bodies: self.dynamics.bodies.len(),
            static_pieces: self.dynamics.model.static_pieces.len(),
            joints: self.dynamics.model.house.joints.len(),
            stand_ins: self.dynamics.model.fallback_collider_objects.clone(),
            ..StartReport::default()
        };
        let model = self.dynamics.model.clone();
        self.articulation.joints = joints::insert(
            &mut self.dynamics.engine,
            &model,
            &self.dynamics.bodies,
            anchor,
            state,
        );
        self.articulation.trees = joints::trees(&self.articulation.joints, &model, anchor);
        limits::check_trees(
            &model.house,
            &self.articulation.joints,
            &self.articulation.trees,
        )?;
        self.articulation.actuations = vec![None; self.articulation.joints.len()];
        self.dynamics.flush();
        let start = PenetrationResolver {
            engine: &self.dynamics.engine,
            model: &model,
            entries: &self.dynamics.entries,
            bodies: &self.dynamics.bodies,
            settings: &self.dynamics.settings,
        };
        let excluded = start.joint_exclusions(&mut report)?;
        let resolved = start.resolve(&mut report);
        self.dynamics.collision_exclusions = excluded;
        for (index, resolved) in resolved.iter().enumerate() {
            self.dynamics.statuses[index] = resolved.status;
            if let Some(rigid) = self
                .dynamics
                .engine
                .bodies
                .get_mut(self.dynamics.bodies[index].handle)
            {
                if *rigid.position() != resolved.pose {
                    rigid.set_position(resolved.pose, false);
                }
                rigid.set_body_type(body::body_type(resolved.status), false);
            }
        }
        self.articulation
            .move_jointed_bodies(&mut self.dynamics, state);
        if self.dynamics.settings.config.latches {
            for joint in &self.articulation.joints {
                let articulation = &model.house.joints[joint.id];
                if joints::is_at_closed_position(
                    joint,
                    articulation,
                    state.joint_position[joint.id],
                ) {
                    let child = joint.child as usize;
                    let body = self.dynamics.bodies[child];
                    let hold = &mut self.dynamics.statuses[child];
                    joints::latch(&mut self.dynamics.engine, joint, articulation, &body, hold);
                }
            }
        }
        self.dynamics.forget_fixed_pairs();
        Ok(report)
    }
}

/// Puts every joint's part at its joint's position, unless it is there already; a joint beyond its limits, as overrides may
/// have set them, is put at the nearer one.
pub(super) fn align_joints(model: &PhysicsModel, state: &mut State) {
    for (id, joint) in model.house.joints.iter_ids() {
        let values = state.joint_parameters(&model.house, id);
        state.joint_position[id] = values.clamp(state.joint_position[id]);
        let parent = joint.parent.map_or(dwell_scene::Pose::IDENTITY, |parent| {
            state.part_pose[parent]
        });
        let pose = state.world_from_child(&model.house, id, &parent, state.joint_position[id]);
        let now = state.part_pose[joint.child];
        let joint_coordinates = (pose.position - now.position).length() < 1e-4
            && pose.rotation.dot(now.rotation).abs() > 1.0 - 1e-6;
        if !joint_coordinates {
            state.part_pose[joint.child] = pose;
        }
    }
}
