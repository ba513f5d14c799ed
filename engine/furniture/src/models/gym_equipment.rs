//! A treadmill and a weight bench.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, painted_steel, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("treadmill", "gym_equipment", 136, treadmill),
    CatalogueEntry::new("weight_bench", "gym_equipment", 137, weight_bench),
];

/// A treadmill: a belt between rails, a console on two posts. One runs towards -Z.
fn treadmill(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("treadmill", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let frame = Finish::plain(
        "treadmill_frame",
        "steel",
        d.choose("tone", [[60, 62, 66], [190, 192, 196], [40, 42, 46]]),
    );
    let belt = Finish::plain("treadmill_belt", "rubber", [30, 30, 32]);
    let screen = Finish::picture(
        "console",
        "electronics",
        "desktop",
        [[30, 60, 80], [200, 220, 220], [60, 160, 120]],
        2,
    )
    .emissive([0.04, 0.08, 0.08]);
    // The hood is a little wider than the rails, and a little above the floor that they stand on.
    let rail = x - 0.004;
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &frame,
            block([-rail, 0.0, -z + 0.2], [-x + 0.08, 0.16, z]),
            0.12,
        )
        .with_fill_fraction(
            &frame,
            block([x - 0.08, 0.0, -z + 0.2], [rail, 0.16, z]),
            0.12,
        )
        .with_fill_fraction(
            &belt,
            block([-x + 0.08, 0.05, -z + 0.2], [x - 0.08, 0.14, z - 0.02]),
            0.1,
        )
        .with_fill_fraction(
            &black_plastic(),
            rounded_block([-x, 0.005, -z], [x, 0.24, -z + 0.3], 0.04, 2),
            0.25,
        );
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.045);
        body = body
            .with_fill_fraction(
                &frame,
                rod([a, 0.1, -z + 0.32], [a, h - 0.22, -z + 0.12], 0.03),
                0.12,
            )
            .with_fill_fraction(
                &black_plastic(),
                rod([a, h - 0.28, -z + 0.13], [a, h - 0.3, -z + 0.62], 0.02),
                0.5,
            );
    }
    let console = rounded_block([-x, 0.0, -0.05], [x, 0.25, 0.05], 0.03, 2).rotated_x(-0.45);
    let shown = crate::shapes::panel(0.34, 0.16, 0.004)
        .translated(0.0, 0.05, 0.05)
        .rotated_x(-0.45);
    let (cy, cz) = (h - 0.25, -z + 0.13);
    let body = body
        .with_fill_fraction(&black_plastic(), console.translated(0.0, cy, cz), 0.3)
        .with(&screen, shown.translated(0.0, cy, cz).visual_only());
    Model::fixed("treadmill", "gym_equipment")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.15, -z + 0.15], "hum", 62.0)
}

/// A bench to lift weights on, with a bar in its rack.
fn weight_bench(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("weight_bench", key);
    let (w, h, depth) = (d.sample_m("width"), d.sample_m("bar"), d.sample_m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let steel = painted_steel(
        "bench_steel",
        d.choose("tone", [[44, 46, 50], [150, 40, 42], [200, 202, 206]]),
    );
    let cover = Finish {
        substance: "leather",
        ..plastic("bench_cover", [40, 40, 43])
    };
    let iron = Finish::plain("weights", "cast_iron", [52, 54, 58]);
    let seat = 0.45;
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &cover,
            rounded_block([-0.14, seat - 0.06, -0.5 * z], [0.14, seat, z], 0.02, 2),
            0.35,
        )
        .with_fill_fraction(
            &steel,
            block(
                [-0.03, seat - 0.12, -z + 0.06],
                [0.03, seat - 0.06, z - 0.05],
            ),
            0.2,
        )
        .with_fill_fraction(
            &steel,
            block([-0.03, 0.05, z - 0.16], [0.03, seat - 0.12, z - 0.1]),
            0.2,
        )
        .with_fill_fraction(
            &steel,
            block([-0.25, 0.0, z - 0.16], [0.25, 0.05, z - 0.1]),
            0.2,
        );
    let post = 0.36 * x;
    for side in [-1.0_f32, 1.0] {
        let a = side * post;
        body = body
            .with_fill_fraction(
                &steel,
                block([a - 0.03, 0.0, -z], [a + 0.03, 0.05, -0.2 * z]),
                0.2,
            )
            .with_fill_fraction(
                &steel,
                block([a - 0.03, 0.05, -z + 0.08], [a + 0.03, h - 0.06, -z + 0.14]),
                0.2,
            )
            .with(
                &steel,
                block(
                    [a - 0.03, h - 0.07, -z + 0.14],
                    [a + 0.03, h - 0.05, -z + 0.2],
                ),
            );
        for (k, r) in [0.14_f32, 0.11].into_iter().enumerate() {
            let plate = cylinder(r, 0.024, 24).rotated_z(FRAC_PI_2);
            body = body.with_fill_fraction(
                &iron,
                plate.translated(
                    side * (x - 0.12 + 0.03 * k as f32) + 0.012,
                    h - 0.035,
                    -z + 0.17,
                ),
                0.5,
            );
        }
    }
    let body = body
        .with_fill_fraction(
            &steel,
            block(
                [-post + 0.03, 0.2, -z + 0.09],
                [post - 0.03, 0.25, -z + 0.13],
            ),
            0.2,
        )
        .with(
            &chrome(),
            rod(
                [-x, h - 0.035, -z + 0.17],
                [x, h - 0.035, -z + 0.17],
                0.0145,
            ),
        );
    Model::fixed("weight_bench", "gym_equipment").part(body)
}
