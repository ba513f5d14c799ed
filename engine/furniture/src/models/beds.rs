//! Single and double beds.

use super::bedding::foam_fill_fraction;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, cloth, oak};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, blanket, block, rounded_block, tapered_leg};
use crate::style::{LegStyle, Style};
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("double_bed", "double_bed", 31, double_bed),
    CatalogueEntry::new("single_bed", "single_bed", 32, single_bed),
];

/// A bed with a mattress, made up with a blanket; pillows are things of their own. The head is at -Z.
#[derive(Clone, Debug)]
struct Bed {
    /// Of the mattress: along x, along z, m.
    mattress_m: [f32; 2],
    /// Height of the headboard, m.
    head_m: f32,
    /// Finish of the body.
    wood: Finish,
    /// Headboard of posts and bars instead of a panel.
    barred: bool,
    /// Headboard, if not of wood.
    headboard: Option<Finish>,
    /// Cloth over the mattress.
    sheet: Finish,
    /// Cloth of the blanket.
    blanket: Finish,
}

impl Default for Bed {
    fn default() -> Self {
        Self {
            mattress_m: [1.6, 2.0],
            head_m: 1.05,
            wood: oak(),
            barred: false,
            headboard: None,
            sheet: cloth("white_linen", [238, 236, 230]),
            blanket: cloth("teal_linen", [86, 120, 124]),
        }
    }
}

impl Bed {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        let [width, length] = self.mattress_m;
        let (x, z) = (0.5 * width + 0.035, 0.5 * length + 0.035);
        let head = self.headboard.as_ref().unwrap_or(&self.wood);
        let mut body = PartBuilder::new("body")
            .with(&self.wood, block([-x, 0.2, -z], [x, 0.32, -z + 0.03]))
            .with(
                &self.wood,
                rounded_block([-x, 0.18, z - 0.03], [x, 0.36, z], 0.008, 1),
            )
            .with(
                &self.wood,
                block([-x, 0.2, -z + 0.03], [-x + 0.03, 0.32, z - 0.03]),
            )
            .with(
                &self.wood,
                block([x - 0.03, 0.2, -z + 0.03], [x, 0.32, z - 0.03]),
            )
            .with(
                &self.wood,
                block([-x + 0.03, 0.25, -z + 0.03], [x - 0.03, 0.27, z - 0.03]),
            );
        body = body.with_all(head, self.head(x, z));
        for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let (a, b) = (sx * (x - 0.06), sz * (z - 0.07));
            body = body.with(
                &self.wood,
                tapered_leg([a, 0.0, b], [a, 0.2, b], 0.045, 0.06),
            );
        }
        let (mx, mz) = (0.5 * width, 0.5 * length);
        body = body.with_fill_fraction(
            &self.sheet,
            rounded_block([-mx, 0.27, -mz], [mx, MATTRESS_TOP_M, mz], 0.06, 2),
            foam_fill_fraction(&self.sheet),
        );
        // The blanket leaves the upper third of the mattress to the pillows and is turned back there.
        let cover = 0.68 * length;
        body = body
            .with_fill_fraction(
                &self.blanket,
                blanket(width + 0.03, cover, 0.26, 0.035).translated(
                    0.0,
                    MATTRESS_TOP_M,
                    mz + 0.02 - 0.5 * cover,
                ),
                0.5,
            )
            .with_fill_fraction(
                &self.sheet,
                rounded_block(
                    [-mx, MATTRESS_TOP_M + 0.02, mz - cover - 0.02],
                    [mx, MATTRESS_TOP_M + 0.05, mz - cover + 0.22],
                    0.014,
                    1,
                ),
                0.3,
            );
        let (name, category) = if width > 1.3 {
            ("double_bed", "double_bed")
        } else {
            ("single_bed", "single_bed")
        };
        Model::fixed(name, category)
            .part(body)
            .with_support_surface(
                "pillow_end",
                [-mx, MATTRESS_TOP_M, -mz],
                [mx, 1.2, mz - cover - 0.03],
            )
            .with_support_surface(
                "blanket",
                [-mx, MATTRESS_TOP_M + 0.035, mz - cover + 0.25],
                [mx, 1.2, mz - 0.1],
            )
    }

    /// The headboard behind the bed's end at (±`x`, -`z`).
    fn head(&self, x: f32, z: f32) -> Vec<SolidMesh> {
        if !self.barred {
            let panel = rounded_block([-x, 0.12, -z - 0.06], [x, self.head_m, -z], 0.02, 2);
            return vec![panel];
        }
        let (back, front) = (-z - 0.05, -z);
        let rail = |low: f32, high: f32| {
            block(
                [-x + 0.05, low, back + 0.01],
                [x - 0.05, high, front - 0.01],
            )
        };
        let post = |at: f32| block([at - 0.025, 0.0, back], [at + 0.025, self.head_m, front]);
        let (low, top) = (0.42, self.head_m - 0.1);
        let count = (2.0 * x / 0.13) as usize;
        let bar = |k: usize| {
            let at = -x + 0.05 + (2.0 * x - 0.1) * k as f32 / count as f32;
            block([at - 0.012, low, -z - 0.033], [at + 0.012, top, -z - 0.017])
        };
        let mut solids = vec![post(-x + 0.025), post(x - 0.025)];
        solids.extend([rail(low - 0.07, low), rail(top, self.head_m - 0.02)]);
        solids.extend((1..count).map(bar));
        solids
    }
}

/// Height of the mattress' upper face, m.
const MATTRESS_TOP_M: f32 = 0.5;

fn bed(style: &Style, d: &SizeSampler) -> Model {
    let covered = d.chance("covered", 0.4);
    // Turned and heavy legs go with bars.
    let old = matches!(style.leg, LegStyle::Turned | LegStyle::Square);
    Bed {
        mattress_m: [d.sample_m("width") - 0.14, d.sample_m("depth") - 0.13],
        head_m: d.sample_m("height"),
        wood: style.random_wood(&mut d.stream("wood")).clone(),
        barred: !covered && d.chance("barred", if old { 0.6 } else { 0.2 }),
        headboard: covered.then(|| style.random_upholstery(&mut d.stream("head")).clone()),
        blanket: style.random_cloth(&mut d.stream("blanket")).clone(),
        ..Bed::default()
    }
    .build()
}

fn double_bed(style: &Style, key: RandomKey) -> Model {
    bed(style, &SizeSampler::new("double_bed", key))
}

fn single_bed(style: &Style, key: RandomKey) -> Model {
    bed(style, &SizeSampler::new("single_bed", key))
}
