//! Several things said of one subject: "the cup is red, on the table and not near the door".

use super::from_tree::{holds, id, parts, place_of, quality_of};
use super::phrases::phrase;
use super::places;
use crate::form::{Clause, Description, Modifier, Phrase, Quality, Quantifier};
use crate::grammar::Tree;

/// What is said of a subject.
pub(super) enum Said {
    Relation(Modifier),
    Quality(Quality),
}

pub(super) fn said(tree: &Tree) -> Option<Said> {
    Some(match parts(tree)? {
        ("vp_relation", [word, object]) => {
            Said::Relation(Modifier::new(&id(word)?, [phrase(object)?]))
        }
        ("vp_between", [a, b]) => {
            Said::Relation(Modifier::new("between", [phrase(a)?, phrase(b)?]))
        }
        ("vp_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            Said::Relation(Modifier::new(&predicate, [place]))
        }
        ("vp_mount", [mount]) => {
            let mount = places::mount_from_tree(mount)?;
            Said::Relation(Modifier::new("hangs_on", [mount]))
        }
        ("vp_side", [side]) => Said::Relation(places::side_from_tree(side)?),
        ("vp_quality", [quality]) => Said::Quality(quality_of(quality)?),
        _ => return None,
    })
}

/// What a list says, each with whether it is negated.
pub(super) fn list(tree: &Tree) -> Option<Vec<(Said, bool)>> {
    match parts(tree)? {
        ("vps_pair", [first, last]) => {
            let mut all = vec![(said(first)?, false)];
            all.push(match parts(last)? {
                ("vps_one", [one]) => (said(one)?, false),
                ("vps_not", [one]) => (said(one)?, true),
                _ => return None,
            });
            Some(all)
        }
        ("vps_more", [first, rest]) => {
            let mut all = vec![(said(first)?, false)];
            all.extend(list(rest)?);
            Some(all)
        }
        _ => None,
    }
}

/// The clause that says it of `subject`.
pub(super) fn clause_of(subject: Phrase, (said, negated): (Said, bool)) -> Clause {
    let clause = match said {
        Said::Relation(modifier) => {
            let mut arguments = vec![subject];
            arguments.extend(modifier.arguments);
            holds(&modifier.predicate, arguments)
        }
        Said::Quality(quality) => Clause::Is { subject, quality },
    };
    if negated {
        Clause::Not(Box::new(clause))
    } else {
        clause
    }
}

/// The clause that says all of a list of a subject. Of "a lamp" it must be one lamp of which all of it is true: that one exists.
pub(super) fn clause(subject: Phrase, rest: &Tree) -> Option<Clause> {
    match &subject {
        Phrase::Described(description) if description.quantifier != Quantifier::The => {
            if description.quantifier == Quantifier::Every {
                return Some(conjunction(&subject, list(rest)?));
            }
            existing(subject, rest)
        }
        _ => Some(conjunction(&subject, list(rest)?)),
    }
}

fn conjunction(subject: &Phrase, all: Vec<(Said, bool)>) -> Clause {
    let all = all.into_iter();
    Clause::All(all.map(|one| clause_of(subject.clone(), one)).collect())
}

/// The existence of things of which all of a list is true.
pub(super) fn existing(subject: Phrase, rest: &Tree) -> Option<Clause> {
    let Phrase::Described(description) = subject else {
        return None;
    };
    let mut description: Description = *description;
    for (said, negated) in list(rest)? {
        match (said, negated) {
            (Said::Relation(modifier), negated) => description.modifiers.push(Modifier {
                negated,
                ..modifier
            }),
            (Said::Quality(quality), false) => add_quality(&mut description, quality)?,
            (Said::Quality(Quality::State(state)), true) => description.modifiers.push(Modifier {
                negated: true,
                ..Modifier::new(&state, [])
            }),
            (Said::Quality(_), true) => return None,
        }
    }
    Some(Clause::Exists(description.into()))
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
