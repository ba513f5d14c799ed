//! A bicycle.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, ball, block, cylinder, rod, rounded_block, torus, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, TAU};

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("bicycle", "bicycle", 138, bicycle)];

/// A bicycle on its stand, riding towards +X.
fn bicycle(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bicycle", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let paint = painted_steel(
        "bicycle_paint",
        d.choose(
            "paint",
            [
                [176, 40, 44],
                [40, 90, 150],
                [40, 44, 46],
                [70, 130, 100],
                [222, 200, 160],
            ],
        ),
    );
    let rubber = Finish::plain("tyre", "rubber", [32, 32, 34]);
    let r = 0.195 * w;
    let (rear, ahead) = ([-0.5 * w + r, r, 0.0], [0.5 * w - r, r, 0.0]);
    let (saddle, crank, head) = (
        [-0.12 * w, h - 0.1, 0.0],
        [-0.06 * w, r - 0.06, 0.0],
        [0.22 * w, h - 0.16, 0.0],
    );
    let seat_tube = [-0.1 * w, 0.68 * h, 0.0];
    let head_low = [0.245 * w, 0.62 * h, 0.0];
    let bar = 0.015;
    let tubes = [
        rod(crank, saddle, bar),
        rod(seat_tube, head, bar),
        rod(crank, head_low, bar),
        rod(rear, crank, 0.01),
        rod(rear, seat_tube, 0.009),
        rod(ahead, head_low, 0.012),
        rod(head_low, head, 0.018),
    ];
    let wheel = |at: [f32; 3]| {
        torus(r - 0.018, 0.018, 32)
            .rotated_x(FRAC_PI_2)
            .translated(at[0], at[1], at[2])
    };
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(&rubber, wheel(rear).merged(wheel(ahead)), 0.45)
        .with_fill_fraction(
            &paint,
            tubes
                .into_iter()
                .fold(SolidMesh::default(), SolidMesh::merged),
            0.16,
        )
        .with_fill_fraction(
            &black_plastic(),
            rounded_block(
                [saddle[0] - 0.14, h - 0.1, -0.07],
                [saddle[0] + 0.12, h - 0.04, 0.07],
                0.025,
                2,
            ),
            0.5,
        )
        .with_fill_fraction(
            &chrome(),
            tube(
                &[
                    [head[0] - 0.08, h - 0.02, -0.28],
                    [head[0] + 0.02, h - 0.02, -0.1],
                    [head[0] + 0.02, h - 0.02, 0.1],
                    [head[0] - 0.08, h - 0.02, 0.28],
                ],
                0.011,
                8,
            ),
            0.3,
        )
        .with_fill_fraction(
            &chrome(),
            rod(head, [head[0] + 0.02, h - 0.02, 0.0], 0.012),
            0.3,
        )
        .with_fill_fraction(
            &chrome(),
            cylinder(0.09, 0.008, 20)
                .rotated_x(FRAC_PI_2)
                .translated(crank[0], crank[1], 0.03),
            0.3,
        )
        .with_fill_fraction(
            &chrome(),
            rod(
                [crank[0] - 0.1, crank[1] + 0.13, 0.06],
                [crank[0] + 0.1, crank[1] - 0.13, 0.06],
                0.008,
            ),
            0.5,
        )
        .with(
            &black_plastic(),
            block(
                [crank[0] - 0.15, crank[1] + 0.12, 0.05],
                [crank[0] - 0.06, crank[1] + 0.14, 0.13],
            ),
        )
        .with(
            &black_plastic(),
            block(
                [crank[0] + 0.06, crank[1] - 0.14, -0.13],
                [crank[0] + 0.15, crank[1] - 0.12, -0.05],
            ),
        )
        // A stand of two legs under the bottom bracket.
        .with(
            &black_plastic(),
            ball(0.01, 8).translated(crank[0] - 0.08, 0.01, 0.16),
        )
        .with(
            &black_plastic(),
            ball(0.01, 8).translated(crank[0] - 0.08, 0.01, -0.16),
        )
        .with(
            &black_plastic(),
            rod(
                [crank[0], crank[1], 0.0],
                [crank[0] - 0.08, 0.008, 0.16],
                0.01,
            ),
        )
        .with(
            &black_plastic(),
            rod(
                [crank[0], crank[1], 0.0],
                [crank[0] - 0.08, 0.008, -0.16],
                0.01,
            ),
        );
    for hub in [rear, ahead] {
        for k in 0..6 {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 12.0);
            let (a, b) = ((r - 0.03) * cos, (r - 0.03) * sin);
            body = body.with(
                &chrome(),
                rod(
                    [hub[0] - a, hub[1] - b, 0.0],
                    [hub[0] + a, hub[1] + b, 0.0],
                    0.0016,
                )
                .visual_only(),
            );
        }
    }
    Model::movable("bicycle", "bicycle").part(body)
}
