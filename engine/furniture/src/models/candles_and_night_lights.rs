//! Candles and night lights.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, milk_glass, painted_steel, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cone, cylinder, rod, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("night_light", "table_lamp", 99, sample_night_light),
    CatalogueEntry::new("candle", "candle", 102, sample_candle),
];

/// A night light in the shape of a mushroom.
fn night_light() -> Model {
    let red = plastic("red_glow", [226, 74, 60]).emissive([0.3, 0.06, 0.04]);
    let cap = surface_of_revolution(
        &[
            (0.0, 0.07),
            (0.06, 0.07),
            (0.066, 0.085),
            (0.045, 0.12),
            (0.0, 0.132),
        ],
        22,
    );
    let body = PartBuilder::new("body")
        .with(&milk_glass(), cone(0.034, 0.026, 0.07, 18))
        .with(&red, cap);
    Model::pickable("night_light", "table_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, 0.15, 0.0], 1.0)
}

fn sample_night_light(_style: &Style, key: RandomKey) -> Model {
    night_light().resized(SizeSampler::new("night_light", key).sample_m("height") / 0.132)
}

/// A candle in a dish.
fn candle(height_m: f32) -> Model {
    let wax = Finish::plain("wax", "wax", [240, 230, 204]);
    let body = PartBuilder::new("body")
        .with(
            &painted_steel("black_steel", [40, 40, 42]),
            surface_of_revolution(&[(0.0, 0.0), (0.055, 0.0), (0.06, 0.012), (0.0, 0.008)], 20),
        )
        .with(
            &wax,
            cylinder(0.032, height_m, 18).translated(0.0, 0.008, 0.0),
        )
        .with(
            &black_plastic(),
            rod(
                [0.0, height_m + 0.008, 0.0],
                [0.0, height_m + 0.016, 0.0],
                0.0012,
            )
            .visual_only(),
        );
    Model::pickable("candle", "candle")
        .with_switch_state(false)
        .part(body)
        .with_light([0.0, height_m + 0.04, 0.0], 0.5)
}

fn sample_candle(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("candle", key);
    let wax = Finish::plain(
        "candle_wax",
        "wax",
        d.choose(
            "wax",
            [
                [240, 230, 204],
                [170, 40, 44],
                [222, 190, 140],
                [120, 140, 110],
            ],
        ),
    );
    candle(d.sample_m("height") - 0.016).with_finish_replaced("wax", &wax)
}
