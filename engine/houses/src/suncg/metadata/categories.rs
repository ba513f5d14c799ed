//! `ModelCategoryMapping.csv`: the category of each model.

use std::collections::BTreeMap;

use super::base_model;
use super::rows::CsvRows;
use crate::report::{FileLocation, LoadReport};

/// A row of the table.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CategoryEntry {
    /// `coffee_table`.
    pub fine: String,
    /// `table`.
    pub coarse: String,
    /// 0 empty, 1 structure, 2 object.
    pub structure: u8,
    /// The NYU-40 name, as spelled there.
    pub nyu40: String,
    /// The `WordNet` synset, `n04446276`.
    pub wordnet: String,
}

/// All rows by model id. Variants (`122_0`) are looked up as their model.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CategoryTable {
    rows: BTreeMap<String, CategoryEntry>,
}

impl CategoryTable {
    /// Reads the table, of either release.
    pub fn read(text: &[u8], file: &str, report: &mut LoadReport) -> Self {
        let at = FileLocation::file(file);
        let names = [
            "model_id",
            "fine_grained_class",
            "coarse_grained_class",
            "empty_struct_obj",
            "nyuv2_40class",
            "wnsynsetid",
        ];
        let mut table = Self::default();
        let consequence = "no object has a category";
        let Some(rows) = CsvRows::new(text, &names, &at, consequence, report) else {
            return table;
        };
        rows.for_each(&at, report, |row| {
            if row.cell(0).is_empty() {
                return Err("no model_id");
            }
            let cell = |column: usize| row.cell(column).to_owned();
            let structure = row.number(3).unwrap_or(2);
            let entry = CategoryEntry {
                fine: cell(1),
                coarse: cell(2),
                structure,
                nyu40: cell(4),
                wordnet: cell(5),
            };
            table.rows.insert(cell(0), entry);
            Ok(())
        });
        table
    }

    /// The row of a model.
    pub fn get(&self, model: &str) -> Option<&CategoryEntry> {
        self.rows
            .get(model)
            .or_else(|| self.rows.get(base_model(model)))
    }

    /// All rows, by model id.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &CategoryEntry)> {
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
