//! Clauses: forms that are true or false of a scene.

use super::phrase::{Description, Phrase};
use crate::size::SizeClass;
use serde::{Deserialize, Serialize};

/// A quality that "is" ascribes to a thing.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// A colour word.
    Color(String),
    /// The adjective of a substance.
    Material(String),
    /// Its size for its kind.
    Size(SizeClass),
    /// A state by its predicate: `"open"`, `"switched_off"`.
    State(String),
}

/// A surface of a room with its look: "a brown wooden floor".
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct RoomSurface {
    /// The surface.
    pub kind: RoomSurfaceKind,
    /// The colour word of most of it.
    pub color: Option<String>,
    /// The adjective of the substance of most of it; floors alone have one.
    pub material: Option<String>,
}

/// A kind of surface of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RoomSurfaceKind {
    /// The floor.
    Floor,
    /// The walls.
    Walls,
}

/// A clause: true, false or undecided of a scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clause {
    /// A predicate applied to arguments: "the cup is on the table".
    Holds {
        /// The predicate's name.
        predicate: String,
        /// Its arguments.
        arguments: Vec<Phrase>,
    },
    /// A thing has a quality: "the door is open".
    Is {
        /// The thing.
        subject: Phrase,
        /// The quality.
        quality: Quality,
    },
    /// The existence of things: "there are two chairs in the kitchen".
    Exists(Phrase),
    /// A greater number of one kind of things than of another, whatever their quantifiers: "there are more chairs than tables".
    More {
        /// The things of which there are more.
        more: Box<Description>,
        /// The things of which there are fewer.
        than: Box<Description>,
    },
    /// A room's floor area, rounded to whole square metres and at least 1: "the kitchen is about 12 square metres".
    Area {
        /// The room.
        room: Phrase,
        /// Its area, m².
        square_metres: u32,
    },
    /// The distance between two things, rounded to whole metres and at least 1: "the sofa is about three metres away".
    Distance {
        /// The thing.
        subject: Phrase,
        /// The other thing, or the listener.
        from: Phrase,
        /// The distance, m.
        metres: u32,
    },
    /// The look of a room's surfaces: "the kitchen has a brown wooden floor and white walls".
    HasSurfaces {
        /// The room.
        room: Phrase,
        /// Its surfaces, the floor before the walls.
        surfaces: Vec<RoomSurface>,
    },
    /// A clause that is true since a change: "the door is open now". Of one scene it says no more than the clause.
    Now(Box<Clause>),
    /// The negation of a clause.
    Not(Box<Clause>),
    /// The conjunction of clauses.
    All(Vec<Clause>),
    /// The disjunction of clauses.
    Any(Vec<Clause>),
}
