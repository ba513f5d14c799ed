//! Steps that one clause of a request names together, and steps that follow from another one.

use super::from_tree::{entry_id, parts, room};
use super::phrases::phrase;
use super::places;
use super::requests::{act, put, refrain, step};
use crate::category::categories;
use crate::form::{Form, Modifier, Noun, Phrase, Quantifier, RequestStep, TurnDirection, topic_of};
use crate::grammar::Tree;

/// Steps in one clause: "switch off the lamp and the radio".
pub(super) fn coordinated_steps(tree: &Tree) -> Option<Vec<RequestStep>> {
    Some(match parts(tree)? {
        ("do_rather", [verb, object, other]) => {
            let verb = entry_id(verb)?;
            let done = act(&verb, object)?;
            let mut refrained = refrain(&verb, other)?;
            inherit_side_landmark(&done, &mut refrained);
            vec![done, refrained]
        }
        ("do_two", [verb, one, other]) => {
            let verb = entry_id(verb)?;
            vec![act(&verb, one)?, act(&verb, other)?]
        }
        ("put_both", [object, one, first, other, second]) => {
            // "Put a book on the bed, next to the towel" is one book.
            if matches!(phrase(object)?, Phrase::Described(own) if own.quantifier == Quantifier::Some)
            {
                return None;
            }
            vec![put(object, one, first)?, put(object, other, second)?]
        }
        ("put_on_beside", [object, one, place, other, neighbour]) => {
            let stands_there = can_be_picked_up(&phrase(neighbour)?);
            (stands_there && !can_be_picked_up(&phrase(place)?)).then_some(())?;
            vec![put(object, one, place)?, put(object, other, neighbour)?]
        }
        ("put_both_structure", [object, one, structure, other, second])
        | ("put_by_floor", [_, object, one, structure, other, second]) => {
            let floor = RequestStep::Put {
                object: phrase(object)?,
                predicate: entry_id(one)?,
                to: places::structure(structure, None)?,
            };
            vec![floor, put(object, other, second)?]
        }
        ("put_two", [one, first, to, other, second, there]) => {
            vec![put(one, first, to)?, put(other, second, there)?]
        }
        ("without_touching", [first, object]) => {
            vec![step(first)?, refrain("touch", object)?]
        }
        ("go_along", [along, to]) => {
            vec![RequestStep::GoTo(room(along)?), act("approach", to)?]
        }
        ("go_along_room", [along, to]) => {
            vec![
                RequestStep::GoTo(room(along)?),
                RequestStep::GoTo(room(to)?),
            ]
        }
        // What is said of the way there.
        ("but_around", [to, around]) => vec![act("go_around", around)?, step(to)?],
        ("go_around_to", [around, to]) => {
            vec![act("go_around", around)?, act("approach", to)?]
        }
        ("past_and_through", [past, through]) => {
            vec![act("go_past", past)?, act("go_through", through)?]
        }
        ("through_and_past", [through, past]) => {
            vec![act("go_through", through)?, act("go_past", past)?]
        }
        ("without_dropping", [first, object]) => {
            vec![step(first)?, refrain("drop", object)?]
        }
        ("along_and_past", [along, past]) => {
            vec![RequestStep::GoTo(room(along)?), act("go_past", past)?]
        }
        ("touching_nothing_of", [object, then]) => {
            vec![step(then)?, refrain("touch", object)?]
        }
        ("passing", [then, past]) => {
            // "Passing the bench on its right" tells the side.
            let passed = act("go_past", past)?;
            let form = Form::Request(vec![passed.clone()]);
            form.is_free_of_anaphora()
                .then_some(vec![passed, step(then)?])?
        }
        ("go_past_to_room", [past, to]) => {
            vec![act("go_past", past)?, RequestStep::GoTo(room(to)?)]
        }
        ("go_past_to", [past, to]) => vec![act("go_past", past)?, act("approach", to)?],
        ("go_through_to", [through, to]) => {
            vec![act("go_through", through)?, act("approach", to)?]
        }
        ("go_through", [to, way]) => {
            vec![act("go_through", way)?, RequestStep::GoTo(room(to)?)]
        }
        ("turn_left_into", [to]) => {
            vec![
                RequestStep::Turn(TurnDirection::Left),
                RequestStep::GoTo(room(to)?),
            ]
        }
        ("turn_right_into", [to]) => {
            vec![
                RequestStep::Turn(TurnDirection::Right),
                RequestStep::GoTo(room(to)?),
            ]
        }
        _ => return None,
    })
}

/// Returns whether a phrase names something small enough to be carried, by the table of categories: it stands on what does not.
fn can_be_picked_up(phrase: &Phrase) -> bool {
    /// What people carry in one hand, kg.
    const LARGEST_MASS_KG: f32 = 3.0;
    let Phrase::Described(own) = phrase else {
        return false;
    };
    let Noun::Object(noun) = &own.noun else {
        return false;
    };
    let mut rows = categories().rows().iter();
    let named = rows.find(|row| row.singular == noun || row.synonyms.contains(&noun.as_str()));
    named.is_some_and(|row| row.movable && row.mass_kg <= LARGEST_MASS_KG)
}

/// "The cabinet on the right of the window, not the one on the left": of the window, too.
fn inherit_side_landmark(done: &RequestStep, refrained: &mut RequestStep) {
    let (
        RequestStep::Do {
            object: Phrase::Described(named),
            ..
        },
        RequestStep::DoNot {
            object: Phrase::Described(other),
            ..
        },
    ) = (done, refrained)
    else {
        return;
    };
    let mut sides = named.modifiers.iter();
    let Some(side) = sides.find(|side| ["left_of", "right_of"].contains(&&*side.predicate)) else {
        return;
    };
    for modifier in &mut other.modifiers {
        let of = match modifier.predicate.as_str() {
            "on_left" => "left_of",
            "on_right" => "right_of",
            _ => continue,
        };
        *modifier = Modifier::new(of, side.arguments.clone());
    }
}

/// The step of waiting where a step leads.
pub(super) fn wait_after(step: &RequestStep) -> Option<RequestStep> {
    match step {
        RequestStep::GoTo(room) => Some(RequestStep::Put {
            object: Phrase::Listener,
            predicate: "in_room".to_owned(),
            to: room.clone(),
        }),
        RequestStep::Put {
            object: Phrase::Listener,
            ..
        } => Some(step.clone()),
        RequestStep::Do { verb, object } if verb == "approach" => Some(RequestStep::Do {
            verb: "stop_at".to_owned(),
            object: object.clone(),
        }),
        _ => None,
    }
}

/// Steps before one that the sentence names first: "before you lift the vase, look under it", the vase.
pub(super) fn before_step(mut steps: Vec<RequestStep>, last: RequestStep) -> Vec<RequestStep> {
    if let (Some(first), Some(named)) = (steps.first_mut(), topic_of(&last)) {
        let it = Form::Request(vec![first.clone()]).with_phrase(&Phrase::Pronoun, named);
        if let Form::Request(mut only) = it
            && let Some(only) = only.pop()
        {
            *first = only;
        }
    }
    steps.push(last);
    steps
}
