//! Elementary functions with the same bits on every machine.
//!
//! The standard library leaves `sin` and the like to the platform. Whatever enters a state, a sound or a picture uses these
//! instead (`libm`, a port of musl's).

/// Sine of an angle in radians.
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine of an angle in radians.
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Sine and cosine of an angle in radians.
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// Tangent of an angle in radians.
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// Angle of the point `(x, y)`, radians in (-pi, pi].
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Arc sine, radians; the argument is clamped to [-1, 1].
pub fn asin(x: f32) -> f32 {
    libm::asinf(x.clamp(-1.0, 1.0))
}

/// Arc cosine, radians; the argument is clamped to [-1, 1].
pub fn acos(x: f32) -> f32 {
    libm::acosf(x.clamp(-1.0, 1.0))
}

/// Natural exponential.
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm.
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Natural logarithm of 1 + x, exact near 0.
pub fn ln_1p(x: f32) -> f32 {
    libm::log1pf(x)
}

/// Power.
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// The angle equal to `angle_rad` modulo a full turn, in (-pi, pi].
pub fn wrap_angle(angle_rad: f32) -> f32 {
    use std::f32::consts::{PI, TAU};
    let wrapped = angle_rad - TAU * (angle_rad / TAU).round();
    if wrapped <= -PI {
        wrapped + TAU
    } else {
        wrapped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    #[test]
    fn wrapped_angles_lie_in_half_open_turn_and_keep_their_direction() {
        for k in -2000..2000 {
            let angle = k as f32 * 0.01;
            let wrapped = wrap_angle(angle);
            assert!(
                wrapped > -PI - 1e-6 && wrapped <= PI + 1e-6,
                "{angle} -> {wrapped}"
            );
            assert!(
                (sin(angle) - sin(wrapped)).abs() < 1e-4
                    && (cos(angle) - cos(wrapped)).abs() < 1e-4
            );
        }
    }
}
