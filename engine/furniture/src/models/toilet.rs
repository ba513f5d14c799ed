//! A toilet with a lid that opens.

use super::washbasins::sanitary_finish;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, chrome, plastic, sanitary_ware};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, loft, rounded_block};
use crate::style::Style;
use dwell_scene::math;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::PI;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("toilet", "toilet", 77, sample_toilet)];

/// A level outline from `back` to `front` (z, m), round in front and blunt behind.
fn outline(half_width: f32, back: f32, front: f32, y: f32) -> Vec<Vec3> {
    const STEPS: usize = 18;
    let length = front - back;
    let mut corners = Vec::with_capacity(STEPS + 3);
    for k in 0..=STEPS {
        // From the left side round the front to the right side.
        let (sin, cos) = math::sin_cos(PI * (k as f32 / STEPS as f32 - 0.5));
        corners.push(Vec3::new(
            half_width * sin,
            y,
            back + length * (0.4 + 0.6 * cos),
        ));
    }
    corners.push(Vec3::new(half_width * 0.8, y, back));
    corners.push(Vec3::new(-half_width * 0.8, y, back));
    corners
}

/// A toilet, its cistern at -Z.
fn toilet() -> Model {
    let white = sanitary_ware();
    let seat = plastic("white_plastic", [240, 240, 236]);
    let z = 0.34;
    let back = -z + 0.165;
    let pedestal = loft(&[
        outline(0.115, back, 0.14, 0.0),
        outline(0.095, back, 0.1, 0.1),
        outline(0.11, back, 0.13, 0.2),
        outline(0.165, back, z - 0.05, 0.32),
        outline(0.185, back, z, 0.4),
    ]);
    let plate =
        |low: f32, high: f32| loft(&[outline(0.187, back, z, low), outline(0.187, back, z, high)]);
    let body = PartBuilder::new("body")
        .with_fill_fraction(&white, pedestal, 0.25)
        .with_fill_fraction(&white, block([-0.11, 0.0, -z], [0.11, 0.39, back]), 0.25)
        .with_fill_fraction(
            &white,
            rounded_block([-0.19, 0.39, -z], [0.19, 0.76, -z + 0.16], 0.025, 2),
            0.2,
        )
        .with(
            &white,
            rounded_block([-0.2, 0.76, -z], [0.2, 0.79, -z + 0.17], 0.01, 1),
        )
        .with(
            &chrome(),
            cylinder(0.022, 0.01, 16).translated(0.0, 0.79, -z + 0.08),
        )
        .with(&seat, plate(0.4, 0.415));
    // The lid ends a little behind its hinge, so that it turns clear of the seat.
    let cover = [0.417, 0.435].map(|y| outline(0.187, back + 0.024, z, y));
    let lid = PartBuilder::new("lid").with_fill_fraction(&seat, loft(&cover), 0.5);
    Model::articulated("toilet", "toilet")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.5, -z + 0.1], "toilet_flush", 70.0)
        .part(lid)
        // Beyond upright, against the cistern, so that it stays up.
        .hinged("lid", [0.0, 0.426, back + 0.03], Vec3::NEG_X, 1.6)
}

fn sample_toilet(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toilet", key);
    let seat = Finish {
        name: "toilet_seat",
        substance: "plastic",
        ..style.wood.clone()
    };
    let size = d.sample_m("height") / 0.79;
    let closet = toilet()
        .resized(size)
        .with_finish_replaced("white_porcelain", &sanitary_finish(&d));
    if d.chance("wooden", 0.2) && seat.pattern.is_none() {
        closet.with_finish_replaced("white_plastic", &seat)
    } else {
        closet
    }
}
