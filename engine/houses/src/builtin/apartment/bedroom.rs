//! The parents' bedroom.

use crate::building::site::{Side, Site};
use dwell_furniture::finish::{
    Finish, black, brass, cloth, grey_board, oak, porcelain, terry, upholstery, walnut,
    white_lacquer,
};
use dwell_furniture::models::bath_things::{laundry_basket, wall_mirror};
use dwell_furniture::models::bed::Bed;
use dwell_furniture::models::bookshelf::book;
use dwell_furniture::models::cabinet::Front;
use dwell_furniture::models::decoration::{handbag, open_box, picture};
use dwell_furniture::models::dresser::Dresser;
use dwell_furniture::models::gadgets::alarm_clock;
use dwell_furniture::models::lamps::{drum, linen_shade, table_lamp};
use dwell_furniture::models::nightstand::nightstand;
use dwell_furniture::models::openings::{light_switch, radiator};
use dwell_furniture::models::plants::vase;
use dwell_furniture::models::seats::pouf;
use dwell_furniture::models::textiles::{Curtains, folded_blanket, pillow, round_rug};
use dwell_furniture::models::wardrobe::Wardrobe;

const NORTH: f32 = 0.0;
const WEST: f32 = 0.0;
const EAST: f32 = 4.0;
const SOUTH: f32 = 3.7;
/// Middle of the bed.
const BED_Z: f32 = 1.45;

pub(super) fn furnish(site: &mut Site<'_>) {
    bed(site);
    let tall = Wardrobe {
        width_m: 1.8,
        doors: 4,
        body: grey_board(),
        front: Front::plain(white_lacquer(), black()),
        ..Wardrobe::default()
    };
    let tall = site.kind(tall.build());
    let tall = site.against(&tall, Side::South, SOUTH, 1.8, 0.0);
    let card = Finish::plain("brown_card", "paper", [176, 138, 96]);
    let carton = site.kind(open_box([0.42, 0.24, 0.34], &card));
    site.put(&carton, &tall, "inside", [-0.45, 0.0], 0.0);
    let fold = site.kind(folded_blanket(
        0.4,
        0.34,
        &cloth("grey_wool", [150, 150, 152]),
    ));
    site.put(&fold, &tall, "hat_shelf", [0.4, 0.0], 0.0);

    let chest = site.kind(
        Dresser {
            wood: walnut(),
            front: Front::plain(walnut(), brass()),
            ..Dresser::default()
        }
        .build(),
    );
    let chest = site.against(&chest, Side::East, EAST, 1.75, 0.0);
    let glass = site.kind(wall_mirror(0.8, 0.9, &walnut()));
    site.hang(&glass, Side::East, EAST, 1.75, 1.5);
    let white_petals = Finish::plain("white_petals", "leaves", [240, 236, 226]);
    let bunch = site.kind(vase(
        0.22,
        &porcelain("rose_glaze", [206, 150, 146]),
        Some(&white_petals),
    ));
    site.put(&bunch, &chest, "top", [0.36, 0.0], 0.0);
    let bag = site.kind(handbag());
    site.put(&bag, &chest, "top", [-0.28, 0.0], 10.0);
    let seat = site.kind(pouf(0.22, 0.42, &cloth("rose_cloth", [196, 140, 136])));
    site.stand(&seat, 3.05, 0.5, 0.0);
    let wash = site.kind(laundry_basket());
    site.stand(&wash, 3.7, 0.35, 0.0);

    let drapes = Curtains {
        width_m: 2.2,
        height_m: 2.3,
        drawn: 0.18,
        cloth: Finish {
            substance: "heavy_curtain",
            ..cloth("sage_curtain", [142, 160, 144])
        },
    };
    let drapes = site.kind(drapes.build());
    site.hang(&drapes, Side::North, NORTH, 2.0, 2.36);
    let heat = site.kind(radiator(0.95, 0.5));
    site.hang(&heat, Side::North, NORTH, 2.0, 0.14);
    let lamp = site.kind(drum(0.3, 0.24, &linen_shade(), 12.0));
    site.ceiling(&lamp, 2.2, 1.9, 0.0);
    let switch = site.kind(light_switch());
    site.hang(&switch, Side::East, EAST, 3.3, 1.1);
    let shag = site.kind(round_rug(0.55, &terry("ivory_shag", [228, 220, 204])));
    site.stand(&shag, 2.9, 2.3, 0.0);
}

fn bed(site: &mut Site<'_>) {
    let headboard = Some(upholstery("sage_upholstery", [124, 142, 126]));
    let frame = site.kind(
        Bed {
            headboard,
            blanket: cloth("teal_linen", [78, 114, 122]),
            ..Bed::default()
        }
        .build(),
    );
    let frame = site.against(&frame, Side::West, WEST, BED_Z, 0.0);
    let white = site.kind(pillow(
        [0.66, 0.17, 0.44],
        &cloth("white_linen", [240, 238, 232]),
    ));
    let blush = site.kind(pillow(
        [0.5, 0.15, 0.4],
        &cloth("rose_cloth", [196, 140, 136]),
    ));
    for dx in [-0.4, 0.4] {
        site.put(&white, &frame, "pillow_end", [dx, -0.05], 0.0);
    }
    site.put(&blush, &frame, "blanket", [0.0, -0.4], 8.0);
    let stand = site.kind(nightstand(0.42, 0.5, &oak()));
    let lamp = site.kind(table_lamp(
        0.42,
        &porcelain("sage_glaze", [136, 156, 140]),
        &linen_shade(),
    ));
    let near = site.against(&stand, Side::West, WEST, BED_Z - 1.1, 0.0);
    let far = site.against(&stand, Side::West, WEST, BED_Z + 1.1, 0.0);
    site.put(&lamp, &near, "top", [0.0, -0.02], 0.0);
    site.put(&lamp, &far, "top", [0.06, -0.04], 0.0);
    let clock = site.kind(alarm_clock());
    site.put(&clock, &far, "top", [-0.13, 0.08], 10.0);
    let novel = site.kind(book([0.13, 0.03, 0.2], 2));
    site.put(&novel, &near, "shelf", [0.0, 0.0], 14.0);
    let images = [
        Finish::picture(
            "botanical_print",
            "paper",
            "branch",
            [[238, 232, 220], [112, 136, 116], [120, 100, 76]],
            1,
        ),
        Finish::picture(
            "botanical_print",
            "paper",
            "branch",
            [[238, 232, 220], [150, 126, 92], [104, 88, 70]],
            2,
        ),
    ];
    for (k, image) in images.iter().enumerate() {
        let print = site.kind(picture(0.42, 0.56, &oak(), image));
        site.hang(
            &print,
            Side::West,
            WEST,
            BED_Z - 0.32 + 0.64 * k as f32,
            1.62,
        );
    }
}
