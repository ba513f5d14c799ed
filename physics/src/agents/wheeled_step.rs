//! One physics step of an agent on wheels.

use super::AgentControl;
use crate::bases::{
    PlanarPose, PlanarTwist, WheelCommand, WheelGeometry, WheelMotion, follow_twist, ramp,
};
use dwell_scene::{AgentState, DifferentialDrive, Locomotion, math};
use glam::Vec3;

/// The displacement of a base in one physics step if nothing stops it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BaseMotion {
    /// m, horizontal.
    pub(crate) displacement: Vec3,
    /// rad to the left.
    pub(crate) turn_rad: f32,
    /// Slip velocity over the ground if its wheels touched it now, level, m/s.
    pub(crate) slips_m_s: Vec3,
}

/// Advances the wheels for one physics step, counts their rotation, and returns the body's motion. `truth`: the base's true
/// parameters in this world; `laws` may change how the wheels roll. `None` for an agent on legs.
pub(crate) fn drive(
    agent: &mut AgentState,
    truth: &Locomotion,
    control: &AgentControl,
    laws: impl FnOnce(&mut WheelMotion),
    dt_s: f32,
) -> Option<BaseMotion> {
    let seconds = f64::from(dt_s);
    let (believed, true_twist) = match (agent.body.locomotion, truth) {
        (Locomotion::DifferentialDrive(nominal), Locomotion::DifferentialDrive(truth)) => {
            let mut rolling = accelerate_wheels(agent, &nominal, truth, control, seconds);
            for side in 0..2 {
                agent.base.wheel_rotation_rad[side] += rolling.rate_rad_s[side] * seconds;
            }
            let believed = WheelGeometry::from(&nominal).twist(rolling.rate_rad_s);
            agent.base.twist = to_f32_array(&believed);
            laws(&mut rolling);
            (believed, rolling.twist())
        }
        (Locomotion::Holonomic(_), Locomotion::Holonomic(truth)) => {
            let wanted = PlanarTwist {
                forward_m_s: f64::from(control.forward_m_s),
                left_m_s: -f64::from(control.right_m_s),
                yaw_rate_rad_s: f64::from(control.yaw_rate_rad_s),
            };
            let [forward_m_s, left_m_s, yaw_rate_rad_s] = agent.base.twist.map(f64::from);
            let now = PlanarTwist {
                forward_m_s,
                left_m_s,
                yaw_rate_rad_s,
            };
            let (end, mean) = follow_twist(truth, now, wanted, seconds);
            agent.base.twist = to_f32_array(&end);
            (mean, mean)
        }
        _ => return None,
    };
    let odometry = PlanarPose::from_array(agent.base.odometry).integrated(&believed, seconds);
    agent.base.odometry = odometry.to_array();
    let here = PlanarPose {
        heading_rad: f64::from(agent.yaw_rad),
        ..PlanarPose::default()
    };
    let there = here.integrated(&true_twist, seconds);
    if !agent.grounded {
        let level = Vec3::new(agent.velocity.x, 0.0, agent.velocity.z);
        agent.base.rounding_remainder = [0.0; 3];
        return Some(BaseMotion {
            displacement: level * dt_s,
            turn_rad: 0.0,
            slips_m_s: level - there.displacement() / dt_s,
        });
    }
    if true_twist == PlanarTwist::default() {
        return Some(BaseMotion::default());
    }
    let [x, z, yaw] = agent.base.rounding_remainder;
    Some(BaseMotion {
        displacement: there.displacement() + Vec3::new(x, 0.0, z),
        turn_rad: (there.heading_rad - here.heading_rad) as f32 + yaw,
        slips_m_s: Vec3::ZERO,
    })
}

fn to_f32_array(twist: &PlanarTwist) -> [f32; 3] {
    [twist.forward_m_s, twist.left_m_s, twist.yaw_rate_rad_s].map(|value| value as f32)
}

/// Accelerates both wheels towards their commands.
fn accelerate_wheels(
    agent: &mut AgentState,
    nominal: &DifferentialDrive,
    truth: &DifferentialDrive,
    control: &AgentControl,
    dt_s: f64,
) -> WheelMotion {
    let fastest = f64::from(truth.max_wheel_speed_rad_s);
    let WheelCommand(told) = match control.wheel_rad_s {
        Some(rates) => WheelCommand(rates.map(f64::from)),
        None => WheelCommand::from_twist(
            &WheelGeometry::from(nominal),
            f64::from(control.forward_m_s),
            f64::from(control.yaw_rate_rad_s),
            fastest,
        ),
    };
    let mut rolling = WheelMotion {
        wheels: WheelGeometry::from(truth),
        rate_rad_s: [0.0; 2],
        acceleration_rad_s2: [0.0; 2],
        slip_ratio: [0.0; 2],
    };
    let most = f64::from(truth.max_wheel_acceleration_rad_s2);
    for (side, told) in told.into_iter().enumerate() {
        let now = f64::from(agent.base.wheel_rad_s[side]);
        let (end, mean) = ramp(now, told.clamp(-fastest, fastest), most, dt_s);
        agent.base.wheel_rad_s[side] = end as f32;
        rolling.rate_rad_s[side] = mean;
        rolling.acceleration_rad_s2[side] = (end - now) / dt_s;
    }
    rolling
}

impl BaseMotion {
    /// Turns the agent, and keeps the rounding remainder.
    pub(crate) fn turn(&self, agent: &mut AgentState) {
        if self.turn_rad == 0.0 {
            return;
        }
        let yaw = agent.yaw_rad + self.turn_rad;
        agent.base.rounding_remainder[2] = self.turn_rad - (yaw - agent.yaw_rad);
        agent.yaw_rad = math::wrap_angle(yaw);
    }

    /// Keeps the rounding remainder of a displacement that nothing stopped.
    pub(crate) fn store_rounding_remainder(&self, agent: &mut AgentState, before: Vec3) {
        if self.displacement == Vec3::ZERO {
            return;
        }
        let rest = self.displacement - (agent.position - before);
        let (x, z) = if rest.x.abs() < 1e-6 && rest.z.abs() < 1e-6 {
            (rest.x, rest.z)
        } else {
            (0.0, 0.0)
        };
        agent.base.rounding_remainder[0] = x;
        agent.base.rounding_remainder[1] = z;
    }
}
