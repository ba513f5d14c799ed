//! The living room with its dining corner.

use crate::building::assembly::Placed;
use crate::building::site::{Side, Site};
use dwell_furniture::finish::{
    Finish, black, cloth, lampshade, marble, oak, painted_steel, porcelain, terracotta, upholstery,
    walnut,
};
use dwell_furniture::models::bookshelf::{Bookshelf, SHELVES, book, book_row, cover};
use dwell_furniture::models::cabinet::Front;
use dwell_furniture::models::chair::Chair;
use dwell_furniture::models::crockery::{bowl, plate, tumbler, white_glaze};
use dwell_furniture::models::decoration::{magazines, picture, sculpture};
use dwell_furniture::models::food::{cutlery, fruit, green_skin, orange_skin, red_skin};
use dwell_furniture::models::gadgets::remote_control;
use dwell_furniture::models::lamps::{candle, drum, floor_lamp, linen_shade, pendant, table_lamp};
use dwell_furniture::models::openings::{light_switch, radiator};
use dwell_furniture::models::plants::{Plant, deep_green, sansevieria, vase};
use dwell_furniture::models::radio::loudspeaker;
use dwell_furniture::models::seats::pouf;
use dwell_furniture::models::sofa::Sofa;
use dwell_furniture::models::table::{Table, side_table};
use dwell_furniture::models::television::television;
use dwell_furniture::models::textiles::{Curtains, folded_blanket, pillow, rug};
use dwell_furniture::models::tv_stand::Lowboard;
use dwell_scene::random::Key;

/// Faces of the room's walls, m.
const WEST: f32 = 4.3;
const EAST: f32 = 11.0;
const SOUTH: f32 = 9.0;
/// South face of the hallway's wall.
const HALL: f32 = 5.3;
/// South face of the kitchen's wall.
const KITCHEN: f32 = 3.8;
/// Middle of the television corner.
const CORNER_Z: f32 = 7.1;

pub(super) fn furnish(site: &mut Site<'_>) {
    television_corner(site);
    bookcases(site);
    dining(site);
    reading_corner(site);
    windows_and_walls(site);
}

fn television_corner(site: &mut Site<'_>) {
    let weave = Finish::picture(
        "patterned_rug",
        "thick_carpet",
        "rug",
        [[150, 52, 44], [36, 52, 84], [222, 196, 150]],
        2,
    );
    let carpet = site.kind(rug(1.7, 1.85, &weave));
    let carpet = site.stand(&carpet, 5.95, CORNER_Z, 90.0);
    let pile = carpet.model.bounds().max.y;

    let stand = site.kind(Lowboard::default().build());
    let stand = site.against(&stand, Side::West, WEST, CORNER_Z, 0.0);
    let set = site.kind(television(1.2));
    site.put(&set, &stand, "top", [0.0, -0.02], 0.0);
    let speaker = site.kind(loudspeaker(0.82));
    site.against(&speaker, Side::West, WEST, CORNER_Z - 1.05, 0.03);
    site.against(&speaker, Side::West, WEST, CORNER_Z + 1.05, 0.03);

    let sofa = site.kind(Sofa::default().build());
    let sofa = site.stand(&sofa, 7.4, CORNER_Z, -90.0);
    let mustard = site.kind(pillow(
        [0.44, 0.15, 0.44],
        &cloth("mustard_cloth", [204, 152, 50]),
    ));
    let cream = site.kind(pillow(
        [0.44, 0.15, 0.44],
        &cloth("cream_cloth", [230, 220, 198]),
    ));
    site.lean(&mustard, &sofa, "seat", -0.62, 68.0);
    site.lean(&cream, &sofa, "seat", -0.12, 68.0);
    site.lean(&mustard, &sofa, "seat", 0.62, 68.0);

    let table = site.kind(Table::coffee(walnut()).build());
    let table = site.stand_at(&table, 5.95, pile, CORNER_Z, 90.0);
    let fruit_bowl = site.kind(bowl(0.14, &porcelain("petrol_glaze", [58, 104, 110])));
    let fruit_bowl = site.put(&fruit_bowl, &table, "top", [-0.2, 0.02], 0.0);
    let apple = site.kind(fruit(0.038, &red_skin()));
    let pear = site.kind(fruit(0.036, &green_skin()));
    site.put(&apple, &fruit_bowl, "inside", [-0.036, 0.006], 0.0);
    site.put(&pear, &fruit_bowl, "inside", [0.04, 0.008], 0.0);
    let remote = site.kind(remote_control());
    site.put(&remote, &table, "top", [0.22, 0.16], 24.0);
    let papers = [cover(0), cover(3), cover(7)];
    let stack = site.kind(magazines([&papers[0], &papers[1], &papers[2]]));
    site.put(&stack, &table, "shelf", [0.18, 0.0], 90.0);
    let novel = site.kind(book([0.14, 0.026, 0.21], 1));
    site.put(&novel, &table, "top", [0.33, -0.1], -12.0);

    let side = site.kind(side_table(0.22, 0.52, &oak()));
    let side = site.stand(&side, 7.45, 5.7, 0.0);
    let lamp = site.kind(table_lamp(
        0.46,
        &porcelain("ochre_glaze", [196, 138, 62]),
        &linen_shade(),
    ));
    site.put(&lamp, &side, "top", [0.0, 0.0], 0.0);

    let chair = site.kind(Sofa::armchair(upholstery("rust_cloth", [176, 88, 56])).build());
    let chair = site.stand(&chair, 5.75, 8.4, 172.0);
    let throw = site.kind(folded_blanket(
        0.36,
        0.3,
        &cloth("cream_wool", [232, 222, 202]),
    ));
    site.put(&throw, &chair, "seat", [0.0, 0.02], 4.0);
    let light = site.kind(floor_lamp(1.62, &linen_shade()));
    site.stand(&light, 7.3, 8.55, 0.0);
    let footstool = site.kind(pouf(0.24, 0.4, &cloth("mustard_knit", [204, 152, 50])));
    site.stand(&footstool, 5.05, 5.95, 0.0);
}

fn bookcases(site: &mut Site<'_>) {
    let case = site.kind(
        Bookshelf {
            width_m: 0.85,
            ..Bookshelf::default()
        }
        .build(),
    );
    let left = site.against(&case, Side::North, HALL, 5.02, 0.0);
    let right = site.against(&case, Side::North, HALL, 5.9, 0.0);
    // Rows of books with gaps for ornaments: bookcase, shelf, width, place.
    let rows: [(&Placed, usize, f32, f32); 9] = [
        (&left, 0, 0.7, -0.03),
        (&left, 1, 0.5, -0.14),
        (&left, 2, 0.76, 0.0),
        (&left, 3, 0.42, 0.17),
        (&left, 4, 0.62, -0.08),
        (&right, 0, 0.74, 0.0),
        (&right, 1, 0.44, 0.17),
        (&right, 3, 0.6, -0.09),
        (&right, 4, 0.38, 0.2),
    ];
    for (k, (shelf, level, width, dx)) in rows.into_iter().enumerate() {
        let row = site.kind(book_row(
            width,
            0.27,
            Key::root(7).child("books").child(k as u64),
        ));
        site.put(&row, shelf, SHELVES[level], [dx, -0.02], 0.0);
    }
    let rings = site.kind(sculpture(&marble()));
    site.put(&rings, &left, SHELVES[3], [-0.22, 0.02], 0.0);
    let jug = site.kind(vase(0.24, &porcelain("chalk_glaze", [226, 220, 208]), None));
    site.put(&jug, &right, SHELVES[2], [-0.22, 0.0], 0.0);
    let green = Plant {
        height_m: 0.27,
        pot_m: 0.07,
        leaf_m: [0.1, 0.04],
        leaves: 12,
        stem_m: 0.0,
        pot: porcelain("white_pot", [236, 234, 228]),
        leaf: deep_green(),
        key: Key::root(3).child("shelf_plant"),
    };
    let green = site.kind(green.build());
    site.put(&green, &right, SHELVES[2], [0.18, 0.02], 0.0);
    let flat = site.kind(book([0.17, 0.035, 0.24], 4));
    site.put(&flat, &left, SHELVES[1], [0.26, 0.0], 90.0);
}

fn dining(site: &mut Site<'_>) {
    let (x, z) = (9.75, 5.6);
    let table = site.kind(Table::default().build());
    let table = site.stand(&table, x, z, 90.0);
    let chair = site.kind(Chair::default().build());
    let pairs = [(-1.0_f32, 90.0), (1.0, -90.0)];
    for (side, yaw_deg) in pairs {
        for dz in [-0.4, 0.4] {
            site.stand(&chair, x + side * 0.62, z + dz, yaw_deg);
        }
    }
    // One place is laid for each chair.
    let dish = site.kind(plate(0.13, &white_glaze()));
    let glass = site.kind(tumbler());
    let [knife, fork] = ["knife", "fork"].map(|name| site.kind(cutlery(name)));
    for side in [-1.0_f32, 1.0] {
        for along in [-0.4_f32, 0.4] {
            // In the table's directions: x runs along it.
            let turn = if side > 0.0 { 0.0 } else { 180.0 };
            site.put(&dish, &table, "top", [along, side * 0.26], turn);
            site.put(
                &fork,
                &table,
                "top",
                [along - side * 0.17, side * 0.26],
                turn,
            );
            site.put(
                &knife,
                &table,
                "top",
                [along + side * 0.17, side * 0.26],
                turn,
            );
            site.put(
                &glass,
                &table,
                "top",
                [along + side * 0.16, side * 0.08],
                turn,
            );
        }
    }
    let flowers = Finish::plain("pink_petals", "leaves", [222, 112, 140]);
    let bunch = site.kind(vase(
        0.2,
        &porcelain("blue_glaze", [84, 120, 168]),
        Some(&flowers),
    ));
    site.put(&bunch, &table, "top", [0.0, 0.0], 0.0);
    let light = site.kind(candle(0.14));
    site.put(&light, &table, "top", [0.68, 0.0], 0.0);
    site.put(&light, &table, "top", [-0.68, 0.0], 0.0);
    let shade = painted_steel("petrol_steel", [46, 88, 96]);
    let lamp = site.kind(pendant(0.95, 0.2, &shade, 9.0));
    site.ceiling(&lamp, x, z - 0.4, 0.0);
    site.ceiling(&lamp, x, z + 0.4, 0.0);

    let board = Lowboard {
        name: "sideboard",
        category: "wardrobe_cabinet",
        width_m: 1.4,
        height_m: 0.8,
        wood: walnut(),
        front: Front::plain(walnut(), black()),
        ..Lowboard::default()
    };
    let board = site.kind(board.build());
    let board = site.against(&board, Side::North, KITCHEN, 9.38, 0.0);
    let lamp = site.kind(table_lamp(
        0.5,
        &porcelain("chalk_glaze", [226, 220, 208]),
        &linen_shade(),
    ));
    site.put(&lamp, &board, "top", [0.46, 0.0], 0.0);
    let dish = site.kind(bowl(0.17, &porcelain("ochre_glaze", [196, 138, 62])));
    let dish = site.put(&dish, &board, "top", [-0.1, 0.0], 0.0);
    let orange = site.kind(fruit(0.042, &orange_skin()));
    site.put(&orange, &dish, "inside", [-0.044, 0.0], 0.0);
    site.put(&orange, &dish, "inside", [0.044, 0.006], 0.0);
    let jug = site.kind(vase(0.3, &porcelain("petrol_glaze", [58, 104, 110]), None));
    site.put(&jug, &board, "top", [-0.55, -0.03], 0.0);
    let image = Finish::picture(
        "landscape",
        "paper",
        "landscape",
        [[120, 168, 206], [70, 110, 84], [250, 214, 120]],
        4,
    );
    let painting = site.kind(picture(1.1, 0.75, &oak(), &image));
    site.hang(&painting, Side::North, KITCHEN, 9.38, 1.65);
}

fn reading_corner(site: &mut Site<'_>) {
    let chair = site.kind(Sofa::armchair(upholstery("moss_cloth", [104, 118, 78])).build());
    let chair = site.stand(&chair, 10.2, 8.2, -135.0);
    let cushion = site.kind(pillow(
        [0.4, 0.14, 0.4],
        &cloth("cream_cloth", [230, 220, 198]),
    ));
    site.lean(&cushion, &chair, "seat", 0.0, 68.0);
    let light = site.kind(floor_lamp(1.55, &lampshade("white_shade", [244, 240, 230])));
    site.stand(&light, 9.3, 8.6, 0.0);
    let side = site.kind(side_table(0.2, 0.48, &walnut()));
    let side = site.stand(&side, 10.55, 7.3, 0.0);
    let novel = site.kind(book([0.15, 0.03, 0.22], 5));
    site.put(&novel, &side, "top", [0.02, 0.0], 30.0);
    let tall = Plant {
        height_m: 1.75,
        pot_m: 0.2,
        leaf_m: [0.4, 0.17],
        leaves: 17,
        stem_m: 0.35,
        pot: terracotta(),
        leaf: deep_green(),
        key: Key::root(3).child("tall_plant"),
    };
    let tall = site.kind(tall.build());
    site.stand(&tall, 10.56, 4.28, 0.0);
    let blades = site.kind(sansevieria(0.85, &porcelain("white_pot", [236, 234, 228])));
    site.stand(&blades, 8.35, 8.7, 40.0);
}

fn windows_and_walls(site: &mut Site<'_>) {
    let drapes = Curtains {
        width_m: 2.5,
        height_m: 2.3,
        drawn: 0.17,
        cloth: Finish {
            substance: "heavy_curtain",
            ..cloth("linen_curtain", [206, 190, 160])
        },
    };
    let drapes = site.kind(drapes.build());
    site.hang(&drapes, Side::South, SOUTH, 6.0, 2.36);
    site.hang(&drapes, Side::South, SOUTH, 9.2, 2.36);
    let narrow = Curtains {
        width_m: 2.0,
        height_m: 2.3,
        drawn: 0.17,
        cloth: Finish {
            substance: "heavy_curtain",
            ..cloth("linen_curtain", [206, 190, 160])
        },
    };
    let narrow = site.kind(narrow.build());
    site.hang(&narrow, Side::East, EAST, 7.4, 2.36);
    let heat = site.kind(radiator(1.3, 0.5));
    site.hang(&heat, Side::South, SOUTH, 9.2, 0.12);
    let images = [
        Finish::picture(
            "print",
            "paper",
            "shapes",
            [[206, 96, 62], [60, 96, 120], [226, 178, 84]],
            1,
        ),
        Finish::picture(
            "print",
            "paper",
            "shapes",
            [[70, 104, 92], [214, 150, 110], [44, 60, 88]],
            2,
        ),
    ];
    for (k, image) in images.iter().enumerate() {
        let print = site.kind(picture(0.5, 0.66, &walnut(), image));
        site.hang(&print, Side::East, EAST, 5.1 + 0.8 * k as f32, 1.6);
    }
    let switch = site.kind(light_switch());
    site.hang(&switch, Side::West, 6.5, 5.1, 1.1);
    let lamp = site.kind(drum(0.35, 0.3, &linen_shade(), 16.0));
    site.ceiling(&lamp, 6.3, CORNER_Z, 0.0);
}
