//! What phrases and steps name, for the search of antecedents.

use super::{Clause, Description, Modifier, Noun, Phrase, Quality, Quantifier, RequestStep};
use crate::category::categories;

/// A subject of indefinite number with what its clause says of it, which "they" then stands for: "three cups are on the table".
pub(super) fn subject_with_predicate(clause: &Clause) -> Option<Description> {
    let subject = match clause {
        Clause::Holds { arguments, .. } => arguments.first()?,
        Clause::Is { subject, .. } => subject,
        _ => return None,
    };
    let Phrase::Described(subject) = subject else {
        return None;
    };
    let is_indefinite = matches!(
        subject.quantifier,
        Quantifier::Some | Quantifier::Exactly(_) | Quantifier::AtLeast(_)
    );
    is_indefinite.then_some(())?;
    let mut subject = Description::clone(subject);
    match clause {
        Clause::Holds {
            predicate,
            arguments,
        } => subject
            .modifiers
            .push(Modifier::new(predicate, arguments.get(1..)?)),
        Clause::Is {
            quality: Quality::Color(word),
            ..
        } => subject.colors.push(word.clone()),
        Clause::Is {
            quality: Quality::State(state),
            ..
        } => subject.state = Some(state.clone()),
        _ => return None,
    }
    Some(subject)
}

/// Several things that a clause says another one has, with where they are: the doors of "the wardrobe has three doors".
pub(super) fn object_with_predicate(clause: &Clause) -> Option<(Phrase, Description)> {
    let Clause::Holds {
        predicate,
        arguments,
    } = clause
    else {
        return None;
    };
    let converse = match predicate.as_str() {
        "has" => "belongs_to",
        "supports" => "on",
        "contains" => "in",
        _ => return None,
    };
    let [holder, object @ Phrase::Described(own)] = &arguments[..] else {
        return None;
    };
    if may_be_one(object) {
        return None;
    }
    let own = Description::clone(own).with_modifier(Modifier::new(converse, [holder.clone()]));
    Some((object.clone(), own))
}

/// A subject of indefinite number with what its clause denies of it: "a lamp is not on".
pub(super) fn subject_without_predicate(clause: &Clause) -> Option<Description> {
    let subject = match clause {
        Clause::Holds { arguments, .. } => arguments.first()?,
        Clause::Is { subject, .. } => subject,
        _ => return None,
    };
    let denied = match clause {
        Clause::Holds {
            predicate,
            arguments,
        } => Modifier::new(predicate, arguments.get(1..)?),
        Clause::Is {
            quality: Quality::State(state),
            ..
        } => Modifier::new(state, []),
        _ => return None,
    };
    match subject {
        Phrase::Described(own) if is_indefinite_singular(own) => {
            Some(Description::clone(own).with_modifier(Modifier {
                negated: true,
                ..denied
            }))
        }
        _ => None,
    }
}

/// Returns whether a description is of any room: that of "in the corner".
pub(super) fn is_any_room(own: &Description) -> bool {
    let any = Noun::Room(Noun::ANY_ROOM.to_owned());
    *own == Description::new(Quantifier::Some, any)
}

/// The thing that a step is about.
pub(crate) fn topic_of(step: &RequestStep) -> Option<&Phrase> {
    match step {
        RequestStep::GoTo(_) | RequestStep::Leave(_) | RequestStep::Turn(_) => None,
        RequestStep::Do { object, .. }
        | RequestStep::DoNot { object, .. }
        | RequestStep::Put { object, .. }
        | RequestStep::Bring { object, .. } => Some(object),
        RequestStep::If { then, .. } => topic_of(then.first()?),
    }
}

/// Verbs and states of things alone, never of rooms or pieces of the building.
const ACTED_ON: [&str; 13] = [
    "open",
    "close",
    "closed",
    "half_open",
    "switch_on",
    "switch_off",
    "switched_on",
    "switched_off",
    "pick_up",
    "drop",
    "bring_me",
    "empty",
    "full",
];

/// Returns whether things of a noun are acted on by a verb, as far as the table of categories knows.
pub(super) fn meets_selectional_restriction(verb: &str, phrase: &Phrase) -> bool {
    let Phrase::Described(own) = phrase else {
        return true;
    };
    let Noun::Object(noun) = &own.noun else {
        // "The wall behind the bed is white, and it is not striped": the wall, which is neither opened nor carried.
        return !ACTED_ON.contains(&verb);
    };
    let mut rows = categories().rows().iter();
    let named = rows.find(|row| row.singular == noun || row.synonyms.contains(&noun.as_str()));
    named.is_none_or(|row| match verb {
        "open" | "close" | "closed" | "half_open" => row.openable,
        "switch_on" | "switch_off" | "switched_on" | "switched_off" => row.switchable,
        "pick_up" | "drop" | "bring_me" => row.movable,
        "empty" | "full" => row.contains || row.supports,
        _ => true,
    })
}

pub(super) fn is_singular(phrase: &Phrase) -> bool {
    match phrase {
        Phrase::Described(description) => description.quantifier == Quantifier::The,
        Phrase::Id(_) => true,
        _ => false,
    }
}

/// Returns whether "it" may stand for a phrase: no phrase of several things.
pub(super) fn may_be_one(phrase: &Phrase) -> bool {
    match phrase {
        Phrase::Described(own) => own.quantifier == Quantifier::The || is_indefinite_singular(own),
        _ => true,
    }
}

/// "There is exactly one bottle in the hall, and it is green": the bottle.
pub(super) fn exactly_one_as_definite(phrase: Phrase) -> Phrase {
    match phrase {
        Phrase::Described(own) if own.quantifier == Quantifier::Exactly(1) => {
            own.with_quantifier(Quantifier::The).into()
        }
        other => other,
    }
}

pub(super) fn is_indefinite_singular(own: &Description) -> bool {
    matches!(own.quantifier, Quantifier::Some | Quantifier::Exactly(1))
}
