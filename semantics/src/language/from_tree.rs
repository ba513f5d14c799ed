//! Trees to forms: the meanings of the grammar's functions.

use super::phrases::{modifier, nominal, phrase, relation_predicate, size};
use super::{
    distances, existence, numbers, other_clauses, places, questions, requests, rooms, sentences,
    sets, verb_phrases,
};
use crate::form::{
    Clause, Description, Form, Modifier, Noun, OrdinalSelection, Phrase, Quality, Quantifier,
    Question,
};
use crate::grammar::Tree;
use std::collections::BTreeMap;

/// The function of a tree with its arguments.
pub(super) type FunctionApplication<'a> = (&'a str, &'a [Tree]);

/// The function of a tree with its arguments; `None` for words and numbers.
pub(super) fn parts(tree: &Tree) -> Option<FunctionApplication<'_>> {
    match tree {
        Tree::Apply {
            function,
            arguments,
        } => Some((function, arguments)),
        Tree::Entry { .. } | Tree::Number { .. } => None,
    }
}

pub(super) fn entry_id(tree: &Tree) -> Option<String> {
    match tree {
        Tree::Entry { id, .. } => Some(id.clone()),
        Tree::Apply { .. } | Tree::Number { .. } => None,
    }
}

pub(super) fn number(tree: &Tree) -> Option<u32> {
    match tree {
        Tree::Number { value, .. } => Some(*value),
        Tree::Apply { .. } | Tree::Entry { .. } => None,
    }
}

/// The form of the tree of a sentence; `None` for trees without a form.
pub(super) fn form(tree: &Tree) -> Option<Form> {
    Some(match parts(tree)? {
        ("claim", [inner]) => Form::Claim(clause(inner)?),
        ("request", [inner]) => Form::Request(requests::plan(inner)?),
        ("ask", [inner]) => Form::Question(questions::question(inner)?),
        ("ask_that" | "ask_tag", [inner]) => Form::Question(Question::Whether(clause(inner)?)),
        ("ask_indirect", [inner]) => Form::Question(questions::indirect_question(inner)?),
        ("phrase", [inner]) => Form::NounPhrase(phrase(inner)?),
        ("phrase_room", [inner]) => Form::NounPhrase(room(inner)?),
        (function, [first, second]) => Form::Several(sentences::forms(function, first, second)?),
        _ => return None,
    })
}

pub(super) fn clause(tree: &Tree) -> Option<Clause> {
    Some(match parts(tree)? {
        ("one_clause", [inner]) => possibly_negated_clause(inner)?,
        ("now" | "no_longer", [inner]) => Clause::Now(Box::new(possibly_negated_clause(inner)?)),
        ("all_clauses", [inner]) => Clause::All(coordinated_clauses(inner)?),
        ("any_clause", [inner]) => Clause::Any(coordinated_clauses(inner)?),
        _ => return None,
    })
}

fn coordinated_clauses(tree: &Tree) -> Option<Vec<Clause>> {
    let mut trees = Vec::new();
    let mut rest = tree;
    loop {
        match parts(rest)? {
            ("and_pair" | "or_pair", [a, b]) => {
                trees.extend([a, b]);
                break;
            }
            ("and_more" | "or_more", [first, more]) => {
                trees.push(first);
                rest = more;
            }
            _ => return None,
        }
    }
    let mut clauses: Vec<Clause> = trees
        .iter()
        .map(|tree| possibly_negated_clause(tree))
        .collect::<Option<_>>()?;
    places::inherit_side_landmarks(&mut clauses, &trees);
    Some(clauses)
}

pub(super) fn atomic_clause(predicate: &str, arguments: Vec<Phrase>) -> Clause {
    Clause::Holds {
        predicate: predicate.to_owned(),
        arguments,
    }
}

pub(super) fn possibly_negated_clause(tree: &Tree) -> Option<Clause> {
    let (function, arguments) = parts(tree)?;
    if let Some(plain) = function.strip_suffix("_not") {
        let inner = affirmative_clause(plain, arguments)?;
        return Some(Clause::Not(Box::new(inner)));
    }
    affirmative_clause(function, arguments)
}

pub(super) fn affirmative_clause(function: &str, arguments: &[Tree]) -> Option<Clause> {
    Some(match (function, arguments) {
        ("holds" | "holds_verb" | "whether_holds" | "whether_verb", [subject, word, object]) => {
            let (subject, object) = (phrase(subject)?, phrase(object)?);
            let predicate = relation_predicate(entry_id(word)?, &subject, &object);
            atomic_clause(&predicate, vec![subject, object])
        }
        ("holds_closer" | "whether_closer", [subject, near, far]) => atomic_clause(
            "closer_to",
            vec![phrase(subject)?, phrase(near)?, phrase(far)?],
        ),
        ("closer_than" | "whether_closer_than", [subject, reference, other]) => atomic_clause(
            "closer_to",
            vec![phrase(reference)?, phrase(subject)?, phrase(other)?],
        ),
        ("farther_than" | "whether_farther_than", [subject, reference, other]) => atomic_clause(
            "closer_to",
            vec![phrase(reference)?, phrase(other)?, phrase(subject)?],
        ),
        ("see_room_from" | "whether_see_room_from", [from, to]) => {
            atomic_clause("visible_from_room", vec![room(to)?, room(from)?])
        }
        ("holds_each_other" | "whether_each_other", [subject, word]) => {
            atomic_clause(&entry_id(word)?, vec![phrase(subject)?, Phrase::EachOther])
        }
        ("list_holds_each_other", [items, word]) => {
            atomic_clause(&entry_id(word)?, vec![subjects(items)?, Phrase::EachOther])
        }
        ("holds_between" | "whether_between", [subject, a, b]) => {
            atomic_clause("between", vec![phrase(subject)?, phrase(a)?, phrase(b)?])
        }
        ("holds_place" | "whether_place", [subject, place]) => {
            let (predicate, place) = place_of(place)?;
            atomic_clause(&predicate, vec![phrase(subject)?, place])
        }
        ("left_at", [thing, relation, landmark]) => atomic_clause(
            &entry_id(relation)?,
            vec![phrase(thing)?, phrase(landmark)?],
        ),
        ("left_in_place", [thing, place]) => {
            let (predicate, place) = place_of(place)?;
            atomic_clause(&predicate, vec![phrase(thing)?, place])
        }
        ("exists_neither", [one, other, place]) => {
            let place = modifier(place)?;
            let no = |noun: &Tree| {
                let noun = nominal(noun)?.with_modifier(place.clone());
                Some(Clause::Exists(noun.with_quantifier(Quantifier::No).into()))
            };
            Clause::All(vec![no(one)?, no(other)?])
        }
        ("more_each", [more, there, than, elsewhere]) => {
            numbers::comparative_by_place([more, there], [than, elsewhere])?
        }
        ("is" | "whether_is", [subject, quality]) => is(phrase(subject)?, quality)?,
        ("is_tiled", [subject, color]) => {
            let subject = phrase(subject)?;
            let is = |quality| Clause::Is {
                subject: subject.clone(),
                quality,
            };
            Clause::All(vec![
                is(Quality::Color(entry_id(color)?)),
                is(Quality::Material("tiled".to_owned())),
            ])
        }
        ("says" | "whether_says", [subject, said]) => verb_phrases::clause(phrase(subject)?, said)?,
        ("says_list" | "whether_says_list", [items, said]) => {
            verb_phrases::clause(subjects(items)?, said)?
        }
        ("stands_list", [items, posture, said]) => {
            verb_phrases::clause(subjects(items)?, &questions::posture_phrase(posture, said))?
        }
        ("stands" | "whether_stands", [subject, posture, said]) => {
            verb_phrases::clause(phrase(subject)?, &questions::posture_phrase(posture, said))?
        }
        ("says_and_has_thing", [subject, said, thing]) => Clause::All(vec![
            verb_phrases::clause(phrase(subject)?, said)?,
            atomic_clause(
                "has",
                vec![phrase(subject)?, existence::items_from_tree(thing)?],
            ),
        ]),
        ("surfaces_and_has", [place, surfaces, items]) => {
            let surfaces = Tree::apply("surfaces", [place.clone(), surfaces.clone()]);
            let has = Tree::apply("room_has", [place.clone(), items.clone()]);
            Clause::All(vec![
                possibly_negated_clause(&surfaces)?,
                possibly_negated_clause(&has)?,
            ])
        }
        ("says_and_has", [subject, said, load]) => Clause::All(vec![
            verb_phrases::clause(phrase(subject)?, said)?,
            atomic_clause(
                "supports",
                vec![phrase(subject)?, existence::items_from_tree(load)?],
            ),
        ]),
        // "What hangs from the ceiling is a lamp."
        ("what_says_is", [said, item]) => {
            verb_phrases::clause(existence::item_from_tree(item)?, said)?
        }
        ("exists_says", [subject, said]) => {
            let Phrase::Described(own) = phrase(subject)? else {
                return None;
            };
            Clause::Exists(verb_phrases::with_predications(*own, said)?.into())
        }
        ("holds_hang", [subject, mount]) => {
            atomic_clause("hangs_on", vec![phrase(subject)?, phrase(mount)?])
        }
        ("holds_verb_list", [subject, word, items]) => {
            let items = existence::items_from_tree(items)?;
            let subject = phrase(subject)?;
            let predicate = relation_predicate(entry_id(word)?, &subject, &items);
            atomic_clause(&predicate, vec![subject, items])
        }
        (
            "holds_carries" | "holds_carries_list" | "holds_content" | "holds_content_list"
            | "whether_carries" | "whether_content",
            [subject, items],
        ) => {
            let inside = function.contains("content");
            let predicate = if inside { "contains" } else { "supports" };
            atomic_clause(
                predicate,
                vec![phrase(subject)?, existence::items_from_tree(items)?],
            )
        }
        ("fronted", [front, inner]) => {
            let clause = possibly_negated_clause(inner)?;
            // "On the bed is one cushion near the lamp" has no subject before its place.
            let is_existence = matches!(clause, Clause::Exists(_));
            (!is_existence || parts(inner)?.0 == "stands").then_some(())?;
            fronted(existence::fronted_modifiers_from_tree(front)?, clause)?
        }
        ("exists_all", [items, quality]) => {
            let all = Description::new(Quantifier::Every, Noun::SameThings);
            Clause::All(vec![
                Clause::Exists(existence::items_from_tree(items)?),
                is(all.into(), quality)?,
            ])
        }
        ("not_but", [subject, quality, other]) => {
            let subject = phrase(subject)?;
            Clause::All(vec![
                Clause::Not(Box::new(is(subject.clone(), quality)?)),
                is(subject, other)?,
            ])
        }
        ("with_around", [subject, said, other, relation])
        | ("stands_with_around", [subject, _, said, other, relation]) => {
            let (subject, other) = (phrase(subject)?, phrase(other)?);
            Clause::All(vec![
                verb_phrases::clause(subject.clone(), said)?,
                atomic_clause(&entry_id(relation)?, vec![other, subject]),
            ])
        }
        ("see_none", [items]) => {
            let Phrase::Described(own) = existence::items_from_tree(items)? else {
                return None;
            };
            let seen = own.with_modifier(Modifier::new("visible", []));
            Clause::Not(Box::new(Clause::Exists(seen.into())))
        }
        ("more_where" | "whether_more_where", [what, one, other]) => {
            numbers::comparative_by_modifier(what, one, other)?
        }
        ("as_many" | "whether_as_many", [one, other]) => numbers::equative(one, other)?,
        ("absolute", [first, subject, said]) => Clause::All(vec![
            possibly_negated_clause(first)?,
            verb_phrases::clause(phrase(subject)?, said)?,
        ]),
        ("nothing_but" | "only_exists", [added, exception]) => {
            let added = modifier(added)?;
            let Phrase::Described(exception) = phrase(exception)? else {
                return None;
            };
            let count = match exception.quantifier {
                Quantifier::Exactly(count) => count,
                Quantifier::Some | Quantifier::The => 1,
                _ => return None,
            };
            let any = Noun::Object(Noun::ANY_OBJECT.to_owned());
            let only =
                Description::new(Quantifier::Exactly(count), any).with_modifier(added.clone());
            if function == "only_exists" && matches!(exception.quantifier, Quantifier::Exactly(_)) {
                // "There is only one bottle in the hall" counts bottles.
                return Some(Clause::Exists(exception.with_modifier(added).into()));
            }
            Clause::All(vec![
                Clause::Exists(exception.with_modifier(added).into()),
                Clause::Exists(only.into()),
            ])
        }
        ("so_is", [one, quality, other]) => Clause::All(vec![
            is(phrase(one)?, quality)?,
            is(phrase(other)?, quality)?,
        ]),
        ("is_unlike", [one, quality, other]) => Clause::All(vec![
            is(phrase(one)?, quality)?,
            Clause::Not(Box::new(is(phrase(other)?, quality)?)),
        ]),
        ("but_is", [one, quality, other]) => Clause::All(vec![
            Clause::Not(Box::new(is(phrase(one)?, quality)?)),
            is(phrase(other)?, quality)?,
        ]),
        ("more" | "whether_more", [more, than]) => numbers::comparative(more, than)?,
        ("has_more" | "whether_has_more", [one, what, other]) => {
            numbers::comparative_by_holder(one, what, other)?
        }
        ("same_color_all" | "whether_same_color_all", [set]) => {
            let all: Phrase = sets::set_description(set)?
                .with_quantifier(Quantifier::Every)
                .into();
            atomic_clause("same_color", vec![all.clone(), all])
        }
        ("same_material_all" | "whether_same_material_all", [set]) => {
            let all: Phrase = sets::set_description(set)?
                .with_quantifier(Quantifier::Every)
                .into();
            atomic_clause("same_material", vec![all.clone(), all])
        }
        ("same_color" | "whether_same_color", [a, b]) => {
            atomic_clause("same_color", vec![phrase(a)?, phrase(b)?])
        }
        ("same_material" | "whether_same_material", [a, b]) => {
            atomic_clause("same_material", vec![phrase(a)?, phrase(b)?])
        }
        ("holds_mount" | "whether_mount", [subject, mount]) => atomic_clause(
            "hangs_on",
            vec![phrase(subject)?, places::mount_from_tree(mount)?],
        ),
        ("leads", [door, passage]) => {
            modifier_clause(phrase(door)?, places::passage_from_tree(passage)?)
        }
        ("holds_side" | "whether_side", [subject, side]) => {
            modifier_clause(phrase(subject)?, places::side_from_tree(side)?)
        }
        ("list_holds", [items, word, object]) => {
            atomic_clause(&entry_id(word)?, vec![subjects(items)?, phrase(object)?])
        }
        ("list_holds_place", [items, place]) => {
            let (predicate, place) = place_of(place)?;
            atomic_clause(&predicate, vec![subjects(items)?, place])
        }
        ("list_is", [items, quality]) => Clause::Is {
            subject: subjects(items)?,
            quality: quality_of(quality)?,
        },
        _ => {
            return existence::from_tree(function, arguments)
                .or_else(|| rooms::from_tree(function, arguments))
                .or_else(|| distances::from_tree(function, arguments))
                .or_else(|| other_clauses::from_tree(function, arguments));
        }
    })
}

fn is(subject: Phrase, quality: &Tree) -> Option<Clause> {
    let quality = quality_of(quality)?;
    Some(Clause::Is { subject, quality })
}

/// "On the table, a lamp is between two cups": the place belongs to the subject.
fn fronted(modifiers: Vec<Modifier>, mut clause: Clause) -> Option<Clause> {
    // "In the study, the clock hangs by the door": the clock in the study is hanging, and it is by the door.
    if let Clause::All(clauses) = clause {
        let all = clauses.into_iter();
        let all = all.map(|one| fronted(modifiers.clone(), one));
        return all.collect::<Option<_>>().map(Clause::All);
    }
    let subject = match &mut clause {
        Clause::Holds { arguments, .. } => arguments.first_mut()?,
        Clause::Is { subject, .. } | Clause::Exists(subject) => subject,
        _ => return None,
    };
    let Phrase::Described(own) = subject else {
        return None;
    };
    own.modifiers.extend(modifiers);
    Some(clause)
}

/// The clause that a modifier ascribes to a subject.
pub(super) fn modifier_clause(subject: Phrase, modifier: Modifier) -> Clause {
    let mut arguments = vec![subject];
    arguments.extend(modifier.arguments);
    atomic_clause(&modifier.predicate, arguments)
}

pub(super) fn subjects(tree: &Tree) -> Option<Phrase> {
    let mut items = Vec::new();
    let mut rest = tree;
    loop {
        match parts(rest)? {
            ("subjects_pair", [first, last]) => {
                items.extend([phrase(first)?, phrase(last)?]);
                return Some(Phrase::List(items));
            }
            ("subjects_more", [first, more]) => {
                items.push(phrase(first)?);
                rest = more;
            }
            _ => return None,
        }
    }
}

pub(super) fn quality_of(tree: &Tree) -> Option<Quality> {
    Some(match parts(tree)? {
        ("quality_color", [word]) => Quality::Color(entry_id(word)?),
        ("quality_material", [word]) => Quality::Material(entry_id(word)?),
        ("quality_size", [word]) => Quality::Size(size(word)?),
        ("quality_state", [word]) => Quality::State(entry_id(word)?),
        _ => return None,
    })
}

pub(super) fn place_of(tree: &Tree) -> Option<(String, Phrase)> {
    let of = |predicate: &str, phrase| (predicate.to_owned(), phrase);
    Some(match parts(tree)? {
        ("place", [room]) => of("in_room", self::room(room)?),
        ("place_spot", [spot, room]) => (entry_id(spot)?, self::room(room)?),
        ("place_room_corner", [noun]) => {
            let room = Description::new(Quantifier::The, Noun::Room(entry_id(noun)?));
            of("in_corner_of", room.into())
        }
        ("place_same_room", [other]) => {
            let room = Description::new(Quantifier::Some, Noun::Room(Noun::ANY_ROOM.to_owned()));
            let with = Modifier::new("room_contains", [any_of_several(phrase(other)?)]);
            of("in_room", room.with_modifier(with).into())
        }
        ("place_same_thing", [relation, noun, other]) => {
            let relation = entry_id(relation)?;
            let converse = match relation.as_str() {
                "on" => "supports",
                "in" => "contains",
                _ => return None,
            };
            let shared = nominal(noun)?.with_modifier(Modifier::new(converse, [phrase(other)?]));
            (relation, shared.into())
        }
        ("destination_end", [room]) => of("at_end_of", self::room(room)?),
        ("destination_middle", [room]) => of("in_middle_of", self::room(room)?),
        ("destination_corner_of", [room]) => of("in_corner_of", self::room(room)?),
        ("place_end", []) => of("at_end_of", places::any_room()),
        ("place_corner" | "destination_corner", []) => of("in_corner_of", places::any_room()),
        ("place_middle", []) => of("in_middle_of", places::any_room()),
        ("on_storey", [place]) => of("on_storey", Phrase::Storey(number(place)?)),
        _ => return None,
    })
}

/// "In the same room as the curtains": as some of them.
fn any_of_several(phrase: Phrase) -> Phrase {
    match phrase {
        Phrase::Described(own) if own.quantifier == Quantifier::ThePlural => {
            own.with_quantifier(Quantifier::Some).into()
        }
        other => other,
    }
}

/// A room's noun with the colour of its walls; the caller sets the quantifier.
fn room_kind(tree: &Tree) -> Option<Description> {
    match parts(tree)? {
        ("room_kind", [word]) => Some(Description::new(
            Quantifier::Some,
            Noun::Room(entry_id(word)?),
        )),
        ("room_colored", [color, inner]) => {
            let mut room = room_kind(inner)?;
            room.colors.push(entry_id(color)?);
            Some(room)
        }
        _ => None,
    }
}

pub(super) fn room(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    let kind = |tree: &Tree, quantifier| Some(room_kind(tree)?.with_quantifier(quantifier));
    match (function, arguments) {
        ("room_of_set", [inner]) => {
            let (function, arguments) = parts(inner)?;
            return sets::partitive_phrase(function.strip_prefix("room_")?, arguments);
        }
        ("room_it", []) => return Some(Phrase::Pronoun),
        ("room_subject", [inner]) => return room(inner),
        _ => {}
    }
    let description = match (function, arguments) {
        ("room_the", [own]) => kind(own, Quantifier::The)?,
        ("room_a", [own]) => kind(own, Quantifier::Some)?,
        ("room_with_walls" | "room_some_with_walls", [own, color]) => {
            let quantifier = match function {
                "room_with_walls" => Quantifier::The,
                _ => Quantifier::Some,
            };
            let mut room = kind(own, quantifier)?;
            room.colors.push(entry_id(color)?);
            room
        }
        ("room_other_than", [own, other]) => {
            let mut own = kind(own, Quantifier::Some)?;
            own.modifiers.push(Modifier {
                negated: true,
                ..Modifier::new(Modifier::IDENTICAL, [room(other)?])
            });
            own
        }
        ("room_another", [own]) => kind(own, Quantifier::Some)?.other(),
        ("room_other", [own]) => kind(own, Quantifier::The)?.other(),
        ("room_every_of", [noun]) => {
            Description::new(Quantifier::Every, Noun::Room(entry_id(noun)?))
        }
        ("room_exactly", [count, noun]) => {
            let noun = Noun::Room(entry_id(noun)?);
            Description::new(Quantifier::Exactly(number(count)?), noun)
        }
        ("room_with_list", [own, things]) => {
            let with = |thing| Modifier::new("room_contains", [thing]);
            let mut room = kind(own, Quantifier::The)?;
            match existence::items_from_tree(things)? {
                Phrase::List(all) => room.modifiers.extend(all.into_iter().map(with)),
                one => room.modifiers.push(with(one)),
            }
            room
        }
        ("room_with_walls_and", [own, color, thing]) => {
            let mut room = kind(own, Quantifier::The)?;
            room.colors.push(entry_id(color)?);
            room.with_modifier(Modifier::new("room_contains", [phrase(thing)?]))
        }
        ("room_every", [own]) => kind(own, Quantifier::Every)?,
        ("room_no", [own]) => kind(own, Quantifier::No)?,
        ("room_nth", [place, own]) => Description {
            selection: Some(OrdinalSelection {
                order: OrdinalSelection::OF_HOUSE.to_owned(),
                place: number(place)?,
                reference: None,
            }),
            ..kind(own, Quantifier::The)?
        },
        ("room_with" | "room_some_with", [own, thing]) => {
            let quantifier = match function {
                "room_with" => Quantifier::The,
                _ => Quantifier::Some,
            };
            let with = Modifier::new("room_contains", [phrase(thing)?]);
            kind(own, quantifier)?.with_modifier(with)
        }
        _ => return None,
    };
    Some(description.into())
}

/// The noun phrases in a tree by their paths from it: argument numbers, counted from 0.
pub(super) fn noun_phrases(tree: &Tree) -> BTreeMap<Vec<usize>, Phrase> {
    let mut found = BTreeMap::new();
    let mut open = vec![(Vec::new(), tree)];
    while let Some((path, tree)) = open.pop() {
        // Clauses of existence say once what they add to each of their items.
        found.extend(existence::item_phrases(tree, &path));
        if !found.contains_key(&path)
            && let Some(own) = phrase(tree).or_else(|| room(tree))
        {
            found.insert(path.clone(), own);
        }
        for (k, argument) in parts(tree)
            .map_or(&[][..], |(_, arguments)| arguments)
            .iter()
            .enumerate()
        {
            let mut longer = path.clone();
            longer.push(k);
            open.push((longer, argument));
        }
    }
    found
}
