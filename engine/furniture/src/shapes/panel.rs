//! Flat boxes whose front shows one whole picture.

use super::{SolidMesh, block};
use glam::Vec2;

/// A box in front of the (x, y) plane, its lower edge on y = 0, centred in x; texture coordinates of every face run from 0
/// to 1, so that the front (+Z) shows the whole image upright.
pub fn panel(width_m: f32, height_m: f32, depth_m: f32) -> SolidMesh {
    let mut solid = block(
        [-0.5 * width_m, 0.0, 0.0],
        [0.5 * width_m, height_m, depth_m],
    );
    for (position, uv) in solid.mesh.positions.iter().zip(&mut solid.mesh.uvs) {
        *uv = Vec2::new(position.x / width_m + 0.5, position.y / height_m);
    }
    solid
}
