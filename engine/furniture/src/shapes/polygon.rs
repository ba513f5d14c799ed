//! Triangles of a simple polygon.

use glam::DVec2;

/// Triangles, as indices, that fill a simple polygon (ear clipping); they turn as the polygon turns when counter-clockwise,
/// the other way round otherwise, so that all are counter-clockwise. What crosses itself is filled as far as ears are found.
///
/// # Source
/// G. H. Meisters, American Mathematical Monthly 82, 648 (1975): every simple polygon has two ears.
pub fn triangulate(points: &[DVec2]) -> Vec<[usize; 3]> {
    let turn =
        |a: usize, b: usize, c: usize| (points[b] - points[a]).perp_dot(points[c] - points[a]);
    let area: f64 = (0..points.len())
        .map(|k| points[k].perp_dot(points[(k + 1) % points.len()]))
        .sum();
    let mut left: Vec<usize> = (0..points.len()).collect();
    if area < 0.0 {
        left.reverse();
    }
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let count = left.len();
        let around = |k: usize| {
            [
                left[(k + count - 1) % count],
                left[k],
                left[(k + 1) % count],
            ]
        };
        let is_ear = |k: usize| {
            let [a, b, c] = around(k);
            let holds =
                |p: usize| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            turn(a, b, c) > 0.0 && left.iter().all(|p| [a, b, c].contains(p) || !holds(*p))
        };
        // Corners on a straight line and leftovers of a crossing have no area: they go without a triangle.
        let flat = |k: usize| {
            let [a, b, c] = around(k);
            turn(a, b, c).abs() < 1e-12
        };
        if let Some(ear) = (0..count).find(|k| is_ear(*k)) {
            triangles.push(around(ear));
            left.remove(ear);
        } else if let Some(corner) = (0..count).find(|k| flat(*k)) {
            left.remove(corner);
        } else {
            return triangles;
        }
    }
    if let [a, b, c] = left[..]
        && turn(a, b, c) > 0.0
    {
        triangles.push([a, b, c]);
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[DVec2]) -> f64 {
        triangulate(points)
            .iter()
            .map(|[a, b, c]| (points[*b] - points[*a]).perp_dot(points[*c] - points[*a]) / 2.0)
            .sum()
    }

    #[test]
    fn concave_outlines_are_filled_exactly_in_either_direction() {
        let mut shape: Vec<DVec2> = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ]
        .map(DVec2::from)
        .to_vec();
        assert!((area(&shape) - 10.0).abs() < 1e-12);
        shape.reverse();
        assert!((area(&shape) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn outlines_that_are_none_end() {
        let bow = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)].map(DVec2::from);
        triangulate(&bow);
        assert!(triangulate(&[DVec2::ZERO; 9]).is_empty());
        // A corner on a straight edge.
        let straight = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1.0)].map(DVec2::from);
        assert!((area(&straight) - 1.0).abs() < 1e-12);
    }
}
