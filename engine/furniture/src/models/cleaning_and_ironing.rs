//! A vacuum cleaner, an iron and an ironing board.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{black_plastic, chrome, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, extrude, rod, rounded_block, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("vacuum_cleaner", "vacuum_cleaner", 64, vacuum_cleaner),
    CatalogueEntry::new("iron", "iron", 65, iron),
    CatalogueEntry::new("ironing_board", "ironing_board", 66, ironing_board),
];

/// A vacuum cleaner on wheels with its hose and nozzle put away upright.
fn vacuum_cleaner(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("vacuum_cleaner", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let shell = plastic(
        "vacuum_shell",
        d.choose(
            "tone",
            [
                [176, 40, 44],
                [40, 84, 150],
                [60, 62, 66],
                [64, 120, 90],
                [222, 170, 50],
            ],
        ),
    );
    let tank = (0.3 * h).min(0.26);
    let wheel = |sx: f32| {
        cylinder(0.07, 0.03, 18).rotated_z(FRAC_PI_2).translated(
            sx * (x - 0.015) + 0.015,
            0.07,
            -z + 0.09,
        )
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &shell,
            rounded_block([-x + 0.035, 0.02, -z], [x - 0.035, tank, z - 0.09], 0.06, 3),
            0.3,
        )
        .with_all(&black_plastic(), [wheel(-1.0), wheel(1.0)])
        .with(
            &black_plastic(),
            ball(0.03, 10).translated(0.0, 0.03, z - 0.13),
        )
        .with(
            &black_plastic(),
            rounded_block([-x, 0.0, z - 0.085], [x, 0.035, z], 0.012, 1),
        )
        .with_fill_fraction(
            &chrome(),
            rod([0.0, 0.03, z - 0.05], [0.0, h - 0.06, z - 0.12], 0.016),
            0.2,
        )
        .with(
            &black_plastic(),
            tube(
                &[
                    [0.0, h - 0.06, z - 0.12],
                    [0.0, h - 0.017, z - 0.15],
                    [0.0, h - 0.017, z - 0.24],
                ],
                0.017,
                8,
            ),
        )
        .with_fill_fraction(
            &black_plastic(),
            tube(
                &[
                    [0.0, h - 0.017, z - 0.24],
                    [0.05, 0.62 * h, z - 0.34],
                    [0.06, 0.42 * h, -0.02],
                    [0.0, tank - 0.02, 0.02],
                ],
                0.019,
                8,
            )
            .visual_only(),
            0.3,
        );
    Model::movable("vacuum_cleaner", "vacuum_cleaner")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.1, -z + 0.05], "noise", 72.0)
}

/// An iron standing on its heel; the tip points up, the plate to -Z.
fn iron(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("iron", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let shell = plastic(
        "iron_shell",
        d.choose(
            "tone",
            [[60, 110, 170], [150, 60, 120], [70, 74, 78], [60, 140, 130]],
        ),
    );
    let outline = |s: f32| {
        [
            [-s * x, 0.0],
            [s * x, 0.0],
            [s * x, 0.45 * h],
            [0.55 * s * x, 0.8 * h],
            [0.0, h],
            [-0.55 * s * x, 0.8 * h],
            [-s * x, 0.45 * h],
        ]
    };
    let body = PartBuilder::new("body")
        .with(
            &steel(),
            extrude(&outline(1.0), 0.012).translated(0.0, 0.0, -z),
        )
        .with_fill_fraction(
            &shell,
            extrude(&outline(0.92).map(|[a, b]| [a, b * 0.94]), 0.05).translated(
                0.0,
                0.0,
                -z + 0.012,
            ),
            0.7,
        )
        .with_fill_fraction(
            &shell,
            block([-0.5 * x, 0.0, -z + 0.062], [0.5 * x, 0.035, z]),
            0.6,
        )
        .with(
            &shell,
            block(
                [-0.4 * x, 0.62 * h, -z + 0.062],
                [0.4 * x, 0.7 * h, z - 0.01],
            ),
        )
        .with(
            &black_plastic(),
            rod([0.0, 0.02, z - 0.02], [0.0, 0.68 * h, z - 0.025], 0.015),
        );
    Model::pickable("iron", "iron")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.5 * h, -z], "noise", 56.0)
}

/// An ironing board on crossed legs.
fn ironing_board(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ironing_board", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let cover = style.random_cloth(&mut d.stream("cover"));
    let outline = [
        [-x, -z],
        [0.55 * x, -z],
        [0.85 * x, -0.6 * z],
        [x, -0.2 * z],
        [x, 0.2 * z],
        [0.85 * x, 0.6 * z],
        [0.55 * x, z],
        [-x, z],
    ];
    let board = crate::shapes::extrude(&outline, 0.03).rotated_x(-FRAC_PI_2);
    let leg = |s: f32, b: f32| rod([-s * 0.6 * x, 0.014, b], [s * 0.6 * x, h - 0.035, b], 0.012);
    let foot = |s: f32, half: f32| {
        rod(
            [s * 0.6 * x, 0.014, -half],
            [s * 0.6 * x, 0.014, half],
            0.014,
        )
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(cover, board.translated(0.0, h - 0.03, 0.0), 0.5)
        .with_fill_fraction(&style.metal, leg(1.0, -0.03).merged(leg(-1.0, 0.03)), 0.35)
        .with_fill_fraction(&style.metal, foot(-1.0, z).merged(foot(1.0, z)), 0.35);
    Model::movable("ironing_board", "ironing_board")
        .part(body)
        .with_support_surface(
            "board",
            [-0.9 * x, h, -0.7 * z],
            [0.5 * x, h + 0.4, 0.7 * z],
        )
}
