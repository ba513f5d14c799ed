//! The tables of `assets/` that give foreign names a meaning.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use dwell_scene::material::{Substance, library};
use serde::Deserialize;

/// A row of `assets/categories.csv`; the file's README describes the columns.
#[derive(Debug, Clone, Deserialize)]
pub struct CategoryRow {
    /// Name in plain words with underscores.
    pub name: String,
    aliases: String,
    /// Its class among the 40 of NYU Depth v2.
    pub nyu40_name: String,
    movable: u8,
    /// 1 where it has a switch.
    pub switchable: u8,
    /// 1 where it opens.
    pub openable: u8,
    /// 1 where it can be heard.
    pub sounding: u8,
    /// 1 where things lie on it.
    pub supports: u8,
    /// 1 where things lie in it.
    pub contains: u8,
    mounted: u8,
    substances: String,
    fill: f32,
    mass_kg: f32,
    width_m: f32,
    height_m: f32,
    depth_m: f32,
}

impl CategoryRow {
    /// Returns whether a person can push it or pick it up.
    pub fn is_movable(&self) -> bool {
        self.movable == 1
    }

    /// Mass of a usual specimen, kg; 0 where that means nothing.
    pub fn mass_kg(&self) -> f32 {
        self.mass_kg
    }

    /// Returns whether it has a switch.
    pub fn is_switchable(&self) -> bool {
        self.switchable == 1
    }

    /// Returns whether it hangs on a wall or ceiling.
    pub fn is_mounted(&self) -> bool {
        self.mounted == 1
    }

    /// Mass over the volume of its bounding box, kg/m³: that of a usual specimen, else the substance's times the fill.
    pub fn box_density_kg_m3(&self) -> f32 {
        let density = self.mass_kg / (self.width_m * self.height_m * self.depth_m);
        if density > 0.0 && density.is_finite() {
            density
        } else {
            self.substance().density_kg_m3 * self.fill
        }
    }

    /// Returns what it is usually made of.
    pub fn substance(&self) -> &'static Substance {
        library().get_or_default(self.substances.split(';').next().unwrap_or_default())
    }
}

#[derive(Deserialize)]
struct RoomRow {
    name: String,
    aliases: String,
}

#[derive(Deserialize)]
struct MaterialPrefixRow {
    prefix: String,
    material: String,
}

struct FurnitureTables {
    categories: BTreeMap<String, CategoryRow>,
    rooms: BTreeMap<String, String>,
    prefixes: Vec<MaterialPrefixRow>,
}

fn rows<T: serde::de::DeserializeOwned>(text: &str) -> Vec<T> {
    csv::Reader::from_reader(text.as_bytes())
        .deserialize()
        .collect::<Result<_, _>>()
        .expect("the tables of assets/ are checked by this file's tests")
}

fn tables() -> &'static FurnitureTables {
    static TABLES: OnceLock<FurnitureTables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let rows_of_categories: Vec<CategoryRow> =
            rows(include_str!("../../../assets/categories.csv"));
        let mut categories = BTreeMap::new();
        // Names go before aliases.
        for row in &rows_of_categories {
            categories.insert(row.name.clone(), row.clone());
        }
        for row in &rows_of_categories {
            for alias in row.aliases.split(';').filter(|alias| !alias.is_empty()) {
                categories
                    .entry(alias.to_owned())
                    .or_insert_with(|| row.clone());
            }
        }
        let mut rooms = BTreeMap::new();
        for row in rows::<RoomRow>(include_str!("../../../assets/rooms.csv")) {
            let kind = row.name.replace('_', " ");
            for alias in row.aliases.split(';').chain([row.name.as_str()]) {
                rooms
                    .entry(alias.to_ascii_lowercase())
                    .or_insert_with(|| kind.clone());
            }
        }
        let mut prefixes: Vec<MaterialPrefixRow> =
            rows(include_str!("../../../assets/texture_substances.csv"));
        prefixes.sort_by(|a, b| {
            b.prefix
                .len()
                .cmp(&a.prefix.len())
                .then_with(|| a.prefix.cmp(&b.prefix))
        });
        FurnitureTables {
            categories,
            rooms,
            prefixes,
        }
    })
}

/// The row of the first of `names` that the table knows, by name or alias.
pub fn category<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<&'static CategoryRow> {
    names
        .into_iter()
        .find_map(|name| tables().categories.get(name))
}

/// The names of all categories, in order, without aliases.
pub fn category_names() -> impl Iterator<Item = &'static str> {
    let rows = tables().categories.iter();
    rows.filter(|(name, row)| **name == row.name)
        .map(|(name, _)| name.as_str())
}

/// A room type as `assets/rooms.csv` calls it, in plain words: `"living room"` of `"Living_Room"`.
///
/// # Errors
/// The type in plain words, when the table does not know it.
pub fn room_kind(room_type: &str) -> Result<String, String> {
    let plain = room_type
        .trim()
        .to_ascii_lowercase()
        .replace(['_', '-'], " ");
    let known = tables()
        .rooms
        .get(&plain.replace(' ', "_"))
        .or_else(|| tables().rooms.get(&plain));
    known.cloned().ok_or(plain)
}

/// The substance that the name of a texture or a material means; `None` when it says nothing definite.
///
/// `name` may hold folders and numbers: `ut/3f.../wood_8`, `chrome_1`.
pub fn substance_of(name: &str) -> Option<&'static Substance> {
    let base = name
        .rsplit(['/', '\\'])
        .next()
        .unwrap_or(name)
        .to_ascii_lowercase();
    let by_prefix = tables()
        .prefixes
        .iter()
        .find(|row| base.starts_with(&row.prefix))
        .and_then(|row| library().get(&row.material));
    let words = || {
        base.split(|c: char| !c.is_alphabetic())
            .filter(|word| !word.is_empty())
    };
    let found = by_prefix
        .or_else(|| library().get(&base))
        .or_else(|| words().find_map(|word| library().find_by_word(word)));
    // "color_1" and the like name the default substance, which means that they say nothing.
    found.filter(|substance| substance.name != library().default_substance().name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_substance_that_the_tables_name_exists() {
        for row in tables().categories.values() {
            for name in row.substances.split(';') {
                assert!(
                    library().get(name).is_some(),
                    "category {}: {name:?}",
                    row.name
                );
            }
        }
        for row in &tables().prefixes {
            assert!(
                library().get(&row.material).is_some(),
                "prefix {}: {:?}",
                row.prefix,
                row.material
            );
        }
    }

    #[test]
    fn names_of_real_files_find_their_substance() {
        let name = |texture| substance_of(texture).map(|s| s.name.as_str());
        assert_eq!(name("textile_2_3"), Some("textile"));
        assert_eq!(name("bricks_1"), Some("brick"));
        assert_eq!(name("ut/0123456789abcdef/wood_8"), Some("wood"));
        assert_eq!(name("chrome_1"), Some("chrome"));
        assert_eq!(
            (name("color_1"), name("material_0"), name("")),
            (None, None, None)
        );
    }

    #[test]
    fn room_types_become_plain_words() {
        assert_eq!(room_kind("Living_Room").as_deref(), Ok("living room"));
        assert_eq!(room_kind("Bathroom").as_deref(), Ok("bathroom"));
        assert_eq!(room_kind("Wine_Cellar"), Err("wine cellar".into()));
    }

    #[test]
    fn aliases_find_the_row_of_a_category() {
        assert_eq!(
            category(["indoor_lamp"]).map(|row| row.name.as_str()),
            Some("table_lamp")
        );
        assert_eq!(
            category(["no_such_thing", "sofa"]).map(CategoryRow::is_movable),
            Some(true)
        );
    }
}
