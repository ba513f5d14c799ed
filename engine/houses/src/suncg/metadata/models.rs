//! `models.csv`: sizes of the models.

use std::collections::BTreeMap;

use super::rows::CsvRows;
use crate::report::{FileLocation, LoadReport};

/// A row of the table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelEntry {
    /// The model's front direction; `[0, 0, 1]` for nearly all.
    pub front: [f64; 3],
    /// Smallest coordinates, m.
    pub min_m: [f64; 3],
    /// Largest coordinates, m.
    pub max_m: [f64; 3],
    /// Width, height and depth when the front looks along +Z, **cm**.
    pub aligned_dims_cm: [f64; 3],
    /// Number of materials that the file states.
    pub materials: u32,
}

impl ModelEntry {
    /// The volume of the aligned box, m³.
    pub fn box_volume_m3(&self) -> f64 {
        self.aligned_dims_cm.iter().map(|cm| cm / 100.0).product()
    }
}

/// All rows by id; variants (`122_0`) have rows of their own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelTable {
    rows: BTreeMap<String, ModelEntry>,
}

impl ModelTable {
    /// Reads the table.
    pub fn read(text: &[u8], file: &str, report: &mut LoadReport) -> Self {
        let at = FileLocation::file(file);
        let names = [
            "id",
            "front",
            "nmaterials",
            "minPoint",
            "maxPoint",
            "aligned.dims",
        ];
        let mut table = Self::default();
        let consequence = "no model has a size";
        let Some(rows) = CsvRows::new(text, &names, &at, consequence, report) else {
            return table;
        };
        rows.for_each(&at, report, |row| {
            if row.cell(0).is_empty() {
                return Err("no id");
            }
            let entry = ModelEntry {
                front: row.triple(1).unwrap_or([0.0, 0.0, 1.0]),
                materials: row.number(2).unwrap_or(0),
                min_m: row.triple(3).ok_or("minPoint is not \"x, y, z\"")?,
                max_m: row.triple(4).ok_or("maxPoint is not \"x, y, z\"")?,
                aligned_dims_cm: row.triple(5).ok_or("aligned.dims is not \"w, h, d\"")?,
            };
            table.rows.insert(row.cell(0).to_owned(), entry);
            Ok(())
        });
        table
    }

    /// The row of a model or variant.
    pub fn get(&self, id: &str) -> Option<&ModelEntry> {
        self.rows.get(id)
    }

    /// All rows, by id.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &ModelEntry)> {
        self.rows.iter().map(|(id, row)| (id.as_str(), row))
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}
