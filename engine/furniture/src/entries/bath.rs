//! Sanitary ware and small things of bathrooms.

use super::tapped;
use crate::finishes::{Finish, plastic, sanitary};
use crate::model::Model;
use crate::models::{bath, bath_things, toilet};
use crate::sampling::SizeSampler;
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

/// Sanitary ware is white, sometimes of a pale colour.
fn ware(d: &SizeSampler) -> Finish {
    let tones = [[236, 230, 214], [226, 232, 230], [230, 214, 206]];
    if d.chance("white", 0.75) {
        sanitary()
    } else {
        Finish {
            name: "pale_porcelain",
            srgb: d.of("tone", tones),
            ..sanitary()
        }
    }
}

pub(crate) fn bathtub(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bathtub", key);
    let (length, left) = (d.m("width"), d.chance("left", 0.5));
    let tub = bath::bathtub(length, d.m("depth"), left).repainted("white_porcelain", &ware(&d));
    let side = if left { -1.0 } else { 1.0 };
    let at = [side * (0.5 * length - 0.045), bath::TUB_RIM_M, 0.0];
    tapped(tub, style, &d, [0.16, 0.14], at, -side * FRAC_PI_2)
}

fn vanity(style: &Style, d: &SizeSampler) -> Model {
    let basin = bath::washbasin_with(d.m("width"), &style.doors());
    let basin = basin.repainted("white_porcelain", &ware(d));
    let sizes = [d.range("tap", 0.13, 0.2), 0.13];
    tapped(basin, style, d, sizes, [0.0, bath::BASIN_RIM_M, -0.17], 0.0)
}

pub(crate) fn washbasin(style: &Style, key: RandomKey) -> Model {
    vanity(style, &SizeSampler::new("washbasin", key))
}

pub(crate) fn hand_basin(style: &Style, key: RandomKey) -> Model {
    vanity(style, &SizeSampler::new("hand_basin", key))
}

pub(crate) fn water_closet(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toilet", key);
    let seat = Finish {
        name: "toilet_seat",
        substance: "plastic",
        ..style.wood.clone()
    };
    let size = d.m("height") / 0.79;
    let closet = toilet::toilet()
        .resized(size)
        .repainted("white_porcelain", &ware(&d));
    if d.chance("wooden", 0.2) && seat.pattern.is_none() {
        closet.repainted("white_plastic", &seat)
    } else {
        closet
    }
}

pub(crate) fn shower_head(_style: &Style, key: RandomKey) -> Model {
    bath::shower_head().resized(SizeSampler::new("shower_head", key).m("height") / 1.33)
}

pub(crate) fn shower_screen(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shower_screen", key);
    bath::shower_screen(d.m("depth"), d.m("height"))
}

pub(crate) fn bath_mat(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bath_mat", key);
    bath_things::bath_mat(d.m("width"), d.m("depth"))
        .repainted("aqua_terry", style.terry(&mut d.stream("terry")))
}

pub(crate) fn laundry_basket(_style: &Style, key: RandomKey) -> Model {
    bath_things::laundry_basket().resized(SizeSampler::new("laundry_basket", key).m("height") / 0.6)
}

pub(crate) fn waste_bin(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("waste_bin", key);
    let tone = style.cloth(&mut d.stream("tone")).srgb;
    let metal = Finish {
        substance: "steel",
        ..style.metal.clone()
    };
    let color = if d.chance("metal", 0.5) {
        metal
    } else {
        Finish::plain("bin_paint", "steel", tone)
    };
    bath_things::pedal_bin(d.m("height"), &color)
}

pub(crate) fn scale(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("scale", key);
    let pane = Finish::plain(
        "scale_glass",
        "glass",
        d.of(
            "tone",
            [
                [150, 186, 180],
                [230, 232, 232],
                [40, 42, 46],
                [196, 170, 170],
            ],
        ),
    )
    .clear(1.0);
    bath_things::scale()
        .resized(d.m("width") / 0.3)
        .repainted("green_glass", &pane)
}

pub(crate) fn folded_towel(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("folded_towel", key);
    bath_things::folded_towel(style.terry(&mut d.stream("terry"))).resized(d.m("width") / 0.34)
}

pub(crate) fn towel_rail(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("towel_rail", key);
    bath_things::towel_rail(d.m("width") - 0.018, style.terry(&mut d.stream("terry")))
}

pub(crate) fn paper_holder(_style: &Style, key: RandomKey) -> Model {
    bath_things::paper_holder().resized(SizeSampler::new("paper_holder", key).m("width") / 0.155)
}

pub(crate) fn soap_dispenser(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("soap_dispenser", key);
    let tone = style.glaze(&mut d.stream("tone")).srgb;
    bath_things::soap_dispenser(&plastic("dispenser_plastic", tone)).resized(d.m("height") / 0.172)
}

pub(crate) fn toothbrushes(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toothbrushes", key);
    let tones = [
        [88, 168, 112],
        [66, 120, 186],
        [226, 90, 110],
        [240, 180, 60],
        [236, 236, 232],
    ];
    let first = d.below("first", tones.len());
    let second = (first + 1 + d.below("second", tones.len() - 1)) % tones.len();
    bath_things::toothbrushes()
        .resized(d.m("height") / 0.18)
        .repainted("green_plastic", &plastic("first_brush", tones[first]))
        .repainted("blue_plastic", &plastic("second_brush", tones[second]))
}

pub(crate) fn wall_mirror(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_mirror", key);
    let rim = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        style.any_wood(&mut d.stream("rim")).clone()
    };
    bath_things::wall_mirror(d.m("width"), d.m("height"), &rim)
}
