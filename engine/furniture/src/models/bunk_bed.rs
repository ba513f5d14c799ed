//! A bunk bed with a ladder.

use super::bedding::foam_fill_fraction;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::cloth;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("bunk_bed", "bunker_bed", 33, bunk_bed)];

/// Two beds, one above the other, with a ladder at the front of the foot end. The heads are at -Z, the open side is +X.
fn bunk_bed(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bunk_bed", key);
    let (w, h, length) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * length);
    let wood = style.random_wood(&mut d.stream("wood"));
    let sheet = cloth("white_linen", [238, 236, 230]);
    let cover = style.random_cloth(&mut d.stream("cover"));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut body = PartBuilder::new("body").with_all(
        wood,
        corners.map(|(sx, sz)| {
            let (a, b) = (sx * (x - 0.035), sz * (z - 0.035));
            block([a - 0.035, 0.0, b - 0.035], [a + 0.035, h, b + 0.035])
        }),
    );
    // Mattresses lie on slats at these heights; EN 747 asks for a guard of 0.26 m, and 0.75 m between the beds.
    let (lower, upper) = (0.3, h - 0.41);
    for base in [lower, upper] {
        let rail = |sx: f32| {
            let a = sx * (x - 0.02);
            block(
                [a - 0.015, base - 0.1, -z + 0.07],
                [a + 0.015, base + 0.04, z - 0.07],
            )
        };
        let end = |sz: f32| {
            let b = sz * (z - 0.02);
            block(
                [-x + 0.07, base - 0.1, b - 0.015],
                [x - 0.07, base + 0.3, b + 0.015],
            )
        };
        let top = base + 0.14;
        body = body
            .with_all(wood, [rail(-1.0), rail(1.0), end(-1.0), end(1.0)])
            .with(
                wood,
                block(
                    [-x + 0.035, base - 0.02, -z + 0.035],
                    [x - 0.035, base, z - 0.035],
                ),
            )
            .with_fill_fraction(
                &sheet,
                rounded_block(
                    [-x + 0.04, base, -z + 0.04],
                    [x - 0.04, top, z - 0.04],
                    0.04,
                    2,
                ),
                foam_fill_fraction(&sheet),
            )
            .with_fill_fraction(
                cover,
                rounded_block(
                    [-x + 0.045, top, -z + 0.55],
                    [x - 0.045, top + 0.025, z - 0.05],
                    0.01,
                    1,
                ),
                0.4,
            );
    }
    let guard = |sx: f32, from: f32| {
        let a = sx * (x - 0.02);
        block([a - 0.012, h - 0.13, from], [a + 0.012, h - 0.03, z - 0.07])
    };
    let back = block(
        [-x + 0.008, h - 0.13, -z + 0.07],
        [-x + 0.032, h - 0.03, z - 0.07],
    );
    body = body.with_all(wood, [back, guard(1.0, -z + 0.55)]);
    let ladder_z = [-z + 0.1, -z + 0.48];
    let stile = |b: f32| block([x, 0.0, b - 0.02], [x + 0.03, h, b + 0.02]);
    let count = ((upper - 0.1) / 0.25) as usize;
    let rungs = (1..=count).map(|k| {
        let y = 0.25 * k as f32;
        block(
            [x + 0.004, y, ladder_z[0] + 0.02],
            [x + 0.03, y + 0.03, ladder_z[1] - 0.02],
        )
    });
    body = body
        .with_all(wood, ladder_z.map(stile))
        .with_all(wood, rungs);
    Model::fixed("bunk_bed", "bunker_bed")
        .part(body)
        .with_support_surface(
            "lower_pillow_end",
            [-x + 0.08, lower + 0.14, -z + 0.08],
            [x - 0.08, lower + 0.5, -z + 0.52],
        )
        .with_support_surface(
            "lower_bed",
            [-x + 0.08, lower + 0.165, -z + 0.58],
            [x - 0.08, upper - 0.12, z - 0.1],
        )
        .with_support_surface(
            "upper_pillow_end",
            [-x + 0.08, upper + 0.14, -z + 0.08],
            [x - 0.08, h, -z + 0.52],
        )
}
