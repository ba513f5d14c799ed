//! Fisheyes: radius by angle, and back.

use dwell_scene::math;
use glam::{Vec2, Vec3};

/// Angles at which the radius is checked to grow.
const CHECKS: u16 = 512;
/// Steps of Newton's method; each halves the bracket where it does not do better.
const STEPS: usize = 40;

/// Focal lengths from the principal point at `angle` rad.
fn radius(k: [f32; 4], angle: f64) -> f64 {
    let square = angle * angle;
    let [k1, k2, k3, k4] = k.map(f64::from);
    angle * (1.0 + square * (k1 + square * (k2 + square * (k3 + square * k4))))
}

/// The derivative of [`radius`] by the angle.
fn slope(k: [f32; 4], angle: f64) -> f64 {
    let square = angle * angle;
    let [k1, k2, k3, k4] = k.map(f64::from);
    1.0 + square * (3.0 * k1 + square * (5.0 * k2 + square * (7.0 * k3 + square * 9.0 * k4)))
}

/// The first angle up to `most` rad at which the radius does not grow.
pub(super) fn max_injective_angle(k: [f32; 4], most: f32) -> Option<f64> {
    (1..=CHECKS)
        .map(|step| f64::from(most) * f64::from(step) / f64::from(CHECKS))
        .find(|angle| slope(k, *angle) <= 0.0)
}

/// The angle with this radius, rad; `None` beyond `most`.
fn angle(k: [f32; 4], wanted: f64, most: f64) -> Option<f64> {
    if wanted > radius(k, most) {
        return None;
    }
    if k == [0.0; 4] {
        return Some(wanted);
    }
    let (mut low, mut high) = (0.0, most);
    let mut at = wanted.min(most);
    for _ in 0..STEPS {
        let error = radius(k, at) - wanted;
        if error > 0.0 {
            high = at;
        } else {
            low = at;
        }
        let next = at - error / slope(k, at);
        let next = if next > low && next < high {
            next
        } else {
            0.5 * (low + high)
        };
        if (next - at).abs() < 1e-12 {
            return Some(next);
        }
        at = next;
    }
    Some(at)
}

/// The unit direction in the camera's frame of a point `at` (focal lengths from the principal point, y down); zero beyond
/// `half_angle` rad.
pub(super) fn direction(at: Vec2, k: [f32; 4], half_angle: f32) -> Vec3 {
    let (x, y) = (f64::from(at.x), f64::from(at.y));
    let wanted = (x * x + y * y).sqrt();
    let Some(angle) = angle(k, wanted, f64::from(half_angle)) else {
        return Vec3::ZERO;
    };
    let (sine, cosine) = math::sin_cos(angle as f32);
    let across = if wanted > 1e-12 {
        f64::from(sine) / wanted
    } else {
        1.0
    };
    Vec3::new((x * across) as f32, (-y * across) as f32, -cosine)
}

/// Returns the image of a point in the camera's frame, focal lengths from the principal point, y down.
pub(super) fn project(point: Vec3, k: [f32; 4], half_angle: f32) -> Option<Vec2> {
    let across = point.truncate().length();
    let angle = math::atan2(across, -point.z);
    // Beyond the square root of the largest number there is no length.
    if angle > half_angle || point == Vec3::ZERO || !across.is_finite() {
        return None;
    }
    let scale = if across > 0.0 {
        radius(k, f64::from(angle)) as f32 / across
    } else {
        0.0
    };
    Some(Vec2::new(point.x, -point.y) * scale)
}
