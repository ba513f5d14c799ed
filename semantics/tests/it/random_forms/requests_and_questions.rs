//! Random requests, questions and whole sentences.

use super::*;

fn step() -> BoxedStrategy<RequestStep> {
    let verb = || {
        word(&[
            "find",
            "pick_up",
            "open",
            "switch_off",
            "bring_me",
            "stop_at",
        ])
    };
    prop_oneof![
        room().prop_map(RequestStep::GoTo),
        room().prop_map(RequestStep::Leave),
        prop_oneof![
            Just(TurnDirection::Left),
            Just(TurnDirection::Right),
            Just(TurnDirection::Around)
        ]
        .prop_map(RequestStep::Turn),
        (verb(), phrase()).prop_map(|(verb, object)| RequestStep::Do { verb, object }),
        (verb(), phrase()).prop_map(|(verb, object)| RequestStep::DoNot { verb, object }),
        (phrase(), room()).prop_map(|(object, to)| RequestStep::Bring { object, to }),
        (phrase(), phrase()).prop_map(|(object, to)| RequestStep::Bring { object, to }),
        (landmark(), room()).prop_map(|(object, to)| RequestStep::Put {
            object,
            predicate: "in_room".to_owned(),
            to,
        }),
        (landmark(), phrase(), phrase()).prop_map(|(object, one, other)| RequestStep::Put {
            object,
            predicate: "between".to_owned(),
            to: Phrase::List(vec![one, other]),
        }),
        (relation(), reference()).prop_map(|(predicate, to)| RequestStep::Put {
            object: Phrase::Listener,
            predicate,
            to,
        }),
        Just(RequestStep::Do {
            verb: "find".to_owned(),
            object: Phrase::Speaker,
        }),
        (landmark(), word(&["on", "in"]), reference()).prop_map(|(object, predicate, to)| {
            RequestStep::Put {
                object,
                predicate,
                to,
            }
        }),
    ]
    .boxed()
}

pub(crate) fn form() -> BoxedStrategy<Form> {
    prop_oneof![
        4 => simple().prop_map(Form::Claim),
        1 => simple()
            .prop_filter("of lists and comparisons nothing is said to be so now", |clause| {
                !matches!(clause, Clause::All(_) | Clause::Any(_))
            })
            .prop_map(|clause| Form::Claim(Clause::Now(Box::new(clause)))),
        2 => proptest::collection::vec(step(), 1..4)
            .prop_map(Form::Request),
        1 => (
            simple(),
            proptest::collection::vec(step(), 1..3),
            proptest::collection::vec(step(), 0..3),
            proptest::option::of(step()),
        )
            .prop_map(|(condition, then, otherwise, first)| {
                let conditional = RequestStep::If {
                    condition,
                    then,
                    otherwise,
                };
                Form::Request(first.into_iter().chain([conditional]).collect())
            }),
        1 => (adjectives(Quantifier::Some), described()).prop_map(|(more, than)| {
            let than = than.with_quantifier(Quantifier::Some);
            let modifiers = than.modifiers.clone();
            let more = Description { modifiers, ..more };
            Form::Claim(Clause::More { more: Box::new(more), than: Box::new(than) })
        }),
        1 => proptest::collection::vec((phrase(), quality()), 2..4).prop_map(|clauses| {
            let clauses = clauses.into_iter();
            let clauses = clauses.map(|(subject, quality)| Clause::Is { subject, quality });
            Form::Question(Question::Alternatives(clauses.collect()))
        }),
        1 => (proptest::collection::vec(step(), 1..3), simple()).prop_map(|(steps, clause)| {
            Form::Several(vec![Form::Request(steps), Form::Question(Question::Whether(clause))])
        }),
        1 => described().prop_map(|what| {
            let what = what.with_quantifier(Quantifier::Some);
            Form::Question(Question::HowMany(Box::new(what)))
        }),
        1 => (phrase(), quality()).prop_map(|(subject, quality)| {
            Form::Question(Question::Whether(Clause::Is { subject, quality }))
        }),
        1 => proptest::collection::vec(simple(), 2..4)
            .prop_map(|clauses| Form::Claim(Clause::All(clauses))),
        1 => (adjectives(Quantifier::Some), relation(), reference()).prop_map(|(kind, predicate, to)| {
            let arguments = vec![Phrase::Hole, to];
            let clause = Clause::Holds { predicate, arguments };
            let kind = Some(Box::new(kind));
            Form::Question(Question::Which { kind, clause })
        }),
        1 => phrase().prop_map(|of| {
            let kind = AttributeKind::Color;
            Form::Question(Question::Attribute { kind, of })
        }),
        1 => pronominal().prop_map(Form::Claim),
        1 => counted().prop_map(|what| {
            let what = what.with_quantifier(Quantifier::Some);
            Form::Question(Question::HowMany(Box::new(what)))
        }),
        1 => item().prop_map(|what| Form::Question(Question::Whether(Clause::Exists(what)))),
        // "Is a chair between the bed and a lamp on the wall?" is a question with two readings: the subject has no modifiers.
        1 => (quantifier().prop_flat_map(adjectives), mount()).prop_map(|(subject, mount)| {
            let predicate = "hangs_on".to_owned();
            let arguments = vec![subject.into(), mount];
            Form::Question(Question::Whether(Clause::Holds { predicate, arguments }))
        }),
        3 => prop_oneof![
            6 => phrase(),
            1 => nothing().prop_map(Phrase::from),
            2 => room(),
        ]
        .prop_map(Form::NounPhrase),
    ]
    .boxed()
}
