//! The outline of a union of rectangles.

use super::room::PlanRect;

/// The corners of the union of `zones`, (x, z), clockwise seen from above, without those in the middle of an edge. The
/// union must be one piece without holes.
pub(crate) fn outline(zones: &[PlanRect]) -> Vec<[f32; 2]> {
    let lines = [0, 1].map(|axis| {
        let mut lines: Vec<f32> = zones.iter().flat_map(|z| [z[axis], z[axis + 2]]).collect();
        lines.sort_by(f32::total_cmp);
        lines.dedup_by(|a, b| (*a - *b).abs() < 1e-4);
        lines
    });
    let [xs, zs] = &lines;
    let solid = |i: usize, j: usize| {
        if i == 0 || j == 0 || i >= xs.len() || j >= zs.len() {
            return false;
        }
        let (x, z) = (0.5 * (xs[i - 1] + xs[i]), 0.5 * (zs[j - 1] + zs[j]));
        zones
            .iter()
            .any(|zone| (zone[0]..zone[2]).contains(&x) && (zone[1]..zone[3]).contains(&z))
    };
    // Edges between grid points with the solid on the right as one walks, x to the right and z down.
    let mut edges: Vec<([usize; 2], [usize; 2])> = Vec::new();
    for j in 0..=zs.len() {
        for i in 0..=xs.len() {
            if !solid(i, j) {
                continue;
            }
            let (w, e, n, s) = (i - 1, i, j - 1, j);
            if !solid(i, j - 1) {
                edges.push(([w, n], [e, n]));
            }
            if !solid(i + 1, j) {
                edges.push(([e, n], [e, s]));
            }
            if !solid(i, j + 1) {
                edges.push(([e, s], [w, s]));
            }
            if !solid(i - 1, j) {
                edges.push(([w, s], [w, n]));
            }
        }
    }
    let Some(mut edge) = edges.first().copied() else {
        return Vec::new();
    };
    let start = edge.0;
    let mut path = vec![edge.0];
    for _ in 0..edges.len() {
        if edge.1 == start {
            break;
        }
        path.push(edge.1);
        let Some(next) = edges.iter().find(|next| next.0 == edge.1) else {
            break;
        };
        edge = *next;
    }
    let count = path.len();
    let corner = |k: usize| {
        let [a, b, c] = [
            path[(k + count - 1) % count],
            path[k],
            path[(k + 1) % count],
        ];
        (a[0] != b[0] || b[0] != c[0]) && (a[1] != b[1] || b[1] != c[1])
    };
    (0..count)
        .filter(|k| corner(*k))
        .map(|k| [xs[path[k][0]], zs[path[k][1]]])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_has_six_corners_clockwise() {
        let corners = outline(&[[0.0, 0.0, 2.0, 1.0], [0.0, 1.0, 1.0, 3.0]]);
        assert_eq!(
            corners,
            [
                [0.0, 0.0],
                [2.0, 0.0],
                [2.0, 1.0],
                [1.0, 1.0],
                [1.0, 3.0],
                [0.0, 3.0]
            ]
        );
    }
}
