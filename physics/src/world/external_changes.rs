//! Changes from outside: added agents, adopted states.

use super::PhysicsWorld;
use crate::articulation::joint_from_state;
use crate::body::{self, BodyStatus};
use crate::convert::to_rapier;
use crate::error::PhysicsError;
use crate::joints::{self, ImposedJointState};
use dwell_scene::{AgentId, AgentState, Id, JointId, State, Velocity};
use glam::Vec3;
use std::collections::BTreeSet;

impl PhysicsWorld {
    /// Adds an agent to the state and the world. It may be placed inside things; it then works its way out.
    ///
    /// # Errors
    /// [`PhysicsError::Scene`] for a body out of range, [`PhysicsError::Range`] for a position that is not finite,
    /// [`PhysicsError::ForeignState`] for a state with other agents.
    pub fn add_agent(
        &mut self,
        state: &mut State,
        agent: AgentState,
    ) -> Result<AgentId, PhysicsError> {
        agent.body.check()?;
        finite_place(agent.position, agent.yaw_rad)?;
        let lowest = 2.0 * agent.body.radius_m;
        if !(0.0..=agent.body.height_m - lowest).contains(&agent.crouched_by_m) {
            return Err(PhysicsError::Range {
                at: "agent".to_owned(),
                field: "crouched_by_m",
                found: agent.crouched_by_m.to_string(),
                allowed: "0 to the height above twice the radius",
            });
        }
        self.check_state(state)?;
        let id = state.agents.push(AgentState {
            holding: None,
            ..agent
        });
        self.agents.insert(&mut self.dynamics, &agent);
        self.dynamics.flush();
        Ok(id)
    }

    /// Adopts poses, velocities and joint positions that were set in `state` from outside: bodies that differ are moved
    /// there and woken. Frozen and latched bodies that are moved, or given a velocity, become free.
    ///
    /// # Errors
    /// [`PhysicsError::ForeignState`] for another house's state; [`PhysicsError::Range`] for a pose that is not rigid.
    pub fn adopt_state(&mut self, state: &mut State) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let model = self.dynamics.model.clone();
        let mut joints = state.joint_position.iter().zip(&state.joint_velocity);
        if let Some(k) = joints.position(|(q, v)| !q.is_finite() || !v.is_finite()) {
            let id = JointId::from_index(k);
            let (q, v) = (state.joint_position[id], state.joint_velocity[id]);
            return Err(PhysicsError::Range {
                at: format!("joint {k}"),
                field: "position or velocity",
                found: format!("{q}, {v}"),
                allowed: "finite numbers",
            });
        }
        for plan in &model.bodies {
            let pose = state.part_pose[plan.root()];
            let velocity = state.part_velocity[plan.root()];
            if !pose.is_valid() || !velocity.linear.is_finite() || !velocity.angular.is_finite() {
                return Err(PhysicsError::Range {
                    at: format!("part {}", plan.root().0),
                    field: "pose or velocity",
                    found: pose.position.to_string(),
                    allowed: "finite numbers and a unit quaternion",
                });
            }
        }
        let (mut disturbed_roots, mut set) = (BTreeSet::new(), Vec::new());
        // Bodies without a joint come first: they are parents of others.
        for (index, plan) in model.bodies.iter().enumerate() {
            if plan.joint.is_some() {
                continue;
            }
            let pose = to_rapier(&state.part_pose[plan.root()]);
            let velocity = state.part_velocity[plan.root()];
            let handle = self.dynamics.bodies[index].handle;
            let Some(rigid) = self.dynamics.engine.bodies.get(handle) else {
                continue;
            };
            let moved = *rigid.position() != pose;
            let moving = velocity != Velocity::default();
            if moved || moving && self.dynamics.engine.sleeping_cache.contains(handle) {
                self.dynamics.engine.wake_around(handle);
            }
            let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle) else {
                continue;
            };
            let mut disturbed = moved;
            if moved {
                self.dynamics.statuses[index] = BodyStatus::Free;
                rigid.set_body_type(body::body_type(BodyStatus::Free), true);
                rigid.set_position(pose, true);
            }
            let origin = rigid.position().translation;
            let arm = rigid.center_of_mass() - origin;
            let there = Velocity {
                linear: rigid.velocity_at_point(origin),
                angular: rigid.angvel(),
            };
            if !same_velocity(&there, &velocity, arm) {
                if self.dynamics.statuses[index] != BodyStatus::Free {
                    // A fixed body with a velocity would pass through everything.
                    self.dynamics.statuses[index] = BodyStatus::Free;
                    rigid.set_body_type(body::body_type(BodyStatus::Free), true);
                }
                rigid.set_linvel(velocity.linear + velocity.angular.cross(arm), true);
                rigid.set_angvel(velocity.angular, true);
                disturbed = true;
            }
            if disturbed {
                disturbed_roots.insert(index as u32);
                set.push((plan.root(), velocity));
            }
        }
        let mut stands = Vec::with_capacity(self.articulation.joints.len());
        for joint in &self.articulation.joints {
            let articulation = &model.house.joints[joint.id];
            let position = joint.values.clamp(state.joint_position[joint.id]);
            let child = joint.child as usize;
            let shut = joints::is_at_closed_position(joint, articulation, position);
            let body = self.dynamics.bodies[child];
            if self.dynamics.statuses[child] == BodyStatus::Latched && !shut {
                joints::release(
                    &mut self.dynamics.engine,
                    &body,
                    &mut self.dynamics.statuses[child],
                );
            }
            let stand = ImposedJointState {
                position,
                velocity: state.joint_velocity[joint.id],
                force_update: false,
                is_latched: self.dynamics.statuses[child] == BodyStatus::Latched,
            };
            let there = joints::read_joint(&self.dynamics.engine, joint, position.into());
            let put = !stand.is_latched
                && !joints::matches_bodies(&self.dynamics.engine, joint, &stand, there);
            if put {
                self.dynamics.engine.wake_around(body.handle);
                self.dynamics.laws.notify_joint_set(joint.id, position);
            }
            if self.dynamics.statuses[child] == BodyStatus::Frozen && put {
                self.dynamics.statuses[child] = BodyStatus::Free;
                if let Some(rigid) = self.dynamics.engine.bodies.get_mut(body.handle) {
                    rigid.set_body_type(body::body_type(BodyStatus::Free), true);
                }
            }
            stands.push(stand);
        }
        for tree in &self.articulation.trees {
            if tree
                .root_body()
                .is_some_and(|root| disturbed_roots.contains(&root))
            {
                for joint in &tree.joints {
                    stands[*joint].force_update = true;
                }
            }
        }
        self.place_joints(state, &stands);
        for (root, velocity) in set {
            let found = state.part_velocity[root];
            let body = self.dynamics.model.body_of_part[root]
                .map(|body| self.dynamics.bodies[body as usize]);
            let rigid = body.and_then(|body| self.dynamics.engine.bodies.get(body.handle));
            let arm = rigid.map_or(Vec3::ZERO, |rigid| {
                rigid.center_of_mass() - rigid.position().translation
            });
            if same_velocity(&found, &velocity, arm) {
                state.part_velocity[root] = velocity;
            }
        }
        // The state keeps the values that it was given: those computed from bodies differ by rounding.
        for (joint, stand) in self.articulation.joints.iter().zip(&stands) {
            let read = (
                state.joint_position[joint.id].into(),
                state.joint_velocity[joint.id].into(),
            );
            if !stand.is_latched
                && joints::matches_bodies(&self.dynamics.engine, joint, stand, read)
            {
                state.joint_position[joint.id] = stand.position;
                state.joint_velocity[joint.id] = stand.velocity;
            }
        }
        self.dynamics.write_contacts(state);
        Ok(())
    }

    /// Returns position and velocity of a joint, rad or m and per second, as the next step begins; `None` for a joint that
    /// moves nothing.
    ///
    /// Physics moves joints by their own coordinates. It goes on from those of the state where bodies agree with them up to
    /// the rounding of their poses and velocities, which are f32 in the world (some 5e-7 m at 5 m from the origin, 2e-6 m/s
    /// at 20 m/s, a few times over), and from the bodies' where they do not.
    pub fn joint_kinematics(&self, state: &State, joint: JointId) -> Option<(f32, f32)> {
        let place = self
            .articulation
            .joints
            .binary_search_by_key(&joint, |other| other.id);
        let found = &self.articulation.joints[place.ok()?];
        let now = joints::coordinates_at_step_start(
            &self.dynamics.engine,
            found,
            joint_from_state(state, joint),
        );
        Some((now.position as f32, now.velocity as f32))
    }
}

/// Returns whether two velocities of a body's origin are the same up to the rounding of moving them to its centre of mass,
/// `arm` away, m.
fn same_velocity(a: &Velocity, b: &Velocity, arm: Vec3) -> bool {
    let most = |v: Vec3| v.abs().max_element();
    let rounding = 4.0 * f32::EPSILON * (most(b.linear) + most(b.angular.cross(arm)));
    a.angular == b.angular && most(a.linear - b.linear) <= rounding
}

fn finite_place(position: Vec3, yaw_rad: f32) -> Result<(), PhysicsError> {
    if position.is_finite() && position.abs().max_element() <= 32_768.0 && yaw_rad.is_finite() {
        return Ok(());
    }
    Err(PhysicsError::Range {
        at: "agent".to_owned(),
        field: "position or yaw",
        found: format!("{position}, {yaw_rad}"),
        allowed: "finite numbers within 32768 m of the origin",
    })
}
