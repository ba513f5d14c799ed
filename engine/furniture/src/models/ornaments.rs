//! Sculptures, globes and small ornaments.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, oak};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, rounded_block, surface_of_revolution, torus};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("sculpture", "decoration", 183, sample_sculpture),
    CatalogueEntry::new("globe", "decoration", 184, sample_globe),
    CatalogueEntry::new("trinket", "trinket", 185, trinket),
];

/// A sculpture of two rings on a foot.
fn sculpture(stone: &Finish) -> Model {
    let body = PartBuilder::new("body")
        .with(&oak(), block([-0.06, 0.0, -0.04], [0.06, 0.03, 0.04]))
        .with(
            stone,
            torus(0.07, 0.014, 26)
                .rotated_x(FRAC_PI_2)
                .translated(-0.015, 0.11, 0.0),
        )
        .with(
            stone,
            torus(0.045, 0.011, 22)
                .rotated_x(FRAC_PI_2)
                .rotated_y(0.9)
                .translated(0.04, 0.083, 0.01)
                .visual_only(),
        );
    Model::pickable("sculpture", "decoration").part(body)
}

fn sample_sculpture(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sculpture", key);
    sculpture(style.random_glaze(&mut d.stream("stone"))).resized(d.sample_m("height") / 0.194)
}

/// A globe of the earth on a stand.
fn globe() -> Model {
    let sea = Finish::tiled(
        "globe_map",
        "paper",
        "marble",
        [[70, 130, 180], [110, 150, 80], [150, 170, 100]],
        0.5,
    );
    let body = PartBuilder::new("body")
        .with(&oak(), cylinder(0.07, 0.02, 22))
        .with(&oak(), cylinder(0.01, 0.05, 12).translated(0.0, 0.02, 0.0))
        .with_fill_fraction(&sea, ball(0.11, 24).translated(0.0, 0.175, 0.0), 0.05);
    Model::pickable("globe", "decoration").part(body)
}

fn sample_globe(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("globe", key);
    let globe = globe().resized(d.sample_m("height") / 0.285);
    let wood = &style.wood;
    if wood.tile_m > 0.0 {
        globe.with_finish_replaced("oak", wood)
    } else {
        globe
    }
}

/// A small ornament: a bird, a snow globe, a pyramid of stone, or a box.
fn trinket(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("trinket", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let glaze = style.random_glaze(&mut d.stream("glaze"));
    let body = PartBuilder::new("body");
    let body = match d.below("build", 4) {
        0 => {
            let tail = block([-r, 0.3 * h, -0.1 * w], [-0.5 * r, 0.4 * h, 0.1 * w]);
            let beak = crate::shapes::cone(0.06 * w, 0.006 * w, 0.2 * w, 8).rotated_z(-FRAC_PI_2);
            body.with_fill_fraction(
                glaze,
                surface_of_revolution(
                    &[
                        (0.0, 0.0),
                        (0.5 * r, 0.0),
                        (0.72 * r, 0.25 * h),
                        (0.5 * r, 0.55 * h),
                        (0.0, 0.6 * h),
                    ],
                    16,
                ),
                0.6,
            )
            .with(glaze, ball(0.2 * h, 14).translated(0.28 * r, 0.8 * h, 0.0))
            .with(glaze, tail.visual_only())
            .with(
                &style.metal,
                beak.translated(0.28 * r + 0.15 * h, 0.8 * h, 0.0)
                    .visual_only(),
            )
        }
        1 => body
            .with(&style.wood, cylinder(0.8 * r, 0.25 * h, 20))
            .with_fill_fraction(
                &crate::finishes::glass(),
                surface_of_revolution(
                    &[
                        (0.0, 0.25 * h),
                        (0.7 * r, 0.25 * h),
                        (r, 0.6 * h),
                        (0.7 * r, 0.9 * h),
                        (0.0, h),
                    ],
                    20,
                ),
                0.9,
            ),
        2 => body.with(
            glaze,
            crate::shapes::tapered_leg([0.0; 3], [0.0, h, 0.0], w, 0.05 * w),
        ),
        _ => body
            .with(
                &style.wood,
                rounded_block([-r, 0.0, -0.7 * r], [r, 0.75 * h, 0.7 * r], 0.006, 1),
            )
            .with(
                &style.wood,
                rounded_block([-r, 0.76 * h, -0.7 * r], [r, h, 0.7 * r], 0.006, 1),
            )
            .with(
                &style.metal,
                block([-0.1 * r, 0.6 * h, 0.7 * r], [0.1 * r, 0.8 * h, 0.72 * r]),
            ),
    };
    Model::pickable("trinket", "trinket").part(body)
}
