//! Lampshades: their form and their cloth.

use crate::finishes::{Finish, lampshade};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, surface_of_revolution};
use crate::style::Style;

/// A shade open at both ends, thin, around +Y.
pub(super) fn shade_mesh(lower_m: f32, upper_m: f32, height_m: f32) -> SolidMesh {
    const WALL_M: f32 = 0.003;
    let profile = [
        (lower_m - WALL_M, 0.0),
        (lower_m, 0.0),
        (upper_m, height_m),
        (upper_m - WALL_M, height_m),
        (lower_m - WALL_M, 0.0),
    ];
    surface_of_revolution(&profile, 28)
}

/// Natural linen.
const fn linen_shade() -> Finish {
    lampshade("linen_shade", [240, 226, 196])
}

/// The cloth of a lit shade: linen, or a calm tone of the style.
pub(super) fn shade_finish(style: &Style, d: &SizeSampler) -> Finish {
    if d.chance("linen", 0.5) {
        linen_shade()
    } else {
        let tone = style.cloths[d.below("shade", 2)].srgb;
        lampshade("lampshade", tone)
    }
}
