//! Parametric models of household things, one file for each or for few of a kind.
//!
//! A file holds the model, a function or a struct of sizes and finishes that gives a [`Model`](super::model::Model); the
//! function that draws these at random, from a style and a key; and `ENTRIES`, what the catalogue lists of it. Where both are
//! functions, the one that draws is called `sample_...`. What houses build to their own measure is public: doors, windows,
//! stairs, curtains, radiators.

mod aquarium;
mod audio_devices;
mod bags;
mod bathroom_scale;
mod bathtub;
mod bedding;
mod beds;
mod benches;
mod bicycle;
mod bins_and_boxes;
mod books;
mod bunk_bed;
mod cabinet_parts;
mod camera_and_tripod;
mod candles_and_night_lights;
mod casings;
mod ceiling_lamps;
mod chessboard;
mod cleaning_and_ironing;
mod clocks;
mod clothes;
mod coat_rack_and_umbrella_stand;
mod coffee_tables;
mod computers;
mod cooker_and_hood;
mod cookware;
mod cot;
mod crockery;
mod cupboards;
pub mod curtains_and_blinds;
mod cutlery;
mod desks;
mod dining_chairs;
mod dining_tables;
mod dishwasher;
pub mod doors;
mod dresser;
mod dressing_table;
mod drum_kit;
mod fireplace;
mod flowers_and_vases;
mod food;
mod four_legged_table;
mod game_console;
mod garden_lamp;
mod garden_seats;
mod garden_table_and_parasol;
mod glasses_and_bottles;
mod grill;
mod guitar;
mod gym_equipment;
pub mod heating_and_cooling;
mod home_bar_and_cart;
mod jars;
mod kitchen_appliances;
mod kitchen_units;
mod kitchen_wall_cabinets;
mod ladder;
mod lampshades;
mod lawn_mower;
mod letter_box;
mod light_switch;
mod lowboards;
mod nightstand;
mod office_chair;
mod office_supplies;
mod ornaments;
mod phones_and_tablets;
mod piano_and_keyboard;
mod pictures_and_mirrors;
mod plants;
mod pool_table;
mod refrigerator;
mod room_divider;
mod rugs;
mod shelves;
mod showers;
mod side_tables;
mod sofas;
pub mod stairs;
mod standing_lamps;
mod stools;
mod taps;
mod television;
mod toilet;
mod toilet_accessories;
mod toiletries;
mod towels;
mod toys;
mod trays_and_place_settings;
mod wall_lamps;
mod wardrobe;
mod washbasins;
mod washer_and_dryer;
mod water_dispenser;
pub mod windows;

use super::catalogue_entry::CatalogueEntry;

/// The entries of the catalogue, by file: a file with a new model is one line here. The order is of no consequence.
pub(crate) const ENTRIES: &[&[CatalogueEntry]] = &[
    aquarium::ENTRIES,
    audio_devices::ENTRIES,
    bags::ENTRIES,
    bathroom_scale::ENTRIES,
    bathtub::ENTRIES,
    bedding::ENTRIES,
    beds::ENTRIES,
    benches::ENTRIES,
    bicycle::ENTRIES,
    bins_and_boxes::ENTRIES,
    books::ENTRIES,
    bunk_bed::ENTRIES,
    camera_and_tripod::ENTRIES,
    candles_and_night_lights::ENTRIES,
    ceiling_lamps::ENTRIES,
    chessboard::ENTRIES,
    cleaning_and_ironing::ENTRIES,
    clocks::ENTRIES,
    clothes::ENTRIES,
    coat_rack_and_umbrella_stand::ENTRIES,
    coffee_tables::ENTRIES,
    computers::ENTRIES,
    cooker_and_hood::ENTRIES,
    cookware::ENTRIES,
    cot::ENTRIES,
    crockery::ENTRIES,
    cupboards::ENTRIES,
    curtains_and_blinds::ENTRIES,
    cutlery::ENTRIES,
    desks::ENTRIES,
    dining_chairs::ENTRIES,
    dining_tables::ENTRIES,
    dishwasher::ENTRIES,
    dresser::ENTRIES,
    dressing_table::ENTRIES,
    drum_kit::ENTRIES,
    fireplace::ENTRIES,
    flowers_and_vases::ENTRIES,
    food::ENTRIES,
    game_console::ENTRIES,
    garden_lamp::ENTRIES,
    garden_seats::ENTRIES,
    garden_table_and_parasol::ENTRIES,
    glasses_and_bottles::ENTRIES,
    grill::ENTRIES,
    guitar::ENTRIES,
    gym_equipment::ENTRIES,
    heating_and_cooling::ENTRIES,
    home_bar_and_cart::ENTRIES,
    jars::ENTRIES,
    kitchen_appliances::ENTRIES,
    kitchen_units::ENTRIES,
    kitchen_wall_cabinets::ENTRIES,
    ladder::ENTRIES,
    lawn_mower::ENTRIES,
    letter_box::ENTRIES,
    light_switch::ENTRIES,
    lowboards::ENTRIES,
    nightstand::ENTRIES,
    office_chair::ENTRIES,
    office_supplies::ENTRIES,
    ornaments::ENTRIES,
    phones_and_tablets::ENTRIES,
    piano_and_keyboard::ENTRIES,
    pictures_and_mirrors::ENTRIES,
    plants::ENTRIES,
    pool_table::ENTRIES,
    refrigerator::ENTRIES,
    room_divider::ENTRIES,
    rugs::ENTRIES,
    shelves::ENTRIES,
    showers::ENTRIES,
    side_tables::ENTRIES,
    sofas::ENTRIES,
    standing_lamps::ENTRIES,
    stools::ENTRIES,
    taps::ENTRIES,
    television::ENTRIES,
    toilet::ENTRIES,
    toilet_accessories::ENTRIES,
    toiletries::ENTRIES,
    towels::ENTRIES,
    toys::ENTRIES,
    trays_and_place_settings::ENTRIES,
    wall_lamps::ENTRIES,
    wardrobe::ENTRIES,
    washbasins::ENTRIES,
    washer_and_dryer::ENTRIES,
    water_dispenser::ENTRIES,
];
