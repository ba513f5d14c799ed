//! Kinds of rooms, `assets/rooms.csv`.

use crate::csv_table::CsvTable;
use crate::error::SemanticsError;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// A row of `assets/rooms.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomCategory {
    /// The identifier.
    pub name: &'static str,
    /// Spoken, for one.
    pub singular: &'static str,
    /// Spoken, for several.
    pub plural: &'static str,
    /// Other spoken words.
    pub synonyms: Vec<&'static str>,
    /// True if it has walls all round.
    pub indoor: bool,
    /// The preposition of place: "in" the kitchen, "on" the balcony.
    pub preposition: &'static str,
}

/// All kinds of rooms.
#[derive(Debug)]
pub struct RoomCategories {
    rows: Vec<RoomCategory>,
    by_word: BTreeMap<String, usize>,
}

fn key(word: &str) -> String {
    word.to_lowercase().replace('_', " ")
}

impl RoomCategories {
    fn parse(text: &'static str) -> Result<Self, SemanticsError> {
        let table = CsvTable::parse("rooms.csv", text)?;
        let (mut rows, mut by_word) = (Vec::new(), BTreeMap::new());
        let mut weaker = Vec::new();
        for row in table.rows() {
            let index = rows.len();
            let kind = RoomCategory {
                name: row.text("name")?,
                singular: row.text("singular")?,
                plural: row.text("plural")?,
                synonyms: row.list("synonyms")?,
                indoor: row.flag("indoor")?,
                preposition: row.text("preposition")?,
            };
            by_word.entry(key(kind.name)).or_insert(index);
            weaker.push((key(kind.singular), index));
            weaker.extend(row.list("aliases")?.iter().map(|word| (key(word), index)));
            weaker.extend(kind.synonyms.iter().map(|word| (key(word), index)));
            rows.push(kind);
        }
        for (word, index) in weaker {
            by_word.entry(word).or_insert(index);
        }
        Ok(Self { rows, by_word })
    }

    /// All rows, in file order.
    pub fn rows(&self) -> &[RoomCategory] {
        &self.rows
    }

    /// The kind of a word: identifier, spoken word, synonym or label of a file; case and underscores do not
    /// matter.
    pub fn get(&self, word: &str) -> Option<&RoomCategory> {
        self.by_word.get(&key(word)).map(|index| &self.rows[*index])
    }
}

/// The table that ships with the engine.
pub fn room_kinds() -> &'static RoomCategories {
    static TABLE: LazyLock<RoomCategories> = LazyLock::new(|| {
        RoomCategories::parse(include_str!("../../assets/rooms.csv"))
            .expect("assets/rooms.csv is checked by this crate's tests")
    });
    &TABLE
}

/// The preposition of place before a room called `noun`; "in" for kinds outside the table.
pub fn preposition(noun: &str) -> &'static str {
    room_kinds().get(noun).map_or("in", |kind| kind.preposition)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_label_of_the_sample_format_is_known() {
        let labels = [
            "Bedroom",
            "Room",
            "Bathroom",
            "Toilet",
            "Kitchen",
            "Living_Room",
            "Office",
            "Dining_Room",
            "Garage",
            "Hallway",
            "Hall",
            "Balcony",
            "Child_Room",
            "Gym",
            "Wardrobe",
            "Storage",
            "Guest_Room",
            "Terrace",
            "Entryway",
            "Lobby",
            "Loggia",
            "Boiler_room",
            "Aeration",
            "Passenger_elevator",
            "Freight_elevator",
            "Outside",
        ];
        for label in labels {
            assert!(room_kinds().get(label).is_some(), "{label}");
        }
        // Kinds that the format lacks.
        for kind in ["porch", "roof", "studio", "laundry_room"] {
            assert!(room_kinds().get(kind).is_some(), "{kind}");
        }
        assert_eq!(room_kinds().rows().len(), labels.len() + 4);
        assert_eq!(
            room_kinds().get("Living_Room").unwrap().singular,
            "living room"
        );
        assert_eq!(room_kinds().get("lounge").unwrap().name, "living_room");
        assert_eq!(room_kinds().get("observatory"), None);
    }

    #[test]
    fn one_is_on_what_has_no_walls_and_in_the_rest() {
        for kind in room_kinds().rows() {
            assert!(["in", "on"].contains(&kind.preposition), "{}", kind.name);
            assert!(!kind.indoor || kind.preposition == "in", "{}", kind.name);
        }
        for noun in [
            "balcony",
            "terrace",
            "patio",
            "deck",
            "porch",
            "roof",
            "loggia",
            "covered balcony",
        ] {
            assert_eq!(preposition(noun), "on", "{noun}");
        }
        for noun in ["kitchen", "garden", "outside area", "hall", "observatory"] {
            assert_eq!(preposition(noun), "in", "{noun}");
        }
    }
}
