//! The bathroom.

use crate::building::site::{Side, Site};
use dwell_furniture::finish::{Finish, beech, white_lacquer};
use dwell_furniture::finish::{lacquer, plastic, terry};
use dwell_furniture::models::appliances::washer;
use dwell_furniture::models::bath::{bathtub, shower_head, shower_screen, washbasin};
use dwell_furniture::models::bath_things::{
    bath_mat, folded_towel, laundry_basket, paper_holder, pedal_bin, scale, soap_dispenser,
    toothbrushes, towel_rail, wall_mirror,
};
use dwell_furniture::models::crockery::bottle;
use dwell_furniture::models::lamps::{ceiling_dome, mirror_lamp};
use dwell_furniture::models::openings::light_switch;
use dwell_furniture::models::seats::stool;
use dwell_furniture::models::taps::mixer_tap;
use dwell_furniture::models::toilet::toilet;

const NORTH: f32 = 0.0;
const WEST: f32 = 4.1;
const EAST: f32 = 6.4;
const SOUTH: f32 = 3.7;

pub(super) fn furnish(site: &mut Site<'_>) {
    let tub = site.kind(bathtub(1.68, 0.75, true));
    let tub = site.against(&tub, Side::North, NORTH, WEST + 0.845, 0.0);
    let tap = site.kind(mixer_tap(0.16, 0.14));
    site.mount(&tap, &tub, [-0.795, 0.57, 0.0], 90.0);
    let screen = site.kind(shower_screen(0.72, 1.4));
    site.hang(&screen, Side::West, WEST, 0.705, 0.5715);
    let head = site.kind(shower_head());
    site.hang(&head, Side::North, NORTH, 4.4, 0.78);
    let machine = site.kind(washer());
    let machine = site.against(&machine, Side::North, NORTH, 6.095, 0.0);
    let towel = site.kind(folded_towel(&terry("aqua_terry", [126, 172, 178])));
    site.put(&towel, &machine, "top", [0.02, 0.0], 0.0);

    let basin = site.kind(washbasin(0.85));
    let basin = site.against(&basin, Side::West, WEST, 1.95, 0.0);
    let tap = site.kind(mixer_tap(0.15, 0.13));
    site.mount(&tap, &basin, [0.0, 0.86, -0.17], 0.0);
    let soap = site.kind(soap_dispenser(&plastic("white_plastic", [240, 240, 236])));
    site.put(&soap, &basin, "back_right", [0.05, 0.01], 0.0);
    let brushes = site.kind(toothbrushes());
    site.put(&brushes, &basin, "back_left", [-0.05, 0.005], 0.0);
    let glass = site.kind(wall_mirror(
        0.75,
        0.8,
        &lacquer("black_lacquer", [38, 38, 40]),
    ));
    site.hang(&glass, Side::West, WEST, 1.95, 1.5);
    let light = site.kind(mirror_lamp(0.55));
    site.hang(&light, Side::West, WEST, 1.95, 2.04);

    let bowl = site.kind(toilet());
    site.against(&bowl, Side::East, EAST, 1.5, 0.0);
    let paper = site.kind(paper_holder());
    site.hang(&paper, Side::East, EAST, 2.05, 0.72);
    let bin = site.kind(pedal_bin(0.3, &white_lacquer()));
    site.stand(&bin, 6.22, 1.03, -90.0);

    let rail = site.kind(towel_rail(0.6, &terry("coral_terry", [222, 128, 108])));
    site.hang(&rail, Side::West, WEST, 2.95, 1.25);
    let wash = site.kind(laundry_basket());
    site.stand(&wash, 4.42, 3.4, 0.0);
    let seat = site.kind(stool(0.45, &beech(), &beech()));
    let seat = site.stand(&seat, 4.42, 1.14, 0.0);
    let blue = Finish::plain("blue_bottle", "plastic", [70, 130, 190]);
    let shampoo = site.kind(bottle(
        0.2,
        &blue,
        &Finish::plain("white_label", "paper", [240, 240, 236]),
        &plastic("white_plastic", [240, 240, 236]),
    ));
    site.put(&shampoo, &seat, "seat", [0.0, 0.0], 0.0);
    let mat = site.kind(bath_mat(0.8, 0.5));
    site.stand(&mat, 5.1, 1.1, 0.0);
    let weigh = site.kind(scale());
    site.stand(&weigh, 4.95, 2.8, 0.0);
    let dome = site.kind(ceiling_dome(0.2, 12.0));
    site.ceiling(&dome, 5.25, 2.0, 0.0);
    let switch = site.kind(light_switch());
    site.hang(&switch, Side::South, SOUTH, 5.0, 1.1);
}
