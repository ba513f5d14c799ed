//! Beds and what stands in bedrooms.

use crate::model::Model;
use crate::models::bed::Bed;
use crate::models::nightstand::nightstand_with;
use crate::models::textiles;
use crate::models::wardrobe::Wardrobe;
use crate::sampling::SizeSampler;
use crate::style::{LegStyle, Style};
use dwell_scene::random::RandomKey;

fn bed(style: &Style, d: &SizeSampler) -> Model {
    let covered = d.chance("covered", 0.4);
    // Turned and heavy legs go with bars.
    let old = matches!(style.leg, LegStyle::Turned | LegStyle::Square);
    Bed {
        mattress_m: [d.m("width") - 0.14, d.m("depth") - 0.13],
        head_m: d.m("height"),
        wood: style.any_wood(&mut d.stream("wood")).clone(),
        barred: !covered && d.chance("barred", if old { 0.6 } else { 0.2 }),
        headboard: covered.then(|| style.cover(&mut d.stream("head")).clone()),
        blanket: style.cloth(&mut d.stream("blanket")).clone(),
        ..Bed::default()
    }
    .build()
}

pub(crate) fn double_bed(style: &Style, key: RandomKey) -> Model {
    bed(style, &SizeSampler::new("double_bed", key))
}

pub(crate) fn single_bed(style: &Style, key: RandomKey) -> Model {
    bed(style, &SizeSampler::new("single_bed", key))
}

pub(crate) fn nightstand(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("nightstand", key);
    let wood = style.any_wood(&mut d.stream("wood"));
    nightstand_with(d.m("width"), d.m("height"), wood, &style.doors())
}

pub(crate) fn wardrobe(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wardrobe", key);
    let width = d.m("width");
    Wardrobe {
        width_m: width,
        height_m: d.m("height"),
        depth_m: d.m("depth"),
        doors: ((width / 0.48).round() as usize).clamp(2, 4),
        body: style.any_wood(&mut d.stream("wood")).clone(),
        front: style.doors(),
    }
    .build()
}

pub(crate) fn pillow(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pillow", key);
    textiles::pillow(
        [d.m("width"), d.m("height"), d.m("depth")],
        &style.cloths[0],
    )
}

pub(crate) fn cushion(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cushion", key);
    let edge = d.m("width");
    textiles::pillow(
        [edge, d.m("height"), edge],
        style.cloth(&mut d.stream("cloth")),
    )
}

pub(crate) fn folded_blanket(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("folded_blanket", key);
    textiles::folded_blanket(
        d.m("width"),
        d.m("depth"),
        style.cloth(&mut d.stream("cloth")),
    )
}
