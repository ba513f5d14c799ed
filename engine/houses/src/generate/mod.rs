//! Houses from a seed: floor plan, building, furniture, small things, by rules that builders and people follow.
//!
//! Stages, each with plain data in and out and its own random stream, so that a change in one does not reshuffle another:
//! `programme` (which rooms, how large), `plan` (where they lie), `openings` (doors and windows), `shell` (the building).
//! Tries are bounded everywhere; what was given up is in the [`GenerateReport`].

mod looks;
mod openings;
mod outline;
mod plan;
mod programme;
mod rooms;
mod shell;
mod spec;

#[cfg(test)]
mod tests;

pub use rooms::RoomKind;
pub use spec::{AssetSplit, DoorStates, HomeKind, HouseSpec};

use crate::building::assembly::Assembly;
use crate::error::HousesError;
use crate::formats::Opened;
use crate::furniture::style::{STYLES, Style};
use crate::report::{At, Report};
use dwell_scene::House;
use dwell_scene::random::Key;
use plan::FloorPlan;
use programme::Programme;
use serde::Serialize;

/// The version of the generator: another one may make other houses of the same seed.
pub const VERSION: u32 = 1;

/// A generated house.
#[derive(Debug)]
pub struct Generated {
    /// The house.
    pub house: House,
    /// What was drawn and what was given up.
    pub report: GenerateReport,
}

/// What was drawn and what was given up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GenerateReport {
    /// What kind of home it is.
    pub home: HomeKind,
    /// The style of its furniture.
    pub style: String,
    /// What was wanted and could not be had, in sentences.
    pub given_up: Vec<String>,
}

/// Makes the house of a seed.
///
/// # Errors
/// [`HousesError::Spec`] names a field, what was found, and what is possible.
///
/// # Determinism
/// The same seed and spec give the same bytes, for any number of threads.
pub fn generate(seed: u64, spec: &HouseSpec) -> Result<Generated, HousesError> {
    spec.check()?;
    let key = Key::root(seed).child("house");
    let style = style(spec, key.child("style"));
    let mut given_up = Vec::new();
    let (programme, plan) = plan_of(spec, key, &mut given_up)?;
    for [a, b] in &plan.unmet {
        let [a, b] = [a, b].map(|kind| kind.traits().words[0]);
        given_up.push(format!("no door between {a} and {b}"));
    }
    if programme.outside.is_some() && !has_outside(&plan) {
        given_up.push("no place for a balcony or terrace".to_owned());
    }
    let (holes, tight) = openings::openings(&plan, key.child("openings"));
    if tight > 0 {
        given_up.push(format!("{tight} doors stand in the way of others"));
    }
    let mut assembly = Assembly::new(&format!("seed_{seed}"), &format!("generate@{VERSION}"));
    let builder = shell::Builder {
        plan: &plan,
        holes: &holes,
        style,
        doors: spec.doors,
        key: key.child("shell"),
    };
    builder.build(&mut assembly);
    let house = House::new(assembly.finish())
        .map_err(HousesError::scene(&At::file(format!("seed:{seed}"))))?;
    let report = GenerateReport {
        home: programme.home,
        style: style.name.to_owned(),
        given_up,
    };
    Ok(Generated { house, report })
}

/// Opens `seed:N` and `seed:N?field=value&field=value`, the fields those of a [`HouseSpec`] and the values JSON or words.
pub(crate) fn open(house: &str) -> Opened {
    let wanted = house.trim_start_matches("seed:");
    let (number, fields) = wanted.split_once('?').unwrap_or((wanted, ""));
    let seed = number.parse().map_err(|_| HousesError::Spec {
        field: "seed".to_owned(),
        found: number.to_owned(),
        possible: "a whole number from 0 to 18446744073709551615".to_owned(),
    })?;
    let mut spec = serde_json::Map::new();
    for field in fields.split('&').filter(|field| !field.is_empty()) {
        let (name, value) = field.split_once('=').unwrap_or((field, ""));
        let value = serde_json::from_str(value).unwrap_or_else(|_| value.into());
        spec.insert(name.to_owned(), value);
    }
    let spec = serde_json::from_value(spec.into()).map_err(|error| HousesError::Spec {
        field: "spec".to_owned(),
        found: error.to_string(),
        possible: "the fields of a HouseSpec as field=value, joined by &".to_owned(),
    })?;
    let generated = generate(seed, &spec)?;
    Ok((generated.house, Report::new()))
}

/// Programmes that are drawn at most until one has a plan.
const PROGRAMMES: u64 = 8;

fn plan_of(
    spec: &HouseSpec,
    key: Key,
    given_up: &mut Vec<String>,
) -> Result<(Programme, FloorPlan), HousesError> {
    let mut last = None;
    for round in 0..PROGRAMMES {
        let programme = programme::programme(spec, key.child("programme").child(round));
        check_area(spec, &programme)?;
        let drawn = plan::lay_out(&programme, &spec.adjacency, key.child("plan").child(round));
        if let Some(plan) = drawn {
            return Ok((programme, plan));
        }
        if round == 0 {
            given_up.push("the rooms that were drawn first: no plan holds them".to_owned());
        }
        last = Some(programme);
    }
    Err(no_plan(spec, last.as_ref()))
}

fn style(spec: &HouseSpec, key: Key) -> &'static Style {
    let fitting: Vec<&Style> = STYLES
        .iter()
        .filter(|style| spec.split.allows(style.split))
        .filter(|style| spec.style.as_ref().is_none_or(|name| style.name == name))
        .collect();
    fitting[key.stream().below(fitting.len())]
}

fn has_outside(plan: &FloorPlan) -> bool {
    let mut rooms = plan.storeys.iter().flat_map(|storey| &storey.rooms);
    rooms.any(|room| room.kind.is_outside())
}

/// Refuses an area that the home's rooms cannot have.
fn check_area(spec: &HouseSpec, programme: &Programme) -> Result<(), HousesError> {
    let Some(area) = spec.area_m2 else {
        return Ok(());
    };
    let rooms = || programme.storeys.iter().flatten();
    let [least, most] = [0, 2].map(|k| {
        rooms()
            .map(|room| room.kind.traits().area_m2[k])
            .sum::<f32>()
    });
    let (least, most) = (least * 1.05, most * 1.4);
    if (least..=most).contains(&area) {
        return Ok(());
    }
    Err(HousesError::Spec {
        field: "area_m2".to_owned(),
        found: area.to_string(),
        possible: format!(
            "{least:.0} to {most:.0} for {} rooms of this home",
            rooms().count()
        ),
    })
}

fn no_plan(spec: &HouseSpec, programme: Option<&Programme>) -> HousesError {
    let rooms = || {
        programme
            .into_iter()
            .flat_map(|programme| &programme.storeys)
            .flatten()
    };
    let area: f32 = rooms().map(|room| room.area_m2).sum();
    let kinds: Vec<&str> = rooms().map(|room| room.kind.traits().name).collect();
    HousesError::Spec {
        field: if spec.rooms.is_empty() {
            "area_m2"
        } else {
            "rooms"
        }
        .to_owned(),
        found: format!("{} on {area:.0} m2", kinds.join(", ")),
        possible: "another area, other rooms or another number of storeys: no plan was found"
            .to_owned(),
    }
}
