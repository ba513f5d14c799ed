//! A guitar on its stand.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, extrude, rod};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("guitar", "guitar", 132, guitar)];

/// A guitar on its stand, strings towards +Z.
fn guitar(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("guitar", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let top = Finish::tiled(
        "spruce",
        "wood",
        "wood",
        [
            d.choose(
                "top",
                [[222, 176, 108], [196, 120, 60], [120, 60, 40], [60, 40, 34]],
            ),
            [170, 116, 66],
            [0; 3],
        ],
        0.5,
    );
    let side = Finish::plain("rosewood", "wood", [92, 52, 38]);
    let ebony = Finish::plain("ebony", "wood", [38, 30, 28]);
    // An outline in the plane of the strings, from the lower bout up; the waist is at 0.6 of the body's height.
    let tall = 0.48 * h;
    let outline = [
        [0.0, 0.0],
        [0.62, 0.03],
        [0.95, 0.16],
        [1.0, 0.3],
        [0.88, 0.46],
        [0.68, 0.6],
        [0.7, 0.76],
        [0.74, 0.86],
        [0.56, 0.97],
        [0.16, 1.0],
    ];
    let right = outline.iter().map(|[a, b]| [a * x, b * tall]);
    let left = outline
        .iter()
        .rev()
        .filter(|p| p[0] > 0.0)
        .map(|[a, b]| [-a * x, b * tall]);
    let shape: Vec<[f32; 2]> = right.chain(left).collect();
    let (low, back) = (0.1, -0.045);
    let deep = 0.09;
    let mut box_of = extrude(&shape, deep).translated(0.0, low, back);
    // The waist is hollow: two convex halves stand for the body.
    box_of.colliders = [(0.02, 0.55, 0.93), (0.55, 0.98, 0.72)]
        .into_iter()
        .flat_map(|(a, b, s): (f32, f32, f32)| {
            block(
                [-s * x, low + a * tall, back],
                [s * x, low + b * tall, back + deep],
            )
            .colliders
        })
        .collect();
    let neck = low + tall;
    let face = back + deep;
    let body = PartBuilder::new("body")
        .with_fill_fraction(&side, box_of, 0.09)
        .with(
            &top,
            extrude(
                &shape
                    .iter()
                    .map(|[a, b]| [0.985 * a, 0.985 * b + 0.0075 * tall])
                    .collect::<Vec<_>>(),
                0.003,
            )
            .translated(0.0, low, face)
            .visual_only(),
        )
        .with(
            &ebony,
            cylinder(0.05, 0.0015, 24)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, low + 0.66 * tall, face + 0.003)
                .visual_only(),
        )
        .with(
            &ebony,
            block(
                [-0.08, low + 0.26 * tall, face + 0.003],
                [0.08, low + 0.29 * tall, face + 0.012],
            )
            .visual_only(),
        )
        .with(
            &side,
            block(
                [-0.026, neck - 0.1, face - 0.02],
                [0.026, h - 0.17, face + 0.006],
            ),
        )
        .with(
            &ebony,
            block(
                [-0.026, neck - 0.12, face + 0.006],
                [0.026, h - 0.17, face + 0.011],
            ),
        )
        .with(
            &side,
            block([-0.034, h - 0.17, face - 0.016], [0.034, h, face + 0.004]),
        )
        .with(
            &chrome(),
            block(
                [-0.05, h - 0.14, face - 0.008],
                [0.05, h - 0.13, face - 0.002],
            )
            .merged(block(
                [-0.05, h - 0.06, face - 0.008],
                [0.05, h - 0.05, face - 0.002],
            ))
            .visual_only(),
        )
        .with(
            &black_plastic(),
            ball(0.012, 8).translated(-0.8 * x, 0.012, z - 0.012),
        )
        .with(
            &black_plastic(),
            ball(0.012, 8).translated(0.8 * x, 0.012, z - 0.012),
        )
        .with(
            &black_plastic(),
            ball(0.012, 8).translated(0.0, 0.012, -z + 0.012),
        )
        // The stand: two feet to the front and one behind, a yoke below, a prop at the back.
        .with(
            &black_plastic(),
            rod(
                [-0.8 * x, 0.012, z - 0.012],
                [0.0, 0.11, back - 0.03],
                0.011,
            ),
        )
        .with(
            &black_plastic(),
            rod([0.8 * x, 0.012, z - 0.012], [0.0, 0.11, back - 0.03], 0.011),
        )
        .with(
            &black_plastic(),
            rod(
                [0.0, 0.012, -z + 0.012],
                [0.0, 0.6 * neck, back - 0.012],
                0.011,
            ),
        )
        .with(
            &black_plastic(),
            block([-0.1, low - 0.015, back - 0.03], [0.1, low, face + 0.01]),
        );
    Model::movable("guitar", "guitar").part(body)
}
