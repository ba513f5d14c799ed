//! The list of what a generated house may hold. A new piece of furniture is one file in `models` and one line here.

use super::finish::{Finish, glass, paper, plastic, steel};
use super::model::Model;
use super::models::{
    appliances, bath, bath_things, bed, bookshelf, chair, cooker, crockery, decoration, desk,
    dresser, food, fridge, gadgets, lamps, nightstand, plants, radio, seats, sofa, table, taps,
    television, textiles, toilet, tv_stand, wardrobe,
};
use super::style::Style;
use dwell_scene::random::{Key, Stream};

/// A way to make one kind of thing.
pub(crate) struct Entry {
    /// What furnishing rules ask for: `"dining_chair"`. Several entries of one kind are looks of it.
    pub(crate) kind: &'static str,
    /// A row of `assets/categories.csv`; the model's.
    pub(crate) category: &'static str,
    /// The names of the styles that it suits; empty: all.
    pub(crate) styles: &'static [&'static str],
    /// Makes one, its size and colours drawn from the key.
    pub(crate) build: fn(&Style, Key) -> Model,
}

const fn entry(
    kind: &'static str,
    category: &'static str,
    build: fn(&Style, Key) -> Model,
) -> Entry {
    Entry {
        kind,
        category,
        styles: &[],
        build,
    }
}

/// The entries of a kind that suit a style.
pub(crate) fn entries_of(kind: &str, style: &Style) -> Vec<&'static Entry> {
    let suits = |entry: &Entry| entry.styles.is_empty() || entry.styles.contains(&style.name);
    let all = entries().iter();
    all.filter(|entry| entry.kind == kind && suits(entry))
        .collect()
}

/// One of `sizes`.
fn one<T: Copy, const N: usize>(stream: &mut Stream, sizes: [T; N]) -> T {
    sizes[stream.below(N)]
}

/// All entries.
pub(crate) fn entries() -> &'static [Entry] {
    const ALL: &[Entry] = &[
        entry("kettle", "kettle", |_, _| appliances::kettle()),
        entry("toaster", "toaster", |_, _| appliances::toaster()),
        entry("coffee_machine", "coffee_machine", |_, _| {
            appliances::coffee_machine()
        }),
        entry("microwave", "microwave", |_, _| appliances::microwave()),
        entry("mixer_tap", "tap", |_, _| taps::mixer_tap(0.2, 0.16)),
        entry("washer", "washer", |_, _| appliances::washer()),
        entry("bathtub", "bathtub", |_, key| {
            bath::bathtub(
                one(&mut key.stream(), [1.6, 1.7, 1.68]),
                one(&mut key.child("depth").stream(), [0.7, 0.75]),
                key.child("tap").stream().below(2) == 0,
            )
        }),
        entry("washbasin", "sink", |_, key| {
            bath::washbasin(key.stream().range(0.6, 0.95))
        }),
        entry("double_bed", "double_bed", |style, key| {
            let mut draw = key.stream();
            let width = one(&mut draw, [1.4, 1.6, 1.8]);
            bed(style, &mut draw, width)
        }),
        entry("single_bed", "single_bed", |style, key| {
            let mut draw = key.stream();
            let width = one(&mut draw, [0.9, 1.0]);
            bed(style, &mut draw, width)
        }),
        entry("bookshelf", "bookshelf", |style, key| {
            let mut draw = key.stream();
            let levels = one(&mut draw, [3, 4, 5, 6]);
            let case = bookshelf::Bookshelf {
                width_m: draw.range(0.7, 1.1),
                height_m: 0.38 * levels as f32 + 0.04,
                levels,
                wood: style.any_wood(&mut draw).clone(),
                ..bookshelf::Bookshelf::default()
            };
            case.build()
        }),
        entry("dining_chair", "chair", |style, key| {
            let mut draw = key.stream();
            let pad = (draw.below(2) == 0).then(|| style.cloth(&mut draw).clone());
            let seat = chair::Chair {
                width_m: draw.range(0.42, 0.48),
                back_m: draw.range(0.84, 0.98),
                slats: 2 + draw.below(3),
                wood: style.any_wood(&mut draw).clone(),
                pad,
                ..chair::Chair::default()
            };
            seat.build()
        }),
        entry("cooker", "cooker", |_, _| cooker::cooker()),
        entry("desk", "desk", |style, key| {
            let mut draw = key.stream();
            let table = desk::Desk {
                width_m: draw.range(1.1, 1.6),
                depth_m: draw.range(0.6, 0.75),
                top: style.wood.clone(),
                body: style.front.clone(),
                ..desk::Desk::default()
            };
            table.build()
        }),
        entry("dresser", "dresser", |style, key| {
            let mut draw = key.stream();
            let chest = dresser::Dresser {
                width_m: draw.range(0.8, 1.3),
                height_m: draw.range(0.75, 0.95),
                wood: style.wood.clone(),
                front: style.front.clone(),
                ..dresser::Dresser::default()
            };
            chest.build()
        }),
        entry("refrigerator", "refrigerator", |_, key| {
            fridge::refrigerator(0.6, key.stream().range(1.5, 1.95), 0.65)
        }),
        entry("floor_lamp", "floor_lamp", |style, key| {
            let mut draw = key.stream();
            lamps::floor_lamp(draw.range(1.45, 1.75), &shade(style, &mut draw))
        }),
        entry("table_lamp", "table_lamp", |style, key| {
            let mut draw = key.stream();
            let base = style.glaze(&mut draw).clone();
            lamps::table_lamp(draw.range(0.36, 0.48), &base, &shade(style, &mut draw))
        }),
        entry("desk_lamp", "table_lamp", |style, _| {
            lamps::desk_lamp(&style.metal)
        }),
        entry("ceiling_lamp", "chandelier", |_, key| {
            lamps::ceiling_dome(key.stream().range(0.16, 0.24), 14.0)
        }),
        entry("drum_lamp", "chandelier", |style, key| {
            let mut draw = key.stream();
            let shade = shade(style, &mut draw);
            lamps::drum(draw.range(0.26, 0.32), draw.range(0.2, 0.28), &shade, 14.0)
        }),
        entry("nightstand", "stand", |style, key| {
            let mut draw = key.stream();
            nightstand::nightstand(
                draw.range(0.38, 0.5),
                draw.range(0.44, 0.54),
                style.any_wood(&mut draw),
            )
        }),
        entry("plant", "plant", |style, key| {
            let mut draw = key.stream();
            let plant = plants::Plant {
                height_m: draw.range(0.7, 1.2),
                pot_m: draw.range(0.13, 0.17),
                leaf_m: [draw.range(0.22, 0.34), draw.range(0.08, 0.14)],
                leaves: 14 + draw.below(8),
                stem_m: draw.range(0.2, 0.4),
                pot: style.glaze(&mut draw).clone(),
                leaf: plants::deep_green(),
                key: key.child("leaves"),
            };
            plant.build()
        }),
        entry("office_chair", "office_chair", |style, key| {
            seats::office_chair(style.cover(&mut key.stream()))
        }),
        entry("stool", "stool", |style, key| {
            let height = key.stream().range(0.42, 0.48);
            seats::stool(height, &style.wood, &style.second_wood)
        }),
        entry("ottoman", "ottoman", |style, key| {
            let mut draw = key.stream();
            seats::pouf(
                draw.range(0.22, 0.28),
                draw.range(0.36, 0.42),
                style.cover(&mut draw),
            )
        }),
        entry("shoe_bench", "bench_chair", |style, key| {
            let mut draw = key.stream();
            seats::shoe_bench(draw.range(0.8, 1.1), &style.wood, style.cloth(&mut draw))
        }),
        entry("sofa", "sofa", |style, key| {
            let mut draw = key.stream();
            let couch = sofa::Sofa {
                seats: 2 + draw.below(2),
                seat_width_m: draw.range(0.58, 0.66),
                depth_m: draw.range(0.86, 0.96),
                cover: style.cover(&mut draw).clone(),
                wood: style.wood.clone(),
                ..sofa::Sofa::default()
            };
            couch.build()
        }),
        entry("armchair", "armchair", |style, key| {
            let cover = style.cover(&mut key.stream()).clone();
            let seat = sofa::Sofa {
                wood: style.wood.clone(),
                ..sofa::Sofa::armchair(cover)
            };
            seat.build()
        }),
        entry("dining_table", "dining_table", |style, key| {
            let mut draw = key.stream();
            let wood = style.wood.clone();
            let board = table::Table {
                size_m: one(&mut draw, [[1.2, 0.8], [1.5, 0.85], [1.7, 0.9]]),
                top: wood.clone(),
                legs: wood,
                ..table::Table::default()
            };
            board.build()
        }),
        entry("coffee_table", "coffee_table", |style, key| {
            let mut draw = key.stream();
            let wood = style.any_wood(&mut draw).clone();
            let board = table::Table {
                size_m: [draw.range(0.9, 1.2), draw.range(0.5, 0.65)],
                ..table::Table::coffee(wood)
            };
            board.build()
        }),
        entry("side_table", "table", |style, key| {
            let mut draw = key.stream();
            table::side_table(
                draw.range(0.2, 0.26),
                draw.range(0.45, 0.55),
                style.any_wood(&mut draw),
            )
        }),
        entry("television", "television", |_, key| {
            television::television(one(&mut key.stream(), [0.97, 1.11, 1.23]))
        }),
        entry("tv_stand", "tv_stand", |style, key| {
            let low = tv_stand::Lowboard {
                width_m: key.stream().range(1.4, 1.9),
                wood: style.wood.clone(),
                front: style.front.clone(),
                ..tv_stand::Lowboard::default()
            };
            low.build()
        }),
        entry("toilet", "toilet", |_, _| toilet::toilet()),
        entry("wardrobe", "wardrobe_cabinet", |style, key| {
            let mut draw = key.stream();
            let doors = one(&mut draw, [2, 3, 4]);
            let closet = wardrobe::Wardrobe {
                width_m: draw.range(0.44, 0.52) * doors as f32,
                height_m: draw.range(1.95, 2.2),
                doors,
                body: style.wood.clone(),
                front: style.front.clone(),
                ..wardrobe::Wardrobe::default()
            };
            closet.build()
        }),
        entry("rug", "rug", |style, key| {
            let mut draw = key.stream();
            let [a, b] = [0, 1].map(|_| style.cloth(&mut draw).srgb);
            let weave = Finish::picture(
                "woven_rug",
                "carpet",
                "rug",
                [a, b, [232, 222, 200]],
                draw.bits(),
            );
            let [width, depth] = one(&mut draw, [[2.0, 1.4], [1.7, 1.2], [2.3, 1.6]]);
            textiles::rug(width, depth, &weave)
        }),
        entry("round_rug", "rug", |style, key| {
            let mut draw = key.stream();
            textiles::round_rug(draw.range(0.5, 0.85), style.terry(&mut draw))
        }),
        entry("bath_mat", "rug", |_, _| bath_things::bath_mat(0.8, 0.5)),
        entry("laundry_basket", "basket", |_, _| {
            bath_things::laundry_basket()
        }),
        entry("waste_bin", "trash_can", |style, key| {
            bath_things::pedal_bin(key.stream().range(0.3, 0.42), &style.metal)
        }),
        entry("scale", "weight_scale", |_, _| bath_things::scale()),
        entry("folded_towel", "towel", |style, key| {
            bath_things::folded_towel(style.terry(&mut key.stream()))
        }),
        entry("soap_dispenser", "soap_dispenser", |_, _| {
            bath_things::soap_dispenser(&plastic("white_plastic", [240, 240, 236]))
        }),
        entry("toothbrushes", "toiletries", |_, _| {
            bath_things::toothbrushes()
        }),
        entry("book", "book", |_, key| {
            let mut draw = key.stream();
            let size = [
                draw.range(0.12, 0.2),
                draw.range(0.015, 0.04),
                draw.range(0.18, 0.27),
            ];
            bookshelf::book(size, draw.below(12))
        }),
        entry("book_row", "books", |_, key| {
            let mut draw = key.stream();
            bookshelf::book_row(
                draw.range(0.25, 0.5),
                draw.range(0.22, 0.27),
                key.child("row"),
            )
        }),
        entry("bottle", "bottle", |_, key| {
            let label = paper("white_label", [240, 240, 236]);
            bottle(key, &label)
        }),
        entry("bowl", "bowl", |style, key| {
            let mut draw = key.stream();
            crockery::bowl(draw.range(0.08, 0.13), style.glaze(&mut draw))
        }),
        entry("jar", "containers", |style, key| {
            let mut draw = key.stream();
            crockery::jar(draw.range(0.14, 0.22), style.glaze(&mut draw), &steel())
        }),
        entry("mug", "cup", |style, key| {
            crockery::mug(style.glaze(&mut key.stream()))
        }),
        entry("plate", "plate", |style, key| {
            let mut draw = key.stream();
            crockery::plate(draw.range(0.11, 0.14), style.glaze(&mut draw))
        }),
        entry("pan", "pan", |_, key| {
            crockery::pan(key.stream().range(0.12, 0.14))
        }),
        entry("pot", "pot", |style, key| {
            crockery::pot(key.stream().range(0.1, 0.125), &style.metal)
        }),
        entry("tumbler", "drinking_glass", |_, _| crockery::tumbler()),
        entry("utensils", "utensil_holder", |_, _| crockery::utensils()),
        entry("globe", "decoration", |_, _| decoration::globe()),
        entry("handbag", "bag", |_, _| decoration::handbag()),
        entry("sculpture", "decoration", |style, key| {
            decoration::sculpture(style.glaze(&mut key.stream()))
        }),
        entry("storage_box", "box", |style, key| {
            let mut draw = key.stream();
            decoration::open_box([0.38, 0.22, 0.28], style.any_wood(&mut draw))
        }),
        entry("pencil_cup", "utensil_holder", |_, _| {
            decoration::pencil_cup()
        }),
        entry("shoes", "shoes", |style, key| {
            decoration::shoes(style.cover(&mut key.stream()))
        }),
        entry("teddy_bear", "toy", |_, key| {
            let brown = [
                [156, 108, 66],
                [204, 170, 120],
                [120, 84, 60],
                [226, 206, 180],
            ];
            let plush = super::finish::upholstery("plush", one(&mut key.stream(), brown));
            decoration::teddy_bear(&plush)
        }),
        entry("toy_ball", "ball", |style, key| {
            let mut draw = key.stream();
            let rubber = Finish::plain("toy_rubber", "rubber", style.cloth(&mut draw).srgb);
            decoration::toy_ball(draw.range(0.08, 0.12), &rubber)
        }),
        entry("toy_train", "toy", |_, _| decoration::toy_train()),
        entry("bread", "bread", |_, _| food::bread()),
        entry("cutting_board", "cutting_board", |_, _| {
            food::cutting_board()
        }),
        entry("fruit", "food", |_, key| {
            let mut draw = key.stream();
            let skins = [food::red_skin(), food::green_skin(), food::orange_skin()];
            food::fruit(draw.range(0.034, 0.044), &skins[draw.below(3)])
        }),
        entry("knife_block", "knife_rack", |_, _| food::knife_block()),
        entry("alarm_clock", "clock", |_, _| gadgets::alarm_clock()),
        entry("laptop", "laptop", |_, _| gadgets::laptop()),
        entry("remote_control", "household_appliance", |_, _| {
            gadgets::remote_control()
        }),
        entry("telephone", "telephone", |_, _| gadgets::telephone()),
        entry("candle", "candle", |_, key| {
            lamps::candle(key.stream().range(0.08, 0.14))
        }),
        entry("vase", "vase", |style, key| {
            let mut draw = key.stream();
            let glaze = style.glaze(&mut draw).clone();
            let petals = Finish::plain("petals", "leaves", style.cloth(&mut draw).srgb);
            plants::vase(draw.range(0.18, 0.28), &glaze, Some(&petals))
        }),
        entry("radio", "radio", |_, key| {
            radio::radio(key.stream().below(4) == 0)
        }),
        entry("loudspeaker", "loudspeaker", |_, key| {
            radio::loudspeaker(key.stream().range(0.7, 0.95))
        }),
        entry("folded_blanket", "blanket", |style, key| {
            let mut draw = key.stream();
            textiles::folded_blanket(0.4, 0.3, style.cloth(&mut draw))
        }),
        entry("cushion", "pillow", |style, key| {
            let mut draw = key.stream();
            let edge = draw.range(0.38, 0.46);
            textiles::pillow([edge, 0.14, edge], style.cloth(&mut draw))
        }),
        entry("pillow", "pillow", |style, _| {
            textiles::pillow([0.62, 0.15, 0.42], &style.cloths[0])
        }),
    ];
    ALL
}

fn bed(style: &Style, draw: &mut Stream, width_m: f32) -> Model {
    let covered = draw.below(2) == 0;
    let frame = bed::Bed {
        mattress_m: [width_m, 2.0],
        head_m: draw.range(0.85, 1.1),
        wood: style.wood.clone(),
        headboard: covered.then(|| style.cover(draw).clone()),
        blanket: style.cloth(draw).clone(),
        ..bed::Bed::default()
    };
    frame.build()
}

/// A lit shade in a calm tone of the style.
fn shade(style: &Style, draw: &mut Stream) -> Finish {
    if draw.below(2) == 0 {
        lamps::linen_shade()
    } else {
        super::finish::lampshade("lampshade", style.cloths[0].srgb)
    }
}

fn bottle(key: Key, label: &Finish) -> Model {
    let mut draw = key.stream();
    let colors = [[52, 92, 60], [110, 60, 40], [186, 206, 214]];
    let body = Finish {
        srgb: one(&mut draw, colors),
        ..glass()
    };
    crockery::bottle(draw.range(0.22, 0.32), &body, label, &steel())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::category;
    use crate::furniture::style::STYLES;

    #[test]
    fn every_entry_makes_things_of_its_category_in_every_style_that_it_suits() {
        let mut faults = Vec::new();
        for style in STYLES {
            for entry in entries() {
                for name in entry.styles {
                    let known = STYLES.iter().any(|style| style.name == *name);
                    assert!(known, "{}: no style {name}", entry.kind);
                }
                if !entries_of(entry.kind, style)
                    .iter()
                    .any(|e| std::ptr::eq(*e, entry))
                {
                    continue;
                }
                let model = (entry.build)(style, Key::root(3).child(entry.kind));
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
}
