//! Where kinds of things belong: `assets/tidy_rules.csv`.

use dwell_scene::{ObjectId, RoomId, StructureKind};
use dwell_semantics::predicates;
use dwell_semantics::{SemanticScene, Term};
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// The word of the table for the floor.
pub(super) const FLOOR: &str = "floor";
/// Things in or on each other that are followed until furniture is reached.
const DEEPEST: usize = 4;

/// A row: things of these classes belong on or in furniture of these classes in rooms of these kinds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TidyRule {
    pub(super) things: BTreeSet<&'static str>,
    pub(super) places: BTreeSet<&'static str>,
    /// Kinds of rooms; empty: everywhere.
    pub(super) rooms: BTreeSet<&'static str>,
}

/// All rows.
pub(super) fn tidy_rules() -> &'static [TidyRule] {
    static RULES: LazyLock<Vec<TidyRule>> =
        LazyLock::new(|| parse(include_str!("../../../../../assets/tidy_rules.csv")));
    &RULES
}

fn parse(text: &'static str) -> Vec<TidyRule> {
    let names = |field: Option<&'static str>| {
        let words = field.unwrap_or_default().split(';');
        words.filter(|word| !word.is_empty()).collect()
    };
    let rows = text.lines().skip(1);
    rows.map(|row| {
        let mut fields = row.split(',');
        TidyRule {
            things: names(fields.next()),
            places: names(fields.next()),
            rooms: names(fields.next()),
        }
    })
    .collect()
}

/// Returns whether some rule is about things of a class.
pub(super) fn has_rule(class: &str) -> bool {
    tidy_rules().iter().any(|rule| rule.things.contains(class))
}

/// Returns whether a thing of a class belongs in a place of a class in a room of a kind.
pub(super) fn is_place_for(class: &str, place: &str, room: Option<&str>) -> bool {
    tidy_rules().iter().any(|rule| {
        rule.things.contains(class)
            && rule.places.contains(place)
            && (rule.rooms.is_empty() || room.is_some_and(|room| rule.rooms.contains(room)))
    })
}

/// The kind of a room.
pub(super) fn room_kind(scene: &SemanticScene<'_>, room: Option<RoomId>) -> Option<&'static str> {
    let kind = scene.semantics.room(room?).kind;
    kind.map(|kind| kind.name)
}

/// Returns whether a thing is where one of the rules says that it belongs: by the predicates `on`, `in` and `in_room`.
pub(super) fn is_tidy(scene: &SemanticScene<'_>, object: ObjectId) -> bool {
    if scene.holder(object).is_some() {
        return false;
    }
    let class = scene.house().objects[object].category.coarse.as_str();
    let room = room_kind(scene, scene.room_of(object));
    let places = places_of(scene, object, DEEPEST);
    places.iter().any(|place| is_place_for(class, place, room))
}

/// The classes of the furniture that a thing is on or in, through other loose things.
fn places_of<'a>(
    scene: &'a SemanticScene<'_>,
    object: ObjectId,
    deepest: usize,
) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let named = ["on", "in"].map(predicates::find);
    let related = named.into_iter().flatten();
    let related = related.flat_map(|predicate| predicate.related(scene, Term::Object(object)));
    for term in related {
        match term {
            Term::Object(other) if scene.house().objects[other].pickable => {
                found.insert(scene.house().objects[other].category.coarse.as_str());
                if deepest > 0 {
                    found.extend(places_of(scene, other, deepest - 1));
                }
            }
            Term::Object(other) => {
                found.insert(scene.house().objects[other].category.coarse.as_str());
            }
            Term::Structure(piece)
                if scene.house().structure[piece].kind == StructureKind::Floor =>
            {
                found.insert(FLOOR);
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_semantics::category::categories;
    use dwell_semantics::room_kind::room_kinds;

    #[test]
    fn every_word_of_the_table_is_a_class_or_a_kind_of_room() {
        let classes: BTreeSet<&str> = categories().rows().iter().map(|row| row.name).collect();
        let rooms: BTreeSet<&str> = room_kinds().rows().iter().map(|row| row.name).collect();
        let rows = tidy_rules();
        assert!(rows.len() > 20);
        for row in rows {
            assert!(!row.things.is_empty() && !row.places.is_empty(), "{row:?}");
            let mut named = row.things.union(&row.places);
            let unknown = named.find(|word| !classes.contains(*word));
            assert_eq!(unknown, None);
            assert_eq!(row.rooms.difference(&rooms).next(), None);
        }
        assert!(has_rule("cup") && !has_rule("wall"));
        assert!(is_place_for("pan", "cooker", Some("kitchen")));
        assert!(!is_place_for("pan", "cooker", None));
        assert!(is_place_for("table_lamp", "desk", None));
    }
}
