//! Household categories, `assets/categories.csv`.

use crate::csv_table::CsvTable;
use crate::error::SemanticsError;
use dwell_scene::Category;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// A row of `assets/categories.csv`; `assets/README.md` describes the columns.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "the columns of the file are independent flags"
)]
pub struct SemanticCategory {
    /// The identifier.
    pub name: &'static str,
    /// Spoken, for one.
    pub singular: &'static str,
    /// Spoken, for several.
    pub plural: &'static str,
    /// Other spoken words.
    pub synonyms: Vec<&'static str>,
    /// Number of the NYU-40 class, 0 to 40.
    pub nyu40_id: u8,
    /// Name of the NYU-40 class.
    pub nyu40_name: &'static str,
    /// Name of the synset of `WordNet` 3.0, such as `"chair.n.01"`; empty where none is right.
    pub synset: &'static str,
    /// Part of the building.
    pub structure: bool,
    /// A person can push or pick it up.
    pub movable: bool,
    /// It opens.
    pub openable: bool,
    /// It has a switch.
    pub switchable: bool,
    /// It makes sounds of its own.
    pub sounding: bool,
    /// It hangs on a wall or ceiling.
    pub mounted: bool,
    /// Things stand on it.
    pub supports: bool,
    /// Things go into it.
    pub contains: bool,
    /// It has a front of its own: the side that is used or looked at.
    pub front: bool,
    /// Usual substances, most usual first.
    pub substances: Vec<&'static str>,
    /// Fraction of the bounding box that the first substance fills.
    pub fill: f32,
    /// A usual specimen's mass, kg.
    pub mass_kg: f32,
    /// A usual specimen's width, height and depth, m.
    pub size_m: [f32; 3],
    /// Rooms in which it is usual.
    pub rooms: Vec<&'static str>,
}

impl SemanticCategory {
    /// Returns whether its noun says too little of a thing to find it by.
    pub(crate) fn is_vague(&self) -> bool {
        ["trinket", "household_appliance", "unknown", "box"].contains(&self.name)
    }
}

/// All categories.
#[derive(Debug)]
pub struct Categories {
    rows: Vec<SemanticCategory>,
    by_name: BTreeMap<&'static str, usize>,
}

impl Categories {
    fn parse(text: &'static str) -> Result<Self, SemanticsError> {
        let table = CsvTable::parse("categories.csv", text)?;
        let (mut rows, mut by_name) = (Vec::new(), BTreeMap::new());
        let mut aliases = Vec::new();
        for row in table.rows() {
            let index = rows.len();
            let name = row.text("name")?;
            if by_name.insert(name, index).is_some() {
                return Err(row.error(format!("the name {name:?} is taken")));
            }
            aliases.extend(row.list("aliases")?.into_iter().map(|alias| (alias, index)));
            rows.push(SemanticCategory {
                name,
                singular: row.text("singular")?,
                plural: row.text("plural")?,
                synonyms: row.list("synonyms")?,
                nyu40_id: row.number("nyu40_id")?,
                nyu40_name: row.text("nyu40_name")?,
                synset: row.text("synset")?,
                structure: row.flag("structure")?,
                movable: row.flag("movable")?,
                openable: row.flag("openable")?,
                switchable: row.flag("switchable")?,
                sounding: row.flag("sounding")?,
                mounted: row.flag("mounted")?,
                supports: row.flag("supports")?,
                contains: row.flag("contains")?,
                front: row.flag("front")?,
                substances: row.list("substances")?,
                fill: row.number("fill")?,
                mass_kg: row.number("mass_kg")?,
                size_m: [
                    row.number("width_m")?,
                    row.number("height_m")?,
                    row.number("depth_m")?,
                ],
                rooms: row.list("rooms")?,
            });
        }
        for (alias, index) in aliases {
            by_name.entry(alias).or_insert(index);
        }
        Ok(Self { rows, by_name })
    }

    /// All rows, in file order.
    pub fn rows(&self) -> &[SemanticCategory] {
        &self.rows
    }

    /// The row called `name`, by identifier or alias.
    pub fn get(&self, name: &str) -> Option<&SemanticCategory> {
        self.by_name.get(name).map(|index| &self.rows[*index])
    }

    /// The row of a thing: by its fine name, else its coarse one. `None` when neither is known.
    pub fn of(&self, category: &Category) -> Option<&SemanticCategory> {
        let known = |name: &str| self.get(name).or_else(|| self.get(&name.replace(' ', "_")));
        known(&category.fine)
            .filter(|row| row.name != "unknown")
            .or_else(|| known(&category.coarse))
    }
}

/// The table that ships with the engine.
pub fn categories() -> &'static Categories {
    static TABLE: LazyLock<Categories> = LazyLock::new(|| {
        Categories::parse(include_str!("../../assets/categories.csv"))
            .expect("assets/categories.csv is checked by this crate's tests")
    });
    &TABLE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::english::article;
    use crate::room_kind::room_kinds;
    use std::collections::BTreeSet;

    #[test]
    fn every_row_points_to_things_that_exist() {
        let table = Categories::parse(include_str!("../../assets/categories.csv")).unwrap();
        assert!(table.rows().len() >= 110);
        for row in table.rows() {
            for substance in &row.substances {
                assert!(
                    dwell_scene::material::library().get(substance).is_some(),
                    "{}: {substance}",
                    row.name
                );
            }
            for room in &row.rooms {
                assert!(room_kinds().get(room).is_some(), "{}: {room}", row.name);
            }
            assert!(
                row.nyu40_id <= 40 && !row.substances.is_empty(),
                "{}",
                row.name
            );
            assert!((0.0..=2.0).contains(&row.fill) && row.size_m.iter().all(|m| *m > 0.0));
            assert_ne!(row.singular, row.plural, "{}", row.name);
        }
    }

    /// Names of synsets are a lemma, a part of speech and a number of a sense.
    #[test]
    fn synsets_have_names_of_nouns() {
        let named = categories()
            .rows()
            .iter()
            .filter(|row| !row.synset.is_empty());
        let mut count = 0;
        for row in named {
            count += 1;
            let [number, speech, lemma] = row.synset.rsplitn(3, '.').collect::<Vec<_>>()[..] else {
                panic!("{}: {}", row.name, row.synset);
            };
            let plain = lemma.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
            assert!(
                plain && !lemma.is_empty() && speech == "n",
                "{}",
                row.synset
            );
            assert!(
                number.len() == 2 && number.parse::<u8>().is_ok(),
                "{}",
                row.synset
            );
        }
        assert!(count > 150, "{count}");
        let of = |name: &str| categories().get(name).map(|row| (row.synset, row.front));
        assert_eq!(of("chair"), Some(("chair.n.01", true)));
        assert_eq!(of("table"), Some(("table.n.02", false)));
    }

    #[test]
    fn the_articles_of_the_file_are_those_of_the_rule() {
        let text = include_str!("../../assets/categories.csv");
        let table = CsvTable::parse("categories.csv", text).unwrap();
        for row in table.rows() {
            let noun = row.text("singular").unwrap();
            assert_eq!(row.text("article").unwrap(), article(noun), "{noun}");
        }
    }

    /// The numbers of Gupta et al. 2013 that a hundred label files rely on.
    #[test]
    fn nyu_numbers_are_the_published_ones() {
        let published = [
            ("wall", 1),
            ("floor", 2),
            ("cabinet", 3),
            ("bed", 4),
            ("chair", 5),
            ("sofa", 6),
            ("table", 7),
            ("door", 8),
            ("window", 9),
            ("bookshelf", 10),
            ("picture", 11),
            ("counter", 12),
            ("blinds", 13),
            ("desk", 14),
            ("shelves", 15),
            ("curtain", 16),
            ("dresser", 17),
            ("pillow", 18),
            ("mirror", 19),
            ("floor mat", 20),
            ("clothes", 21),
            ("ceiling", 22),
            ("books", 23),
            ("refridgerator", 24),
            ("television", 25),
            ("paper", 26),
            ("towel", 27),
            ("shower curtain", 28),
            ("box", 29),
            ("whiteboard", 30),
            ("person", 31),
            ("night stand", 32),
            ("toilet", 33),
            ("sink", 34),
            ("lamp", 35),
            ("bathtub", 36),
            ("bag", 37),
            ("otherstructure", 38),
            ("otherfurniture", 39),
            ("otherprop", 40),
            ("void", 0),
        ];
        let published: BTreeSet<_> = published.into_iter().collect();
        for row in categories().rows() {
            assert!(
                published.contains(&(row.nyu40_name, row.nyu40_id)),
                "{}: {}",
                row.name,
                row.nyu40_name
            );
        }
    }

    #[test]
    fn fine_names_go_before_coarse_ones() {
        let of = |fine: &str, coarse: &str| {
            let category = Category {
                fine: fine.into(),
                coarse: coarse.into(),
                nyu40: String::new(),
            };
            categories().of(&category).map(|row| row.singular)
        };
        assert_eq!(of("coffee_table", "table"), Some("coffee table"));
        assert_eq!(of("range_oven", "kitchen_appliance"), Some("cooker"));
        assert_eq!(of("nothing_known", "table"), Some("table"));
        assert_eq!(of("nothing_known", "neither"), None);
    }
}
