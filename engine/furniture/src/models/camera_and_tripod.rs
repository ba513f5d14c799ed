//! A camera and a tripod.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, electronics};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, TAU};

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("camera", "camera", 127, camera),
    CatalogueEntry::new("tripod", "tripod", 128, tripod),
];

/// A camera, its lens towards +Z.
fn camera(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("camera", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let skin = electronics(
        "camera_body",
        d.choose("skin", [[34, 34, 36], [170, 172, 176], [90, 60, 40]]),
    );
    let lens = |r: f32, from: f32, deep: f32| {
        cylinder(r, deep, 24)
            .rotated_x(FRAC_PI_2)
            .translated(0.1 * x, 0.36 * h, from)
    };
    let body = PartBuilder::new("body")
        .with(
            &skin,
            rounded_block([-x, 0.0, -z], [x, 0.8 * h, -z + 0.045], 0.01, 1),
        )
        .with(
            &skin,
            block([-0.25 * x, 0.8 * h, -z + 0.004], [0.45 * x, h, -z + 0.04]),
        )
        .with_fill_fraction(
            &black_plastic(),
            lens(0.36 * h, -z + 0.045, depth - 0.05),
            0.7,
        )
        .with(
            &Finish::plain("lens", "glass", [40, 46, 70]).transparent(1.0),
            lens(0.28 * h, z - 0.005, 0.004),
        )
        .with(
            &chrome(),
            cylinder(0.01, 0.008, 12).translated(-0.7 * x, 0.8 * h, -z + 0.022),
        );
    Model::pickable("camera", "camera")
        .with_switch_state(false)
        .part(body)
}

/// A tripod with its legs spread.
fn tripod(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("tripod", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let leg = Finish::plain(
        "tripod_leg",
        "aluminium",
        d.choose("tone", [[44, 44, 47], [176, 178, 182]]),
    );
    let r = w / 3.0_f32.sqrt() - 0.012;
    let crown = 0.72 * h;
    let mut body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            cylinder(0.045, 0.06, 16).translated(0.0, crown - 0.03, 0.0),
        )
        .with_fill_fraction(
            &leg,
            cylinder(0.013, h - crown - 0.03, 12).translated(0.0, crown, 0.0),
            0.6,
        )
        .with(
            &black_plastic(),
            block([-0.04, h - 0.05, -0.03], [0.04, h, 0.03]),
        )
        .with(
            &black_plastic(),
            rod([0.0, h - 0.03, -0.02], [0.1, h - 0.12, -0.14], 0.008),
        );
    for k in 0..3 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 3.0);
        let foot = ball(0.012, 8).translated(r * sin, 0.012, r * cos);
        body = body.with(&black_plastic(), foot);
        body = body.with_fill_fraction(
            &leg,
            rod(
                [r * sin, 0.01, r * cos],
                [0.04 * sin, crown, 0.04 * cos],
                0.012,
            ),
            0.5,
        );
    }
    Model::movable("tripod", "tripod").part(body)
}
