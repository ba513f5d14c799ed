//! The distance between triangles.

use glam::Vec3;

/// Returns whether two triangles come within `gap_m` of each other, or intersect.
///
/// # Source
/// C. Ericson, *Real-Time Collision Detection*, Morgan Kaufmann 2005, sections 5.1.5, 5.1.9 and 5.1.10.
pub(super) fn are_within(p: &[Vec3; 3], q: &[Vec3; 3], gap_m: f32) -> bool {
    let gap2 = gap_m * gap_m;
    let edges = |t: &[Vec3; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let near_corner = |corners: &[Vec3; 3], triangle: &[Vec3; 3]| {
        let mut corners = corners.iter();
        corners.any(|point| nearest_on_triangle(triangle, *point).distance_squared(*point) <= gap2)
    };
    near_corner(p, q)
        || near_corner(q, p)
        || edges(p).iter().any(|[a, b]| {
            cuts(*a, *b, q)
                || edges(q)
                    .iter()
                    .any(|[c, d]| segments_distance2(*a, *b, *c, *d) <= gap2)
        })
        || edges(q).iter().any(|[a, b]| cuts(*a, *b, p))
}

/// The point of a triangle that is nearest to `p`.
fn nearest_on_triangle([a, b, c]: &[Vec3; 3], p: Vec3) -> Vec3 {
    let (ab, ac, ap) = (*b - *a, *c - *a, p - *a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - *b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return *a + ab * (d1 / (d1 - d3));
    }
    let cp = p - *c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return *a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return *b + (*c - *b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    *a + ab * (vb * scale) + ac * (vc * scale)
}

/// The square of the distance between the segments from `a` to `b` and from `c` to `d`, m².
fn segments_distance2(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f32 {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, vv, uv) = (u.dot(u), v.dot(v), u.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    let parallel = uu * vv - uv * uv;
    let on_first = |t: f32| {
        if uu > 0.0 {
            ((uv * t - uw) / uu).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let on_second = |s: f32| if vv > 0.0 { (uv * s + vw) / vv } else { 0.0 };
    let mut s = if parallel > 1e-12 * uu * vv {
        ((uv * vw - uw * vv) / parallel).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let mut t = on_second(s);
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = on_first(t);
    }
    (a + u * s).distance_squared(c + v * t)
}

/// Returns whether the segment from `a` to `b` passes through the triangle.
fn cuts(a: Vec3, b: Vec3, [p, q, r]: &[Vec3; 3]) -> bool {
    let (pq, pr, way) = (*q - *p, *r - *p, b - a);
    let side = way.cross(pr);
    let determinant = pq.dot(side);
    if determinant == 0.0 {
        return false;
    }
    let offset = a - *p;
    let u = offset.dot(side) / determinant;
    let across = offset.cross(pq);
    let v = way.dot(across) / determinant;
    let t = pr.dot(across) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Compares with the least distance between points sampled in both.
    #[test]
    fn distances_agree_with_sampling() {
        let mut stream = RandomKey::root(3).stream();
        let mut point = |x: f32| {
            let mut axis = || stream.range(-1.0, 1.0);
            Vec3::new(x + axis(), axis(), axis())
        };
        let samples = |t: &[Vec3; 3]| -> Vec<Vec3> {
            let n = 24;
            let pairs = (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i, j)));
            pairs
                .map(|(i, j)| {
                    let (u, v) = (i as f32 / n as f32, j as f32 / n as f32);
                    t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v
                })
                .collect()
        };
        let mut decided = [0, 0];
        for k in 0..200 {
            let x = 0.01 * k as f32;
            let (p, q) = (
                [point(0.0), point(0.0), point(0.0)],
                [point(x), point(x), point(x)],
            );
            let (u, v) = (samples(&p), samples(&q));
            let pairs = u.iter().flat_map(|a| v.iter().map(|b| a.distance(*b)));
            let sampled = pairs.fold(f32::INFINITY, f32::min);
            let within = are_within(&p, &q, 0.2);
            // Samples lie up to some 0.1 apart.
            if sampled <= 0.2 {
                assert!(within, "{k}: {sampled}");
                decided[0] += 1;
            }
            if sampled > 0.32 {
                assert!(!within, "{k}: {sampled}");
                decided[1] += 1;
            }
        }
        assert!(decided.iter().all(|count| *count > 30), "{decided:?}");
    }
}
