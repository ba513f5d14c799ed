//! Tables of other builds, the dressing table, the home bar.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, drawer, drawer_space};
use super::table::Table;
use crate::finishes::{Finish, brass, glass, mirror};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, frame, rod, rounded_block, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, TAU};

/// A dining table: on four legs, on a column, or on trestles.
pub fn dining_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dining_table", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let wood = style.any_wood(&mut d.stream("wood")).clone();
    match d.below("build", 4) {
        0 => column_table(
            "round_dining_table",
            "dining_table",
            SizeSampler::new("round_dining_table", key).m("width"),
            h,
            style,
            &wood,
        ),
        1 => trestle_table(w, h, depth, style, &wood),
        _ => Table {
            size_m: [w, depth],
            height_m: h,
            leg_m: d.range("leg", 0.05, 0.08),
            top: wood,
            legs: style.leg_finish().clone(),
            ..Table::default()
        }
        .build(),
    }
}

/// A round top on one column with a foot.
fn column_table(
    name: &'static str,
    category: &'static str,
    width_m: f32,
    height_m: f32,
    style: &Style,
    wood: &Finish,
) -> Model {
    let (r, h) = (0.5 * width_m, height_m);
    let foot = [
        (0.0, 0.0),
        (0.62 * r, 0.0),
        (0.62 * r, 0.02),
        (0.16 * r, 0.06),
        (0.09 * r, 0.4 * h),
        (0.16 * r, h - 0.03),
        (0.0, h - 0.03),
    ];
    let body = PartBuilder::new("body")
        .with_bar(style.leg_finish(), surface_of_revolution(&foot, 24))
        .with(wood, cylinder(r, 0.03, 36).at(0.0, h - 0.03, 0.0));
    let half = 0.68 * r;
    Model::movable(name, category)
        .part(body)
        .top("top", [-half, h, -half], [half, h + 0.6, half])
}

fn trestle_table(w: f32, h: f32, depth: f32, style: &Style, wood: &Finish) -> Model {
    let (x, z, under) = (0.5 * w, 0.5 * depth, h - 0.04);
    let legs = style.leg_finish();
    let mut body =
        PartBuilder::new("body").with(wood, rounded_block([-x, under, -z], [x, h, z], 0.01, 1));
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.28);
        body = body
            .with_bar(
                legs,
                block([a - 0.04, 0.0, -z + 0.08], [a + 0.04, 0.05, z - 0.08]),
            )
            .with_bar(
                legs,
                block([a - 0.035, 0.05, -0.08], [a + 0.035, under - 0.04, 0.08]),
            )
            .with_bar(
                legs,
                block(
                    [a - 0.04, under - 0.04, -z + 0.1],
                    [a + 0.04, under, z - 0.1],
                ),
            );
    }
    body = body.with_bar(
        legs,
        block([-x + 0.315, 0.3, -0.02], [x - 0.315, 0.38, 0.02]),
    );
    Model::movable("dining_table", "dining_table")
        .part(body)
        .top("top", [-x, h, -z], [x, h + 0.6, z])
}

/// A low table before a sofa: with a shelf, round, or of glass on a frame of metal.
pub fn coffee_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("coffee_table", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let wood = style.any_wood(&mut d.stream("wood")).clone();
    match d.below("build", 3) {
        0 => Table {
            size_m: [w, depth],
            height_m: h,
            legs: style.leg_finish().clone(),
            shelf_m: Some(0.14),
            leg_m: 0.05,
            ..Table::coffee(wood)
        }
        .build(),
        1 => drum_table(
            SizeSampler::new("round_coffee_table", key).m("width"),
            h,
            style,
            &wood,
        ),
        _ => glass_table(w, h, depth, style),
    }
}

/// A round top on four splayed legs.
fn drum_table(width_m: f32, height_m: f32, style: &Style, wood: &Finish) -> Model {
    let (r, under) = (0.5 * width_m, height_m - 0.03);
    let mut body = PartBuilder::new("body").with(wood, cylinder(r, 0.03, 36).at(0.0, under, 0.0));
    for k in 0..4 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * (k as f32 + 0.5) / 4.0);
        let leg = crate::shapes::tapered_leg(
            [0.82 * r * sin, 0.0, 0.82 * r * cos],
            [0.62 * r * sin, under, 0.62 * r * cos],
            0.026,
            0.042,
        );
        body = body.with(style.leg_finish(), leg);
    }
    let half = 0.68 * r;
    Model::movable("round_coffee_table", "coffee_table")
        .part(body)
        .top(
            "top",
            [-half, height_m, -half],
            [half, height_m + 0.6, half],
        )
}

fn glass_table(w: f32, h: f32, depth: f32, style: &Style) -> Model {
    let (x, z, t) = (0.5 * w, 0.5 * depth, 0.014);
    let top = h - 0.01;
    let mut body = PartBuilder::new("body").with(&glass(), block([-x, top, -z], [x, h, z]));
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (x - 0.04), sz * (z - 0.04));
        body = body.with_filled(
            &style.metal,
            block([a - t, 0.0, b - t], [a + t, top, b + t]),
            0.3,
        );
    }
    for y in [0.02, top - 2.0 * t] {
        for side in [-1.0_f32, 1.0] {
            let (a, b) = (side * (x - 0.04), side * (z - 0.04));
            body = body
                .with_filled(
                    &style.metal,
                    block(
                        [-x + 0.04 + t, y, b - t],
                        [x - 0.04 - t, y + 2.0 * t, b + t],
                    ),
                    0.3,
                )
                .with_filled(
                    &style.metal,
                    block(
                        [a - t, y, -z + 0.04 + t],
                        [a + t, y + 2.0 * t, z - 0.04 - t],
                    ),
                    0.3,
                );
        }
    }
    Model::movable("coffee_table", "coffee_table")
        .part(body)
        .top("top", [-x, h, -z], [x, h + 0.6, z])
}

/// A small table beside a sofa or a chair.
pub fn side_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("side_table", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let wood = style.any_wood(&mut d.stream("wood")).clone();
    match d.below("build", 3) {
        0 => super::table::side_table(0.5 * w, h, &wood),
        1 => column_table("side_table", "table", w, h, style, &wood),
        _ => Table {
            name: "side_table",
            category: "table",
            size_m: [w, w],
            height_m: h,
            top_m: 0.022,
            leg_m: 0.034,
            top: wood,
            legs: style.leg_finish().clone(),
            shelf_m: d.chance("shelf", 0.4).then_some(0.16),
        }
        .build(),
    }
}

/// A narrow table for a hall or behind a sofa.
pub fn console_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("console_table", key);
    Table {
        name: "console_table",
        category: "table",
        size_m: [d.m("width"), d.m("depth")],
        height_m: d.m("height"),
        top_m: 0.026,
        leg_m: 0.04,
        top: style.any_wood(&mut d.stream("wood")).clone(),
        legs: style.leg_finish().clone(),
        shelf_m: d.chance("shelf", 0.5).then_some(0.18),
    }
    .build()
}

/// A table with a mirror and two drawers, to make oneself up at.
pub fn dressing_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dressing_table", key);
    let (w, h, depth, table) = (d.m("width"), d.m("height"), d.m("depth"), d.m("table"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let wood = style.any_wood(&mut d.stream("wood"));
    let carcass = Carcass {
        min: [-x + 0.005, table - 0.15, -z + 0.005],
        max: [x - 0.005, table - 0.02, z - BOARD_M],
    };
    let face = carcass.max[2];
    let mut body = PartBuilder::new("body")
        .with(
            wood,
            rounded_block([-x, table - 0.02, -z], [x, table, z], 0.006, 1),
        )
        .with_all(wood, carcass.boards(&[], &[0.5]))
        .with_bars(
            style.leg_finish(),
            style.legs([x - 0.04, z - 0.05], table - 0.15, 0.045),
        );
    let round = d.chance("round", 0.4);
    let tall = h - table;
    if round {
        let r = 0.5 * tall - 0.03;
        let disc = |radius: f32, from: f32, deep: f32| {
            cylinder(radius, deep, 32).about_x(FRAC_PI_2).at(
                0.0,
                table + 0.03 + 0.5 * tall - 0.015,
                from,
            )
        };
        body = body
            .with(wood, disc(r + 0.015, -z + 0.02, 0.02))
            .with(&mirror(), disc(r, -z + 0.04, 0.004))
            .with(
                wood,
                block([-0.06, table, -z + 0.01], [0.06, table + 0.05, -z + 0.02]),
            )
            .with(
                wood,
                block([-0.06, table, -z + 0.04], [0.06, table + 0.03, -z + 0.06]),
            );
    } else {
        let wide = (0.7 * w).min(0.8);
        body = body
            .with(
                wood,
                frame(wide, tall, 0.03, 0.02).at(0.0, table + 0.5 * tall, -z + 0.01),
            )
            .with(
                &mirror(),
                block(
                    [-0.5 * wide + 0.03, table + 0.03, -z + 0.014],
                    [0.5 * wide - 0.03, h - 0.03, -z + 0.026],
                ),
            );
    }
    let mut model = Model::articulated("dressing_table", "dressing_table")
        .part(body)
        .top("top", [-x, table, -z + 0.07], [x, table + 0.5, z]);
    let front = style.doors();
    for (name, a, b) in [
        ("left_drawer", -x + 0.007, -0.5 * GAP_M),
        ("right_drawer", 0.5 * GAP_M, x - 0.007),
    ] {
        let (low, high) = ([a, table - 0.148], [b, table - 0.024]);
        let (min, max) = drawer_space(low, high, face, depth - 0.1);
        model = model
            .part(drawer(name, low, high, face, depth - 0.1, &front))
            .sliding(name, Vec3::Z, 0.6 * (depth - 0.1))
            .inside(name, min, max);
    }
    model
}

/// A bar for the living room: a counter towards the guests (+Z) with a foot rail, shelves towards the host (-Z).
pub fn home_bar(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("home_bar", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let wood = style.any_wood(&mut d.stream("wood"));
    let (back, face, low) = (-z + 0.06, z - 0.16, 0.06);
    let (half, under) = (x - 0.02, h - 0.04);
    let shelves = [low, 0.5 * under, under - 0.3];
    let shelf = |y: f32| block([-half + 0.02, y, back], [half - 0.02, y + 0.02, face]);
    let panel = |k: usize| {
        let wide = 2.0 * half / 3.0;
        let from = -half + wide * k as f32;
        block(
            [from + 0.04, 0.14, face + 0.02],
            [from + wide - 0.04, under - 0.08, face + 0.032],
        )
    };
    let rail = |a: f32| rod([a, 0.18, face + 0.02], [a, 0.18, z - 0.02], 0.008);
    let body = PartBuilder::new("body")
        .with(wood, block([-half, 0.0, face], [half, under, face + 0.02]))
        .with(wood, block([-half, 0.0, back], [-half + 0.02, under, face]))
        .with(wood, block([half - 0.02, 0.0, back], [half, under, face]))
        .with_all(wood, shelves.map(shelf))
        .with_all(&style.front, (0..3).map(panel))
        .with_bar(
            &style.worktop,
            rounded_block([-x, under, -z], [x, h, z], 0.01, 1),
        )
        .with(
            &brass(),
            rod([-half, 0.18, z - 0.02], [half, 0.18, z - 0.02], 0.014),
        )
        .with_all(&brass(), [-half + 0.1, half - 0.1].map(rail));
    let inner = half - 0.03;
    let mut model = Model::fixed("home_bar", "drinkbar").part(body).top(
        "counter",
        [-x + 0.02, h, -z + 0.02],
        [x - 0.02, h + 0.5, z - 0.02],
    );
    let ceilings = [shelves[1], shelves[2], under];
    for (k, name) in ["lower_shelf", "middle_shelf", "upper_shelf"]
        .into_iter()
        .enumerate()
    {
        let (from, to) = (shelves[k] + 0.02, ceilings[k] - 0.01);
        model = model.top(name, [-inner, from, back + 0.01], [inner, to, face - 0.01]);
    }
    model
}
