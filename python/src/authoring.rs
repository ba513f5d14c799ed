//! Authoring of houses for Python: plans and edits come as JSON.

use crate::answers::PyValue;
use crate::errors::PyFault;
use dwell::Engines;
use dwell_acoustics::{Recording, signals};
use dwell_houses::authoring::{self, FileAccess, HousePlan, UnmappedNames};
use dwell_houses::{FileLocation, LoadReport};
use dwell_scene::House;
use serde_json::Value;

/// The report of damage with a sentence for each warning.
pub(crate) fn report_rows(report: &LoadReport) -> Result<Value, PyFault> {
    let mut rows = serde_json::to_value(report)?;
    if let Some(warnings) = rows["warnings"].as_array_mut() {
        for (row, warning) in warnings.iter_mut().zip(report.warnings()) {
            row["sentence"] = warning.to_string().into();
        }
    }
    Ok(rows)
}

/// The house of a plan.
pub(crate) fn build_plan(plan_json: &str) -> Result<(House, Value), PyFault> {
    let plan = HousePlan::from_json(plan_json.as_bytes(), &FileLocation::file("plan"))?;
    let (house, report) = authoring::build(&plan, &FileAccess::Anywhere)?;
    check_signals(&house, 0)?;
    Ok((house, report_rows(&report)?))
}

/// The same house with edits.
pub(crate) fn apply_edits(
    base: &House,
    base_report: &Value,
    edits_json: &str,
) -> Result<(House, Value), PyFault> {
    let edits = authoring::edits_from_json(edits_json)?;
    let (house, report) = authoring::edit(base, &edits, &FileAccess::Anywhere)?;
    check_signals(&house, base.emitters.len())?;
    let mut all = report_of(base_report);
    all.append_by_place(report);
    Ok((house, report_rows(&all)?))
}

/// Refuses signals that do not exist.
fn check_signals(house: &House, known: usize) -> Result<(), PyFault> {
    for emitter in house.emitters.iter().skip(known.min(house.emitters.len())) {
        let told = match emitter.sound_file {
            Some(file) => {
                let file = &house.sound_files[file];
                Recording::decode(&file.name, &file.bytes).map(drop)
            }
            None => signals::info(&emitter.signal).map(drop),
        };
        told.map_err(|error| PyFault::House(error.to_string()))?;
    }
    Ok(())
}

fn report_of(rows: &Value) -> LoadReport {
    serde_json::from_value(rows.clone()).unwrap_or_default()
}

fn unmapped(house: &House, report: &Value) -> UnmappedNames {
    authoring::unmapped_names(house, &report_of(report))
}

/// Counts, rooms and categories, with what stayed unmapped.
pub(crate) fn info(engines: &Engines, report: &Value) -> Result<PyValue, PyFault> {
    let mut info = dwell::house_info(engines, report);
    info["unmapped"] = serde_json::to_value(unmapped(engines.house(), report))?;
    PyValue::of(&info)
}

/// A map file for the unmapped names.
pub(crate) fn map_template(house: &House, report: &Value, name: &str) -> String {
    authoring::map_template(name, &unmapped(house, report))
}
