//! Seats, tables to work at, shelves, lamps, plants.

use super::shade;
use crate::furniture::draw::Draw;
use crate::furniture::finish::{Finish, black};
use crate::furniture::model::Model;
use crate::furniture::models::bookshelf::Bookshelf;
use crate::furniture::models::desk::Desk;
use crate::furniture::models::dresser::Dresser;
use crate::furniture::models::plants::{Plant, deep_green, fresh_green};
use crate::furniture::models::sofa::Sofa;
use crate::furniture::models::tv_stand::Lowboard;
use crate::furniture::models::{lamps, plants, radio, seats, television, textiles};
use crate::furniture::style::Style;
use dwell_scene::random::Key;

pub(in crate::furniture) fn sofa(style: &Style, key: Key) -> Model {
    let d = Draw::new("sofa", key);
    let width = d.m("width");
    // Seats of 0.55 to 0.77 m between two arms.
    let seats = (((width - 0.3) / 0.62).round() as usize).clamp(2, 3);
    Sofa {
        seats,
        seat_width_m: (width - 0.3) / seats as f32,
        depth_m: d.m("depth"),
        back_m: d.m("height"),
        cover: style.cover(&mut d.stream("cover")).clone(),
        wood: style.wood.clone(),
    }
    .build()
}

pub(in crate::furniture) fn armchair(style: &Style, key: Key) -> Model {
    let d = Draw::new("armchair", key);
    Sofa {
        seat_width_m: d.m("width") - 0.3,
        depth_m: d.m("depth"),
        back_m: d.m("height"),
        wood: style.wood.clone(),
        ..Sofa::armchair(style.cover(&mut d.stream("cover")).clone())
    }
    .build()
}

pub(in crate::furniture) fn office_chair(style: &Style, key: Key) -> Model {
    let d = Draw::new("office_chair", key);
    seats::office_chair(style.cover(&mut d.stream("cover"))).resized(d.m("height") / 1.08)
}

pub(in crate::furniture) fn stool(style: &Style, key: Key) -> Model {
    let d = Draw::new("stool", key);
    let wood = style.any_wood(&mut d.stream("wood"));
    seats::stool(d.m("height"), wood, style.leg_finish())
}

pub(in crate::furniture) fn ottoman(style: &Style, key: Key) -> Model {
    let d = Draw::new("ottoman", key);
    let cover = style.cover(&mut d.stream("cover"));
    seats::pouf(0.5 * d.m("width"), d.m("height"), cover)
}

pub(in crate::furniture) fn shoe_bench(style: &Style, key: Key) -> Model {
    let d = Draw::new("shoe_bench", key);
    let (wood, cloth) = (
        style.any_wood(&mut d.stream("wood")),
        style.cloth(&mut d.stream("cloth")),
    );
    seats::shoe_bench(d.m("width"), wood, cloth)
}

pub(in crate::furniture) fn desk(style: &Style, key: Key) -> Model {
    let d = Draw::new("desk", key);
    let wood = style.any_wood(&mut d.stream("wood")).clone();
    let same = d.chance("one_wood", 0.5);
    Desk {
        width_m: d.m("width"),
        depth_m: d.m("depth"),
        height_m: d.m("height"),
        body: if same {
            wood.clone()
        } else {
            style.front.clone()
        },
        top: wood,
        front: style.doors(),
    }
    .build()
}

pub(in crate::furniture) fn bookshelf(style: &Style, key: Key) -> Model {
    let d = Draw::new("bookshelf", key);
    let height = d.m("height");
    Bookshelf {
        width_m: d.m("width"),
        height_m: height,
        depth_m: d.m("depth"),
        levels: ((height / 0.36).round() as usize).clamp(2, 6),
        wood: style.any_wood(&mut d.stream("wood")).clone(),
    }
    .build()
}

pub(in crate::furniture) fn dresser(style: &Style, key: Key) -> Model {
    let d = Draw::new("dresser", key);
    let height = d.m("height");
    Dresser {
        width_m: d.m("width"),
        height_m: height,
        depth_m: d.m("depth"),
        rows: ((height / 0.26) as usize).clamp(2, 4),
        wood: style.any_wood(&mut d.stream("wood")).clone(),
        front: style.doors(),
    }
    .build()
}

fn lowboard(style: &Style, d: &Draw, name: &'static str, category: &'static str) -> Model {
    Lowboard {
        name,
        category,
        width_m: d.m("width"),
        height_m: d.m("height"),
        depth_m: d.m("depth"),
        wood: style.any_wood(&mut d.stream("wood")).clone(),
        front: style.doors(),
    }
    .build()
}

pub(in crate::furniture) fn tv_stand(style: &Style, key: Key) -> Model {
    lowboard(style, &Draw::new("tv_stand", key), "tv_stand", "tv_stand")
}

pub(in crate::furniture) fn sideboard(style: &Style, key: Key) -> Model {
    let d = Draw::new("sideboard", key);
    lowboard(style, &d, "sideboard", "wardrobe_cabinet")
}

pub(in crate::furniture) fn television(_style: &Style, key: Key) -> Model {
    television::television(Draw::new("television", key).m("width"))
}

pub(in crate::furniture) fn loudspeaker(style: &Style, key: Key) -> Model {
    let d = Draw::new("loudspeaker", key);
    let case = style.any_wood(&mut d.stream("wood"));
    let plain = Finish::plain("speaker_case", "wood", case.srgb);
    let case = if case.pattern.is_some() {
        case.clone()
    } else {
        plain
    };
    radio::loudspeaker(d.m("height")).repainted("walnut", &case)
}

pub(in crate::furniture) fn floor_lamp(style: &Style, key: Key) -> Model {
    let d = Draw::new("floor_lamp", key);
    let foot = Finish {
        name: "lamp_foot",
        ..style.metal.clone()
    };
    lamps::floor_lamp(d.m("height"), &shade(style, &d)).repainted("black_plastic", &foot)
}

pub(in crate::furniture) fn table_lamp(style: &Style, key: Key) -> Model {
    let d = Draw::new("table_lamp", key);
    let base = style.glaze(&mut d.stream("base"));
    lamps::table_lamp(d.m("height"), base, &shade(style, &d))
}

pub(in crate::furniture) fn desk_lamp(style: &Style, key: Key) -> Model {
    let d = Draw::new("desk_lamp", key);
    let accent = Finish::plain(
        "lamp_lacquer",
        "steel",
        style.cloth(&mut d.stream("tone")).srgb,
    );
    let lacquer = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        accent
    };
    lamps::desk_lamp(&lacquer).resized(d.m("height") / 0.42)
}

pub(in crate::furniture) fn plant(style: &Style, key: Key) -> Model {
    let d = Draw::new("plant", key);
    let height = d.m("height");
    let pot = style.glaze(&mut d.stream("pot")).clone();
    if d.chance("sword", 0.25) {
        return plants::sansevieria(height.min(0.9), &pot);
    }
    Plant {
        height_m: height,
        pot_m: 0.5 * d.m("pot"),
        leaf_m: [0.26 * height, d.range("leaf", 0.09, 0.13) * height],
        leaves: 14 + d.below("leaves", 8),
        stem_m: d.range("stem", 0.2, 0.32) * height,
        pot,
        leaf: if d.chance("deep", 0.5) {
            deep_green()
        } else {
            fresh_green()
        },
        key: key.child("crown"),
    }
    .build()
}

pub(in crate::furniture) fn small_plant(style: &Style, key: Key) -> Model {
    let d = Draw::new("small_plant", key);
    let height = d.m("height");
    Plant {
        height_m: height,
        pot_m: 0.5 * d.m("pot"),
        leaf_m: [0.42 * height, 0.17 * height],
        leaves: 9 + d.below("leaves", 5),
        stem_m: 0.08 * height,
        pot: style.glaze(&mut d.stream("pot")).clone(),
        leaf: if d.chance("deep", 0.5) {
            deep_green()
        } else {
            fresh_green()
        },
        key: key.child("crown"),
    }
    .build()
}

pub(in crate::furniture) fn rug(style: &Style, key: Key) -> Model {
    let d = Draw::new("rug", key);
    let [a, b] = ["ground", "border"].map(|tone| style.cloth(&mut d.stream(tone)).srgb);
    let pattern = d.stream("pattern").bits();
    let weave = Finish::picture(
        "woven_rug",
        "carpet",
        "rug",
        [a, b, [232, 222, 200]],
        pattern,
    );
    textiles::rug(d.m("width"), d.m("depth"), &weave)
}

pub(in crate::furniture) fn round_rug(style: &Style, key: Key) -> Model {
    let d = Draw::new("round_rug", key);
    textiles::round_rug(0.5 * d.m("width"), style.terry(&mut d.stream("pile")))
}

pub(in crate::furniture) fn coat_rack(style: &Style, key: Key) -> Model {
    let d = Draw::new("coat_rack", key);
    let tones = [
        [60, 66, 90],
        [120, 84, 60],
        [70, 84, 70],
        [44, 44, 48],
        [150, 60, 60],
    ];
    let coat = crate::furniture::finish::cloth("coat", d.of("coat", tones));
    let scarf = style.cloth(&mut d.stream("scarf"));
    textiles::coat_rack(d.m("width"), &coat, scarf)
        .repainted("oak", style.any_wood(&mut d.stream("wood")))
        .repainted(
            "black_plastic",
            if d.chance("metal", 0.5) {
                &style.metal
            } else {
                BLACK
            },
        )
}

/// Black hooks.
const BLACK: &Finish = &black();
