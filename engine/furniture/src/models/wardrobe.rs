//! A wardrobe with hinged doors.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, chrome};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rod};
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "wardrobe",
    "wardrobe_cabinet",
    20,
    wardrobe,
)];

/// Doors in pairs over a carcass with a rail and a hat shelf.
#[derive(Clone, Debug)]
struct Wardrobe {
    /// m.
    width_m: f32,
    /// m.
    height_m: f32,
    /// m.
    depth_m: f32,
    /// Doors beside each other.
    doors: usize,
    /// Finish of the carcass.
    body: Finish,
    /// Style of doors and drawers.
    front: FrontStyle,
}

impl Wardrobe {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        let carcass =
            Carcass::floor_standing(self.width_m, 0.06, self.height_m, self.depth_m - BOARD_M);
        let (x, z) = (0.5 * self.width_m, carcass.max[2]);
        let rail = self.height_m - 0.42;
        let body = PartBuilder::new("body")
            .with(&self.body, block([-x, 0.0, -z], [x, 0.06, z - 0.03]))
            .with_all(&self.body, carcass.boards(&[0.84], &[]))
            .with(
                &chrome(),
                rod([-x + BOARD_M, rail, 0.0], [x - BOARD_M, rail, 0.0], 0.012),
            );
        let (low, high) = carcass.space_between_shelves(0.0, 0.84);
        let (shelf_low, shelf_high) = carcass.space_between_shelves(0.84, 1.0);
        let mut model = Model::articulated("wardrobe", "wardrobe_cabinet")
            .part(body)
            .with_container_space("inside", low, [high[0], rail - 0.03, high[2]])
            .with_container_space("hat_shelf", shelf_low, shelf_high)
            .with_support_surface("top", [-x, self.height_m, -z], [x, self.height_m + 0.4, z]);
        let front = self.front.clone();
        let count = self.doors.min(NAMES.len());
        let step = self.width_m / count as f32;
        for (k, name) in NAMES.into_iter().take(count).enumerate() {
            let (left, right) = (-x + step * k as f32, -x + step * (k + 1) as f32);
            // Doors of a pair meet with their handles; an odd last one hangs on its right.
            let hinge_left = k % 2 == 0 && k + 1 < count;
            let part = door(
                name,
                [left + 0.5 * GAP_M, 0.065],
                [right - 0.5 * GAP_M, self.height_m],
                z,
                hinge_left,
                &front,
            );
            let hinge = if hinge_left { left } else { right };
            let axis = if hinge_left { Vec3::NEG_Y } else { Vec3::Y };
            model = model
                .part(part)
                .hinged(name, [hinge, 0.0, z + BOARD_M], axis, 1.7);
        }
        model
    }
}

const NAMES: [&str; 4] = ["door_1", "door_2", "door_3", "door_4"];

fn wardrobe(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wardrobe", key);
    let width = d.sample_m("width");
    Wardrobe {
        width_m: width,
        height_m: d.sample_m("height"),
        depth_m: d.sample_m("depth"),
        doors: ((width / 0.48).round() as usize).clamp(2, 4),
        body: style.random_wood(&mut d.stream("wood")).clone(),
        front: style.front_style(),
    }
    .build()
}
