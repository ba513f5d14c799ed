//! What furnishes walls and divides rooms: fireplace, screen, blind, wall lamp, chandelier, kitchen rail.

use crate::finishes::{Finish, brass, lampshade, milk_glass, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cone, cylinder, rod, rounded_block, surface_of_revolution, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::{FRAC_PI_2, TAU};

/// A fireplace on the wall with logs that glow when it burns; its back is at -Z.
pub fn fireplace(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("fireplace", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let stone = match d.below("stone", 3) {
        0 => crate::finishes::marble(),
        1 => Finish::tiled(
            "fire_brick",
            "brick",
            "brick",
            [[158, 84, 62], [190, 180, 168], [112, 56, 46]],
            0.5,
        ),
        _ => Finish::plain("white_surround", "plaster", [236, 232, 224]),
    };
    let soot = Finish::plain("soot", "brick", [38, 34, 32]);
    let bark = Finish::plain("logs", "wood", [84, 58, 40]);
    let ember = Finish::plain("embers", "wood", [214, 86, 30]).glowing([0.5, 0.14, 0.03]);
    let (leg, beam, deck) = (0.2 * w, 0.24, h - 0.05);
    let (inner, top) = (x - leg, deck - beam);
    let hearth = 0.06;
    let face = z - 0.04;
    let body = PartBuilder::new("body")
        .with_filled(
            &stone,
            block([-x + 0.04, hearth, -z], [-inner, deck, face]),
            0.55,
        )
        .with_filled(
            &stone,
            block([inner, hearth, -z], [x - 0.04, deck, face]),
            0.55,
        )
        .with_filled(&stone, block([-inner, top, -z], [inner, deck, face]), 0.55)
        .with(&stone, rounded_block([-x, deck, -z], [x, h, z], 0.01, 1))
        .with_filled(
            &stone,
            block([-x + 0.02, 0.0, -z], [x - 0.02, hearth, z]),
            0.8,
        )
        .with(&soot, block([-inner, hearth, -z], [inner, top, -z + 0.04]))
        .with(
            &soot,
            block(
                [-inner, hearth, -z + 0.04],
                [-inner + 0.02, top, face - 0.03],
            ),
        )
        .with(
            &soot,
            block([inner - 0.02, hearth, -z + 0.04], [inner, top, face - 0.03]),
        );
    let log = |a: f32, y: f32, b: f32, spin: f32, long: f32| {
        rod([-0.5 * long, 0.0, 0.0], [0.5 * long, 0.0, 0.0], 0.045)
            .about_y(spin)
            .at(a, y, b)
    };
    let long = (1.2 * inner).min(0.5);
    let body = body
        .with(&bark, log(0.0, hearth + 0.045, -0.3 * z, 0.1, long))
        .with(&bark, log(0.0, hearth + 0.045, 0.25 * z, -0.12, long))
        .with(&bark, log(0.02, hearth + 0.13, 0.0, 0.5, 0.8 * long))
        .with(
            &ember,
            block(
                [-0.3 * long, hearth, -0.2 * z],
                [0.3 * long, hearth + 0.02, 0.15 * z],
            )
            .visual_only(),
        );
    Model::fixed("fireplace", "fireplace")
        .switched(false)
        .part(body)
        .with_light([0.0, hearth + 0.3, 0.1 * z], 20.0)
        .with_sound([0.0, hearth + 0.1, 0.0], "noise", 40.0)
        .top(
            "mantelpiece",
            [-x + 0.03, h, -z + 0.01],
            [x - 0.03, h + 0.5, z - 0.01],
        )
}

/// A screen of three leaves that stands in a zigzag.
pub fn room_divider(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("room_divider", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let wood = style.any_wood(&mut d.stream("wood"));
    let cloth = if d.chance("paper", 0.4) {
        crate::finishes::paper("rice_paper", [240, 234, 218])
    } else {
        style.cloth(&mut d.stream("cloth")).clone()
    };
    let t = 0.022;
    let run = (w - t) / 3.0;
    let rise = depth - t;
    let leaf_m = (run * run + rise * rise).sqrt();
    let angle = dwell_scene::math::atan2(rise, run);
    let mut body = PartBuilder::new("body");
    for k in 0..3 {
        let spin = if k % 2 == 0 { angle } else { -angle };
        let middle = -0.5 * w + 0.5 * t + run * (k as f32 + 0.5);
        let half = 0.5 * leaf_m - 0.5 * t * 0.6;
        let place = |solid: crate::shapes::SolidMesh| solid.about_y(spin).at(middle, 0.0, 0.0);
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

/// A blind before a window, half let down: slats or a roll of cloth. y = 0 is its upper edge, z = 0 the wall.
pub fn blind(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("blind", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let x = 0.5 * w;
    let white = plastic("blind_white", [238, 238, 234]);
    let mut body =
        PartBuilder::new("body").with_filled(&white, block([-x, -0.05, 0.0], [x, 0.0, 0.06]), 0.3);
    if d.chance("slats", 0.5) {
        let slat = if d.chance("wood", 0.4) {
            style.wood.clone()
        } else {
            Finish {
                substance: "aluminium",
                ..white.clone()
            }
        };
        let count = ((h - 0.08) / 0.045) as usize;
        for k in 0..count {
            let y = -0.075 - 0.045 * k as f32;
            let one = block([-x + 0.01, -0.0015, -0.022], [x - 0.01, 0.0015, 0.022])
                .about_x(0.5)
                .at(0.0, y, 0.03);
            body = body.with(&slat, one.visual_only());
        }
        for a in [-0.7 * x, 0.7 * x] {
            body = body.with(
                &white,
                rod([a, -h + 0.02, 0.03], [a, -0.05, 0.03], 0.001).visual_only(),
            );
        }
        // The slats are felt as one board.
        let board = block([-x + 0.01, -h + 0.02, 0.014], [x - 0.01, -0.05, 0.046]).collision_only();
        body = body.with(&slat, board).with(
            &white,
            block([-x + 0.01, -h, 0.012], [x - 0.01, -h + 0.02, 0.048]),
        );
    } else {
        let cloth = style.cloth(&mut d.stream("cloth"));
        body = body
            .with(
                cloth,
                block([-x + 0.015, -h + 0.02, 0.028], [x - 0.015, -0.05, 0.031]),
            )
            .with(
                &white,
                block([-x + 0.01, -h, 0.02], [x - 0.01, -h + 0.02, 0.04]),
            );
    }
    Model::fixed("blind", "blinds").part(body)
}

/// A lamp on the wall: a cylinder that shines up and down, a shade on an arm, or a globe. y = 0 is its plate's middle.
pub fn wall_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_lamp", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (r, z) = (0.5 * w, depth - 0.5 * w);
    let plate = cylinder(0.045, 0.015, 20).about_x(FRAC_PI_2);
    let arm = rod([0.0, 0.0, 0.015], [0.0, 0.0, z], 0.008);
    let body = PartBuilder::new("body")
        .with(&style.metal, plate)
        .with(&style.metal, arm);
    let body = match d.below("build", 3) {
        0 => body
            .with_filled(
                &style.metal,
                cylinder(r, h - 0.01, 20).at(0.0, -0.5 * h, z),
                0.05,
            )
            .with(
                &milk_glass(),
                cylinder(0.9 * r, 0.01, 20).at(0.0, 0.5 * h - 0.01, z),
            ),
        1 => {
            let shade = lampshade("lampshade", style.cloths[0].srgb);
            body.with_filled(&shade, cone(r, 0.7 * r, h, 24).at(0.0, -0.3 * h, z), 0.02)
        }
        _ => {
            let fit = 0.5 * h.min(w);
            body.with_filled(
                &milk_glass(),
                crate::shapes::ball(fit, 18).at(0.0, 0.5 * h - fit, z),
                0.1,
            )
        }
    };
    Model::fixed("wall_lamp", "wall_lamp")
        .switched(true)
        .part(body)
        .with_light([0.0, 0.5 * h + 0.04, z], 6.0)
}

/// A chandelier: arms with candles or bulbs around a stem, under the ceiling.
pub fn chandelier(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("chandelier", key);
    let (w, h) = (d.m("span"), d.m("height"));
    let metal = if d.chance("brass", 0.4) {
        brass()
    } else {
        style.metal.clone()
    };
    let count = d.of("arms", [5, 6, 8]);
    let (r, low) = (0.5 * w - 0.03, -h);
    let mut body = PartBuilder::new("body")
        .with_filled(&metal, cylinder(0.06, 0.03, 20).at(0.0, -0.03, 0.0), 0.4)
        .with(
            &metal,
            rod([0.0, low + 0.18, 0.0], [0.0, -0.03, 0.0], 0.007),
        )
        .with_filled(
            &metal,
            surface_of_revolution(
                &[
                    (0.0, low),
                    (0.03, low + 0.02),
                    (0.05, low + 0.07),
                    (0.02, low + 0.16),
                    (0.0, low + 0.18),
                ],
                18,
            ),
            0.5,
        );
    for k in 0..count {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / count as f32);
        let at = |out: f32, y: f32| [out * sin, low + y, out * cos];
        body = body
            .with_filled(
                &metal,
                tube(
                    &[
                        at(0.03, 0.08),
                        at(0.5 * r, 0.01),
                        at(0.85 * r, 0.03),
                        at(r, 0.1),
                    ],
                    0.006,
                    6,
                ),
                0.6,
            )
            .with(
                &metal,
                cylinder(0.028, 0.008, 12).at(r * sin, low + 0.1, r * cos),
            )
            .with(
                &plastic("candle_sleeve", [240, 234, 216]),
                cylinder(0.012, 0.07, 10).at(r * sin, low + 0.108, r * cos),
            )
            .with(
                &milk_glass(),
                surface_of_revolution(
                    &[(0.0, 0.0), (0.012, 0.008), (0.014, 0.02), (0.0, 0.05)],
                    10,
                )
                .at(r * sin, low + 0.178, r * cos)
                .visual_only(),
            );
    }
    Model::fixed("chandelier", "chandelier")
        .switched(true)
        .part(body)
        .with_light([0.0, low - 0.05, 0.0], 24.0)
}
