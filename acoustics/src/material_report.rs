//! Report of a house's acoustic materials: areas, absorption, and the share of default materials.

use crate::bands::{BAND_COUNT, BandValues};
use crate::propagation_scene::PropagationScene;
use dwell_scene::material::library;
use dwell_scene::{Id, MaterialId};
use glam::Vec3;
use serde::Serialize;

/// The acoustic properties of a material of a house.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialAcoustics {
    /// The material.
    pub material: MaterialId,
    /// Its name.
    pub name: String,
    /// Its substance.
    pub substance: String,
    /// Area of its triangles, one side each, m².
    pub area_m2: f64,
    /// Absorption of energy in force. Shape (band,).
    pub absorption: BandValues,
    /// Scattering in force. Shape (band,).
    pub scattering: BandValues,
    /// True if the material names no substance, so that the library's default is used.
    pub is_default: bool,
    /// True if a parameter of the state overrides it.
    pub is_overridden: bool,
}

/// The acoustic materials of a house.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialReport {
    /// Materials that have area, the largest first.
    pub materials: Vec<MaterialAcoustics>,
    /// Area of all triangles, m².
    pub area_m2: f64,
    /// Area of triangles whose material is the library's default, m².
    pub default_area_m2: f64,
    /// Mean absorption over the area. Shape (band,).
    pub mean_absorption: [f64; BAND_COUNT],
    /// Mean scattering over the area. Shape (band,).
    pub mean_scattering: [f64; BAND_COUNT],
    /// The box around all triangles: its lowest and its highest corner, m; zeros without any.
    pub bounds_m: [[f32; 3]; 2],
    /// Number of planes of the triangles.
    pub planes: usize,
    /// Number of triangles.
    pub triangles: usize,
}

impl MaterialReport {
    pub(crate) fn new(data: &PropagationScene) -> Self {
        let house = data.house();
        let mut area_of = vec![0.0_f64; house.materials.len()];
        let mut bounds: Option<(Vec3, Vec3)> = None;
        for placed in &house.geometry().placed {
            let mesh = &house.meshes[placed.mesh];
            for triangle in 0..mesh.triangles.len() {
                let corners = mesh.corners(triangle);
                let [a, b, c] = corners.map(|p| placed.world_from_mesh.transform_point3(p));
                for corner in [a, b, c] {
                    let (low, high) = bounds.unwrap_or((corner, corner));
                    bounds = Some((low.min(corner), high.max(corner)));
                }
                let material = house.slot_material(placed.owner, mesh.slot(triangle));
                area_of[material.index()] += 0.5 * f64::from((b - a).cross(c - a).length());
            }
        }
        let default = &library().default_substance().name;
        let mut rows: Vec<MaterialAcoustics> = house
            .materials
            .iter_ids()
            .zip(&area_of)
            .filter(|(_, area)| **area > 0.0)
            .map(|((id, material), area_m2)| {
                let surface = data.surface(id);
                let known = library().get(&material.substance);
                MaterialAcoustics {
                    material: id,
                    name: material.name.clone(),
                    substance: material.substance.clone(),
                    area_m2: *area_m2,
                    absorption: surface.absorption,
                    scattering: surface.scattering,
                    is_default: known.is_none_or(|substance| substance.name == *default)
                        && known
                            .is_none_or(|substance| substance.absorption == material.absorption),
                    is_overridden: data.is_overridden(&material.name),
                }
            })
            .collect();
        rows.sort_by(|a, b| {
            let order = b.area_m2.total_cmp(&a.area_m2);
            order.then(a.material.cmp(&b.material))
        });
        let area_m2: f64 = rows.iter().map(|row| row.area_m2).sum();
        let mean = |of: &dyn Fn(&MaterialAcoustics) -> BandValues| {
            let mut sum = [0.0; BAND_COUNT];
            for row in &rows {
                for (total, value) in sum.iter_mut().zip(of(row)) {
                    *total += row.area_m2 * f64::from(value) / area_m2;
                }
            }
            sum
        };
        Self {
            mean_absorption: mean(&|row| row.absorption),
            mean_scattering: mean(&|row| row.scattering),
            default_area_m2: rows
                .iter()
                .filter(|row| row.is_default)
                .map(|row| row.area_m2)
                .sum(),
            area_m2,
            bounds_m: bounds.map_or_else(Default::default, |(low, high)| {
                [low.to_array(), high.to_array()]
            }),
            planes: data.planes().len(),
            triangles: house.triangle_count(),
            materials: rows,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{AcousticConfig, AcousticScene};
    use dwell_scene::{House, Material, ShoeboxMaterials, State, material::library};
    use std::sync::Arc;

    #[test]
    fn a_shoebox_is_explained() {
        let carpet = Material::from_substance("rug", library().get("carpet").unwrap());
        let unknown = Material::from_substance("unknown", library().default_substance());
        let materials = ShoeboxMaterials {
            floor: carpet.clone(),
            ..ShoeboxMaterials::uniform(&unknown)
        };
        let house = Arc::new(House::shoebox([6.0, 3.0, 5.0], &materials).unwrap());
        let mut scene = AcousticScene::new(house.clone(), AcousticConfig::rl()).unwrap();
        let told = scene.material_report();
        assert_eq!(told.bounds_m, [[0.0; 3], [6.0, 3.0, 5.0]]);
        assert!((told.area_m2 - 126.0).abs() < 1e-3 && (told.default_area_m2 - 96.0).abs() < 1e-3);
        let wanted =
            (30.0 * carpet.absorption.at(1000.0) + 96.0 * unknown.absorption.at(1000.0)) / 126.0;
        assert!((told.mean_absorption[4] - f64::from(wanted)).abs() < 1e-5);
        let mut state = State::new(&house);
        let address = "material/floor/absorption/1000".parse().unwrap();
        state.set_parameter(&house, &address, 0.9).unwrap();
        scene.update(&state);
        let row = scene
            .material_report()
            .materials
            .into_iter()
            .find(|row| row.name == "floor")
            .unwrap();
        assert!(row.is_overridden && (row.absorption[4] - 0.9).abs() < 1e-6);
        assert!((row.absorption[3] - carpet.absorption.at(500.0)).abs() < 1e-6);
    }
}
