//! Questions: trees to forms.

use super::existence;
use super::from_tree::{
    affirmative_clause, atomic_clause, entry_id, modifier_clause, parts, place_of,
    possibly_negated_clause, quality_of, room,
};
use super::lexicon::RELATION;
use super::phrases::{modifier, nominal, phrase};
use super::{alternatives, numbers, places, sets, verb_phrases};
use crate::form::{
    AttributeKind, Clause, Description, Modifier, Noun, OrdinalSelection, Phrase, Quantifier,
    Question,
};
use crate::grammar::Tree;

/// The question of a tree that is only read, never said; `None` for other trees.
fn read_only_question(function: &str, arguments: &[Tree]) -> Option<Question> {
    let count = |description: Description| Question::HowMany(Box::new(description));
    let which = |kind: Option<Description>, clause: Clause| Question::Which {
        kind: kind.map(Box::new),
        clause,
    };
    Some(match (function, arguments) {
        ("how_many_seen_of", [noun, added]) => {
            let noun = nominal(noun)?.with_modifier(modifier(added)?);
            count(noun.with_modifier(Modifier::new("visible", [])))
        }
        ("which_are_more", [one, other]) => Question::Alternatives(vec![
            numbers::comparative(one, other)?,
            numbers::comparative(other, one)?,
        ]),
        ("which_has_more", [what, one, other]) => Question::Alternatives(vec![
            numbers::comparative_by_holder(one, what, other)?,
            numbers::comparative_by_holder(other, what, one)?,
        ]),
        ("where_are_more", [what, one, other]) => Question::Alternatives(vec![
            numbers::comparative_by_modifier(what, one, other)?,
            numbers::comparative_by_modifier(what, other, one)?,
        ]),
        ("which_count", [one, other, what]) => Question::Alternatives(
            numbers::alternative_count_clauses([one, other], &nominal(what)?, Clause::Exists)?,
        ),
        ("which_count_of", [one, what, other, added]) => {
            let what = nominal(what)?.with_modifier(modifier(added)?);
            Question::Alternatives(numbers::alternative_count_clauses(
                [one, other],
                &what,
                Clause::Exists,
            )?)
        }
        ("has_count_or", [subject, one, what, other]) => {
            let subject = phrase(subject)?;
            let has = |what| atomic_clause("has", vec![subject.clone(), what]);
            Question::Alternatives(numbers::alternative_count_clauses(
                [one, other],
                &nominal(what)?,
                has,
            )?)
        }
        ("which_verb", [kind, verb, object]) => which(
            Some(nominal(kind)?),
            atomic_clause(&entry_id(verb)?, vec![Phrase::Hole, phrase(object)?]),
        ),
        ("what_verb", [verb, object]) => which(
            None,
            atomic_clause(&entry_id(verb)?, vec![Phrase::Hole, phrase(object)?]),
        ),
        ("what_has", [subject]) => which(
            None,
            atomic_clause("belongs_to", vec![Phrase::Hole, phrase(subject)?]),
        ),
        ("what_seen_from", [place]) => which(
            None,
            atomic_clause("visible_from_room", vec![Phrase::Hole, room(place)?]),
        ),
        ("how_many_verb" | "how_many_verb_not", [kind, verb, object]) => {
            count(nominal(kind)?.with_modifier(Modifier {
                negated: function == "how_many_verb_not",
                ..Modifier::new(&entry_id(verb)?, [phrase(object)?])
            }))
        }
        ("how_many_has", [noun, subject]) => {
            let within = Modifier::new("belongs_to", [phrase(subject)?]);
            count(nominal(noun)?.with_modifier(within))
        }
        ("what_besides", [named, relation, landmark]) => {
            let any = Noun::Object(Noun::ANY_OBJECT.to_owned());
            let others = Description::new(Quantifier::Some, any).with_modifier(Modifier {
                negated: true,
                ..Modifier::new(Modifier::IDENTICAL, [phrase(named)?])
            });
            which(
                Some(others),
                atomic_clause(&entry_id(relation)?, vec![Phrase::Hole, phrase(landmark)?]),
            )
        }
        ("what_inside", []) => which(
            None,
            atomic_clause("in", vec![Phrase::Hole, Phrase::Pronoun]),
        ),
        ("either_room_has", [place, one, other]) => {
            let there = |item: &Tree| {
                let Phrase::Described(own) = existence::items_from_tree(item)? else {
                    return None;
                };
                let there = Modifier::new("in_room", [room(place)?]);
                Some(Clause::Exists(own.with_modifier(there).into()))
            };
            Question::Alternatives(vec![there(one)?, there(other)?])
        }
        ("either_exists", [one, other]) => {
            let one = existence::items_from_tree(one)?;
            let mut other = existence::items_from_tree(other)?;
            // "A shower in the bathroom or a bathtub": there, too.
            if let (Phrase::Described(one), Phrase::Described(other)) = (&one, &mut other)
                && other.modifiers.is_empty()
            {
                other.modifiers.clone_from(&one.modifiers);
            }
            Question::Alternatives(vec![Clause::Exists(one), Clause::Exists(other)])
        }
        ("whether_either_seen", [one, other]) => {
            let seen = |noun: &Tree| {
                let noun = nominal(noun)?.with_modifier(Modifier::new("visible", []));
                Some(Clause::Exists(noun.into()))
            };
            Question::Whether(Clause::Any(vec![seen(one)?, seen(other)?]))
        }
        ("any_of_two", [one, other, added]) => {
            let added = modifier(added)?;
            let exists = |noun: &Tree| {
                let noun = nominal(noun)?.with_modifier(added.clone());
                Some(Clause::Exists(noun.into()))
            };
            Question::Whether(Clause::Any(vec![exists(one)?, exists(other)?]))
        }
        ("which_of_is_closer", [noun, reference]) => {
            let reference = Some(phrase(reference)?);
            let kind = with_selection(nominal(noun)?, "closest_to", reference);
            which(Some(kind), Clause::Exists(Phrase::Hole))
        }
        ("which_carries", [kind, load]) => which(
            Some(nominal(kind)?),
            atomic_clause("supports", vec![Phrase::Hole, phrase(load)?]),
        ),
        ("which_holds_inside", [kind, content]) => which(
            Some(nominal(kind)?),
            atomic_clause("contains", vec![Phrase::Hole, phrase(content)?]),
        ),
        ("how_many_seen", [noun]) => {
            count(nominal(noun)?.with_modifier(Modifier::new("visible", [])))
        }
        ("how_many_room_has", [noun, place]) => {
            count(nominal(noun)?.with_modifier(Modifier::new("in_room", [room(place)?])))
        }
        ("what_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            which(None, atomic_clause(&predicate, vec![Phrase::Hole, place]))
        }
        ("what_mount", [mount]) => {
            let mount = places::mount_from_tree(mount)?;
            which(None, atomic_clause("hangs_on", vec![Phrase::Hole, mount]))
        }
        ("which_mount", [kind, mount]) => {
            let mount = places::mount_from_tree(mount)?;
            which(
                Some(nominal(kind)?),
                atomic_clause("hangs_on", vec![Phrase::Hole, mount]),
            )
        }
        ("which_is_most" | "which_is_least" | "which_is_superlative", [word]) => {
            let word = entry_id(word)?;
            let order = match function {
                "which_is_superlative" => &word,
                _ => superlative_of(&word, function == "which_is_least")?,
            };
            let kind = Description::new(Quantifier::The, Noun::SameThings);
            which(
                Some(with_selection(kind, order, None)),
                Clause::Exists(Phrase::Hole),
            )
        }
        ("what_is", [subject]) => {
            let Phrase::Described(kind) = phrase(subject)? else {
                return None;
            };
            which(Some(*kind), Clause::Exists(Phrase::Hole))
        }
        ("which_leads", [noun, passage]) => which(
            Some(nominal(noun)?),
            modifier_clause(Phrase::Hole, places::passage_from_tree(passage)?),
        ),
        // "Is that a clock on the wall?" is whether there is one, where a place is named.
        ("is_that", [item]) => Question::Whether(Clause::Exists(placed_indefinite(item)?)),
        ("is_that_either", [one, other, place]) => {
            let place = modifier(place)?;
            let there = |noun: &Tree| {
                let noun = nominal(noun)?.with_modifier(place.clone());
                Some(Clause::Exists(noun.into()))
            };
            Question::Alternatives(vec![there(one)?, there(other)?])
        }
        ("floor_kind", [place]) => {
            let floor = Noun::Structure("floor".to_owned());
            let there = Modifier::new("in_room", [room(place)?]);
            Question::Attribute {
                kind: AttributeKind::Material,
                of: Description::new(Quantifier::Some, floor)
                    .with_modifier(there)
                    .into(),
            }
        }
        ("how_far", [subject, from]) => Question::HowFar {
            subject: phrase(subject)?,
            from: phrase(from)?,
        },
        ("how_far_away", [subject]) => Question::HowFar {
            subject: phrase(subject)?,
            from: Phrase::Listener,
        },
        ("where_leads", [door]) => {
            let any = Description::new(Quantifier::Some, Noun::Room(Noun::ANY_ROOM.to_owned()));
            which(
                Some(any),
                atomic_clause("leads_to", vec![phrase(door)?, Phrase::Hole]),
            )
        }
        ("what_seen_there", [relation, landmark]) => which(
            None,
            Clause::All(vec![
                atomic_clause("visible", vec![Phrase::Hole]),
                atomic_clause(&entry_id(relation)?, vec![Phrase::Hole, phrase(landmark)?]),
            ]),
        ),
        ("what_between", [a, b]) => which(
            None,
            atomic_clause("between", vec![Phrase::Hole, phrase(a)?, phrase(b)?]),
        ),
        ("where_stands", [of, _]) => Question::Attribute {
            kind: AttributeKind::Place,
            of: phrase(of)?,
        },
        ("which_of_stranded", [set, subject, word]) => which(
            Some(sets::set_description(set)?),
            atomic_clause(&entry_id(word)?, vec![phrase(subject)?, Phrase::Hole]),
        ),
        ("how_many_held", [kind, subject, word]) => {
            let (held, holder) = (nominal(kind)?, phrase(subject)?);
            let converse = match entry_id(word)?.as_str() {
                "supports" => "on",
                "contains" => "in",
                "has" | "holds" => "belongs_to",
                _ => return None,
            };
            count(held.with_modifier(Modifier::new(converse, [holder])))
        }
        ("where_in", [place, of]) => {
            let Phrase::Described(of) = phrase(of)? else {
                return None;
            };
            let of = of.with_modifier(Modifier::new("in_room", [room(place)?]));
            Question::Attribute {
                kind: AttributeKind::Place,
                of: of.into(),
            }
        }
        ("which_stranded", [kind, subject, word]) => which(
            Some(nominal(kind)?),
            atomic_clause(&entry_id(word)?, vec![phrase(subject)?, Phrase::Hole]),
        ),
        ("what_stranded", [subject, word]) | ("what_stranded_standing", [subject, _, word]) => {
            which(
                None,
                atomic_clause(&entry_id(word)?, vec![phrase(subject)?, Phrase::Hole]),
            )
        }
        ("what_says", [said]) => what(verb_phrases::clause(Phrase::Hole, said)?),
        ("which_says" | "which_modified_says", [kind, said]) => which(
            Some(nominal(kind)?),
            verb_phrases::clause(Phrase::Hole, said)?,
        ),
        ("what_stands", [posture, said]) => what(verb_phrases::clause(
            Phrase::Hole,
            &posture_phrase(posture, said),
        )?),
        ("which_stands", [kind, posture, said]) => which(
            Some(nominal(kind)?),
            verb_phrases::clause(Phrase::Hole, &posture_phrase(posture, said))?,
        ),
        ("which_of_says", [set, said]) => which(
            Some(sets::set_description(set)?),
            verb_phrases::clause(Phrase::Hole, said)?,
        ),
        ("which_of_stands", [set, posture, said]) => which(
            Some(sets::set_description(set)?),
            verb_phrases::clause(Phrase::Hole, &posture_phrase(posture, said))?,
        ),
        ("which_of_is", [set, order]) => which(
            Some(with_selection(
                sets::set_description(set)?,
                &entry_id(order)?,
                None,
            )),
            Clause::Exists(Phrase::Hole),
        ),
        ("which_of_order_to", [set, order, reference]) => {
            let reference = Some(phrase(reference)?);
            let kind = sets::set_description(set)?;
            which(
                Some(with_selection(kind, &entry_id(order)?, reference)),
                Clause::Exists(Phrase::Hole),
            )
        }
        ("which_of_is_more" | "which_of_is_less", [set, word]) => {
            let order = superlative_of(&entry_id(word)?, function == "which_of_is_less")?;
            which(
                Some(with_selection(sets::set_description(set)?, order, None)),
                Clause::Exists(Phrase::Hole),
            )
        }
        ("how_many_say", [kind, said]) => {
            count(verb_phrases::with_predications(nominal(kind)?, said)?)
        }
        ("how_many_bare", [said]) => {
            let same = Description::new(Quantifier::Some, Noun::SameNoun);
            count(verb_phrases::with_predications(same, said)?)
        }
        ("how_many_of_say", [set, said]) => count(verb_phrases::with_predications(
            sets::set_description(set)?,
            said,
        )?),
        ("how_many_stand", [kind, posture, said]) => count(verb_phrases::with_predications(
            nominal(kind)?,
            &posture_phrase(posture, said),
        )?),
        ("how_many_carry", [kind, load]) => {
            count(nominal(kind)?.with_modifier(Modifier::new("supports", [phrase(load)?])))
        }
        ("how_many_hold_inside", [kind, content]) => {
            count(nominal(kind)?.with_modifier(Modifier::new("contains", [phrase(content)?])))
        }
        ("which_room_has", [set, thing]) => which(
            Some(sets::set_description(set)?),
            atomic_clause("room_contains", vec![Phrase::Hole, phrase(thing)?]),
        ),
        ("how_many_rooms_have", [noun, thing]) => {
            let rooms = Description::new(Quantifier::Some, Noun::Room(entry_id(noun)?));
            count(rooms.with_modifier(Modifier::new("room_contains", [phrase(thing)?])))
        }
        ("which_superlative", [noun, order]) => {
            let kind = with_selection(nominal(noun)?, &entry_id(order)?, None);
            which(Some(kind), Clause::Exists(Phrase::Hole))
        }
        ("which_order_to", [noun, order, reference])
        | ("which_stands_order", [noun, _, order, reference]) => {
            let kind = with_selection(nominal(noun)?, &entry_id(order)?, Some(phrase(reference)?));
            which(Some(kind), Clause::Exists(Phrase::Hole))
        }
        _ => return None,
    })
}

/// The phrase of an item such as "a clock on the wall": indefinite, with what tells where.
/// "What is hanging above the bed?" asks which hanging thing is above the bed.
fn what(clause: Clause) -> Question {
    let Clause::All(mut clauses) = clause else {
        return Question::Which { kind: None, clause };
    };
    let any = Noun::Object(Noun::ANY_OBJECT.to_owned());
    let last = clauses.pop();
    // "What is on the floor, a bath mat?" asks whether it is one.
    if let Some(Clause::Holds {
        predicate,
        arguments,
    }) = &last
        && predicate == Modifier::IDENTICAL
        && let [Phrase::Hole, Phrase::Described(guess)] = &arguments[..]
        && let Some(there) = clauses
            .iter()
            .map(hole_modifier)
            .collect::<Option<Vec<_>>>()
    {
        let mut guess = Description::clone(guess);
        guess.modifiers.extend(there);
        return Question::Whether(Clause::Exists(guess.into()));
    }
    let mut kind = Description::new(Quantifier::Some, any);
    for said in &clauses {
        let quality = match said {
            Clause::Is {
                subject: Phrase::Hole,
                quality,
            } => verb_phrases::add_quality(&mut kind, quality.clone()),
            _ => None,
        };
        if quality.is_none() {
            clauses.extend(last);
            return Question::Which {
                kind: None,
                clause: Clause::All(clauses),
            };
        }
    }
    Question::Which {
        kind: Some(Box::new(kind)),
        clause: last.unwrap_or(Clause::Exists(Phrase::Hole)),
    }
}

/// What a clause says of the hole, as a modifier.
fn hole_modifier(clause: &Clause) -> Option<Modifier> {
    match clause {
        Clause::Holds {
            predicate,
            arguments,
        } => match &arguments[..] {
            [Phrase::Hole, others @ ..] => Some(Modifier {
                negated: false,
                predicate: predicate.clone(),
                arguments: others.to_vec(),
            }),
            _ => None,
        },
        _ => None,
    }
}

fn placed_indefinite(item: &Tree) -> Option<Phrase> {
    match existence::items_from_tree(item)? {
        Phrase::Described(own)
            if own.quantifier == Quantifier::Some && !own.modifiers.is_empty() =>
        {
            Some(Phrase::Described(own))
        }
        _ => None,
    }
}

/// "Stands next to the door".
pub(super) fn posture_phrase(posture: &Tree, said: &Tree) -> Tree {
    Tree::apply("vp_standing", [posture.clone(), said.clone()])
}

pub(super) fn with_selection(
    description: Description,
    order: &str,
    reference: Option<Phrase>,
) -> Description {
    Description {
        selection: Some(OrdinalSelection {
            order: order.to_owned(),
            place: 1,
            reference: reference.map(Box::new),
        }),
        ..description.with_quantifier(Quantifier::The)
    }
}

/// The order whose first thing is more so than all others, or less.
pub(super) fn superlative_of(comparative: &str, less: bool) -> Option<&'static str> {
    match (comparative, less) {
        ("larger_than", false) => Some("largest"),
        ("larger_than", true) => Some("smallest"),
        ("taller_than", false) => Some("tallest"),
        ("wider_than", false) => Some("widest"),
        _ => None,
    }
}

/// The question of a tree; `None` for other trees.
pub(super) fn question(tree: &Tree) -> Option<Question> {
    let (function, arguments) = parts(tree)?;
    let attribute = |kind, of: &Tree| {
        let of = phrase(of)?;
        Some(Question::Attribute { kind, of })
    };
    let which = |kind: Option<&Tree>, clause: Clause| {
        let kind = match kind {
            Some(kind) => Some(Box::new(nominal(kind)?)),
            None => None,
        };
        Some(Question::Which { kind, clause })
    };
    if let Some(clauses) = alternatives::from_tree(function, arguments) {
        return Some(Question::Alternatives(clauses));
    }
    if let Some(other) = read_only_question(function, arguments) {
        return Some(other);
    }
    match (function, arguments) {
        ("how_many", [what]) => Some(Question::HowMany(Box::new(nominal(what)?))),
        ("how_many_rooms", [noun]) => {
            let noun = Noun::Room(entry_id(noun)?);
            let what = Description::new(Quantifier::Some, noun);
            Some(Question::HowMany(Box::new(what)))
        }
        ("how_many_storeys", []) => {
            let what = Description::new(Quantifier::Some, Noun::Storey);
            Some(Question::HowMany(Box::new(what)))
        }
        ("how_many_of", [what, added]) => {
            let mut description = nominal(what)?;
            description.modifiers.push(modifier(added)?);
            Some(Question::HowMany(Box::new(description)))
        }
        ("what_holds", [relation @ Tree::Entry { class, .. }, object]) if class == RELATION => {
            which(
                None,
                atomic_clause(&entry_id(relation)?, vec![Phrase::Hole, phrase(object)?]),
            )
        }
        ("which_holds", [kind, relation, object]) => {
            let clause = atomic_clause(&entry_id(relation)?, vec![Phrase::Hole, phrase(object)?]);
            which(Some(kind), clause)
        }
        ("which_place", [kind, place]) => {
            let (predicate, place) = place_of(place)?;
            which(
                Some(kind),
                atomic_clause(&predicate, vec![Phrase::Hole, place]),
            )
        }
        ("which_is", [kind, quality]) => {
            let quality = quality_of(quality)?;
            let subject = Phrase::Hole;
            which(Some(kind), Clause::Is { subject, quality })
        }
        ("where", [of]) => attribute(AttributeKind::Place, of),
        ("which_room", [of]) => attribute(AttributeKind::Room, of),
        ("what_color", [of]) => attribute(AttributeKind::Color, of),
        ("what_material", [of]) => attribute(AttributeKind::Material, of),
        _ => Some(Question::Whether(affirmative_clause(function, arguments)?)),
    }
}

/// A question within another sentence: "tell me whether the lamp is on".
pub(super) fn indirect_question(tree: &Tree) -> Option<Question> {
    let attribute = |kind, of: &Tree| {
        let of = phrase(of)?;
        Some(Question::Attribute { kind, of })
    };
    match parts(tree)? {
        ("indirect_whether", [inner]) => Some(Question::Whether(possibly_negated_clause(inner)?)),
        ("indirect_question", [inner]) => question(inner),
        ("indirect_where", [of]) => attribute(AttributeKind::Place, of),
        ("indirect_color", [of]) => attribute(AttributeKind::Color, of),
        ("indirect_material", [of]) => attribute(AttributeKind::Material, of),
        ("indirect_room", [of]) => attribute(AttributeKind::Room, of),
        ("indirect_stranded", arguments) => read_only_question("what_stranded", arguments),
        ("indirect_which_of_stranded", arguments) => {
            read_only_question("which_of_stranded", arguments)
        }
        ("indirect_which_stranded", arguments) => read_only_question("which_stranded", arguments),
        ("indirect_stranded_standing", arguments) => {
            read_only_question("what_stranded_standing", arguments)
        }
        _ => None,
    }
}
