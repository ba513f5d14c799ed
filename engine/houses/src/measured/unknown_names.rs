//! Unknown names in the file: misspelt ones are refused, all others are the user's own.

use super::file::MeasuredRoomFile;
use crate::error::HousesError;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;
use dwell_scene::name_suggestions::is_within_edit_distance;

/// The fields of the file, those of the measurement among them.
const FIELDS: [&str; 11] = [
    "air",
    "bands_hz",
    "duration_s",
    "fs",
    "materials",
    "mesh",
    "name",
    "receivers",
    "shoebox",
    "sources",
    "walls",
];
const MATERIAL_FIELDS: [&str; 2] = ["absorption", "scattering"];
/// Largest number of differing letters of a misspelt name.
const SLIP_LETTERS: usize = 2;
/// Length up to which names have too many similar words: only other case and one letter too many are misspellings.
const SHORT: usize = 4;

/// Refuses unknown names that are nearly a field's, whose value would silently be the default; other names in a material are
/// warnings, and other fields of the file belong to the measurement.
///
/// # Errors
/// [`HousesError::Field`] with the field that was meant.
pub(super) fn refuse_misspelled_names(
    file: &MeasuredRoomFile,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Result<(), HousesError> {
    // "source" beside "sources" is no misspelling.
    let is_there = |field: &&str| file.other_fields.contains_key(*field);
    let (there, absent): (Vec<_>, Vec<_>) = FIELDS.into_iter().partition(is_there);
    for name in file.other_fields.keys() {
        if !there.contains(&&**name) {
            refuse_misspelling(at, name, &absent)?;
            if let Some(field) = absent.iter().find(|field| is_one_letter_off(name, field)) {
                let found = format!("{name} (nearly {field})");
                report.warn(at.clone(), WarningKind::BadStatement { found });
            }
        }
    }
    for (material, values) in &file.materials {
        let at = at.field("materials").field(material);
        for name in values.other_fields.keys() {
            refuse_misspelling(&at, name, &MATERIAL_FIELDS)?;
            let found = name.chars().take(60).collect();
            report.warn(at.clone(), WarningKind::BadStatement { found });
        }
    }
    Ok(())
}

fn refuse_misspelling(
    at: &FileLocation,
    name: &str,
    fields: &[&'static str],
) -> Result<(), HousesError> {
    let meant = fields.iter().find(|field| {
        is_within_edit_distance(name, field, SLIP_LETTERS) || is_short_slip(name, field)
    });
    meant.map_or(Ok(()), |field| {
        Err(HousesError::Field {
            at: at.field(name),
            expected: "a name of its own, or the exact name of a field",
            found: format!("nearly {field:?}"),
        })
    })
}

/// Returns whether a name differs from a short one, of which too many are another word to refuse it, by one letter but the first.
fn is_one_letter_off(name: &str, field: &str) -> bool {
    let differ = name
        .chars()
        .zip(field.chars())
        .filter(|(a, b)| a != b)
        .count();
    let lengths = [name, field].map(|text| text.chars().count());
    field.len() <= SHORT
        && lengths[0] == lengths[1]
        && differ == 1
        && name.chars().next() == field.chars().next()
}

/// Returns whether a name is a short one in other case, or with one letter too many.
fn is_short_slip(name: &str, field: &str) -> bool {
    let letters: Vec<char> = name
        .chars()
        .flat_map(char::to_lowercase)
        .take(SHORT + 2)
        .collect();
    let without = |k: usize| {
        let (head, tail) = letters.split_at(k);
        head.iter()
            .chain(&tail[1..])
            .eq(field.chars().collect::<Vec<_>>().iter())
    };
    field.len() <= SHORT
        && (letters.iter().copied().eq(field.chars()) || (0..letters.len()).any(without))
}
