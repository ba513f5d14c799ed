//! Triangles of a simple polygon.

use earcut::Earcut;
use glam::DVec2;

/// Triangles, as indices, that fill a simple polygon, convex or not; they turn as the polygon turns when counter-clockwise,
/// the other way round otherwise, so that all are counter-clockwise. What crosses itself is filled as far as ears are found; a
/// polygon with a coordinate that is not finite has no triangles.
///
/// # Source
/// G. H. Meisters, American Mathematical Monthly 82, 648 (1975): every simple polygon has two ears. They are found by Mapbox's
/// earcut.
pub fn triangulate(points: &[DVec2]) -> Vec<[usize; 3]> {
    if !points.iter().all(|p| p.is_finite()) {
        return Vec::new();
    }
    let mut corners: Vec<usize> = Vec::new();
    Earcut::new().earcut(points.iter().map(DVec2::to_array), &[], &mut corners);
    corners.as_chunks().0.to_vec()
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
