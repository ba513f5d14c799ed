//! Desks with drawers on one side, and plain writing tables.

use super::cabinet_parts::{Carcass, GAP_M, drawer, drawer_space};
use super::four_legged_table::Table;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block};
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new("desk", "desk", 14, desk)];

/// A writing desk: a top, a side panel, a block of three drawers.
#[derive(Clone, Debug)]
struct Desk {
    /// m.
    width_m: f32,
    /// m.
    depth_m: f32,
    /// m.
    height_m: f32,
    /// Finish of the top.
    top: Finish,
    /// Finish of the carcass.
    body: Finish,
    /// Style of doors and drawers.
    front: FrontStyle,
}

impl Desk {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        const BLOCK_M: f32 = 0.38;
        let (x, z, under) = (
            0.5 * self.width_m,
            0.5 * self.depth_m,
            self.height_m - 0.028,
        );
        let carcass = Carcass {
            min: [x - BLOCK_M - 0.02, 0.03, -z + 0.03],
            max: [x - 0.02, under, z - 0.05],
        };
        let body = PartBuilder::new("body")
            .with(
                &self.top,
                rounded_block([-x, under, -z], [x, self.height_m, z], 0.006, 1),
            )
            .with(
                &self.body,
                block([-x + 0.02, 0.0, -z + 0.03], [-x + 0.05, under, z - 0.05]),
            )
            .with(
                &self.body,
                block(
                    [-x + 0.05, under - 0.3, -z + 0.04],
                    [x - BLOCK_M - 0.02, under, -z + 0.058],
                ),
            )
            .with(
                &self.body,
                block([x - BLOCK_M, 0.0, -z + 0.05], [x - 0.04, 0.03, z - 0.09]),
            )
            .with_all(&self.body, carcass.boards(&[], &[]));
        let mut model = Model::articulated("desk", "desk")
            .part(body)
            .with_support_surface("top", [-x, self.height_m, -z], [x, self.height_m + 0.6, z]);
        let front = self.front.clone();
        let face = carcass.max[2];
        for (k, name) in ["upper_drawer", "middle_drawer", "lower_drawer"]
            .into_iter()
            .enumerate()
        {
            let step = (carcass.max[1] - carcass.min[1]) / 3.0;
            let top = carcass.max[1] - step * k as f32 - GAP_M;
            let (low, high) = ([carcass.min[0], top - step + GAP_M], [carcass.max[0], top]);
            let (min, max) = drawer_space(low, high, face, 0.45);
            model = model
                .part(drawer(name, low, high, face, 0.45, &front))
                .sliding(name, Vec3::Z, 0.36)
                .with_container_space(name, min, max);
        }
        model
    }
}

fn desk(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("desk", key);
    let wood = style.random_wood(&mut d.stream("wood")).clone();
    if d.chance("plain", 0.3) {
        return Table {
            name: "writing_table",
            category: "desk",
            size_m: [d.sample_m("width"), d.sample_m("depth")],
            height_m: d.sample_m("height"),
            top: wood,
            legs: style.leg_finish().clone(),
            leg_m: 0.055,
            ..Table::default()
        }
        .build();
    }
    let same = d.chance("one_wood", 0.5);
    Desk {
        width_m: d.sample_m("width"),
        depth_m: d.sample_m("depth"),
        height_m: d.sample_m("height"),
        body: if same {
            wood.clone()
        } else {
            style.front.clone()
        },
        top: wood,
        front: style.front_style(),
    }
    .build()
}
