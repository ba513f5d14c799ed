//! The kinds of rooms and what builders expect of each.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A kind of room.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum GeneratedRoomKind {
    /// One room to live, cook and sleep in.
    Studio,
    /// Sofa and television.
    LivingRoom,
    /// A table with chairs.
    DiningRoom,
    /// A room to cook in.
    Kitchen,
    /// For the owners.
    Bedroom,
    /// For a child.
    ChildRoom,
    /// For guests.
    GuestRoom,
    /// With a tub, a basin and a toilet.
    Bathroom,
    /// A toilet with a basin.
    Toilet,
    /// A room with desks.
    Office,
    /// A room in which visitors of an office wait.
    Lobby,
    /// A room in which clothes hang.
    Wardrobe,
    /// Shelves.
    Storage,
    /// With the washing machine.
    BoilerRoom,
    /// For exercise.
    Gym,
    /// Comes by itself where rooms need one.
    Hallway,
    /// Outside, with a railing.
    Balcony,
    /// Outside, on the ground.
    Terrace,
}

/// The kind of windows that a room gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WindowStyle {
    /// Wide ones on every outer wall.
    Wide,
    /// One or two of usual size.
    Usual,
    /// One above the worktop.
    High,
    /// A small one of frosted glass.
    Frosted,
    /// None.
    None,
}

/// The requirements of a kind of room.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoomKindProperties {
    /// A row of `assets/rooms.csv`; rooms are named after it.
    pub(crate) name: &'static str,
    /// Everyday names of its kind, the most fitting first.
    pub(crate) everyday_names: &'static [&'static str],
    /// The smallest, the usual and the largest floor, m².
    pub(crate) area_m2: [f32; 3],
    /// Smallest width between the middles of its walls, m.
    pub(crate) min_width_m: f32,
    pub(crate) windows: WindowStyle,
    /// The storey that it is usually on when there are several: 0 the ground, 1 above.
    pub(crate) storey: usize,
}

const fn room_kind_properties(
    name: &'static str,
    words: &'static [&'static str],
    area_m2: [f32; 3],
    least_width_m: f32,
    windows: WindowStyle,
    storey: usize,
) -> RoomKindProperties {
    RoomKindProperties {
        name,
        everyday_names: words,
        area_m2,
        min_width_m: least_width_m,
        windows,
        storey,
    }
}

impl GeneratedRoomKind {
    /// All kinds that a spec can ask for.
    pub const ALL: [Self; 17] = [
        Self::Studio,
        Self::LivingRoom,
        Self::DiningRoom,
        Self::Kitchen,
        Self::Bedroom,
        Self::ChildRoom,
        Self::GuestRoom,
        Self::Bathroom,
        Self::Toilet,
        Self::Office,
        Self::Lobby,
        Self::Wardrobe,
        Self::Storage,
        Self::BoilerRoom,
        Self::Gym,
        Self::Balcony,
        Self::Terrace,
    ];

    /// Areas: usual German flats after E. Neufert, *Architects' Data*, 4th ed. (2012), "Housing", rounded.
    pub(crate) const fn requirements(self) -> RoomKindProperties {
        use WindowStyle::{Frosted, High, None, Usual, Wide};
        match self {
            Self::Studio => room_kind_properties(
                "studio",
                &["living room", "bedroom", "kitchen"],
                [17.0, 26.0, 45.0],
                3.4,
                Wide,
                0,
            ),
            Self::LivingRoom => room_kind_properties(
                "living_room",
                &["living room"],
                [13.0, 24.0, 48.0],
                3.3,
                Wide,
                0,
            ),
            Self::DiningRoom => room_kind_properties(
                "dining_room",
                &["dining room"],
                [8.5, 13.0, 26.0],
                2.7,
                Usual,
                0,
            ),
            Self::Kitchen => {
                room_kind_properties("kitchen", &["kitchen"], [6.5, 11.0, 22.0], 2.3, High, 0)
            }
            Self::Bedroom => {
                room_kind_properties("bedroom", &["bedroom"], [10.5, 15.0, 28.0], 2.9, Usual, 1)
            }
            Self::ChildRoom => room_kind_properties(
                "child_room",
                &["child room", "bedroom"],
                [8.5, 12.0, 22.0],
                2.5,
                Usual,
                1,
            ),
            Self::GuestRoom => room_kind_properties(
                "guest_room",
                &["guest room", "bedroom"],
                [8.5, 12.0, 22.0],
                2.5,
                Usual,
                1,
            ),
            Self::Bathroom => {
                room_kind_properties("bathroom", &["bathroom"], [4.6, 7.0, 14.0], 2.0, Frosted, 1)
            }
            Self::Toilet => {
                room_kind_properties("toilet", &["toilet"], [2.6, 3.2, 6.0], 1.4, Frosted, 0)
            }
            Self::Office => {
                room_kind_properties("office", &["office"], [8.0, 12.0, 26.0], 2.5, Usual, 0)
            }
            Self::Lobby => {
                room_kind_properties("lobby", &["lobby"], [14.0, 24.0, 60.0], 3.4, Wide, 0)
            }
            Self::Wardrobe => {
                room_kind_properties("wardrobe", &["wardrobe"], [3.6, 5.5, 12.0], 1.7, None, 1)
            }
            Self::Storage => {
                room_kind_properties("storage", &["storage"], [2.2, 4.0, 12.0], 1.3, None, 0)
            }
            Self::BoilerRoom => room_kind_properties(
                "boiler_room",
                &["boiler room"],
                [4.0, 6.0, 14.0],
                1.8,
                Frosted,
                0,
            ),
            Self::Gym => room_kind_properties("gym", &["gym"], [10.0, 16.0, 32.0], 2.9, Usual, 1),
            Self::Hallway => {
                room_kind_properties("hallway", &["hallway"], [1.5, 8.0, 40.0], 1.1, None, 0)
            }
            Self::Balcony => {
                room_kind_properties("balcony", &["balcony"], [3.0, 5.0, 12.0], 1.3, None, 0)
            }
            Self::Terrace => {
                room_kind_properties("terrace", &["terrace"], [6.0, 12.0, 30.0], 2.0, None, 0)
            }
        }
    }

    /// Returns whether it lies outside.
    pub(crate) const fn is_outside(self) -> bool {
        matches!(self, Self::Balcony | Self::Terrace)
    }
}
