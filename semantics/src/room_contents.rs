//! The kind of a room by what stands in it.

use crate::facts::ObjectFacts;
use crate::room_kind::{RoomCategory, room_kinds};
use dwell_scene::{Aabb, House, IdVec, ObjectId, RoomId};
use std::collections::{BTreeMap, BTreeSet};

/// Kinds with the categories of things that make a room one of them: all of a list at least once. The first that fits counts.
const KINDS: [(&str, &[&str]); 11] = [
    ("bathroom", &["bathtub"]),
    ("bathroom", &["shower"]),
    ("toilet", &["toilet"]),
    ("kitchen", &["cooker"]),
    ("kitchen", &["refrigerator", "sink"]),
    ("bedroom", &["double_bed"]),
    ("bedroom", &["single_bed"]),
    ("bedroom", &["bed"]),
    ("living_room", &["sofa", "television"]),
    ("dining_room", &["dining_table"]),
    ("office", &["desk", "office_chair"]),
];

/// Categories of which a living room has one of each if it is a studio.
const STUDIO: [&[&str]; 2] = [
    &["bed", "single_bed", "double_bed"],
    &["refrigerator", "cooker"],
];

/// The same of a boiler room that is a laundry room: rooms for machines are labelled after the boiler.
const LAUNDRY: [&[&str]; 1] = [&["washer", "dryer"]];
/// Kinds by the label that they replace, and by what makes a room one of them.
const BY_LABEL: [(&str, &str, &[&[&str]]); 2] = [
    ("living_room", "studio", &STUDIO),
    ("boiler_room", "laundry_room", &LAUNDRY),
];

/// Labels that say nothing of what a room is used for.
const VAGUE: [&str; 2] = ["room", "storage"];

/// The categories of the things in each room, as a house starts.
pub(crate) struct RoomContents(BTreeMap<RoomId, BTreeSet<&'static str>>);

impl RoomContents {
    pub(crate) fn gather(
        house: &House,
        bounds: &IdVec<ObjectId, Aabb>,
        facts: &IdVec<ObjectId, ObjectFacts>,
    ) -> Self {
        let mut contents: BTreeMap<RoomId, BTreeSet<&'static str>> = BTreeMap::new();
        for (id, own) in facts.iter_ids() {
            let here = house.room_at(bounds[id].center());
            if let (Some(room), Some(row)) = (here.or(house.objects[id].room), own.category) {
                contents.entry(room).or_default().insert(row.name);
            }
        }
        Self(contents)
    }

    /// The kind that the things in a room make it, where its label `kind` is none or says nothing of its use (in files of houses
    /// bathrooms are "storage"), or only a part of it (a living room with a bed and a cooker is a studio, a boiler room with a washing machine
    /// a laundry room).
    pub(crate) fn kind(
        &self,
        room: RoomId,
        kind: Option<&RoomCategory>,
    ) -> Option<&'static RoomCategory> {
        let own = self.0.get(&room)?;
        let label = kind.map_or("room", |kind| kind.name);
        let has_one = |of: &&[&str]| of.iter().any(|name| own.contains(name));
        let mut by_label = BY_LABEL.iter();
        if let Some((_, found, _)) =
            by_label.find(|(from, _, needed)| *from == label && needed.iter().all(has_one))
        {
            return room_kinds().get(found);
        }
        if !VAGUE.contains(&label) {
            return None;
        }
        let fits = |needed: &&[&str]| needed.iter().all(|name| own.contains(name));
        let found = KINDS.iter().find(|(_, needed)| fits(needed))?;
        room_kinds().get(found.0)
    }
}
