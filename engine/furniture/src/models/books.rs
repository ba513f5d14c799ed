//! Books, rows of books and magazines.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, book_page_edges};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, panel};
use crate::style::Style;
use crate::textures::Srgb;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("book", "book", 186, sample_book),
    CatalogueEntry::new("book_row", "books", 187, sample_book_row),
    CatalogueEntry::new("magazines", "magazines", 188, sample_magazines),
];

/// Colours of book covers: cloth, label, band.
const COVERS: [[Srgb; 3]; 8] = [
    [[150, 48, 42], [226, 208, 168], [206, 172, 92]],
    [[44, 74, 112], [220, 220, 212], [186, 150, 80]],
    [[58, 96, 70], [230, 222, 196], [214, 190, 120]],
    [[206, 160, 70], [80, 52, 40], [120, 70, 40]],
    [[92, 58, 96], [226, 214, 224], [190, 160, 190]],
    [[222, 214, 196], [150, 60, 50], [60, 70, 90]],
    [[42, 44, 50], [206, 70, 60], [210, 206, 196]],
    [[72, 140, 150], [236, 232, 220], [232, 120, 80]],
];

/// The finish of the cover number `k`.
const fn cover(k: usize) -> Finish {
    Finish::picture("book_cover", "books", "cover", COVERS[k % COVERS.len()], 1)
}

/// The plain spine that fits the cover number `k`.
const fn spine(k: usize) -> Finish {
    Finish::plain("book_spine", "books", COVERS[k % COVERS.len()][0])
}

/// A book that lies on its back: `size_m` (x, thickness, z), the spine at -X.
fn book(size_m: [f32; 3], k: usize) -> Model {
    let [w, t, d] = size_m;
    let (x, z, board) = (0.5 * w, 0.5 * d, 0.1 * t);
    let front = panel(w, d, board)
        .rotated_x(-std::f32::consts::FRAC_PI_2)
        .translated(0.0, t - board, z);
    let body = PartBuilder::new("body")
        .with(&cover(k), front)
        .with(&spine(k), block([-x, 0.0, -z], [x, board, z]))
        .with(
            &spine(k),
            block([-x, board, -z], [-x + 0.003, t - board, z]),
        )
        .with(
            &book_page_edges(),
            block(
                [-x + 0.003, board, -z + 0.004],
                [x - 0.004, t - board, z - 0.004],
            ),
        );
    Model::pickable("book", "book").part(body)
}

fn sample_book(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("book", key);
    book(
        [
            d.sample_m("width"),
            d.sample_m("height"),
            d.sample_m("depth"),
        ],
        d.below("cover", 8),
    )
}

/// A row of upright books, spines towards +Z, about `width_m` wide; the last ones lean or are missing, as `key` draws.
fn book_row(width_m: f32, height_m: f32, key: RandomKey) -> Model {
    let mut random = key.stream();
    let mut body = PartBuilder::new("body");
    let mut x = -0.5 * width_m;
    loop {
        let thick = random.range(0.018, 0.046);
        if x + thick > 0.5 * width_m {
            break;
        }
        let (h, d) = (height_m * random.range(0.72, 1.0), random.range(0.14, 0.2));
        let k = random.below(COVERS.len());
        let back = 0.1 - d;
        body = body
            .with(&spine(k), block([x, 0.0, back], [x + thick, h, 0.1]))
            .with(
                &Finish::plain("book_label", "paper", COVERS[k][1]),
                block(
                    [x + 0.2 * thick, 0.68 * h, 0.1],
                    [x + 0.8 * thick, 0.8 * h, 0.1008],
                )
                .visual_only(),
            );
        x += thick + 0.0006;
    }
    Model::movable("row_of_books", "books").part(body)
}

fn sample_book_row(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("book_row", key);
    book_row(d.sample_m("row"), d.sample_m("tall"), key.child("row"))
}

/// A stack of magazines.
fn magazines(covers: [&Finish; 3]) -> Model {
    let mut body = PartBuilder::new("body");
    for (k, cover) in covers.into_iter().enumerate() {
        let y = 0.008 * k as f32;
        let sheet = panel(0.21, 0.28, 0.008)
            .rotated_x(-FRAC_PI_2)
            .translated(0.0, 0.0, 0.14);
        body = body.with(
            cover,
            sheet
                .rotated_y(0.12 * k as f32 - 0.1)
                .translated(0.0, y, 0.0),
        );
    }
    Model::pickable("magazines", "magazines").part(body)
}

fn sample_magazines(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("magazines", key);
    let cover = |k: usize| {
        let colors = [0, 1, 2].map(|n| style.cloths[(k + n) % style.cloths.len()].srgb);
        let recipe = ["cover", "shapes", "landscape"][k];
        Finish::picture("magazine_cover", "paper", recipe, colors, 1 + k as u64)
    };
    magazines([&cover(0), &cover(1), &cover(2)]).resized(d.sample_m("width") / 0.24)
}
