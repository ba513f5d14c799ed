//! Houses from a seed: floor plan, building, furniture, small things, by rules that builders and people follow.
//!
//! Stages, each with plain data in and out and its own random stream, so that a change in one does not reshuffle another:
//! `room_program` (rooms and their sizes), `plan` (their layout), `openings` (doors and windows), `shell` (the building),
//! `furnish` (furniture, lamps and small things).
//! Tries are bounded everywhere; omissions are in the [`GenerateReport`].

mod furnish;
mod openings;
mod plan;
mod reachability;
pub(crate) mod room_finishes;
mod room_program;
mod rooms;
mod shell;
mod spec;

#[cfg(test)]
mod tests;

pub use rooms::GeneratedRoomKind;
pub use spec::{AssetSplit, DoorStates, HomeKind, HouseSpec};

use crate::building::assembly::HouseAssembly;
use crate::error::HousesError;
use crate::opened::OpenResult;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;
use dwell_furniture::style::{STYLES, Style};
use dwell_scene::random::RandomKey;
use dwell_scene::{House, SceneError, Sky, SkyConditions};
use openings::WallHole;
use plan::{GeneratedPlan, StoreyCells};
use room_program::RoomProgram;
use serde::Serialize;

/// The version of the generator: another one may make other houses of the same seed.
pub const VERSION: u32 = 4;

/// A generated house.
#[derive(Debug)]
pub struct GeneratedHouse {
    /// The house.
    pub house: House,
    /// The draws, and what was given up.
    pub report: GenerateReport,
}

/// The draws of a generated house, and what was given up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GenerateReport {
    /// The kind of home.
    pub home: HomeKind,
    /// The style of its furniture.
    pub style: String,
    /// The omissions: what was wanted but did not fit, in sentences.
    pub given_up: Vec<String>,
}

/// Generates the house of a seed.
///
/// # Errors
/// [`HousesError::Spec`] names a field, what was found, and what is possible.
///
/// # Determinism
/// The same seed and spec give the same bytes, for any number of threads.
pub fn generate(seed: u64, spec: &HouseSpec) -> Result<GeneratedHouse, HousesError> {
    spec.check()?;
    let key = RandomKey::root(seed).child("house");
    let style = style(spec, key.child("style"));
    let mut best: Option<FurnishedPlan> = None;
    // Where a room stays unreachable with any furniture left out, another plan is drawn.
    for round in 0..HOUSES {
        let paper = furnished_plan(spec, style, key.child("house").child(round))?;
        let lost = |paper: &FurnishedPlan| paper.unreached.len();
        if best.as_ref().is_none_or(|best| lost(&paper) < lost(best)) {
            best = Some(paper);
        }
        if best.as_ref().is_some_and(|best| lost(best) == 0) {
            break;
        }
    }
    let paper = best.ok_or_else(|| no_plan(spec, None))?;
    let FurnishedPlan {
        draft, furnished, ..
    } = &paper;
    let mut assembly = HouseAssembly::new(&format!("seed_{seed}"), &format!("generate@{VERSION}"));
    let builder = shell::ShellBuilder {
        plan: &draft.plan,
        holes: &draft.holes,
        style,
        doors: spec.doors,
        key: paper.key.child("shell"),
    };
    let shell = builder.build(&mut assembly);
    shell.furnish(furnished, &mut assembly);
    let at = FileLocation::file(format!("seed:{seed}"));
    assembly.data.sky = Some(sky(spec, key.child("sky")).map_err(HousesError::scene(&at))?);
    let house = House::new(assembly.finish()).map_err(HousesError::scene(&at))?;
    let mut given_up = draft.given_up();
    given_up.extend(furnish::missing_items(furnished));
    given_up.extend(paper.unreached.iter().map(|(level, room)| {
        let id = shell.rooms[*level][*room];
        format!("a way to {}", house.rooms[id].name)
    }));
    let report = GenerateReport {
        home: draft.programme.home,
        style: style.name.to_owned(),
        given_up,
    };
    Ok(GeneratedHouse { house, report })
}

/// Largest number of houses that are drawn until every room is reached.
const HOUSES: u64 = 4;

/// A furnished plan.
struct FurnishedPlan {
    key: RandomKey,
    draft: UnfurnishedPlan,
    furnished: Vec<Vec<furnish::RoomFurniture>>,
    /// Unreachable rooms.
    unreached: Vec<reachability::RoomIndex>,
}

/// Furnishes a plan. Rooms that cannot be reached for furniture, and those beside them, are furnished again with less.
fn furnished_plan(
    spec: &HouseSpec,
    style: &Style,
    key: RandomKey,
) -> Result<FurnishedPlan, HousesError> {
    let draft = draft(spec, key)?;
    let furnish_key = key.child("furnish");
    let furnisher = furnish::HouseFurnisher {
        plan: &draft.plan,
        wall_holes: &draft.holes,
        style,
        spec,
        key: furnish_key.child(0_u64),
    };
    let mut furnished = furnisher.furnish();
    let mut unreached = reachability::unreachable_rooms(&draft.plan, &draft.holes, &furnished);
    for (round, share) in SHARES.into_iter().enumerate() {
        if unreached.is_empty() {
            break;
        }
        for (level, storey) in draft.plan.storeys.iter().enumerate() {
            let cells = StoreyCells::new(&storey.rooms);
            let lost = |room: usize| unreached.contains(&(level, room));
            for (room, place) in furnished[level].iter_mut().enumerate() {
                let beside = storey.connections.iter().any(|link| {
                    link.into == room && link.from.is_some_and(lost)
                        || link.from == Some(room) && lost(link.into)
                });
                if lost(room) || beside {
                    let key = furnish_key.child(1 + round as u64);
                    *place = furnisher.furnish_room(level, &cells, room, share, key);
                }
            }
        }
        unreached = reachability::unreachable_rooms(&draft.plan, &draft.holes, &furnished);
    }
    Ok(FurnishedPlan {
        key,
        draft,
        furnished,
        unreached,
    })
}

/// Opens `seed:N` and `seed:N?field=value&field=value`, the fields those of a [`HouseSpec`] and the values JSON or words.
pub(crate) fn open(house: &str) -> OpenResult {
    let wanted = house.strip_prefix("seed:").unwrap_or(house);
    let (number, fields) = wanted.split_once('?').unwrap_or((wanted, ""));
    let seed = number.parse().map_err(|_| HousesError::Spec {
        field: "seed".to_owned(),
        found: if number.is_empty() {
            "nothing".to_owned()
        } else {
            number.to_owned()
        },
        possible: "a whole number from 0 to 18446744073709551615; A..B only where several houses are taken"
            .to_owned(),
    })?;
    let generated = generate(seed, &spec_of(fields)?)?;
    let mut report = LoadReport::new();
    for what in generated.report.given_up {
        report.warn(FileLocation::file(house), WarningKind::Omitted { what });
    }
    Ok((generated.house, report))
}

/// The spec of `field=value&field=value`, checked as far as possible for any seed.
///
/// # Errors
/// [`HousesError::Spec`] names the field, what was found, and what is possible.
pub(crate) fn spec_of(fields: &str) -> Result<HouseSpec, HousesError> {
    let mut spec = serde_json::Map::new();
    for field in fields.split('&').filter(|field| !field.is_empty()) {
        let (name, value) = field.split_once('=').unwrap_or((field, ""));
        let value = serde_json::from_str(value).unwrap_or_else(|_| value.into());
        if spec.insert(name.to_owned(), value).is_some() {
            return Err(HousesError::Spec {
                field: name.to_owned(),
                found: "it twice".to_owned(),
                possible: "each field once".to_owned(),
            });
        }
    }
    let spec = parsed(spec)?;
    spec.check()?;
    Ok(spec)
}

/// The spec of some fields; an error names the first that cannot be read.
fn parsed(fields: serde_json::Map<String, serde_json::Value>) -> Result<HouseSpec, HousesError> {
    let read = |fields: serde_json::Map<_, _>| serde_json::from_value::<HouseSpec>(fields.into());
    for (name, value) in &fields {
        let alone = [(name.clone(), value.clone())].into_iter().collect();
        read(alone).map_err(|error| HousesError::Spec {
            field: name.clone(),
            found: crate::plain_parse_error(&error),
            possible: "the fields of a HouseSpec as field=value, joined by &".to_owned(),
        })?;
    }
    read(fields).map_err(|error| HousesError::Spec {
        field: "spec".to_owned(),
        found: crate::plain_parse_error(&error),
        possible: "the fields of a HouseSpec as field=value, joined by &".to_owned(),
    })
}

/// Shares of the optional furniture of a room, tried in turn until it is reached.
const SHARES: [f32; 3] = [0.6, 0.3, 0.0];

/// Largest number of programmes that are drawn until one has a plan.
const PROGRAMMES: u64 = 8;

/// A plan before it is furnished.
struct UnfurnishedPlan {
    programme: RoomProgram,
    plan: GeneratedPlan,
    holes: Vec<Vec<WallHole>>,
    /// Number of doors that block others.
    tight: usize,
}

impl UnfurnishedPlan {
    /// Returns the omissions, in sentences.
    fn given_up(&self) -> Vec<String> {
        let missing_connections = self.plan.missing_connections.iter().map(|pair| {
            let [a, b] = pair.map(|kind| kind.requirements().everyday_names[0]);
            format!("no door between {a} and {b}")
        });
        let mut given_up: Vec<String> = missing_connections.collect();
        if self.tight > 0 {
            given_up.push(format!("{} doors stand in the way of others", self.tight));
        }
        if self.programme.outside.is_some() && !has_outside(&self.plan) {
            given_up.push("no place for a balcony or terrace".to_owned());
        }
        given_up
    }
}

/// The first draft in which no door blocks another, or the best of a few.
fn draft(spec: &HouseSpec, key: RandomKey) -> Result<UnfurnishedPlan, HousesError> {
    let mut best: Option<UnfurnishedPlan> = None;
    let mut last = None;
    for round in 0..PROGRAMMES {
        let programme = room_program::draw_room_program(spec, key.child("programme").child(round));
        check_area(spec, &programme)?;
        let drawn = plan::best_plan(&programme, &spec.adjacency, key.child("plan").child(round));
        let Some(plan) = drawn else {
            last = Some(programme);
            continue;
        };
        let (holes, tight) = openings::openings(&plan, key.child("openings").child(round));
        if best.as_ref().is_none_or(|best| tight < best.tight) {
            best = Some(UnfurnishedPlan {
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
    best.ok_or_else(|| no_plan(spec, last.as_ref()))
}

fn style(spec: &HouseSpec, key: RandomKey) -> &'static Style {
    let fitting: Vec<&Style> = STYLES
        .iter()
        .filter(|style| spec.split.allows(style.split))
        .filter(|style| spec.style.as_ref().is_none_or(|name| style.name == name))
        .collect();
    fitting[key.stream().below(fitting.len())]
}

/// The open air at the hour of the spec; north lies anywhere.
fn sky(spec: &HouseSpec, key: RandomKey) -> Result<Sky, SceneError> {
    Sky::at(&SkyConditions {
        hour_h: spec.time_of_day,
        north_yaw_deg: key.stream().uniform_f32() * 360.0 - 180.0,
        ..SkyConditions::default()
    })
}

fn has_outside(plan: &GeneratedPlan) -> bool {
    let mut rooms = plan.storeys.iter().flat_map(|storey| &storey.rooms);
    rooms.any(|room| room.kind.is_outside())
}

/// Refuses an area that the home's rooms cannot have.
fn check_area(spec: &HouseSpec, programme: &RoomProgram) -> Result<(), HousesError> {
    let Some(area) = spec.area_m2 else {
        return Ok(());
    };
    let rooms = || programme.storeys.iter().flatten();
    let [least, most] = [0, 2].map(|k| {
        rooms()
            .map(|room| room.kind.requirements().area_m2[k])
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

fn no_plan(spec: &HouseSpec, programme: Option<&RoomProgram>) -> HousesError {
    let rooms = || {
        programme
            .into_iter()
            .flat_map(|programme| &programme.storeys)
            .flatten()
    };
    let area: f32 = rooms().map(|room| room.area_m2).sum();
    let kinds: Vec<&str> = rooms().map(|room| room.kind.requirements().name).collect();
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
