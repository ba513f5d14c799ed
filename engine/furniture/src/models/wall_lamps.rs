//! Wall lamps and mirror lamps.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{chrome, lampshade, milk_glass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cone, cylinder, rod};
use crate::style::Style;
use dwell_scene::LightShape;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("wall_lamp", "wall_lamp", 100, wall_lamp),
    CatalogueEntry::new("mirror_lamp", "wall_lamp", 101, sample_mirror_lamp),
];

/// A lamp on the wall: a cylinder that shines up and down, a shade on an arm, or a globe. y = 0 is its plate's middle.
fn wall_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_lamp", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (r, z) = (0.5 * w, depth - 0.5 * w);
    let plate = cylinder(0.045, 0.015, 20).rotated_x(FRAC_PI_2);
    let arm = rod([0.0, 0.0, 0.015], [0.0, 0.0, z], 0.008);
    let body = PartBuilder::new("body")
        .with(&style.metal, plate)
        .with(&style.metal, arm);
    let body = match d.below("build", 3) {
        0 => body
            .with_fill_fraction(
                &style.metal,
                cylinder(r, h - 0.01, 20).translated(0.0, -0.5 * h, z),
                0.05,
            )
            .with(
                &milk_glass(),
                cylinder(0.9 * r, 0.01, 20).translated(0.0, 0.5 * h - 0.01, z),
            ),
        1 => {
            let shade = lampshade("lampshade", style.cloths[0].srgb);
            body.with_fill_fraction(
                &shade,
                cone(r, 0.7 * r, h, 24).translated(0.0, -0.3 * h, z),
                0.02,
            )
        }
        _ => {
            let fit = 0.5 * h.min(w);
            body.with_fill_fraction(
                &milk_glass(),
                crate::shapes::ball(fit, 18).translated(0.0, 0.5 * h - fit, z),
                0.1,
            )
        }
    };
    Model::fixed("wall_lamp", "wall_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, 0.5 * h + 0.04, z], 6.0)
}

/// A bar of light over a mirror.
fn mirror_lamp(width_m: f32) -> Model {
    let x = 0.5 * width_m;
    let bar = cylinder(0.022, width_m, 14)
        .rotated_z(std::f32::consts::FRAC_PI_2)
        .translated(x, 0.0, 0.07);
    let body = PartBuilder::new("body")
        .with(&chrome(), block([-0.06, -0.03, 0.0], [0.06, 0.03, 0.05]))
        .with_fill_fraction(&milk_glass(), bar, 0.3);
    let line = LightShape::Line {
        end: Vec3::new(x, 0.0, 0.1),
    };
    Model::fixed("mirror_lamp", "wall_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light_shape([-x, 0.0, 0.1], line, 6.0)
}

fn sample_mirror_lamp(_style: &Style, key: RandomKey) -> Model {
    mirror_lamp(SizeSampler::new("mirror_lamp", key).sample_m("width"))
}
