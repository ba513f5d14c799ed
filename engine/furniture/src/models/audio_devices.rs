//! Radios, loudspeakers, stereos and headphones.

use super::casings::CASING_COLORS;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, electronics, plastic, walnut};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod, rounded_block, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, PI};

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("loudspeaker", "loudspeaker", 115, sample_loudspeaker),
    CatalogueEntry::new("stereo", "stereo_set", 116, stereo),
    CatalogueEntry::new("radio", "radio", 117, sample_radio),
    CatalogueEntry::new("headphones", "headphones", 126, headphones),
];

/// The cloth or metal in front of a loudspeaker.
const fn grille(dark: bool) -> Finish {
    let colors = if dark {
        [[70, 70, 74], [22, 22, 24], [0; 3]]
    } else {
        [[206, 196, 176], [120, 108, 90], [0; 3]]
    };
    Finish::tiled("grille", "electronics", "grille", colors, 0.06)
}

/// A kitchen radio with a wooden case, a dial and two knobs.
fn radio(on: bool) -> Model {
    let (x, h, z) = (0.15, 0.17, 0.055);
    let dial = Finish::picture(
        "dial",
        "electronics",
        "dial",
        [[240, 226, 186], [60, 44, 30], [196, 40, 36]],
        1,
    );
    let scale = crate::shapes::panel(0.11, 0.05, 0.004).translated(0.075, 0.1, z);
    let knob = |at: f32| {
        cylinder(0.015, 0.016, 12)
            .rotated_x(FRAC_PI_2)
            .translated(at, 0.055, z)
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &walnut(),
            rounded_block([-x, 0.006, -z], [x, h, z], 0.018, 2),
            0.6,
        )
        .with(
            &black_plastic(),
            block([-x + 0.02, 0.0, -z + 0.01], [x - 0.02, 0.006, z - 0.01]),
        )
        .with(
            &grille(false),
            block([-x + 0.018, 0.028, z], [0.008, h - 0.025, z + 0.003]),
        )
        .with(&dial, scale)
        .with_all(&chrome(), [knob(0.045), knob(0.105)])
        .with(
            &chrome(),
            rod([0.13, h - 0.01, -0.03], [0.13, h + 0.2, -0.05], 0.0025).visual_only(),
        );
    Model::pickable("radio", "radio")
        .with_switch_state(on)
        .part(body)
        .with_sound([-0.06, 0.09, z + 0.01], "radio", 63.0)
}

fn sample_radio(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("radio", key);
    let wood = &style.wood;
    let set = radio(d.chance("on", 0.25)).resized(d.sample_m("width") / 0.3);
    if wood.tile_m > 0.0 {
        set.with_finish_replaced("walnut", wood)
    } else {
        set
    }
}

/// A loudspeaker on the floor.
fn loudspeaker(height_m: f32) -> Model {
    let case = electronics("black_case", [26, 26, 29]);
    let cone = |y: f32, r: f32| {
        cylinder(r, 0.006, 20)
            .rotated_x(FRAC_PI_2)
            .translated(0.0, y, 0.125)
            .visual_only()
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &walnut(),
            rounded_block([-0.1, 0.0, -0.125], [0.1, height_m, 0.125], 0.008, 1),
            0.35,
        )
        .with_all(
            &case,
            [
                cone(height_m * 0.42, 0.07),
                cone(height_m * 0.66, 0.07),
                cone(height_m * 0.86, 0.028),
            ],
        );
    Model::movable("loudspeaker", "loudspeaker").part(body)
}

fn sample_loudspeaker(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("loudspeaker", key);
    let case = style.random_wood(&mut d.stream("wood"));
    let plain = Finish::plain("speaker_case", "wood", case.srgb);
    let case = if case.pattern.is_some() {
        case.clone()
    } else {
        plain
    };
    let height = d.sample_m("height");
    loudspeaker(height)
        .with_switch_state(false)
        .with_sound([0.0, 0.66 * height, 0.14], "radio", 70.0)
        .with_finish_replaced("walnut", &case)
}

/// A stereo: an amplifier with a record player on top.
fn stereo(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("stereo", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let amp = 0.5 * h;
    let silver = electronics(
        "amplifier_face",
        d.choose("face", [[186, 188, 190], [36, 36, 39], [206, 190, 150]]),
    );
    let vinyl = plastic("vinyl", [20, 20, 22]);
    let label = plastic(
        "record_label",
        d.choose("label", [[196, 60, 50], [60, 110, 170], [226, 180, 70]]),
    );
    let knob = |a: f32, r: f32| {
        cylinder(r, 0.018, 18)
            .rotated_x(FRAC_PI_2)
            .translated(a, 0.5 * amp, z - 0.02)
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &style.wood,
            rounded_block([-x, 0.012, -z], [x, amp, z - 0.025], 0.006, 1),
            0.4,
        )
        .with(
            &black_plastic(),
            block([-x + 0.03, 0.0, -z + 0.03], [x - 0.03, 0.012, z - 0.05]),
        )
        .with(
            &silver,
            block(
                [-x + 0.008, 0.02, z - 0.025],
                [x - 0.008, amp - 0.008, z - 0.02],
            ),
        )
        .with_all(
            &chrome(),
            [
                knob(0.6 * x, 0.024),
                knob(-0.75 * x, 0.012),
                knob(-0.55 * x, 0.012),
                knob(-0.35 * x, 0.012),
            ],
        )
        .with_fill_fraction(
            &style.wood,
            rounded_block(
                [-x + 0.005, amp, -z + 0.005],
                [x - 0.005, h - 0.03, z - 0.03],
                0.006,
                1,
            ),
            0.5,
        )
        .with(
            &vinyl,
            cylinder(0.15_f32.min(0.42 * depth), 0.006, 32).translated(-0.06, h - 0.03, -0.012),
        )
        .with(
            &label,
            cylinder(0.05, 0.0015, 20)
                .translated(-0.06, h - 0.024, -0.012)
                .visual_only(),
        )
        .with(
            &chrome(),
            cylinder(0.018, 0.026, 14).translated(x - 0.06, h - 0.03, -z + 0.07),
        )
        .with(
            &chrome(),
            rod(
                [x - 0.06, h - 0.008, -z + 0.07],
                [0.06, h - 0.016, 0.07],
                0.004,
            )
            .visual_only(),
        );
    Model::movable("stereo", "stereo_set")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.5 * h, z], "radio", 66.0)
}

/// Headphones hung over a stand.
fn headphones(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("headphones", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let shell = plastic("headphones_shell", d.choose("case", CASING_COLORS));
    let r = 0.5 * w - 0.016;
    let y = h - r - 0.012;
    let arc: Vec<[f32; 3]> = (0..=8)
        .map(|k| {
            let (sin, cos) = dwell_scene::math::sin_cos(PI * (k as f32 / 8.0 - 0.5));
            [r * sin, y + r * cos, 0.0]
        })
        .collect();
    let ear = |side: f32| {
        cylinder(0.038, 0.03, 18)
            .rotated_z(FRAC_PI_2)
            .translated(side * r + 0.015, y - 0.02, 0.0)
    };
    let body = PartBuilder::new("body")
        .with(&style.wood, cylinder(0.36 * w, 0.016, 24))
        .with(
            &style.metal,
            rod([0.0, 0.016, 0.0], [0.0, h - 0.024, 0.0], 0.008),
        )
        .with(&shell, tube(&arc, 0.01, 8))
        .with_fill_fraction(&shell, ear(-1.0).merged(ear(1.0)), 0.5);
    Model::pickable("headphones", "headphones")
        .with_switch_state(false)
        .part(body)
        .with_sound([r, y - 0.02, 0.0], "radio", 48.0)
}
