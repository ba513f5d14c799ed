//! Papers, pencil cups and whiteboards.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, paper, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, frame, panel, rod};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("whiteboard", "whiteboard", 110, whiteboard),
    CatalogueEntry::new("papers", "paper", 189, papers),
    CatalogueEntry::new("pencil_cup", "utensil_holder", 190, sample_pencil_cup),
];

/// A few sheets of paper.
fn papers(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("papers", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let white = paper("white_sheet", [246, 246, 242]);
    let ink = Finish::picture(
        "printed_sheet",
        "paper",
        "pages",
        [[244, 244, 240], [70, 70, 76], [0; 3]],
        3,
    );
    let body = PartBuilder::new("body")
        .with(&white, block([-x, 0.0, -z], [x, h, z]))
        .with(
            &ink,
            panel(0.8 * w, 0.82 * depth, 0.0002)
                .rotated_x(-FRAC_PI_2)
                .translated(0.0, h, 0.41 * depth)
                .visual_only(),
        );
    Model::pickable("papers", "paper").part(body)
}

/// Pencils in a cup.
fn pencil_cup() -> Model {
    let cup = crate::shapes::vessel(&[(0.0, 0.0), (0.035, 0.0), (0.037, 0.1)], 0.003, 18);
    let pencil = |k: usize| {
        let tilt = 0.05 * k as f32 - 0.1;
        rod([0.0, 0.006, 0.0], [0.0, 0.16, 0.0], 0.0035)
            .visual_only()
            .rotated_z(tilt)
            .translated(0.0, 0.0, 0.012 * (k % 3) as f32 - 0.012)
    };
    let body = PartBuilder::new("body")
        .with(&plastic("blue_plastic", [66, 120, 186]), cup)
        .with_all(
            &Finish::plain("pencil_wood", "wood", [224, 176, 62]),
            (0..5).map(pencil),
        );
    Model::pickable("pencil_cup", "utensil_holder").part(body)
}

fn sample_pencil_cup(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pencil_cup", key);
    let cup = plastic(
        "pencil_cup_plastic",
        style.random_cloth(&mut d.stream("tone")).srgb,
    );
    pencil_cup()
        .resized(d.sample_m("height") / 0.16)
        .with_finish_replaced("blue_plastic", &cup)
}

/// A white board in a frame on the wall; y = 0 is its middle.
fn whiteboard(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("whiteboard", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let (x, y) = (0.5 * w, 0.5 * h);
    let alloy = Finish::plain("board_frame", "aluminium", [190, 192, 196]);
    let face = Finish::plain("board_face", "steel", [246, 247, 247]);
    let mut body = PartBuilder::new("body")
        .with(&alloy, frame(w, h, 0.02, 0.022))
        .with_fill_fraction(
            &face,
            block([-x + 0.02, -y + 0.02, 0.002], [x - 0.02, y - 0.02, 0.016]),
            0.15,
        )
        .with(
            &alloy,
            block([-0.4 * w, -y, 0.022], [0.4 * w, -y + 0.012, 0.08]),
        );
    let pens = [[30, 60, 150], [190, 40, 40], [30, 120, 60]];
    for (k, tone) in pens.into_iter().enumerate() {
        let at = -0.1 + 0.15 * k as f32;
        let pen = rod([at, -y + 0.021, 0.05], [at + 0.12, -y + 0.021, 0.05], 0.008);
        body = body.with(&plastic("board_pen", tone), pen.visual_only());
    }
    Model::fixed("whiteboard", "whiteboard").part(body)
}
