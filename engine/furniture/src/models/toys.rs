//! Teddy bears, toy trains, blocks and balls.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, pine, upholstery};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cone, cylinder, rod, rounded_block, surface_of_revolution};
use crate::style::Style;
use crate::textures::Srgb;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("teddy_bear", "toy", 141, sample_teddy_bear),
    CatalogueEntry::new("toy_train", "toy", 142, sample_toy_train),
    CatalogueEntry::new("toy_block", "toy", 143, sample_toy_block),
    CatalogueEntry::new("toy_ball", "ball", 144, sample_toy_ball),
];

/// A bear of plush, sitting.
fn teddy_bear(plush: &Finish) -> Model {
    let cream = upholstery("cream_plush", [226, 206, 170]);
    let limb = |from: [f32; 3], to: [f32; 3], r: f32| {
        rod(from, to, r).merged(
            ball(r * 1.12, 12)
                .translated(to[0], to[1], to[2])
                .visual_only(),
        )
    };
    let body = PartBuilder::new("body")
        .with(
            plush,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.055, 0.0),
                    (0.085, 0.05),
                    (0.075, 0.11),
                    (0.045, 0.155),
                    (0.0, 0.16),
                ],
                16,
            ),
        )
        .with(plush, ball(0.062, 16).translated(0.0, 0.2, 0.0))
        .with(
            plush,
            ball(0.024, 10).translated(-0.045, 0.25, 0.0).visual_only(),
        )
        .with(
            plush,
            ball(0.024, 10).translated(0.045, 0.25, 0.0).visual_only(),
        )
        .with(
            &cream,
            ball(0.03, 12).translated(0.0, 0.185, 0.05).visual_only(),
        )
        .with_all(
            plush,
            [-1.0_f32, 1.0].map(|s| limb([s * 0.05, 0.13, 0.02], [s * 0.1, 0.075, 0.07], 0.024)),
        )
        .with_all(
            plush,
            [-1.0_f32, 1.0].map(|s| limb([s * 0.045, 0.04, 0.04], [s * 0.075, 0.04, 0.13], 0.028)),
        )
        .with_all(
            &black_plastic(),
            [-0.022, 0.022].map(|x| ball(0.006, 8).translated(x, 0.215, 0.058).visual_only()),
        )
        .with(
            &black_plastic(),
            ball(0.008, 8).translated(0.0, 0.192, 0.078).visual_only(),
        );
    Model::pickable("teddy_bear", "toy").part(body)
}

fn sample_teddy_bear(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("teddy_bear", key);
    let plush = upholstery(
        "plush",
        d.choose(
            "plush",
            [
                [156, 108, 66],
                [204, 170, 120],
                [120, 84, 60],
                [226, 206, 180],
            ],
        ),
    );
    teddy_bear(&plush).resized(d.sample_m("height") / 0.274)
}

/// A wooden engine on wheels.
fn toy_train() -> Model {
    let red = Finish::plain("red_wood", "wood", [196, 52, 44]);
    let blue = Finish::plain("blue_wood", "wood", [54, 96, 168]);
    let wheel = |x: f32, z: f32| {
        cylinder(0.022, 0.012, 14)
            .rotated_x(FRAC_PI_2)
            .translated(x, 0.022, z)
    };
    let body = PartBuilder::new("body")
        .with(&red, block([-0.12, 0.024, -0.04], [0.12, 0.05, 0.04]))
        .with(
            &blue,
            cylinder(0.034, 0.13, 18)
                .rotated_z(FRAC_PI_2)
                .translated(0.11, 0.084, 0.0),
        )
        .with(&red, block([-0.11, 0.05, -0.04], [-0.02, 0.14, 0.04]))
        .with(&blue, block([-0.12, 0.14, -0.046], [-0.01, 0.15, 0.046]))
        .with(
            &black_plastic(),
            cone(0.013, 0.018, 0.04, 12).translated(0.085, 0.115, 0.0),
        )
        .with_all(
            &pine(),
            [
                wheel(-0.08, 0.04),
                wheel(0.07, 0.04),
                wheel(-0.08, -0.052),
                wheel(0.07, -0.052),
            ],
        );
    Model::pickable("toy_train", "toy").part(body)
}

fn sample_toy_train(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toy_train", key);
    let tones = [
        [196, 52, 44],
        [54, 96, 168],
        [236, 190, 60],
        [76, 150, 90],
        [226, 226, 220],
    ];
    let first = d.below("first", tones.len());
    let second = (first + 1 + d.below("second", tones.len() - 1)) % tones.len();
    toy_train()
        .resized(d.sample_m("width") / 0.24)
        .with_finish_replaced("red_wood", &Finish::plain("toy_body", "wood", tones[first]))
        .with_finish_replaced(
            "blue_wood",
            &Finish::plain("toy_boiler", "wood", tones[second]),
        )
}

/// A building block of wood.
fn toy_block(edge_m: f32, name: &'static str, srgb: Srgb) -> Model {
    let h = 0.5 * edge_m;
    let lacquered = Finish::plain(name, "wood", srgb);
    Model::pickable("toy_block", "toy").part(PartBuilder::new("body").with(
        &lacquered,
        rounded_block([-h, 0.0, -h], [h, edge_m, h], 0.004, 1),
    ))
}

fn sample_toy_block(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toy_block", key);
    let tone = d.choose(
        "tone",
        [[196, 52, 44], [54, 96, 168], [236, 190, 60], [76, 150, 90]],
    );
    toy_block(d.sample_m("width"), "block_lacquer", tone)
}

/// A ball to play with.
fn toy_ball(radius_m: f32, rubber: &Finish) -> Model {
    Model::pickable("ball", "ball").part(PartBuilder::new("body").with_fill_fraction(
        rubber,
        ball(radius_m, 24).translated(0.0, radius_m, 0.0),
        0.06,
    ))
}

fn sample_toy_ball(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toy_ball", key);
    let rubber = Finish::plain(
        "toy_rubber",
        "rubber",
        style.random_cloth(&mut d.stream("tone")).srgb,
    );
    toy_ball(0.5 * d.sample_m("width"), &rubber)
}
