//! Dining chairs: slatted, upholstered, or with a moulded shell.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, extrude, rounded_block, tapered_leg};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "dining_chair",
    "chair",
    2,
    dining_chair,
)];

/// A chair with four legs and a back of slats.
#[derive(Clone, Debug)]
struct Chair {
    /// m.
    width_m: f32,
    /// Height of the seat, m.
    seat_m: f32,
    /// Height of the back, m.
    back_m: f32,
    /// Number of level slats in the back.
    slats: usize,
    /// Finish of the body.
    wood: Finish,
    /// A flat cushion on the seat.
    pad: Option<Finish>,
}

impl Chair {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        let (x, z) = (0.5 * self.width_m, 0.215);
        let board = self.seat_m - 0.015;
        let mut body = PartBuilder::new("body").with(
            &self.wood,
            rounded_block([-x, board - 0.025, -z], [x, board, z], 0.012, 1),
        );
        let inset = 0.035;
        for side in [-1.0, 1.0] {
            let leg = side * (x - inset);
            let front = tapered_leg(
                [leg * 1.04, 0.0, z - inset + 0.01],
                [leg, board - 0.025, z - inset],
                0.026,
                0.04,
            );
            let rear = tapered_leg(
                [leg * 1.04, 0.0, -z + inset - 0.04],
                [leg, board - 0.025, -z + inset - 0.01],
                0.026,
                0.04,
            );
            let post = tapered_leg(
                [leg, board, -z + 0.02],
                [leg * 0.98, self.back_m, -z - 0.06],
                0.036,
                0.026,
            );
            body = body.with_all(&self.wood, [front, rear, post]);
            let rail = side * (x - inset);
            body = body.with(
                &self.wood,
                block(
                    [rail - 0.01, board - 0.075, -z + inset],
                    [rail + 0.01, board - 0.025, z - inset],
                ),
            );
        }
        for k in 0..self.slats {
            let share = (k as f32 + 0.6) / self.slats as f32;
            let y = board + share * (self.back_m - board) + 0.02;
            let back = -z + 0.02 - 0.08 * share;
            let half = x - inset - 0.012;
            body = body.with(
                &self.wood,
                rounded_block(
                    [-half, y - 0.03, back - 0.008],
                    [half, y + 0.03, back + 0.008],
                    0.006,
                    1,
                ),
            );
        }
        let seat = match &self.pad {
            Some(pad) => {
                body = body.with_fill_fraction(
                    pad,
                    rounded_block(
                        [-x + 0.02, board, -z + 0.035],
                        [x - 0.02, board + 0.03, z - 0.01],
                        0.014,
                        2,
                    ),
                    0.3,
                );
                board + 0.03
            }
            None => board,
        };
        Model::movable("dining_chair", "chair")
            .part(body)
            .with_support_surface(
                "seat",
                [-x + 0.03, seat, -z + 0.05],
                [x - 0.03, seat + 0.4, z - 0.02],
            )
    }
}

/// A dining chair: slatted, upholstered or a shell on rods.
fn dining_chair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dining_chair", key);
    match d.below("build", 3) {
        0 => slatted(style, &d),
        1 => upholstered(style, &d),
        _ => shell(style, &d),
    }
}

fn slatted(style: &Style, d: &SizeSampler) -> Model {
    let cloth = style.random_cloth(&mut d.stream("pad")).clone();
    Chair {
        width_m: d.sample_m("width"),
        seat_m: d.sample_m("seat"),
        back_m: d.sample_m("height"),
        slats: d.choose("slats", [2, 3, 4]),
        wood: style.random_wood(&mut d.stream("wood")).clone(),
        pad: d.chance("padded", 0.6).then_some(cloth),
    }
    .build()
}

fn upholstered(style: &Style, d: &SizeSampler) -> Model {
    let (w, h, depth, seat) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
        d.sample_m("seat"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let cover = style.random_upholstery(&mut d.stream("cover"));
    let under = seat - 0.09;
    let body = PartBuilder::new("body")
        .with_all_hollow(
            style.leg_finish(),
            style.legs([x - 0.035, z - 0.04], under, 0.04),
        )
        .with_fill_fraction(
            cover,
            rounded_block([-x, under, -z], [x, seat, z], 0.03, 2),
            0.5 * cover.padded_fill_fraction(),
        )
        .with_fill_fraction(
            cover,
            rounded_block(
                [-x + 0.01, seat - 0.02, -z],
                [x - 0.01, h, -z + 0.07],
                0.03,
                2,
            ),
            0.5 * cover.padded_fill_fraction(),
        );
    Model::movable("dining_chair", "chair")
        .part(body)
        .with_support_surface(
            "seat",
            [-x + 0.03, seat, -z + 0.08],
            [x - 0.03, seat + 0.4, z - 0.02],
        )
}

fn shell(style: &Style, d: &SizeSampler) -> Model {
    let (w, h, depth, seat) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
        d.sample_m("seat"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let tone = d.choose(
        "tone",
        [
            [238, 236, 230],
            [52, 54, 58],
            [196, 116, 76],
            [112, 140, 128],
            [206, 172, 84],
        ],
    );
    let hull = plastic("chair_shell", tone);
    let (half, rise) = (x - 0.03, h - seat + 0.02);
    // A back that narrows upwards, with cut corners.
    let outline = [
        [-half, 0.0],
        [half, 0.0],
        [half, 0.45 * rise],
        [0.86 * half, 0.85 * rise],
        [0.6 * half, rise],
        [-0.6 * half, rise],
        [-0.86 * half, 0.85 * rise],
        [-half, 0.45 * rise],
    ];
    let back = extrude(&outline, 0.014).rotated_x(-0.17);
    let mut body = PartBuilder::new("body")
        .with(
            &hull,
            rounded_block(
                [-x + 0.02, seat - 0.022, -z + 0.05],
                [x - 0.02, seat, z],
                0.0105,
                2,
            ),
        )
        .with(&hull, back.translated(0.0, seat - 0.015, -z + 0.07));
    let legs = if d.chance("metal", 0.5) {
        &style.metal
    } else {
        &style.wood
    };
    for (sx, sz) in CORNERS {
        let foot = [sx * (x - 0.012), 0.0, sz * (z - 0.03)];
        let top = [sx * 0.12, seat - 0.02, sz * 0.11];
        body = body.with_hollow(legs, tapered_leg(foot, top, 0.02, 0.03));
    }
    Model::movable("dining_chair", "chair")
        .part(body)
        .with_support_surface(
            "seat",
            [-x + 0.05, seat, -z + 0.11],
            [x - 0.05, seat + 0.4, z - 0.02],
        )
}

pub(super) const CORNERS: [(f32, f32); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
