//! Noun phrases: the meanings of the grammar's functions that make them.

use super::from_tree::{entry_id, number, parts, place_of, quality_of, room};
use super::{converse, existence, own_doors, places, questions, sets, verb_phrases};
use crate::form::{Description, Modifier, Noun, OrdinalSelection, Phrase, Quality, Quantifier};
use crate::grammar::Tree;
use crate::size::SizeClass;

pub(super) fn phrase(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    let of = |quantifier, noun: &Tree| -> Option<Phrase> {
        Some(nominal(noun)?.with_quantifier(quantifier).into())
    };
    let selected =
        |noun: &Tree, order: &Tree, place, reference: Option<Phrase>| -> Option<Phrase> {
            let selection = OrdinalSelection {
                order: entry_id(order)?,
                place,
                reference: reference.map(Box::new),
            };
            let description = Description {
                selection: Some(selection),
                ..nominal(noun)?.with_quantifier(Quantifier::The)
            };
            Some(description.into())
        };
    let first_in = |noun: &Tree, order: &str| -> Option<Phrase> {
        let selection = OrdinalSelection {
            order: order.to_owned(),
            place: 1,
            reference: None,
        };
        let description = Description {
            selection: Some(selection),
            ..nominal(noun)?.with_quantifier(Quantifier::The)
        };
        Some(description.into())
    };
    let that = |quantifier, noun: &Tree, predicate: String, other: Phrase| -> Option<Phrase> {
        let mut description = nominal(noun)?.with_quantifier(quantifier);
        description.modifiers.push(Modifier {
            negated: false,
            predicate,
            arguments: vec![other],
        });
        Some(description.into())
    };
    match (function, arguments) {
        ("the" | "i_the", [noun]) => of(Quantifier::The, noun),
        ("some" | "i_some" | "i_the_plural", [noun]) => of(Quantifier::Some, noun),
        ("every" | "i_every" | "the_pair_of", [noun]) => of(Quantifier::Every, noun),
        ("the_plural", [noun]) => of(Quantifier::ThePlural, noun),
        ("both" | "i_both", [noun]) => of(Quantifier::All(2), noun),
        ("every_counted" | "i_every_counted", [count, noun]) => {
            of(Quantifier::All(number(count)?), noun)
        }
        ("no", [noun]) => of(Quantifier::No, noun),
        ("exactly_one", [noun]) => of(Quantifier::Exactly(1), noun),
        ("exactly" | "i_exactly", [count, noun]) => of(Quantifier::Exactly(number(count)?), noun),
        ("at_most", [count, noun]) => of(Quantifier::AtMost(number(count)?), noun),
        ("more_than", [count, noun]) => of(sets::more_than(count)?, noun),
        ("fewer_than", [count, noun]) => of(sets::fewer_than(count)?, noun),
        ("another" | "i_another", [noun]) => Some(nominal(noun)?.other().into()),
        ("another_same", []) => {
            let same = Description::new(Quantifier::Some, Noun::SameNoun);
            Some(same.other().into())
        }
        ("nth_with", [place, noun, order, added]) => {
            let noun = Tree::apply("with", [noun.clone(), added.clone()]);
            selected(&noun, order, number(place)?, None)
        }
        // "Stop at the second door": the second nearest.
        ("nth_passage", [place, noun]) => {
            let own = nominal(noun)?;
            is_passage_noun(&own.noun).then_some(())?;
            let selection = OrdinalSelection {
                order: "nearest".to_owned(),
                place: number(place)?,
                reference: None,
            };
            let own = Description {
                selection: Some(selection),
                ..own
            };
            Some(own.with_quantifier(Quantifier::The).into())
        }
        ("nth_at_side", [place, noun, side]) => {
            let side = places::side_from_tree(side)?;
            let selection = OrdinalSelection {
                order: "nearest".to_owned(),
                place: number(place)?,
                reference: None,
            };
            let description = Description {
                selection: Some(selection),
                ..nominal(noun)?.with_modifier(side)
            };
            Some(description.with_quantifier(Quantifier::The).into())
        }
        ("every_piece", [noun]) => places::quantified_piece(Quantifier::Every, noun, None),
        ("every_piece_here", [noun]) => places::every_piece_here(noun),
        ("every_piece_of", [noun, place]) => {
            places::quantified_piece(Quantifier::Every, noun, Some(place))
        }
        ("no_piece_of", [noun, place]) => {
            places::quantified_piece(Quantifier::No, noun, Some(place))
        }
        ("closer_one" | "whichever_closer" | "i_whichever_closer", [noun, reference]) => {
            let reference = Some(phrase(reference)?);
            Some(questions::with_selection(nominal(noun)?, "closest_to", reference).into())
        }
        ("other" | "i_other", [noun]) => {
            let other = nominal(noun)?.with_quantifier(Quantifier::The).other();
            Some(other.into())
        }
        (
            "comparative" | "i_comparative" | "comparative_less" | "i_comparative_less",
            [word, noun],
        ) => {
            let order = questions::superlative_of(&entry_id(word)?, function.ends_with("_less"))?;
            Some(questions::with_selection(nominal(noun)?, order, None).into())
        }
        ("superlative_of", [order, of]) => Some(
            questions::with_selection(sets::set_description(of)?, &entry_id(order)?, None).into(),
        ),
        ("comparative_of" | "comparative_less_of", [word, of]) => {
            let order =
                questions::superlative_of(&entry_id(word)?, function == "comparative_less_of")?;
            Some(questions::with_selection(sets::set_description(of)?, order, None).into())
        }
        ("door_of_thing" | "i_door_of_thing", [whole]) => own_doors::with_door(whole),
        ("pair_of", [noun]) => of(Quantifier::Exactly(2), noun),
        ("nobody", []) => {
            let person = Noun::Object("person".to_owned());
            Some(Description::new(Quantifier::No, person).into())
        }
        ("me" | "i_me", []) => Some(Phrase::Speaker),
        ("at_most_one", [noun]) => of(Quantifier::AtMost(1), noun),
        ("at_least_one", [noun]) => of(Quantifier::AtLeast(1), noun),
        ("at_least" | "i_at_least", [count, noun]) => of(Quantifier::AtLeast(number(count)?), noun),
        ("i_the_that" | "i_the_that_verb", [noun, relation, other]) => {
            that(Quantifier::The, noun, entry_id(relation)?, phrase(other)?)
        }
        ("i_some_that" | "i_some_that_verb", [noun, relation, other]) => {
            that(Quantifier::Some, noun, entry_id(relation)?, phrase(other)?)
        }
        ("i_the_from", [noun, source]) => that(
            Quantifier::The,
            noun,
            "belongs_to".to_owned(),
            phrase(source)?,
        ),
        ("i_some_from", [noun, source]) => that(
            Quantifier::Some,
            noun,
            "belongs_to".to_owned(),
            phrase(source)?,
        ),
        ("its" | "i_its", [noun]) => that(
            Quantifier::The,
            noun,
            "belongs_to".to_owned(),
            Phrase::Pronoun,
        ),
        ("its_plural", [noun]) => that(
            Quantifier::Every,
            noun,
            "belongs_to".to_owned(),
            Phrase::Pronoun,
        ),
        ("i_its_plural", [noun]) => that(
            Quantifier::Some,
            noun,
            "belongs_to".to_owned(),
            Phrase::Pronoun,
        ),
        ("genitive" | "i_genitive", [whole, noun]) => that(
            Quantifier::The,
            noun,
            "belongs_to".to_owned(),
            nominal(whole)?.with_quantifier(Quantifier::The).into(),
        ),
        ("i_the_that_place", [noun, place]) => {
            let (predicate, place) = place_of(place)?;
            that(Quantifier::The, noun, predicate, place)
        }
        ("i_some_that_place", [noun, place]) => {
            let (predicate, place) = place_of(place)?;
            that(Quantifier::Some, noun, predicate, place)
        }
        ("nth" | "i_nth", [place, noun, order])
        | ("nth_superlative" | "i_nth_superlative", [place, order, noun]) => {
            selected(noun, order, number(place)?, None)
        }
        ("superlative" | "i_superlative", [order, noun]) => selected(noun, order, 1, None),
        ("i_superlative_of" | "i_superlative_of_modified", [order, noun, whole]) => {
            let part = nominal(noun)?.with_modifier(Modifier::new("belongs_to", [phrase(whole)?]));
            Some(questions::with_selection(part, &entry_id(order)?, None).into())
        }
        ("selected_to" | "i_selected_to" | "selected_apposed", [noun, order, reference]) => {
            selected(noun, order, 1, Some(phrase(reference)?))
        }
        ("by_id" | "i_by_id", [own]) => Some(Phrase::Id(number(own)?)),
        ("you" | "i_you", []) => Some(Phrase::Listener),
        ("it" | "i_it", []) => Some(Phrase::Pronoun),
        (
            "structure_np" | "structures" | "i_structure" | "piece_np" | "pieces" | "i_piece_np",
            [noun],
        ) => places::structure(noun, None),
        ("structure_at" | "i_structure_at", [noun, side])
        | ("structure_flank" | "i_structure_flank", [side, noun]) => {
            places::structure(noun, Some(places::side_from_tree(side)?))
        }
        ("piece_with" | "i_piece_with", [noun, added]) => {
            // What hangs on a wall is not carried by it.
            let added = modifier(added)?;
            (added.predicate != "supports").then_some(())?;
            places::structure(noun, Some(added))
        }
        (
            "structure_of" | "i_structure_of" | "piece_of" | "i_piece_of" | "pieces_of"
            | "structures_of",
            [noun, place],
        ) => places::structure(noun, Some(Modifier::new("in_room", [room(place)?]))),
        ("structure_in" | "i_structure_in", [place, noun]) => {
            let room = Description::new(Quantifier::The, Noun::Room(entry_id(place)?));
            places::structure(noun, Some(Modifier::new("in_room", [room.into()])))
        }
        ("some_same" | "one_same", []) => Some(anaphoric_phrase(Quantifier::Some, function)),
        ("other_same" | "i_other_same", []) => {
            let same = Description::new(Quantifier::The, Noun::SameNoun);
            Some(same.other().into())
        }
        ("every_same" | "i_every_same", []) => Some(anaphoric_phrase(Quantifier::Every, function)),
        ("both_same" | "i_both_same", []) => Some(anaphoric_phrase(Quantifier::All(2), function)),
        ("no_same", []) => Some(anaphoric_phrase(Quantifier::No, function)),
        ("structure_flank_of" | "i_structure_flank_of", [side, noun, place]) => {
            let wall = places::structure(noun, Some(places::side_from_tree(side)?))?;
            match wall {
                Phrase::Described(own) => {
                    let there = Modifier::new("in_room", [room(place)?]);
                    Some(own.with_modifier(there).into())
                }
                _ => None,
            }
        }
        // "The other one" is one other, "the other two" are two.
        ("others", [count]) if number(count) == Some(1) => {
            let same = Description::new(Quantifier::The, Noun::SameNoun);
            Some(same.other().into())
        }
        ("others", [count]) => {
            let others = Description::new(Quantifier::Exactly(number(count)?), Noun::SameNoun);
            Some(others.into())
        }
        ("all_others", []) => {
            let same = Description::new(Quantifier::Every, Noun::SameNoun);
            Some(same.other().into())
        }
        ("one_colored", [color]) => {
            let mut own = Description::new(Quantifier::Some, Noun::SameNoun);
            own.colors.push(entry_id(color)?);
            Some(own.into())
        }
        ("only_one_same", []) => Some(anaphoric_phrase(Quantifier::Exactly(1), function)),
        ("exactly_same", [count]) => Some(anaphoric_phrase(
            Quantifier::Exactly(number(count)?),
            function,
        )),
        ("np_nothing" | "np_something", [inner]) => indefinite_pronoun(inner).map(Phrase::from),
        (
            "at_least_two" | "i_at_least_two" | "bare_plural" | "i_bare_plural" | "more_than_one",
            [noun],
        )
        | ("gathering_of", [_, noun]) => of(Quantifier::AtLeast(2), noun),
        ("whichever" | "i_whichever", [noun, said]) => {
            let own = verb_phrases::with_predications(nominal(noun)?, said)?;
            Some(own.with_quantifier(Quantifier::The).into())
        }
        ("whatever" | "i_whatever", [said]) => {
            let any =
                Description::new(Quantifier::Every, Noun::Object(Noun::ANY_OBJECT.to_owned()));
            Some(verb_phrases::with_predications(any, said)?.into())
        }
        ("whatever_selected" | "i_whatever_selected", [order, reference]) => {
            let any = Description::new(Quantifier::Some, Noun::Object(Noun::ANY_OBJECT.to_owned()));
            let reference = Some(phrase(reference)?);
            Some(questions::with_selection(any, &entry_id(order)?, reference).into())
        }
        ("i_something", []) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            Some(Description::new(Quantifier::Some, noun).into())
        }
        ("i_something_quality", [quality]) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            let mut own = Description::new(Quantifier::Some, noun);
            verb_phrases::add_quality(&mut own, quality_of(quality)?)?;
            Some(own.into())
        }
        ("nth_left" | "i_nth_left", [noun]) => first_in(noun, "from_left"),
        ("nth_right" | "i_nth_right", [noun]) => first_in(noun, "from_right"),
        ("i_with", [noun, added]) => {
            let noun = nominal(noun)?.with_quantifier(Quantifier::The);
            Some(noun.with_modifier(modifier(added)?).into())
        }
        ("i_some_with", [noun, added]) => {
            Some(nominal(noun)?.with_modifier(modifier(added)?).into())
        }
        ("i_with_relative", [noun, added]) => {
            let noun = nominal(noun)?.with_quantifier(Quantifier::The);
            Some(verb_phrases::with_relative_clause(noun, added)?.into())
        }
        ("i_some_with_relative", [noun, added]) => {
            Some(verb_phrases::with_relative_clause(nominal(noun)?, added)?.into())
        }
        _ => sets::partitive_phrase(function.strip_prefix("i_").unwrap_or(function), arguments),
    }
}

/// What several things are compared with: "the color of the curtains" is that of each.
pub(super) fn each_of(tree: &Tree) -> Option<Phrase> {
    match (parts(tree)?.0, phrase(tree)?) {
        ("i_the_plural" | "the_plural", Phrase::Described(own)) => {
            Some(own.with_quantifier(Quantifier::ThePlural).into())
        }
        (_, other) => Some(other),
    }
}

/// Things that were named before: "one" by their noun, "one of them" by all that was said of them.
fn anaphoric_phrase(quantifier: Quantifier, function: &str) -> Phrase {
    let noun = match function {
        "some_same" => Noun::SameNoun,
        _ => Noun::SameThings,
    };
    Description::new(quantifier, noun).into()
}

fn indefinite_pronoun(tree: &Tree) -> Option<Description> {
    match parts(tree)? {
        ("nothing", []) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            Some(Description::new(Quantifier::No, noun))
        }
        ("something", []) => {
            let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
            Some(Description::new(Quantifier::Some, noun))
        }
        ("nothing_inside" | "something_inside", [inner]) => {
            let inside = Modifier::new("in", [Phrase::Pronoun]);
            Some(indefinite_pronoun(inner)?.with_modifier(inside))
        }
        ("nothing_with" | "something_with", [inner, added]) => {
            Some(indefinite_pronoun(inner)?.with_modifier(modifier(added)?))
        }
        ("nothing_with_relative" | "something_with_relative", [inner, added]) => {
            verb_phrases::with_relative_clause(indefinite_pronoun(inner)?, added)
        }
        ("nothing_quality" | "something_quality", [inner, quality]) => {
            let mut description = indefinite_pronoun(inner)?;
            verb_phrases::add_quality(&mut description, quality_of(quality)?)?;
            Some(description)
        }
        _ => None,
    }
}

/// The landmarks of "between two chairs": one and another.
pub(super) fn between_two(noun: &Tree) -> Option<[Phrase; 2]> {
    let one: Phrase = nominal(noun)?.into();
    Some([one.clone(), one])
}

/// Returns whether a noun names doors and archways, which lead from room to room.
fn is_passage_noun(noun: &Noun) -> bool {
    let ways = ["door", "arch", "archway", "doorway", "gate", "thing"];
    match noun {
        Noun::Object(noun) => ways.iter().any(|way| noun.ends_with(way)),
        Noun::SameNoun => true,
        _ => false,
    }
}

fn is_picture(noun: &Noun) -> bool {
    let shows = [
        "picture",
        "painting",
        "photo",
        "photograph",
        "poster",
        "drawing",
    ];
    matches!(noun, Noun::Object(noun) if shows.iter().any(|shown| noun.ends_with(shown)))
}

/// The description of a noun with its adjectives and modifiers; the caller sets its quantifier.
pub(super) fn nominal(tree: &Tree) -> Option<Description> {
    let (function, arguments) = parts(tree)?;
    let plain = |noun: String| Description::new(Quantifier::Some, Noun::Object(noun));
    Some(match (function, arguments) {
        ("plain", [inner]) => nominal(inner)?,
        // "Do not touch the lamp, it is on" has no lamp that it is on.
        ("with_after_comma", [_, added]) if parts(added)?.0 == "modifier_stranded" => return None,
        ("with" | "with_after_comma" | "but_not", [noun, added]) => {
            let mut description = nominal(noun)?;
            let is_of = parts(added)?.0 == "modifier_of";
            let mut added = modifier(added)?;
            // "Every book except the yellow one": a book.
            if added.predicate == Modifier::IDENTICAL
                && let [Phrase::Described(other)] = &mut added.arguments[..]
                && other.noun == Noun::SameNoun
            {
                other.noun.clone_from(&description.noun);
            }
            if added.predicate.starts_with("leads_") && !is_passage_noun(&description.noun) {
                return None;
            }
            // What a picture shows is not its own, and "at the end of the bed" is no place in a room.
            let ends = |last: &Modifier| last.predicate == "at_end_of";
            if is_of
                && (is_picture(&description.noun) || description.modifiers.last().is_some_and(ends))
            {
                return None;
            }
            description.modifiers.push(Modifier {
                negated: added.negated != (function == "but_not"),
                ..added
            });
            description
        }
        ("with_relative", [noun, added]) => {
            verb_phrases::with_relative_clause(nominal(noun)?, added)?
        }
        ("with_material", [noun, word]) => {
            let mut description = nominal(noun)?;
            verb_phrases::add_quality(&mut description, Quality::Material(entry_id(word)?))?;
            description
        }
        ("way_between", [noun, one, other]) => {
            let way = nominal(noun)?;
            is_passage_noun(&way.noun).then_some(())?;
            let to = |place: &Tree| Some(Modifier::new("leads_to", [room(place)?]));
            way.with_modifier(to(one)?).with_modifier(to(other)?)
        }
        ("with_apposition", [noun, added]) => nominal(noun)?.with_modifier(modifier(added)?),
        ("with_apposed_color", [noun, color]) => {
            let mut description = nominal(noun)?;
            verb_phrases::add_quality(&mut description, Quality::Color(entry_id(color)?))?;
            description
        }
        ("noun" | "tail", [word]) => plain(entry_id(word)?),
        ("front_door", []) => {
            plain("door".to_owned()).with_modifier(Modifier::new("leads_outside", []))
        }
        ("same_noun", []) => Description::new(Quantifier::Some, Noun::SameNoun),
        ("gathered", [head, tail]) => {
            let mut description = nominal(tail)?;
            let Noun::Object(tail) = &description.noun else {
                return None;
            };
            description.noun = Noun::Object(format!("{} of {tail}", entry_id(head)?));
            description
        }
        ("room_compound", [room, noun]) => {
            let (room, noun) = (entry_id(room)?, entry_id(noun)?);
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
            let mut description = nominal(inner)?;
            description.colors.insert(0, entry_id(word)?);
            (description.colors.len() == 1).then_some(description)?
        }
        ("two_colors" | "two_colors_tail", [one, two, inner]) => {
            let mut description = nominal(inner)?;
            if !description.colors.is_empty() {
                return None;
            }
            description.colors = vec![entry_id(one)?, entry_id(two)?];
            description
        }
        ("material" | "material_tail", [word, inner]) => {
            let mut description = nominal(inner)?;
            let before = description.material.replace(entry_id(word)?);
            before.is_none().then_some(description)?
        }
        ("size" | "size_tail", [word, inner]) => {
            let mut description = nominal(inner)?;
            let before = description.size.replace(size(word)?);
            before.is_none().then_some(description)?
        }
        ("state", [word, inner]) => {
            let mut description = nominal(inner)?;
            // "A long striped curtain": one that is striped.
            if let Some(before) = description.state.replace(entry_id(word)?) {
                let also = Modifier::new(&before, []);
                description.modifiers.insert(0, also);
            }
            description
        }
        _ => return None,
    })
}

pub(super) fn modifier(tree: &Tree) -> Option<Modifier> {
    let (predicate, arguments) = match parts(tree)? {
        ("modifier_state", [state]) => (entry_id(state)?, Vec::new()),
        ("modifier_state_not", [state]) => {
            return Some(Modifier {
                negated: true,
                ..Modifier::new(&entry_id(state)?, [])
            });
        }
        ("modifier_carries_list" | "modifier_on_which", [load]) => (
            "supports".to_owned(),
            vec![existence::items_from_tree(load)?],
        ),
        ("modifier_holds_inside_list" | "modifier_in_which", [content]) => (
            "contains".to_owned(),
            vec![existence::items_from_tree(content)?],
        ),
        ("modifier_of_room", [place]) => ("in_room".to_owned(), vec![room(place)?]),
        ("modifier_source" | "modifier_of", [source]) => {
            ("belongs_to".to_owned(), vec![phrase(source)?])
        }
        ("modifier_carries", [load]) => ("supports".to_owned(), vec![phrase(load)?]),
        ("modifier_holds_inside", [content]) => ("contains".to_owned(), vec![phrase(content)?]),
        ("modifier_with", [content]) => ("has".to_owned(), vec![phrase(content)?]),
        ("modifier_other", [of]) => {
            return Some(Modifier {
                negated: true,
                ..Modifier::new(Modifier::IDENTICAL, [phrase(of)?])
            });
        }
        ("modifier_without", [content]) => {
            return Some(Modifier {
                negated: true,
                ..Modifier::new("has", [nominal(content)?.into()])
            });
        }
        ("modifier_around" | "modifier_stranded", [other, relation]) => {
            return converse::modifier(&entry_id(relation)?, phrase(other)?);
        }
        ("modifier_same_color", [other]) => ("same_color".to_owned(), vec![each_of(other)?]),
        ("modifier_same_kind", [other]) => ("same_kind".to_owned(), vec![each_of(other)?]),
        ("modifier_closer", [near, far]) => {
            ("closer_to".to_owned(), vec![phrase(near)?, phrase(far)?])
        }
        ("modifier" | "modifier_verb", [word, other]) => {
            let other = phrase(other)?;
            let thing: Phrase =
                Description::new(Quantifier::Some, Noun::Object(Noun::ANY_OBJECT.to_owned()))
                    .into();
            (
                relation_predicate(entry_id(word)?, &thing, &other),
                vec![other],
            )
        }
        ("modifier_between_two", [both]) => ("between".to_owned(), between_two(both)?.into()),
        ("modifier_from", [word, other]) => (entry_id(word)?, vec![phrase(other)?]),
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

/// The predicate of a relation word between two things: what is on a wall hangs there, and a thing that "holds" another has it.
pub(super) fn relation_predicate(word: String, subject: &Phrase, landmark: &Phrase) -> String {
    let hung = |own: &Description| match &own.noun {
        Noun::Structure(noun) => noun == "wall" || noun == "ceiling",
        _ => false,
    };
    match (word.as_str(), subject, landmark) {
        ("on", _, Phrase::Described(own)) if hung(own) => "hangs_on".to_owned(),
        ("holds", Phrase::Described(_), _) => "has".to_owned(),
        _ => word,
    }
}

pub(super) fn size(tree: &Tree) -> Option<SizeClass> {
    let word = entry_id(tree)?;
    SizeClass::ALL
        .into_iter()
        .find(|size| size.word() == Some(&word))
}
