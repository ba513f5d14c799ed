//! Taps: a spout with a lever that turns the water on.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, chrome};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{axis_rotation, cylinder, rod, tube};
use crate::style::Style;
use dwell_scene::Pose;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "mixer_tap",
    "tap",
    52,
    sample_mixer_tap,
)];

/// Angle of the lever from off to full, rad.
const TURN_RAD: f32 = 0.9;

/// A mixer tap that stands on a rim, its spout towards +Z, its lever upright on the right; the lever comes forward.
fn mixer_tap(height_m: f32, reach_m: f32) -> Model {
    let (h, reach) = (height_m, reach_m);
    let spout = [
        [0.0, 0.0, 0.0],
        [0.0, 0.8 * h, 0.0],
        [0.0, 0.96 * h, 0.18 * reach],
        [0.0, h, 0.47 * reach],
        [0.0, 0.93 * h, 0.88 * reach],
        [0.0, 0.72 * h, reach],
    ];
    let level = 0.36 * h;
    let hub = cylinder(0.012, 0.036, 12)
        .rotated_z(-FRAC_PI_2)
        .translated(0.0, level, 0.0);
    let body = PartBuilder::new("body")
        .with_fill_fraction(&chrome(), cylinder(0.025, 0.03, 16), 0.5)
        .with_fill_fraction(&chrome(), tube(&spout, 0.012, 10), 0.4)
        .with_fill_fraction(&chrome(), hub, 0.5);
    let x = 0.042;
    let lever = PartBuilder::new("lever").with(
        &chrome(),
        rod([x, level - 0.008, 0.0], [x, level + 0.07, 0.0], 0.005),
    );
    Model::articulated("mixer_tap", "tap")
        .part(body)
        .with_sound([0.0, 0.72 * h - 0.01, reach], "tap", 58.0)
        .part(lever)
        .hinged("lever", [x, level, 0.0], Vec3::X, TURN_RAD)
        .with_switch()
}

fn sample_mixer_tap(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("mixer_tap", key);
    let tap = mixer_tap(d.sample_m("height"), d.sample_m("reach"));
    if d.chance("metal", 0.3) {
        tap.with_finish_replaced("chrome", &tap_metal(style))
    } else {
        tap
    }
}

/// The style's metal, polished.
fn tap_metal(style: &Style) -> Finish {
    Finish {
        name: "tap_metal",
        substance: "chrome",
        ..style.metal.clone()
    }
}

/// A mixer tap of `sizes_m` (height, reach) on the point `at` of a basin, its spout turned to the left by `turn_rad`.
pub(super) fn with_mixer_tap(
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
        tap = tap.with_finish_replaced("chrome", &tap_metal(style));
    }
    let pose = Pose::new(at.into(), axis_rotation(Vec3::Y, turn_rad));
    basin.with_mounted(tap, "tap", &pose)
}
