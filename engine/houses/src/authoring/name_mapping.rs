//! Map files: the meanings of foreign names of materials, nodes and rooms. TOML; `docs/authoring.md` lists the fields.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Write as _};
use std::path::Path;
use std::sync::Arc;

use dwell_scene::interrupt;
use dwell_scene::{House, HouseData, Mobility, ObjectId, Structure, StructureKind};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::edit_errors::{invalid_field, prefix_field};
use super::edits::{ObjectAttributes, SurfaceStyle};
use super::hinge::{NodeHinge, attach_hinge};
use super::name_patterns::{ComparisonWork, NamePatterns};
use super::unmapped::UnmappedNames;
use super::{describe, place, remove_objects, surfaces};
use crate::data_root::UserFile;
use crate::error::HousesError;
use crate::import::{UniqueNames, category, room_kind, room_over_floors};
use crate::limits::MAX_TEXT_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::toml_text;
use crate::warning_kind::WarningKind;

/// Largest number of patterns, and of letters of one.
const MOST: [usize; 2] = [20_000, 256];
/// Largest gap between a thing and its support, m.
const GAP_M: f32 = 0.03;

/// The meanings of foreign names: patterns with `*` and `?`, without regard to case. Of those that fit, the one with the most plain
/// letters counts.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NameMapping {
    /// Names of materials or their images.
    pub materials: BTreeMap<String, MaterialMappingEntry>,
    /// Names of nodes or models.
    pub nodes: BTreeMap<String, MappedNode>,
    /// Names of rooms or their foreign kinds.
    pub rooms: BTreeMap<String, MappedRoom>,
}

/// The mapping of a material: a substance's name, or a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaterialMappingEntry(pub MaterialMapping);

/// The table form of a material's mapping.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialMapping {
    /// A row of `assets/materials.toml`; empty: as without a map.
    pub substance: String,
    /// sRGB, 0 to 255, instead of the file's look.
    pub srgb: Option<[u8; 3]>,
    /// 0 to 1.
    pub opacity: Option<f32>,
    /// 0 to 1.
    pub roughness: Option<f32>,
}

/// The mapping of a node: a category's name, or a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MappedNode(pub NodeMapping);

/// The table form of a node's mapping.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NodeMapping {
    /// A row of `assets/categories.csv`; empty: as without a map.
    pub category: String,
    /// The object's name; a number follows where several nodes fit.
    pub name: Option<String>,
    /// Fixed or movable; without it, as things of the category are.
    pub mobility: Option<Mobility>,
    /// kg.
    pub mass_kg: Option<f32>,
    /// kg/m³.
    pub density_kg_m3: Option<f32>,
    /// True if a hand can take it.
    pub pickable: Option<bool>,
    /// The kind of structure, for a piece of the building instead of an object.
    pub structure: Option<StructureKind>,
    /// The hinge about which it opens; an unknown object counts as a door then.
    pub hinge: Option<NodeHinge>,
}

/// The everyday name of a kind of room.
pub type MappedRoom = String;

macro_rules! word_or_table {
    ($row:ident, $table:ident, $field:ident, $expected:literal) => {
        impl<'de> Deserialize<'de> for $row {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Row;
                impl<'de> Visitor<'de> for Row {
                    type Value = $row;
                    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                        f.write_str($expected)
                    }
                    fn visit_str<E>(self, word: &str) -> Result<$row, E> {
                        Ok($row($table {
                            $field: word.to_owned(),
                            ..$table::default()
                        }))
                    }
                    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<$row, A::Error> {
                        $table::deserialize(MapAccessDeserializer::new(map)).map($row)
                    }
                }
                deserializer.deserialize_any(Row)
            }
        }
    };
}

word_or_table!(
    MaterialMappingEntry,
    MaterialMapping,
    substance,
    "a substance's name, or a table with `substance`"
);
word_or_table!(
    MappedNode,
    NodeMapping,
    category,
    "a category's name, or a table with `category`"
);

impl NameMapping {
    /// Reads a map from TOML; `at` is the place in errors.
    ///
    /// # Errors
    /// [`HousesError::Syntax`] for what is no such TOML, [`HousesError::TooLarge`].
    pub fn parse(text: &str, at: &FileLocation) -> Result<Self, HousesError> {
        let map: Self = toml_text::from_str(text, at)?;
        let count = map.materials.len() + map.nodes.len() + map.rooms.len();
        let too_large = |what, found: usize, allowed: usize| HousesError::TooLarge {
            at: at.clone(),
            what,
            found: found as u64,
            allowed: allowed as u64,
        };
        if count > MOST[0] {
            return Err(too_large("pattern count", count, MOST[0]));
        }
        let patterns = map
            .materials
            .keys()
            .chain(map.nodes.keys())
            .chain(map.rooms.keys());
        match patterns.map(|pattern| pattern.chars().count()).max() {
            Some(letters) if letters > MOST[1] => {
                Err(too_large("letters of a pattern", letters, MOST[1]))
            }
            _ => map.check_numbers(at).map(|()| map),
        }
    }

    /// Refuses invalid numbers, also in rows that no name of the house fits.
    fn check_numbers(&self, at: &FileLocation) -> Result<(), HousesError> {
        let materials = self
            .materials
            .iter()
            .flat_map(|(pattern, MaterialMappingEntry(row))| {
                let numbers = [("opacity", row.opacity), ("roughness", row.roughness)];
                numbers.map(|(name, number)| (format!("materials.{pattern:?}.{name}"), number))
            });
        let nodes = self.nodes.iter().flat_map(|(pattern, MappedNode(row))| {
            let place = row.hinge.and_then(|hinge| hinge.at);
            let numbers = [
                ("mass_kg", row.mass_kg),
                ("density_kg_m3", row.density_kg_m3),
                ("hinge.open_deg", row.hinge.map(|hinge| hinge.open_deg)),
                ("hinge.closed_deg", row.hinge.map(|hinge| hinge.closed_deg)),
                ("hinge.at[0]", place.map(|at| at[0])),
                ("hinge.at[1]", place.map(|at| at[1])),
                ("hinge.at[2]", place.map(|at| at[2])),
            ];
            numbers.map(|(name, number)| (format!("nodes.{pattern:?}.{name}"), number))
        });
        for (field, number) in materials.chain(nodes) {
            if let Some(number) = number.filter(|number| !number.is_finite()) {
                return Err(HousesError::Field {
                    at: at.field(field),
                    expected: "a finite number",
                    found: number.to_string(),
                });
            }
        }
        Ok(())
    }

    /// Reads a map file.
    ///
    /// # Errors
    /// [`HousesError::Io`], and those of [`Self::parse`].
    pub fn read(path: &Path) -> Result<Self, HousesError> {
        let UserFile { name, bytes, .. } = UserFile::read(path, MAX_TEXT_BYTES)?;
        let at = FileLocation::file(&name);
        let text = std::str::from_utf8(&bytes).map_err(|error| HousesError::Syntax {
            at: at.clone(),
            message: format!("expected a map of names, TOML: {error}"),
        })?;
        Self::parse(text, &at)
    }

    /// The house with its foreign names mapped; names that the map explains leave the report.
    ///
    /// # Errors
    /// [`HousesError::Spec`] names the pattern and the field, what was found and what is possible; [`HousesError::Scene`].
    pub fn apply(&self, house: &House, report: &mut LoadReport) -> Result<House, HousesError> {
        let mut data = house.data().clone();
        let mut work = ComparisonWork::default();
        let patterns = MapPatterns {
            materials: NamePatterns::new(&self.materials),
            nodes: NamePatterns::new(&self.nodes),
            rooms: NamePatterns::new(&self.rooms),
        };
        patterns.apply_materials(&mut data, &mut work)?;
        patterns.apply_nodes(&mut data, report, &mut work)?;
        for room in &mut data.rooms {
            let names = room
                .kinds
                .iter()
                .map(String::as_str)
                .chain([room.name.as_str()]);
            let found = patterns.rooms.best_match(names, &mut work)?;
            if let Some((_, kind)) = found.filter(|(_, kind)| !kind.is_empty()) {
                room.kinds = vec![room_kind(kind).unwrap_or_else(|plain| plain)];
            }
        }
        let mut explained = BTreeSet::new();
        for warning in report.warnings() {
            if let WarningKind::Unmapped { name, .. } = &warning.kind
                && patterns.explains(name, &mut work)?
            {
                explained.insert(name.clone());
            }
        }
        report.retain(|warning| match &warning.kind {
            WarningKind::Unmapped { name, .. } => !explained.contains(name),
            _ => true,
        });
        House::new(data).map_err(HousesError::scene(&FileLocation::file("map")))
    }
}

/// The rows of a map by their patterns.
struct MapPatterns<'a> {
    materials: NamePatterns<'a, MaterialMappingEntry>,
    nodes: NamePatterns<'a, MappedNode>,
    rooms: NamePatterns<'a, MappedRoom>,
}

impl MapPatterns<'_> {
    /// Returns whether the map says what a foreign name means.
    fn explains(&self, name: &str, work: &mut ComparisonWork) -> Result<bool, HousesError> {
        let material = self.materials.best_match([name], work)?;
        let node = self.nodes.best_match([name], work)?;
        let room = self.rooms.best_match([name], work)?;
        Ok(material.is_some_and(|(_, row)| !row.0.substance.is_empty())
            || node.is_some_and(|(_, row)| !row.0.category.is_empty() || row.0.hinge.is_some())
            || room.is_some_and(|(_, kind)| !kind.is_empty()))
    }

    fn apply_materials(
        &self,
        data: &mut HouseData,
        work: &mut ComparisonWork,
    ) -> Result<(), HousesError> {
        for k in 0..data.materials.len() {
            let id = dwell_scene::MaterialId(k as u32);
            let material = &data.materials[id];
            let image = material
                .texture
                .map(|texture| data.textures[texture].name.as_str());
            let names = image.into_iter().chain([material.name.as_str()]);
            let Some((pattern, MaterialMappingEntry(row))) =
                self.materials.best_match(names, work)?
            else {
                continue;
            };
            let look = SurfaceStyle {
                substance: Some(row.substance.clone()).filter(|name| !name.is_empty()),
                srgb: row.srgb,
                opacity: row.opacity,
                roughness: row.roughness,
                keep_appearance: true,
            };
            if look
                == (SurfaceStyle {
                    keep_appearance: true,
                    ..SurfaceStyle::default()
                })
            {
                continue;
            }
            let place = format!("materials.{pattern:?}");
            surfaces::restyle_material(data, id, &look).map_err(prefix_field(place))?;
        }
        Ok(())
    }

    fn apply_nodes(
        &self,
        data: &mut HouseData,
        report: &mut LoadReport,
        work: &mut ComparisonWork,
    ) -> Result<(), HousesError> {
        let mut given = UniqueNames::taken(data.objects.iter().map(|object| &object.name));
        let mut walls = BTreeSet::new();
        for k in 0..data.objects.len() {
            interrupt::unwind_if_cancelled();
            let id = ObjectId(k as u32);
            let object = &data.objects[id];
            let names = [
                object.source_id.as_str(),
                object.model.as_str(),
                object.name.as_str(),
            ];
            let Some((pattern, MappedNode(row))) = self.nodes.best_match(names, work)? else {
                continue;
            };
            let place = format!("nodes.{pattern:?}");
            if row.hinge.is_some() && (row.structure.is_some() || row.mobility.is_some()) {
                let found = "it beside `structure` or `mobility`";
                let possible = "a hinge alone: what hangs on one moves with it";
                return Err(prefix_field(place)(invalid_field("hinge", found, possible)));
            }
            if let Some(kind) = row.structure {
                convert_to_structure(data, id, kind).map_err(prefix_field(place))?;
                walls.insert(id);
                continue;
            }
            let unknown = object.category.coarse.is_empty();
            let told = Some(row.category.clone()).filter(|name| !name.is_empty());
            let door = (unknown && row.hinge.is_some()).then(|| "door".to_owned());
            let told = told.or(door);
            let traits = ObjectAttributes {
                category: told,
                mobility: row.mobility.or_else(|| {
                    let loose = row.hinge.is_none();
                    loose
                        .then(|| usual_mobility(data, id, unknown, &row.category))
                        .flatten()
                }),
                mass_kg: row.mass_kg,
                density_kg_m3: row.density_kg_m3,
                pickable: row.pickable,
                switch: None,
            };
            if let Some(hinge) = &row.hinge {
                attach_hinge(data, id, hinge).map_err(prefix_field(&place))?;
            }
            describe::set_attributes(data, id, &traits).map_err(prefix_field(&place))?;
            let object = &mut data.objects[id];
            let kind = category([object.category.coarse.as_str()]);
            if unknown
                && object.switch.is_none()
                && kind.is_some_and(crate::import::CategoryRow::is_switchable)
            {
                object.switch = Some(false);
            }
            if let Some(name) = row.name.as_ref().filter(|name| **name != object.name) {
                if name.is_empty() {
                    return Err(prefix_field(place)(invalid_field(
                        "name", "nothing", "a name",
                    )));
                }
                object.name = given.unique(name);
            }
        }
        if !walls.is_empty() {
            remove_objects::remove(data, &walls);
            if data.rooms.is_empty() {
                room_over_floors(data, &FileLocation::file("map"), report);
                for k in 0..data.objects.len() {
                    place::update_room_and_level(data, ObjectId(k as u32));
                }
            }
        }
        Ok(())
    }
}

/// Movable, for an unknown object whose category moves, and which stands on something.
fn usual_mobility(data: &HouseData, id: ObjectId, unknown: bool, name: &str) -> Option<Mobility> {
    let object = &data.objects[id];
    let row = category([name])?;
    let loose = unknown && row.is_movable() && !row.is_mounted();
    let rigid = object.part_count == 1 && object.mobility == Mobility::Fixed;
    (loose && rigid && is_supported(data, id)).then_some(Mobility::Movable)
}

fn is_supported(data: &HouseData, id: ObjectId) -> bool {
    let own = place::world_bounds(data, id);
    let foot = own.center().with_y(own.min.y);
    let floors = data.rooms.iter().map(|room| room.floor_y);
    let on_floor = floors.into_iter().any(|y| (foot.y - y).abs() <= GAP_M);
    on_floor
        || data
            .objects
            .ids()
            .filter(|other| *other != id)
            .any(|other| {
                let below = place::world_bounds(data, other);
                below.min.y < foot.y - 0.01
                    && foot.y < below.max.y + GAP_M
                    && below.contains(foot.with_y(below.center().y))
            })
}

/// Turns an object into a piece of the building; the object is left for the caller to remove.
fn convert_to_structure(
    data: &mut HouseData,
    id: ObjectId,
    kind: StructureKind,
) -> Result<(), HousesError> {
    let object = data.objects[id].clone();
    if object.mobility == Mobility::Articulated || object.part_count > 1 {
        let found = format!("{:?}, which has {} parts", object.name, object.part_count);
        return Err(invalid_field(
            "structure",
            found,
            "an object of one rigid part",
        ));
    }
    let part = data.parts[object.first_part].clone();
    let map = part.world_from_part.to_affine() * part.part_from_mesh;
    let mesh = data.meshes[part.mesh].transformed(&map);
    let mesh = data.meshes.push(Arc::new(mesh));
    let mut name = object.name.clone();
    let mut number = 2;
    while data.structure.iter().any(|piece| piece.name == name) {
        name = format!("{}_{number}", object.name);
        number += 1;
    }
    data.structure.push(Structure {
        name,
        kind,
        room: object.room,
        level: object.level,
        mesh,
        materials: part.materials,
    });
    Ok(())
}

/// A map file with all unmapped names, to be filled in; as it is, it changes nothing.
pub fn map_template(house: &str, names: &UnmappedNames) -> String {
    let mut text = format!(
        "# What the names of {} mean: `dwell info HOUSE --map FILE`. Patterns may hold * and ?. docs/authoring.md lists the fields.\n",
        house.replace(['\n', '\r'], " ")
    );
    let quoted = |name: &str| serde_json::Value::from(name).to_string();
    text += "\n# A substance of assets/materials.toml, or { substance = \"oak\", opacity = 1.0 }.\n[materials]\n";
    for row in &names.materials {
        let _ = write!(
            text,
            "# {:.2} m2 on {}; taken for {}\n{} = \"\"\n",
            row.area_m2,
            pluralize(row.count, "surface"),
            row.taken_for,
            quoted(&row.name)
        );
    }
    text += "\n# A category of assets/categories.csv, or { category = \"chair\", mobility = \"movable\", mass_kg = 4.0 }, or { structure = \"wall\" }.\n[nodes]\n";
    for row in &names.nodes {
        let _ = write!(
            text,
            "# {:.2} m2 on {}\n{} = \"\"\n",
            row.area_m2,
            pluralize(row.count, "object"),
            quoted(&row.name)
        );
    }
    text += "\n# What people call the room: \"living room\".\n[rooms]\n";
    for row in &names.rooms {
        let _ = write!(
            text,
            "# {:.2} m2\n{} = \"\"\n",
            row.area_m2,
            quoted(&row.name)
        );
    }
    text
}

fn pluralize(count: usize, noun: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{s}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_says_where_it_is_wrong() {
        let told = |text: &str| {
            NameMapping::parse(text, &FileLocation::file("m.toml"))
                .unwrap_err()
                .to_string()
        };
        let unknown = told("[materials]\n\"a\" = { substanc = \"oak\" }\n");
        assert!(
            unknown.contains("substanc") && unknown.contains("opacity"),
            "{unknown}"
        );
        let number = told("[nodes]\nchair = 3\n");
        assert!(number.contains("a category's name, or a table"), "{number}");
        assert!(told("[things]\n").contains("expected one of"));
        let sound = NameMapping::parse(
            "[materials]\na = \"oak\"\n[nodes]\nb = \"chair\"\n[rooms]\nr = \"kitchen\"\n",
            &FileLocation::file("m"),
        );
        assert_eq!(sound.unwrap().materials["a"].0.substance, "oak");
    }
}
