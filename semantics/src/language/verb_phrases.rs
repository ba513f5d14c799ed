//! What is said of a subject: "is red", "stands next to the door but is not open".

use super::from_tree::{atomic_clause, entry_id, parts, place_of, quality_of, subjects};
use super::phrases::{between_two, each_of, nominal, phrase, relation_predicate};
use super::{places, questions};
use crate::form::{Clause, Description, Modifier, Noun, Phrase, Quality, Quantifier};
use crate::grammar::Tree;
use crate::size::SizeClass;

/// One thing that is said of a subject.
#[derive(Clone)]
pub(super) enum Predication {
    /// A relation, or a place.
    Relation(Modifier),
    /// A relation of another thing to the subject: "smaller than the table" of a table that is larger.
    Converse(String, Phrase),
    /// A quality.
    Quality(Quality),
    /// One to the left and one to the right of a landmark.
    BothSides(Phrase),
    /// A relation of each of several to another of them.
    EachOther(String),
    /// A relation of one of several to another of them: "one above the other".
    OneTheOther(String),
    /// Being the only thing that a description fits.
    Only(Description),
}

/// What is said, each with whether it is denied.
pub(super) type PredicationList = Vec<(Predication, bool)>;

fn relation(predicate: &str, arguments: impl Into<Vec<Phrase>>) -> PredicationList {
    affirmed(Predication::Relation(Modifier::new(predicate, arguments)))
}

fn affirmed(said: Predication) -> PredicationList {
    vec![(said, false)]
}

/// The reading of a verb phrase; `None` for other trees.
pub(super) fn predications(tree: &Tree) -> Option<PredicationList> {
    Some(match parts(tree)? {
        ("vp_relation", [word, object]) => {
            let object = phrase(object)?;
            relation(
                &relation_predicate(entry_id(word)?, &any_thing(), &object),
                [object],
            )
        }
        ("vp_relation_list", [word, items]) => {
            let items = subjects(items)?;
            // "Two coats hang on the wall, one red and one brown": those are no landmarks.
            let Phrase::List(all) = &items else {
                return None;
            };
            let stands_for = |item: &Phrase| matches!(item, Phrase::Described(own) if own.noun == Noun::SameNoun);
            if all.iter().any(stands_for) {
                return None;
            }
            relation(&entry_id(word)?, [items])
        }
        ("vp_between", [a, b]) => relation("between", [phrase(a)?, phrase(b)?]),
        ("vp_between_two", [both]) => relation("between", between_two(both)?),
        ("vp_closer", [near, far]) => relation("closer_to", [phrase(near)?, phrase(far)?]),
        ("vp_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            relation(&predicate, [place])
        }
        ("vp_mount", [mount]) => relation("hangs_on", [places::mount_from_tree(mount)?]),
        ("vp_side", [side]) => affirmed(Predication::Relation(places::side_from_tree(side)?)),
        ("vp_passage", [passage]) => {
            affirmed(Predication::Relation(places::passage_from_tree(passage)?))
        }
        ("vp_side_corner", [side]) if parts(side)?.0 != "flank_ahead" => {
            let mut all = relation("in_corner_of", [places::any_room()]);
            all.extend(affirmed(Predication::Relation(places::side_from_tree(
                side,
            )?)));
            all
        }
        ("vp_converse", [word, object]) => {
            affirmed(Predication::Converse(entry_id(word)?, phrase(object)?))
        }
        ("vp_not_as", [quality, object]) => {
            let relation = comparative_of(&quality_of(quality)?)?;
            affirmed(Predication::Converse(relation.to_owned(), phrase(object)?))
        }
        // "As tall as the plant" is at least as tall: the plant is not taller.
        ("vp_as", [quality, object]) => {
            let relation = comparative_of(&quality_of(quality)?)?;
            let taller = Predication::Converse(relation.to_owned(), phrase(object)?);
            vec![(taller, true)]
        }
        ("vp_superlative", [order, noun]) => {
            let selected = questions::with_selection(nominal(noun)?, &entry_id(order)?, None);
            relation("identical", [selected.into()])
        }
        ("vp_selected_to", [noun, order, reference]) => {
            let reference = Some(phrase(reference)?);
            let selected = questions::with_selection(nominal(noun)?, &entry_id(order)?, reference);
            relation("identical", [selected.into()])
        }
        ("vp_any_other" | "vp_less_any_other", [word, noun]) => {
            let order = questions::superlative_of(&entry_id(word)?, is_less_than_any_other(tree))?;
            let selected = questions::with_selection(nominal(noun)?, order, None);
            relation("identical", [selected.into()])
        }
        ("vp_is_a", [noun]) => relation("identical", [nominal(noun)?.into()]),
        ("vp_both_sides", [landmark]) => affirmed(Predication::BothSides(phrase(landmark)?)),
        ("vp_one_the_other", [word]) => affirmed(Predication::OneTheOther(entry_id(word)?)),
        ("vp_only", [noun]) => affirmed(Predication::Only(nominal(noun)?)),
        ("vp_same_color", [other]) => relation("same_color", [each_of(other)?]),
        ("vp_same_material", [other]) => relation("same_material", [each_of(other)?]),
        ("vp_side_by_side", []) => affirmed(Predication::EachOther("next_to".to_owned())),
        ("vp_each_other", [word]) => affirmed(Predication::EachOther(entry_id(word)?)),
        ("vp_color_material", [color, material]) | ("vp_material_color", [material, color]) => {
            vec![
                (
                    Predication::Quality(Quality::Color(entry_id(color)?)),
                    false,
                ),
                (
                    Predication::Quality(Quality::Material(entry_id(material)?)),
                    false,
                ),
            ]
        }
        ("vp_quality", [quality]) => affirmed(Predication::Quality(quality_of(quality)?)),
        ("vp_standing", [posture, inner]) => {
            let mut all = predications(inner)?;
            // "Standing on" does not say that something is switched on, and nothing "stands" being a chair.
            let is_no_place = |said: &Predication| match said {
                Predication::Quality(_) => true,
                Predication::Relation(modifier) => modifier.predicate == Modifier::IDENTICAL,
                _ => false,
            };
            if all.iter().any(|(said, _)| is_no_place(said)) {
                return None;
            }
            if hangs(posture) {
                use_hangs_on(&mut all);
            }
            all
        }
        ("vps_and_hang", [first, mount]) => {
            let mut all = predications(first)?;
            all.extend(relation("hangs_on", [phrase(mount)?]));
            all
        }
        ("vps_and_same_color", [first, other]) => {
            let mut all = predications(first)?;
            all.extend(relation("same_color", [each_of(other)?]));
            all
        }
        ("vps_single" | "vps_several", [inner]) => predications(inner)?,
        ("vps_pair" | "vps_beside", [first, last]) => {
            let mut all = predications(first)?;
            match parts(last)? {
                ("vps_one", [one]) => all.extend(predications(one)?),
                ("vps_not", [one]) => all.extend(negate_single(predications(one)?)?),
                _ => all.extend(predications(last)?),
            }
            // "Black on top" is not what is black and switched on.
            if parts(tree)?.0 == "vps_beside"
                && all.iter().skip(1).any(|(said, _)| is_switching(said))
            {
                return None;
            }
            // "Visible in the mirror" is not what is visible and in the mirror.
            let is = |at: usize, found: fn(&Predication) -> bool| {
                all.get(at).is_some_and(|(said, _)| found(said))
            };
            if is(
                0,
                |said| matches!(said, Predication::Quality(Quality::State(state)) if state == "visible"),
            ) && is(
                1,
                |said| matches!(said, Predication::Relation(place) if place.predicate == "in"),
            ) {
                return None;
            }
            all
        }
        ("vps_more", [first, rest]) => {
            let mut all = predications(first)?;
            all.extend(predications(rest)?);
            all
        }
        _ => return None,
    })
}

/// "Not as tall as the plant": the plant is taller.
fn comparative_of(quality: &Quality) -> Option<&'static str> {
    match quality {
        Quality::State(state) if state == "tall" => Some("taller_than"),
        Quality::State(state) if state == "wide" => Some("wider_than"),
        Quality::Size(SizeClass::Large) => Some("larger_than"),
        _ => None,
    }
}

fn is_switching(said: &Predication) -> bool {
    matches!(
        said,
        Predication::Quality(Quality::State(state)) if state.starts_with("switched_")
    )
}

fn hangs(posture: &Tree) -> bool {
    parts(posture).is_some_and(|(function, _)| function.starts_with("hang"))
}

/// What hangs "on" a thing is mounted on it; what hangs elsewhere is mounted on something.
fn use_hangs_on(all: &mut PredicationList) {
    let mut is_mounted = false;
    for (said, _) in all.iter_mut() {
        if let Predication::Relation(modifier) = said {
            if modifier.predicate == "on" {
                "hangs_on".clone_into(&mut modifier.predicate);
            }
            is_mounted |= modifier.predicate == "hangs_on";
        }
    }
    if !is_mounted {
        let hanging = Predication::Quality(Quality::State("hanging".to_owned()));
        all.insert(0, (hanging, false));
    }
}

fn is_less_than_any_other(tree: &Tree) -> bool {
    matches!(parts(tree), Some(("vp_less_any_other", _)))
}

fn negate_single(mut all: PredicationList) -> Option<PredicationList> {
    // "Not in the left corner" denies both together, which no list of two denials does.
    let [(_, negated)] = &mut all[..] else {
        return None;
    };
    *negated = !*negated;
    Some(all)
}

fn any_thing() -> Phrase {
    let noun = Noun::Object(Noun::ANY_OBJECT.to_owned());
    Description::new(Quantifier::Some, noun).into()
}

/// The clause that says one thing of `subject`.
fn clause_of(subject: Phrase, (said, negated): (Predication, bool)) -> Option<Clause> {
    // "Neither picture is as wide as the bed": the bed is wider than every picture.
    let (subject, negated) = match (subject, &said) {
        (Phrase::Described(own), Predication::Converse(..))
            if negated && own.quantifier == Quantifier::No =>
        {
            (own.with_quantifier(Quantifier::Every).into(), false)
        }
        (subject, _) => (subject, negated),
    };
    let clause = match said {
        Predication::Relation(modifier) => {
            let mut arguments = vec![subject];
            arguments.extend(modifier.arguments);
            atomic_clause(&modifier.predicate, arguments)
        }
        Predication::Converse(predicate, other) => atomic_clause(&predicate, vec![other, subject]),
        Predication::Quality(quality) => Clause::Is { subject, quality },
        Predication::BothSides(landmark) => {
            let Phrase::Described(own) = &subject else {
                return None;
            };
            let one = own.clone().with_quantifier(Quantifier::Some);
            let side = |name| atomic_clause(name, vec![one.clone().into(), landmark.clone()]);
            Clause::All(vec![side("left_of"), side("right_of")])
        }
        Predication::OneTheOther(predicate) => {
            let Phrase::Described(own) = subject else {
                return None;
            };
            let one: Phrase = own.with_quantifier(Quantifier::Some).into();
            atomic_clause(&predicate, vec![one.clone(), one])
        }
        Predication::Only(only) => Clause::All(vec![
            atomic_clause("identical", vec![subject, only.clone().into()]),
            Clause::Exists(only.with_quantifier(Quantifier::Exactly(1)).into()),
        ]),
        Predication::EachOther(predicate) => match &subject {
            Phrase::List(_) | Phrase::Described(_) => {
                atomic_clause(&predicate, vec![subject, Phrase::EachOther])
            }
            _ => return None,
        },
    };
    Some(if negated {
        Clause::Not(Box::new(clause))
    } else {
        clause
    })
}

/// The clause that says all of a verb phrase of a subject. Of "a lamp" it must be one lamp of which all of it is true: that one exists.
pub(super) fn clause(subject: Phrase, tree: &Tree) -> Option<Clause> {
    let mut all = predications(tree)?;
    if let [_] = all[..] {
        return clause_of(subject, all.remove(0));
    }
    let (mut own, others): (PredicationList, PredicationList) =
        all.into_iter().partition(|(said, _)| is_attributive(said));
    let conjunction = |subject: &Phrase, all: PredicationList| -> Option<Vec<Clause>> {
        let all = all.into_iter();
        all.map(|one| clause_of(subject.clone(), one)).collect()
    };
    let is_indefinite = |own: &Description| {
        !matches!(
            own.quantifier,
            Quantifier::The | Quantifier::Every | Quantifier::ThePlural | Quantifier::All(_)
        )
    };
    match subject {
        // "The floor is wooden and brown": "the floor" means any piece of it, and what is said is no part of its name.
        Phrase::Described(description)
            if is_indefinite(&description) && !matches!(description.noun, Noun::Structure(_)) =>
        {
            let mut description = *description;
            add_predications(&mut description, own)?;
            let subject: Phrase = description.into();
            // "Two chairs are on the balcony side by side": those on the balcony are.
            let mut clauses = conjunction(&subject, others)?;
            Some(match clauses.len() {
                0 => Clause::Exists(subject),
                1 => clauses.remove(0),
                _ => Clause::All(clauses),
            })
        }
        subject => {
            own.extend(others);
            Some(Clause::All(conjunction(&subject, own)?))
        }
    }
}

/// Returns whether it can be said within a description.
fn is_attributive(said: &Predication) -> bool {
    matches!(said, Predication::Relation(_) | Predication::Quality(_))
}

/// Adds to a description what a verb phrase says.
pub(super) fn add_predications(description: &mut Description, all: PredicationList) -> Option<()> {
    let mut predicates: Vec<String> = Vec::new();
    for (said, negated) in all {
        match (said, negated) {
            // "There is bread on the table and on the shelf": not one bread on both.
            (Predication::Relation(modifier), false)
                if predicates.contains(&modifier.predicate) =>
            {
                return None;
            }
            (Predication::Relation(modifier), negated) => {
                predicates.push(modifier.predicate.clone());
                description.modifiers.push(Modifier {
                    negated,
                    ..modifier
                });
            }
            (Predication::Quality(Quality::State(state)), false) if description.state.is_some() => {
                description.modifiers.push(Modifier::new(&state, []));
            }
            (Predication::Quality(quality), false) => add_quality(description, quality)?,
            (Predication::Quality(Quality::State(state)), true) => {
                description.modifiers.push(Modifier {
                    negated: true,
                    ..Modifier::new(&state, [])
                });
            }
            _ => return None,
        }
    }
    Some(())
}

/// The description with what a verb phrase says added.
pub(super) fn with_predications(mut description: Description, tree: &Tree) -> Option<Description> {
    add_predications(&mut description, predications(tree)?)?;
    Some(description)
}

/// The description with what a relative clause says: "that is not on the table", "standing by the door".
pub(super) fn with_relative_clause(
    mut description: Description,
    tree: &Tree,
) -> Option<Description> {
    let all = match parts(tree)? {
        ("relative", [inner]) => predications(inner)?,
        ("relative_not", [inner]) => negate_single(predications(inner)?)?,
        ("relative_stands" | "relative_standing", [posture, inner]) => {
            let mut all = predications(inner)?;
            if hangs(posture) {
                use_hangs_on(&mut all);
            }
            all
        }
        _ => return None,
    };
    add_predications(&mut description, all)?;
    Some(description)
}

/// Adds a quality to a description that does not have one of its kind.
pub(super) fn add_quality(description: &mut Description, quality: Quality) -> Option<()> {
    match quality {
        Quality::Color(word) if description.colors.len() < 2 => description.colors.push(word),
        Quality::Material(word) if description.material.is_none() => {
            description.material = Some(word);
        }
        Quality::Size(size) if description.size.is_none() => description.size = Some(size),
        Quality::State(state) if description.state.is_none() => description.state = Some(state),
        _ => return None,
    }
    Some(())
}
