//! Loose mattresses, pillows, cushions and folded blankets.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, cloth};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, pillow as cushion, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("mattress", "mattress", 35, mattress),
    CatalogueEntry::new("pillow", "pillow", 36, sample_pillow),
    CatalogueEntry::new("cushion", "pillow", 37, sample_cushion),
    CatalogueEntry::new("folded_blanket", "blanket", 38, sample_folded_blanket),
];

/// Foam inside a cover: how much of its volume is substance of the cover's weight.
pub(super) fn foam_fill_fraction(cover: &Finish) -> f32 {
    let density = |name| {
        dwell_scene::material::library()
            .get_or_default(name)
            .density_kg_m3
    };
    density("foam") / cover.substance().density_kg_m3
}

/// A mattress without a bed.
fn mattress(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("mattress", key);
    let (w, h, length) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * length);
    let cover = cloth(
        "mattress_ticking",
        d.choose("cover", [[238, 236, 230], [226, 230, 234], [232, 224, 208]]),
    );
    let band = cloth(
        "mattress_border",
        d.choose("band", [[150, 158, 166], [190, 176, 150], [120, 130, 140]]),
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &cover,
            rounded_block([-x, 0.0, -z], [x, 0.35 * h, z], 0.03, 2),
            foam_fill_fraction(&cover),
        )
        .with_fill_fraction(
            &band,
            block(
                [-x + 0.004, 0.35 * h, -z + 0.004],
                [x - 0.004, 0.65 * h, z - 0.004],
            ),
            foam_fill_fraction(&band),
        )
        .with_fill_fraction(
            &cover,
            rounded_block([-x, 0.65 * h, -z], [x, h, z], 0.03, 2),
            foam_fill_fraction(&cover),
        );
    Model::movable("mattress", "mattress")
        .part(body)
        .with_support_surface(
            "top",
            [-x + 0.05, h, -z + 0.05],
            [x - 0.05, h + 0.5, z - 0.05],
        )
}

/// A pillow or cushion: width, thickness, depth in m.
fn pillow(size_m: [f32; 3], cloth: &Finish) -> Model {
    Model::pickable("pillow", "pillow").part(PartBuilder::new("body").with_fill_fraction(
        cloth,
        cushion(size_m),
        0.12,
    ))
}

fn sample_pillow(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pillow", key);
    pillow(
        [
            d.sample_m("width"),
            d.sample_m("height"),
            d.sample_m("depth"),
        ],
        &style.cloths[0],
    )
}

fn sample_cushion(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cushion", key);
    let edge = d.sample_m("width");
    pillow(
        [edge, d.sample_m("height"), edge],
        style.random_cloth(&mut d.stream("cloth")),
    )
}

/// A folded throw.
fn folded_blanket(width_m: f32, depth_m: f32, cloth: &Finish) -> Model {
    let (x, z) = (0.5 * width_m, 0.5 * depth_m);
    let layer = |k: usize| {
        let y = 0.028 * k as f32;
        let slack = 0.006 * (k % 2) as f32;
        rounded_block([-x + slack, y, -z], [x, y + 0.028, z - slack], 0.012, 1)
    };
    Model::pickable("folded_blanket", "blanket").part(
        (0..3)
            .map(layer)
            .fold(PartBuilder::new("body"), |part, fold| {
                part.with_fill_fraction(cloth, fold, 0.4)
            }),
    )
}

fn sample_folded_blanket(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("folded_blanket", key);
    folded_blanket(
        d.sample_m("width"),
        d.sample_m("depth"),
        style.random_cloth(&mut d.stream("cloth")),
    )
}
