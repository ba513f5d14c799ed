//! Bookshelves, wall shelves, cube shelves and metal racks.

use super::cabinet_parts::{BOARD_M, Carcass, SHELVES};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, grey_board, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::block;
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("bookshelf", "bookshelf", 24, bookshelf),
    CatalogueEntry::new("cube_shelf", "shelving", 25, cube_shelf),
    CatalogueEntry::new("metal_rack", "shelving", 26, metal_rack),
    CatalogueEntry::new("wall_shelf", "shelving", 27, sample_wall_shelf),
];

/// An open bookcase.
#[derive(Clone, Debug)]
struct Bookshelf {
    /// m.
    width_m: f32,
    /// m.
    height_m: f32,
    /// m.
    depth_m: f32,
    /// Number of compartments, 2 to 6.
    levels: usize,
    /// Finish of the body.
    wood: Finish,
}

impl Bookshelf {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
        let carcass = Carcass::floor_standing(self.width_m, 0.0, self.height_m, self.depth_m);
        let levels = self.levels.clamp(2, SHELVES.len());
        let shares: Vec<f32> = (1..levels).map(|k| k as f32 / levels as f32).collect();
        let body = PartBuilder::new("body").with_all(&self.wood, carcass.boards(&shares, &[]));
        let mut model = Model::fixed("bookshelf", "bookshelf").part(body);
        for (k, name) in SHELVES.into_iter().take(levels).enumerate() {
            let (low, high) = carcass
                .space_between_shelves(k as f32 / levels as f32, (k + 1) as f32 / levels as f32);
            model = model.with_support_surface(name, low, high);
        }
        let (x, z) = (0.5 * self.width_m, 0.5 * self.depth_m);
        model.with_support_surface("top", [-x, self.height_m, -z], [x, self.height_m + 0.4, z])
    }
}

fn bookshelf(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bookshelf", key);
    let height = d.sample_m("height");
    Bookshelf {
        width_m: d.sample_m("width"),
        height_m: height,
        depth_m: d.sample_m("depth"),
        levels: ((height / 0.36).round() as usize).clamp(2, 6),
        wood: style.random_wood(&mut d.stream("wood")).clone(),
    }
    .build()
}

/// A board on the wall.
fn wall_shelf(width_m: f32, depth_m: f32, wood: &Finish) -> Model {
    let x = 0.5 * width_m;
    let body = PartBuilder::new("body")
        .with(wood, block([-x, -0.03, 0.0], [x, 0.0, depth_m]))
        .with_all(
            wood,
            [-x + 0.08, x - 0.1].map(|a| block([a, -0.12, 0.0], [a + 0.02, -0.03, 0.7 * depth_m])),
        );
    Model::fixed("wall_shelf", "shelving")
        .part(body)
        .with_support_surface("top", [-x, 0.0, 0.0], [x, 0.35, depth_m])
}

fn sample_wall_shelf(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_shelf", key);
    wall_shelf(
        d.sample_m("width"),
        d.sample_m("depth"),
        style.random_wood(&mut d.stream("wood")),
    )
}

/// A rack of open cubes.
fn cube_shelf(style: &Style, key: RandomKey) -> Model {
    const NAMES: [[&str; 4]; 4] = [
        ["cube_1_1", "cube_1_2", "cube_1_3", "cube_1_4"],
        ["cube_2_1", "cube_2_2", "cube_2_3", "cube_2_4"],
        ["cube_3_1", "cube_3_2", "cube_3_3", "cube_3_4"],
        ["cube_4_1", "cube_4_2", "cube_4_3", "cube_4_4"],
    ];
    let d = SizeSampler::new("cube_shelf", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let count = |length: f32| ((length / 0.37).round() as usize).clamp(1, 4);
    let (columns, rows) = (count(w), count(h));
    let carcass = Carcass::floor_standing(w, 0.0, h, depth);
    let share = |k: usize, n: usize| k as f32 / n as f32;
    let levels: Vec<f32> = (1..rows).map(|k| share(k, rows)).collect();
    let walls: Vec<f32> = (1..columns).map(|k| share(k, columns)).collect();
    let wood = style.random_wood(&mut d.stream("wood"));
    let body = PartBuilder::new("body").with_all(wood, carcass.boards(&levels, &walls));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let mut model = Model::fixed("cube_shelf", "shelving")
        .part(body)
        .with_support_surface("top", [-x, h, -z], [x, h + 0.5, z]);
    for (row, names) in NAMES.iter().take(rows).enumerate() {
        let (low, high) = carcass.space_between_shelves(share(row, rows), share(row + 1, rows));
        for (column, name) in names.iter().take(columns).enumerate() {
            let left = -x + share(column, columns) * w + BOARD_M;
            let right = -x + share(column + 1, columns) * w - BOARD_M;
            model =
                model.with_support_surface(name, [left, low[1], low[2]], [right, high[1], high[2]]);
        }
    }
    model
}

/// A rack of steel posts with boards: for a pantry, a cellar, a workshop loft.
fn metal_rack(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("metal_rack", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let steel = painted_steel("black_steel", [46, 46, 48]);
    let boards = if d.chance("wooden", 0.5) {
        style.wood.clone()
    } else {
        grey_board()
    };
    let mut body = PartBuilder::new("body");
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (x - 0.015), sz * (z - 0.015));
        let post = block([a - 0.015, 0.0, b - 0.015], [a + 0.015, h, b + 0.015]);
        body = body.with_fill_fraction(&steel, post, 0.2);
    }
    let levels = ((h / 0.4).round() as usize).clamp(3, SHELVES.len());
    let level = |k: usize| 0.08 + (h - 0.12) * k as f32 / (levels - 1) as f32;
    for k in 0..levels {
        let y = level(k);
        let board = block([-x + 0.03, y, -z + 0.002], [x - 0.03, y + 0.018, z - 0.002]);
        body = body.with(&boards, board);
    }
    let mut model = Model::fixed("metal_rack", "shelving").part(body);
    for (k, name) in SHELVES.into_iter().take(levels).enumerate() {
        let ceiling = if k + 1 < levels {
            level(k + 1)
        } else {
            h + 0.35
        };
        let low = [-x + 0.035, level(k) + 0.018, -z + 0.01];
        model = model.with_support_surface(name, low, [x - 0.035, ceiling, z - 0.01]);
    }
    model
}
