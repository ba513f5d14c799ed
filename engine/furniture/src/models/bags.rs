//! Handbags and backpacks.

use super::clothes::CLOTHING_COLORS;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, leather};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("handbag", "bag", 194, sample_handbag),
    CatalogueEntry::new("backpack", "bag", 195, backpack),
];

/// A bag with two handles.
fn handbag() -> Model {
    let hide = leather("cognac_leather", [150, 88, 48]);
    let arc = |z: f32| {
        let path = [
            [-0.08, 0.24, z],
            [-0.07, 0.33, z],
            [0.0, 0.37, z],
            [0.07, 0.33, z],
            [0.08, 0.24, z],
        ];
        tube(&path, 0.006, 8).visual_only()
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &hide,
            rounded_block([-0.17, 0.0, -0.06], [0.17, 0.25, 0.06], 0.02, 2),
            0.15,
        )
        .with_all(&hide, [arc(-0.05), arc(0.05)]);
    Model::pickable("handbag", "bag").part(body)
}

fn sample_handbag(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("handbag", key);
    let hide = leather(
        "bag_leather",
        d.choose(
            "hide",
            [
                [150, 88, 48],
                [40, 38, 38],
                [150, 44, 50],
                [206, 186, 152],
                [60, 80, 110],
            ],
        ),
    );
    handbag()
        .resized(d.sample_m("height") / 0.376)
        .with_finish_replaced("cognac_leather", &hide)
}

/// A backpack standing on the floor.
fn backpack(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("backpack", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let cloth = crate::finishes::cloth("backpack_cloth", d.choose("tone", CLOTHING_COLORS));
    let strap = Finish {
        srgb: cloth.srgb.map(|c| (f32::from(c) * 0.6) as u8),
        ..cloth.clone()
    };
    let belt = |s: f32| {
        rounded_block(
            [s * 0.45 * x - 0.025, 0.12, -z],
            [s * 0.45 * x + 0.025, 0.86 * h, -z + 0.02],
            0.008,
            1,
        )
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &cloth,
            rounded_block([-x, 0.0, -z + 0.02], [x, h - 0.03, 0.35 * z], 0.07, 3),
            0.04,
        )
        .with_fill_fraction(
            &cloth,
            rounded_block([-0.8 * x, 0.02, 0.3 * z], [0.8 * x, 0.5 * h, z], 0.04, 2),
            0.04,
        )
        .with(
            &strap,
            block(
                [-0.6 * x, 0.4 * h, z - 0.004],
                [0.6 * x, 0.41 * h, z + 0.001],
            )
            .visual_only(),
        )
        .with_all(&strap, [belt(-1.0), belt(1.0)])
        .with(
            &strap,
            rounded_block([-0.03, h - 0.05, -z + 0.03], [0.03, h, -z + 0.05], 0.008, 1),
        );
    Model::pickable("backpack", "bag").part(body)
}
