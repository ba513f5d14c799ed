//! A chest of drawers.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, drawer, drawer_space};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block, tapered_leg};
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("dresser", "dresser", 22, dresser)];

/// Two columns of drawers under one top, on legs.
#[derive(Clone, Debug)]
struct Dresser {
    /// m.
    width_m: f32,
    /// m.
    height_m: f32,
    /// m.
    depth_m: f32,
    /// Drawers above each other.
    rows: usize,
    /// Finish of the body.
    wood: Finish,
    /// Style of doors and drawers.
    front: FrontStyle,
}

impl Dresser {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        const LEG_M: f32 = 0.12;
        let (x, top) = (0.5 * self.width_m, self.height_m - 0.022);
        let carcass =
            Carcass::floor_standing(self.width_m - 0.02, LEG_M, top, self.depth_m - BOARD_M);
        let z = carcass.max[2];
        let mut body = PartBuilder::new("body")
            .with(
                &self.wood,
                rounded_block([-x, top, -z], [x, self.height_m, z + BOARD_M], 0.006, 1),
            )
            .with_all(&self.wood, carcass.boards(&[], &[0.5]));
        for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let (a, b) = (sx * (x - 0.06), sz * (z - 0.04));
            body = body.with(
                &self.wood,
                tapered_leg([a * 1.02, 0.0, b], [a, LEG_M, b], 0.026, 0.042),
            );
        }
        // Runners between the rows, on both sides of the wall in the middle.
        let step = (top - LEG_M) / self.rows as f32;
        for k in 1..self.rows {
            let y = LEG_M + step * k as f32;
            let runner =
                |left: f32, right: f32| block([left, y - 0.006, z - 0.03], [right, y + 0.006, z]);
            body = body.with_all(
                &self.wood,
                [
                    runner(-x + 0.03, -0.5 * BOARD_M),
                    runner(0.5 * BOARD_M, x - 0.03),
                ],
            );
        }
        let mut model = Model::articulated("dresser", "dresser")
            .part(body)
            .with_support_surface("top", [-x, self.height_m, -z], [x, self.height_m + 0.6, z]);
        let front = self.front.clone();
        let half = carcass.max[0];
        for (k, name) in NAMES.into_iter().take(2 * self.rows).enumerate() {
            let left = if k % 2 == 0 { -half } else { 0.0 };
            let low = LEG_M + step * (k / 2) as f32;
            let (low, high) = (
                [left + GAP_M, low + GAP_M],
                [left + half - GAP_M, low + step - GAP_M],
            );
            let (min, max) = drawer_space(low, high, z, self.depth_m - 0.1);
            model = model
                .part(drawer(name, low, high, z, self.depth_m - 0.1, &front))
                .sliding(name, Vec3::Z, self.depth_m - 0.16)
                .with_container_space(name, min, max);
        }
        model
    }
}

const NAMES: [&str; 8] = [
    "drawer_1", "drawer_2", "drawer_3", "drawer_4", "drawer_5", "drawer_6", "drawer_7", "drawer_8",
];

fn dresser(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dresser", key);
    let height = d.sample_m("height");
    Dresser {
        width_m: d.sample_m("width"),
        height_m: height,
        depth_m: d.sample_m("depth"),
        rows: ((height / 0.26) as usize).clamp(2, 4),
        wood: style.random_wood(&mut d.stream("wood")).clone(),
        front: style.front_style(),
    }
    .build()
}
