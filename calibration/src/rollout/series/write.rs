//! The report of a series as files.

use super::ModelComparisonReport;
use crate::error::CalibrationError;
use crate::report::write_atomically;
use crate::rollout::box_plot;
use serde_json::Value;
use std::fs;
use std::path::Path;

impl ModelComparisonReport {
    /// The report as one JSON object; its key `html` holds the page.
    pub fn to_json(&self) -> String {
        let mut value = self.value();
        if let Value::Object(object) = &mut value {
            object.insert("kind".to_owned(), Value::from("series"));
            object.insert("html".to_owned(), Value::String(self.to_html()));
        }
        value.to_string()
    }

    fn value(&self) -> Value {
        // A report is plain data; numbers that are not finite become null.
        serde_json::to_value(self).unwrap_or(Value::Null)
    }

    /// Writes `report.json`, `report.html`, `found.json` and the pictures into `folder`, which is made where it is missing.
    /// Each file appears whole or not at all.
    ///
    /// # Errors
    /// [`CalibrationError::Write`] names the file.
    pub fn write(&self, folder: &Path) -> Result<(), CalibrationError> {
        fs::create_dir_all(folder).map_err(|source| CalibrationError::Write {
            path: folder.to_owned(),
            source,
        })?;
        let pretty = |value: &Value| format!("{value:#}\n");
        let found = serde_json::to_value(&self.found).unwrap_or(Value::Null);
        for residuals in &self.residuals {
            let name = format!("{}.svg", residuals.name);
            write_atomically(folder, &name, box_plot::to_svg_file(residuals).as_bytes())?;
        }
        write_atomically(folder, "report.json", pretty(&self.value()).as_bytes())?;
        write_atomically(folder, "report.html", self.to_html().as_bytes())?;
        write_atomically(folder, "found.json", pretty(&found).as_bytes())
    }
}
