//! True sentences with one word swapped: the checker says of each what counting over the scene graph says.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_houses::open;
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::{Entity, EntityId, House, ObjectId, State, StructureKind};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::color::ColorVocabulary;
use dwell_semantics::describe::{TextOptions, captions, describe_rooms};
use dwell_semantics::english::ordinal;
use dwell_semantics::form::{Clause, Description, Form, Noun, Phrase, Quantifier};
use dwell_semantics::graph::{ObjectNode, SceneGraph, scene_graph};
use dwell_semantics::{
    ObjectAttributes, SemanticScene, Semantics, Truth, UndecidedReason, object_attributes,
};
use std::sync::Arc;

/// The swaps of each house; eight houses: 10,000 in all with `DWELL_TEST_ALL=1`.
fn swaps() -> usize {
    if std::env::var_os("DWELL_TEST_ALL").is_some() {
        1250
    } else {
        400
    }
}

/// Scene graph and attributes: what the checker's truth is compared with.
struct Facts<'a> {
    house: &'a House,
    graph: SceneGraph,
    attributes: Vec<ObjectAttributes>,
}

impl Facts<'_> {
    fn attributes_of(&self, id: i32) -> &ObjectAttributes {
        self.attributes.iter().find(|own| own.id == id).unwrap()
    }

    fn is_called(&self, id: i32, noun: &str) -> bool {
        let Some(Entity::Object(object)) = self.house.entity(EntityId(id)) else {
            return false;
        };
        let category = &self.house.objects[object].category;
        let row = dwell_semantics::category::categories().of(category);
        let kinds = include_str!("../../../assets/kind_nouns.csv").lines();
        let mut kinds = kinds.filter_map(|line| line.strip_prefix(category.fine.as_str()));
        let kind = kinds.find_map(|rest| rest.strip_prefix(',')?.rsplit(',').next());
        let synonyms = row.into_iter().flat_map(|row| row.synonyms.iter().copied());
        let synonyms = synonyms.chain(kind.into_iter().flat_map(|words| words.split(';')));
        let own = self.graph.object(id).unwrap().noun.as_str();
        let mut names = synonyms.chain([own]);
        noun == "thing" || names.any(|name| name == noun || name.ends_with(&format!(" {noun}")))
    }

    /// Returns whether a room, by its number in the graph, is one that a phrase means.
    fn is_room(&self, phrase: &Phrase, number: Option<u32>) -> bool {
        let Phrase::Described(room) = phrase else {
            panic!("a room: {phrase:?}");
        };
        let Noun::Room(noun) = &room.noun else {
            panic!("a room: {phrase:?}");
        };
        let Some(number) = number else {
            return false;
        };
        let name = &self.graph.rooms[number as usize].name;
        match &room.selection {
            Some(selection) => *name == format!("{} {noun}", ordinal(selection.place as usize)),
            None => name == noun || name.ends_with(&format!(" {noun}")),
        }
    }

    fn mount_is(&self, id: i32, noun: &Noun) -> bool {
        match (self.house.entity(EntityId(id)), noun) {
            (Some(Entity::Structure(piece)), Noun::Structure(noun)) => {
                let kind = match noun.as_str() {
                    "wall" => StructureKind::Wall,
                    "ceiling" => StructureKind::Ceiling,
                    _ => StructureKind::Floor,
                };
                self.house.structure[piece].kind == kind
            }
            (Some(Entity::Object(_)), Noun::Object(noun)) => self.is_called(id, noun),
            _ => false,
        }
    }

    fn fits(&self, node: &ObjectNode, description: &Description) -> bool {
        let Noun::Object(noun) = &description.noun else {
            panic!("a thing: {description:?}");
        };
        let attributes = self.attributes_of(node.id);
        let library = dwell_scene::material::library();
        let made_of = |word: &String| {
            attributes
                .substances
                .iter()
                .any(|(name, share)| *share >= 0.2 && library.get(name).unwrap().adjective == *word)
        };
        let in_state = |state: &String| match state.as_str() {
            "open" => node.openness.is_some_and(|share| share > 0.5),
            "closed" => node.openness.is_some_and(|share| share <= 0.02),
            "half_open" => node
                .openness
                .is_some_and(|share| share > 0.02 && share <= 0.5),
            "switched_on" => node.switched_on == Some(true),
            "striped" | "checked" | "patterned" => attributes
                .pattern
                .is_some_and(|own| state == "patterned" || own.name() == state),
            other => panic!("state {other}"),
        };
        self.is_called(node.id, noun)
            && description
                .colors
                .iter()
                .all(|color| node.colors.contains(color))
            && description.material.as_ref().is_none_or(made_of)
            && description.size.is_none_or(|size| node.size == size)
            && description.state.as_ref().is_none_or(in_state)
            && description.modifiers.iter().all(|modifier| {
                let other = &modifier.arguments[0];
                let mut edges = self.graph.relations_of(node.id);
                match (modifier.predicate.as_str(), other) {
                    ("in_room", room) => self.is_room(room, node.room),
                    ("hangs_on", Phrase::Described(mount)) => edges.any(|edge| {
                        edge.predicate == "hangs_on" && self.mount_is(edge.object, &mount.noun)
                    }),
                    (predicate, Phrase::Described(landmark)) => {
                        let landmarks = self.matching(landmark);
                        edges.any(|edge| {
                            edge.predicate == predicate && landmarks.contains(&edge.object)
                        })
                    }
                    other => panic!("{other:?}"),
                }
            })
    }

    fn matching(&self, description: &Description) -> Vec<i32> {
        let nodes = self.graph.objects.iter();
        let fitting = nodes.filter(|node| self.fits(node, description));
        fitting.map(|node| node.id).collect()
    }

    fn exists(&self, description: &Description) -> bool {
        let number = self.matching(description).len() as u32;
        match description.quantifier {
            Quantifier::Some => number >= 1,
            Quantifier::Exactly(asked) => number == asked,
            Quantifier::AtLeast(asked) => number >= asked,
            Quantifier::No => number == 0,
            other => panic!("{other:?}"),
        }
    }
}

/// The descriptions of things whose existence true texts claim, and that are about places and landmarks alone.
fn true_descriptions(scene: &SemanticScene<'_>) -> Vec<Description> {
    let texts = describe_rooms(scene, TextOptions::default()).into_iter();
    let texts = texts.chain(captions(scene, TextOptions::default()));
    let forms = texts.flat_map(|text| text.claims).map(|claim| claim.form);
    let mut found = Vec::new();
    for form in forms {
        let what = match form {
            Form::Claim(Clause::Exists(Phrase::List(items))) => items,
            Form::Claim(Clause::Exists(one)) | Form::NounPhrase(one) => vec![one],
            _ => continue,
        };
        for phrase in what {
            let Phrase::Described(description) = phrase else {
                continue;
            };
            let known = ["in_room", "in", "on", "next_to", "hangs_on"];
            let mut modifiers = description.modifiers.iter();
            let is_thing = matches!(description.noun, Noun::Object(_));
            if is_thing && modifiers.all(|own| known.contains(&own.predicate.as_str())) {
                found.push(*description);
            }
        }
    }
    found
}

/// The description with one word swapped; `None` where it has none of the kind that was drawn.
fn swapped(
    description: &Description,
    nouns: &[String],
    rooms: &[Phrase],
    stream: &mut RandomStream,
) -> Option<Description> {
    let mut other = description.clone();
    match stream.below(4) {
        0 => {
            let words = ColorVocabulary::Spoken.words();
            let word = stream.choose(&words)?;
            (*word).clone_into(other.colors.first_mut()?);
        }
        1 => other.noun = Noun::Object(stream.choose(nouns)?.clone()),
        2 => {
            let modifier = other.modifiers.last_mut()?;
            match modifier.predicate.as_str() {
                "in_room" => modifier.arguments = vec![stream.choose(rooms)?.clone()],
                "in" | "on" | "next_to" => {
                    let names = ["in", "on", "next_to"];
                    (*stream.choose(&names)?).clone_into(&mut modifier.predicate);
                }
                _ => return None,
            }
        }
        _ => {
            other.quantifier = match other.quantifier {
                Quantifier::Exactly(number) => {
                    Quantifier::Exactly((number + stream.below(3) as u32).max(3) - 1)
                }
                Quantifier::AtLeast(number) => Quantifier::AtLeast(number + 1),
                _ => Quantifier::Exactly(2 + stream.below(2) as u32),
            };
        }
    }
    (other != *description).then_some(other)
}

/// Swaps in one house; returns how many of them are false.
fn swap_in(name: &str) -> usize {
    let house: Arc<House> = Arc::new(open(name).unwrap().0);
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let checker = Checker::new(&scene, Addressee::default());
    let objects = || house.objects.ids();
    let facts = Facts {
        house: &house,
        graph: scene_graph(&scene, None),
        attributes: objects().map(|id| object_attributes(&scene, id)).collect(),
    };
    let all = true_descriptions(&scene);
    let noun = |id: ObjectId| scene.facts(id).noun.clone();
    let mut nouns: Vec<String> = objects().map(noun).collect();
    nouns.sort();
    nouns.dedup();
    let rooms = house.rooms.ids();
    let rooms: Vec<Phrase> = rooms
        .map(|room| dwell_semantics::refer::room_phrase(&scene, room))
        .collect();
    let mut stream = RandomKey::root(11).child(name).stream();
    let (wanted, mut swaps, mut wrong, mut divided) = (swaps(), 0, 0, 0);
    while swaps < wanted {
        let description = stream.choose(&all).unwrap();
        assert!(facts.exists(description), "{name}: {description:?}");
        let Some(other) = swapped(description, &nouns, &rooms, &mut stream) else {
            continue;
        };
        let expected = facts.exists(&other);
        let verdict = checker.check(&Clause::Exists(other.clone().into()));
        if verdict.truth == Truth::Undecided(UndecidedReason::DividedColor) {
            divided += 1;
            continue;
        }
        swaps += 1;
        assert_eq!(verdict.truth, Truth::from(expected), "{name}: {other:?}");
        // Whoever is told that a swapped sentence happens to be true gets the things that make it so.
        let named = !verdict.witnesses.is_empty();
        assert!(!expected || named, "{name}: {other:?}");
        wrong += usize::from(!expected);
    }
    // Of a cream thing that is called white: few swaps hit a word on which people divide.
    assert!(divided * 10 < swaps, "{name}: {divided} of {swaps}");
    wrong
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn swapped_words_are_found() {
    // Six of them with `DWELL_TEST_ALL=1`.
    let all = std::env::var_os("DWELL_TEST_ALL").is_some();
    let seeds = (0..if all { 6 } else { 1 }).map(|seed| format!("seed:{seed}"));
    let houses = ["builtin:studio", "builtin:apartment"].map(str::to_owned);
    let houses: Vec<String> = houses.into_iter().chain(seeds).collect();
    let wrong: usize = houses.iter().map(|name| swap_in(name)).sum();
    let all = houses.len() * swaps();
    assert!(wrong * 10 > all * 6, "{wrong} of {all}");
}
