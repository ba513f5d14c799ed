//! A drum kit.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, brass, chrome, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, rod, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("drum_kit", "drumset", 133, drum_kit)];

/// A drum kit: bass drum, two toms, a floor tom, a snare, two cymbals, a stool behind.
fn drum_kit(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("drum_kit", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let shell = Finish::plain(
        "drum_shell",
        "wood",
        d.choose(
            "shell",
            [
                [170, 36, 40],
                [36, 60, 120],
                [30, 30, 33],
                [190, 150, 60],
                [226, 224, 218],
            ],
        ),
    );
    let skin = plastic("drum_skin", [236, 234, 226]);
    let bass = 0.28;
    let front = z - 0.45;
    let mut body = PartBuilder::new("kit")
        .with_fill_fraction(
            &shell,
            cylinder(bass, 0.4, 28)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, bass, front),
            0.07,
        )
        .with(
            &skin,
            cylinder(bass - 0.015, 0.003, 28)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, bass, front + 0.4)
                .visual_only(),
        );
    let drum = |body: PartBuilder, r: f32, tall: f32, at: [f32; 3], legs: bool| {
        let [a, y, b] = at;
        let mut body = body
            .with_fill_fraction(&shell, cylinder(r, tall, 24).translated(a, y, b), 0.07)
            .with(
                &skin,
                cylinder(r - 0.008, 0.003, 24)
                    .translated(a, y + tall, b)
                    .visual_only(),
            );
        if legs {
            for k in 0..3 {
                let (sin, cos) = dwell_scene::math::sin_cos(2.1 * k as f32 + 0.5);
                body = body.with_fill_fraction(
                    &chrome(),
                    rod(
                        [a + 0.95 * r * sin, 0.008, b + 0.95 * r * cos],
                        [a + 0.8 * r * sin, y + 0.1, b + 0.8 * r * cos],
                        0.009,
                    ),
                    0.4,
                );
            }
        } else {
            body = body.with_fill_fraction(
                &chrome(),
                rod([0.4 * a, 2.0 * bass - 0.02, b], [a, y + 0.05, b], 0.012).visual_only(),
                0.4,
            );
        }
        body
    };
    body = drum(body, 0.15, 0.2, [-0.17, 0.62, front + 0.12], false);
    body = drum(body, 0.16, 0.22, [0.18, 0.62, front + 0.12], false);
    body = drum(body, 0.2, 0.4, [0.62 * x, 0.2, front - 0.3], true);
    body = drum(body, 0.18, 0.14, [-0.5 * x, 0.48, front - 0.28], true);
    let cymbal = |r: f32, a: f32, y: f32, b: f32| {
        let plate = surface_of_revolution(
            &[
                (0.0, 0.0),
                (r, -0.015),
                (r, -0.012),
                (0.05, 0.012),
                (0.0, 0.028),
            ],
            24,
        );
        (
            plate.translated(a, y, b),
            rod([a, 0.03, b], [a, y, b], 0.011),
            cylinder(0.16, 0.03, 3).translated(a, 0.0, b),
        )
    };
    for (plate, post, foot) in [
        cymbal(0.2, -x + 0.2, h - 0.04, front + 0.05),
        cymbal(0.23, x - 0.24, h - 0.08, front + 0.15),
    ] {
        body = body
            .with(&brass(), plate)
            .with_fill_fraction(&chrome(), post, 0.4)
            .with_fill_fraction(&black_plastic(), foot, 0.15);
    }
    let body = body
        .with(
            &black_plastic(),
            cylinder(0.17, 0.07, 24).translated(0.0, 0.45, -z + 0.18),
        )
        .with_fill_fraction(
            &chrome(),
            rod([0.0, 0.02, -z + 0.18], [0.0, 0.45, -z + 0.18], 0.015),
            0.5,
        )
        .with_fill_fraction(
            &black_plastic(),
            cylinder(0.18, 0.03, 3).translated(0.0, 0.0, -z + 0.18),
            0.2,
        );
    Model::fixed("drum_kit", "drumset").part(body)
}
