//! A grill.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, painted_steel, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new("grill", "grill", 149, grill)];

/// A grill: a kettle on three legs or a wagon with a hood that opens.
fn grill(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("grill", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let enamel = painted_steel(
        "grill_enamel",
        d.choose(
            "tone",
            [[34, 34, 36], [130, 34, 38], [60, 80, 70], [168, 171, 175]],
        ),
    );
    let bowl = 0.42 * w.min(depth * 1.2);
    let rim = h - 0.26;
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &enamel,
            block([-bowl, rim - 0.16, -0.8 * z], [bowl, rim, 0.8 * z]),
            0.06,
        )
        .with_fill_fraction(
            &steel(),
            block(
                [-bowl + 0.02, rim, -0.8 * z + 0.02],
                [bowl - 0.02, rim + 0.006, 0.8 * z - 0.02],
            ),
            0.4,
        )
        .with(
            &oiled_slats(),
            block(
                [-x, rim - 0.04, -0.6 * z],
                [-bowl - 0.004, rim - 0.015, 0.6 * z],
            ),
        )
        .with(
            &oiled_slats(),
            block(
                [bowl + 0.004, rim - 0.04, -0.6 * z],
                [x, rim - 0.015, 0.6 * z],
            ),
        );
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (bowl - 0.03), sz * (0.7 * z));
        body = body.with_fill_fraction(
            &black_plastic(),
            block(
                [a - 0.018, 0.0, b - 0.018],
                [a + 0.018, rim - 0.16, b + 0.018],
            ),
            0.5,
        );
    }
    let knob = |k: usize| {
        cylinder(0.022, 0.022, 14).rotated_x(FRAC_PI_2).translated(
            -0.5 * bowl + 0.5 * bowl * k as f32,
            rim - 0.1,
            0.8 * z,
        )
    };
    let wheel = |s: f32| {
        cylinder(0.08, 0.03, 18).rotated_z(FRAC_PI_2).translated(
            s * (bowl + 0.01) + 0.015,
            0.08,
            -0.7 * z,
        )
    };
    let body = body
        .with_fill_fraction(
            &black_plastic(),
            block(
                [-bowl + 0.015, 0.16, -0.7 * z + 0.018],
                [bowl - 0.015, 0.175, 0.7 * z - 0.018],
            ),
            0.5,
        )
        .with_all(&black_plastic(), (0..3).map(knob))
        .with_all(&black_plastic(), [wheel(-1.0), wheel(1.0)]);
    let side = [
        [-0.8 * z, 0.0],
        [0.8 * z, 0.0],
        [0.72 * z, 0.12],
        [0.35 * z, 0.24],
        [-0.35 * z, 0.24],
        [-0.72 * z, 0.12],
    ];
    // The profile in (z, y), drawn out along x.
    let hood = crate::shapes::extrude(
        &side
            .map(|[a, y]| [-a, y])
            .iter()
            .rev()
            .copied()
            .collect::<Vec<_>>(),
        2.0 * bowl,
    )
    .rotated_y(FRAC_PI_2)
    .translated(-bowl, rim + 0.01, 0.0);
    let lid = PartBuilder::new("lid")
        .with_fill_fraction(&enamel, hood, 0.05)
        .with(
            &steel(),
            rod(
                [-0.6 * bowl, rim + 0.09, 0.8 * z + 0.03],
                [0.6 * bowl, rim + 0.09, 0.8 * z + 0.03],
                0.01,
            ),
        )
        .with(
            &steel(),
            rod(
                [-0.5 * bowl, rim + 0.09, 0.7 * z],
                [-0.5 * bowl, rim + 0.09, 0.8 * z + 0.03],
                0.007,
            )
            .visual_only(),
        )
        .with(
            &steel(),
            rod(
                [0.5 * bowl, rim + 0.09, 0.7 * z],
                [0.5 * bowl, rim + 0.09, 0.8 * z + 0.03],
                0.007,
            )
            .visual_only(),
        );
    Model::articulated("grill", "grill")
        .with_switch_state(false)
        .part(body)
        .with_support_surface(
            "side_table",
            [bowl + 0.01, rim - 0.015, -0.55 * z],
            [x - 0.01, rim + 0.4, 0.55 * z],
        )
        .part(lid)
        .hinged("lid", [0.0, rim + 0.01, -0.8 * z], Vec3::NEG_X, 1.2)
}

/// Oiled slats beside a grill.
const fn oiled_slats() -> Finish {
    Finish::tiled(
        "grill_wood",
        "wood",
        "wood",
        [[150, 104, 66], [116, 76, 46], [0; 3]],
        0.6,
    )
}
