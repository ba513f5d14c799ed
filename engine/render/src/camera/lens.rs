//! Brown's lens: the distortion of a ray, and its inverse.

use glam::{DVec2, Vec2};

/// Largest coefficient of a lens.
pub(super) const MAX_COEFFICIENT: f32 = 100.0;
/// Steps of Newton's method.
const STEPS: usize = 30;
/// Rings on which the radius is checked to grow.
const RINGS: u8 = 24;

/// Radial k1, k2, k3 and tangential p1, p2.
pub(super) type Lens = [f32; 5];

/// Returns the distorted point of a point of the plane at depth 1, y down, with the derivatives by x and by y.
fn distort_with_jacobian(lens: Lens, p: DVec2) -> (DVec2, DVec2, DVec2) {
    let [k1, k2, k3, p1, p2] = lens.map(f64::from);
    let DVec2 { x, y } = p;
    let r2 = p.length_squared();
    let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    // By r².
    let slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);
    let bent = DVec2::new(
        x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
        y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
    );
    let mixed = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
    let by_x = DVec2::new(
        radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x,
        mixed,
    );
    let by_y = DVec2::new(
        mixed,
        radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x,
    );
    (bent, by_x, by_y)
}

/// Returns whether the picture still grows outwards everywhere up to a point: further out the lens folds it back.
fn is_before_fold(lens: Lens, p: DVec2) -> bool {
    (1..=RINGS).all(|ring| {
        let (_, by_x, by_y) = distort_with_jacobian(lens, p * (f64::from(ring) / f64::from(RINGS)));
        by_x.perp_dot(by_y) > 0.0 && by_x.x + by_y.y > 0.0
    })
}

/// Returns the distorted point of a point of the plane at depth 1; `None` beyond its fold.
pub(super) fn distort(lens: Lens, p: Vec2) -> Option<Vec2> {
    let p = p.as_dvec2();
    is_before_fold(lens, p).then(|| distort_with_jacobian(lens, p).0.as_vec2())
}

/// The point of the plane at depth 1 that the lens maps to `seen`; `None` where there is none before the fold.
pub(super) fn undistort(lens: Lens, seen: Vec2) -> Option<Vec2> {
    let seen = seen.as_dvec2();
    let mut p = seen;
    for _ in 0..STEPS {
        let (bent, by_x, by_y) = distort_with_jacobian(lens, p);
        let error = bent - seen;
        let area = by_x.perp_dot(by_y);
        if area.abs() < 1e-12 || !p.is_finite() {
            return None;
        }
        // Cramer's rule.
        let step = DVec2::new(error.perp_dot(by_y), by_x.perp_dot(error)) / area;
        p -= step;
        if step.length_squared() < 1e-24 {
            return is_before_fold(lens, p).then(|| p.as_vec2());
        }
    }
    None
}
