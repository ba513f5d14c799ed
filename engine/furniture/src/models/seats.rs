//! Office chairs, stools, ottomans, benches.

use crate::finishes::{Finish, black, chrome};
use crate::model::{Model, PartBuilder};
use crate::shapes::{ball, block, cushion, cylinder, rod, rounded_block, tapered_leg};
use std::f32::consts::TAU;

/// A swivel chair on five castors.
pub fn office_chair(cloth: &Finish) -> Model {
    let dark = black();
    let mut body =
        PartBuilder::new("body").with(&chrome(), cylinder(0.025, 0.34, 14).at(0.0, 0.09, 0.0));
    for k in 0..5 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 5.0);
        let (x, z) = (0.28 * sin, 0.28 * cos);
        body = body
            .with(&dark, rod([0.0, 0.1, 0.0], [x, 0.07, z], 0.016))
            .with(&dark, ball(0.03, 12).at(x, 0.03, z));
    }
    let body = body
        .with(&dark, block([-0.2, 0.43, -0.2], [0.2, 0.445, 0.2]))
        .with_filled(
            cloth,
            cushion([-0.24, 0.445, -0.23], [0.24, 0.52, 0.25]),
            0.7 * cloth.padded(),
        )
        .with(&dark, block([-0.03, 0.43, -0.27], [0.03, 0.72, -0.245]))
        .with_filled(
            cloth,
            cushion([-0.22, 0.62, -0.245], [0.22, 1.08, -0.175]),
            0.7 * cloth.padded(),
        );
    let mut body = body;
    for side in [-1.0, 1.0] {
        body = body
            .with(
                &dark,
                block(
                    [side * 0.26 - 0.012, 0.43, -0.04],
                    [side * 0.26 + 0.012, 0.66, 0.0],
                ),
            )
            .with(
                &dark,
                block(
                    [side * 0.23 - 0.03, 0.43, -0.04],
                    [side * 0.23 + 0.03, 0.445, 0.0],
                ),
            )
            .with(
                &dark,
                rounded_block(
                    [side * 0.26 - 0.03, 0.66, -0.12],
                    [side * 0.26 + 0.03, 0.69, 0.14],
                    0.012,
                    1,
                ),
            );
    }
    Model::movable("office_chair", "office_chair")
        .part(body)
        .top("seat", [-0.2, 0.52, -0.16], [0.2, 0.9, 0.22])
}

/// A round stool on four legs.
pub fn stool(height_m: f32, wood: &Finish, legs: &Finish) -> Model {
    let under = height_m - 0.035;
    let mut body =
        PartBuilder::new("body").with(wood, cylinder(0.17, 0.035, 26).at(0.0, under, 0.0));
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        body = body.with_bar(
            legs,
            tapered_leg(
                [0.15 * x, 0.0, 0.15 * z],
                [0.09 * x, under, 0.09 * z],
                0.024,
                0.034,
            ),
        );
    }
    let bar = height_m * 0.3;
    let out = 0.13;
    body = body.with_bars(
        legs,
        [
            rod([-out, bar, -out], [out, bar, -out], 0.009),
            rod([-out, bar, out], [out, bar, out], 0.009),
            rod([-out, bar, -out], [-out, bar, out], 0.009),
            rod([out, bar, -out], [out, bar, out], 0.009),
        ],
    );
    Model::movable("stool", "stool").part(body).top(
        "seat",
        [-0.12, height_m, -0.12],
        [0.12, height_m + 0.4, 0.12],
    )
}

/// A round footstool of cloth.
pub fn pouf(radius_m: f32, height_m: f32, cloth: &Finish) -> Model {
    let (r, h) = (radius_m, height_m);
    let shape = [
        (0.0, 0.0),
        (0.86 * r, 0.0),
        (r, 0.18 * h),
        (1.02 * r, 0.5 * h),
        (r, 0.82 * h),
        (0.86 * r, h),
        (0.0, h),
    ];
    let body = PartBuilder::new("body")
        .with_padding(cloth, crate::shapes::surface_of_revolution(&shape, 28));
    let half = 0.5 * r;
    Model::movable("pouf", "ottoman").part(body).top(
        "top",
        [-half, h, -half],
        [half, h + 0.4, half],
    )
}

/// A bench with a shelf for shoes and a cushion.
pub fn shoe_bench(width_m: f32, wood: &Finish, cloth: &Finish) -> Model {
    let (x, z, h) = (0.5 * width_m, 0.17, 0.43);
    let slat = |k: usize| {
        let a = -z + 0.02 + 0.08 * k as f32;
        block([-x + 0.025, 0.14, a], [x - 0.025, 0.158, a + 0.055])
    };
    let body = PartBuilder::new("body")
        .with(wood, block([-x, 0.0, -z], [-x + 0.025, h, z]))
        .with(wood, block([x - 0.025, 0.0, -z], [x, h, z]))
        .with(wood, block([-x + 0.025, h - 0.025, -z], [x - 0.025, h, z]))
        .with_all(wood, (0..4).map(slat))
        .with_filled(
            cloth,
            rounded_block(
                [-x + 0.01, h, -z + 0.01],
                [x - 0.01, h + 0.05, z - 0.01],
                0.02,
                2,
            ),
            0.5 * cloth.padded(),
        );
    Model::movable("shoe_bench", "bench_chair")
        .part(body)
        .top(
            "seat",
            [-x + 0.02, h + 0.05, -z + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        )
        .top(
            "shelf",
            [-x + 0.03, 0.158, -z + 0.02],
            [x - 0.03, h - 0.03, z],
        )
}
