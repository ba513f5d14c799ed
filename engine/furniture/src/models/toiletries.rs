//! Soap, shampoo, toothbrushes and hair dryers.

use super::casings::CASING_COLORS;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, glass, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{
    block, cone, cylinder, loft, oval, rod, rounded_block, surface_of_revolution, vessel,
};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("hair_dryer", "hair_dryer", 67, hair_dryer),
    CatalogueEntry::new(
        "soap_dispenser",
        "soap_dispenser",
        88,
        sample_soap_dispenser,
    ),
    CatalogueEntry::new("soap_dish", "soap_dish", 89, soap_dish),
    CatalogueEntry::new("toothbrushes", "toiletries", 90, sample_toothbrushes),
    CatalogueEntry::new("shampoo", "toiletries", 91, shampoo),
];

/// A soap dispenser.
fn soap_dispenser(color: &Finish) -> Model {
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            color,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.032, 0.0),
                    (0.034, 0.01),
                    (0.034, 0.1),
                    (0.014, 0.125),
                    (0.0, 0.125),
                ],
                18,
            ),
            0.7,
        )
        .with(
            &chrome(),
            cylinder(0.006, 0.035, 10).translated(0.0, 0.125, 0.0),
        )
        .with(
            &chrome(),
            rounded_block([-0.008, 0.16, -0.01], [0.008, 0.172, 0.045], 0.004, 1),
        );
    Model::pickable("soap_dispenser", "soap_dispenser").part(body)
}

fn sample_soap_dispenser(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("soap_dispenser", key);
    let tone = style.random_glaze(&mut d.stream("tone")).srgb;
    soap_dispenser(&plastic("dispenser_plastic", tone)).resized(d.sample_m("height") / 0.172)
}

/// A dish with a piece of soap.
fn soap_dish(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("soap_dish", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let soap = Finish::plain(
        "soap",
        "wax",
        d.choose(
            "soap",
            [
                [238, 230, 206],
                [222, 170, 180],
                [180, 206, 170],
                [230, 200, 130],
            ],
        ),
    );
    let glaze = style.random_glaze(&mut d.stream("glaze"));
    let dish = loft(&[
        oval(0.38 * w, 0.36 * depth, 0.0, 0.0, 20),
        oval(0.5 * w, 0.5 * depth, 0.5 * h, 0.0, 20),
    ]);
    let piece = rounded_block(
        [-0.3 * w, 0.5 * h, -0.27 * depth],
        [0.3 * w, h, 0.27 * depth],
        0.009,
        2,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(glaze, dish, 0.6)
        .with(&soap, piece);
    Model::pickable("soap_dish", "soap_dish").part(body)
}

/// A beaker with two toothbrushes.
fn toothbrushes() -> Model {
    let brush = |name: &'static str, srgb, x: f32, tilt: f32| {
        (
            plastic(name, srgb),
            rod([0.0, 0.01, 0.0], [0.0, 0.18, 0.0], 0.004)
                .visual_only()
                .rotated_z(tilt)
                .translated(x, 0.0, 0.0),
        )
    };
    let (green, a) = brush("green_plastic", [88, 168, 112], 0.012, 0.13);
    let (blue, b) = brush("blue_plastic", [66, 120, 186], -0.012, -0.13);
    let cup = vessel(&[(0.0, 0.0), (0.034, 0.0), (0.038, 0.1)], 0.003, 18);
    let body = PartBuilder::new("body")
        .with(&glass(), cup)
        .with(&green, a)
        .with(&blue, b);
    Model::pickable("toothbrushes", "toiletries").part(body)
}

fn sample_toothbrushes(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toothbrushes", key);
    let tones = [
        [88, 168, 112],
        [66, 120, 186],
        [226, 90, 110],
        [240, 180, 60],
        [236, 236, 232],
    ];
    let first = d.below("first", tones.len());
    let second = (first + 1 + d.below("second", tones.len() - 1)) % tones.len();
    toothbrushes()
        .resized(d.sample_m("height") / 0.18)
        .with_finish_replaced("green_plastic", &plastic("first_brush", tones[first]))
        .with_finish_replaced("blue_plastic", &plastic("second_brush", tones[second]))
}

/// Shampoo and shower gel: two or three bottles of plastic together.
fn shampoo(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shampoo", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let tones = [
        [60, 140, 170],
        [226, 110, 130],
        [240, 236, 226],
        [110, 160, 90],
        [230, 170, 60],
        [90, 70, 130],
    ];
    let mut body = PartBuilder::new("body");
    let first = d.below("first", tones.len());
    for (k, (at, tall)) in [(-0.27, 1.0_f32), (0.27, 0.82)].into_iter().enumerate() {
        let tone = plastic("shampoo_bottle", tones[(first + 2 * k) % tones.len()]);
        let shell = loft(&[
            oval(0.2 * w, 0.42 * depth, 0.0, 0.0, 16),
            oval(0.22 * w, 0.5 * depth, 0.06 * h, 0.0, 16),
            oval(0.22 * w, 0.5 * depth, 0.62 * h * tall, 0.0, 16),
            oval(0.1 * w, 0.25 * depth, 0.82 * h * tall, 0.0, 16),
        ]);
        body = body
            .with_fill_fraction(&tone, shell.translated(at * w, 0.0, 0.0), 0.75)
            .with(
                &plastic("bottle_cap", [236, 236, 232]),
                cylinder(0.09 * w, 0.18 * h * tall, 12).translated(at * w, 0.82 * h * tall, 0.0),
            );
    }
    Model::movable("shampoo", "toiletries").part(body)
}

/// A hair dryer lying on its side, the nozzle towards +X.
fn hair_dryer(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("hair_dryer", key);
    let (w, depth) = (d.sample_m("width"), d.sample_m("depth"));
    let shell = plastic("dryer_shell", d.choose("case", CASING_COLORS));
    let r = 0.038;
    let barrel = cylinder(r, 0.75 * w, 20).rotated_z(-FRAC_PI_2);
    let nozzle = cone(0.8 * r, 0.62 * r, 0.25 * w, 16).rotated_z(-FRAC_PI_2);
    let handle = rounded_block(
        [-0.018, -0.016, 0.0],
        [0.018, 0.016, depth - 1.4 * r],
        0.012,
        2,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &shell,
            barrel.translated(-0.5 * w, r, -0.5 * depth + r),
            0.3,
        )
        .with_fill_fraction(
            &black_plastic(),
            nozzle.translated(0.25 * w, r, -0.5 * depth + r),
            0.3,
        )
        .with_fill_fraction(
            &shell,
            handle.translated(-0.2 * w, r, -0.5 * depth + 1.4 * r),
            0.5,
        )
        .with(
            &black_plastic(),
            cylinder(0.03, 0.004, 16)
                .rotated_z(FRAC_PI_2)
                .translated(-0.5 * w, r, -0.5 * depth + r)
                .visual_only(),
        )
        // The handle is lower at its end, so that the dryer lies on barrel and grip.
        .with(
            &black_plastic(),
            block(
                [-0.2 * w - 0.012, 0.0, 0.5 * depth - 0.03],
                [-0.2 * w + 0.012, r - 0.014, 0.5 * depth - 0.01],
            ),
        );
    Model::pickable("hair_dryer", "hair_dryer")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.5 * w, r, -0.5 * depth + r], "noise", 76.0)
}
