//! Footfalls of walking agents.

use dwell_scene::math::wrap_angle;
use dwell_scene::person::WALK_RATIO;
use dwell_scene::{AgentState, Locomotion};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A turn on the spot that takes a step, rad.
const TURN_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Speed of the feet in a turn on the spot, m/s.
const TURN_M_S: f32 = 0.4;
/// Half the distance between the feet, m, of a body 1.7 m high.
const SIDE_M: f32 = 0.08;
/// Speed below which nobody walks, m/s.
const SLOWEST_M_S: f32 = 0.02;

/// The mass of a person of a height, kg: body mass index 22.
pub(super) fn body_mass_kg(height_m: f32) -> f32 {
    22.0 * height_m * height_m
}

/// The phase of an agent's gait.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct GaitPhase {
    /// Of the step that is made, 0 to 1.
    phase: f32,
    /// True if the left foot comes down next.
    left: bool,
}

impl Default for GaitPhase {
    fn default() -> Self {
        Self {
            phase: STANDING,
            left: false,
        }
    }
}

/// The phase while standing: walking begins with half a step.
const STANDING: f32 = 0.5;

/// The events of an agent's feet or wheels in a control step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FootEvent {
    /// A foot comes down.
    Step {
        /// From the beginning of the control step, s.
        late_s: f64,
        /// Walking speed, m/s.
        speed_m_s: f32,
        /// The time from step to step, s.
        period_s: f32,
        /// Lateral offset of the foot, m, positive to the left.
        side_m: f32,
    },
    /// It rolls.
    Wheels {
        /// m/s.
        speed_m_s: f32,
    },
}

impl GaitPhase {
    /// Advances from the agent's `feet` and `yaw_rad` of a control step ago.
    pub(super) fn advance(
        &mut self,
        agent: &AgentState,
        feet: Vec3,
        yaw_rad: f32,
        step_s: f64,
    ) -> Option<FootEvent> {
        let way = agent.position - feet;
        let speed_m_s = Vec3::new(way.x, 0.0, way.z).length() / step_s as f32;
        if !agent.grounded {
            return None;
        }
        if !matches!(agent.body.locomotion, Locomotion::Walking(_)) {
            return (speed_m_s > SLOWEST_M_S).then_some(FootEvent::Wheels { speed_m_s });
        }
        let height = agent.body.height_m / 1.7;
        let length_m = (WALK_RATIO * speed_m_s).sqrt() * height;
        let turn = wrap_angle(agent.yaw_rad - yaw_rad).abs() / TURN_RAD;
        let walk = if speed_m_s > SLOWEST_M_S {
            speed_m_s * step_s as f32 / length_m
        } else {
            0.0
        };
        // Curves cost no further steps.
        let steps = walk.max(turn);
        if steps < 1e-4 {
            self.phase = STANDING;
            return None;
        }
        let before = self.phase;
        self.phase += steps;
        if self.phase < 1.0 {
            return None;
        }
        let late_s = f64::from((1.0 - before) / steps) * step_s;
        // Nobody makes more than one step in a control step worth hearing.
        self.phase -= self.phase.floor();
        let side_m = if self.left { SIDE_M } else { -SIDE_M } * height;
        self.left = !self.left;
        Some(FootEvent::Step {
            late_s,
            speed_m_s: speed_m_s.max(TURN_M_S),
            period_s: (step_s as f32 / steps).min(2.0),
            side_m,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::AgentBody;

    fn steps(speed_m_s: f32, yaw_rate_rad_s: f32, seconds: f32) -> Vec<(f64, f32)> {
        let (mut gait, step_s) = (GaitPhase::default(), 0.05);
        let body = AgentBody {
            height_m: 1.7,
            ..AgentBody::default()
        };
        let mut agent = AgentState::new(body, Vec3::ZERO, 0.0);
        let mut heard = Vec::new();
        for k in 0..(seconds * 20.0) as usize {
            let before = (agent.position, agent.yaw_rad);
            agent.position.z -= speed_m_s * 0.05;
            agent.yaw_rad = wrap_angle(agent.yaw_rad + yaw_rate_rad_s * 0.05);
            match gait.advance(&agent, before.0, before.1, step_s) {
                Some(FootEvent::Step { late_s, side_m, .. }) => {
                    heard.push((k as f64 * step_s + late_s, side_m));
                }
                Some(FootEvent::Wheels { .. }) => panic!("legs have no wheels"),
                None => {}
            }
        }
        heard
    }

    /// 1.3 m/s: steps of 0.71 m, 1.83 a second; left and right in turn, evenly.
    #[test]
    fn a_walker_makes_as_many_steps_as_walkers_do() {
        let heard = steps(1.3, 0.0, 20.0);
        assert!(
            (heard.len() as f32 / 20.0 - 1.826).abs() < 0.06,
            "{}",
            heard.len()
        );
        for pair in heard.windows(2) {
            assert!((pair[1].0 - pair[0].0 - 0.5477).abs() < 0.002);
            assert_eq!(pair[0].1, -pair[1].1);
        }
        assert!(steps(2.6, 0.0, 20.0).len() > heard.len());
        assert!(steps(0.0, 0.0, 20.0).is_empty());
        // A full turn on the spot takes eight.
        assert_eq!(steps(0.0, 1.0, std::f32::consts::TAU + 0.1).len(), 8);
    }
}
