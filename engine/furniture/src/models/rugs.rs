//! Rugs and bath mats.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, terry};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{panel, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("bath_mat", "rug", 84, sample_bath_mat),
    CatalogueEntry::new("rug", "rug", 112, sample_rug),
    CatalogueEntry::new("round_rug", "rug", 113, sample_round_rug),
];

/// A rug whose picture fills it.
fn rug(width_m: f32, depth_m: f32, weave: &Finish) -> Model {
    let flat = panel(width_m, depth_m, 0.009)
        .rotated_x(-FRAC_PI_2)
        .translated(0.0, 0.0, 0.5 * depth_m);
    Model::movable("rug", "rug").part(PartBuilder::new("body").with(weave, flat))
}

fn sample_rug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("rug", key);
    let [a, b] = ["ground", "border"].map(|tone| style.random_cloth(&mut d.stream(tone)).srgb);
    let pattern = d.stream("pattern").bits();
    let recipe = d.choose("recipe", ["rug", "rug", "stripes", "checks"]);
    let weave = Finish::picture(
        "woven_rug",
        "carpet",
        recipe,
        [a, b, [232, 222, 200]],
        pattern,
    );
    rug(d.sample_m("width"), d.sample_m("depth"), &weave)
}

/// A round or square rug of one colour, pile up.
fn round_rug(radius_m: f32, pile: &Finish) -> Model {
    let disc = crate::shapes::cylinder(radius_m, 0.012, 40);
    Model::movable("round_rug", "rug").part(PartBuilder::new("body").with(pile, disc))
}

fn sample_round_rug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("round_rug", key);
    round_rug(
        0.5 * d.sample_m("width"),
        style.random_terry(&mut d.stream("pile")),
    )
}

/// A bath mat of terry.
fn bath_mat(width_m: f32, depth_m: f32) -> Model {
    let (x, z) = (0.5 * width_m, 0.5 * depth_m);
    let cloth = terry("aqua_terry", [126, 172, 178]);
    Model::movable("bath_mat", "rug").part(PartBuilder::new("body").with_fill_fraction(
        &cloth,
        rounded_block([-x, 0.0, -z], [x, 0.014, z], 0.006, 1),
        0.5,
    ))
}

fn sample_bath_mat(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bath_mat", key);
    bath_mat(d.sample_m("width"), d.sample_m("depth"))
        .with_finish_replaced("aqua_terry", style.random_terry(&mut d.stream("terry")))
}
