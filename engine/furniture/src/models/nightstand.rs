//! A bedside table with a drawer.

use super::cabinet_parts::{Carcass, drawer, drawer_space};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::tapered_leg;
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "nightstand",
    "stand",
    16,
    sample_nightstand,
)];

/// A small cupboard on legs: an open shelf below a drawer.
fn nightstand(width_m: f32, height_m: f32, wood: &Finish, front: &FrontStyle) -> Model {
    const DEPTH_M: f32 = 0.38;
    const SHARE: f32 = 0.52;
    let carcass = Carcass::floor_standing(width_m, 0.14, height_m, DEPTH_M);
    let (x, z) = (0.5 * width_m - 0.03, 0.5 * DEPTH_M - 0.03);
    let legs = [(-x, -z), (x, -z), (x, z), (-x, z)]
        .map(|(a, b)| tapered_leg([a, 0.0, b], [a, 0.14, b], 0.024, 0.036));
    let body = PartBuilder::new("body")
        .with_all(wood, carcass.boards(&[SHARE], &[]))
        .with_all(wood, legs);
    let (low, high) = carcass.space_between_shelves(0.0, SHARE);
    let (x, face) = (0.5 * width_m, 0.5 * DEPTH_M);
    let split = carcass.min[1] + SHARE * (height_m - carcass.min[1]);
    let (front_low, front_high) = ([-x, split], [x, height_m - 0.002]);
    let (min, max) = drawer_space(front_low, front_high, face, 0.3);
    Model::articulated("nightstand", "stand")
        .part(body)
        .with_support_surface("top", [-x, height_m, -face], [x, height_m + 0.6, face])
        .with_support_surface("shelf", low, high)
        .part(drawer("drawer", front_low, front_high, face, 0.3, front))
        .sliding("drawer", Vec3::Z, 0.24)
        .with_container_space("drawer", min, max)
}

fn sample_nightstand(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("nightstand", key);
    let wood = style.random_wood(&mut d.stream("wood"));
    nightstand(
        d.sample_m("width"),
        d.sample_m("height"),
        wood,
        &style.front_style(),
    )
}
