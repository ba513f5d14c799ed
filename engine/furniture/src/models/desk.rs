//! A desk with drawers on one side.

use super::cabinet_parts::{Carcass, GAP_M, drawer, drawer_space};
use crate::finishes::{Finish, black, oak, white_lacquer};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, rounded_block};
use crate::style::FrontStyle;
use glam::Vec3;

/// A writing desk: a top, a side panel, a block of three drawers.
#[derive(Clone, Debug)]
pub struct Desk {
    /// m.
    pub width_m: f32,
    /// m.
    pub depth_m: f32,
    /// m.
    pub height_m: f32,
    /// What the top is made of.
    pub top: Finish,
    /// What the carcass is made of.
    pub body: Finish,
    /// What doors and drawers look like.
    pub front: FrontStyle,
}

impl Default for Desk {
    fn default() -> Self {
        Self {
            width_m: 1.3,
            depth_m: 0.62,
            height_m: 0.74,
            top: oak(),
            body: white_lacquer(),
            front: FrontStyle::plain(white_lacquer(), black()),
        }
    }
}

impl Desk {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
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
        let mut model = Model::articulated("desk", "desk").part(body).top(
            "top",
            [-x, self.height_m, -z],
            [x, self.height_m + 0.6, z],
        );
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
                .inside(name, min, max);
        }
        model
    }
}
