//! Fitted kitchens, their appliances, and crockery.

use super::tapped;
use crate::finishes::{Finish, glass, painted_steel, paper, plastic, steel};
use crate::model::Model;
use crate::models::kitchen_unit::{KitchenUnit, UnitKind, WORKTOP_M, wall_cabinet as cabinets};
use crate::models::{appliances, cooker, crockery, food, fridge, taps};
use crate::sampling::SizeSampler;
use crate::style::Style;
use dwell_scene::random::RandomKey;

/// The casing of an appliance: the style's, or white, or steel.
fn casing(style: &Style, d: &SizeSampler, name: &'static str) -> Finish {
    let white = Finish {
        name,
        srgb: [238, 239, 240],
        ..style.appliance.clone()
    };
    let metal = Finish {
        name,
        srgb: [172, 174, 178],
        ..style.appliance.clone()
    };
    match d.below("casing", 4) {
        0 => white,
        1 => metal,
        _ => Finish {
            name,
            ..style.appliance.clone()
        },
    }
}

fn run(style: &Style, bay_m: f32, bays: Vec<UnitKind>) -> Model {
    KitchenUnit {
        bay_m,
        bays,
        front: style.kitchen_doors(),
        worktop: style.worktop.clone(),
    }
    .build()
}

pub(crate) fn base_unit_1(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("base_unit_1", key);
    run(
        style,
        d.m("width"),
        vec![d.of("bay", [UnitKind::Door, UnitKind::Drawers])],
    )
}

pub(crate) fn base_unit_2(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("base_unit_2", key);
    let bays = d.of(
        "order",
        [
            [UnitKind::Door, UnitKind::Drawers],
            [UnitKind::Drawers, UnitKind::Door],
        ],
    );
    run(style, 0.5 * d.m("width"), bays.to_vec())
}

/// A run with a sink and its tap.
fn sink(style: &Style, d: &SizeSampler, bay_m: f32, bays: Vec<UnitKind>) -> Model {
    let place = bays
        .iter()
        .position(|bay| *bay == UnitKind::Sink)
        .unwrap_or(0);
    let middle = bay_m * (place as f32 + 0.5 - 0.5 * bays.len() as f32);
    let sizes = [d.range("tap", 0.2, 0.3), d.range("reach", 0.16, 0.19)];
    tapped(
        run(style, bay_m, bays),
        style,
        d,
        sizes,
        [middle, WORKTOP_M, -0.24],
        0.0,
    )
}

pub(crate) fn sink_unit(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sink_unit", key);
    sink(style, &d, d.m("width"), vec![UnitKind::Sink])
}

pub(crate) fn sink_unit_2(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sink_unit_2", key);
    let other = d.of("other", [UnitKind::Door, UnitKind::Drawers]);
    let bays = d.of("order", [[UnitKind::Sink, other], [other, UnitKind::Sink]]);
    sink(style, &d, 0.5 * d.m("width"), bays.to_vec())
}

pub(crate) fn sink_unit_3(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sink_unit_3", key);
    let other = d.of("other", [UnitKind::Door, UnitKind::Drawers]);
    let orders = [
        [UnitKind::Drawers, UnitKind::Sink, other],
        [other, UnitKind::Sink, UnitKind::Drawers],
        [UnitKind::Sink, UnitKind::Door, UnitKind::Drawers],
    ];
    sink(
        style,
        &d,
        d.m("width") / 3.0,
        d.of("order", orders).to_vec(),
    )
}

fn cabinet(style: &Style, name: &'static str, key: RandomKey, doors: usize) -> Model {
    let d = SizeSampler::new(name, key);
    cabinets(
        doors,
        d.m("width") / doors as f32,
        d.m("height"),
        &style.kitchen_doors(),
    )
}

pub(crate) fn wall_cabinet(style: &Style, key: RandomKey) -> Model {
    cabinet(style, "wall_cabinet", key, 1)
}

pub(crate) fn wall_cabinet_2(style: &Style, key: RandomKey) -> Model {
    cabinet(style, "wall_cabinet_2", key, 2)
}

pub(crate) fn wall_cabinet_3(style: &Style, key: RandomKey) -> Model {
    cabinet(style, "wall_cabinet_3", key, 3)
}

pub(crate) fn refrigerator(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("refrigerator", key);
    let case = casing(style, &d, "fridge_casing");
    fridge::refrigerator(d.m("width"), d.m("height"), d.m("depth")).repainted("fridge_white", &case)
}

pub(crate) fn stove(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cooker", key);
    cooker::cooker().repainted("cooker_steel", &casing(style, &d, "cooker_casing"))
}

pub(crate) fn range_hood(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("range_hood", key);
    let shine = if d.chance("dark", 0.3) {
        painted_steel("hood_black", [44, 44, 47])
    } else {
        Finish {
            name: "hood_steel",
            ..steel()
        }
    };
    cooker::range_hood(d.m("width")).repainted("steel", &shine)
}

pub(crate) fn microwave(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("microwave", key);
    appliances::microwave()
        .resized(d.m("width") / 0.48)
        .repainted("microwave_white", &casing(style, &d, "microwave_casing"))
}

pub(crate) fn washer(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("washer", key);
    appliances::washer().repainted("washer_white", &casing(style, &d, "washer_casing"))
}

pub(crate) fn kettle(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("kettle", key);
    let tone = style.cloth(&mut d.stream("tone")).srgb;
    let body = match d.below("body", 3) {
        0 => painted_steel("kettle_enamel", tone),
        1 => painted_steel("kettle_white", [236, 236, 232]),
        _ => Finish {
            name: "kettle_steel",
            ..steel()
        },
    };
    appliances::kettle()
        .resized(d.m("height") / 0.22)
        .repainted("steel", &body)
}

pub(crate) fn toaster(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toaster", key);
    let tone = style.cloth(&mut d.stream("tone")).srgb;
    let case = plastic(
        "toaster_case",
        d.of(
            "case",
            [tone, [232, 218, 186], [52, 54, 58], [190, 193, 197]],
        ),
    );
    appliances::toaster()
        .resized(d.m("height") / 0.18)
        .repainted("cream_plastic", &case)
}

pub(crate) fn coffee_machine(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("coffee_machine", key);
    let tone = style.cloth(&mut d.stream("tone")).srgb;
    let case = plastic(
        "coffee_machine_case",
        d.of("case", [tone, [54, 56, 60], [196, 198, 202], [150, 36, 38]]),
    );
    appliances::coffee_machine()
        .resized(d.m("height") / 0.33)
        .repainted("anthracite_plastic", &case)
}

pub(crate) fn mixer_tap(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("mixer_tap", key);
    let metal = Finish {
        name: "tap_metal",
        substance: "chrome",
        ..style.metal.clone()
    };
    let tap = taps::mixer_tap(d.m("height"), d.m("reach"));
    if d.chance("metal", 0.3) {
        tap.repainted("chrome", &metal)
    } else {
        tap
    }
}

pub(crate) fn bottle(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bottle", key);
    let body = Finish {
        srgb: d.of("glass", [[52, 92, 60], [110, 60, 40], [186, 206, 214]]),
        ..glass()
    };
    let label = paper(
        "bottle_label",
        d.of(
            "label",
            [
                [240, 240, 236],
                [226, 206, 150],
                [150, 40, 44],
                [60, 90, 70],
            ],
        ),
    );
    let cap = painted_steel(
        "bottle_cap",
        d.of(
            "cap",
            [[168, 171, 175], [150, 40, 44], [40, 44, 50], [190, 156, 84]],
        ),
    );
    crockery::bottle(d.m("height"), &body, &label, &cap)
}

pub(crate) fn bowl(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bowl", key);
    crockery::bowl(0.5 * d.m("width"), style.glaze(&mut d.stream("glaze")))
}

pub(crate) fn jar(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("jar", key);
    let lid = if d.chance("wood", 0.5) {
        style.wood.clone()
    } else {
        steel()
    };
    crockery::jar(d.m("height"), style.glaze(&mut d.stream("glaze")), &lid)
}

pub(crate) fn mug(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("mug", key);
    crockery::mug(style.glaze(&mut d.stream("glaze"))).resized(d.m("height") / 0.095)
}

pub(crate) fn plate(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("plate", key);
    crockery::plate(0.5 * d.m("width"), style.glaze(&mut d.stream("glaze")))
}

pub(crate) fn pan(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pan", key);
    let iron = painted_steel(
        "pan_metal",
        d.of("metal", [[40, 40, 42], [168, 171, 175], [150, 60, 40]]),
    );
    crockery::pan(0.5 * d.m("depth")).repainted("black_steel", &iron)
}

pub(crate) fn pot(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pot", key);
    let tone = style.cloth(&mut d.stream("tone")).srgb;
    let metal = if d.chance("enamel", 0.5) {
        painted_steel("pot_enamel", tone)
    } else {
        steel()
    };
    let radius = 0.5 * d.m("depth");
    if d.chance("lid", 0.5) {
        crockery::pot(radius, &metal)
    } else {
        crockery::open_pot(radius, &metal)
    }
}

pub(crate) fn tumbler(_style: &Style, key: RandomKey) -> Model {
    crockery::tumbler().resized(SizeSampler::new("tumbler", key).m("height") / 0.12)
}

pub(crate) fn utensils(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("utensils", key);
    let cup = Finish {
        name: "beaker",
        substance: "steel",
        ..style.glaze(&mut d.stream("cup")).clone()
    };
    crockery::utensils()
        .resized(d.m("height") / 0.31)
        .repainted("steel", &cup)
}

pub(crate) fn bread(_style: &Style, key: RandomKey) -> Model {
    food::bread().resized(SizeSampler::new("bread", key).m("width") / 0.26)
}

pub(crate) fn cutting_board(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cutting_board", key);
    let wood = &style.wood;
    let board = food::cutting_board().resized(d.m("width") / 0.38);
    if wood.pattern.is_some() && wood.tile_m > 0.0 {
        board.repainted("beech", wood)
    } else {
        board
    }
}

pub(crate) fn fruit(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("fruit", key);
    let skins = [food::red_skin(), food::green_skin(), food::orange_skin()];
    food::fruit(0.5 * d.m("width"), &skins[d.below("skin", 3)])
}

pub(crate) fn knife_block(_style: &Style, key: RandomKey) -> Model {
    food::knife_block().resized(SizeSampler::new("knife_block", key).m("height") / 0.31)
}

pub(crate) fn knife(_style: &Style, key: RandomKey) -> Model {
    food::cutlery("knife").resized(SizeSampler::new("knife", key).m("depth") / 0.21)
}

pub(crate) fn fork(_style: &Style, key: RandomKey) -> Model {
    food::cutlery("fork").resized(SizeSampler::new("fork", key).m("depth") / 0.2)
}

pub(crate) fn spoon(_style: &Style, key: RandomKey) -> Model {
    food::cutlery("spoon").resized(SizeSampler::new("spoon", key).m("depth") / 0.205)
}
