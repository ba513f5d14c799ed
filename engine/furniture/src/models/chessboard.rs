//! A chessboard with its pieces.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "chessboard",
    "chessboard",
    134,
    chessboard,
)];

/// A chess board with some pieces of a game on it.
fn chessboard(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("chessboard", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let thick = 0.016;
    let x = 0.5 * w;
    let square = (w - 0.04) / 8.0;
    let maple = Finish::plain("chess_maple", "wood", [226, 196, 150]);
    let dark = Finish::plain("chess_walnut", "wood", [104, 66, 44]);
    let mut squares = SolidMesh::default();
    for k in 0..64 {
        let (a, b) = (k % 8, k / 8);
        if (a + b) % 2 == 1 {
            let (from_x, from_z) = (-x + 0.02 + square * a as f32, -x + 0.02 + square * b as f32);
            squares = squares.merged(
                block(
                    [from_x, thick, from_z],
                    [from_x + square, thick + 0.0006, from_z + square],
                )
                .visual_only(),
            );
        }
    }
    let tall = h - thick;
    let piece = |share: f32| {
        let (t, r) = (tall * share, 0.36 * square);
        surface_of_revolution(
            &[
                (0.0, 0.0),
                (r, 0.0),
                (0.9 * r, 0.12 * t),
                (0.4 * r, 0.3 * t),
                (0.35 * r, 0.62 * t),
                (0.62 * r, 0.8 * t),
                (0.4 * r, 0.95 * t),
                (0.0, t),
            ],
            8,
        )
    };
    let mut random = d.stream("game");
    let mut body = PartBuilder::new("body")
        .with(&dark, block([-x, 0.0, -x], [x, thick - 0.002, x]))
        .with(
            &maple,
            block(
                [-x + 0.02, thick - 0.002, -x + 0.02],
                [x - 0.02, thick, x - 0.02],
            ),
        )
        .with(&dark, squares);
    // Pawns on the second and seventh rank, some moved forward; kings and queens behind.
    for k in 0..8 {
        for (color, home, way) in [(&maple, 6, -1), (&dark, 1, 1)] {
            if random.below(5) == 0 {
                continue;
            }
            let rank = home + way * [0, 0, 1, 2][random.below(4)];
            let at = |n: i32| -x + 0.02 + square * (n as f32 + 0.5);
            body = body.with(
                color,
                piece(0.55).translated(at(k), thick + 0.0006, at(rank)),
            );
        }
    }
    for (color, rank) in [(&maple, 7), (&dark, 0)] {
        for (file, share) in [(0, 0.6), (3, 0.92), (4, 1.0), (5, 0.8), (7, 0.6)] {
            let at = |n: i32| -x + 0.02 + square * (n as f32 + 0.5);
            body = body.with(
                color,
                piece(share).translated(at(file), thick + 0.0006, at(rank)),
            );
        }
    }
    Model::movable("chessboard", "chessboard").part(body)
}
