//! Requests: forms to trees, and trees to forms.

use super::from_tree::{entry_id, parts, place_of, possibly_negated_clause, room, subjects};
use super::lexicon::{RELATION, VERB};
use super::phrases::{between_two, phrase};
use super::places;
use super::step_groups::{before_step, coordinated_steps, wait_after};
use super::to_tree::{PhrasePosition, TreeBuilder};
use crate::form::{
    Clause, Description, Form, Modifier, Noun, Phrase, Quantifier, RequestStep, TurnDirection,
    topic_of,
};
use crate::grammar::Tree;

pub(super) fn plan(tree: &Tree) -> Option<Vec<RequestStep>> {
    Some(match parts(tree)? {
        ("one_step", [only]) => vec![step(only)?],
        ("unless", [condition, then]) => {
            let not = Clause::Not(Box::new(possibly_negated_clause(condition)?));
            vec![conditional(not, plan_or_step(then)?, Vec::new())]
        }
        ("step_unless", [condition, then]) => {
            let then = plan_or_step(then)?;
            let condition = about_the_step(possibly_negated_clause(condition)?, &then);
            vec![conditional(
                Clause::Not(Box::new(condition)),
                then,
                Vec::new(),
            )]
        }
        ("if", [condition, then]) => {
            vec![conditional(
                possibly_negated_clause(condition)?,
                plan_or_step(then)?,
                Vec::new(),
            )]
        }
        ("step_if", [condition, then]) => {
            let mut condition = possibly_negated_clause(condition)?;
            let then = plan_or_step(then)?;
            one_of_the_step(&mut condition, &then);
            condition = about_the_step(condition, &then);
            vec![conditional(condition, then, Vec::new())]
        }
        ("if_else", [condition, then, otherwise]) => {
            vec![conditional(
                possibly_negated_clause(condition)?,
                plan(then)?,
                plan(otherwise)?,
            )]
        }
        // "If the door is closed, open it, otherwise come to me", as people put it.
        ("step_if_else", [then, condition, otherwise]) => {
            vec![conditional(
                possibly_negated_clause(condition)?,
                vec![step(then)?],
                plan(otherwise)?,
            )]
        }
        ("then" | "steps" | "last_steps", [first, rest]) => {
            let mut rest = plan(rest)?;
            if !merge_fetch_step(first, &mut rest)? {
                rest.insert(0, step(first)?);
            }
            rest
        }
        ("plan_to_wait", [steps]) => {
            let mut steps = plan(steps)?;
            let there = steps.iter().rev().find_map(wait_after)?;
            if steps.last() != Some(&there) {
                steps.push(there);
            }
            steps
        }
        // Of the way, not of its end.
        ("plan_but_around", [steps, around]) => {
            let mut steps = plan(steps)?;
            steps.insert(0, act("go_around", around)?);
            steps
        }
        ("on_leaving", [last]) => {
            let here = Description::new(Quantifier::The, Noun::Room(Noun::ANY_ROOM.to_owned()));
            vec![RequestStep::Leave(here.into()), step(last)?]
        }
        ("on_leaving_room", [last, from]) => {
            vec![RequestStep::Leave(room(from)?), step(last)?]
        }
        ("on_reaching_room", [place, rest]) => {
            let mut steps = plan(rest)?;
            steps.insert(0, RequestStep::GoTo(room(place)?));
            steps
        }
        ("on_reaching", [thing, rest]) => {
            let mut steps = plan(rest)?;
            steps.insert(0, act("approach", thing)?);
            steps
        }
        ("step_on_reaching_room", [last, place]) => {
            vec![RequestStep::GoTo(room(place)?), step(last)?]
        }
        ("step_on_reaching_room_then", [then, place, rest]) => {
            let mut steps = vec![RequestStep::GoTo(room(place)?), step(then)?];
            steps.extend(plan(rest)?);
            steps
        }
        ("before_doing", [last, before]) => before_step(plan(before)?, step(last)?),
        ("after_done" | "after_doing", [done, rest]) => {
            let mut steps = vec![done_step(done)?];
            steps.extend(plan(rest)?);
            steps
        }
        ("step_after_done" | "step_after_doing", [last, done]) => {
            vec![done_step(done)?, step(last)?]
        }
        ("step_before_doing", [first, done]) => vec![step(first)?, done_step(done)?],
        ("before_doing_it", [done, before]) => before_step(plan(before)?, done_step(done)?),
        ("group", [only]) => coordinated_steps(only)?,
        ("group_then", [first, rest]) => {
            let mut steps = coordinated_steps(first)?;
            steps.extend(plan(rest)?);
            steps
        }
        _ => return None,
    })
}

/// "Bring me the jacket if there is one": a jacket.
fn one_of_the_step(condition: &mut Clause, then: &[RequestStep]) {
    let Clause::Exists(Phrase::Described(one)) = condition else {
        return;
    };
    let Some(
        RequestStep::Do { object, .. }
        | RequestStep::Put { object, .. }
        | RequestStep::Bring { object, .. },
    ) = then.first()
    else {
        return;
    };
    if let Phrase::Described(object) = object
        && **one == Description::new(Quantifier::Some, Noun::SameNoun)
    {
        **one = Description::clone(object).with_quantifier(Quantifier::Some);
    }
}

/// "Switch off the tap if it is on": the tap.
fn about_the_step(condition: Clause, then: &[RequestStep]) -> Clause {
    let Some(topic) = then.first().and_then(topic_of) else {
        return condition;
    };
    let starts_with_it = match &condition {
        Clause::Holds { arguments, .. } => arguments.first() == Some(&Phrase::Pronoun),
        Clause::Is { subject, .. } => *subject == Phrase::Pronoun,
        Clause::Not(inner) => matches!(
            &**inner,
            Clause::Is {
                subject: Phrase::Pronoun,
                ..
            }
        ),
        _ => false,
    };
    if !starts_with_it {
        return condition;
    }
    match Form::Claim(condition.clone()).with_phrase(&Phrase::Pronoun, topic) {
        Form::Claim(clause) => clause,
        _ => condition,
    }
}

/// The step that "once you have opened the door" and "after opening the door" speak of.
fn done_step(tree: &Tree) -> Option<RequestStep> {
    match parts(tree)? {
        (function, [object]) => {
            let (_, verb) = function.split_once('_')?;
            act(verb, object)
        }
        _ => None,
    }
}

/// Puts what is fetched, or any thing that is picked up, in place of "it" in the step after it, which says where it goes: "Fetch
/// the cup and put it on the table", "Take one of the cups and bring it to me". Returns whether it did.
fn merge_fetch_step(tree: &Tree, rest: &mut [RequestStep]) -> Option<bool> {
    let fetched = match step(tree)? {
        RequestStep::Do { verb, object } => {
            let is_any =
                matches!(&object, Phrase::Described(own) if own.quantifier == Quantifier::Some);
            let takes = parts(tree)?.0 == "do_fetch" || verb == "pick_up" && is_any;
            takes.then_some(object)
        }
        _ => None,
    };
    Some(match (fetched, rest.first_mut()) {
        (
            Some(fetched),
            Some(RequestStep::Put { object, .. } | RequestStep::Bring { object, .. }),
        ) if *object == Phrase::Pronoun => {
            *object = fetched;
            true
        }
        (Some(fetched), Some(RequestStep::Do { verb, object }))
            if verb == "bring_me" && *object == Phrase::Pronoun =>
        {
            *object = fetched;
            true
        }
        _ => false,
    })
}

pub(super) fn act(verb: &str, object: &Tree) -> Option<RequestStep> {
    Some(RequestStep::Do {
        verb: verb.to_owned(),
        object: phrase(object)?,
    })
}

/// "Look in the cupboard for a cup": what is acted on, with where it is.
fn act_on_modified(verb: &str, object: &Tree, added: Modifier) -> Option<RequestStep> {
    let Phrase::Described(object) = phrase(object)? else {
        return None;
    };
    Some(RequestStep::Do {
        verb: verb.to_owned(),
        object: object.with_modifier(added).into(),
    })
}

pub(super) fn refrain(verb: &str, object: &Tree) -> Option<RequestStep> {
    let object = match (parts(object)?.0, phrase(object)?) {
        // "Do not touch the chairs" denies touching any, "every chair" only touching all.
        ("the_plural" | "every_same", Phrase::Described(own)) => {
            own.with_quantifier(Quantifier::Some).into()
        }
        (_, object) => object,
    };
    Some(RequestStep::DoNot {
        verb: verb.to_owned(),
        object,
    })
}

pub(super) fn put(object: &Tree, relation: &Tree, to: &Tree) -> Option<RequestStep> {
    Some(RequestStep::Put {
        object: put_object(object)?,
        predicate: entry_id(relation)?,
        to: phrase(to)?,
    })
}

/// What is put somewhere: "the plates" are all that are meant, where a landmark is any of them.
fn put_object(tree: &Tree) -> Option<Phrase> {
    match (parts(tree)?.0, phrase(tree)?) {
        ("i_the_plural", Phrase::Described(own)) => {
            Some(own.with_quantifier(Quantifier::ThePlural).into())
        }
        (_, other) => Some(other),
    }
}

fn conditional(
    condition: Clause,
    then: Vec<RequestStep>,
    otherwise: Vec<RequestStep>,
) -> RequestStep {
    RequestStep::If {
        condition,
        then,
        otherwise,
    }
}

fn plan_or_step(tree: &Tree) -> Option<Vec<RequestStep>> {
    plan(tree).or_else(|| Some(vec![step(tree)?]))
}

pub(super) fn step(tree: &Tree) -> Option<RequestStep> {
    Some(match parts(tree)? {
        ("go_to", [to]) => RequestStep::GoTo(room(to)?),
        ("leave_room", [from]) => RequestStep::Leave(room(from)?),
        ("turn_left", []) => RequestStep::Turn(TurnDirection::Left),
        ("turn_right", []) => RequestStep::Turn(TurnDirection::Right),
        ("turn_around", []) => RequestStep::Turn(TurnDirection::Around),
        ("do_from_room", [verb, object, from]) => {
            let in_room = Modifier::new("in_room", [room(from)?]);
            act_on_modified(&entry_id(verb)?, object, in_room)?
        }
        ("look_in_for", [relation, place, object]) => act_on_modified(
            "find",
            object,
            Modifier::new(&entry_id(relation)?, [phrase(place)?]),
        )?,
        ("look_inside_for", [object]) => {
            act_on_modified("find", object, Modifier::new("in", [Phrase::Pronoun]))?
        }
        ("take_out", [object]) => {
            let source = Modifier::new("belongs_to", [Phrase::Pronoun]);
            act_on_modified("pick_up", object, source)?
        }
        ("leave", [object]) => refrain("pick_up", object)?,
        ("do_close_behind", [object]) => act("close", object)?,
        ("do_open_wide", [object]) => act("open", object)?,
        ("put_near", [object, to]) => RequestStep::Put {
            object: phrase(object)?,
            predicate: "near".to_owned(),
            to: phrase(to)?,
        },
        ("turn_toward", [object, to]) => RequestStep::Put {
            object: phrase(object)?,
            predicate: "facing".to_owned(),
            to: phrase(to)?,
        },
        ("leave_any_room", []) => {
            let room = Noun::Room(Noun::ANY_ROOM.to_owned());
            RequestStep::Leave(Description::new(Quantifier::The, room).into())
        }
        ("make_state", [object, state]) => {
            let verb = match entry_id(state)?.as_str() {
                "open" => "open",
                "closed" => "close",
                "switched_on" => "switch_on",
                "switched_off" => "switch_off",
                _ => return None,
            };
            act(verb, object)?
        }
        ("leave_state", [object, state]) => {
            let verb = match entry_id(state)?.as_str() {
                "open" | "half_open" => "close",
                "closed" => "open",
                "switched_on" => "switch_off",
                "switched_off" => "switch_on",
                _ => return None,
            };
            refrain(verb, object)?
        }
        ("put_by", [_, object, relation, to]) | ("leave_at", [object, relation, to]) => {
            put(object, relation, to)?
        }
        ("stand_in_place" | "stand_in_destination", [place]) => {
            let (predicate, to) = place_of(place)?;
            RequestStep::Put {
                object: Phrase::Listener,
                predicate,
                to,
            }
        }
        ("stand_between_two", [both]) => RequestStep::Put {
            object: Phrase::Listener,
            predicate: "between".to_owned(),
            to: Phrase::List(between_two(both)?.into()),
        },
        ("put_by_between_two", [_, object, both]) => RequestStep::Put {
            object: phrase(object)?,
            predicate: "between".to_owned(),
            to: Phrase::List(between_two(both)?.into()),
        },
        ("stand_between", [one, other]) => RequestStep::Put {
            object: Phrase::Listener,
            predicate: "between".to_owned(),
            to: Phrase::List(vec![phrase(one)?, phrase(other)?]),
        },
        ("put_between" | "put_by_between", [.., object, one, other]) => RequestStep::Put {
            object: phrase(object)?,
            predicate: "between".to_owned(),
            to: Phrase::List(vec![phrase(one)?, phrase(other)?]),
        },
        ("put_list", [_, items, relation, to]) => RequestStep::Put {
            object: subjects(items)?,
            predicate: entry_id(relation)?,
            to: phrase(to)?,
        },
        ("put_list_in_place", [_, items, place]) => {
            let (predicate, to) = place_of(place)?;
            RequestStep::Put {
                object: subjects(items)?,
                predicate,
                to,
            }
        }
        ("bring_list", [items, to]) => RequestStep::Bring {
            object: subjects(items)?,
            to: phrase(to)?,
        },
        ("bring_list_to_place", [items, to]) => RequestStep::Bring {
            object: subjects(items)?,
            to: room(to)?,
        },
        ("carry_out", [object, from]) => {
            let Phrase::Described(object) = phrase(object)? else {
                return None;
            };
            let from = room(from)?;
            let elsewhere =
                Description::new(Quantifier::Some, Noun::Room(Noun::ANY_ROOM.to_owned()));
            RequestStep::Bring {
                object: object
                    .with_modifier(Modifier::new("in_room", [from.clone()]))
                    .into(),
                to: elsewhere
                    .with_modifier(Modifier {
                        negated: true,
                        ..Modifier::new(Modifier::IDENTICAL, [from])
                    })
                    .into(),
            }
        }
        ("stand_at", [relation, landmark]) => {
            let to = phrase(landmark)?;
            // "Stand by the lamp with the window on your right" tells how to stand, not which lamp.
            let tells_side = |pair: &[Modifier]| {
                pair[0].predicate == "has" && places::side_of(&pair[1].predicate).is_some()
            };
            if matches!(&to, Phrase::Described(own) if own.modifiers.windows(2).any(tells_side)) {
                return None;
            }
            RequestStep::Put {
                object: Phrase::Listener,
                predicate: entry_id(relation)?,
                to,
            }
        }
        ("come", []) => RequestStep::Do {
            verb: "approach".to_owned(),
            object: Phrase::Speaker,
        },
        ("do_on", [object]) => act("switch_on", object)?,
        ("go_alongside", [object]) => act("go_past", object)?,
        ("do_not_on", [object]) => refrain("switch_on", object)?,
        ("do_not_off", [object]) => refrain("switch_off", object)?,
        ("do_off", [object]) => act("switch_off", object)?,
        ("do_pick_up", [object]) => act("pick_up", object)?,
        ("do_drop", [object]) => act("drop", object)?,
        ("do_bring_here" | "do_bring_me" | "do_fetch", [object]) => act("bring_me", object)?,
        ("do", [verb, object]) => act(&entry_id(verb)?, object)?,
        ("do_not", [verb, object]) => refrain(&entry_id(verb)?, object)?,
        ("put" | "put_down" | "put_modified", [object, relation, to]) => put(object, relation, to)?,
        (
            "put_in_place" | "put_modified_in_place" | "put_in_destination" | "leave_in_place",
            [object, place],
        )
        | ("put_by_place", [_, object, place]) => {
            let (predicate, to) = place_of(place)?;
            RequestStep::Put {
                object: put_object(object)?,
                predicate,
                to,
            }
        }
        ("bring", [object, to]) => match phrase(to)? {
            Phrase::Speaker => act("bring_me", object)?,
            to => RequestStep::Bring {
                object: phrase(object)?,
                to,
            },
        },
        ("bring_to_place", [object, to]) => RequestStep::Bring {
            object: phrase(object)?,
            to: room(to)?,
        },
        _ => return None,
    })
}

/// Returns whether steps are a route: they walk and turn alone, and leave a room or stop at a thing.
fn is_route(steps: &[RequestStep]) -> bool {
    let stops = |step: &RequestStep| {
        matches!(step, RequestStep::Leave(_))
            || matches!(step, RequestStep::Do { verb, .. } if verb == "stop_at")
    };
    let walks = |step: &RequestStep| match step {
        RequestStep::GoTo(_) | RequestStep::Leave(_) | RequestStep::Turn(_) => true,
        RequestStep::Do { verb, .. } => ["go_through", "go_past", "stop_at"].contains(&&**verb),
        _ => false,
    };
    steps.iter().any(stops) && steps.iter().all(walks)
}

impl TreeBuilder<'_> {
    pub(super) fn plan(&self, steps: &[RequestStep]) -> Option<Tree> {
        Some(match steps {
            [] => return None,
            [
                RequestStep::If {
                    condition,
                    then,
                    otherwise,
                },
            ] => {
                let condition = self.simple_clause(condition)?;
                // A condition within another one would be taken for the next step.
                let nested = |step: &RequestStep| matches!(step, RequestStep::If { .. });
                if then.iter().chain(otherwise).any(nested) {
                    return None;
                }
                match &otherwise[..] {
                    [] => Tree::apply("if", [condition, self.plan(then)?]),
                    otherwise => Tree::apply(
                        "if_else",
                        [condition, self.plan(then)?, self.plan(otherwise)?],
                    ),
                }
            }
            [only] => Tree::apply("one_step", [self.step(only)?]),
            steps if is_route(steps) => self.route(steps)?,
            [first, rest @ ..] => Tree::apply("then", [self.step(first)?, self.plan(rest)?]),
        })
    }

    /// The steps of a route, one after the other with commas, and the last after "and".
    fn route(&self, steps: &[RequestStep]) -> Option<Tree> {
        let (last, before) = steps.split_last()?;
        let mut plan = Tree::apply("one_step", [self.step(last)?]);
        let mut function = "last_steps";
        for step in before.iter().rev() {
            plan = Tree::apply(function, [self.step(step)?, plan]);
            function = "steps";
        }
        Some(plan)
    }

    fn step(&self, step: &RequestStep) -> Option<Tree> {
        let free = |phrase: &Phrase| self.phrase(phrase, PhrasePosition::Free);
        Some(match step {
            RequestStep::GoTo(room) => Tree::apply("go_to", [self.room(room)?]),
            RequestStep::Leave(room) => Tree::apply("leave_room", [self.room(room)?]),
            RequestStep::Turn(direction) => {
                let function = match direction {
                    TurnDirection::Left => "turn_left",
                    TurnDirection::Right => "turn_right",
                    TurnDirection::Around => "turn_around",
                };
                Tree::apply(function, [])
            }
            RequestStep::Do { verb, object } => {
                Tree::apply("do", [self.lexicon_entry(VERB, verb)?, free(object)?])
            }
            RequestStep::DoNot { verb, object } => {
                Tree::apply("do_not", [self.lexicon_entry(VERB, verb)?, free(object)?])
            }
            RequestStep::Put {
                object,
                predicate,
                to,
            } => {
                if let (Phrase::Listener, "between", Phrase::List(landmarks)) =
                    (object, predicate.as_str(), to)
                {
                    let [one, other] = &landmarks[..] else {
                        return None;
                    };
                    return Some(Tree::apply("stand_between", [free(one)?, free(other)?]));
                }
                if *object == Phrase::Listener && predicate == "in_room" {
                    return Some(Tree::apply("stand_in_place", [self.place(to)?]));
                }
                if *object == Phrase::Listener
                    && let Some(spot) = self.place_in_room(predicate, to)
                {
                    return Some(Tree::apply("stand_in_place", [spot]));
                }
                if *object == Phrase::Listener {
                    let relation = self.lexicon_entry(RELATION, predicate)?;
                    return Some(Tree::apply("stand_at", [relation, free(to)?]));
                }
                let object = match object {
                    Phrase::Described(own)
                        if own.quantifier == Quantifier::ThePlural && own.modifiers.is_empty() =>
                    {
                        Tree::apply("i_the_plural", [self.noun_with_adjectives(own)?])
                    }
                    other => self.phrase(other, PhrasePosition::Landmark)?,
                };
                if let ("between", Phrase::List(landmarks)) = (predicate.as_str(), to) {
                    let [one, other] = &landmarks[..] else {
                        return None;
                    };
                    Tree::apply("put_between", [object, free(one)?, free(other)?])
                } else if predicate == "in_room" {
                    Tree::apply("put_in_place", [object, self.place(to)?])
                } else if let Some(spot) = self.place_in_room(predicate, to) {
                    Tree::apply("put_in_place", [object, spot])
                } else {
                    let relation = self.lexicon_entry(RELATION, predicate)?;
                    Tree::apply("put", [object, relation, free(to)?])
                }
            }
            // A condition has commas of its own: it stands alone or at the end.
            RequestStep::If { .. } => return None,
            RequestStep::Bring { object, to } => match self.room(to) {
                Some(room) => Tree::apply("bring_to_place", [free(object)?, room]),
                None => Tree::apply("bring", [free(object)?, free(to)?]),
            },
        })
    }
}
