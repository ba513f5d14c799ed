//! Cache of a scene about the things of one noun: filled at first use by `refer`.

use crate::size::SizeClass;
use dwell_scene::{ObjectId, RoomId};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// A trait of a thing that a description can name beside its noun.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Attribute {
    Color(String),
    /// A colour that somebody may see on it, be it little.
    TraceOfColor(String),
    Material(String),
    Size(SizeClass),
    Room(String),
}

/// A relation to something called `noun` that shows `colors`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct LandmarkQuery {
    pub(crate) predicate: String,
    pub(crate) noun: String,
    pub(crate) colors: Vec<String>,
}

/// Objects, ascending.
pub(crate) type ObjectList = Rc<[ObjectId]>;
/// Pairs of things and their relata, by things.
pub(crate) type RelatedPairs = Vec<(ObjectId, ObjectId)>;

/// The things that one noun can name. Things with a trait are listed once for each trait, so that a description need not look at
/// all of them.
pub(crate) struct DistractorSet {
    /// Things, ascending.
    pub(crate) things: ObjectList,
    pub(crate) in_rooms: BTreeMap<RoomId, usize>,
    pub(crate) having: OnceCell<BTreeMap<Attribute, ObjectList>>,
    /// Things that have several traits together, by these traits.
    pub(crate) having_all: RefCell<BTreeMap<Vec<Attribute>, ObjectList>>,
    /// Pairs by predicate and the kind of the relatum.
    pub(crate) pairs: OnceCell<BTreeMap<(&'static str, u32), RelatedPairs>>,
    pub(crate) marked: RefCell<BTreeMap<LandmarkQuery, ObjectList>>,
}
