//! Lamps that hang from the ceiling or sit on it.

use super::lampshades::{shade_finish, shade_mesh};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, brass, chrome, milk_glass, plastic, white_lacquer};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, cylinder, rod, surface_of_revolution, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("ceiling_lamp", "chandelier", 92, ceiling_lamp),
    CatalogueEntry::new("drum_lamp", "chandelier", 93, drum_lamp),
    CatalogueEntry::new("pendant", "chandelier", 94, sample_pendant),
    CatalogueEntry::new("chandelier", "chandelier", 95, chandelier),
];

/// A flat dome of milk glass on the ceiling.
fn ceiling_dome(radius_m: f32, power_w: f32) -> Model {
    let glass = surface_of_revolution(
        &[
            (0.0, -0.1),
            (0.5 * radius_m, -0.088),
            (0.85 * radius_m, -0.055),
            (radius_m, -0.02),
            (0.0, -0.02),
        ],
        28,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &chrome(),
            cylinder(radius_m, 0.02, 28).translated(0.0, -0.02, 0.0),
            0.1,
        )
        .with_fill_fraction(&milk_glass(), glass, 0.08);
    Model::fixed("ceiling_dome", "chandelier")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, -0.13, 0.0], power_w)
}

fn ceiling_lamp(_style: &Style, key: RandomKey) -> Model {
    ceiling_dome(
        0.5 * SizeSampler::new("ceiling_lamp", key).sample_m("width"),
        14.0,
    )
}

/// A drum of cloth on a cord.
fn drum(drop_m: f32, radius_m: f32, cloth: &Finish, power_w: f32) -> Model {
    let height = 0.65 * radius_m;
    let body = PartBuilder::new("body")
        .with(
            &white_lacquer(),
            cylinder(0.05, 0.025, 20).translated(0.0, -0.025, 0.0),
        )
        .with(
            &black_plastic(),
            rod(
                [0.0, -drop_m + 0.5 * height, 0.0],
                [0.0, -0.025, 0.0],
                0.004,
            ),
        )
        .with(
            cloth,
            shade_mesh(radius_m, radius_m, height).translated(0.0, -drop_m, 0.0),
        )
        .with(
            &milk_glass(),
            cylinder(radius_m - 0.006, 0.004, 28)
                .translated(0.0, -drop_m + 0.02, 0.0)
                .visual_only(),
        );
    Model::fixed("drum_lamp", "chandelier")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, -drop_m - 0.02, 0.0], power_w)
}

fn drum_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("drum_lamp", key);
    drum(
        d.sample_m("height"),
        0.5 * d.sample_m("width"),
        &shade_finish(style, &d),
        14.0,
    )
}

/// A pendant: a shade on a cord `drop_m` below the ceiling.
fn pendant(drop_m: f32, radius_m: f32, metal: &Finish, power_w: f32) -> Model {
    let top = -drop_m + 0.62 * radius_m;
    let dome = [
        (radius_m - 0.003, 0.0),
        (radius_m, 0.0),
        (0.93 * radius_m, 0.22 * radius_m),
        (0.6 * radius_m, 0.5 * radius_m),
        (0.12 * radius_m, 0.62 * radius_m),
        (0.12 * radius_m, 0.6 * radius_m),
        (0.58 * radius_m, 0.485 * radius_m),
        (0.92 * radius_m, 0.2 * radius_m),
        (radius_m - 0.003, 0.0),
    ];
    let body = PartBuilder::new("body")
        .with(
            metal,
            cylinder(0.05, 0.025, 20).translated(0.0, -0.025, 0.0),
        )
        .with(
            &black_plastic(),
            rod([0.0, top, 0.0], [0.0, -0.025, 0.0], 0.004),
        )
        .with(
            metal,
            surface_of_revolution(&dome, 32).translated(0.0, -drop_m, 0.0),
        )
        .with(
            &milk_glass(),
            ball(0.26 * radius_m, 16)
                .translated(0.0, -drop_m + 0.2 * radius_m, 0.0)
                .visual_only(),
        );
    Model::fixed("pendant_lamp", "chandelier")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, -drop_m - 0.12, 0.0], power_w)
}

fn sample_pendant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pendant", key);
    let tone = style.random_glaze(&mut d.stream("tone")).srgb;
    let lacquer = Finish::plain("pendant_lacquer", "steel", tone);
    let metal = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        lacquer
    };
    pendant(
        d.sample_m("height"),
        0.5 * d.sample_m("width"),
        &metal,
        12.0,
    )
}

/// A chandelier: arms with candles or bulbs around a stem, under the ceiling.
fn chandelier(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("chandelier", key);
    let (w, h) = (d.sample_m("span"), d.sample_m("height"));
    let metal = if d.chance("brass", 0.4) {
        brass()
    } else {
        style.metal.clone()
    };
    let count = d.choose("arms", [5, 6, 8]);
    let (r, low) = (0.5 * w - 0.03, -h);
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &metal,
            cylinder(0.06, 0.03, 20).translated(0.0, -0.03, 0.0),
            0.4,
        )
        .with(
            &metal,
            rod([0.0, low + 0.18, 0.0], [0.0, -0.03, 0.0], 0.007),
        )
        .with_fill_fraction(
            &metal,
            surface_of_revolution(
                &[
                    (0.0, low),
                    (0.03, low + 0.02),
                    (0.05, low + 0.07),
                    (0.02, low + 0.16),
                    (0.0, low + 0.18),
                ],
                18,
            ),
            0.5,
        );
    for k in 0..count {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / count as f32);
        let at = |out: f32, y: f32| [out * sin, low + y, out * cos];
        body = body
            .with_fill_fraction(
                &metal,
                tube(
                    &[
                        at(0.03, 0.08),
                        at(0.5 * r, 0.01),
                        at(0.85 * r, 0.03),
                        at(r, 0.1),
                    ],
                    0.006,
                    6,
                ),
                0.6,
            )
            .with(
                &metal,
                cylinder(0.028, 0.008, 12).translated(r * sin, low + 0.1, r * cos),
            )
            .with(
                &plastic("candle_sleeve", [240, 234, 216]),
                cylinder(0.012, 0.07, 10).translated(r * sin, low + 0.108, r * cos),
            )
            .with(
                &milk_glass(),
                surface_of_revolution(
                    &[(0.0, 0.0), (0.012, 0.008), (0.014, 0.02), (0.0, 0.05)],
                    10,
                )
                .translated(r * sin, low + 0.178, r * cos)
                .visual_only(),
            );
    }
    Model::fixed("chandelier", "chandelier")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, low - 0.05, 0.0], 24.0)
}
