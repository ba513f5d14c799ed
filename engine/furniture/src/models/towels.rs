//! Folded towels, and a towel on its rail.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, chrome};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("towel_rail", "towel_rack", 82, sample_towel_rail),
    CatalogueEntry::new("folded_towel", "towel", 83, sample_folded_towel),
];

/// A rail on the wall with a towel over it; y = 0 is the rail's height. Rail and towel hang as one.
fn towel_rail(width_m: f32, towel: &Finish) -> Model {
    let x = 0.5 * width_m;
    let hold = |at: f32| rod([at, 0.0, 0.0], [at, 0.0, 0.08], 0.009);
    let drape = rounded_block([-x + 0.08, -0.46, 0.088], [x - 0.1, 0.012, 0.102], 0.006, 1)
        .merged(rounded_block(
            [-x + 0.08, -0.4, 0.058],
            [x - 0.1, 0.012, 0.072],
            0.006,
            1,
        ))
        .merged(rounded_block(
            [-x + 0.08, 0.006, 0.058],
            [x - 0.1, 0.02, 0.102],
            0.006,
            1,
        ));
    let body = PartBuilder::new("body")
        .with_all(
            &chrome(),
            [
                hold(-x),
                hold(x),
                rod([-x, 0.0, 0.08], [x, 0.0, 0.08], 0.007),
            ],
        )
        .with(towel, drape);
    Model::fixed("towel_rail", "towel_rack").part(body)
}

fn sample_towel_rail(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("towel_rail", key);
    towel_rail(
        d.sample_m("width") - 0.018,
        style.random_terry(&mut d.stream("terry")),
    )
}

/// A folded towel.
fn folded_towel(cloth: &Finish) -> Model {
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            cloth,
            rounded_block([-0.17, 0.0, -0.12], [0.17, 0.035, 0.12], 0.016, 2),
            0.3,
        )
        .with_fill_fraction(
            cloth,
            rounded_block([-0.165, 0.035, -0.115], [0.165, 0.07, 0.12], 0.016, 2),
            0.3,
        );
    Model::pickable("towel", "towel").part(body)
}

fn sample_folded_towel(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("folded_towel", key);
    folded_towel(style.random_terry(&mut d.stream("terry"))).resized(d.sample_m("width") / 0.34)
}
