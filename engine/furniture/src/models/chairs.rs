//! Chairs of other builds than the slatted one, bar stools, benches, garden seats, a swing.

use super::chair::Chair;
use crate::finishes::{Finish, painted_steel, plastic, rattan};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cushion, cylinder, extrude, rod, rounded_block, tapered_leg, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;

const CORNERS: [(f32, f32); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];

/// A dining chair: slatted, upholstered or a shell on rods.
pub fn dining_chair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dining_chair", key);
    match d.below("build", 3) {
        0 => slatted(style, &d),
        1 => upholstered(style, &d),
        _ => shell(style, &d),
    }
}

fn slatted(style: &Style, d: &SizeSampler) -> Model {
    let cloth = style.cloth(&mut d.stream("pad")).clone();
    Chair {
        width_m: d.m("width"),
        seat_m: d.m("seat"),
        back_m: d.m("height"),
        slats: d.of("slats", [2, 3, 4]),
        wood: style.any_wood(&mut d.stream("wood")).clone(),
        pad: d.chance("padded", 0.6).then_some(cloth),
    }
    .build()
}

fn upholstered(style: &Style, d: &SizeSampler) -> Model {
    let (w, h, depth, seat) = (d.m("width"), d.m("height"), d.m("depth"), d.m("seat"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let cover = style.cover(&mut d.stream("cover"));
    let under = seat - 0.09;
    let body = PartBuilder::new("body")
        .with_bars(
            style.leg_finish(),
            style.legs([x - 0.035, z - 0.04], under, 0.04),
        )
        .with_filled(
            cover,
            rounded_block([-x, under, -z], [x, seat, z], 0.03, 2),
            0.5 * cover.padded(),
        )
        .with_filled(
            cover,
            rounded_block(
                [-x + 0.01, seat - 0.02, -z],
                [x - 0.01, h, -z + 0.07],
                0.03,
                2,
            ),
            0.5 * cover.padded(),
        );
    Model::movable("dining_chair", "chair").part(body).top(
        "seat",
        [-x + 0.03, seat, -z + 0.08],
        [x - 0.03, seat + 0.4, z - 0.02],
    )
}

fn shell(style: &Style, d: &SizeSampler) -> Model {
    let (w, h, depth, seat) = (d.m("width"), d.m("height"), d.m("depth"), d.m("seat"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let tone = d.of(
        "tone",
        [
            [238, 236, 230],
            [52, 54, 58],
            [196, 116, 76],
            [112, 140, 128],
            [206, 172, 84],
        ],
    );
    let hull = plastic("chair_shell", tone);
    let (half, rise) = (x - 0.03, h - seat + 0.02);
    // A back that narrows upwards, with cut corners.
    let outline = [
        [-half, 0.0],
        [half, 0.0],
        [half, 0.45 * rise],
        [0.86 * half, 0.85 * rise],
        [0.6 * half, rise],
        [-0.6 * half, rise],
        [-0.86 * half, 0.85 * rise],
        [-half, 0.45 * rise],
    ];
    let back = extrude(&outline, 0.014).about_x(-0.17);
    let mut body = PartBuilder::new("body")
        .with(
            &hull,
            rounded_block(
                [-x + 0.02, seat - 0.022, -z + 0.05],
                [x - 0.02, seat, z],
                0.0105,
                2,
            ),
        )
        .with(&hull, back.at(0.0, seat - 0.015, -z + 0.07));
    let legs = if d.chance("metal", 0.5) {
        &style.metal
    } else {
        &style.wood
    };
    for (sx, sz) in CORNERS {
        let foot = [sx * (x - 0.012), 0.0, sz * (z - 0.03)];
        let top = [sx * 0.12, seat - 0.02, sz * 0.11];
        body = body.with_bar(legs, tapered_leg(foot, top, 0.02, 0.03));
    }
    Model::movable("dining_chair", "chair").part(body).top(
        "seat",
        [-x + 0.05, seat, -z + 0.11],
        [x - 0.05, seat + 0.4, z - 0.02],
    )
}

/// A high stool for a counter, with a ring or bars for the feet.
pub fn bar_stool(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bar_stool", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let (out, inner, under) = (0.5 * w - 0.014, 0.32 * w, h - 0.05);
    let legs = style.leg_finish();
    let cover = style.cover(&mut d.stream("cover"));
    let mut body = PartBuilder::new("body");
    for (sx, sz) in CORNERS {
        let leg = tapered_leg(
            [sx * out, 0.0, sz * out],
            [sx * inner, under, sz * inner],
            0.026,
            0.03,
        );
        body = body.with_bar(legs, leg);
    }
    let y = 0.32 * h;
    let r = out + (inner - out) * y / under;
    body = body.with_bars(
        legs,
        [
            rod([-r, y, -r], [r, y, -r], 0.009),
            rod([-r, y, r], [r, y, r], 0.009),
            rod([-r, y, -r], [-r, y, r], 0.009),
            rod([r, y, -r], [r, y, r], 0.009),
        ],
    );
    body = if d.chance("round", 0.5) {
        body.with_filled(
            cover,
            cylinder(0.46 * w, 0.05, 24).at(0.0, under, 0.0),
            0.5 * cover.padded(),
        )
    } else {
        let s = 0.44 * w;
        body.with_filled(
            cover,
            rounded_block([-s, under, -s], [s, h, s], 0.018, 2),
            0.5 * cover.padded(),
        )
    };
    let half = 0.3 * w;
    Model::movable("bar_stool", "stool").part(body).top(
        "seat",
        [-half, h, -half],
        [half, h + 0.4, half],
    )
}

/// A plain bench: for a long table, a hall or the foot of a bed.
pub fn bench(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bench", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let padded = d.chance("padded", 0.4);
    let board = if padded { h - 0.05 } else { h };
    let wood = style.any_wood(&mut d.stream("wood"));
    let mut body = PartBuilder::new("body")
        .with(
            wood,
            rounded_block([-x, board - 0.035, -z], [x, board, z], 0.008, 1),
        )
        .with(
            wood,
            block(
                [-x + 0.08, board - 0.1, -0.012],
                [x - 0.08, board - 0.035, 0.012],
            ),
        )
        .with_bars(
            style.leg_finish(),
            style.legs([x - 0.06, z - 0.05], board - 0.035, 0.05),
        );
    if padded {
        let pad = rounded_block(
            [-x + 0.004, board, -z + 0.004],
            [x - 0.004, h, z - 0.004],
            0.02,
            2,
        );
        let cover = style.cover(&mut d.stream("cover"));
        body = body.with_filled(cover, pad, 0.4 * cover.padded());
    }
    Model::movable("bench", "bench_chair").part(body).top(
        "seat",
        [-x + 0.02, h, -z + 0.02],
        [x - 0.02, h + 0.45, z - 0.02],
    )
}

/// A chair for the garden or the balcony: of slats or basket work, with arms.
pub fn garden_chair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_chair", key);
    let (w, h, depth, seat) = (d.m("width"), d.m("height"), d.m("depth"), d.m("seat"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let teak = Finish::tiled(
        "teak",
        "wood",
        "wood",
        [[178, 128, 82], [146, 98, 58], [0; 3]],
        0.8,
    );
    let (frame, slats) = match d.below("build", 3) {
        0 => (teak.clone(), teak),
        1 => (
            painted_steel(
                "garden_steel",
                d.of("paint", [[54, 58, 60], [232, 232, 228], [70, 96, 82]]),
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
            block([a, 0.0, -0.009], [b, rise, 0.009]).about_x(-0.17).at(
                0.0,
                seat + 0.015,
                -z + 0.075,
            ),
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
        .top(
            "seat",
            [-inner, seat, -z + 0.1],
            [inner, seat + 0.19, z - 0.03],
        )
}

/// A seat that hangs in a stand under a roof of cloth.
pub fn garden_swing(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_swing", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let steel = painted_steel(
        "garden_steel",
        d.of("paint", [[54, 58, 60], [226, 226, 220], [66, 88, 76]]),
    );
    let cover = style.cloth(&mut d.stream("cover"));
    let r = 0.022;
    let mut body = PartBuilder::new("stand");
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - r);
        body = body
            .with_filled(
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
            .with_filled(&steel, rod([a, r, z - r], [a, r, -z + r], r), 0.25);
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
            .about_x(tilt)
            .at(0.0, y, 0.0)
    };
    let body = body
        .with_filled(
            &steel,
            rod([-x + r, h - 0.2, 0.0], [x - r, h - 0.2, 0.0], r),
            0.25,
        )
        .with(cover, roof(-0.77 * z, 0.0, h - 0.045, -0.14))
        .with(cover, roof(0.0, 0.77 * z, h - 0.045, 0.14))
        .with_filled(
            cover,
            cushion([-seat, 0.43, -0.25], [seat, 0.52, 0.27]),
            0.3 * cover.padded(),
        )
        .with_filled(
            cover,
            cushion([-seat, 0.5, -0.31], [seat, 0.98, -0.21]),
            0.3 * cover.padded(),
        )
        .with_filled(&steel, block([-seat, 0.4, -0.25], [seat, 0.43, 0.25]), 0.05);
    Model::fixed("garden_swing", "swing").part(body).top(
        "seat",
        [-seat + 0.03, 0.52, -0.2],
        [seat - 0.03, 0.95, 0.24],
    )
}
