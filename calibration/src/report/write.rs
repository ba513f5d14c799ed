//! The report as files.

use super::data::CalibrationReport;
use crate::error::CalibrationError;
use dwell_scene::file;
use serde_json::Value;
use std::fs;
use std::path::Path;

impl CalibrationReport {
    /// The report as one JSON object; its key `html` holds the page.
    pub fn to_json(&self) -> String {
        let mut value = self.value();
        if let Value::Object(object) = &mut value {
            object.insert("html".to_owned(), Value::String(self.to_html()));
        }
        value.to_string()
    }

    fn value(&self) -> Value {
        // A report is plain data; numbers that are not finite become null.
        serde_json::to_value(self).unwrap_or(Value::Null)
    }

    /// Writes `report.json` (without the page), `report.html` and `found.json` into `folder`, which is made where it is
    /// missing. Each file appears whole or not at all.
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
        write_atomically(folder, "report.json", pretty(&self.value()).as_bytes())?;
        write_atomically(folder, "report.html", self.to_html().as_bytes())?;
        write_atomically(folder, "found.json", pretty(&found).as_bytes())
    }
}

/// Writes a file beside its place and moves it there.
pub(crate) fn write_atomically(
    folder: &Path,
    name: &str,
    bytes: &[u8],
) -> Result<(), CalibrationError> {
    let path = folder.join(name);
    file::write(&path, bytes).map_err(|source| CalibrationError::Write { path, source })
}
