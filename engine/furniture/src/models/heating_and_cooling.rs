//! Radiators, air conditioners and fans.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, enamel, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, cylinder, rod, rounded_block, surface_of_revolution, torus};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, TAU};

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("air_conditioner", "air_conditioner", 61, air_conditioner),
    CatalogueEntry::new("pedestal_fan", "fan", 62, pedestal_fan),
    CatalogueEntry::new("ceiling_fan", "fan", 63, ceiling_fan),
    CatalogueEntry::new("radiator", "heater", 68, sample_radiator),
];

/// A panel radiator on the wall; y = 0 is its lower edge.
pub fn radiator(width_m: f32, height_m: f32) -> Model {
    let white = Finish::plain("radiator_white", "steel", [238, 238, 236]);
    let x = 0.5 * width_m;
    let rib = |k: usize| {
        let a = -x + 0.012 + 0.04 * k as f32;
        block([a, 0.03, 0.09], [a + 0.022, height_m - 0.03, 0.098]).visual_only()
    };
    // Brackets between 0.1 m from either end, at least 4 cm high.
    let middle = 0.5 * height_m;
    let (low, high) = if height_m >= 0.24 {
        (0.1, height_m - 0.1)
    } else {
        (middle - 0.02, middle + 0.02)
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(&white, block([-x, 0.0, 0.04], [x, height_m, 0.09]), 0.12)
        .with_all(&white, (0..(width_m / 0.04 - 0.5) as usize).map(rib))
        .with_all(
            &white,
            [-x + 0.1, x - 0.12].map(|a| block([a, low, 0.0], [a + 0.02, high, 0.04])),
        )
        .with(
            &chrome(),
            rod([x, 0.05, 0.06], [x + 0.05, 0.05, 0.06], 0.011),
        );
    Model::fixed("radiator", "heater").part(body)
}

fn sample_radiator(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("radiator", key);
    radiator(d.sample_m("width"), d.sample_m("height")).with_switch_state(true)
}

/// The indoor unit of an air conditioner, on the wall; y = 0 is its lower edge.
fn air_conditioner(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("air_conditioner", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let x = 0.5 * w;
    let white = enamel(
        "white_case",
        d.choose("tone", [[240, 241, 240], [232, 230, 224], [70, 74, 78]]),
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &white,
            rounded_block([-x, 0.0, 0.0], [x, h, depth], 0.025, 2),
            0.45,
        )
        .with(
            &black_plastic(),
            block([-x + 0.06, 0.02, depth], [x - 0.06, 0.045, depth + 0.001]).visual_only(),
        )
        .with(
            &white,
            block(
                [-x + 0.05, -0.002, depth - 0.09],
                [x - 0.05, 0.004, depth - 0.02],
            )
            .visual_only(),
        )
        .with(
            &Finish::plain("indicator", "plastic", [90, 200, 120]).emissive([0.05, 0.3, 0.1]),
            block([x - 0.1, 0.12, depth], [x - 0.08, 0.126, depth + 0.001]).visual_only(),
        );
    Model::fixed("air_conditioner", "air_conditioner")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.02, depth], "fan", 40.0)
}

/// A fan on a stand: a cage with blades on a post.
fn pedestal_fan(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pedestal_fan", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let (r, y) = (0.5 * w, h - 0.5 * w);
    let dark = d.chance("dark", 0.5);
    let case = if dark {
        black_plastic()
    } else {
        plastic("white_plastic", [240, 240, 236])
    };
    let hub = |from: f32, deep: f32, radius: f32| {
        cylinder(radius, deep, 16)
            .rotated_x(FRAC_PI_2)
            .translated(0.0, y, from)
    };
    let mut body = PartBuilder::new("body")
        .with(
            &case,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.85 * r, 0.0),
                    (0.85 * r, 0.012),
                    (0.12, 0.04),
                    (0.0, 0.04),
                ],
                24,
            ),
        )
        .with(
            &style.metal,
            rod([0.0, 0.04, -0.1], [0.0, y - 0.05, -0.1], 0.013),
        )
        .with_fill_fraction(&case, hub(-0.15, 0.12, 0.055), 0.8)
        .with(
            &case,
            block([-0.02, y - 0.09, -0.12], [0.02, y - 0.04, -0.08]),
        );
    for k in 0..4 {
        let spin = TAU * k as f32 / 4.0;
        body = body.with(
            &case,
            blade(0.02, 0.86 * r, 0.35 * r)
                .rotated_x(FRAC_PI_2)
                .rotated_z(spin)
                .translated(0.0, y, 0.0)
                .visual_only(),
        );
    }
    for z in [-0.045_f32, 0.045] {
        for (k, size) in [1.0_f32, 0.55].into_iter().enumerate() {
            let wire = torus(size * (r - 0.006), 0.003, 18)
                .rotated_x(FRAC_PI_2)
                .translated(
                    0.0,
                    y,
                    z * (1.0 + 0.25 * k as f32) * if k == 0 { 0.4 } else { 1.0 },
                );
            body = body.with(&style.metal, wire.visual_only());
        }
        for k in 0..8 {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 8.0);
            let wire = rod(
                [0.0, y, z * 1.5],
                [0.99 * r * sin, y + 0.99 * r * cos, 0.4 * z],
                0.002,
            );
            body = body.with(&style.metal, wire.visual_only());
        }
    }
    // The cage is felt as a disc.
    let cage = hub(-0.05, 0.1, r - 0.004).collision_only();
    let body = body.with(&style.metal, cage);
    Model::movable("pedestal_fan", "fan")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, y, 0.05], "fan", 50.0)
}

/// A fan under the ceiling with a lamp in its middle.
fn ceiling_fan(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ceiling_fan", key);
    let (w, h) = (d.sample_m("span"), d.sample_m("height"));
    let (r, low) = (0.5 * w, -h);
    let count = d.choose("blades", [3, 4, 5]);
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &style.metal,
            cylinder(0.07, 0.05, 20).translated(0.0, -0.05, 0.0),
            0.3,
        )
        .with_fill_fraction(
            &style.metal,
            rod([0.0, low + 0.2, 0.0], [0.0, -0.05, 0.0], 0.014),
            0.5,
        )
        .with_fill_fraction(
            &style.metal,
            cylinder(0.1, 0.1, 24).translated(0.0, low + 0.1, 0.0),
            0.3,
        )
        .with_fill_fraction(
            &crate::finishes::milk_glass(),
            surface_of_revolution(
                &[
                    (0.0, low),
                    (0.06, low + 0.01),
                    (0.095, low + 0.05),
                    (0.1, low + 0.1),
                    (0.0, low + 0.1),
                ],
                24,
            ),
            0.2,
        );
    for k in 0..count {
        let one = blade(0.09, r, 0.13).rotated_y(TAU * k as f32 / count as f32);
        body = body.with(&style.wood, one.translated(0.0, low + 0.14, 0.0));
    }
    Model::fixed("ceiling_fan", "fan")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, low - 0.03, 0.0], 12.0)
        .with_sound([0.0, low + 0.14, 0.0], "fan", 38.0)
}

/// An oval fan blade from the axis (+Y) outwards along +X, twisted.
fn blade(from_m: f32, to_m: f32, width_m: f32) -> SolidMesh {
    rounded_block(
        [from_m, -0.004, -0.5 * width_m],
        [to_m, 0.004, 0.5 * width_m],
        0.0035,
        1,
    )
    .rotated_x(0.2)
}
