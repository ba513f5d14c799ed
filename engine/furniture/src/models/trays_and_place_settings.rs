//! Laid trays and place settings.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, open_top_box, rod, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("place_setting", "place_setting", 172, place_setting),
    CatalogueEntry::new("tray", "food_tray", 173, tray),
];

/// A tray with two grips.
fn tray(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("tray", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let stuff = match d.below("build", 3) {
        0 => style.wood.clone(),
        1 => plastic(
            "tray_plastic",
            d.choose(
                "tone",
                [
                    [60, 62, 66],
                    [200, 70, 60],
                    [120, 160, 150],
                    [236, 230, 216],
                ],
            ),
        ),
        _ => Finish {
            substance: "wood",
            ..style.second_wood.clone()
        },
    };
    let grip = |s: f32| {
        rod(
            [s * (x - 0.014), h + 0.014, -0.06],
            [s * (x - 0.014), h + 0.014, 0.06],
            0.006,
        )
        .merged([-0.055_f32, 0.055].into_iter().fold(
            crate::shapes::SolidMesh::default(),
            |all, b| {
                all.merged(
                    rod(
                        [s * (x - 0.014), h - 0.01, b],
                        [s * (x - 0.014), h + 0.014, b],
                        0.005,
                    )
                    .visual_only(),
                )
            },
        ))
    };
    let body = PartBuilder::new("body")
        .with(&stuff, open_top_box([-x, 0.0, -z], [x, h, z], 0.008))
        .with_all(&style.metal, [grip(-1.0), grip(1.0)]);
    Model::pickable("tray", "food_tray")
        .part(body)
        .with_support_surface(
            "inside",
            [-x + 0.03, 0.008, -z + 0.012],
            [x - 0.03, 0.25, z - 0.012],
        )
}

/// A place laid for one: mat, plate, knife, fork, folded napkin.
fn place_setting(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("place_setting", key);
    let (w, depth) = (d.sample_m("width"), d.sample_m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let mat = style.random_cloth(&mut d.stream("mat"));
    let napkin = &style.cloths[d.below("napkin", style.cloths.len())];
    let glaze = style.random_glaze(&mut d.stream("glaze"));
    let r = 0.3 * w;
    let dish = surface_of_revolution(
        &[
            (0.0, 0.003),
            (0.58 * r, 0.003),
            (r, 0.021),
            (r, 0.025),
            (0.6 * r, 0.0085),
            (0.0, 0.0085),
        ],
        24,
    );
    let tool = |a: f32, wide: f32| {
        block([a - 0.006, 0.003, -0.02], [a + 0.006, 0.0065, 0.1])
            .merged(block([a - wide, 0.003, -0.1], [a + wide, 0.006, -0.02]))
    };
    let body = PartBuilder::new("body")
        .with(mat, block([-x, 0.0, -z], [x, 0.003, z]))
        .with(glaze, dish)
        .with(&steel(), tool(0.82 * x, 0.009))
        .with(&steel(), tool(-0.82 * x, 0.012))
        .with(
            napkin,
            block([-0.97 * x, 0.003, -0.6 * z], [-0.89 * x, 0.012, 0.6 * z]),
        );
    Model::movable("place_setting", "place_setting").part(body)
}
