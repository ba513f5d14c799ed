//! Tests that models have the affordances of their category.

use crate::catalogue::entries;
use crate::model::Model;
use crate::style::STYLES;
use crate::tables::category;
use dwell_scene::ReceptacleKind;
use dwell_scene::random::RandomKey;
use std::collections::BTreeMap;

/// Affordances that models lack, with their categories: `assets/categories.csv` states them for things of the category that are
/// not modelled here, or agents have no use for them yet.
const LEFT_OUT: &[(&str, &[&str])] = &[
    (
        "opens",
        &[
            // Cloth that is drawn aside.
            "curtain",
            "blinds",
            // Made open or shut.
            "laptop",
            "umbrella",
            "drinkbar",
            "television",
        ],
    ),
    // Its shelves are places on which things stand; bags are shut.
    ("contains", &["bag", "bookshelf", "shelving"]),
    (
        "sounds",
        &[
            // Played by somebody.
            "piano",
            "keyboard",
            "guitar",
            "drumset",
            // Silent until somebody calls.
            "cellphone",
            "tablet",
            // A remote control; a click is an event.
            "household_appliance",
            "switch",
        ],
    ),
    // The floor carries what stands on a rug; a coat rack comes with its coat.
    ("supports", &["hanger", "rug"]),
    // Lamps have switches of their own.
    ("switches", &["household_appliance", "piano", "switch"]),
];

/// A category whose rows in `assets/categories.csv` say that it opens, contains, supports, sounds or has a switch has a kind
/// that does.
#[test]
fn categories_keep_what_their_rows_promise() {
    let mut models: BTreeMap<&str, Vec<Model>> = BTreeMap::new();
    for entry in entries() {
        let drawn = (0..4).map(|number| (entry.build)(&STYLES[0], RandomKey::root(number)));
        models.entry(entry.category).or_default().extend(drawn);
    }
    let mut faults = Vec::new();
    for (name, models) in &models {
        let row = category([*name]).unwrap();
        let holds = |holding: ReceptacleKind| {
            models
                .iter()
                .any(|model| model.spaces.iter().any(|space| space.kind == holding))
        };
        let either = holds(ReceptacleKind::On) || holds(ReceptacleKind::In);
        let claims = [
            (
                "opens",
                row.openable,
                models.iter().any(|model| !model.joints.is_empty()),
            ),
            ("contains", row.contains, holds(ReceptacleKind::In)),
            ("supports", row.supports, either),
            (
                "sounds",
                row.sounding,
                models.iter().any(|model| !model.sounds.is_empty()),
            ),
            (
                "switches",
                row.switchable,
                models.iter().any(|model| model.switch.is_some()),
            ),
        ];
        for (what, promised, kept) in claims {
            let excused = LEFT_OUT
                .iter()
                .any(|(which, names)| *which == what && names.contains(name));
            if promised == 1 && !kept && !excused {
                faults.push(format!("no {name} {what}"));
            }
            if excused && kept {
                faults.push(format!("{name} is excused, yet one {what}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
