//! Curtains and blinds.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, cloth, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, ball, block, curtain as folds, rod};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("curtains", "curtain", 105, curtains),
    CatalogueEntry::new("blind", "blinds", 106, blind),
];

/// A pair of curtains on a rod, drawn to the sides; x = 0 is the window's middle, y = 0 the rod, z = 0 the wall.
#[derive(Clone, Debug)]
pub struct Curtains {
    /// Length of the rod, m.
    pub width_m: f32,
    /// From the rod to the hem, m.
    pub height_m: f32,
    /// Share of the window that each curtain covers, 0.1 to 0.5.
    pub drawn: f32,
    /// Finish of the cloth.
    pub cloth: Finish,
}

impl Curtains {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        const OFF_M: f32 = 0.085;
        let x = 0.5 * self.width_m;
        let wide = self.width_m * self.drawn;
        let side = |sign: f32| {
            let folded = folds(
                wide,
                self.height_m - 0.03,
                0.07,
                ((wide / 0.075) as usize).max(3),
            );
            folded.translated(sign * (x - 0.5 * wide - 0.02), -0.03, OFF_M)
        };
        let hold = |at: f32| rod([at, 0.0, 0.0], [at, 0.0, OFF_M], 0.008);
        let end = |at: f32| ball(0.022, 12).translated(at, 0.0, OFF_M);
        let pole: SolidMesh = rod([-x - 0.03, 0.0, OFF_M], [x + 0.03, 0.0, OFF_M], 0.012);
        let body = PartBuilder::new("rod")
            .with(&black_plastic(), pole)
            .with_all(
                &black_plastic(),
                [
                    hold(-x + 0.01),
                    hold(x - 0.01),
                    end(-x - 0.04),
                    end(x + 0.04),
                ],
            )
            .with_all(&self.cloth, [side(-1.0), side(1.0)]);
        Model::fixed("curtains", "curtain").part(body)
    }
}

fn curtains(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("curtains", key);
    let tone = style.random_cloth(&mut d.stream("cloth")).srgb;
    let substance = d.choose("weight", ["light_curtain", "heavy_curtain"]);
    // The ends of the rod stand 62 mm over.
    Curtains {
        width_m: d.sample_m("width") - 0.124,
        height_m: d.sample_m("height") - 0.022,
        drawn: d.range("drawn", 0.14, 0.3),
        cloth: Finish {
            substance,
            ..cloth("curtain_cloth", tone)
        },
    }
    .build()
}

/// A blind before a window, half let down: slats or a roll of cloth. y = 0 is its upper edge, z = 0 the wall.
fn blind(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("blind", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let x = 0.5 * w;
    let white = plastic("blind_white", [238, 238, 234]);
    let mut body = PartBuilder::new("body").with_fill_fraction(
        &white,
        block([-x, -0.05, 0.0], [x, 0.0, 0.06]),
        0.3,
    );
    if d.chance("slats", 0.5) {
        let slat = if d.chance("wood", 0.4) {
            style.wood.clone()
        } else {
            Finish {
                substance: "aluminium",
                ..white.clone()
            }
        };
        let count = ((h - 0.08) / 0.045) as usize;
        for k in 0..count {
            let y = -0.075 - 0.045 * k as f32;
            let one = block([-x + 0.01, -0.0015, -0.022], [x - 0.01, 0.0015, 0.022])
                .rotated_x(0.5)
                .translated(0.0, y, 0.03);
            body = body.with(&slat, one.visual_only());
        }
        for a in [-0.7 * x, 0.7 * x] {
            body = body.with(
                &white,
                rod([a, -h + 0.02, 0.03], [a, -0.05, 0.03], 0.001).visual_only(),
            );
        }
        // The slats are felt as one board.
        let board = block([-x + 0.01, -h + 0.02, 0.014], [x - 0.01, -0.05, 0.046]).collision_only();
        body = body.with(&slat, board).with(
            &white,
            block([-x + 0.01, -h, 0.012], [x - 0.01, -h + 0.02, 0.048]),
        );
    } else {
        let cloth = style.random_cloth(&mut d.stream("cloth"));
        body = body
            .with(
                cloth,
                block([-x + 0.015, -h + 0.02, 0.028], [x - 0.015, -0.05, 0.031]),
            )
            .with(
                &white,
                block([-x + 0.01, -h, 0.02], [x - 0.01, -h + 0.02, 0.04]),
            );
    }
    Model::fixed("blind", "blinds").part(body)
}
