//! A flat television on a foot.

use crate::finishes::{Finish, black, device};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, panel, rounded_block};

/// What it shows.
const PROGRAMME: Finish = Finish::picture(
    "television_picture",
    "glass",
    "television",
    [[70, 96, 150], [30, 52, 92], [176, 40, 44]],
    3,
);

/// A television `width_m` wide, the picture towards +Z. Its screen is a part of its own, its loudspeakers sit below.
pub fn television(width_m: f32) -> Model {
    let (x, height) = (0.5 * width_m, width_m * 0.58);
    let (low, high) = (0.07, 0.07 + height);
    let case = device("black_case", [26, 26, 29]);
    let body = PartBuilder::new("body")
        .with(
            &black(),
            block([-0.3 * width_m, 0.0, -0.11], [0.3 * width_m, 0.012, 0.11]),
        )
        .with(&black(), block([-0.05, 0.012, -0.03], [0.05, low, -0.005]))
        .with_filled(
            &case,
            rounded_block([-x, low, -0.035], [x, high, 0.02], 0.01, 1),
            0.45,
        );
    let screen = PartBuilder::new("screen").with(
        &PROGRAMME.clear(1.0).glowing([0.1, 0.12, 0.17]),
        panel(width_m - 0.03, height - 0.045, 0.003).at(0.0, low + 0.03, 0.02),
    );
    Model::fixed("television", "television")
        .switched(true)
        .part(body)
        .with_sound([0.0, low + 0.05, 0.03], "television", 60.0)
        .part(screen)
}
