//! The list of what a generated house may hold. A new piece of furniture is one function in `models` and one line here.

use super::entries::{bath, kitchen, living, sleeping, small, walls};
use super::model::Model;
use super::models::{
    bath_more, beds, chairs, devices, hobby, machines, music, outdoor, recreation, room_parts,
    storage, tables, tableware, wear,
};
use super::style::Style;
use dwell_scene::random::RandomKey;

/// A way to make one kind of thing.
pub struct CatalogueEntry {
    /// What furnishing rules ask for: `"dining_chair"`. Several entries of one kind are looks of it.
    pub kind: &'static str,
    /// A row of `assets/categories.csv`; the model's.
    pub category: &'static str,
    /// The names of the styles that it suits; empty: all.
    pub styles: &'static [&'static str],
    /// How many there are in one style: sizes and colours drawn anew.
    pub variants: u64,
    /// Makes one, its size and colours drawn from the key.
    pub build: fn(&Style, RandomKey) -> Model,
}

/// Variants of most entries in one style.
const VARIANTS: u64 = 3;
/// Variants of what people choose for being unlike others: pictures.
const MANY: u64 = 16;

const fn entry(
    kind: &'static str,
    category: &'static str,
    build: fn(&Style, RandomKey) -> Model,
) -> CatalogueEntry {
    CatalogueEntry {
        kind,
        category,
        styles: &[],
        variants: VARIANTS,
        build,
    }
}

impl CatalogueEntry {
    /// The same entry in many variants.
    const fn many(mut self) -> Self {
        self.variants = MANY;
        self
    }

    /// Returns whether it may stand in a house of this style.
    pub fn suits(&self, style: &Style) -> bool {
        self.styles.is_empty() || self.styles.contains(&style.name)
    }
}

/// The entries of a kind that suit a style, with their places in the list.
pub fn entries_of(kind: &str, style: &Style) -> Vec<(usize, &'static CatalogueEntry)> {
    let all = entries().iter().enumerate();
    all.filter(|(_, entry)| entry.kind == kind && entry.suits(style))
        .collect()
}

/// All entries.
pub fn entries() -> &'static [CatalogueEntry] {
    static ALL: &[CatalogueEntry] = &[
        // Seats.
        entry("sofa", "sofa", living::sofa),
        entry("armchair", "armchair", living::armchair),
        entry("dining_chair", "chair", chairs::dining_chair),
        entry("office_chair", "office_chair", living::office_chair),
        entry("stool", "stool", living::stool),
        entry("bar_stool", "stool", chairs::bar_stool),
        entry("ottoman", "ottoman", living::ottoman),
        entry("bench", "bench_chair", chairs::bench),
        entry("shoe_bench", "bench_chair", living::shoe_bench),
        entry("storage_bench", "storage_bench", storage::storage_bench),
        // Tables.
        entry("dining_table", "dining_table", tables::dining_table),
        entry("coffee_table", "coffee_table", tables::coffee_table),
        entry("side_table", "table", tables::side_table),
        entry("console_table", "table", tables::console_table),
        entry("desk", "desk", living::desk),
        entry("dressing_table", "dressing_table", tables::dressing_table),
        entry("nightstand", "stand", sleeping::nightstand),
        entry("home_bar", "drinkbar", tables::home_bar),
        entry("serving_cart", "cart", storage::cart),
        entry("pool_table", "game_table", recreation::pool_table),
        // Cupboards and shelves.
        entry("wardrobe", "wardrobe_cabinet", sleeping::wardrobe),
        entry("sideboard", "wardrobe_cabinet", living::sideboard),
        entry("dresser", "dresser", living::dresser),
        entry("tv_stand", "tv_stand", living::tv_stand),
        entry("bookshelf", "bookshelf", living::bookshelf),
        entry("cube_shelf", "shelving", storage::cube_shelf),
        entry("metal_rack", "shelving", storage::metal_rack),
        entry("wall_shelf", "shelving", walls::wall_shelf),
        entry("shoe_cabinet", "shoes_cabinet", storage::shoe_cabinet),
        entry("coat_rack", "hanger", living::coat_rack),
        entry("safe", "safe", storage::safe),
        // Beds.
        entry("double_bed", "double_bed", sleeping::double_bed),
        entry("single_bed", "single_bed", sleeping::single_bed),
        entry("bunk_bed", "bunker_bed", beds::bunk_bed),
        entry("cot", "baby_bed", beds::cot),
        entry("mattress", "mattress", beds::mattress),
        entry("pillow", "pillow", sleeping::pillow),
        entry("cushion", "pillow", sleeping::cushion),
        entry("folded_blanket", "blanket", sleeping::folded_blanket),
        // Fitted kitchens.
        entry("sink_unit", "kitchen_set", kitchen::sink_unit),
        entry("sink_unit_2", "kitchen_set", kitchen::sink_unit_2),
        entry("sink_unit_3", "kitchen_set", kitchen::sink_unit_3),
        entry("base_unit_1", "kitchen_set", kitchen::base_unit_1),
        entry("base_unit_2", "kitchen_set", kitchen::base_unit_2),
        entry(
            "wall_cabinet",
            "hanging_kitchen_cabinet",
            kitchen::wall_cabinet,
        ),
        entry(
            "wall_cabinet_2",
            "hanging_kitchen_cabinet",
            kitchen::wall_cabinet_2,
        ),
        entry(
            "wall_cabinet_3",
            "hanging_kitchen_cabinet",
            kitchen::wall_cabinet_3,
        ),
        entry("larder", "kitchen_cabinet", storage::larder),
        entry("cooker", "cooker", kitchen::stove),
        entry("range_hood", "range_hood", kitchen::range_hood),
        entry("refrigerator", "refrigerator", kitchen::refrigerator),
        entry("dishwasher", "dishwasher", machines::dishwasher),
        entry("mixer_tap", "tap", kitchen::mixer_tap),
        // Machines of the household.
        entry("microwave", "microwave", kitchen::microwave),
        entry("kettle", "kettle", kitchen::kettle),
        entry("toaster", "toaster", kitchen::toaster),
        entry("coffee_machine", "coffee_machine", kitchen::coffee_machine),
        entry("blender", "food_processor", devices::blender),
        entry("washer", "washer", kitchen::washer),
        entry("dryer", "dryer", machines::dryer),
        entry(
            "water_dispenser",
            "water_dispenser",
            machines::water_dispenser,
        ),
        entry(
            "air_conditioner",
            "air_conditioner",
            machines::air_conditioner,
        ),
        entry("pedestal_fan", "fan", machines::pedestal_fan),
        entry("ceiling_fan", "fan", machines::ceiling_fan),
        entry("vacuum_cleaner", "vacuum_cleaner", machines::vacuum_cleaner),
        entry("iron", "iron", devices::iron),
        entry("ironing_board", "ironing_board", hobby::ironing_board),
        entry("hair_dryer", "hair_dryer", devices::hair_dryer),
        entry("radiator", "heater", walls::radiator),
        entry("light_switch", "switch", walls::light_switch),
        // Bathrooms.
        entry("bathtub", "bathtub", bath::bathtub),
        entry("shower_cabin", "shower", bath_more::shower_cabin),
        entry("shower_head", "shower", bath::shower_head),
        entry("shower_screen", "shower", bath::shower_screen),
        entry("washbasin", "sink", bath::washbasin),
        entry("hand_basin", "sink", bath::hand_basin),
        entry("basin", "sink", bath_more::basin),
        entry("toilet", "toilet", bath::water_closet),
        entry("paper_holder", "toilet_paper", bath::paper_holder),
        entry("toilet_roll", "toilet_paper", bath_more::toilet_roll),
        entry("toilet_brush", "toiletries", bath_more::toilet_brush),
        entry("plunger", "toilet_plunger", bath_more::plunger),
        entry("towel_rail", "towel_rack", bath::towel_rail),
        entry("folded_towel", "towel", bath::folded_towel),
        entry("bath_mat", "rug", bath::bath_mat),
        entry("scale", "weight_scale", bath::scale),
        entry("laundry_basket", "basket", bath::laundry_basket),
        entry("waste_bin", "trash_can", bath::waste_bin),
        entry("soap_dispenser", "soap_dispenser", bath::soap_dispenser),
        entry("soap_dish", "soap_dish", bath_more::soap_dish),
        entry("toothbrushes", "toiletries", bath::toothbrushes),
        entry("shampoo", "toiletries", bath_more::shampoo),
        // Lamps.
        entry("ceiling_lamp", "chandelier", walls::ceiling_lamp),
        entry("drum_lamp", "chandelier", walls::drum_lamp),
        entry("pendant", "chandelier", walls::pendant),
        entry("chandelier", "chandelier", room_parts::chandelier),
        entry("floor_lamp", "floor_lamp", living::floor_lamp),
        entry("table_lamp", "table_lamp", living::table_lamp),
        entry("desk_lamp", "table_lamp", living::desk_lamp),
        entry("night_light", "table_lamp", small::night_light),
        entry("wall_lamp", "wall_lamp", room_parts::wall_lamp),
        entry("mirror_lamp", "wall_lamp", walls::mirror_lamp),
        entry("candle", "candle", small::candle),
        // Walls, windows and floors.
        entry("fireplace", "fireplace", room_parts::fireplace),
        entry("room_divider", "partition", room_parts::room_divider),
        entry("curtains", "curtain", walls::curtains),
        entry("blind", "blinds", room_parts::blind),
        entry("wall_mirror", "mirror", bath::wall_mirror),
        entry("picture", "picture_frame", walls::picture).many(),
        entry("poster", "picture_frame", walls::poster).many(),
        entry("whiteboard", "whiteboard", hobby::whiteboard),
        entry("wall_clock", "clock", walls::wall_clock),
        entry("rug", "rug", living::rug),
        entry("round_rug", "rug", living::round_rug),
        // Electronics.
        entry("television", "television", living::television),
        entry("loudspeaker", "loudspeaker", living::loudspeaker),
        entry("stereo", "stereo_set", devices::stereo),
        entry("radio", "radio", small::wireless),
        entry("computer", "computer", devices::computer),
        entry("computer_tower", "computer", devices::computer_tower),
        entry("laptop", "laptop", small::laptop),
        entry("tablet", "tablet", devices::tablet),
        entry("cellphone", "cellphone", devices::cellphone),
        entry("telephone", "telephone", small::telephone),
        entry(
            "remote_control",
            "household_appliance",
            small::remote_control,
        ),
        entry("game_console", "game_console", devices::game_console),
        entry("headphones", "headphones", devices::headphones),
        entry("camera", "camera", devices::camera),
        entry("tripod", "tripod", hobby::tripod),
        entry("alarm_clock", "clock", small::alarm_clock),
        // Leisure.
        entry("piano", "piano", music::piano),
        entry("keyboard", "keyboard", music::keyboard),
        entry("guitar", "guitar", music::guitar),
        entry("drum_kit", "drumset", music::drum_kit),
        entry("chessboard", "chessboard", hobby::chessboard),
        entry("aquarium", "fish_tank", recreation::aquarium),
        entry("treadmill", "gym_equipment", machines::treadmill),
        entry("weight_bench", "gym_equipment", hobby::weight_bench),
        entry("bicycle", "bicycle", hobby::bicycle),
        entry("helmet", "helmet", wear::helmet),
        entry("ladder", "ladder", hobby::ladder),
        entry("teddy_bear", "toy", small::teddy_bear),
        entry("toy_train", "toy", small::toy_train),
        entry("toy_block", "toy", small::toy_block),
        entry("toy_ball", "ball", small::toy_ball),
        // Outdoors.
        entry("garden_chair", "outdoor_seating", chairs::garden_chair),
        entry("garden_swing", "swing", chairs::garden_swing),
        entry("garden_table", "table", outdoor::garden_table),
        entry("parasol", "umbrella", outdoor::parasol),
        entry("grill", "grill", outdoor::grill),
        entry("garden_lamp", "outdoor_lamp", outdoor::garden_lamp),
        entry("lawn_mower", "lawn_mower", outdoor::lawn_mower),
        entry("letter_box", "mailbox", outdoor::letter_box),
        // Crockery and food.
        entry("mug", "cup", kitchen::mug),
        entry("plate", "plate", kitchen::plate),
        entry("bowl", "bowl", kitchen::bowl),
        entry("tumbler", "drinking_glass", kitchen::tumbler),
        entry("wine_glass", "drinking_glass", tableware::wine_glass),
        entry("bottle", "bottle", kitchen::bottle),
        entry("beer", "beer", tableware::beer),
        entry("jug", "jug", tableware::jug),
        entry("teapot", "teapot", tableware::teapot),
        entry("jar", "containers", kitchen::jar),
        entry("clip_jar", "containers", tableware::clip_jar),
        entry("pot", "pot", kitchen::pot),
        entry("pan", "pan", kitchen::pan),
        entry("utensils", "utensil_holder", kitchen::utensils),
        entry("knife_block", "knife_rack", kitchen::knife_block),
        entry("cutting_board", "cutting_board", kitchen::cutting_board),
        entry("knife", "knife", kitchen::knife),
        entry("fork", "fork", kitchen::fork),
        entry("spoon", "spoon", kitchen::spoon),
        entry("place_setting", "place_setting", tableware::place_setting),
        entry("tray", "food_tray", tableware::tray),
        entry("fruit_bowl", "fruit_bowl", tableware::fruit_bowl),
        entry("fruit", "food", kitchen::fruit),
        entry("bread", "bread", kitchen::bread),
        entry("cake", "cake", tableware::cake),
        // Small things.
        entry("plant", "plant", living::plant),
        entry("snake_plant", "plant", living::snake_plant),
        entry("small_plant", "plant", living::small_plant),
        entry("flowers", "flowers", wear::flowers),
        entry("vase", "vase", small::vase),
        entry("sculpture", "decoration", small::sculpture),
        entry("globe", "decoration", small::globe),
        entry("trinket", "trinket", wear::trinket),
        entry("book", "book", small::book),
        entry("book_row", "books", small::book_row),
        entry("magazines", "magazines", small::magazines),
        entry("papers", "paper", wear::papers),
        entry("pencil_cup", "utensil_holder", small::pencil_cup),
        entry("storage_box", "box", small::storage_box),
        entry("shoes", "shoes", small::shoes),
        entry("folded_clothes", "cloth", wear::folded_clothes),
        entry("handbag", "bag", small::handbag),
        entry("backpack", "bag", wear::backpack),
        entry("umbrella_stand", "umbrella", wear::umbrella_stand),
    ];
    ALL
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::STYLES;
    use crate::tables::category;

    #[test]
    fn every_entry_makes_things_of_its_category_in_every_style_that_it_suits() {
        let mut faults = Vec::new();
        for style in STYLES {
            for entry in entries() {
                for name in entry.styles {
                    let known = STYLES.iter().any(|style| style.name == *name);
                    assert!(known, "{}: no style {name}", entry.kind);
                }
                if !entry.suits(style) {
                    continue;
                }
                let model = (entry.build)(style, RandomKey::root(3).child(entry.kind));
                let at = format!("{} ({}) in {}", entry.kind, model.name, style.name);
                let row = category([entry.category]);
                if row.is_none_or(|row| row.name != entry.category) {
                    faults.push(format!("{at}: {} is no category", entry.category));
                }
                if model.category != entry.category || model.parts.is_empty() {
                    faults.push(format!("{at}: {}", model.category));
                }
            }
        }
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }

    #[test]
    fn every_kind_is_to_be_had_in_every_style() {
        for style in STYLES {
            for entry in entries() {
                assert!(
                    !entries_of(entry.kind, style).is_empty(),
                    "{} in {}",
                    entry.kind,
                    style.name
                );
            }
        }
    }
}
