//! The real SUNCG house, compared with what its predecessor's tables and code said of it.

use dwell_houses::suncg;
use dwell_scene::parallel::Threads;
use dwell_scene::{House, ObjectId, State};
use dwell_semantics::color::ColorVocabulary;
use dwell_semantics::describe::{TextOptions, caption, describe_house};
use dwell_semantics::graph::scene_graph;
use dwell_semantics::instruct::{InstructionKind, candidates};
use dwell_semantics::{Semantics, SizeClass};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

static OPENED: OnceLock<Arc<House>> = OnceLock::new();

fn data_root() -> PathBuf {
    let beside = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    std::env::var_os("DWELL_SHARED_DATA").map_or(beside, PathBuf::from)
}

/// The sample house, or `None` with a printed line.
#[expect(clippy::print_stdout, reason = "what is skipped is said")]
fn sample() -> Option<Arc<House>> {
    let path = data_root().join("suncg/house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    if !path.is_file() {
        println!("skipped: no sample house in ../shared/data/suncg or $DWELL_SHARED_DATA");
        return None;
    }
    let open = || {
        let (house, _) = suncg::open(&path, Threads::ONE).expect("the sample opens");
        Arc::new(house)
    };
    Some(OPENED.get_or_init(open).clone())
}

fn of_model(house: &House, model: &str) -> ObjectId {
    let found = house
        .objects
        .iter_ids()
        .find(|(_, object)| object.model == model);
    found
        .unwrap_or_else(|| panic!("no object of model {model}"))
        .0
}

/// Fact 3 of the reference: what a reader of the file counts.
#[test]
fn kinds_of_things_are_counted_as_in_the_file() {
    let Some(house) = sample() else { return };
    let semantics = Semantics::new(&house);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for object in house.objects.ids() {
        *counts
            .entry(semantics.facts(object).noun.as_str())
            .or_default() += 1;
    }
    let published = [
        ("window", 6),
        ("door", 5),
        // "Curtain" there: one hangs on each side of the window.
        ("pair of curtains", 2),
        ("toilet", 2),
        ("trash can", 2),
        ("partition", 1),
        // "Ottoman" there: two can sit on it.
        ("bench", 1),
        // The file calls it a wardrobe: it is 0.74 m high and hangs on a wall.
        ("cabinet", 1),
        ("dressing table", 1),
        ("shower", 1),
        ("bathtub", 1),
        ("sink", 1),
        ("mirror", 1),
        ("double bed", 1),
        ("sofa", 1),
        ("column", 2),
        // "Shelf" there: they stand on the floor.
        ("shelving unit", 2),
    ];
    for (noun, count) in published {
        assert_eq!(counts.get(noun), Some(&count), "{noun}: {counts:?}");
    }
    let chairs = ["chair", "armchair", "office chair"]
        .iter()
        .filter_map(|noun| counts.get(noun))
        .sum::<usize>();
    let tables = ["table", "coffee table", "dining table"]
        .iter()
        .filter_map(|noun| counts.get(noun))
        .sum::<usize>();
    assert_eq!((chairs, tables), (6, 5));
}

/// Facts 2 and 10: floors overlap, and three things are in no room.
#[test]
fn things_are_in_the_rooms_that_the_file_lists_them_in() {
    let Some(house) = sample() else { return };
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let nowhere: Vec<&str> = house
        .objects
        .iter_ids()
        .filter(|(id, _)| scene.room_of(*id).is_none())
        .map(|(_, object)| object.model.as_str())
        .collect();
    assert_eq!(nowhere, ["365", "365", "135"]);
    let (mut same, mut other) = (0, Vec::new());
    for (id, object) in house.objects.iter_ids() {
        if let (Some(here), Some(file)) = (scene.room_of(id), object.room) {
            if here == file {
                same += 1;
            } else {
                other.push((
                    caption(&scene, id, TextOptions::default()).text,
                    house.rooms[file].name.clone(),
                ));
            }
        }
    }
    println!("{same} things are in the room of their file; not so: {other:?}");
    assert!(same >= 38, "{same}");
    // The sum of the floors is 82 m², what they cover together is 62.1 m².
    let area: f32 = house
        .rooms
        .ids()
        .map(|room| semantics.room(room).area_m2)
        .sum();
    assert!((area - 62.1).abs() < 2.0, "{area}");
}

/// The predecessor's colours of a thing: groups by texture or colour, a fifth of the area at least, plain mean of the image,
/// nearest by Euclid's distance in sRGB.
fn predecessor_colors(house: &House, object: ObjectId, list: ColorVocabulary) -> BTreeSet<String> {
    let mut groups: BTreeMap<String, (f64, [f32; 3])> = BTreeMap::new();
    for part in house.objects[object].parts() {
        let part = &house.parts[part];
        let mesh = &house.meshes[part.mesh];
        for triangle in 0..mesh.triangles.len() {
            let material = &house.materials[part.materials[usize::from(mesh.slot(triangle))]];
            let [a, b, c] = mesh
                .corners(triangle)
                .map(|p| part.part_from_mesh.transform_point3(p));
            let area = f64::from((b - a).cross(c - a).length()) * 0.5;
            let plain = || {
                material
                    .base_color
                    .map(dwell_scene::units::srgb_from_linear)
            };
            let image = |id| house.textures[id].mean_srgb().map(|c| (c / 255.0) as f32);
            let color = material.texture.map_or_else(plain, image);
            let key = format!("{:?} {color:?} {}", material.texture, material.opacity);
            groups.entry(key).or_insert((0.0, color)).0 += area;
        }
    }
    let total: f64 = groups.values().map(|(area, _)| area).sum();
    let kept = groups.values().filter(|(area, _)| area / total >= 0.2);
    kept.map(|(_, color)| list.word_by_srgb_distance(*color).replace(' ', ""))
        .collect()
}

/// Fact 19, for the models whose colours this house does not override: basic, web and survey words as the predecessor gave
/// them. Its way of choosing is repeated here over our meshes, areas and textures; ours is printed beside it.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_predecessors_colour_words_come_out_of_our_surfaces() {
    let Some(house) = sample() else { return };
    let semantics = Semantics::new(&house);
    let cases: &[(&str, ColorVocabulary, &[&str])] = &[
        ("317", ColorVocabulary::Basic, &["silver"]),
        ("317", ColorVocabulary::Web, &["navajo white"]),
        ("317", ColorVocabulary::Xkcd, &["light peach"]),
        ("210", ColorVocabulary::Web, &["dark gray", "cadet blue"]),
        ("561", ColorVocabulary::Web, &["linen"]),
        ("67", ColorVocabulary::Basic, &["teal"]),
        ("67", ColorVocabulary::Web, &["dark slate blue"]),
        ("67", ColorVocabulary::Xkcd, &["denim blue"]),
        ("656", ColorVocabulary::Basic, &["olive"]),
        ("656", ColorVocabulary::Web, &["sienna"]),
        ("656", ColorVocabulary::Xkcd, &["sienna"]),
        ("261", ColorVocabulary::Basic, &["silver"]),
        ("77", ColorVocabulary::Basic, &["silver", "teal"]),
    ];
    let mut agree = 0;
    for (model, list, words) in cases {
        let object = of_model(&house, model);
        let expected: BTreeSet<String> = words.iter().map(|word| word.replace(' ', "")).collect();
        let found = predecessor_colors(&house, object, *list);
        let ours = semantics.facts(object).color_words(*list);
        println!(
            "{model} {list:?}: predecessor {expected:?}, its way here {found:?}, our words {ours:?}"
        );
        agree += usize::from(expected == found);
    }
    assert_eq!(agree, cases.len());
    // It said that the toilet is white, as its model is: it never read the colours that this house gives its things.
    let toilet = of_model(&house, "83");
    let found = predecessor_colors(&house, toilet, ColorVocabulary::Basic);
    assert_eq!(found, BTreeSet::from(["gray".to_owned()]));
    assert_eq!(
        semantics.facts(toilet).color_words(ColorVocabulary::Basic),
        ["gray"]
    );
}

/// Facts 19 and 21: substances and kinds agree.
#[test]
fn substances_and_kinds_agree_with_the_predecessor() {
    let Some(house) = sample() else { return };
    let semantics = Semantics::new(&house);
    let substances: &[(&str, &[&str])] = &[
        ("317", &["wood"]),
        ("561", &["wood"]),
        ("67", &["textile"]),
        ("656", &["wood"]),
        ("261", &["leather"]),
        ("77", &["leather", "textile"]),
    ];
    for (model, expected) in substances {
        let facts = semantics.facts(of_model(&house, model));
        let found: BTreeSet<&str> = facts
            .substances
            .iter()
            .filter(|(_, share)| *share >= 0.2)
            .map(|(substance, _)| substance.name.as_str())
            .collect();
        assert_eq!(found, expected.iter().copied().collect(), "{model}");
    }
    let kinds = [
        ("83", "toilet"),
        ("87", "sink"),
        ("365", "column"),
        ("502", "partition"),
        ("456", "shelving unit"),
        ("478", "bench"),
        ("203", "dressing table"),
        ("135", "shower"),
    ];
    for (model, noun) in kinds {
        assert_eq!(semantics.facts(of_model(&house, model)).noun, noun);
    }
}

/// A model of the predecessor's tables: its id, whether its front is the usual one, and its volume, m³.
struct TabledModel {
    id: String,
    coarse_class: String,
    volume_m3: f64,
}

/// The models of a folder of tables whose front is the usual one.
fn tabled_models(folder: &str) -> Vec<TabledModel> {
    let root = data_root().join("suncg").join(folder);
    let rows = |name: &str| {
        let mut reader = csv::Reader::from_path(root.join(name)).expect("a table");
        let columns = reader.headers().expect("a header").clone();
        let rows = reader.records().map(|row| row.expect("a row"));
        let rows = rows.map(|row| {
            let fields = columns.iter().zip(&row);
            fields
                .map(|(name, value)| (name.to_owned(), value.to_owned()))
                .collect::<BTreeMap<_, _>>()
        });
        rows.collect::<Vec<_>>()
    };
    let classes: BTreeMap<String, String> = rows("ModelCategoryMapping.csv")
        .into_iter()
        .map(|row| (row["model_id"].clone(), row["coarse_grained_class"].clone()))
        .collect();
    let models = rows("models.csv").into_iter();
    let usual = models.filter(|row| row["front"].replace(' ', "") == "0,0,1");
    usual
        .filter_map(|row| {
            let edges = row["aligned.dims"].split(',');
            let edges = edges.map(|cm| cm.trim().parse::<f64>().expect("a length") / 100.0);
            Some(TabledModel {
                coarse_class: classes.get(&row["id"])?.clone(),
                volume_m3: edges.product(),
                id: row["id"].clone(),
            })
        })
        .collect()
}

/// The predecessor's size of a model: by the mean and the standard deviation of the volumes of all models of its coarse class.
fn predecessor_size(models: &[TabledModel], id: &str) -> &'static str {
    let own = models.iter().find(|model| model.id == id).expect("a model");
    let class = models
        .iter()
        .filter(|model| model.coarse_class == own.coarse_class);
    let volumes: Vec<f64> = class.map(|model| model.volume_m3).collect();
    let number = volumes.len() as f64;
    let mean = volumes.iter().sum::<f64>() / number;
    let variance = volumes.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / number;
    let off = own.volume_m3 - mean;
    match off / variance.sqrt() {
        off if off < -2.0 => "tiny",
        off if off < -1.0 => "small",
        off if off > 2.0 => "huge",
        off if off > 1.0 => "large",
        _ => "normal",
    }
}

/// Facts 19 and 20: the predecessor's sizes come out of its tables by its rule. Ours are printed beside: its "large" is one of the largest
/// of all models of a class as wide as "table", ours is larger than a thing of its kind usually is, whatever models there are; so its word
/// changes with the tables (561 is small in those of one house), ours does not.
#[test]
fn the_predecessors_sizes_come_out_of_its_tables() {
    let Some(house) = sample() else { return };
    let semantics = Semantics::new(&house);
    let (all, of_one_house) = (
        tabled_models("metadata"),
        tabled_models("metadata_home_subset"),
    );
    let large = ["203", "499", "502", "83"].map(|id| (id, "large"));
    let normal = [
        "109", "122", "126", "135", "210", "261", "352", "67", "77", "561",
    ];
    let normal = normal.map(|id| (id, "normal"));
    for (id, word) in large.into_iter().chain([("81", "small")]).chain(normal) {
        assert_eq!(predecessor_size(&all, id), word, "{id}");
        let ours = semantics.facts(of_model(&house, id)).size;
        println!("{id}: {word} among its class's models, {ours:?} beside a usual one");
        assert!(ours != SizeClass::Tiny && ours != SizeClass::Huge);
    }
    assert_eq!(predecessor_size(&of_one_house, "561"), "small");
}

#[test]
fn the_house_is_described_and_its_things_can_be_asked_for() {
    let Some(house) = sample() else { return };
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let text = describe_house(&scene, TextOptions::default()).text;
    println!("{text}");
    assert!(
        text.starts_with(
            "There are four rooms and 43 things. There is a bathroom, a bedroom and a dining room.\n"
        ),
        "{text}"
    );
    // Its walls are the sample's: crimson paint in the first two, white paper in the others.
    assert_eq!(text.matches(" red walls").count(), 1);
    assert_eq!(text.matches(" red-orange walls").count(), 1);
    assert_eq!(text.matches("white walls").count(), 2);
    for object in house.objects.ids() {
        let words = caption(&scene, object, TextOptions::default()).text;
        assert!(
            words.starts_with("a ") || words.starts_with("an "),
            "{words}"
        );
    }
    for kind in InstructionKind::ALL {
        let all = candidates(&scene, kind);
        println!(
            "{:?}",
            all.iter().map(|i| i.text.as_str()).collect::<Vec<_>>()
        );
        assert!(all.len() >= 3 && all.iter().all(|instruction| instruction.tokens().is_ok()));
    }
    let graph = scene_graph(&scene, None);
    // With its storey; nobody is there.
    assert_eq!(graph.node_count(), 48);
}
