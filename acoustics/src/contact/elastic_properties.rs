//! The table of substances' elastic properties, `assets/ringing.toml`.

use dwell_scene::material::library;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Elastic properties of a substance: stiffness, yield and damping. Units, ranges and sources stand in `assets/ringing.toml`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticProperties {
    /// Young's modulus for bending, Pa.
    pub young_pa: f64,
    /// Young's modulus of the surface that is hit, Pa.
    pub contact_pa: f64,
    /// Density of the solid, kg/m³.
    pub density_kg_m3: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Loss factor.
    pub loss: f64,
    /// Arithmetic mean roughness, m.
    pub roughness_m: f64,
}

#[derive(Deserialize)]
struct RingingToml {
    row: Vec<ElasticRow>,
}

#[derive(Deserialize)]
struct ElasticRow {
    substances: Vec<String>,
    young_gpa: f64,
    contact_gpa: f64,
    density_kg_m3: f64,
    poisson: f64,
    loss: f64,
    roughness_um: f64,
}

fn table() -> &'static BTreeMap<String, ElasticProperties> {
    static TABLE: OnceLock<BTreeMap<String, ElasticProperties>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let text = include_str!("../../../assets/ringing.toml");
        let file: RingingToml =
            toml::from_str(text).expect("assets/ringing.toml is checked by this crate's tests");
        let rows = file.row.into_iter().flat_map(|row| {
            let elastic = ElasticProperties {
                young_pa: row.young_gpa * 1e9,
                contact_pa: row.contact_gpa * 1e9,
                density_kg_m3: row.density_kg_m3,
                poisson: row.poisson,
                loss: row.loss,
                roughness_m: row.roughness_um * 1e-6,
            };
            row.substances.into_iter().map(move |name| (name, elastic))
        });
        rows.collect()
    })
}

/// Returns the properties of the substance called `name`; those of the library's default for an unknown one.
///
/// # Panics
/// Never: tests check the table against the library.
pub fn elastic(name: &str) -> ElasticProperties {
    let table = table();
    let found = table
        .get(name)
        .or_else(|| table.get(&library().get_or_default(name).name));
    *found.expect("every substance of the library has a row")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_substance_of_the_library_has_one_row_within_its_ranges() {
        let text = include_str!("../../../assets/ringing.toml");
        let file: RingingToml = toml::from_str(text).unwrap();
        let mut named: Vec<&String> = file.row.iter().flat_map(|row| &row.substances).collect();
        named.sort();
        let mut known: Vec<String> = library().iter().map(|row| row.name.clone()).collect();
        known.sort();
        assert_eq!(named, known.iter().collect::<Vec<_>>());
        assert_eq!(text.matches("source = \"").count(), file.row.len());
        for name in &known {
            let it = elastic(name);
            assert!((1e5..=3e11).contains(&it.young_pa), "{name}");
            assert!(
                it.contact_pa > 0.0 && it.contact_pa <= it.young_pa,
                "{name}"
            );
            assert!((50.0..=1e4).contains(&it.density_kg_m3), "{name}");
            assert!((0.0..0.5).contains(&it.poisson), "{name}");
            assert!((1e-4..=1.0).contains(&it.loss), "{name}");
            assert!((1e-8..=1e-3).contains(&it.roughness_m), "{name}");
        }
        assert_eq!(elastic("unobtainium"), elastic("hard_surface"));
    }

    /// Speed of longitudinal waves in bars, m/s: L. Cremer, M. Heckl, B. A. T. Petersson, Structure-Borne Sound (2005).
    #[test]
    fn bar_speeds_are_the_published_ones() {
        for (name, published) in [
            ("steel", 5_050.0),
            ("aluminium", 5_100.0),
            ("glass", 4_900.0),
            ("concrete", 3_400.0),
            ("copper", 3_500.0),
            ("plywood", 3_000.0),
            ("cork", 430.0),
            ("oak", 4_100.0),
        ] {
            let it = elastic(name);
            let speed = (it.young_pa / it.density_kg_m3).sqrt();
            assert!((speed / published - 1.0).abs() < 0.15, "{name}: {speed}");
        }
    }
}
