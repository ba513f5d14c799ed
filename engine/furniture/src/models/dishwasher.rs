//! A dishwasher.

use super::cabinet_parts::horizontal_handle;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{black_plastic, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::block;
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "dishwasher",
    "dishwasher",
    51,
    dishwasher,
)];

/// A dishwasher under a worktop; its door folds down.
fn dishwasher(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dishwasher", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z, t) = (0.5 * w, 0.5 * depth, 0.03);
    let face = z - 0.045;
    let tub = steel();
    let (low, top) = (0.12, h - 0.03);
    let body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            block([-x + 0.02, 0.0, -z + 0.03], [x - 0.02, 0.1, face - 0.05]),
        )
        .with_fill_fraction(
            &style.appliance,
            block([-x, 0.1, -z], [-x + t, h, face]),
            0.5,
        )
        .with_fill_fraction(&style.appliance, block([x - t, 0.1, -z], [x, h, face]), 0.5)
        .with_fill_fraction(
            &style.appliance,
            block([-x + t, top, -z], [x - t, h, face]),
            0.5,
        )
        .with_fill_fraction(
            &style.appliance,
            block([-x + t, 0.1, -z], [x - t, top, -z + t]),
            0.5,
        )
        .with_fill_fraction(
            &style.appliance,
            block([-x + t, 0.1, -z + t], [x - t, low + 0.1, face]),
            0.6,
        )
        .with_fill_fraction(
            &tub,
            block(
                [-x + t, 0.5 * h, -z + t],
                [x - t, 0.5 * h + 0.012, face - 0.03],
            ),
            0.1,
        );
    let door = PartBuilder::new("door")
        .with_fill_fraction(
            &style.appliance,
            block([-x + 0.002, 0.105, face + 0.001], [x - 0.002, h - 0.002, z]),
            0.5,
        )
        .with(
            &black_plastic(),
            block([-x + 0.03, h - 0.07, z], [x - 0.03, h - 0.02, z + 0.002]).visual_only(),
        )
        .with(&steel(), horizontal_handle(0.0, h - 0.11, z, 0.36 * w));
    Model::articulated("dishwasher", "dishwasher")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.4, z], "washing_machine", 48.0)
        .with_container_space(
            "lower_rack",
            [-x + t, low + 0.1, -z + t],
            [x - t, 0.5 * h - 0.01, face - 0.01],
        )
        .with_container_space(
            "upper_rack",
            [-x + t, 0.5 * h + 0.012, -z + t],
            [x - t, top, face - 0.03],
        )
        .part(door)
        .hinged("door", [0.0, 0.105, z], Vec3::X, 1.5)
}
