//! Wall clocks and alarm clocks.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, lacquer, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, panel, torus};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("wall_clock", "clock", 111, sample_wall_clock),
    CatalogueEntry::new("alarm_clock", "clock", 129, sample_alarm_clock),
];

/// A round clock on a wall.
fn wall_clock(radius_m: f32) -> Model {
    let frame = lacquer("black_lacquer", [38, 38, 40]);
    let dial = Finish::picture(
        "clock_face",
        "plastic",
        "clock",
        [[246, 244, 236], [40, 40, 44], [200, 60, 50]],
        1,
    );
    let edge = 2.0 * radius_m * 0.7;
    let plate = plastic("white_plastic", [246, 244, 236]);
    let body = PartBuilder::new("body")
        .with(&plate, cylinder(radius_m, 0.022, 32).rotated_x(FRAC_PI_2))
        .with(
            &frame,
            torus(radius_m, 0.012, 32)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, 0.0, 0.014)
                .visual_only(),
        )
        .with(
            &dial,
            panel(edge, edge, 0.002)
                .translated(0.0, -0.5 * edge, 0.022)
                .visual_only(),
        );
    Model::fixed("wall_clock", "clock")
        .part(body)
        .with_sound([0.0, 0.0, 0.03], "clock", 34.0)
}

fn sample_wall_clock(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_clock", key);
    let rim = Finish {
        name: "clock_rim",
        substance: "plastic",
        ..style.metal.clone()
    };
    wall_clock(0.5 * d.sample_m("width")).with_finish_replaced("black_lacquer", &rim)
}

/// An alarm clock with bells' colour and a ticking work.
fn alarm_clock() -> Model {
    let mint = plastic("mint_plastic", [120, 182, 164]);
    let dial = Finish::picture(
        "clock_face",
        "plastic",
        "clock",
        [[246, 244, 236], [40, 40, 44], [200, 60, 50]],
        1,
    );
    let body = PartBuilder::new("body")
        .with(
            &mint,
            cylinder(0.05, 0.045, 24)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, 0.06, -0.022),
        )
        .with(
            &dial,
            panel(0.07, 0.07, 0.001)
                .translated(0.0, 0.025, 0.023)
                .visual_only(),
        )
        .with_all(
            &black_plastic(),
            [-0.03, 0.03].map(|x| block([x - 0.006, 0.0, -0.018], [x + 0.006, 0.025, 0.018])),
        );
    Model::pickable("alarm_clock", "clock")
        .part(body)
        .with_sound([0.0, 0.06, 0.0], "clock", 32.0)
}

fn sample_alarm_clock(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("alarm_clock", key);
    let case = plastic(
        "alarm_clock_case",
        style.random_glaze(&mut d.stream("tone")).srgb,
    );
    alarm_clock()
        .resized(d.sample_m("height") / 0.11)
        .with_finish_replaced("mint_plastic", &case)
}
