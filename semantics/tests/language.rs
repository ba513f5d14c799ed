//! Forms become text and come back as they were, in English and in a language of another word order.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_scene::random::RandomKey;
use dwell_semantics::SizeClass;
use dwell_semantics::form::{
    AttributeKind, Clause, Description, Form, Modifier, Noun, Phrase, PlaceInOrder, Quality,
    Quantifier, Question, Request, RequestStep,
};
use dwell_semantics::grammar::{Grammar, Lexicon};
use dwell_semantics::language::Language;
use proptest::prelude::*;

fn word(words: &'static [&'static str]) -> BoxedStrategy<String> {
    proptest::sample::select(words)
        .prop_map(str::to_owned)
        .boxed()
}

fn noun() -> BoxedStrategy<Noun> {
    let words = &[
        "chair",
        "bed",
        "coffee table",
        "TV stand",
        "lamp",
        "stack of books",
        "pair of shoes",
        "sofa",
    ];
    word(words).prop_map(Noun::Object).boxed()
}

fn adjectives(quantifier: Quantifier) -> BoxedStrategy<Description> {
    let colors = &["red", "blue", "gray", "orange"];
    let sizes = [
        SizeClass::Tiny,
        SizeClass::Small,
        SizeClass::Large,
        SizeClass::Huge,
    ];
    (
        noun(),
        proptest::option::of(proptest::sample::select(sizes.to_vec())),
        proptest::option::of(word(&[
            "open",
            "closed",
            "switched_on",
            "switched_off",
            "empty",
        ])),
        proptest::collection::vec(word(colors), 0..3),
        proptest::option::of(word(&["wooden", "leather", "steel"])),
    )
        .prop_map(move |(noun, size, state, colors, material)| Description {
            size,
            state,
            colors,
            material,
            ..Description::new(quantifier, noun)
        })
        .boxed()
}

fn relation() -> BoxedStrategy<String> {
    word(&[
        "on", "in", "next_to", "left_of", "behind", "under", "facing",
    ])
    .boxed()
}

fn landmark() -> BoxedStrategy<Phrase> {
    let plain =
        || prop_oneof![Just(Quantifier::The), Just(Quantifier::Some)].prop_flat_map(adjectives);
    let of = |mut outer: Description, predicate: String, inner: Phrase| {
        outer.modifiers.push(Modifier {
            negated: false,
            predicate,
            arguments: vec![inner],
        });
        outer
    };
    let to_thing = (plain(), relation(), plain());
    let by_verb = (plain(), word(&["contains", "holds"]), plain());
    let nested = prop_oneof![
        to_thing.prop_map(move |(outer, name, inner)| of(outer, name, inner.into())),
        by_verb.prop_map(move |(outer, name, inner)| of(outer, name, inner.into())),
        (plain(), room()).prop_map(move |(outer, inner)| of(outer, "in_room".to_owned(), inner)),
    ];
    prop_oneof![
        4 => plain().prop_map(Phrase::from),
        1 => nested.prop_map(Phrase::from),
        1 => (2..40_u32).prop_flat_map(|n| adjectives(Quantifier::Exactly(n))).prop_map(Phrase::from),
        1 => (1..400_u32).prop_map(Phrase::Id),
        1 => Just(Phrase::Listener),
    ].boxed()
}

fn room() -> BoxedStrategy<Phrase> {
    let noun = word(&["kitchen", "bedroom", "living room", "balcony", "hall"]);
    let kinds = (0..6_u8, noun, 1..15_u32, adjectives(Quantifier::Some));
    kinds
        .prop_map(|(kind, noun, place, thing)| {
            let plain = |quantifier| Description::new(quantifier, Noun::Room(noun.clone()));
            let description = match kind {
                0 => plain(Quantifier::Some),
                1 => plain(Quantifier::Every),
                2 => Description {
                    selection: Some(PlaceInOrder {
                        order: "house".to_owned(),
                        place,
                        reference: None,
                    }),
                    ..plain(Quantifier::The)
                },
                3 => Description {
                    modifiers: vec![Modifier {
                        negated: false,
                        predicate: "contains".to_owned(),
                        arguments: vec![thing.into()],
                    }],
                    ..plain(Quantifier::The)
                },
                _ => plain(Quantifier::The),
            };
            description.into()
        })
        .boxed()
}

fn modifier() -> BoxedStrategy<Modifier> {
    let made = |predicate: String, arguments| Modifier {
        negated: false,
        predicate,
        arguments,
    };
    prop_oneof![
        (relation(), landmark()).prop_map(move |(name, to)| made(name, vec![to])),
        room().prop_map(move |room| made("in_room".to_owned(), vec![room])),
        (1..20_u32).prop_map(move |n| made("on_storey".to_owned(), vec![Phrase::Storey(n)])),
        (landmark(), landmark()).prop_map(move |(a, b)| made("between".to_owned(), vec![a, b])),
    ]
    .boxed()
}

fn quantifier() -> BoxedStrategy<Quantifier> {
    prop_oneof![
        Just(Quantifier::Some),
        Just(Quantifier::The),
        Just(Quantifier::Every),
        Just(Quantifier::No),
        (1..30_u32).prop_map(Quantifier::Exactly),
        (1..30_u32).prop_map(Quantifier::AtLeast),
    ]
    .boxed()
}

fn described() -> BoxedStrategy<Description> {
    (
        quantifier().prop_flat_map(adjectives),
        proptest::collection::vec(modifier(), 0..2),
    )
        .prop_map(|(description, modifiers)| Description {
            modifiers,
            ..description
        })
        .boxed()
}

fn selected() -> BoxedStrategy<Phrase> {
    let order = word(&[
        "from_left",
        "from_right",
        "largest",
        "nearest",
        "closest_to",
    ]);
    (adjectives(Quantifier::The), order, 1..20_u32, landmark())
        .prop_map(|(description, order, place, reference)| {
            let counted = order.starts_with("from");
            let reference = (order == "closest_to").then(|| Box::new(reference));
            let selection = PlaceInOrder {
                order,
                place: if counted { place } else { 1 },
                reference,
            };
            Description {
                selection: Some(selection),
                ..description
            }
            .into()
        })
        .boxed()
}

fn phrase() -> BoxedStrategy<Phrase> {
    prop_oneof![
        6 => described().prop_map(Phrase::from),
        1 => selected(),
        1 => (1..400_u32).prop_map(Phrase::Id),
        1 => Just(Phrase::Listener),
    ]
    .boxed()
}

fn quality() -> BoxedStrategy<Quality> {
    prop_oneof![
        word(&["red", "green"]).prop_map(Quality::Color),
        word(&["wooden", "leather"]).prop_map(Quality::Material),
        Just(Quality::Size(SizeClass::Small)),
        word(&["open", "switched_off"]).prop_map(Quality::State),
    ]
    .boxed()
}

fn affirmed() -> BoxedStrategy<Clause> {
    let holds = |predicate: String, arguments| Clause::Holds {
        predicate,
        arguments,
    };
    prop_oneof![
        (phrase(), relation(), phrase()).prop_map(move |(a, name, b)| holds(name, vec![a, b])),
        (phrase(), word(&["supports", "same_color"]), phrase())
            .prop_map(move |(a, name, b)| holds(name, vec![a, b])),
        (phrase(), room()).prop_map(move |(a, b)| holds("in_room".to_owned(), vec![a, b])),
        (phrase(), phrase(), phrase())
            .prop_map(move |(a, b, c)| holds("between".to_owned(), vec![a, b, c])),
        (phrase(), quality()).prop_map(|(subject, quality)| Clause::Is { subject, quality }),
        described().prop_map(|what| Clause::Exists(what.into())),
    ]
    .boxed()
}

fn simple() -> BoxedStrategy<Clause> {
    prop_oneof![
        3 => affirmed(),
        1 => affirmed().prop_map(|clause| Clause::Not(Box::new(clause))),
    ]
    .boxed()
}

fn step() -> BoxedStrategy<RequestStep> {
    let verb = || word(&["find", "pick_up", "open", "switch_off", "bring_me"]);
    prop_oneof![
        room().prop_map(RequestStep::GoTo),
        (verb(), phrase()).prop_map(|(verb, object)| RequestStep::Do { verb, object }),
        (verb(), phrase()).prop_map(|(verb, object)| RequestStep::DoNot { verb, object }),
        (phrase(), room()).prop_map(|(object, to)| RequestStep::Bring { object, to }),
        (phrase(), phrase()).prop_map(|(object, to)| RequestStep::Bring { object, to }),
        (landmark(), room()).prop_map(|(object, to)| RequestStep::Put {
            object,
            predicate: "in_room".to_owned(),
            to,
        }),
        (landmark(), word(&["on", "in"]), phrase()).prop_map(|(object, predicate, to)| {
            RequestStep::Put {
                object,
                predicate,
                to,
            }
        }),
    ]
    .boxed()
}

fn form() -> BoxedStrategy<Form> {
    prop_oneof![
        4 => simple().prop_map(Form::Claim),
        2 => proptest::collection::vec(step(), 1..4)
            .prop_map(|steps| Form::Request(Request::Sequence(steps))),
        1 => (simple(), step()).prop_map(|(clause, step)| Form::Request(Request::If(clause, step))),
        1 => described().prop_map(|what| {
            let what = what.with_quantifier(Quantifier::Some);
            Form::Question(Question::HowMany(Box::new(what)))
        }),
        1 => (phrase(), quality()).prop_map(|(subject, quality)| {
            Form::Question(Question::Whether(Clause::Is { subject, quality }))
        }),
        1 => proptest::collection::vec(simple(), 2..4)
            .prop_map(|clauses| Form::Claim(Clause::All(clauses))),
        1 => (adjectives(Quantifier::Some), relation(), phrase()).prop_map(|(kind, predicate, to)| {
            let arguments = vec![Phrase::Hole, to];
            let clause = Clause::Holds { predicate, arguments };
            let kind = Some(Box::new(kind));
            Form::Question(Question::Which { kind, clause })
        }),
        1 => phrase().prop_map(|of| {
            let kind = AttributeKind::Color;
            Form::Question(Question::Attribute { kind, of })
        }),
    ]
    .boxed()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    /// Whatever is said, in any wording, has the form among its readings; in the first wording it is the preferred one.
    #[test]
    fn what_is_said_is_read_as_it_was_meant(form in form(), seed in any::<u64>()) {
        let english = Language::english();
        let said = english.say(&form, None);
        prop_assert!(said.is_some(), "no words for {form:?}");
        let said = said.unwrap();
        let reading = english.read(&said.text);
        prop_assume!(!matches!(reading, Err(dwell_semantics::language::ReadError::TooLong { .. })));
        let reading = reading.map_err(|error| TestCaseError::fail(format!("{}: {error}", said.text)))?;
        prop_assert_eq!(&reading.forms[0], &form, "{}", said.text);
        for span in &said.phrases {
            prop_assert!(said.text.get(span.start..span.end).is_some_and(|part| !part.is_empty()));
        }
        let other = english.say(&form, Some(RandomKey::root(seed))).unwrap();
        let reading = english.read(&other.text);
        prop_assume!(!matches!(reading, Err(dwell_semantics::language::ReadError::TooLong { .. })));
        prop_assert!(reading.is_ok_and(|reading| reading.forms.contains(&form)), "{}", other.text);
    }

    /// No text makes the reader fail otherwise than by a sentence.
    #[test]
    fn any_text_is_read_or_refused(text in "(the |a |red |chair |on |is |, |left of |two |[a-z]{1,4} |\\PC){0,70}") {
        if let Err(error) = Language::english().read(&text) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}

/// Another noun table, another word order (the verb last), no articles: language is data.
#[test]
fn another_language_is_another_file() {
    let grammar = r#"
start = ["text"]
[[rule]]
function = "claim"
result = "text"
arguments = ["clause"]
texts = ["{1} ."]
[[rule]]
function = "one_clause"
result = "clause"
arguments = ["simple"]
texts = ["{1}"]
[[rule]]
function = "holds"
result = "simple"
arguments = ["np", "relation", "np"]
texts = ["{1} {3} {2} est"]
[[rule]]
function = "the"
result = "np"
arguments = ["cn"]
texts = ["{1}"]
[[rule]]
function = "plain"
result = "cn"
arguments = ["ac"]
texts = ["{1}"]
[[rule]]
function = "noun"
result = "ac"
arguments = ["noun"]
texts = ["{1}"]
[[rule]]
function = "color"
result = "ac"
arguments = ["color", "ac"]
texts = ["{2} {1}"]
"#;
    let mut lexicon = Lexicon::default();
    lexicon.add_texts("noun", "chair", &[&["sella"]]);
    lexicon.add_texts("noun", "bed", &[&["lectus"]]);
    lexicon.add_texts("color", "red", &[&["rubra"]]);
    lexicon.add_texts("relation", "next_to", &[&["iuxta"]]);
    let latin = Language::from_grammar(Grammar::new(grammar, lexicon).unwrap());
    let english = Language::english();
    let form = english
        .read("The red chair is next to the bed.")
        .unwrap()
        .forms
        .remove(0);
    let said = latin.say(&form, None).unwrap();
    assert_eq!(said.text, "Sella rubra lectus iuxta est.");
    assert_eq!(latin.read(&said.text).unwrap().forms, [form]);
    let other = english.read("There is a chair.").unwrap().forms.remove(0);
    assert_eq!(latin.say(&other, None), None);
}
