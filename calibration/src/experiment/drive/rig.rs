//! The simulation of a robot on an empty floor.

use super::recording::{NominalWheelGeometry, wrap_angle};
use crate::error::CalibrationError;
use dwell_physics::{AgentControl, PhysicsConfig, PhysicsWorld};
use dwell_scene::{
    AgentBody, AgentId, AgentState, DifferentialDrive, House, LawSpec, Locomotion,
    ShoeboxMaterials, State,
};
use glam::Vec3;
use std::sync::Arc;

/// Edge of the room, m: the robot starts in the middle of it.
const ROOM_M: f32 = 16.0;
/// Wheels reach their commanded positions at once: their motion is measured.
const AT_ONCE_RAD_S2: f32 = 1e6;
const FASTEST_RAD_S: f32 = 1000.0;
/// Radius and height of the robot's body, m; nothing is in its way.
const BODY_M: [f32; 2] = [0.1, 0.25];

/// A robot in an empty room, ready to be driven.
pub(super) struct DriveRig {
    world: PhysicsWorld,
    state: State,
    robot: AgentId,
}

impl DriveRig {
    /// The robot with `laws`, in a world with a step between two samples: the base follows exact arcs.
    pub(super) fn new(
        base: &NominalWheelGeometry,
        rate_hz: f64,
        laws: Vec<LawSpec>,
    ) -> Result<Self, CalibrationError> {
        let fault =
            |error: &dyn std::fmt::Display| CalibrationError::simulation("the robot", error);
        let room = House::shoebox([ROOM_M, 3.0, ROOM_M], &ShoeboxMaterials::default())
            .map_err(|e| fault(&e))?;
        let house = Arc::new(room);
        let config = PhysicsConfig {
            control_rate_hz: rate_hz as f32,
            physics_rate_hz: rate_hz as f32,
            ..PhysicsConfig::default()
        };
        let mut state = State::new(&house);
        let (mut world, _) = PhysicsWorld::new(house, config, &mut state).map_err(|e| fault(&e))?;
        let radius = base.wheel_radius_m as f32;
        let drive = DifferentialDrive {
            wheel_base_m: base.wheel_base_m as f32,
            left_wheel_radius_m: radius,
            right_wheel_radius_m: radius,
            max_wheel_speed_rad_s: FASTEST_RAD_S,
            max_wheel_acceleration_rad_s2: AT_ONCE_RAD_S2,
        };
        let body = AgentBody {
            radius_m: BODY_M[0],
            height_m: BODY_M[1],
            eye_height_m: BODY_M[1],
            locomotion: Locomotion::DifferentialDrive(drive),
            ..AgentBody::default()
        };
        let middle = Vec3::new(0.5 * ROOM_M, 0.0, 0.5 * ROOM_M);
        let robot = world
            .add_agent(&mut state, AgentState::new(body, middle, 0.0))
            .map_err(|e| fault(&e))?;
        state.laws = laws;
        world.apply_parameters(&mut state).map_err(|e| fault(&e))?;
        Ok(Self {
            world,
            state,
            robot,
        })
    }

    /// The way that the robot makes while its wheels turn so far from sample to sample (rad): places from its start on, the
    /// start first, with x forward and y to the left there (m) and the heading (rad, not wrapped).
    pub(super) fn simulated_path(
        &self,
        turned_rad: &[[f64; 2]],
        rate_hz: f64,
    ) -> Result<Vec<[f64; 3]>, CalibrationError> {
        let (mut world, mut state) = (self.world.clone(), self.state.clone());
        let start = state.agents[self.robot].position;
        let mut heading = 0.0;
        let mut last_yaw = f64::from(state.agents[self.robot].yaw_rad);
        let mut way = Vec::with_capacity(turned_rad.len() + 1);
        way.push([0.0; 3]);
        let mut events = Vec::new();
        for turned in turned_rad {
            let control = AgentControl {
                wheel_rad_s: Some(turned.map(|rad| (rad * rate_hz) as f32)),
                ..AgentControl::default()
            };
            events.clear();
            world
                .step(&mut state, &[control], &mut events)
                .map_err(|error| CalibrationError::simulation("a step of the robot", error))?;
            let agent = &state.agents[self.robot];
            let yaw = f64::from(agent.yaw_rad);
            heading += wrap_angle(yaw - last_yaw);
            last_yaw = yaw;
            let moved = agent.position - start;
            way.push([-f64::from(moved.z), -f64::from(moved.x), heading]);
        }
        Ok(way)
    }
}
