//! Holonomic base: moves in any direction.

use super::PlanarTwist;
use dwell_scene::HolonomicBase;

/// Returns the twist after a step towards `wanted`, and the mean over the step. The velocity changes along a straight line,
/// independently of the yaw rate.
pub(crate) fn accelerate_towards(
    base: &HolonomicBase,
    now: PlanarTwist,
    wanted: PlanarTwist,
    dt_s: f64,
) -> (PlanarTwist, PlanarTwist) {
    let within = |value: f64, most: f32| value.clamp(-f64::from(most), f64::from(most));
    let goal = (
        within(wanted.forward_m_s, base.max_forward_m_s),
        within(wanted.left_m_s, base.max_sideways_m_s),
    );
    let change = (goal.0 - now.forward_m_s, goal.1 - now.left_m_s);
    let length = libm::hypot(change.0, change.1);
    let acceleration = f64::from(base.max_acceleration_m_s2);
    let (end, mean) = if length > 0.0 {
        super::differential::ramp(0.0, length, acceleration, dt_s)
    } else {
        (0.0, 0.0)
    };
    let along = |part: f64| {
        let share = if length > 0.0 { part / length } else { 0.0 };
        (
            now.forward_m_s + change.0 * share,
            now.left_m_s + change.1 * share,
        )
    };
    let (yaw_end, yaw_mean) = super::differential::ramp(
        now.yaw_rate_rad_s,
        within(wanted.yaw_rate_rad_s, base.max_yaw_rate_rad_s),
        f64::from(base.max_yaw_acceleration_rad_s2),
        dt_s,
    );
    let twist = |(forward_m_s, left_m_s), yaw_rate_rad_s| PlanarTwist {
        forward_m_s,
        left_m_s,
        yaw_rate_rad_s,
    };
    let reached = end >= length;
    let last = if reached { goal } else { along(end) };
    (twist(last, yaw_end), twist(along(mean), yaw_mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twist_is_reached_along_a_straight_line_within_its_limits() {
        let base = HolonomicBase::default();
        let wanted = PlanarTwist {
            forward_m_s: 0.6,
            left_m_s: -5.0,
            yaw_rate_rad_s: 9.0,
        };
        let mut now = PlanarTwist::default();
        for k in 1..=100 {
            (now, _) = accelerate_towards(&base, now, wanted, 0.01);
            let t = f64::from(k) * 0.01;
            let speed = now.forward_m_s.hypot(now.left_m_s);
            assert!(
                (speed - (2.0 * t).min(0.6_f64.hypot(1.0))).abs() < 1e-9,
                "{t}"
            );
            assert!((now.left_m_s * 0.6 + now.forward_m_s).abs() < 1e-9);
            assert!((now.yaw_rate_rad_s - (4.0 * t).min(2.0)).abs() < 1e-9);
        }
        assert_eq!((now.forward_m_s, now.left_m_s), (0.6, -1.0));
    }
}
