//! Cots, bunk beds, loose mattresses.

use crate::finishes::{Finish, cloth};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

/// Foam inside a cover: how much of its volume is substance of the cover's weight.
fn foam(cover: &Finish) -> f32 {
    let density = |name| {
        dwell_scene::material::library()
            .get_or_default(name)
            .density_kg_m3
    };
    density("foam") / cover.substance().density_kg_m3
}

/// A cot: bars all round a small mattress. The head is at -Z.
pub fn cot(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cot", key);
    let (w, h, length) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * length);
    let wood = style.any_wood(&mut d.stream("wood"));
    let sheet = cloth(
        "cot_sheet",
        d.of(
            "sheet",
            [
                [240, 238, 232],
                [214, 226, 236],
                [240, 226, 216],
                [226, 236, 220],
            ],
        ),
    );
    let base = 0.3;
    let post = |sx: f32, sz: f32| {
        let (a, b) = (sx * (x - 0.02), sz * (z - 0.02));
        block([a - 0.02, 0.0, b - 0.02], [a + 0.02, h, b + 0.02])
    };
    let side_rail = |sx: f32, y: f32| {
        let a = sx * (x - 0.02);
        block([a - 0.014, y, -z + 0.04], [a + 0.014, y + 0.035, z - 0.04])
    };
    let end = |sz: f32| {
        let b = sz * (z - 0.02);
        block(
            [-x + 0.04, base - 0.06, b - 0.01],
            [x - 0.04, h - 0.01, b + 0.01],
        )
    };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let bars = |sx: f32| {
        let count = ((length - 0.08) / 0.075) as usize;
        (1..count).map(move |k| {
            let at = -z + 0.04 + (length - 0.08) * k as f32 / count as f32;
            // Square bars collide through the panel that stands for all of them.
            cylinder(0.008, h - base - 0.05, 6)
                .at(sx * (x - 0.02), base - 0.02, at)
                .visual_only()
        })
    };
    let panel = |sx: f32| {
        let a = sx * (x - 0.02);
        block(
            [a - 0.008, base - 0.02, -z + 0.04],
            [a + 0.008, h - 0.035, z - 0.04],
        )
        .collision_only()
    };
    let body = PartBuilder::new("body")
        .with_all(wood, corners.map(|(a, b)| post(a, b)))
        .with_all(wood, [-1.0, 1.0].map(|s| side_rail(s, h - 0.04)))
        .with_all(wood, [-1.0, 1.0].map(|s| side_rail(s, base - 0.055)))
        .with_all(wood, [-1.0, 1.0].map(end))
        .with_all(wood, bars(-1.0).chain(bars(1.0)))
        .with_all(wood, [-1.0, 1.0].map(panel))
        .with(
            wood,
            block(
                [-x + 0.034, base - 0.05, -z + 0.03],
                [x - 0.034, base - 0.035, z - 0.03],
            ),
        )
        .with_filled(
            &sheet,
            rounded_block(
                [-x + 0.045, base - 0.035, -z + 0.04],
                [x - 0.045, base + 0.065, z - 0.04],
                0.03,
                2,
            ),
            foam(&sheet),
        );
    Model::fixed("cot", "baby_bed").part(body).top(
        "mattress",
        [-x + 0.06, base + 0.065, -z + 0.06],
        [x - 0.06, h, z - 0.06],
    )
}

/// Two beds, one above the other, with a ladder at the front of the foot end. The heads are at -Z, the open side is +X.
pub fn bunk_bed(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bunk_bed", key);
    let (w, h, length) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * length);
    let wood = style.any_wood(&mut d.stream("wood"));
    let sheet = cloth("white_linen", [238, 236, 230]);
    let cover = style.cloth(&mut d.stream("cover"));
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
            .with_filled(
                &sheet,
                rounded_block(
                    [-x + 0.04, base, -z + 0.04],
                    [x - 0.04, top, z - 0.04],
                    0.04,
                    2,
                ),
                foam(&sheet),
            )
            .with_filled(
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
        .top(
            "lower_pillow_end",
            [-x + 0.08, lower + 0.14, -z + 0.08],
            [x - 0.08, lower + 0.5, -z + 0.52],
        )
        .top(
            "lower_bed",
            [-x + 0.08, lower + 0.165, -z + 0.58],
            [x - 0.08, upper - 0.12, z - 0.1],
        )
        .top(
            "upper_pillow_end",
            [-x + 0.08, upper + 0.14, -z + 0.08],
            [x - 0.08, h, -z + 0.52],
        )
}

/// A mattress without a bed.
pub fn mattress(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("mattress", key);
    let (w, h, length) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * length);
    let cover = cloth(
        "mattress_ticking",
        d.of("cover", [[238, 236, 230], [226, 230, 234], [232, 224, 208]]),
    );
    let band = cloth(
        "mattress_border",
        d.of("band", [[150, 158, 166], [190, 176, 150], [120, 130, 140]]),
    );
    let body = PartBuilder::new("body")
        .with_filled(
            &cover,
            rounded_block([-x, 0.0, -z], [x, 0.35 * h, z], 0.03, 2),
            foam(&cover),
        )
        .with_filled(
            &band,
            block(
                [-x + 0.004, 0.35 * h, -z + 0.004],
                [x - 0.004, 0.65 * h, z - 0.004],
            ),
            foam(&band),
        )
        .with_filled(
            &cover,
            rounded_block([-x, 0.65 * h, -z], [x, h, z], 0.03, 2),
            foam(&cover),
        );
    Model::movable("mattress", "mattress").part(body).top(
        "top",
        [-x + 0.05, h, -z + 0.05],
        [x - 0.05, h + 0.5, z - 0.05],
    )
}
