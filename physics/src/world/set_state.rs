//! Setting poses and velocities of bodies and joints from outside.

use super::PhysicsWorld;
use crate::body::BodyStatus;
use crate::convert::{from_rapier, to_rapier};
use crate::error::PhysicsError;
use dwell_scene::{Id, JointId, JointKind, PartId, Pose, State, Velocity};

/// Highest speed that can be set, m/s and rad/s: a turn within a solver substep at the default rates, beyond which
/// rotations are ambiguous.
const FASTEST: f32 = 1000.0;
/// Largest coordinate that can be set, m: coordinates are exact to some millimetres there.
const FURTHEST_M: f32 = 32_768.0;
/// Rounding tolerance of a joint's position beyond a stop, rad or m.
const AT_STOP: f32 = 1e-5;

/// The pose and velocities of a part that moves freely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// A part of the body: a free object's, or the base of a free robot.
    pub part: PartId,
    /// `world_from_part`.
    pub pose: Pose,
    /// Of the part's origin, m/s, and rad/s.
    pub velocity: Velocity,
}

/// The position and velocity of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState {
    /// The joint.
    pub joint: JointId,
    /// rad or m, within its limits.
    pub position: f32,
    /// rad/s or m/s.
    pub velocity: f32,
}

fn refuse(at: String, field: &'static str, found: String, allowed: &'static str) -> PhysicsError {
    PhysicsError::Range {
        at,
        field,
        found,
        allowed,
    }
}

impl PhysicsWorld {
    /// Sets poses and velocities of free bodies, at once; bodies jointed to them move along, with unchanged joint
    /// positions. They and their supports are awake afterwards. The state then holds exactly the values that were set.
    ///
    /// # Errors
    /// [`PhysicsError::Unmovable`] for a part that is fixed, frozen, held or moved by a joint; [`PhysicsError::Range`] for
    /// values that are not finite, a rotation that is no unit quaternion, a position beyond 32768 m or speeds beyond 1000
    /// m/s or rad/s. Nothing has changed then.
    pub fn set_bodies(
        &mut self,
        state: &mut State,
        bodies: &[BodyState],
    ) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        // To adopt the state looks at all contacts anew.
        if bodies.is_empty() {
            return Ok(());
        }
        let roots: Vec<(PartId, Pose, Velocity)> = bodies
            .iter()
            .map(|body| self.root_state(body))
            .collect::<Result<_, _>>()?;
        for (root, pose, velocity) in &roots {
            state.part_pose[*root] = *pose;
            state.part_velocity[*root] = *velocity;
        }
        self.adopt_state(state)?;
        self.wake_bodies_of(roots.iter().map(|(root, ..)| *root));
        Ok(())
    }

    /// Sets joints to positions and velocities, at once; jointed bodies move along, and are awake afterwards.
    ///
    /// Setting is no motion: a hysteresis spring then has no effort and a backlash's output is at the joint's position,
    /// whatever was before, so that equal states evolve alike. Motors' states of past commands (latency, lag, rate limit)
    /// stay.
    ///
    /// A hinge counts its turns: a continuous one reads the integral of its velocity up to the 1000 rad/s that may be set,
    /// as long as no impact changes its velocity at once by a turn a physics step (754 rad/s at 120 Hz); beyond that it may
    /// read a turn too many or too few. A position has f32 precision: 1e-3 rad at 10,000 rad.
    ///
    /// # Errors
    /// [`PhysicsError::Unmovable`] for a joint that does not exist; [`PhysicsError::Range`] for numbers that are not finite, a
    /// position beyond the joint's limits or a speed beyond 1000 rad/s or m/s. Nothing has changed then.
    pub fn set_joints(
        &mut self,
        state: &mut State,
        joints: &[JointState],
    ) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let mut within = Vec::with_capacity(joints.len());
        for set in joints {
            within.push(self.check_joint(state, set)?);
        }
        for (set, position) in joints.iter().zip(within) {
            state.joint_position[set.joint] = position;
            state.joint_velocity[set.joint] = set.velocity;
        }
        self.adopt_state(state)?;
        for set in joints {
            self.dynamics
                .laws
                .notify_joint_set(set.joint, state.joint_position[set.joint]);
        }
        let children = joints
            .iter()
            .map(|set| self.dynamics.model.house.joints[set.joint].child);
        self.wake_bodies_of(children.collect::<Vec<_>>().into_iter());
        Ok(())
    }

    /// The position within the limits.
    fn check_joint(&self, state: &State, set: &JointState) -> Result<f32, PhysicsError> {
        let house = &self.dynamics.model.house;
        let Some(joint) = house.joints.get(set.joint) else {
            return Err(PhysicsError::Unmovable {
                what: format!("joint {}", set.joint.0),
                why: format!("there are {}, counted from 0", house.joints.len()),
            });
        };
        let at = || format!("joint {:?}", joint.name);
        if !set.position.is_finite() || !set.velocity.is_finite() {
            let found = format!("{}, {}", set.position, set.velocity);
            return Err(refuse(
                at(),
                "position or velocity",
                found,
                "finite numbers",
            ));
        }
        if set.velocity.abs() > FASTEST {
            let allowed = match joint.kind {
                JointKind::Hinge => "at most 1000 rad/s either way",
                JointKind::Slide => "at most 1000 m/s either way",
            };
            return Err(refuse(at(), "velocity", set.velocity.to_string(), allowed));
        }
        let values = state.joint_parameters(house, set.joint);
        let within = values.clamp(set.position);
        if (within - set.position).abs() > AT_STOP * within.abs().max(1.0) {
            let [low, high] = values.limits.unwrap_or([f32::MIN, f32::MAX]);
            let found = format!("{} (limits {low} to {high})", set.position);
            return Err(refuse(
                at(),
                "position",
                found,
                "a place between its limits",
            ));
        }
        Ok(within)
    }

    /// Returns the pose and velocity of a part as those of its body's first part.
    fn root_state(&self, body: &BodyState) -> Result<(PartId, Pose, Velocity), PhysicsError> {
        let house = &self.dynamics.model.house;
        let Some(part) = house.parts.get(body.part) else {
            return Err(PhysicsError::Unmovable {
                what: format!("part {}", body.part.0),
                why: format!("there are {}, counted from 0", house.parts.len()),
            });
        };
        let name = &house.objects[part.object].name;
        let unmovable = |why: String| PhysicsError::Unmovable {
            what: format!("{name:?} (part {:?})", part.name),
            why,
        };
        let Some(index) = self.dynamics.model.body_of_part[body.part] else {
            return Err(unmovable("it is fixed".to_owned()));
        };
        let plan = &self.dynamics.model.bodies[index as usize];
        if let Some(joint) = plan.joint {
            let joint = &house.joints[joint].name;
            return Err(unmovable(format!(
                "the joint {joint:?} moves it; set that one"
            )));
        }
        if self.dynamics.statuses[index as usize] == BodyStatus::Frozen {
            return Err(unmovable(
                "it overlapped something at the start and stands for good".to_owned(),
            ));
        }
        if let Some(grip) = self
            .hands
            .held_objects
            .iter()
            .find(|grip| grip.body == index)
        {
            let holder = grip.agent.index();
            return Err(unmovable(format!("agent {holder} holds it; drop it first")));
        }
        let (pose, velocity) = (body.pose, body.velocity);
        let at = || format!("{name:?}");
        if !pose.is_valid() || pose.position.abs().max_element() > FURTHEST_M {
            return Err(refuse(
                at(),
                "pose",
                format!("{}, {}", pose.position, pose.rotation),
                "finite numbers within 32768 m of the origin and a unit quaternion",
            ));
        }
        let (linear, angular) = (velocity.linear, velocity.angular);
        let slow = linear.abs().max_element() <= FASTEST && angular.abs().max_element() <= FASTEST;
        if !linear.is_finite() || !angular.is_finite() || !slow {
            return Err(refuse(
                at(),
                "velocity",
                format!("{linear} m/s, {angular} rad/s"),
                "finite numbers, at most 1000 m/s and 1000 rad/s along each axis",
            ));
        }
        let root = plan.root();
        if root == body.part {
            return Ok((root, pose, velocity));
        }
        let stands = plan.parts.iter().find(|(part, _)| *part == body.part);
        let body_from_part = stands.map_or(Pose::IDENTITY, |(_, place)| *place);
        let of_root = pose * body_from_part.inverse();
        let arm = of_root.position - pose.position;
        let linear = linear + angular.cross(arm);
        Ok((root, of_root, Velocity { linear, angular }))
    }

    fn wake_bodies_of(&mut self, parts: impl Iterator<Item = PartId>) {
        for part in parts {
            if let Some(body) = self.dynamics.model.body_of_part[part] {
                let handle = self.dynamics.bodies[body as usize].handle;
                self.dynamics.engine.wake(handle);
            }
        }
    }

    /// Returns the mass of the free body that a part belongs to, kg; `None` for what does not move.
    pub fn body_mass_kg(&self, part: PartId) -> Option<f32> {
        let index = (*self.dynamics.model.body_of_part.get(part)?)? as usize;
        let handle = self.dynamics.bodies[index].handle;
        Some(self.dynamics.engine.bodies.get(handle)?.mass())
    }

    /// Returns the motion of a free body as physics has it, by one of its parts; `None` for a body that does not move.
    pub fn body_state(&self, part: PartId) -> Option<BodyState> {
        let index = (*self.dynamics.model.body_of_part.get(part)?)? as usize;
        let rigid = self
            .dynamics
            .engine
            .bodies
            .get(self.dynamics.bodies[index].handle)?;
        let place = self.dynamics.model.bodies[index].parts.iter();
        let (_, body_from_part) = place.clone().find(|(id, _)| *id == part)?;
        let pose = from_rapier(&(*rigid.position() * to_rapier(body_from_part)));
        Some(BodyState {
            part,
            pose,
            velocity: Velocity {
                linear: rigid.velocity_at_point(pose.position),
                angular: rigid.angvel(),
            },
        })
    }
}
