//! The hallway.

use crate::building::site::{Side, Site};
use dwell_furniture::finish::{
    Finish, black, cloth, leather, oak, porcelain, upholstery, white_lacquer,
};
use dwell_furniture::models::bath_things::wall_mirror;
use dwell_furniture::models::cabinet::Front;
use dwell_furniture::models::decoration::{picture, shoes};
use dwell_furniture::models::gadgets::telephone;
use dwell_furniture::models::lamps::ceiling_dome;
use dwell_furniture::models::openings::light_switch;
use dwell_furniture::models::plants::vase;
use dwell_furniture::models::seats::shoe_bench;
use dwell_furniture::models::textiles::{coat_rack, rug};
use dwell_furniture::models::wardrobe::Wardrobe;

const NORTH: f32 = 3.8;
const SOUTH: f32 = 5.2;
const WEST: f32 = 0.0;

pub(super) fn furnish(site: &mut Site<'_>) {
    let bench = site.kind(shoe_bench(
        1.0,
        &oak(),
        &upholstery("slate_blue_cloth", [92, 112, 134]),
    ));
    let bench = site.against(&bench, Side::South, SOUTH, 2.3, 0.0);
    let brown = site.kind(shoes(&leather("brown_leather", [104, 66, 40])));
    let red = site.kind(shoes(&cloth("red_canvas", [186, 56, 50])));
    site.put(&brown, &bench, "shelf", [-0.2, 0.0], 0.0);
    site.put(&red, &bench, "shelf", [0.2, 0.0], 0.0);
    let rack = site.kind(coat_rack(
        1.1,
        &cloth("navy_wool", [48, 58, 86]),
        &cloth("mustard_cloth", [204, 152, 50]),
    ));
    site.hang(&rack, Side::South, SOUTH, 2.3, 1.7);

    let cupboard = Wardrobe {
        width_m: 0.9,
        height_m: 0.95,
        depth_m: 0.3,
        doors: 2,
        body: white_lacquer(),
        front: Front::plain(oak(), black()),
    };
    let mut cupboard = cupboard.build();
    cupboard.name = "shoe_cabinet";
    cupboard.category = "shoes_cabinet";
    let cupboard = site.kind(cupboard);
    let cupboard = site.against(&cupboard, Side::South, SOUTH, 4.4, 0.0);
    let phone = site.kind(telephone());
    site.put(&phone, &cupboard, "top", [-0.2, 0.0], 8.0);
    let yellow = Finish::plain("yellow_petals", "leaves", [236, 196, 70]);
    let bunch = site.kind(vase(
        0.18,
        &porcelain("blue_glaze", [84, 120, 168]),
        Some(&yellow),
    ));
    site.put(&bunch, &cupboard, "top", [0.26, 0.0], 0.0);
    let glass = site.kind(wall_mirror(0.6, 0.85, &oak()));
    site.hang(&glass, Side::South, SOUTH, 4.4, 1.6);

    let weave = Finish::picture(
        "hall_runner",
        "carpet",
        "rug",
        [[70, 88, 104], [160, 70, 54], [222, 204, 170]],
        5,
    );
    let runner = site.kind(rug(2.4, 0.66, &weave));
    site.stand(&runner, 3.2, 4.4, 0.0);
    let images = [
        Finish::picture(
            "landscape",
            "paper",
            "landscape",
            [[150, 180, 200], [96, 104, 80], [244, 190, 110]],
            8,
        ),
        Finish::picture(
            "print",
            "paper",
            "shapes",
            [[196, 120, 84], [84, 112, 104], [40, 52, 72]],
            5,
        ),
    ];
    let first = site.kind(picture(0.6, 0.45, &oak(), &images[0]));
    site.hang(&first, Side::North, NORTH, 1.6, 1.6);
    let second = site.kind(picture(0.42, 0.56, &oak(), &images[1]));
    site.hang(&second, Side::North, NORTH, 4.5, 1.6);
    let dome = site.kind(ceiling_dome(0.18, 9.0));
    site.ceiling(&dome, 1.6, 4.5, 0.0);
    site.ceiling(&dome, 4.9, 4.5, 0.0);
    let switch = site.kind(light_switch());
    site.hang(&switch, Side::West, WEST, 5.1, 1.1);
}
