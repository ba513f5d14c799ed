//! Specification of a generated house.

use super::rooms::GeneratedRoomKind;
use crate::error::HousesError;
use dwell_furniture::style::{STYLES, StyleSplit};
use dwell_scene::SkyConditions;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The kind of home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HomeKind {
    /// One room with a bathroom.
    Studio,
    /// Rooms on one storey.
    Apartment,
    /// Rooms on one to three storeys.
    House,
    /// A place to work.
    Office,
}

/// The initial positions of the doors between rooms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DoorStates {
    /// All shut.
    Closed,
    /// All wide open.
    Open,
    /// All half open.
    Ajar,
    /// Each as it is drawn; the entrance is shut.
    #[default]
    Mixed,
}

/// Which looks of furniture a house may have; those of `val` and `test` never occur in `train`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AssetSplit {
    /// Looks for training.
    #[default]
    Train,
    /// Looks for choosing between trained agents.
    Val,
    /// Looks for the final test.
    Test,
    /// All looks.
    All,
}

impl AssetSplit {
    pub(crate) fn allows(self, split: StyleSplit) -> bool {
        match self {
            Self::Train => split == StyleSplit::Train,
            Self::Val => split == StyleSplit::Val,
            Self::Test => split == StyleSplit::Test,
            Self::All => true,
        }
    }
}

/// The specification of a house. Fields that are left out are drawn from the seed.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use dwell_houses::generate::{HomeKind, HouseSpec, generate};
/// let spec = HouseSpec { home: Some(HomeKind::Studio), ..HouseSpec::default() };
/// let generated = generate(7, &spec)?;
/// assert!(generated.house.rooms.iter().any(|room| room.name.starts_with("studio")));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct HouseSpec {
    /// What kind of home.
    pub home: Option<HomeKind>,
    /// Number of storeys, 1 to 3; more than one only for a house or with `rooms`.
    pub storeys: Option<usize>,
    /// Floor of all rooms together, hallways too, without balconies and terraces, m²; 12 to 400. Kept to within a
    /// fifth, as far as the rooms allow.
    pub area_m2: Option<f32>,
    /// Exactly these rooms, 1 to 12; empty: as the home usually has. Hallways come by themselves.
    pub rooms: Vec<GeneratedRoomKind>,
    /// Kinds of rooms that shall have a door between them, as far as the plan allows.
    pub adjacency: Vec<[GeneratedRoomKind; 2]>,
    /// The name of a style of furniture.
    pub style: Option<String>,
    /// How much of the furniture that a home can do without is there, 0 to 1.
    pub furniture_density: f32,
    /// How much small stuff lies about, 0 to 1.
    pub clutter: f32,
    /// How doors stand at the start.
    pub doors: DoorStates,
    /// Local solar time, h, 0 to 24: where the sun stands on a fine day in April. Which way north lies is drawn.
    pub time_of_day: f32,
    /// Which looks of furniture it may have.
    pub split: AssetSplit,
}

impl Default for HouseSpec {
    fn default() -> Self {
        Self {
            home: None,
            storeys: None,
            area_m2: None,
            rooms: Vec::new(),
            adjacency: Vec::new(),
            style: None,
            furniture_density: 0.8,
            clutter: 0.6,
            doors: DoorStates::default(),
            time_of_day: SkyConditions::default().hour_h,
            split: AssetSplit::default(),
        }
    }
}

/// The most rooms that a spec can ask for.
pub(crate) const MAX_ROOMS: usize = 12;

/// Floor of hallways and stairs on top of that of the rooms, as a share.
const HALLWAY_SHARE: f32 = 1.12;

fn fault(field: &str, found: impl Into<String>, possible: impl Into<String>) -> HousesError {
    HousesError::Spec {
        field: field.to_owned(),
        found: found.into(),
        possible: possible.into(),
    }
}

impl HouseSpec {
    /// Checks every field by itself and against the others.
    ///
    /// # Errors
    /// [`HousesError::Spec`] names the field, what was found, and what is possible.
    pub fn check(&self) -> Result<(), HousesError> {
        if let Some(storeys) = self.storeys {
            if !(1..=3).contains(&storeys) {
                return Err(fault("storeys", storeys.to_string(), "1 to 3"));
            }
            let one = matches!(
                self.home,
                Some(HomeKind::Studio | HomeKind::Apartment | HomeKind::Office)
            );
            if storeys > 1 && one && self.rooms.is_empty() {
                return Err(fault(
                    "storeys",
                    storeys.to_string(),
                    "1, or home = \"house\", or a list of rooms",
                ));
            }
        }
        if self.rooms.len() > MAX_ROOMS {
            return Err(fault("rooms", self.rooms.len().to_string(), "1 to 12"));
        }
        if self.rooms.contains(&GeneratedRoomKind::Hallway) {
            return Err(fault(
                "rooms",
                "hallway",
                "any other kind: hallways come by themselves",
            ));
        }
        self.check_outside()?;
        if let Some(area) = self.area_m2 {
            self.check_area(area)?;
        }
        for [a, b] in &self.adjacency {
            for kind in [a, b] {
                if kind.is_outside() || *kind == GeneratedRoomKind::Hallway {
                    return Err(fault("adjacency", kind.requirements().name, "rooms inside"));
                }
                if !self.rooms.is_empty() && !self.rooms.contains(kind) {
                    return Err(fault(
                        "adjacency",
                        kind.requirements().name,
                        "kinds in `rooms`",
                    ));
                }
            }
        }
        for (field, value) in [
            ("furniture_density", self.furniture_density),
            ("clutter", self.clutter),
        ] {
            if !(0.0..=1.0).contains(&value) {
                return Err(fault(field, value.to_string(), "0 to 1"));
            }
        }
        let hour = self.time_of_day;
        if !(0.0..=24.0).contains(&hour) {
            return Err(fault("time_of_day", hour.to_string(), "0 to 24 (hours)"));
        }
        if let Some(style) = &self.style {
            let known: Vec<&str> = STYLES
                .iter()
                .filter(|style| self.split.allows(style.split))
                .map(|style| style.name)
                .collect();
            if !known.contains(&style.as_str()) {
                let possible = format!("of split {:?}: {}", self.split, known.join(", "));
                return Err(fault("style", style, possible));
            }
        }
        Ok(())
    }

    fn check_outside(&self) -> Result<(), HousesError> {
        let outside = self.rooms.iter().filter(|kind| kind.is_outside()).count();
        if outside > 1 {
            return Err(fault(
                "rooms",
                format!("{outside} balconies and terraces"),
                "at most one",
            ));
        }
        let inside = self.rooms.len() - outside;
        if !self.rooms.is_empty() && inside < self.storeys.unwrap_or(1) {
            return Err(fault(
                "rooms",
                format!("{inside} inside"),
                "at least one for each storey",
            ));
        }
        Ok(())
    }

    fn check_area(&self, area_m2: f32) -> Result<(), HousesError> {
        if !(12.0..=400.0).contains(&area_m2) {
            return Err(fault("area_m2", area_m2.to_string(), "12 to 400"));
        }
        let inside = self.rooms.iter().filter(|kind| !kind.is_outside());
        let (mut least, mut most) = (0.0, 0.0);
        for kind in inside {
            let [low, _, high] = kind.requirements().area_m2;
            least += low;
            most += high;
        }
        if !self.rooms.is_empty() {
            let hallway = if self.rooms.len() > 1 {
                HALLWAY_SHARE
            } else {
                1.0
            };
            let (least, most) = (least * hallway, most * 1.3);
            if !(least..=most).contains(&area_m2) {
                let possible = format!("{least:.0} to {most:.0} for these rooms");
                return Err(fault("area_m2", area_m2.to_string(), possible));
            }
        }
        Ok(())
    }
}
