//! Boxes open above: boxes, tubs, drawers, tanks.

use super::{SolidMesh, block};

/// A box of five boards without a lid between two outer corners, `wall_m` thick. It collides as its boards.
pub fn open_top_box(min: [f32; 3], max: [f32; 3], wall_m: f32) -> SolidMesh {
    let ([x0, y0, z0], [x1, y1, z1], t) = (min, max, wall_m);
    [
        block([x0, y0, z0], [x1, y0 + t, z1]),
        block([x0, y0 + t, z0], [x0 + t, y1, z1]),
        block([x1 - t, y0 + t, z0], [x1, y1, z1]),
        block([x0 + t, y0 + t, z0], [x1 - t, y1, z0 + t]),
        block([x0 + t, y0 + t, z1 - t], [x1 - t, y1, z1]),
    ]
    .into_iter()
    .fold(SolidMesh::default(), SolidMesh::merged)
}
