//! The kitchen.

use crate::building::site::{Side, Site};
use dwell_furniture::finish::{Finish, granite, pine};
use dwell_furniture::finish::{
    black, cloth, glass, lacquer, oak, painted_steel, plastic, porcelain, steel, terracotta,
};
use dwell_furniture::models::appliances::{coffee_machine, kettle, microwave, toaster};
use dwell_furniture::models::bath_things::{pedal_bin, soap_dispenser};
use dwell_furniture::models::bookshelf::wall_shelf;
use dwell_furniture::models::cabinet::Front;
use dwell_furniture::models::chair::Chair;
use dwell_furniture::models::cooker::{cooker, range_hood};
use dwell_furniture::models::crockery::{
    bottle, bowl, jar, mug, pan, plate, pot, tumbler, utensils, white_glaze,
};
use dwell_furniture::models::decoration::picture;
use dwell_furniture::models::food::{bread, cutting_board, fruit, knife_block, red_skin};
use dwell_furniture::models::fridge::refrigerator;
use dwell_furniture::models::gadgets::wall_clock;
use dwell_furniture::models::kitchen_unit::{Bay, KitchenUnit, WORKTOP_M, wall_cabinet};
use dwell_furniture::models::lamps::{ceiling_dome, pendant};
use dwell_furniture::models::openings::{light_switch, radiator};
use dwell_furniture::models::plants::{Plant, fresh_green};
use dwell_furniture::models::radio::radio;
use dwell_furniture::models::table::Table;
use dwell_furniture::models::taps::mixer_tap;
use dwell_furniture::models::textiles::rug;
use dwell_furniture::models::tv_stand::Lowboard;
use dwell_scene::random::Key;

const NORTH: f32 = 0.0;
const WEST: f32 = 6.5;
const EAST: f32 = 11.0;
const SOUTH: f32 = 3.7;
/// Height of the wall cabinets' lower edges, m.
const CABINETS_M: f32 = 1.45;

pub(super) fn furnish(site: &mut Site<'_>) {
    worktops(site);
    west_side(site);
    breakfast(site);
    walls(site);
}

fn front() -> Finish {
    lacquer("sage_lacquer", [138, 158, 136])
}

fn worktops(site: &mut Site<'_>) {
    let cold = site.kind(refrigerator(0.65, 1.85, 0.66));
    site.against(&cold, Side::North, NORTH, 6.9, 0.0);
    let narrow = KitchenUnit {
        bays: vec![Bay::Drawers],
        front: Front::plain(front(), steel()),
        worktop: granite(),
        ..KitchenUnit::default()
    };
    let narrow = site.kind(narrow.build());
    let narrow = site.against(&narrow, Side::North, NORTH, 7.57, 0.0);
    let stove = site.kind(cooker());
    let stove = site.against(&stove, Side::North, NORTH, 8.18, 0.0);
    let long = KitchenUnit {
        bays: vec![Bay::Door, Bay::Sink, Bay::Drawers, Bay::Door],
        front: Front::plain(front(), steel()),
        ..KitchenUnit::default()
    };
    let long = site.kind(long.build());
    let long = site.against(&long, Side::North, NORTH, 9.69, 0.0);
    let tap = site.kind(mixer_tap(0.215, 0.17));
    site.mount(&tap, &long, [-0.3, WORKTOP_M, -0.24], 0.0);

    let toast = site.kind(toaster());
    site.put(&toast, &narrow, "worktop", [-0.02, -0.12], 0.0);
    let soup = site.kind(pot(0.12, &painted_steel("red_enamel", [178, 40, 38])));
    site.put(&soup, &stove, "hob", [-0.14, -0.12], 0.0);
    let fry = site.kind(pan(0.13));
    site.put(&fry, &stove, "hob", [0.13, 0.12], -90.0);

    let board = site.kind(cutting_board());
    let board = site.put(&board, &long, "worktop", [-0.06, 0.1], 0.0);
    let loaf = site.kind(bread());
    site.put(&loaf, &board, "top", [0.0, 0.0], 14.0);
    let knives = site.kind(knife_block());
    site.put(&knives, &long, "worktop", [-0.18, -0.2], 0.0);
    let spoons = site.kind(utensils());
    site.put(&spoons, &long, "worktop", [0.05, -0.22], 0.0);
    let soap = site.kind(soap_dispenser(&plastic("lime_plastic", [170, 196, 84])));
    site.put(&soap, &long, "worktop", [0.24, -0.24], 0.0);

    let boiler = site.kind(kettle());
    site.put(&boiler, &long, "worktop_right", [0.42, 0.02], 150.0);
    let coffee = site.kind(coffee_machine());
    site.put(&coffee, &long, "worktop_right", [0.12, -0.12], 0.0);
    let set = site.kind(radio(true));
    site.put(&set, &long, "worktop_right", [-0.3, -0.16], 12.0);
    let blue = site.kind(mug(&porcelain("blue_glaze", [84, 120, 168])));
    site.put(&blue, &long, "worktop_right", [0.08, 0.16], 60.0);
    let white = site.kind(mug(&white_glaze()));
    site.put(&white, &long, "worktop_right", [0.24, 0.14], -30.0);
    let dirty = site.kind(plate(0.12, &white_glaze()));
    site.put(&dirty, &long, "sink", [0.0, 0.02], 0.0);

    let single = site.kind(wall_cabinet(1, 0.6, 0.7, &Front::plain(front(), steel())));
    let over = site.hang(&single, Side::North, NORTH, 7.57, CABINETS_M);
    let far = site.hang(&single, Side::North, NORTH, 10.59, CABINETS_M);
    let hood = site.kind(range_hood(0.6));
    site.hang(&hood, Side::North, NORTH, 8.18, 1.6);
    // Crockery behind the doors.
    let dish = site.kind(plate(0.12, &white_glaze()));
    site.put(&dish, &over, "lower_shelf", [-0.12, 0.0], 0.0);
    let deep = site.kind(bowl(0.09, &white_glaze()));
    site.put(&deep, &over, "lower_shelf", [0.14, 0.0], 0.0);
    let glass = site.kind(tumbler());
    for dx in [-0.16, -0.04, 0.08, 0.2] {
        site.put(&glass, &far, "lower_shelf", [dx, 0.0], 0.0);
    }
    site.put(&white, &over, "upper_shelf", [-0.1, 0.0], 40.0);
    site.put(&blue, &over, "upper_shelf", [0.12, 0.0], 100.0);
}

fn west_side(site: &mut Site<'_>) {
    let chest = Lowboard {
        name: "kitchen_cabinet",
        category: "kitchen_cabinet",
        width_m: 0.95,
        height_m: 0.88,
        depth_m: 0.44,
        wood: oak(),
        front: Front::plain(front(), black()),
    };
    let chest = site.kind(chest.build());
    let chest = site.against(&chest, Side::West, WEST, 2.1, 0.0);
    let oven = site.kind(microwave());
    site.put(&oven, &chest, "top", [0.14, 0.0], 0.0);
    let fruit_bowl = site.kind(bowl(0.12, &terracotta()));
    let fruit_bowl = site.put(&fruit_bowl, &chest, "top", [-0.3, 0.06], 0.0);
    let apple = site.kind(fruit(0.036, &red_skin()));
    site.put(&apple, &fruit_bowl, "inside", [0.0, 0.0], 0.0);
    let board = site.kind(wall_shelf(0.95, 0.2, &oak()));
    let board = site.hang(&board, Side::West, WEST, 2.1, 1.6);
    let tins = [
        (0.2, painted_steel("red_tin", [184, 62, 48]), -0.36),
        (0.17, painted_steel("cream_tin", [232, 220, 190]), -0.2),
        (0.14, painted_steel("blue_tin", [70, 112, 150]), -0.06),
    ];
    for (height, color, dx) in tins {
        let tin = site.kind(jar(height, &color, &steel()));
        site.put(&tin, &board, "top", [dx, 0.0], 0.0);
    }
    let oil = site.kind(bottle(
        0.29,
        &glass(),
        &Finish::plain("olive_label", "paper", [120, 130, 60]),
        &plastic("black_plastic", [34, 34, 36]),
    ));
    site.put(&oil, &board, "top", [0.12, 0.0], 0.0);
    let wine_glass = Finish::plain("green_bottle_glass", "glass", [48, 76, 52]).clear(0.85);
    let wine = site.kind(bottle(
        0.31,
        &wine_glass,
        &Finish::plain("wine_label", "paper", [236, 226, 202]),
        &Finish::plain("wine_capsule", "aluminium", [120, 30, 40]),
    ));
    site.put(&wine, &board, "top", [0.25, 0.0], 0.0);
    site.put(&wine, &board, "top", [0.38, 0.0], 0.0);
    let bin = site.kind(pedal_bin(0.6, &steel()));
    site.stand(&bin, 6.76, 2.95, 90.0);
}

fn breakfast(site: &mut Site<'_>) {
    let table = Table {
        name: "kitchen_table",
        size_m: [1.15, 0.78],
        leg_m: 0.055,
        top: pine(),
        legs: pine(),
        category: "table",
        ..Table::default()
    };
    let table = site.kind(table.build());
    let table = site.stand(&table, 10.05, 2.5, 0.0);
    let red = Chair {
        wood: pine(),
        pad: Some(cloth("red_cloth", [176, 62, 54])),
        slats: 2,
        ..Chair::default()
    };
    let chair = site.kind(red.build());
    site.stand(&chair, 10.05, 2.5 - 0.56, 0.0);
    site.stand(&chair, 10.05, 2.5 + 0.58, 176.0);
    site.stand(&chair, 9.3, 2.5, 94.0);
    let dish = site.kind(plate(0.12, &porcelain("blue_glaze", [84, 120, 168])));
    let dish = site.put(&dish, &table, "top", [0.0, 0.2], 0.0);
    let apple = site.kind(fruit(0.037, &red_skin()));
    site.put(&apple, &dish, "top", [0.0, 0.0], 0.0);
    let cup = site.kind(mug(&porcelain("red_glaze", [176, 62, 54])));
    site.put(&cup, &table, "top", [-0.3, 0.14], 20.0);
    let milk = site.kind(bottle(
        0.25,
        &Finish::plain("milk_bottle", "glass", [244, 244, 240]).clear(1.0),
        &Finish::plain("milk_label", "paper", [96, 150, 200]),
        &plastic("white_plastic", [240, 240, 236]),
    ));
    site.put(&milk, &table, "top", [0.26, -0.12], 0.0);
    let lamp = site.kind(pendant(
        0.9,
        0.19,
        &painted_steel("red_enamel", [178, 40, 38]),
        9.0,
    ));
    site.ceiling(&lamp, 10.05, 2.5, 0.0);
}

fn walls(site: &mut Site<'_>) {
    let clock = site.kind(wall_clock(0.15));
    site.hang(&clock, Side::East, EAST, 1.5, 2.0);
    let image = Finish::picture(
        "botanical_print",
        "paper",
        "branch",
        [[240, 234, 216], [84, 128, 76], [110, 84, 54]],
        6,
    );
    let print = site.kind(picture(0.42, 0.56, &oak(), &image));
    site.hang(&print, Side::East, EAST, 2.5, 1.6);
    let heat = site.kind(radiator(0.8, 0.6));
    site.hang(&heat, Side::South, SOUTH, 9.2, 0.12);
    let switch = site.kind(light_switch());
    site.hang(&switch, Side::South, SOUTH, 7.2, 1.1);
    let dome = site.kind(ceiling_dome(0.22, 14.0));
    site.ceiling(&dome, 8.2, 1.7, 0.0);
    let mat = Finish::tiled(
        "kitchen_runner",
        "thin_carpet",
        "stripes",
        [[226, 220, 204], [120, 140, 120], [180, 96, 70]],
        0.5,
    );
    let runner = site.kind(rug(1.5, 0.6, &mat));
    site.stand(&runner, 9.1, 1.12, 0.0);
    let herb = Plant {
        height_m: 0.28,
        pot_m: 0.065,
        leaf_m: [0.09, 0.05],
        leaves: 16,
        stem_m: 0.0,
        pot: terracotta(),
        leaf: fresh_green(),
        key: Key::root(3).child("herb"),
    };
    let herb = site.kind(herb.build());
    // On the window's sill.
    site.stand_at(&herb, 9.1, 1.17, 0.035, 0.0);
    site.stand_at(&herb, 9.7, 1.17, 0.035, 70.0);
}
