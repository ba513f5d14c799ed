//! Drinking glasses, bottles and beer.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, glass, painted_steel, paper, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, surface_of_revolution, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("tumbler", "drinking_glass", 156, sample_tumbler),
    CatalogueEntry::new("wine_glass", "drinking_glass", 157, wine_glass),
    CatalogueEntry::new("bottle", "bottle", 158, sample_bottle),
    CatalogueEntry::new("beer", "beer", 159, beer),
];

/// A tumbler.
fn tumbler() -> Model {
    let shell = vessel(&[(0.0, 0.0), (0.03, 0.0), (0.037, 0.12)], 0.003, 20);
    Model::pickable("tumbler", "drinking_glass")
        .part(PartBuilder::new("body").with(&glass(), shell))
        .with_container_space("inside", [-0.018, 0.004, -0.018], [0.018, 0.12, 0.018])
}

fn sample_tumbler(_style: &Style, key: RandomKey) -> Model {
    tumbler().resized(SizeSampler::new("tumbler", key).sample_m("height") / 0.12)
}

/// A wine glass on its stem.
fn wine_glass(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wine_glass", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let foot = surface_of_revolution(
        &[
            (0.0, 0.0),
            (0.86 * r, 0.0),
            (0.86 * r, 0.003),
            (0.12 * r, 0.01),
            (0.1 * r, 0.45 * h),
            (0.0, 0.45 * h),
        ],
        20,
    );
    let cup = vessel(
        &[
            (0.0, 0.0),
            (0.35 * r, 0.0),
            (0.9 * r, 0.15 * h),
            (r, 0.3 * h),
            (0.8 * r, 0.55 * h),
        ],
        0.002,
        20,
    );
    let body = PartBuilder::new("body")
        .with(&glass(), foot)
        .with(&glass(), cup.translated(0.0, 0.45 * h, 0.0));
    let half = 0.3 * r;
    Model::pickable("wine_glass", "drinking_glass")
        .part(body)
        .with_container_space("inside", [-half, 0.46 * h, -half], [half, h, half])
}

/// A bottle; `cap` closes it.
fn bottle(height_m: f32, body: &Finish, label: &Finish, cap: &Finish) -> Model {
    let (h, r) = (height_m, 0.13 * height_m);
    let shape = surface_of_revolution(
        &[
            (0.0, 0.0),
            (r, 0.0),
            (1.02 * r, 0.02 * h),
            (r, 0.58 * h),
            (0.75 * r, 0.68 * h),
            (0.36 * r, 0.78 * h),
            (0.34 * r, 0.95 * h),
            (0.0, 0.95 * h),
        ],
        20,
    );
    let band = surface_of_revolution(
        &[
            (1.03 * r, 0.2 * h),
            (1.05 * r, 0.2 * h),
            (1.05 * r, 0.5 * h),
            (1.03 * r, 0.5 * h),
            (1.03 * r, 0.2 * h),
        ],
        20,
    );
    let part = PartBuilder::new("body")
        .with_fill_fraction(body, shape, 0.55)
        .with(label, band.visual_only())
        .with(
            cap,
            cylinder(0.38 * r, 0.05 * h, 14).translated(0.0, 0.95 * h, 0.0),
        );
    Model::pickable("bottle", "bottle").part(part)
}

fn sample_bottle(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bottle", key);
    let body = Finish {
        srgb: d.choose("glass", [[52, 92, 60], [110, 60, 40], [186, 206, 214]]),
        ..glass()
    };
    let label = paper(
        "bottle_label",
        d.choose(
            "label",
            [
                [240, 240, 236],
                [226, 206, 150],
                [150, 40, 44],
                [60, 90, 70],
            ],
        ),
    );
    let cap = painted_steel(
        "bottle_cap",
        d.choose(
            "cap",
            [[168, 171, 175], [150, 40, 44], [40, 44, 50], [190, 156, 84]],
        ),
    );
    bottle(d.sample_m("height"), &body, &label, &cap)
}

/// A bottle of beer.
fn beer(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("beer", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let brown = Finish {
        srgb: d.choose("glass", [[104, 60, 26], [50, 96, 56], [196, 200, 190]]),
        ..glass()
    }
    .transparent(0.75);
    let label = paper(
        "beer_label",
        d.choose(
            "label",
            [
                [232, 220, 180],
                [190, 40, 40],
                [40, 80, 140],
                [236, 236, 230],
            ],
        ),
    );
    let shape = surface_of_revolution(
        &[
            (0.0, 0.0),
            (r, 0.0),
            (r, 0.55 * h),
            (0.8 * r, 0.65 * h),
            (0.42 * r, 0.76 * h),
            (0.38 * r, 0.96 * h),
            (0.0, 0.96 * h),
        ],
        18,
    );
    let band = surface_of_revolution(
        &[
            (1.005 * r, 0.15 * h),
            (1.02 * r, 0.15 * h),
            (1.02 * r, 0.42 * h),
            (1.005 * r, 0.42 * h),
            (1.005 * r, 0.15 * h),
        ],
        18,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(&brown, shape, 0.55)
        .with(&label, band.visual_only())
        .with(
            &steel(),
            cylinder(0.45 * r, 0.04 * h, 12).translated(0.0, 0.96 * h, 0.0),
        );
    Model::pickable("beer", "beer").part(body)
}
