//! Bookshelves, wall shelves, and what stands in them.

use super::cabinet_parts::Carcass;
use crate::finishes::{Finish, oak, pages};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, panel};
use crate::textures::Srgb;
use dwell_scene::random::RandomKey;

/// An open bookcase.
#[derive(Clone, Debug)]
pub struct Bookshelf {
    /// m.
    pub width_m: f32,
    /// m.
    pub height_m: f32,
    /// m.
    pub depth_m: f32,
    /// Number of compartments, 2 to 6.
    pub levels: usize,
    /// What the body is made of.
    pub wood: Finish,
}

impl Default for Bookshelf {
    fn default() -> Self {
        Self {
            width_m: 0.9,
            height_m: 1.9,
            depth_m: 0.3,
            levels: 5,
            wood: oak(),
        }
    }
}

/// What the compartments of a bookcase are called, from below.
pub const SHELVES: [&str; 6] = [
    "shelf_1", "shelf_2", "shelf_3", "shelf_4", "shelf_5", "shelf_6",
];

impl Bookshelf {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let carcass = Carcass::standing(self.width_m, 0.0, self.height_m, self.depth_m);
        let levels = self.levels.clamp(2, SHELVES.len());
        let shares: Vec<f32> = (1..levels).map(|k| k as f32 / levels as f32).collect();
        let body = PartBuilder::new("body").with_all(&self.wood, carcass.boards(&shares, &[]));
        let mut model = Model::fixed("bookshelf", "bookshelf").part(body);
        for (k, name) in SHELVES.into_iter().take(levels).enumerate() {
            let (low, high) =
                carcass.space(k as f32 / levels as f32, (k + 1) as f32 / levels as f32);
            model = model.top(name, low, high);
        }
        let (x, z) = (0.5 * self.width_m, 0.5 * self.depth_m);
        model.top("top", [-x, self.height_m, -z], [x, self.height_m + 0.4, z])
    }
}

/// A board on the wall.
pub fn wall_shelf(width_m: f32, depth_m: f32, wood: &Finish) -> Model {
    let x = 0.5 * width_m;
    let body = PartBuilder::new("body")
        .with(wood, block([-x, -0.03, 0.0], [x, 0.0, depth_m]))
        .with_all(
            wood,
            [-x + 0.08, x - 0.1].map(|a| block([a, -0.12, 0.0], [a + 0.02, -0.03, 0.7 * depth_m])),
        );
    Model::fixed("wall_shelf", "shelving")
        .part(body)
        .top("top", [-x, 0.0, 0.0], [x, 0.35, depth_m])
}

/// Colours of book covers: cloth, label, band.
const COVERS: [[Srgb; 3]; 8] = [
    [[150, 48, 42], [226, 208, 168], [206, 172, 92]],
    [[44, 74, 112], [220, 220, 212], [186, 150, 80]],
    [[58, 96, 70], [230, 222, 196], [214, 190, 120]],
    [[206, 160, 70], [80, 52, 40], [120, 70, 40]],
    [[92, 58, 96], [226, 214, 224], [190, 160, 190]],
    [[222, 214, 196], [150, 60, 50], [60, 70, 90]],
    [[42, 44, 50], [206, 70, 60], [210, 206, 196]],
    [[72, 140, 150], [236, 232, 220], [232, 120, 80]],
];

/// The finish of the cover number `k`.
pub const fn cover(k: usize) -> Finish {
    Finish::picture("book_cover", "books", "cover", COVERS[k % COVERS.len()], 1)
}

/// The plain spine that fits the cover number `k`.
const fn spine(k: usize) -> Finish {
    Finish::plain("book_spine", "books", COVERS[k % COVERS.len()][0])
}

/// A book that lies on its back: `size_m` (x, thickness, z), the spine at -X.
pub fn book(size_m: [f32; 3], k: usize) -> Model {
    let [w, t, d] = size_m;
    let (x, z, board) = (0.5 * w, 0.5 * d, 0.1 * t);
    let front = panel(w, d, board)
        .about_x(-std::f32::consts::FRAC_PI_2)
        .at(0.0, t - board, z);
    let body = PartBuilder::new("body")
        .with(&cover(k), front)
        .with(&spine(k), block([-x, 0.0, -z], [x, board, z]))
        .with(
            &spine(k),
            block([-x, board, -z], [-x + 0.003, t - board, z]),
        )
        .with(
            &pages(),
            block(
                [-x + 0.003, board, -z + 0.004],
                [x - 0.004, t - board, z - 0.004],
            ),
        );
    Model::pickable("book", "book").part(body)
}

/// A row of upright books, spines towards +Z, about `width_m` wide; the last ones lean or are missing, as `key` draws.
pub fn book_row(width_m: f32, height_m: f32, key: RandomKey) -> Model {
    let mut random = key.stream();
    let mut body = PartBuilder::new("body");
    let mut x = -0.5 * width_m;
    loop {
        let thick = random.range(0.018, 0.046);
        if x + thick > 0.5 * width_m {
            break;
        }
        let (h, d) = (height_m * random.range(0.72, 1.0), random.range(0.14, 0.2));
        let k = random.below(COVERS.len());
        let back = 0.1 - d;
        body = body
            .with(&spine(k), block([x, 0.0, back], [x + thick, h, 0.1]))
            .with(
                &Finish::plain("book_label", "paper", COVERS[k][1]),
                block(
                    [x + 0.2 * thick, 0.68 * h, 0.1],
                    [x + 0.8 * thick, 0.8 * h, 0.1008],
                )
                .visual_only(),
            );
        x += thick + 0.0006;
    }
    Model::movable("row_of_books", "books").part(body)
}
