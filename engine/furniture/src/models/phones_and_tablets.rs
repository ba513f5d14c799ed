//! Mobile phones, tablets and telephones with a cord.

use super::computers::screen_finish;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, electronics, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{panel, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("tablet", "tablet", 121, tablet),
    CatalogueEntry::new("cellphone", "cellphone", 122, cellphone),
    CatalogueEntry::new("telephone", "telephone", 123, sample_telephone),
];

/// A flat tablet computer, face up.
fn tablet(_style: &Style, key: RandomKey) -> Model {
    slab("tablet", "tablet", key)
}

/// A mobile phone, face up.
fn cellphone(_style: &Style, key: RandomKey) -> Model {
    slab("cellphone", "cellphone", key)
}

fn slab(name: &'static str, category: &'static str, key: RandomKey) -> Model {
    let d = SizeSampler::new(name, key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = electronics(
        "slab_case",
        d.choose(
            "tone",
            [
                [30, 30, 33],
                [206, 208, 212],
                [60, 80, 110],
                [180, 140, 130],
            ],
        ),
    );
    let rim = 0.05 * w;
    let face = panel(w - 2.0 * rim, depth - 2.0 * rim, 0.0008)
        .rotated_x(-FRAC_PI_2)
        .translated(0.0, h, z - rim);
    let body = PartBuilder::new("body")
        .with(&case, rounded_block([-x, 0.0, -z], [x, h, z], 0.45 * h, 1))
        .with(&screen_finish("slab_screen", &d), face.visual_only());
    Model::pickable(name, category)
        .with_switch_state(true)
        .part(body)
}

/// A telephone with a receiver on its cradle.
fn telephone() -> Model {
    let red = plastic("red_plastic", [170, 36, 34]);
    let ear = |x: f32| {
        rounded_block(
            [x - 0.026, 0.062, -0.028],
            [x + 0.026, 0.098, 0.028],
            0.012,
            1,
        )
    };
    let dial = Finish::picture(
        "telephone_dial",
        "plastic",
        "clock",
        [[236, 232, 222], [60, 60, 60], [120, 120, 120]],
        1,
    );
    let face = panel(0.09, 0.09, 0.004)
        .rotated_x(-FRAC_PI_2 + 0.45)
        .translated(0.0, 0.03, 0.082);
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &red,
            rounded_block([-0.09, 0.0, -0.09], [0.09, 0.055, 0.09], 0.016, 1),
            0.4,
        )
        .with_all(&red, [ear(-0.085), ear(0.085)])
        .with(
            &red,
            rounded_block([-0.09, 0.078, -0.018], [0.09, 0.104, 0.018], 0.01, 1),
        )
        .with(&dial, face.visual_only());
    Model::pickable("telephone", "telephone")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.03, 0.0], "phone", 74.0)
}

fn sample_telephone(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("telephone", key);
    let case = plastic(
        "telephone_case",
        d.choose(
            "case",
            [[170, 36, 34], [44, 44, 47], [226, 214, 186], [70, 110, 96]],
        ),
    );
    telephone()
        .resized(d.sample_m("width") / 0.222)
        .with_finish_replaced("red_plastic", &case)
}
