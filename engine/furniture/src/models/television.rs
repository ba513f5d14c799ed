//! A flat television on a foot, and its remote control.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, electronics, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, panel, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("television", "television", 114, sample_television),
    CatalogueEntry::new(
        "remote_control",
        "household_appliance",
        124,
        sample_remote_control,
    ),
];

/// The picture on its screen.
const PROGRAMME: Finish = Finish::picture(
    "television_picture",
    "glass",
    "television",
    [[70, 96, 150], [30, 52, 92], [176, 40, 44]],
    3,
);

/// A television `width_m` wide, the picture towards +Z. Its screen is a part of its own, its loudspeakers sit below.
fn television(width_m: f32) -> Model {
    let (x, height) = (0.5 * width_m, width_m * 0.58);
    let (low, high) = (0.07, 0.07 + height);
    let case = electronics("black_case", [26, 26, 29]);
    let body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            block([-0.3 * width_m, 0.0, -0.11], [0.3 * width_m, 0.012, 0.11]),
        )
        .with(
            &black_plastic(),
            block([-0.05, 0.012, -0.03], [0.05, low, -0.005]),
        )
        .with_fill_fraction(
            &case,
            rounded_block([-x, low, -0.035], [x, high, 0.02], 0.01, 1),
            0.45,
        );
    let screen = PartBuilder::new("screen").with(
        &PROGRAMME.transparent(1.0).emissive([0.1, 0.12, 0.17]),
        panel(width_m - 0.03, height - 0.045, 0.003).translated(0.0, low + 0.03, 0.02),
    );
    Model::fixed("television", "television")
        .with_switch_state(true)
        .part(body)
        .with_sound([0.0, low + 0.05, 0.03], "television", 60.0)
        .part(screen)
}

fn sample_television(_style: &Style, key: RandomKey) -> Model {
    television(SizeSampler::new("television", key).sample_m("width"))
}

/// A remote control.
fn remote_control() -> Model {
    let key = |k: usize| {
        let (x, z) = (
            (k % 3) as f32 * 0.013 - 0.013,
            (k / 3) as f32 * 0.017 - 0.06,
        );
        block(
            [x - 0.004, 0.018, z - 0.005],
            [x + 0.004, 0.0195, z + 0.005],
        )
        .visual_only()
    };
    let body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            rounded_block([-0.024, 0.0, -0.085], [0.024, 0.018, 0.085], 0.006, 1),
        )
        .with_all(&plastic("grey_plastic", [150, 150, 154]), (0..9).map(key));
    Model::pickable("remote_control", "household_appliance").part(body)
}

fn sample_remote_control(_style: &Style, key: RandomKey) -> Model {
    remote_control().resized(SizeSampler::new("remote_control", key).sample_m("depth") / 0.17)
}
