//! Conversion of the file into a house.

use super::file::{BandCoefficient, MeasuredMaterial, MeasuredRoomFile};
use super::unknown_names;
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::obj::{ObjGroupSelection, build_mesh, read_mesh};
use crate::report::{FileLocation, LoadReport};
use dwell_scene::material::{Bands, library};
use dwell_scene::{
    Aabb, HouseData, Level, LevelId, Material, MaterialId, Mesh, Structure, StructureKind,
};
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A wall of a box: its name in the file, its kind, and its corners as corners of a unit cube, seen from inside counter-clockwise.
type BoxFace = (&'static str, StructureKind, [[f32; 3]; 4]);

const SIDES: [BoxFace; 6] = [
    (
        "x0",
        StructureKind::Wall,
        [[0., 0., 0.], [0., 1., 0.], [0., 1., 1.], [0., 0., 1.]],
    ),
    (
        "x1",
        StructureKind::Wall,
        [[1., 1., 0.], [1., 0., 0.], [1., 0., 1.], [1., 1., 1.]],
    ),
    (
        "y0",
        StructureKind::Wall,
        [[1., 0., 0.], [0., 0., 0.], [0., 0., 1.], [1., 0., 1.]],
    ),
    (
        "y1",
        StructureKind::Wall,
        [[0., 1., 0.], [1., 1., 0.], [1., 1., 1.], [0., 1., 1.]],
    ),
    (
        "z0",
        StructureKind::Floor,
        [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
    ),
    (
        "z1",
        StructureKind::Ceiling,
        [[0., 1., 1.], [1., 1., 1.], [1., 0., 1.], [0., 0., 1.]],
    ),
];

fn is_side(name: &str) -> bool {
    SIDES.iter().any(|(side, ..)| *side == name)
}

fn is_band_list(centres_hz: &[f32]) -> bool {
    let in_range = |centre: &f32| *centre > 0.0 && centre.is_finite();
    !centres_hz.is_empty()
        && centres_hz.iter().all(in_range)
        && centres_hz.is_sorted_by(|a, b| a < b)
}

/// Converts the file's axes to the house's.
fn y_up_from_z_up(p: Vec3) -> Vec3 {
    Vec3::new(p.x, p.z, -p.y)
}

/// A house under construction.
struct MeasuredRoomBuilder<'a> {
    file: &'a MeasuredRoomFile,
    at: &'a FileLocation,
    data: HouseData,
    materials: BTreeMap<&'a str, MaterialId>,
}

pub(super) fn convert(
    file: &MeasuredRoomFile,
    name: &str,
    (root, at): (&DataRoot, &FileLocation),
    report: &mut LoadReport,
) -> Result<HouseData, HousesError> {
    unknown_names::refuse_misspelled_names(file, at, report)?;
    if !is_band_list(&file.bands_hz) {
        return Err(HousesError::Field {
            at: at.field("bands_hz"),
            expected: "rising frequencies above 0 Hz, at least one",
            found: format!("{:.200}", format!("{:?}", file.bands_hz)),
        });
    }
    let mut room = MeasuredRoomBuilder {
        file,
        at,
        data: HouseData {
            name: name.to_owned(),
            source: "measured".to_owned(),
            ..HouseData::default()
        },
        materials: BTreeMap::new(),
    };
    for (name, material) in &file.materials {
        let id = room.data.materials.push(room.material(name, material)?);
        room.materials.insert(name, id);
    }
    match (&file.shoebox, &file.mesh) {
        (Some(size), None) => room.add_box(*size)?,
        (None, Some(mesh)) => room.add_mesh(mesh, root, report)?,
        (both, _) => {
            return Err(HousesError::Field {
                at: at.field("shoebox"),
                expected: "either \"shoebox\" or \"mesh\"",
                found: if both.is_some() { "both" } else { "neither" }.to_owned(),
            });
        }
    }
    if room.data.structure.is_empty() {
        return Err(HousesError::empty(at, report));
    }
    Ok(room.data)
}

impl MeasuredRoomBuilder<'_> {
    /// A material of plaster with other acoustic properties; it transmits nothing.
    fn material(&self, name: &str, file: &MeasuredMaterial) -> Result<Material, HousesError> {
        let at = self.at.field("materials").field(name);
        let substance = library().get_or_default("plaster");
        Ok(Material {
            absorption: self.bands(&at, "absorption", &file.absorption)?,
            scattering: self.bands(&at, "scattering", &file.scattering)?,
            transmission_loss_db: Bands::constant(Material::MAX_TRANSMISSION_LOSS_DB),
            ..Material::from_substance(name, substance)
        })
    }

    fn bands(
        &self,
        at: &FileLocation,
        field: &str,
        table: &BandCoefficient,
    ) -> Result<Bands, HousesError> {
        let count = self.file.bands_hz.len();
        let values = match table {
            BandCoefficient::AllBands(value) => vec![*value; count],
            BandCoefficient::PerBand(values) => values.clone(),
        };
        if values.len() != count {
            return Err(HousesError::Field {
                at: at.field(field),
                expected: "one number, or one for each of bands_hz",
                found: format!("{} numbers for {count} bands", values.len()),
            });
        }
        Ok(Bands {
            centres_hz: self.file.bands_hz.clone(),
            values,
        })
    }

    fn material_of(
        &self,
        at: &FileLocation,
        name: Option<&str>,
    ) -> Result<MaterialId, HousesError> {
        let found = name.and_then(|name| self.materials.get(name));
        found.copied().ok_or_else(|| HousesError::Field {
            at: at.clone(),
            expected: "the name of one of \"materials\"",
            found: name.map_or_else(|| "none".to_owned(), |name| format!("{name:?}")),
        })
    }

    fn add_box(&mut self, size: [f32; 3]) -> Result<(), HousesError> {
        if !size.iter().all(|edge| (0.1..=1000.0).contains(edge)) {
            return Err(HousesError::Field {
                at: self.at.field("shoebox"),
                expected: "three edges of 0.1 to 1000 m",
                found: format!("{size:?}"),
            });
        }
        let size = Vec3::from_array(size);
        self.storey(Aabb::new(
            Vec3::new(0.0, 0.0, -size.y),
            Vec3::new(size.x, size.z, 0.0),
        ));
        if let Some(unknown) = self.file.walls.keys().find(|name| !is_side(name)) {
            return Err(HousesError::Field {
                at: self.at.field("walls"),
                expected: "x0, x1, y0, y1, z0, and z1",
                found: format!("{unknown:?}"),
            });
        }
        for (name, kind, corners) in SIDES {
            let at = self.at.field("walls").field(name);
            let wall = self.file.walls.get(name).map(String::as_str);
            let material = self.material_of(&at, wall)?;
            let positions = corners.map(|corner| y_up_from_z_up(Vec3::from_array(corner) * size));
            let mesh = Mesh::rectangle(positions);
            self.add(name, kind, mesh, material);
        }
        Ok(())
    }

    fn add_mesh(
        &mut self,
        path: &str,
        root: &DataRoot,
        report: &mut LoadReport,
    ) -> Result<(), HousesError> {
        let at = self.at.field("mesh");
        let inside = DataRoot::resolve("", path).map_err(|_| HousesError::Field {
            at: at.clone(),
            expected: "a path inside of the file's folder",
            found: format!("{path:?}"),
        })?;
        let Some(files) = read_mesh(root, &inside, report) else {
            return Err(HousesError::Field {
                at,
                expected: "an OBJ file that can be read",
                found: format!("{path:?}"),
            });
        };
        let mut by_material: BTreeMap<Option<&str>, Vec<_>> = BTreeMap::new();
        for run in files
            .obj
            .face_groups
            .iter()
            .filter(|run| !run.faces.is_empty())
        {
            let runs = by_material.entry(run.material.as_deref()).or_default();
            runs.push((0, run));
        }
        let mut meshes = Vec::new();
        let mut bounds = Aabb::EMPTY;
        for (name, runs) in by_material {
            let material = self.material_of(&FileLocation::file(&inside).field("usemtl"), name)?;
            let shape = ObjGroupSelection {
                obj: &files.obj,
                face_groups: runs,
                box_mapping: false,
            };
            let mut mesh = build_mesh(&shape, &FileLocation::file(&inside), report);
            for point in mesh.positions.iter_mut().chain(&mut mesh.normals) {
                *point = y_up_from_z_up(*point);
            }
            bounds = bounds.union(&mesh.bounds());
            meshes.push((name.unwrap_or_default(), mesh, material));
        }
        self.storey(bounds);
        for (name, mesh, material) in meshes {
            self.add(name, StructureKind::Other, mesh, material);
        }
        Ok(())
    }

    fn storey(&mut self, bounds: Aabb) {
        self.data.levels.push(Level {
            name: "0".to_owned(),
            bounds,
        });
    }

    fn add(&mut self, name: &str, kind: StructureKind, mesh: Mesh, material: MaterialId) {
        let mesh = self.data.meshes.push(Arc::new(mesh));
        self.data.structure.push(Structure {
            name: name.to_owned(),
            kind,
            room: None,
            level: LevelId(0),
            mesh,
            materials: vec![material],
        });
    }
}
