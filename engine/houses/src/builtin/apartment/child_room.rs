//! The child's room.

use crate::building::site::{Side, Site};
use dwell_furniture::finish::lampshade;
use dwell_furniture::finish::{
    Finish, beech, black, cloth, painted_steel, pine, plastic, terry, upholstery, white_lacquer,
};
use dwell_furniture::models::bath_things::pedal_bin;
use dwell_furniture::models::bed::Bed;
use dwell_furniture::models::bookshelf::{Bookshelf, SHELVES, book, book_row};
use dwell_furniture::models::cabinet::Front;
use dwell_furniture::models::decoration::{
    globe, open_box, pencil_cup, poster, teddy_bear, toy_ball, toy_block, toy_train,
};
use dwell_furniture::models::desk::Desk;
use dwell_furniture::models::gadgets::laptop;
use dwell_furniture::models::lamps::{desk_lamp, drum, night_light};
use dwell_furniture::models::nightstand::nightstand;
use dwell_furniture::models::openings::{light_switch, radiator};
use dwell_furniture::models::seats::office_chair;
use dwell_furniture::models::textiles::{Curtains, pillow, round_rug};
use dwell_furniture::models::wardrobe::Wardrobe;
use dwell_scene::random::Key;

const NORTH: f32 = 5.3;
const EAST: f32 = 4.2;
const SOUTH: f32 = 9.0;

pub(super) fn furnish(site: &mut Site<'_>) {
    sleep(site);
    work(site);
    play(site);
    walls(site);
}

fn sleep(site: &mut Site<'_>) {
    let stars = Finish::tiled(
        "checked_cotton",
        "textile",
        "checks",
        [[232, 236, 240], [96, 140, 190], [230, 190, 80]],
        0.5,
    );
    let frame = Bed {
        mattress_m: [0.9, 2.0],
        head_m: 0.85,
        wood: pine(),
        blanket: stars,
        ..Bed::default()
    };
    let frame = site.kind(frame.build());
    let frame = site.against(&frame, Side::South, SOUTH, 0.5, 0.0);
    let head = site.kind(pillow(
        [0.6, 0.15, 0.42],
        &cloth("yellow_cotton", [240, 208, 104]),
    ));
    site.put(&head, &frame, "pillow_end", [0.0, -0.05], 0.0);
    let bear = site.kind(teddy_bear(&upholstery("brown_plush", [156, 108, 66])));
    site.put(&bear, &frame, "blanket", [0.1, -0.2], 20.0);
    let stand = site.kind(nightstand(0.4, 0.46, &pine()));
    let stand = site.against(&stand, Side::South, SOUTH, 1.25, 0.0);
    let glow = site.kind(night_light());
    site.put(&glow, &stand, "top", [-0.08, 0.0], 0.0);
    let tale = site.kind(book([0.17, 0.02, 0.22], 7));
    site.put(&tale, &stand, "top", [0.1, 0.03], -10.0);
}

fn work(site: &mut Site<'_>) {
    let table = site.kind(
        Desk {
            width_m: 1.25,
            top: beech(),
            ..Desk::default()
        }
        .build(),
    );
    let table = site.against(&table, Side::South, SOUTH, 2.6, 0.13);
    let seat = site.kind(office_chair(&upholstery("orange_cloth", [222, 122, 48])));
    site.stand(&seat, 2.85, 7.92, 160.0);
    let screen = site.kind(laptop());
    site.put(&screen, &table, "top", [0.0, 0.02], 0.0);
    let lamp = site.kind(desk_lamp(&painted_steel("yellow_steel", [236, 190, 60])));
    site.put(&lamp, &table, "top", [0.45, -0.12], -30.0);
    let pens = site.kind(pencil_cup());
    site.put(&pens, &table, "top", [-0.32, -0.14], 0.0);
    let notes = site.kind(book([0.2, 0.018, 0.28], 3));
    site.put(&notes, &table, "top", [-0.45, 0.1], 12.0);
    let bin = site.kind(pedal_bin(0.34, &plastic("blue_plastic", [66, 120, 186])));
    site.stand(&bin, 3.55, 8.65, 180.0);
}

fn play(site: &mut Site<'_>) {
    let case = Bookshelf {
        width_m: 0.95,
        height_m: 1.2,
        levels: 3,
        wood: white_lacquer(),
        ..Bookshelf::default()
    };
    let case = site.kind(case.build());
    let case = site.against(&case, Side::North, NORTH, 1.95, 0.0);
    for (k, (level, width, dx)) in [(1, 0.5, -0.16), (2, 0.4, 0.2)].into_iter().enumerate() {
        let row = site.kind(book_row(
            width,
            0.26,
            Key::root(9).child("children").child(k as u64),
        ));
        site.put(&row, &case, SHELVES[level], [dx, -0.02], 0.0);
    }
    let world = site.kind(globe());
    site.put(&world, &case, "top", [-0.25, 0.0], 0.0);
    let red_box = site.kind(open_box(
        [0.4, 0.25, 0.26],
        &plastic("red_plastic", [206, 70, 60]),
    ));
    site.put(&red_box, &case, SHELVES[0], [-0.22, 0.0], 0.0);
    let green_box = site.kind(open_box(
        [0.4, 0.25, 0.26],
        &plastic("green_plastic", [88, 168, 112]),
    ));
    site.put(&green_box, &case, SHELVES[0], [0.22, 0.0], 0.0);
    let mat = site.kind(round_rug(0.85, &terry("red_pile", [204, 84, 70])));
    let mat = site.stand(&mat, 2.2, 6.95, 0.0);
    let pile = mat.model.bounds().max.y;
    let engine = site.kind(toy_train());
    site.stand_at(&engine, 2.0, pile, 6.7, 25.0);
    let blocks = [
        ("red_block", [206, 56, 48], 2.45, 6.75, 10.0),
        ("yellow_block", [240, 196, 60], 2.56, 6.86, 40.0),
        ("blue_block", [58, 104, 180], 2.4, 6.95, -20.0),
        ("green_block", [84, 160, 90], 2.62, 7.02, 65.0),
    ];
    for (name, color, x, z, turn) in blocks {
        let cube = site.kind(toy_block(0.06, name, color));
        site.stand_at(&cube, x, pile, z, turn);
    }
    let striped = Finish::tiled(
        "striped_ball",
        "rubber",
        "stripes",
        [[240, 240, 236], [206, 56, 48], [58, 104, 180]],
        0.5,
    );
    let rubber = site.kind(toy_ball(0.11, &striped));
    site.stand(&rubber, 3.3, 6.95, 30.0);
    let closet = Wardrobe {
        width_m: 1.0,
        height_m: 1.9,
        doors: 2,
        body: white_lacquer(),
        front: Front::plain(beech(), black()),
        ..Wardrobe::default()
    };
    let closet = site.kind(closet.build());
    site.against(&closet, Side::East, EAST, 5.95, 0.0);
}

fn walls(site: &mut Site<'_>) {
    let space = Finish::picture(
        "planet_poster",
        "paper",
        "planets",
        [[24, 34, 72], [230, 140, 80], [110, 190, 200]],
        2,
    );
    let print = site.kind(poster(1.0, 0.75, &space));
    site.hang(&print, Side::East, EAST, 7.6, 1.55);
    let drapes = Curtains {
        width_m: 2.0,
        height_m: 1.7,
        drawn: 0.17,
        cloth: Finish {
            substance: "light_curtain",
            ..cloth("yellow_curtain", [244, 210, 106])
        },
    };
    let drapes = site.kind(drapes.build());
    site.hang(&drapes, Side::South, SOUTH, 2.4, 2.36);
    let heat = site.kind(radiator(0.9, 0.5));
    site.hang(&heat, Side::East, EAST, 7.6, 0.14);
    let lamp = site.kind(drum(
        0.25,
        0.22,
        &lampshade("orange_shade", [244, 176, 96]),
        12.0,
    ));
    site.ceiling(&lamp, 2.1, 7.0, 0.0);
    let switch = site.kind(light_switch());
    site.hang(&switch, Side::North, NORTH, 1.36, 1.1);
}
