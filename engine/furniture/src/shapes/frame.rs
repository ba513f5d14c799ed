//! Rectangular frames: of pictures, windows, doors.

use super::{SolidMesh, block};

/// A frame in the (x, y) plane around the origin with mitre-free corners: outer `width_m` by `height_m`, bars `bar_m` wide,
/// from z = 0 to `depth_m`. It collides as its four bars.
pub fn frame(width_m: f32, height_m: f32, bar_m: f32, depth_m: f32) -> SolidMesh {
    let (x, y) = (width_m * 0.5, height_m * 0.5);
    let bars = [
        ([-x, -y, 0.0], [-x + bar_m, y, depth_m]),
        ([x - bar_m, -y, 0.0], [x, y, depth_m]),
        ([-x + bar_m, -y, 0.0], [x - bar_m, -y + bar_m, depth_m]),
        ([-x + bar_m, y - bar_m, 0.0], [x - bar_m, y, depth_m]),
    ];
    bars.into_iter()
        .map(|(min, max)| block(min, max))
        .fold(SolidMesh::default(), SolidMesh::merged)
}
