//! Low cabinets: television stands and sideboards.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block};
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("sideboard", "wardrobe_cabinet", 21, sideboard),
    CatalogueEntry::new("tv_stand", "tv_stand", 23, tv_stand),
];

/// A sideboard or media cabinet: doors left and right, open shelves between.
#[derive(Clone, Debug)]
struct Lowboard {
    /// Name of the instances: `"tv_stand"`.
    name: &'static str,
    /// A row of `assets/categories.csv`.
    category: &'static str,
    /// m.
    width_m: f32,
    /// m.
    height_m: f32,
    /// m.
    depth_m: f32,
    /// Finish of the body.
    wood: Finish,
    /// Style of doors and drawers.
    front: FrontStyle,
}

impl Lowboard {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        let (x, top) = (0.5 * self.width_m, self.height_m - 0.02);
        let carcass =
            Carcass::floor_standing(self.width_m - 0.01, 0.07, top, self.depth_m - BOARD_M);
        let z = carcass.max[2];
        let body = PartBuilder::new("body")
            .with(
                &self.wood,
                rounded_block([-x, top, -z], [x, self.height_m, z + BOARD_M], 0.006, 1),
            )
            .with(
                &black_plastic(),
                block([-x + 0.05, 0.0, -z + 0.02], [x - 0.05, 0.07, z - 0.05]),
            )
            .with_all(&self.wood, carcass.boards(&[0.5], &[1.0 / 3.0, 2.0 / 3.0]));
        let third = (carcass.max[0] - carcass.min[0]) / 3.0;
        let (_, upper) = carcass.space_between_shelves(0.5, 1.0);
        let (lower, _) = carcass.space_between_shelves(0.5, 1.0);
        let middle = 0.5 * third - 0.02;
        let mut model = Model::articulated(self.name, self.category)
            .part(body)
            .with_support_surface("top", [-x, self.height_m, -z], [x, self.height_m + 0.8, z])
            .with_support_surface(
                "shelf",
                [-middle, lower[1], lower[2]],
                [middle, upper[1], upper[2]],
            );
        let front = self.front.clone();
        for (name, left) in [("left_door", true), ("right_door", false)] {
            let near = if left {
                carcass.min[0]
            } else {
                carcass.max[0] - third
            };
            let part = door(
                name,
                [near + GAP_M, 0.075],
                [near + third - GAP_M, top - GAP_M],
                z,
                left,
                &front,
            );
            let hinge = if left { near } else { near + third };
            let axis = if left { Vec3::NEG_Y } else { Vec3::Y };
            model = model
                .part(part)
                .hinged(name, [hinge, 0.0, z + BOARD_M], axis, 1.7);
        }
        model
    }
}

fn lowboard(style: &Style, d: &SizeSampler, name: &'static str, category: &'static str) -> Model {
    Lowboard {
        name,
        category,
        width_m: d.sample_m("width"),
        height_m: d.sample_m("height"),
        depth_m: d.sample_m("depth"),
        wood: style.random_wood(&mut d.stream("wood")).clone(),
        front: style.front_style(),
    }
    .build()
}

fn tv_stand(style: &Style, key: RandomKey) -> Model {
    lowboard(
        style,
        &SizeSampler::new("tv_stand", key),
        "tv_stand",
        "tv_stand",
    )
}

fn sideboard(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sideboard", key);
    lowboard(style, &d, "sideboard", "wardrobe_cabinet")
}
