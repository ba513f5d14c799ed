//! The metadata tables of a written data root.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use dwell_scene::{Aabb, Category, Light, LightShape, units};
use glam::{Affine3A, Vec3};
use serde::{Deserialize, Serialize};

use super::super::metadata::{OneOrMany, SoundEntry, SuncgLight};
use super::SuncgWriter;
use crate::atomic::write_file;
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::limits::MAX_TEXT_BYTES;
use crate::report::FileLocation;

/// A model as the tables know it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct ModelRow {
    pub(super) id: String,
    pub(super) category: Category,
    pub(super) slots: usize,
    pub(super) bounds: Aabb,
    pub(super) lights: Vec<SuncgLight>,
    pub(super) signals: Vec<String>,
}

/// File name of the [`ModelRow`] beside a model that houses share.
const ROW: &str = "row.json";

impl SuncgWriter<'_> {
    /// Writes the table row of a shared model beside it.
    pub(super) fn write_row_file(&self, row: &ModelRow) -> Result<(), HousesError> {
        let path = format!("object/{}/{ROW}", row.id);
        let text = serde_json::to_vec(row).map_err(|error| HousesError::NotRepresentable {
            path: self.folder.join(&path),
            message: crate::plain_parse_error(&error),
        })?;
        self.file(&path, &text)
    }
}

/// The rows beside all shared models of a data root, by id.
///
/// # Errors
/// [`HousesError::Io`] when the system refuses, [`HousesError::Syntax`] when a row is none.
pub(super) fn read_rows(root: &DataRoot) -> Result<Vec<ModelRow>, HousesError> {
    let folder = root.folder().join("object");
    // Without any house there are no models.
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let mut names: Vec<_> = fs::read_dir(&folder)
        .map_err(HousesError::io(&folder))?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort_unstable();
    let rows = names
        .iter()
        .map(|name| format!("object/{name}/{ROW}"))
        .filter(|path| root.exists(path));
    rows.map(|path| {
        let text = root.read(&path, MAX_TEXT_BYTES)?;
        crate::json::from_slice(&text).map_err(|error| HousesError::Syntax {
            at: FileLocation::file(&path),
            message: crate::plain_parse_error(&error),
        })
    })
    .collect()
}

/// Writes the tables of models into a data root.
///
/// # Errors
/// [`HousesError::Io`] when the system refuses.
pub(super) fn write_tables(folder: &Path, models: &[ModelRow]) -> Result<(), HousesError> {
    let unwritable = |path: &str, message: String| HousesError::NotRepresentable {
        path: folder.join(path),
        message,
    };
    let file = |path: &str, bytes: &[u8]| write_file(&folder.join(path), bytes);
    let metadata = folder.join("metadata");
    fs::create_dir_all(&metadata).map_err(HousesError::io(&metadata))?;
    let path = "metadata/ModelCategoryMapping.csv";
    let rows = models
        .iter()
        .filter(|row| !row.category.fine.is_empty() || !row.category.coarse.is_empty());
    let rows = rows.enumerate().map(|(k, row)| {
        let category = &row.category;
        let [index, structure] = [k.to_string(), "2".to_owned()];
        let names = [
            &category.fine,
            &category.coarse,
            &structure,
            &category.nyu40,
        ]
        .map(Clone::clone);
        [
            vec![index, row.id.clone()],
            names.to_vec(),
            vec![String::new(); 2],
        ]
        .concat()
    });
    let header = [
        "index",
        "model_id",
        "fine_grained_class",
        "coarse_grained_class",
        "empty_struct_obj",
        "nyuv2_40class",
        "wnsynsetid",
        "wnsynsetkey",
    ];
    file(
        path,
        &csv_text(&header, rows).map_err(|message| unwritable(path, message))?,
    )?;

    let path = "metadata/models.csv";
    let triple = |v: Vec3| format!("{}, {}, {}", v.x, v.y, v.z);
    let rows = models
        .iter()
        .filter(|row| !row.bounds.is_empty())
        .enumerate()
        .map(|(k, row)| {
            let dims = triple(row.bounds.size() * 100.0);
            let (min, max) = (triple(row.bounds.min), triple(row.bounds.max));
            vec![
                row.id.clone(),
                "0,0,1".to_owned(),
                row.slots.to_string(),
                min,
                max,
                dims,
                k.to_string(),
                String::new(),
            ]
        });
    let header = [
        "id",
        "front",
        "nmaterials",
        "minPoint",
        "maxPoint",
        "aligned.dims",
        "index",
        "variantIds",
    ];
    file(
        path,
        &csv_text(&header, rows).map_err(|message| unwritable(path, message))?,
    )?;

    let lights: BTreeMap<&str, &[SuncgLight]> = models
        .iter()
        .filter(|row| !row.lights.is_empty())
        .map(|row| (row.id.as_str(), row.lights.as_slice()))
        .collect();
    let sounds: Vec<SoundEntry> = models
        .iter()
        .filter(|row| !row.signals.is_empty())
        .map(|row| SoundEntry {
            category: OneOrMany::One(row.category.coarse.clone()),
            model_ids: vec![row.id.clone()],
            sounds: row
                .signals
                .iter()
                .enumerate()
                .map(|(k, signal)| (event(k), format!("{signal}.wav")))
                .collect(),
        })
        .collect();
    let json = |path: &str, text: Result<Vec<u8>, serde_json::Error>| {
        text.map_err(|error| unwritable(path, error.to_string()))
    };
    let path = "metadata/suncgModelLights.json";
    file(path, &json(path, serde_json::to_vec(&lights))?)?;
    let path = "metadata/sounds.json";
    file(path, &json(path, serde_json::to_vec_pretty(&sounds))?)
}

/// The name of the k-th event of a model.
fn event(k: usize) -> String {
    if k == 0 {
        "on".to_owned()
    } else {
        format!("on_{}", k + 1)
    }
}

fn csv_text(header: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Result<Vec<u8>, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer
        .write_record(header)
        .map_err(|error| error.to_string())?;
    for row in rows {
        writer
            .write_record(&row)
            .map_err(|error| error.to_string())?;
    }
    writer.into_inner().map_err(|error| error.to_string())
}

/// A light in the space of its model.
pub(super) fn light_in_model_space(light: &Light, model_from_part: &Affine3A) -> SuncgLight {
    let point = |p: Vec3| {
        model_from_part
            .transform_point3(p)
            .to_array()
            .map(f64::from)
    };
    let color = light
        .color
        .map(|c| (units::srgb_from_linear(c) * 255.0).round() as u8);
    let [r, g, b] = color;
    let file = SuncgLight {
        power: f64::from(light.power_w),
        color: format!("#{r:02x}{g:02x}{b:02x}"),
        position: point(light.position),
        attenuation: light.attenuation.map(f64::from),
        ..SuncgLight::default()
    };
    match light.shape {
        LightShape::Point => SuncgLight {
            kind: "PointLight".to_owned(),
            ..file
        },
        LightShape::Spot {
            direction,
            cutoff_rad,
            dropoff_rate,
        } => SuncgLight {
            kind: "SpotLight".to_owned(),
            direction: Some(
                model_from_part
                    .transform_vector3(direction)
                    .to_array()
                    .map(f64::from),
            ),
            cutoff_angle: Some(f64::from(cutoff_rad)),
            dropoff_rate: Some(f64::from(dropoff_rate)),
            ..file
        },
        LightShape::Line { end } => SuncgLight {
            kind: "LineLight".to_owned(),
            position2: Some(point(end)),
            ..file
        },
    }
}
