//! Plans of houses, as plain data and as files `NAME.plan.json`.

use std::ffi::OsStr;
use std::path::Path;

use dwell_scene::House;
use dwell_scene::parallel::Threads;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use super::apply::edit;
use super::edit_errors::{invalid_field, prefix_field};
use super::edits::Edit;
use super::files::FileAccess;
use super::floor_plan::{BuildingPlan, build_house_data};
use crate::data_root::{UserFile, is_json_containing, read_up_to};
use crate::error::HousesError;
use crate::formats::{FORMATS, open_by};
use crate::json;
use crate::limits::MAX_TEXT_BYTES;
use crate::opened::OpenResult;
use crate::report::{FileLocation, LoadReport};

/// Value of the field `format` of a plan file.
const FORMAT: &str = "dwell-plan";
/// The version that is written and read.
const VERSION: u32 = 1;
/// Ending of a plan file's name.
const ENDING: &str = ".plan.json";

/// The plan of a house: a building or another house, and edits, one after another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HousePlan {
    /// `"dwell-plan"`.
    pub format: String,
    /// 1.
    pub version: u32,
    /// The house's name; empty: that of the file or of the house that it is based on.
    pub name: String,
    /// A HOUSE that is edited.
    pub house: Option<String>,
    /// A building that is raised; not beside a house.
    pub building: Option<BuildingPlan>,
    /// The edits, in order.
    pub edits: Vec<Edit>,
}

impl Default for HousePlan {
    fn default() -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            name: String::new(),
            house: None,
            building: None,
            edits: Vec::new(),
        }
    }
}

/// Reads edits from JSON.
///
/// # Errors
/// [`HousesError::Syntax`] with what was found and what is allowed there.
pub fn edits_from_json(text: &str) -> Result<Vec<Edit>, HousesError> {
    let at = FileLocation::file("edits");
    serde_json::from_str(text).map_err(|error| {
        edit_name_count_error(text.as_bytes(), &at).unwrap_or_else(|| json::syntax(&at)(error))
    })
}

/// The fault of an edit that has several names, or none; `None` where all have one.
fn edit_name_count_error(text: &[u8], at: &FileLocation) -> Option<HousesError> {
    let file: serde_json::Value = serde_json::from_slice(text).ok()?;
    let edits = file.get("edits").unwrap_or(&file).as_array()?;
    let names = |edit: &serde_json::Value| Some(edit.as_object()?.keys().cloned().collect());
    let mut all = edits.iter().enumerate();
    all.find_map(|(k, edit)| {
        let names: Vec<String> = names(edit)?;
        (names.len() != 1).then(|| HousesError::Field {
            at: at.field(format_args!("edits[{k}]")),
            expected: "one edit: an object with one name",
            found: format!("{} names: {:.200}", names.len(), names.join(", ")),
        })
    })
}

impl HousePlan {
    /// Reads a plan from JSON; `at` is the place in errors.
    ///
    /// # Errors
    /// [`HousesError::Syntax`], [`HousesError::Field`] for another format, [`HousesError::Version`].
    pub fn from_json(text: &[u8], at: &FileLocation) -> Result<Self, HousesError> {
        if text.trim_ascii_start().starts_with(b"[") {
            return Err(HousesError::Syntax {
                at: at.clone(),
                message: "found a list; expected an object with format, version and rooms"
                    .to_owned(),
            });
        }
        let plan: Self = json::from_slice(text).map_err(|error| {
            edit_name_count_error(text, at).unwrap_or_else(|| json::syntax(at)(error))
        })?;
        if plan.format != FORMAT {
            return Err(HousesError::Field {
                at: at.field("format"),
                expected: "\"dwell-plan\"",
                found: format!("{:?}", plan.format),
            });
        }
        if plan.version != VERSION {
            return Err(HousesError::Version {
                at: at.field("version"),
                found: plan.version.to_string(),
                allowed: vec![VERSION.to_string()],
            });
        }
        Ok(plan)
    }
}

/// Builds the house of a plan.
///
/// # Errors
/// [`HousesError::Spec`] names storey and room, or the edit, and the field, what was found and what is possible; otherwise
/// what readers of files say.
///
/// # Determinism
/// The same plan and files give the same house for any number of threads.
///
/// ```
/// use dwell_houses::authoring::{FileAccess, HousePlan, build};
/// let plan: HousePlan = serde_json::from_str(
///     r#"{"building": {"storeys": [{"rooms": [{"name": "study", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}]}]}}"#,
/// )?;
/// let (house, _) = build(&plan, &FileAccess::Anywhere)?;
/// assert!((house.rooms.as_slice()[0].area_m2() - 12.0).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn build(plan: &HousePlan, files: &FileAccess) -> Result<(House, LoadReport), HousesError> {
    build_with(plan, files, Threads::default())
}

fn build_with(
    plan: &HousePlan,
    files: &FileAccess,
    threads: Threads,
) -> Result<(House, LoadReport), HousesError> {
    let (base, mut report) = match (&plan.house, &plan.building) {
        (Some(house), None) => open_by(FORMATS, &files.resolve_house("house", house)?, threads)?,
        (None, Some(building)) => {
            let data = build_house_data(&plan.name, building).map_err(prefix_field("building"))?;
            let house =
                House::new(data).map_err(HousesError::scene(&FileLocation::file("plan")))?;
            (house, LoadReport::new())
        }
        (both, _) => {
            let found = if both.is_some() { "both" } else { "neither" };
            return Err(invalid_field("house, building", found, "one of them"));
        }
    };
    let (mut house, more) = edit(&base, &plan.edits, files)?;
    report.append(more);
    if !plan.name.is_empty() && plan.name != house.name {
        let mut data = house.data().clone();
        data.name.clone_from(&plan.name);
        house = House::new(data).map_err(HousesError::scene(&FileLocation::file("plan")))?;
    }
    Ok((house, report))
}

/// Returns whether `path` names a plan: by its ending, or as a `.json` that says so or has the look of one.
pub(crate) fn recognizes(path: &Path) -> bool {
    let is_other = || {
        let others = [
            crate::habitat::recognizes,
            crate::procthor::recognizes,
            crate::measured::recognizes,
        ];
        others.iter().any(|recognizes| recognizes(path))
    };
    is_named_as_plan(path)
        || is_json_containing(path, &[&["\"dwell-plan\""]])
        || (is_json_containing(path, &[&PlanLook::WORDS])
            && !is_other()
            && PlanLook::is_that_of(path))
}

fn is_named_as_plan(path: &Path) -> bool {
    let lower = |name: &OsStr| name.to_string_lossy().to_ascii_lowercase();
    path.file_name()
        .is_some_and(|name| lower(name).ends_with(ENDING))
}

/// What tells a plan from a house of SUNCG, which may be any `.json`.
#[derive(Deserialize)]
struct PlanLook {
    format: Option<serde_json::Value>,
    building: Option<IgnoredAny>,
    edits: Option<IgnoredAny>,
    levels: Option<IgnoredAny>,
}

impl PlanLook {
    /// One of them stands in each.
    const WORDS: [&'static str; 3] = ["\"format\"", "\"building\"", "\"edits\""];

    fn is_that_of(path: &Path) -> bool {
        let text = read_up_to(path, "", MAX_TEXT_BYTES).unwrap_or_default();
        json::from_slice(&text).is_ok_and(|look: Self| {
            let has_parts = look.building.is_some() || look.edits.is_some();
            look.levels.is_none() && (look.format.is_some() || has_parts)
        })
    }

    /// Refuses a file that names no format, or one of nothing that is opened.
    fn check_format(text: &[u8], at: &FileLocation) -> Result<(), HousesError> {
        let Ok(look) = json::from_slice::<Self>(text) else {
            // What it is instead is told by the reader of plans.
            return Ok(());
        };
        if look.format.as_ref().is_some_and(|format| format == FORMAT) {
            return Ok(());
        }
        let found = look
            .format
            .map_or_else(|| "nothing".to_owned(), |format| format.to_string());
        Err(HousesError::Field {
            at: at.field("format"),
            expected: "\"dwell-plan\", the only one that a house's .json names: those of SUNCG, ProcTHOR, Habitat and measured \
                       rooms have none, and our own houses are opened by their folder NAME.dwell",
            found: found.chars().take(200).collect(),
        })
    }
}

/// Opens a plan file; the files that it names are read below its folder.
pub(crate) fn open(path: &Path, threads: Threads) -> OpenResult {
    let UserFile { root, name, bytes } = UserFile::read(path, MAX_TEXT_BYTES)?;
    let at = FileLocation::file(&name);
    if !is_named_as_plan(path) {
        PlanLook::check_format(&bytes, &at)?;
    }
    let mut plan = HousePlan::from_json(&bytes, &at)?;
    if plan.name.is_empty() && plan.building.is_some() {
        let lower = name.to_ascii_lowercase();
        let stem = lower.strip_suffix(ENDING).or(lower.strip_suffix(".json"));
        name[..stem.unwrap_or(&lower).len()].clone_into(&mut plan.name);
    }
    build_with(&plan, &FileAccess::Below(root), threads).map_err(|error| error.in_file(&name))
}
