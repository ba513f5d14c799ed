//! Seats, tables to work at, shelves, lamps, plants.

use super::shade;
use crate::finishes::{Finish, black};
use crate::model::Model;
use crate::models::bookshelf::Bookshelf;
use crate::models::desk::Desk;
use crate::models::dresser::Dresser;
use crate::models::plants::{Plant, deep_green, fresh_green};
use crate::models::sofa::{ArmStyle, Sofa};
use crate::models::table::Table;
use crate::models::tv_stand::Lowboard;
use crate::models::{lamps, plants, radio, seats, television, textiles};
use crate::sampling::SizeSampler;
use crate::style::{LegStyle, Style};
use dwell_scene::random::RandomKey;

/// Builds and proportions that seats of one family share.
fn seat(style: &Style, d: &SizeSampler, cover: Finish) -> Sofa {
    let arm = match style.leg {
        LegStyle::Turned => d.of("arm", [ArmStyle::Rolled, ArmStyle::Rolled, ArmStyle::Block]),
        LegStyle::Metal => ArmStyle::Block,
        LegStyle::Tapered | LegStyle::Square => {
            d.of("arm", [ArmStyle::Block, ArmStyle::Block, ArmStyle::Wood])
        }
    };
    Sofa {
        arm,
        arm_m: match arm {
            ArmStyle::Block => d.range("arm_m", 0.09, 0.2),
            ArmStyle::Rolled => d.range("arm_m", 0.14, 0.19),
            ArmStyle::Wood => 0.06,
        },
        arm_top_m: d.range("arm_top", 0.54, 0.65),
        leg_m: d.range("leg", 0.07, 0.18),
        depth_m: d.m("depth"),
        back_m: d.m("height"),
        wood: style.wood.clone(),
        ..Sofa::armchair(cover)
    }
}

pub(crate) fn sofa(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sofa", key);
    let family = seat(style, &d, style.cover(&mut d.stream("cover")).clone());
    let width = d.m("width") - 2.0 * family.arm_m;
    let seats = ((width / 0.64).round() as usize).clamp(2, 3);
    Sofa {
        seats,
        seat_width_m: width / seats as f32,
        ..family
    }
    .build()
}

pub(crate) fn armchair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("armchair", key);
    let family = seat(style, &d, style.cover(&mut d.stream("cover")).clone());
    Sofa {
        seat_width_m: d.m("width") - 2.0 * family.arm_m,
        ..family
    }
    .build()
}

pub(crate) fn office_chair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("office_chair", key);
    seats::office_chair(style.cover(&mut d.stream("cover"))).resized(d.m("height") / 1.08)
}

pub(crate) fn stool(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("stool", key);
    let wood = style.any_wood(&mut d.stream("wood"));
    seats::stool(d.m("height"), wood, style.leg_finish())
}

pub(crate) fn ottoman(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ottoman", key);
    let cover = style.cover(&mut d.stream("cover"));
    seats::pouf(0.5 * d.m("width"), d.m("height"), cover)
}

pub(crate) fn shoe_bench(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shoe_bench", key);
    let (wood, cloth) = (
        style.any_wood(&mut d.stream("wood")),
        style.cloth(&mut d.stream("cloth")),
    );
    seats::shoe_bench(d.m("width"), wood, cloth)
}

pub(crate) fn desk(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("desk", key);
    let wood = style.any_wood(&mut d.stream("wood")).clone();
    if d.chance("plain", 0.3) {
        return Table {
            name: "writing_table",
            category: "desk",
            size_m: [d.m("width"), d.m("depth")],
            height_m: d.m("height"),
            top: wood,
            legs: style.leg_finish().clone(),
            leg_m: 0.055,
            ..Table::default()
        }
        .build();
    }
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

pub(crate) fn bookshelf(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bookshelf", key);
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

pub(crate) fn dresser(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dresser", key);
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

fn lowboard(style: &Style, d: &SizeSampler, name: &'static str, category: &'static str) -> Model {
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

pub(crate) fn tv_stand(style: &Style, key: RandomKey) -> Model {
    lowboard(
        style,
        &SizeSampler::new("tv_stand", key),
        "tv_stand",
        "tv_stand",
    )
}

pub(crate) fn sideboard(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sideboard", key);
    lowboard(style, &d, "sideboard", "wardrobe_cabinet")
}

pub(crate) fn television(_style: &Style, key: RandomKey) -> Model {
    television::television(SizeSampler::new("television", key).m("width"))
}

pub(crate) fn loudspeaker(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("loudspeaker", key);
    let case = style.any_wood(&mut d.stream("wood"));
    let plain = Finish::plain("speaker_case", "wood", case.srgb);
    let case = if case.pattern.is_some() {
        case.clone()
    } else {
        plain
    };
    let height = d.m("height");
    radio::loudspeaker(height)
        .switched(false)
        .with_sound([0.0, 0.66 * height, 0.14], "radio", 70.0)
        .repainted("walnut", &case)
}

pub(crate) fn floor_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("floor_lamp", key);
    let cloth = shade(style, &d);
    if d.chance("tripod", 0.35) {
        let legs = style.any_wood(&mut d.stream("legs"));
        return lamps::tripod_lamp(d.m("height"), legs, &cloth);
    }
    let foot = Finish {
        name: "lamp_foot",
        ..style.metal.clone()
    };
    lamps::floor_lamp(d.m("height"), &cloth).repainted("black_plastic", &foot)
}

pub(crate) fn table_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("table_lamp", key);
    let base = style.glaze(&mut d.stream("base"));
    lamps::table_lamp(d.m("height"), base, &shade(style, &d))
}

pub(crate) fn desk_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("desk_lamp", key);
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

pub(crate) fn plant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("plant", key);
    let height = d.m("height");
    let pot = style.glaze(&mut d.stream("pot")).clone();
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

pub(crate) fn snake_plant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("snake_plant", key);
    plants::sansevieria(d.m("height"), style.glaze(&mut d.stream("pot")))
}

pub(crate) fn small_plant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("small_plant", key);
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

pub(crate) fn rug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("rug", key);
    let [a, b] = ["ground", "border"].map(|tone| style.cloth(&mut d.stream(tone)).srgb);
    let pattern = d.stream("pattern").bits();
    let recipe = d.of("recipe", ["rug", "rug", "stripes", "checks"]);
    let weave = Finish::picture(
        "woven_rug",
        "carpet",
        recipe,
        [a, b, [232, 222, 200]],
        pattern,
    );
    textiles::rug(d.m("width"), d.m("depth"), &weave)
}

pub(crate) fn round_rug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("round_rug", key);
    textiles::round_rug(0.5 * d.m("width"), style.terry(&mut d.stream("pile")))
}

pub(crate) fn coat_rack(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("coat_rack", key);
    let tones = [
        [60, 66, 90],
        [120, 84, 60],
        [70, 84, 70],
        [44, 44, 48],
        [150, 60, 60],
    ];
    let coat = crate::finishes::cloth("coat", d.of("coat", tones));
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
