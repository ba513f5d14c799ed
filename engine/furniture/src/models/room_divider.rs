//! A folding screen.

use crate::catalogue_entry::CatalogueEntry;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::block;
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "room_divider",
    "partition",
    104,
    room_divider,
)];

/// A screen of three leaves that stands in a zigzag.
fn room_divider(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("room_divider", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let wood = style.random_wood(&mut d.stream("wood"));
    let cloth = if d.chance("paper", 0.4) {
        crate::finishes::paper("rice_paper", [240, 234, 218])
    } else {
        style.random_cloth(&mut d.stream("cloth")).clone()
    };
    let t = 0.022;
    let run = w / 3.0;
    // The corners of the ends reach about half a thickness further.
    let rise = depth - 0.5 * t;
    let leaf_m = (run * run + rise * rise).sqrt();
    let angle = dwell_scene::math::atan2(rise, run);
    let mut body = PartBuilder::new("body");
    for k in 0..3 {
        let spin = if k % 2 == 0 { angle } else { -angle };
        let middle = -0.5 * w + run * (k as f32 + 0.5);
        // Neighbours meet at the edges of their ends.
        let half = 0.5 * (leaf_m - t * rise / run);
        let place =
            |solid: crate::shapes::SolidMesh| solid.rotated_y(spin).translated(middle, 0.0, 0.0);
        let (a, bar) = (half, 0.035);
        let rails = [
            block([-a, 0.0, -0.5 * t], [-a + bar, h, 0.5 * t]),
            block([a - bar, 0.0, -0.5 * t], [a, h, 0.5 * t]),
            block([-a + bar, 0.1, -0.5 * t], [a - bar, 0.1 + bar, 0.5 * t]),
            block([-a + bar, h - bar, -0.5 * t], [a - bar, h, 0.5 * t]),
            block(
                [-a + bar, 0.55 * h, -0.5 * t],
                [a - bar, 0.55 * h + bar, 0.5 * t],
            ),
        ];
        body = body
            .with_all(wood, rails.map(place))
            .with(
                &cloth,
                place(block(
                    [-a + bar, 0.1 + bar, -0.002],
                    [a - bar, 0.55 * h, 0.002],
                )),
            )
            .with(
                &cloth,
                place(block(
                    [-a + bar, 0.55 * h + bar, -0.002],
                    [a - bar, h - bar, 0.002],
                )),
            );
    }
    Model::movable("room_divider", "partition").part(body)
}
