//! Books, toys, gadgets, ornaments.

use crate::finishes::{Finish, leather, plastic, upholstery};
use crate::model::Model;
use crate::models::{bookshelf, decoration, gadgets, lamps, plants, radio};
use crate::sampling::SizeSampler;
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(crate) fn book(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("book", key);
    bookshelf::book(
        [d.m("width"), d.m("height"), d.m("depth")],
        d.below("cover", 8),
    )
}

pub(crate) fn book_row(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("book_row", key);
    bookshelf::book_row(d.m("row"), d.m("tall"), key.child("row"))
}

pub(crate) fn magazines(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("magazines", key);
    let cover = |k: usize| {
        let colors = [0, 1, 2].map(|n| style.cloths[(k + n) % style.cloths.len()].srgb);
        let recipe = ["cover", "shapes", "landscape"][k];
        Finish::picture("magazine_cover", "paper", recipe, colors, 1 + k as u64)
    };
    decoration::magazines([&cover(0), &cover(1), &cover(2)]).resized(d.m("width") / 0.24)
}

pub(crate) fn globe(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("globe", key);
    let globe = decoration::globe().resized(d.m("height") / 0.285);
    let wood = &style.wood;
    if wood.tile_m > 0.0 {
        globe.repainted("oak", wood)
    } else {
        globe
    }
}

pub(crate) fn handbag(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("handbag", key);
    let hide = leather(
        "bag_leather",
        d.of(
            "hide",
            [
                [150, 88, 48],
                [40, 38, 38],
                [150, 44, 50],
                [206, 186, 152],
                [60, 80, 110],
            ],
        ),
    );
    decoration::handbag()
        .resized(d.m("height") / 0.376)
        .repainted("cognac_leather", &hide)
}

pub(crate) fn sculpture(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sculpture", key);
    decoration::sculpture(style.glaze(&mut d.stream("stone"))).resized(d.m("height") / 0.194)
}

pub(crate) fn storage_box(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("storage_box", key);
    let card = Finish::plain(
        "storage_card",
        "paper",
        d.of(
            "card",
            [
                [176, 138, 96],
                [226, 222, 212],
                [96, 120, 140],
                [150, 150, 148],
            ],
        ),
    );
    let stuff = if d.chance("card", 0.5) {
        card
    } else {
        style.any_wood(&mut d.stream("wood")).clone()
    };
    decoration::open_box([d.m("width"), d.m("height"), d.m("depth")], &stuff)
}

pub(crate) fn pencil_cup(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pencil_cup", key);
    let cup = plastic(
        "pencil_cup_plastic",
        style.cloth(&mut d.stream("tone")).srgb,
    );
    decoration::pencil_cup()
        .resized(d.m("height") / 0.16)
        .repainted("blue_plastic", &cup)
}

pub(crate) fn shoes(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shoes", key);
    let hide = leather(
        "shoe_leather",
        d.of(
            "hide",
            [
                [104, 62, 38],
                [36, 34, 34],
                [226, 224, 218],
                [60, 74, 104],
                [150, 50, 48],
            ],
        ),
    );
    decoration::shoes(&hide).resized(d.m("depth") / 0.29)
}

pub(crate) fn teddy_bear(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("teddy_bear", key);
    let plush = upholstery(
        "plush",
        d.of(
            "plush",
            [
                [156, 108, 66],
                [204, 170, 120],
                [120, 84, 60],
                [226, 206, 180],
            ],
        ),
    );
    decoration::teddy_bear(&plush).resized(d.m("height") / 0.274)
}

pub(crate) fn toy_ball(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toy_ball", key);
    let rubber = Finish::plain(
        "toy_rubber",
        "rubber",
        style.cloth(&mut d.stream("tone")).srgb,
    );
    decoration::toy_ball(0.5 * d.m("width"), &rubber)
}

pub(crate) fn toy_train(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toy_train", key);
    let tones = [
        [196, 52, 44],
        [54, 96, 168],
        [236, 190, 60],
        [76, 150, 90],
        [226, 226, 220],
    ];
    let first = d.below("first", tones.len());
    let second = (first + 1 + d.below("second", tones.len() - 1)) % tones.len();
    decoration::toy_train()
        .resized(d.m("width") / 0.24)
        .repainted("red_wood", &Finish::plain("toy_body", "wood", tones[first]))
        .repainted(
            "blue_wood",
            &Finish::plain("toy_boiler", "wood", tones[second]),
        )
}

pub(crate) fn toy_block(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toy_block", key);
    let tone = d.of(
        "tone",
        [[196, 52, 44], [54, 96, 168], [236, 190, 60], [76, 150, 90]],
    );
    decoration::toy_block(d.m("width"), "block_lacquer", tone)
}

pub(crate) fn alarm_clock(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("alarm_clock", key);
    let case = plastic("alarm_clock_case", style.glaze(&mut d.stream("tone")).srgb);
    gadgets::alarm_clock()
        .resized(d.m("height") / 0.11)
        .repainted("mint_plastic", &case)
}

pub(crate) fn laptop(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("laptop", key);
    let case = crate::finishes::device(
        "laptop_case",
        d.of(
            "case",
            [
                [150, 152, 156],
                [54, 56, 60],
                [206, 206, 208],
                [190, 160, 150],
            ],
        ),
    );
    gadgets::laptop()
        .resized(d.m("width") / 0.33)
        .repainted("grey_case", &case)
}

pub(crate) fn remote_control(_style: &Style, key: RandomKey) -> Model {
    gadgets::remote_control().resized(SizeSampler::new("remote_control", key).m("depth") / 0.17)
}

pub(crate) fn telephone(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("telephone", key);
    let case = plastic(
        "telephone_case",
        d.of(
            "case",
            [[170, 36, 34], [44, 44, 47], [226, 214, 186], [70, 110, 96]],
        ),
    );
    gadgets::telephone()
        .resized(d.m("width") / 0.222)
        .repainted("red_plastic", &case)
}

pub(crate) fn candle(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("candle", key);
    let wax = Finish::plain(
        "candle_wax",
        "wax",
        d.of(
            "wax",
            [
                [240, 230, 204],
                [170, 40, 44],
                [222, 190, 140],
                [120, 140, 110],
            ],
        ),
    );
    lamps::candle(d.m("height") - 0.016).repainted("wax", &wax)
}

pub(crate) fn night_light(_style: &Style, key: RandomKey) -> Model {
    lamps::night_light().resized(SizeSampler::new("night_light", key).m("height") / 0.132)
}

pub(crate) fn vase(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("vase", key);
    plants::vase(d.m("height"), style.glaze(&mut d.stream("glaze")), None)
}

pub(crate) fn wireless(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("radio", key);
    let wood = &style.wood;
    let set = radio::radio(d.chance("on", 0.25)).resized(d.m("width") / 0.3);
    if wood.tile_m > 0.0 {
        set.repainted("walnut", wood)
    } else {
        set
    }
}
