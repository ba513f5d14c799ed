//! The table of substances, `assets/materials.toml`.

use super::Bands;
use crate::error::SceneError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A substance: an entry of `assets/materials.toml`. Units and ranges are given at the head of that file.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    missing_docs,
    reason = "the fields are the file's, and are documented once, at its head"
)]
pub struct Substance {
    pub name: String,
    pub noun: String,
    pub adjective: String,
    pub words: Vec<String>,
    pub default_color: [u8; 3],
    pub opacity: f32,
    pub metallic: f32,
    pub roughness: f32,
    pub density_kg_m3: f32,
    pub friction: f32,
    pub restitution: f32,
    pub absorption: Bands,
    pub scattering: Bands,
    pub surface_density_kg_m2: f32,
    pub transmission_loss_db: Bands,
    /// Sources of the values, by group (`density`, `contact`, `surface`, `absorption`, `scattering`, `transmission`).
    pub sources: BTreeMap<String, String>,
}

/// Friction and restitution between two substances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairContact {
    /// Coefficient of kinetic friction: the force along the surface over the normal force.
    pub friction: f32,
    /// Coefficient of restitution: the speed after over the speed before, along the normal.
    pub restitution: f32,
}

/// All substances.
#[derive(Clone, Debug)]
pub struct MaterialLibrary {
    substances: BTreeMap<String, Substance>,
    pairs: BTreeMap<(String, String), (f32, Option<f32>)>,
    by_word: BTreeMap<String, String>,
    default_name: String,
}

#[derive(Deserialize)]
struct MaterialsToml {
    band_centres_hz: Vec<f32>,
    default_material: String,
    material: Vec<SubstanceRow>,
    #[serde(default)]
    pair: Vec<PairRow>,
}

#[derive(Deserialize)]
struct SubstanceRow {
    name: String,
    noun: String,
    adjective: String,
    #[serde(default)]
    words: Vec<String>,
    default_color: [u8; 3],
    opacity: f32,
    metallic: f32,
    roughness: f32,
    density_kg_m3: f32,
    friction: f32,
    restitution: f32,
    absorption: Vec<f32>,
    scattering: Vec<f32>,
    surface_density_kg_m2: f32,
    transmission_loss_db: Option<Vec<f32>>,
    density_source: String,
    contact_source: String,
    surface_source: String,
    absorption_source: String,
    scattering_source: String,
    transmission_source: String,
}

#[derive(Deserialize)]
struct PairRow {
    between: [String; 2],
    friction: f32,
    restitution: Option<f32>,
}

/// The library that ships with the engine.
///
/// # Panics
/// Never: the file is part of the build, and tested.
pub fn library() -> &'static MaterialLibrary {
    static LIBRARY: OnceLock<MaterialLibrary> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let text = include_str!("../../../../assets/materials.toml");
        MaterialLibrary::parse(text)
            .expect("assets/materials.toml is checked by this crate's tests")
    })
}

/// Sound reduction index R of a limp panel, dB.
///
/// # Source
/// Field-incidence mass law, L. L. Beranek, *Noise and Vibration Control* (1971): 20 log10(m f) - 47.
fn mass_law_db(surface_density_kg_m2: f32, frequency_hz: f32) -> f32 {
    (20.0 * libm::log10f(surface_density_kg_m2 * frequency_hz) - 47.0).max(0.0)
}

impl MaterialLibrary {
    /// Reads a table of the form of `assets/materials.toml`.
    ///
    /// # Errors
    /// [`SceneError`] with the row and field.
    pub fn parse(text: &str) -> Result<Self, SceneError> {
        let file: MaterialsToml = toml::from_str(text).map_err(|error| SceneError::Range {
            at: "materials.toml".to_owned(),
            field: "table",
            found: error.to_string(),
            allowed: "the schema at the head of assets/materials.toml",
        })?;
        let centres = file.band_centres_hz;
        let mut substances = BTreeMap::new();
        let mut by_word = BTreeMap::new();
        for row in file.material {
            let bands = |values| Bands {
                centres_hz: centres.clone(),
                values,
            };
            let loss = row.transmission_loss_db.unwrap_or_else(|| {
                centres
                    .iter()
                    .map(|f| mass_law_db(row.surface_density_kg_m2, *f))
                    .collect()
            });
            for word in row.words.iter().chain([&row.name]) {
                by_word
                    .entry(word.clone())
                    .or_insert_with(|| row.name.clone());
            }
            let sources = [
                ("density", row.density_source),
                ("contact", row.contact_source),
                ("surface", row.surface_source),
                ("absorption", row.absorption_source),
                ("scattering", row.scattering_source),
                ("transmission", row.transmission_source),
            ];
            let substance = Substance {
                noun: row.noun,
                adjective: row.adjective,
                words: row.words,
                default_color: row.default_color,
                opacity: row.opacity,
                metallic: row.metallic,
                roughness: row.roughness,
                density_kg_m3: row.density_kg_m3,
                friction: row.friction,
                restitution: row.restitution,
                absorption: bands(row.absorption),
                scattering: bands(row.scattering),
                surface_density_kg_m2: row.surface_density_kg_m2,
                transmission_loss_db: bands(loss),
                sources: sources
                    .map(|(group, source)| (group.to_owned(), source))
                    .into(),
                name: row.name,
            };
            super::Material::from_substance("row", &substance)
                .check(&format!("materials.toml: {}", substance.name))?;
            let at = || format!("materials.toml: {}", substance.name);
            if let Some(old) = substances.insert(substance.name.clone(), substance.clone()) {
                return Err(SceneError::DuplicateName {
                    at: at(),
                    name: old.name,
                });
            }
        }
        let known = || substances.keys().cloned().collect::<Vec<_>>();
        let mut pairs = BTreeMap::new();
        for pair in file.pair {
            let [mut a, mut b] = pair.between;
            if let Some(name) = [&a, &b]
                .into_iter()
                .find(|name| !substances.contains_key(*name))
            {
                let at = "materials.toml: pair".to_owned();
                return Err(SceneError::Unknown {
                    at,
                    kind: "material",
                    name: name.clone(),
                    known: known(),
                });
            }
            if a > b {
                std::mem::swap(&mut a, &mut b);
            }
            pairs.insert((a, b), (pair.friction, pair.restitution));
        }
        if !substances.contains_key(&file.default_material) {
            let at = "materials.toml: default_material".to_owned();
            return Err(SceneError::Unknown {
                at,
                kind: "material",
                name: file.default_material,
                known: known(),
            });
        }
        Ok(Self {
            substances,
            pairs,
            by_word,
            default_name: file.default_material,
        })
    }

    /// The substance called `name`.
    pub fn get(&self, name: &str) -> Option<&Substance> {
        self.substances.get(name)
    }

    /// The substance called `name`, or the default one.
    pub fn get_or_default(&self, name: &str) -> &Substance {
        self.get(name).unwrap_or_else(|| self.default_substance())
    }

    /// Returns the substance of a thing whose material is unknown.
    pub fn default_substance(&self) -> &Substance {
        &self.substances[&self.default_name]
    }

    /// Returns the substance for a word in a foreign material's name.
    pub fn find_by_word(&self, word: &str) -> Option<&Substance> {
        self.by_word.get(word).map(|name| &self.substances[name])
    }

    /// All substances, by name.
    pub fn iter(&self) -> impl Iterator<Item = &Substance> {
        self.substances.values()
    }

    /// Friction and restitution between two substances: the published pair, else the geometric mean of the two.
    /// Unknown names count as the default substance.
    pub fn pair_contact(&self, a: &str, b: &str) -> PairContact {
        let (a, b) = (self.get_or_default(a), self.get_or_default(b));
        let key = if a.name <= b.name {
            (a.name.clone(), b.name.clone())
        } else {
            (b.name.clone(), a.name.clone())
        };
        let mean = PairContact {
            friction: (a.friction * b.friction).sqrt(),
            restitution: (a.restitution * b.restitution).sqrt(),
        };
        match self.pairs.get(&key) {
            Some((friction, restitution)) => PairContact {
                friction: *friction,
                restitution: restitution.unwrap_or(mean.restitution),
            },
            None => mean,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_in_range_in_all_bands_and_names_its_sources() {
        let library =
            MaterialLibrary::parse(include_str!("../../../../assets/materials.toml")).unwrap();
        for substance in library.iter() {
            assert_eq!(
                substance.absorption.values.len(),
                substance.absorption.centres_hz.len(),
                "{}",
                substance.name
            );
            assert_eq!(
                substance.scattering.values.len(),
                substance.scattering.centres_hz.len(),
                "{}",
                substance.name
            );
            for (group, source) in &substance.sources {
                assert!(source.len() >= 8, "{} {group}: {source:?}", substance.name);
            }
        }
    }

    #[test]
    fn a_pair_does_not_depend_on_its_order() {
        let library = library();
        for a in library.iter() {
            for b in library.iter() {
                assert_eq!(
                    library.pair_contact(&a.name, &b.name),
                    library.pair_contact(&b.name, &a.name)
                );
            }
        }
    }

    #[test]
    fn mass_law_gives_six_db_an_octave() {
        assert!((mass_law_db(20.0, 1000.0) - 39.02).abs() < 0.01);
        assert!((mass_law_db(20.0, 2000.0) - mass_law_db(20.0, 1000.0) - 6.02).abs() < 0.01);
    }
}
