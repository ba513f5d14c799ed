//! Houses from a seed: floor plan, building, furniture, small things, by rules that builders and people follow.
//!
//! Stages, each with plain data in and out and its own random stream, so that a change in one does not reshuffle another:
//! `programme` (which rooms, how large), `plan` (where they lie), `openings` (doors and windows), `shell` (the building),
//! `furnish` (furniture, lamps and small things).
//! Tries are bounded everywhere; what was given up is in the [`GenerateReport`].

mod furnish;
mod looks;
mod openings;
mod outline;
mod plan;
mod programme;
mod reach;
mod rooms;
mod shell;
mod spec;

#[cfg(test)]
mod tests;

pub use rooms::RoomKind;
pub use spec::{AssetSplit, DoorStates, HomeKind, HouseSpec};

use crate::building::assembly::Assembly;
use crate::damage::Damage;
use crate::error::HousesError;
use crate::formats::Opened;
use crate::report::{At, Report};
use dwell_furniture::style::{STYLES, Style};
use dwell_scene::House;
use dwell_scene::random::Key;
use openings::Hole;
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
    let mut last = None;
    // Where a room cannot be reached whatever is left out, another plan is drawn.
    for round in 0..HOUSES {
        let made = furnished_house(seed, spec, style, key.child("house").child(round))?;
        let done = made.unreached.is_empty();
        last = Some(made);
        if done {
            break;
        }
    }
    let made = last.ok_or_else(|| no_plan(spec, None))?;
    let mut given_up = made.given_up;
    given_up.extend(made.unreached.iter().map(|room| format!("a way to {room}")));
    let house = made.house;
    let report = GenerateReport {
        home: made.home,
        style: style.name.to_owned(),
        given_up,
    };
    Ok(Generated { house, report })
}

/// Houses that are drawn at most until every room is reached.
const HOUSES: u64 = 4;

/// A house and what became of the wishes for it.
struct Made {
    home: HomeKind,
    house: House,
    given_up: Vec<String>,
    /// Rooms that nobody can enter.
    unreached: Vec<String>,
}

fn furnished_house(
    seed: u64,
    spec: &HouseSpec,
    style: &Style,
    key: Key,
) -> Result<Made, HousesError> {
    let mut given_up = Vec::new();
    let Draft {
        programme,
        plan,
        holes,
        ..
    } = draft(spec, key, &mut given_up)?;
    for [a, b] in &plan.unmet {
        let [a, b] = [a, b].map(|kind| kind.traits().words[0]);
        given_up.push(format!("no door between {a} and {b}"));
    }
    if programme.outside.is_some() && !has_outside(&plan) {
        given_up.push("no place for a balcony or terrace".to_owned());
    }
    let mut built = None;
    // Where someone cannot reach a room for furniture, the house is furnished again with less.
    for (round, share) in DENSITIES.into_iter().enumerate() {
        let spec = HouseSpec {
            furniture_density: spec.furniture_density * share,
            ..spec.clone()
        };
        let furnisher = furnish::Furnisher {
            plan: &plan,
            holes: &holes,
            style,
            spec: &spec,
            key: key.child("furnish").child(round as u64),
        };
        let furnished = furnisher.furnish();
        let mut assembly = Assembly::new(&format!("seed_{seed}"), &format!("generate@{VERSION}"));
        let builder = shell::Builder {
            plan: &plan,
            holes: &holes,
            style,
            doors: spec.doors,
            key: key.child("shell"),
        };
        let shell = builder.build(&mut assembly);
        shell.furnish(&furnished, &mut assembly);
        let at = At::file(format!("seed:{seed}"));
        let house = House::new(assembly.finish()).map_err(HousesError::scene(&at))?;
        // Where all paths are wide and all ways are doors, everything is reached.
        let unreached = if furnish::is_narrow(&furnished) || has_opening(&plan) {
            reach::unreached(&house).map_err(HousesError::scene(&at))?
        } else {
            Vec::new()
        };
        let done = unreached.is_empty();
        built = Some((house, furnish::missing(&furnished), unreached));
        if done {
            break;
        }
    }
    let (house, missing, unreached) = built.ok_or_else(|| no_plan(spec, Some(&programme)))?;
    given_up.extend(missing);
    Ok(Made {
        home: programme.home,
        house,
        given_up,
        unreached,
    })
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
    let mut report = Report::new();
    for what in generated.report.given_up {
        report.warn(At::file(house), Damage::GivenUp { what });
    }
    Ok((generated.house, report))
}

/// Shares of the furniture that a home can do without, one after the other until every room is reached.
const DENSITIES: [f32; 4] = [1.0, 0.6, 0.3, 0.0];

/// Programmes that are drawn at most until one has a plan.
const PROGRAMMES: u64 = 8;

/// A house on paper.
struct Draft {
    programme: Programme,
    plan: FloorPlan,
    holes: Vec<Vec<Hole>>,
    /// Doors that stand in the way of others.
    tight: usize,
}

/// The first draft in which no door stands in the way of another, or the best of a few.
fn draft(spec: &HouseSpec, key: Key, given_up: &mut Vec<String>) -> Result<Draft, HousesError> {
    let mut best: Option<Draft> = None;
    let mut last = None;
    for round in 0..PROGRAMMES {
        let programme = programme::programme(spec, key.child("programme").child(round));
        check_area(spec, &programme)?;
        let drawn = plan::lay_out(&programme, &spec.adjacency, key.child("plan").child(round));
        let Some(plan) = drawn else {
            last = Some(programme);
            continue;
        };
        let (holes, tight) = openings::openings(&plan, key.child("openings").child(round));
        if best.as_ref().is_none_or(|best| tight < best.tight) {
            best = Some(Draft {
                programme,
                plan,
                holes,
                tight,
            });
        }
        if best.as_ref().is_some_and(|best| best.tight == 0) {
            break;
        }
    }
    let best = best.ok_or_else(|| no_plan(spec, last.as_ref()))?;
    if best.tight > 0 {
        given_up.push(format!("{} doors stand in the way of others", best.tight));
    }
    Ok(best)
}

fn style(spec: &HouseSpec, key: Key) -> &'static Style {
    let fitting: Vec<&Style> = STYLES
        .iter()
        .filter(|style| spec.split.allows(style.split))
        .filter(|style| spec.style.as_ref().is_none_or(|name| style.name == name))
        .collect();
    fitting[key.stream().below(fitting.len())]
}

/// Whether rooms open into each other without a door.
fn has_opening(plan: &FloorPlan) -> bool {
    let mut links = plan.storeys.iter().flat_map(|storey| &storey.links);
    links.any(|link| link.kind == plan::LinkKind::Open)
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
