//! Garden chairs and a garden swing.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{painted_steel, rattan, teak};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cushion, rod, rounded_block, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("garden_chair", "outdoor_seating", 145, garden_chair),
    CatalogueEntry::new("garden_swing", "swing", 146, garden_swing),
];

/// A chair for the garden or the balcony: of slats or basket work, with arms.
fn garden_chair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_chair", key);
    let (w, h, depth, seat) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
        d.sample_m("seat"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let (frame, slats) = match d.below("build", 3) {
        0 => (teak(), teak()),
        1 => (
            painted_steel(
                "garden_steel",
                d.choose("paint", [[54, 58, 60], [232, 232, 228], [70, 96, 82]]),
            ),
            style.wood.clone(),
        ),
        _ => (rattan(), rattan()),
    };
    let mut body = PartBuilder::new("body");
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.02);
        body = body
            .with(
                &frame,
                block([a - 0.02, 0.0, z - 0.05], [a + 0.02, seat + 0.2, z - 0.01]),
            )
            .with(
                &frame,
                block(
                    [a - 0.02, 0.0, -z + 0.05],
                    [a + 0.02, seat + 0.2, -z + 0.09],
                ),
            )
            .with(
                &frame,
                rounded_block(
                    [a - 0.02, seat + 0.2, -z + 0.03],
                    [a + 0.02, seat + 0.225, z],
                    0.006,
                    1,
                ),
            )
            .with(
                &frame,
                block(
                    [a - 0.012, seat - 0.07, -z + 0.09],
                    [a + 0.012, seat - 0.02, z - 0.05],
                ),
            );
    }
    let inner = x - 0.045;
    let count = 6;
    for k in 0..count {
        let from = -z + 0.07 + (2.0 * z - 0.09) * k as f32 / count as f32;
        let to = from + 0.8 * (2.0 * z - 0.09) / count as f32;
        body = body.with(
            &slats,
            block([-inner, seat - 0.02, from], [inner, seat, to]),
        );
    }
    let rise = (h - seat - 0.02) / 0.985;
    for k in 0..5 {
        let a = -inner + 2.0 * inner * k as f32 / 5.0;
        let b = a + 1.5 * inner / 5.0;
        body = body.with(
            &slats,
            block([a, 0.0, -0.009], [b, rise, 0.009])
                .rotated_x(-0.17)
                .translated(0.0, seat + 0.015, -z + 0.075),
        );
    }
    body = body.with(
        &frame,
        block(
            [-x + 0.02, seat - 0.02, -z + 0.052],
            [x - 0.02, seat + 0.014, -z + 0.07],
        ),
    );
    Model::movable("garden_chair", "outdoor_seating")
        .part(body)
        .with_support_surface(
            "seat",
            [-inner, seat, -z + 0.1],
            [inner, seat + 0.19, z - 0.03],
        )
}

/// A seat that hangs in a stand under a roof of cloth.
fn garden_swing(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_swing", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let steel = painted_steel(
        "garden_steel",
        d.choose("paint", [[54, 58, 60], [226, 226, 220], [66, 88, 76]]),
    );
    let cover = style.random_cloth(&mut d.stream("cover"));
    let r = 0.022;
    let mut body = PartBuilder::new("stand");
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - r);
        body = body
            .with_fill_fraction(
                &steel,
                tube(
                    &[
                        [a, r, z - r],
                        [a, h - 0.2, 0.03],
                        [a, h - 0.2, -0.03],
                        [a, r, -z + r],
                    ],
                    r,
                    8,
                ),
                0.25,
            )
            .with_fill_fraction(&steel, rod([a, r, z - r], [a, r, -z + r], r), 0.25);
        let chain = side * (x - 0.22);
        for at in [-0.22_f32, 0.22] {
            body = body.with(
                &steel,
                rod([chain, 0.6, at], [chain, h - 0.2, at * 0.3], 0.005).visual_only(),
            );
        }
    }
    let seat = x - 0.2;
    let roof = |from: f32, to: f32, y: f32, tilt: f32| {
        block([-x, 0.0, from], [x, 0.012, to])
            .rotated_x(tilt)
            .translated(0.0, y, 0.0)
    };
    let body = body
        .with_fill_fraction(
            &steel,
            rod([-x + r, h - 0.2, 0.0], [x - r, h - 0.2, 0.0], r),
            0.25,
        )
        .with(cover, roof(-0.77 * z, 0.0, h - 0.045, -0.14))
        .with(cover, roof(0.0, 0.77 * z, h - 0.045, 0.14))
        .with_fill_fraction(
            cover,
            cushion([-seat, 0.43, -0.25], [seat, 0.52, 0.27]),
            0.3 * cover.padded_fill_fraction(),
        )
        .with_fill_fraction(
            cover,
            cushion([-seat, 0.5, -0.31], [seat, 0.98, -0.21]),
            0.3 * cover.padded_fill_fraction(),
        )
        .with_fill_fraction(&steel, block([-seat, 0.4, -0.25], [seat, 0.43, 0.25]), 0.05);
    Model::fixed("garden_swing", "swing")
        .part(body)
        .with_support_surface(
            "seat",
            [-seat + 0.03, 0.52, -0.2],
            [seat - 0.03, 0.95, 0.24],
        )
}
