//! How entries of the catalogue draw sizes and looks of the models that take them as arguments.

pub(crate) mod bath;
pub(crate) mod kitchen;
pub(crate) mod living;
pub(crate) mod sleeping;
pub(crate) mod small;
pub(crate) mod walls;

use super::style::Style;
use crate::finishes::{Finish, lampshade};
use crate::model::Model;
use crate::models::lamps::linen_shade;
use crate::models::taps::mixer_tap;
use crate::sampling::SizeSampler;
use crate::shapes::turn;
use dwell_scene::Pose;
use glam::Vec3;

/// A lit shade in a calm tone of the style.
fn shade(style: &Style, d: &SizeSampler) -> Finish {
    if d.chance("linen", 0.5) {
        linen_shade()
    } else {
        let tone = style.cloths[d.below("shade", 2)].srgb;
        lampshade("lampshade", tone)
    }
}

/// A mixer tap of `sizes_m` (height, reach) on the point `at` of a basin, its spout turned to the left by `turn_rad`.
fn tapped(
    basin: Model,
    style: &Style,
    d: &SizeSampler,
    sizes_m: [f32; 2],
    at: [f32; 3],
    turn_rad: f32,
) -> Model {
    let [height, reach] = sizes_m;
    let mut tap = mixer_tap(height, reach);
    if d.chance("metal_tap", 0.3) {
        let metal = Finish {
            name: "tap_metal",
            substance: "chrome",
            ..style.metal.clone()
        };
        tap = tap.repainted("chrome", &metal);
    }
    let pose = Pose::new(at.into(), turn(Vec3::Y, turn_rad));
    basin.mounting(tap, "tap", &pose)
}
