//! Trees to forms: the meanings of the grammar's functions.

use super::{existence, places, questions, rooms, several};
use crate::form::{
    Clause, Description, Form, Modifier, Noun, Phrase, PlaceInOrder, Quality, Quantifier, Question,
    Request, RequestStep,
};
use crate::grammar::Tree;
use crate::size::SizeClass;
use std::collections::BTreeMap;

/// The function of a tree with its arguments.
pub(super) type Parts<'a> = (&'a str, &'a [Tree]);

/// The function of a tree with its arguments; `None` for words and numbers.
pub(super) fn parts(tree: &Tree) -> Option<Parts<'_>> {
    match tree {
        Tree::Apply {
            function,
            arguments,
        } => Some((function, arguments)),
        Tree::Entry { .. } | Tree::Number { .. } => None,
    }
}

pub(super) fn id(tree: &Tree) -> Option<String> {
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
        ("request", [inner]) => Form::Request(plan(inner)?),
        ("ask", [inner]) => Form::Question(questions::question(inner)?),
        ("ask_clause", [inner]) => Form::Question(Question::Whether(simple(inner)?)),
        ("phrase", [inner]) => Form::NounPhrase(phrase(inner)?),
        ("phrase_room", [inner]) => Form::NounPhrase(room(inner)?),
        _ => return None,
    })
}

fn clause(tree: &Tree) -> Option<Clause> {
    Some(match parts(tree)? {
        ("one_clause", [inner]) => simple(inner)?,
        ("all_clauses", [inner]) => Clause::All(list(inner)?),
        ("any_clause", [inner]) => Clause::Any(list(inner)?),
        _ => return None,
    })
}

fn list(tree: &Tree) -> Option<Vec<Clause>> {
    match parts(tree)? {
        ("and_pair" | "or_pair", [a, b]) => Some(vec![simple(a)?, simple(b)?]),
        ("and_more" | "or_more", [first, rest]) => {
            let mut all = vec![simple(first)?];
            all.extend(list(rest)?);
            Some(all)
        }
        _ => None,
    }
}

pub(super) fn holds(predicate: &str, arguments: Vec<Phrase>) -> Clause {
    Clause::Holds {
        predicate: predicate.to_owned(),
        arguments,
    }
}

fn simple(tree: &Tree) -> Option<Clause> {
    let (function, arguments) = parts(tree)?;
    if let Some(plain) = function.strip_suffix("_not") {
        let inner = affirmed(plain, arguments)?;
        return Some(Clause::Not(Box::new(inner)));
    }
    affirmed(function, arguments)
}

pub(super) fn affirmed(function: &str, arguments: &[Tree]) -> Option<Clause> {
    Some(match (function, arguments) {
        ("holds" | "holds_verb" | "whether_holds" | "whether_verb", [subject, word, object]) => {
            holds(&id(word)?, vec![phrase(subject)?, phrase(object)?])
        }
        ("holds_between" | "whether_between", [subject, a, b]) => {
            holds("between", vec![phrase(subject)?, phrase(a)?, phrase(b)?])
        }
        ("holds_place" | "whether_place", [subject, place]) => {
            let (predicate, place) = place_of(place)?;
            holds(&predicate, vec![phrase(subject)?, place])
        }
        ("is" | "whether_is", [subject, quality]) => Clause::Is {
            subject: phrase(subject)?,
            quality: quality_of(quality)?,
        },
        ("vps" | "whether_vps", [subject, rest]) => several::clause(phrase(subject)?, rest)?,
        ("exists_vps", [subject, rest]) => several::existing(phrase(subject)?, rest)?,
        ("holds_converse" | "whether_converse", [subject, word, object]) => {
            holds(&id(word)?, vec![phrase(object)?, phrase(subject)?])
        }
        ("holds_superlative", [subject, order, noun]) => {
            let selected = questions::selected(described(noun)?, &id(order)?, None);
            holds("identical", vec![phrase(subject)?, selected.into()])
        }
        ("holds_hang", [subject, mount]) => {
            holds("hangs_on", vec![phrase(subject)?, phrase(mount)?])
        }
        ("holds_verb_list", [subject, word, items]) => {
            let Clause::Exists(items) =
                existence::from_tree("exists_list", std::slice::from_ref(items))?
            else {
                return None;
            };
            holds(&id(word)?, vec![phrase(subject)?, items])
        }
        ("same_color" | "whether_same_color", [a, b]) => {
            holds("same_color", vec![phrase(a)?, phrase(b)?])
        }
        ("same_material" | "whether_same_material", [a, b]) => {
            holds("same_material", vec![phrase(a)?, phrase(b)?])
        }
        ("holds_mount" | "whether_mount", [subject, mount]) => holds(
            "hangs_on",
            vec![phrase(subject)?, places::mount_from_tree(mount)?],
        ),
        ("leads", [door, passage]) => holds_of(phrase(door)?, places::passage_from_tree(passage)?),
        ("holds_side" | "whether_side", [subject, side]) => {
            holds_of(phrase(subject)?, places::side_from_tree(side)?)
        }
        ("list_holds", [items, word, object]) => {
            holds(&id(word)?, vec![subjects(items)?, phrase(object)?])
        }
        ("list_holds_place", [items, place]) => {
            let (predicate, place) = place_of(place)?;
            holds(&predicate, vec![subjects(items)?, place])
        }
        ("list_is", [items, quality]) => Clause::Is {
            subject: subjects(items)?,
            quality: quality_of(quality)?,
        },
        _ => {
            return existence::from_tree(function, arguments)
                .or_else(|| rooms::from_tree(function, arguments));
        }
    })
}

/// The clause that a modifier ascribes to a subject.
fn holds_of(subject: Phrase, modifier: Modifier) -> Clause {
    let mut arguments = vec![subject];
    arguments.extend(modifier.arguments);
    holds(&modifier.predicate, arguments)
}

fn subjects(tree: &Tree) -> Option<Phrase> {
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
        ("quality_color", [word]) => Quality::Color(id(word)?),
        ("quality_material", [word]) => Quality::Material(id(word)?),
        ("quality_size", [word]) => Quality::Size(size(word)?),
        ("quality_state", [word]) => Quality::State(id(word)?),
        _ => return None,
    })
}

fn size(tree: &Tree) -> Option<SizeClass> {
    let word = id(tree)?;
    SizeClass::ALL
        .into_iter()
        .find(|size| size.word() == Some(&word))
}

pub(super) fn place_of(tree: &Tree) -> Option<(String, Phrase)> {
    let any_room = || {
        let noun = Noun::Room(Noun::ANY_ROOM.to_owned());
        Phrase::from(Description::new(Quantifier::Some, noun))
    };
    let of = |predicate: &str, phrase| (predicate.to_owned(), phrase);
    Some(match parts(tree)? {
        ("place", [room]) => of("in_room", self::room(room)?),
        ("place_spot", [spot, room]) => (id(spot)?, self::room(room)?),
        ("place_corner", []) => of("in_corner_of", any_room()),
        ("place_middle", []) => of("in_middle_of", any_room()),
        ("on_storey", [place]) => of("on_storey", Phrase::Storey(number(place)?)),
        _ => return None,
    })
}

pub(super) fn room(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    let kind = |tree: &Tree, quantifier| match parts(tree)? {
        ("room_kind", [word]) => Some(Description::new(quantifier, Noun::Room(id(word)?))),
        _ => None,
    };
    match (function, arguments) {
        ("room_it", []) => return Some(Phrase::Pronoun),
        ("room_subject", [inner]) => return room(inner),
        _ => {}
    }
    let description = match (function, arguments) {
        ("room_the", [own]) => kind(own, Quantifier::The)?,
        ("room_a", [own]) => kind(own, Quantifier::Some)?,
        ("room_every", [own]) => kind(own, Quantifier::Every)?,
        ("room_no", [own]) => kind(own, Quantifier::No)?,
        ("room_nth", [place, own]) => Description {
            selection: Some(PlaceInOrder {
                order: PlaceInOrder::OF_HOUSE.to_owned(),
                place: number(place)?,
                reference: None,
            }),
            ..kind(own, Quantifier::The)?
        },
        ("room_with", [own, thing]) => Description {
            modifiers: vec![Modifier {
                negated: false,
                predicate: "room_contains".to_owned(),
                arguments: vec![phrase(thing)?],
            }],
            ..kind(own, Quantifier::The)?
        },
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

pub(super) fn phrase(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    let of = |quantifier, noun: &Tree| -> Option<Phrase> {
        Some(described(noun)?.with_quantifier(quantifier).into())
    };
    let selected =
        |noun: &Tree, order: &Tree, place, reference: Option<Phrase>| -> Option<Phrase> {
            let selection = PlaceInOrder {
                order: id(order)?,
                place,
                reference: reference.map(Box::new),
            };
            let description = Description {
                selection: Some(selection),
                ..described(noun)?.with_quantifier(Quantifier::The)
            };
            Some(description.into())
        };
    let first_in = |noun: &Tree, order: &str| -> Option<Phrase> {
        let selection = PlaceInOrder {
            order: order.to_owned(),
            place: 1,
            reference: None,
        };
        let description = Description {
            selection: Some(selection),
            ..described(noun)?.with_quantifier(Quantifier::The)
        };
        Some(description.into())
    };
    let that = |quantifier, noun: &Tree, predicate: String, other: Phrase| -> Option<Phrase> {
        let mut description = described(noun)?.with_quantifier(quantifier);
        description.modifiers.push(Modifier {
            negated: false,
            predicate,
            arguments: vec![other],
        });
        Some(description.into())
    };
    match (function, arguments) {
        ("the" | "i_the", [noun]) => of(Quantifier::The, noun),
        ("some" | "i_some", [noun]) => of(Quantifier::Some, noun),
        ("every" | "i_every", [noun]) => of(Quantifier::Every, noun),
        ("no", [noun]) => of(Quantifier::No, noun),
        ("exactly_one", [noun]) => of(Quantifier::Exactly(1), noun),
        ("exactly" | "i_exactly", [count, noun]) => of(Quantifier::Exactly(number(count)?), noun),
        ("at_least_one", [noun]) => of(Quantifier::AtLeast(1), noun),
        ("at_least", [count, noun]) => of(Quantifier::AtLeast(number(count)?), noun),
        ("i_the_that" | "i_the_that_verb", [noun, relation, other]) => {
            that(Quantifier::The, noun, id(relation)?, phrase(other)?)
        }
        ("i_some_that" | "i_some_that_verb", [noun, relation, other]) => {
            that(Quantifier::Some, noun, id(relation)?, phrase(other)?)
        }
        ("i_the_that_place", [noun, place]) => {
            let (predicate, place) = place_of(place)?;
            that(Quantifier::The, noun, predicate, place)
        }
        ("i_some_that_place", [noun, place]) => {
            let (predicate, place) = place_of(place)?;
            that(Quantifier::Some, noun, predicate, place)
        }
        ("nth" | "i_nth", [place, noun, order]) => selected(noun, order, number(place)?, None),
        ("superlative" | "i_superlative", [order, noun]) => selected(noun, order, 1, None),
        ("selected_to", [noun, order, reference]) => {
            selected(noun, order, 1, Some(phrase(reference)?))
        }
        ("by_id" | "i_by_id", [own]) => Some(Phrase::Id(number(own)?)),
        ("you" | "i_you", []) => Some(Phrase::Listener),
        ("it" | "i_it", []) => Some(Phrase::Pronoun),
        ("structure_np" | "i_structure", [noun]) => {
            let noun = Noun::Structure(id(noun)?);
            Some(Description::new(Quantifier::Some, noun).into())
        }
        ("np_nothing" | "np_something", [inner]) => nothing(inner).map(Phrase::from),
        ("at_least_two" | "i_at_least_two", [noun]) => of(Quantifier::AtLeast(2), noun),
        ("i_something", []) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            Some(Description::new(Quantifier::Some, noun).into())
        }
        ("nth_left" | "i_nth_left", [noun]) => first_in(noun, "from_left"),
        ("nth_right" | "i_nth_right", [noun]) => first_in(noun, "from_right"),
        ("i_with", [noun, added]) => {
            let noun = described(noun)?.with_quantifier(Quantifier::The);
            Some(noun.with_modifier(modifier(added)?).into())
        }
        ("i_some_with", [noun, added]) => {
            Some(described(noun)?.with_modifier(modifier(added)?).into())
        }
        _ => None,
    }
}

fn nothing(tree: &Tree) -> Option<Description> {
    match parts(tree)? {
        ("nothing", []) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            Some(Description::new(Quantifier::No, noun))
        }
        ("something", []) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            Some(Description::new(Quantifier::Some, noun))
        }
        ("nothing_with" | "something_with", [inner, added]) => {
            Some(nothing(inner)?.with_modifier(modifier(added)?))
        }
        _ => None,
    }
}

/// Returns whether a noun names doors and archways, which lead from room to room.
fn is_way(noun: &Noun) -> bool {
    let ways = ["door", "arch", "archway", "doorway", "gate", "thing"];
    matches!(noun, Noun::Object(noun) if ways.iter().any(|way| noun.ends_with(way)))
}

/// The description of a noun with its adjectives and modifiers; the caller sets its quantifier.
pub(super) fn described(tree: &Tree) -> Option<Description> {
    let (function, arguments) = parts(tree)?;
    let plain = |noun: String| Description::new(Quantifier::Some, Noun::Object(noun));
    Some(match (function, arguments) {
        ("plain", [inner]) => described(inner)?,
        ("with" | "but_not", [noun, added]) => {
            let mut description = described(noun)?;
            let added = modifier(added)?;
            if added.predicate.starts_with("leads_") && !is_way(&description.noun) {
                return None;
            }
            description.modifiers.push(Modifier {
                negated: function == "but_not",
                ..added
            });
            description
        }
        ("noun" | "tail", [word]) => plain(id(word)?),
        ("gathered", [head, tail]) => {
            let mut description = described(tail)?;
            let Noun::Object(tail) = &description.noun else {
                return None;
            };
            description.noun = Noun::Object(format!("{} of {tail}", id(head)?));
            description
        }
        ("room_compound", [room, noun]) => {
            let (room, noun) = (id(room)?, id(noun)?);
            // "The balcony door" leads there, "the kitchen table" stands there.
            let predicate = if noun.ends_with("door") {
                "leads_to"
            } else {
                "in_room"
            };
            let room = Description::new(Quantifier::The, Noun::Room(room));
            plain(noun).with_modifier(Modifier::new(predicate, [room.into()]))
        }
        ("color" | "color_tail", [word, inner]) => {
            let mut description = described(inner)?;
            description.colors.insert(0, id(word)?);
            (description.colors.len() == 1).then_some(description)?
        }
        ("two_colors" | "two_colors_tail", [one, two, inner]) => {
            let mut description = described(inner)?;
            if !description.colors.is_empty() {
                return None;
            }
            description.colors = vec![id(one)?, id(two)?];
            description
        }
        ("material" | "material_tail", [word, inner]) => {
            let mut description = described(inner)?;
            let before = description.material.replace(id(word)?);
            before.is_none().then_some(description)?
        }
        ("size" | "size_tail", [word, inner]) => {
            let mut description = described(inner)?;
            let before = description.size.replace(size(word)?);
            before.is_none().then_some(description)?
        }
        ("state", [word, inner]) => {
            let mut description = described(inner)?;
            let before = description.state.replace(id(word)?);
            before.is_none().then_some(description)?
        }
        _ => return None,
    })
}

pub(super) fn modifier(tree: &Tree) -> Option<Modifier> {
    let (predicate, arguments) = match parts(tree)? {
        ("modifier_state", [state]) => (id(state)?, Vec::new()),
        ("modifier_state_not", [state]) => {
            return Some(Modifier {
                negated: true,
                ..Modifier::new(&id(state)?, [])
            });
        }
        ("modifier_source", [source]) => ("in_or_on".to_owned(), vec![phrase(source)?]),
        ("modifier_carries", [load]) => ("supports".to_owned(), vec![phrase(load)?]),
        ("modifier_holds_inside", [content]) => ("contains".to_owned(), vec![phrase(content)?]),
        ("modifier" | "modifier_verb", [word, other]) => (id(word)?, vec![phrase(other)?]),
        ("modifier_between", [a, b]) => ("between".to_owned(), vec![phrase(a)?, phrase(b)?]),
        ("modifier_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            (predicate, vec![place])
        }
        (function, arguments) => return places::modifier_from_tree(function, arguments),
    };
    Some(Modifier {
        negated: false,
        predicate,
        arguments,
    })
}

fn plan(tree: &Tree) -> Option<Request> {
    match parts(tree)? {
        ("one_step", [only]) => Some(Request::Sequence(vec![step(only)?])),
        ("unless", [condition, then]) => Some(Request::If(
            Clause::Not(Box::new(simple(condition)?)),
            step(then)?,
        )),
        ("then" | "steps", [first, rest]) => {
            let Request::Sequence(rest) = plan(rest)? else {
                return None;
            };
            let mut steps = vec![step(first)?];
            steps.extend(rest);
            Some(Request::Sequence(steps))
        }
        ("if", [condition, then]) => Some(Request::If(simple(condition)?, step(then)?)),
        _ => None,
    }
}

fn step(tree: &Tree) -> Option<RequestStep> {
    let act = |verb: &str, object: &Tree| {
        Some(RequestStep::Do {
            verb: verb.to_owned(),
            object: phrase(object)?,
        })
    };
    Some(match parts(tree)? {
        ("go_to", [to]) => RequestStep::GoTo(room(to)?),
        ("do_from_room", [verb, object, from]) => {
            let Phrase::Described(description) = phrase(object)? else {
                return None;
            };
            let in_room = Modifier::new("in_room", [room(from)?]);
            RequestStep::Do {
                verb: id(verb)?,
                object: description.with_modifier(in_room).into(),
            }
        }
        ("do_on", [object]) => act("switch_on", object)?,
        ("do_off", [object]) => act("switch_off", object)?,
        ("do_pick_up", [object]) => act("pick_up", object)?,
        ("do_drop", [object]) => act("drop", object)?,
        ("do_bring_me", [object]) => act("bring_me", object)?,
        ("do", [verb, object]) => RequestStep::Do {
            verb: id(verb)?,
            object: phrase(object)?,
        },
        ("do_not", [verb, object]) => RequestStep::DoNot {
            verb: id(verb)?,
            object: phrase(object)?,
        },
        ("put" | "put_modified", [object, relation, to]) => RequestStep::Put {
            object: phrase(object)?,
            predicate: id(relation)?,
            to: phrase(to)?,
        },
        ("put_in_place" | "put_modified_in_place", [object, place]) => {
            let (predicate, to) = place_of(place)?;
            RequestStep::Put {
                object: phrase(object)?,
                predicate,
                to,
            }
        }
        ("bring", [object, to]) => RequestStep::Bring {
            object: phrase(object)?,
            to: phrase(to)?,
        },
        ("bring_to_place", [object, to]) => RequestStep::Bring {
            object: phrase(object)?,
            to: room(to)?,
        },
        _ => return None,
    })
}
