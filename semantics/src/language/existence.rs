//! Clauses of existence: "there is a chair", "on the table there are a cup and two plates", "on your left you see a lamp".

use super::from_tree::{FunctionApplication, atomic_clause, number, parts, place_of, room};
use super::lexicon::ROOM_NOUN;
use super::phrases::{between_two, phrase};
use super::places;
use super::to_tree::{PhrasePosition, TreeBuilder, count};
use crate::form::{Clause, Description, Modifier, Noun, Phrase, Quantifier};
use crate::grammar::Tree;

/// The predicate of what is seen.
const SEEN: &str = "visible";

/// Returns whether a modifier takes no other thing.
fn is_visibility_modifier(modifier: &Modifier) -> bool {
    modifier.predicate == SEEN && !modifier.negated && modifier.arguments.is_empty()
}

fn items_of(what: &Phrase) -> &[Phrase] {
    match what {
        Phrase::List(items) => items,
        one => std::slice::from_ref(one),
    }
}

fn description(phrase: &Phrase) -> Option<&Description> {
    match phrase {
        Phrase::Described(description) => Some(description),
        _ => None,
    }
}

/// The last modifiers of every item, at most `most` of them, that all items share; in order.
fn shared_modifiers(items: &[Phrase], most: usize) -> Vec<Modifier> {
    let Some(first) = items.first().and_then(description) else {
        return Vec::new();
    };
    let last = |description: &Description, k: usize| -> Option<Modifier> {
        let at = description.modifiers.len().checked_sub(k + 1)?;
        description.modifiers.get(at).cloned()
    };
    let mut shared = Vec::new();
    for k in 0..most {
        let Some(modifier) = last(first, k) else {
            break;
        };
        let has = |item: &Phrase| {
            description(item).and_then(|own| last(own, k)).as_ref() == Some(&modifier)
        };
        if modifier.negated || !items.iter().all(has) {
            break;
        }
        shared.insert(0, modifier);
    }
    shared
}

fn without_last_modifiers(items: &[Phrase], number: usize) -> Option<Vec<Phrase>> {
    let shorter = items.iter().map(|item| {
        let mut own = description(item)?.clone();
        own.modifiers
            .truncate(own.modifiers.len().checked_sub(number)?);
        Some(own.into())
    });
    shorter.collect()
}

/// Returns whether a landmark cannot stand inside another noun phrase without "that is".
fn needs_relative_clause(phrase: &Phrase) -> bool {
    match phrase {
        Phrase::Described(description) => {
            matches!(description.noun, Noun::Object(_))
                && (!description.modifiers.is_empty() || description.selection.is_some())
        }
        Phrase::Pronoun => true,
        _ => false,
    }
}

impl TreeBuilder<'_> {
    /// The tree of "there is `what`".
    pub(super) fn existence(&self, what: &Phrase, negated: bool) -> Option<Tree> {
        let items = items_of(what);
        if negated {
            let [only] = items else {
                return None;
            };
            return Some(Tree::apply("exists_not", [self.item(only)?]));
        }
        let shared = shared_modifiers(items, 1);
        if shared.iter().any(is_visibility_modifier) {
            return self.see_tree(&without_last_modifiers(items, 1)?);
        }
        if let Some((front, number)) = self.fronted_modifiers(items) {
            let rest = self.items(&without_last_modifiers(items, number)?)?;
            return Some(Tree::apply(
                existence_function("exists_front", items),
                [front, rest],
            ));
        }
        let all = self.items(items)?;
        Some(Tree::apply(existence_function("exists", items), [all]))
    }

    fn see_tree(&self, items: &[Phrase]) -> Option<Tree> {
        let shared = shared_modifiers(items, 1);
        let side = shared.first().and_then(places::side_to_tree);
        if let Some(side) = side {
            let rest = self.items(&without_last_modifiers(items, 1)?)?;
            return Some(Tree::apply(
                existence_function("see_front", items),
                [side, rest],
            ));
        }
        if let Some((front, number)) = self.fronted_modifiers(items) {
            let rest = self.items(&without_last_modifiers(items, number)?)?;
            return Some(Tree::apply(
                existence_function("see_place", items),
                [front, rest],
            ));
        }
        Some(Tree::apply(
            existence_function("see", items),
            [self.items(items)?],
        ))
    }

    /// The place that stands before the verb, and the number of modifiers that it says.
    fn fronted_modifiers(&self, items: &[Phrase]) -> Option<(Tree, usize)> {
        let shared = shared_modifiers(items, 2);
        let [.., last] = &shared[..] else {
            return None;
        };
        // Rooms have no modifiers behind them: "on the first floor there are two bedrooms".
        let is_room =
            |item: &Phrase| description(item).is_some_and(|own| matches!(own.noun, Noun::Room(_)));
        let is_plain =
            last.predicate != "leads_from" && !last.arguments.iter().any(needs_relative_clause);
        if items.len() == 1 && is_plain && !is_room(&items[0]) {
            return None;
        }
        if let [mount, place] = &shared[..]
            && mount.predicate == "hangs_on"
            && place.predicate == "in_room"
            && let Some(mount) = places::mount_to_tree(mount.arguments.first()?)
        {
            let room = self.room(place.arguments.first()?)?;
            return Some((Tree::apply("front_mount", [mount, room]), 2));
        }
        let tree = match (last.predicate.as_str(), &last.arguments[..]) {
            ("in_room" | "on_storey", [place]) => Tree::apply("front_place", [self.place(place)?]),
            ("leads_from", [room]) => Tree::apply("front_from", [self.room(room)?]),
            ("between", [a, b]) => {
                let free = |phrase| self.phrase(phrase, PhrasePosition::Free);
                Tree::apply("front_between", [free(a)?, free(b)?])
            }
            (predicate, [landmark]) => {
                let relation = self.relation_word(predicate, landmark)?;
                let landmark = self.phrase(landmark, PhrasePosition::Free)?;
                Tree::apply("front_relation", [relation, landmark])
            }
            _ => return None,
        };
        Some((tree, 1))
    }

    fn items(&self, items: &[Phrase]) -> Option<Tree> {
        match items {
            [] => None,
            [only] => self.item(only),
            [first, last] => Some(Tree::apply(
                "list_pair",
                [self.item(first)?, self.item(last)?],
            )),
            [first, rest @ ..] => Some(Tree::apply(
                "list_more",
                [self.item(first)?, self.items(rest)?],
            )),
        }
    }

    pub(super) fn item(&self, item: &Phrase) -> Option<Tree> {
        let Some(own) = description(item) else {
            return Some(Tree::apply(
                "item",
                [self.phrase(item, PhrasePosition::Free)?],
            ));
        };
        match (&own.noun, own.quantifier) {
            (Noun::Storey, Quantifier::Exactly(1)) if is_bare(own) => {
                Some(Tree::apply("item_storey", []))
            }
            (Noun::Storey, Quantifier::Exactly(number)) if is_bare(own) => {
                Some(Tree::apply("item_storeys", [count(number)]))
            }
            (Noun::Room(noun), Quantifier::Exactly(1)) if is_bare(own) => Some(Tree::apply(
                "item_one_room",
                [self.lexicon_entry(ROOM_NOUN, noun)?],
            )),
            (Noun::Room(_), Quantifier::AtLeast(1)) => None,
            (Noun::Room(noun), Quantifier::Exactly(number) | Quantifier::AtLeast(number))
                if is_bare(own) =>
            {
                let function = match own.quantifier {
                    Quantifier::AtLeast(_) => "item_rooms_at_least",
                    _ => "item_rooms",
                };
                let noun = self.lexicon_entry(ROOM_NOUN, noun)?;
                Some(Tree::apply(function, [count(number), noun]))
            }
            (Noun::Room(_), _) => Some(Tree::apply("item_room", [self.room(item)?])),
            _ => Some(Tree::apply(
                "item",
                [self.phrase(item, PhrasePosition::Free)?],
            )),
        }
    }
}

/// Returns whether a description has a quantifier and a noun only.
pub(super) fn is_bare(description: &Description) -> bool {
    let plain = Description::new(description.quantifier, description.noun.clone());
    *description == plain
}

fn existence_function(function: &str, items: &[Phrase]) -> &'static str {
    match (function, items.len()) {
        ("exists", 1) => "exists",
        ("exists", _) => "exists_list",
        ("exists_front", 1) => "exists_front",
        ("exists_front", _) => "exists_front_list",
        ("see", 1) => "see",
        ("see", _) => "see_list",
        ("see_place", 1) => "see_place",
        ("see_place", _) => "see_place_list",
        (_, 1) => "see_front",
        _ => "see_front_list",
    }
}

/// The modifiers that a clause adds to each of its items, and the tree of the items.
struct ExistenceParts<'a> {
    modifiers: Vec<Modifier>,
    items: &'a Tree,
}

fn existence_parts<'a>(function: &str, arguments: &'a [Tree]) -> Option<ExistenceParts<'a>> {
    let seen = || Modifier::new(SEEN, []);
    Some(match (function, arguments) {
        ("exists" | "exists_list" | "whether_exists", [items]) => ExistenceParts {
            modifiers: Vec::new(),
            items,
        },
        ("exists_front" | "exists_front_list", [front, items])
        | ("front_stands", [front, _, items]) => ExistenceParts {
            modifiers: fronted_modifiers_from_tree(front)?,
            items,
        },
        ("room_has" | "room_has_list" | "whether_room_has", [place, items]) => ExistenceParts {
            modifiers: vec![Modifier::new("in_room", [room(place)?])],
            items,
        },
        ("see_from" | "see_from_list" | "whether_see_from", [place, items]) => ExistenceParts {
            modifiers: vec![Modifier::new("visible_from_room", [room(place)?])],
            items,
        },
        ("see" | "see_list" | "whether_seen", [items]) => ExistenceParts {
            modifiers: vec![seen()],
            items,
        },
        ("see_front" | "see_front_list", [side, items]) => ExistenceParts {
            modifiers: vec![places::side_from_tree(side)?, seen()],
            items,
        },
        ("see_place" | "see_place_list", [front, items]) => {
            let mut modifiers = fronted_modifiers_from_tree(front)?;
            modifiers.push(seen());
            ExistenceParts { modifiers, items }
        }
        _ => return None,
    })
}

pub(super) fn fronted_modifiers_from_tree(tree: &Tree) -> Option<Vec<Modifier>> {
    Some(match parts(tree)? {
        ("front_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            vec![Modifier::new(&predicate, [place])]
        }
        ("front_relation", [Tree::Entry { id, .. }, landmark]) => {
            vec![Modifier::new(id, [phrase(landmark)?])]
        }
        ("front_between_two", [both]) => vec![Modifier::new("between", between_two(both)?)],
        ("front_between", [a, b]) => vec![Modifier::new("between", [phrase(a)?, phrase(b)?])],
        ("front_mount", [mount, place]) => vec![
            Modifier::new("hangs_on", [places::mount_from_tree(mount)?]),
            Modifier::new("in_room", [room(place)?]),
        ],
        // "In front of the mirror, on the chest, there is a vase": both are said of the vase.
        ("front_both", [one, other]) => {
            let mut both = fronted_modifiers_from_tree(one)?;
            both.extend(fronted_modifiers_from_tree(other)?);
            both
        }
        ("front_from", [place]) => vec![Modifier::new("leads_from", [room(place)?])],
        _ => return None,
    })
}

/// The clause of a tree of existence; `None` for other trees.
pub(super) fn from_tree(function: &str, arguments: &[Tree]) -> Option<Clause> {
    let ExistenceParts { modifiers, items } = existence_parts(function, arguments)?;
    let mut found = Vec::new();
    collect(items, &modifiers, &mut found)?;
    // "You can see the sofa from the kitchen" is about the sofa.
    if let ([Phrase::Described(one)], [seen]) = (&found[..], &modifiers[..])
        && seen.predicate == "visible_from_room"
        && one.quantifier == Quantifier::The
    {
        let mut subject = Description::clone(one);
        subject.modifiers.pop();
        let mut arguments = vec![Phrase::from(subject)];
        arguments.extend(seen.arguments.iter().cloned());
        return Some(atomic_clause(&seen.predicate, arguments));
    }
    // "Two mats, a gray one and an orange one": the first is the sum of the others.
    if found.len() > 2 && is_several(&found[0]) && found[1..].iter().all(has_anaphoric_noun) {
        let whole = Clause::Exists(found.remove(0));
        let each = found.into_iter().map(Clause::Exists);
        return Some(Clause::All(std::iter::once(whole).chain(each).collect()));
    }
    Some(Clause::Exists(one_or_list(found)))
}

fn one_or_list(mut items: Vec<Phrase>) -> Phrase {
    match items.len() {
        1 => items.remove(0),
        _ => Phrase::List(items),
    }
}

fn is_several(phrase: &Phrase) -> bool {
    matches!(
        phrase,
        Phrase::Described(own)
            if matches!(own.quantifier, Quantifier::Exactly(2..) | Quantifier::AtLeast(2..))
    )
}

fn has_anaphoric_noun(phrase: &Phrase) -> bool {
    matches!(phrase, Phrase::Described(own) if own.noun == Noun::SameNoun)
}

/// The phrase of an item or of a list of items.
pub(super) fn items_from_tree(items: &Tree) -> Option<Phrase> {
    let mut found = Vec::new();
    collect(items, &[], &mut found)?;
    Some(one_or_list(found))
}

fn collect(items: &Tree, modifiers: &[Modifier], into: &mut Vec<Phrase>) -> Option<()> {
    if let ("list_pair" | "list_more", [first, rest]) = parts(items)? {
        collect(first, modifiers, into)?;
        return collect(rest, modifiers, into);
    }
    into.push(with_modifiers(item_from_tree(items)?, modifiers)?);
    Some(())
}

fn with_modifiers(item: Phrase, modifiers: &[Modifier]) -> Option<Phrase> {
    if modifiers.is_empty() {
        return Some(item);
    }
    match item {
        Phrase::Described(mut description) => {
            description.modifiers.extend_from_slice(modifiers);
            Some(Phrase::Described(description))
        }
        _ => None,
    }
}

/// The phrase of an item; `None` for other trees.
pub(super) fn item_from_tree(tree: &Tree) -> Option<Phrase> {
    let bare = |quantifier, noun| Some(Description::new(quantifier, noun).into());
    match parts(tree)? {
        ("item", [inner]) => phrase(inner),
        ("item_room", [inner]) => room(inner),
        ("item_rooms", [number_of, Tree::Entry { id, .. }]) => bare(
            Quantifier::Exactly(number(number_of)?),
            Noun::Room(id.clone()),
        ),
        ("item_rooms_at_least", [number_of, Tree::Entry { id, .. }]) => bare(
            Quantifier::AtLeast(number(number_of)?),
            Noun::Room(id.clone()),
        ),
        ("item_one_room", [Tree::Entry { id, .. }]) => {
            bare(Quantifier::Exactly(1), Noun::Room(id.clone()))
        }
        ("item_storey", []) => bare(Quantifier::Exactly(1), Noun::Storey),
        ("item_storeys", [number_of]) => {
            bare(Quantifier::Exactly(number(number_of)?), Noun::Storey)
        }
        _ => None,
    }
}

/// The phrases of the items of a clause of existence, with the modifiers that the clause adds, by their paths from the clause.
pub(super) fn item_phrases(clause: &Tree, path: &[usize]) -> Vec<(Vec<usize>, Phrase)> {
    let Some((function, arguments)): Option<FunctionApplication<'_>> = parts(clause) else {
        return Vec::new();
    };
    let Some(ExistenceParts { modifiers, items }) = existence_parts(function, arguments) else {
        return Vec::new();
    };
    let mut path = path.to_vec();
    path.push(arguments.len() - 1);
    let mut found = Vec::new();
    let mut open = vec![(path, items)];
    while let Some((path, tree)) = open.pop() {
        let step = |k: usize| {
            let mut longer = path.clone();
            longer.push(k);
            longer
        };
        if let Some(("list_pair" | "list_more", [first, rest])) = parts(tree) {
            open.push((step(0), first));
            open.push((step(1), rest));
            continue;
        }
        let phrase = item_from_tree(tree).and_then(|item| with_modifiers(item, &modifiers));
        // The item and the noun phrase in it have the same text.
        if matches!(parts(tree), Some(("item" | "item_room", _))) {
            found.extend(phrase.clone().map(|phrase| (step(0), phrase)));
        }
        found.extend(phrase.map(|phrase| (path, phrase)));
    }
    found
}
