//! A water cooler with its bottle.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "water_dispenser",
    "water_dispenser",
    60,
    water_dispenser,
)];

/// A stand with a bottle of water upside down.
fn water_dispenser(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("water_dispenser", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = h - 0.38;
    let water = Finish::plain("bottled_water", "water", [140, 186, 214]).transparent(0.45);
    let r = 0.42 * w;
    let bottle = surface_of_revolution(
        &[
            (0.0, case),
            (0.2 * r, case),
            (0.25 * r, case + 0.04),
            (r, case + 0.1),
            (r, h - 0.02),
            (0.9 * r, h),
            (0.0, h),
        ],
        24,
    );
    let tap = |a: f32, tone: [u8; 3]| (a, plastic("tap_lever", tone));
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            &style.appliance,
            rounded_block([-x, 0.0, -z], [x, 0.62 * case, z], 0.015, 1),
            0.18,
        )
        .with_fill_fraction(
            &style.appliance,
            rounded_block([-x, 0.62 * case, -z], [x, case, z - 0.09], 0.012, 1),
            0.18,
        )
        .with_fill_fraction(
            &style.appliance,
            rounded_block([-x, 0.9 * case, z - 0.1], [x, case, z], 0.012, 1),
            0.18,
        )
        .with(
            &black_plastic(),
            block(
                [-x + 0.04, 0.62 * case, z - 0.08],
                [x - 0.04, 0.62 * case + 0.012, z - 0.01],
            ),
        )
        .with_fill_fraction(&water, bottle, 0.6);
    for (a, lever) in [tap(-0.05, [60, 110, 190]), tap(0.05, [196, 60, 50])] {
        body = body.with(
            &lever,
            block(
                [a - 0.014, 0.8 * case, z - 0.09],
                [a + 0.014, 0.8 * case + 0.03, z - 0.04],
            ),
        );
    }
    Model::fixed("water_dispenser", "water_dispenser")
        .with_switch_state(true)
        .part(body)
        .with_sound([0.0, 0.2, -z], "hum", 36.0)
        .with_support_surface(
            "drip_tray",
            [-x + 0.05, 0.62 * case + 0.012, z - 0.075],
            [x - 0.05, 0.79 * case, z - 0.015],
        )
}
