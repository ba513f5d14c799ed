//! Clauses against scenes: what was counted by hand, what was swapped, what cannot be asked.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_houses::open;
use dwell_scene::material::library;
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{House, MaterialId, ObjectId, State};
use dwell_semantics::check::{Addressee, CheckResult, Checker, QuestionAnswer};
use dwell_semantics::color::ColorVocabulary;
use dwell_semantics::form::{Clause, Form, Phrase, Question};
use dwell_semantics::language::Language;
use dwell_semantics::{SemanticScene, Semantics, Term, Truth, UndecidedReason, Viewer};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

fn house(name: &str) -> Arc<House> {
    Arc::new(open(name).unwrap().0)
}

fn clause(text: &str) -> Clause {
    match Language::english()
        .read(text)
        .unwrap_or_else(|error| panic!("{text}: {error}"))
        .forms
        .remove(0)
    {
        Form::Claim(clause) => clause,
        other => panic!("{text}: {other:?}"),
    }
}

fn question(text: &str) -> Question {
    match Language::english().read(text).unwrap().forms.remove(0) {
        Form::Question(question) => question,
        other => panic!("{text}: {other:?}"),
    }
}

fn check(scene: &SemanticScene<'_>, text: &str) -> CheckResult {
    Checker::new(scene, Addressee::default()).check(&clause(text))
}

/// Things that may be called by each noun, counted one by one.
fn called(scene: &SemanticScene<'_>) -> BTreeMap<String, Vec<ObjectId>> {
    let objects = || scene.house().objects.ids();
    let nouns: BTreeSet<String> = objects().map(|id| scene.facts(id).noun.clone()).collect();
    let known = nouns.into_iter().filter(|noun| {
        Language::english()
            .read(&format!("There is a {noun}."))
            .is_ok()
    });
    known
        .map(|noun| {
            let own = objects().filter(|id| scene.facts(*id).is_called(&noun));
            let own = own.collect();
            (noun, own)
        })
        .collect()
}

#[test]
fn quantifiers_agree_with_counting() {
    for name in ["builtin:studio", "builtin:apartment", "seed:7"] {
        let house = house(name);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        for (noun, things) in called(&scene) {
            let own = things.iter().find(|id| scene.facts(**id).noun == noun);
            let facts = scene.facts(*own.unwrap());
            if facts.noun.contains(" of ") {
                continue;
            }
            let (one, several) = (noun.as_str(), facts.plural.as_str());
            let red = things.iter().filter(|id| {
                scene
                    .facts(**id)
                    .colors
                    .iter()
                    .any(|(word, _)| *word == "red")
            });
            let (all, red) = (things.len(), red.count());
            // Glass has no colour, so that nobody can say how many are red.
            let clear = things
                .iter()
                .filter(|id| scene.facts(**id).colors.is_empty())
                .count();
            let mut cases = vec![
                (format!("There is a {one}."), true),
                (format!("There is no {one}."), false),
                (format!("There are {} {several}.", all + 1), false),
                (format!("There are at least {} {several}.", all + 1), false),
            ];
            if all > 1 {
                cases.push((format!("There are {all} {several}."), true));
                cases.push((format!("There are at least {all} {several}."), true));
            }
            if clear == 0 {
                cases.push((format!("A {one} is red."), red > 0));
                cases.push((format!("Every {one} is red."), red == all));
                cases.push((format!("No {one} is red."), red == 0));
                cases.push((format!("There is a red {one}."), red > 0));
            }
            for (text, expected) in cases {
                let verdict = check(&scene, &text);
                assert_eq!(verdict.truth, Truth::from(expected), "{name}: {text}");
            }
        }
    }
}

/// "A lamp in every room" is one lamp in each, not one lamp in all of them.
#[test]
fn each_landmark_has_its_own_thing() {
    for name in ["builtin:apartment", "seed:7", "seed:12"] {
        let house = house(name);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let rooms: Vec<_> = scene.house().rooms.ids().collect();
        for (noun, things) in called(&scene) {
            let has = |room| things.iter().any(|id| scene.room_of(*id) == Some(room));
            let having = rooms.iter().filter(|room| has(**room)).count();
            for (text, expected) in [
                (
                    format!("There is a {noun} in every room."),
                    having == rooms.len(),
                ),
                (format!("Every room has a {noun}."), having == rooms.len()),
                (format!("None of the rooms has a {noun}."), having == 0),
                (format!("Two of the rooms have a {noun}."), having == 2),
                (format!("There are at most 3 {noun}s."), things.len() <= 3),
                (format!("There are fewer than 3 {noun}s."), things.len() < 3),
                (format!("There are more than 3 {noun}s."), things.len() > 3),
            ] {
                // Not every plural has an "s".
                let Ok(read) = Language::english().read(&text) else {
                    assert!(text.ends_with("s."), "{text}");
                    continue;
                };
                let Form::Claim(clause) = &read.forms[0] else {
                    panic!("{text}: {read:?}");
                };
                let verdict = Checker::new(&scene, Addressee::default()).check(clause);
                assert_eq!(
                    verdict.truth,
                    Truth::from(expected),
                    "{name}: {text} {clause:?}"
                );
            }
        }
    }
}

/// Returns whether a colour of these houses lies between `word` and another.
fn lies_between(own: &str, word: &str) -> bool {
    match own {
        "cream" => ["white", "beige"].contains(&word),
        "light gray" => ["white", "gray"].contains(&word),
        "dark gray" => ["black", "gray"].contains(&word),
        "tan" => ["brown", "beige"].contains(&word),
        "teal" => ["blue", "green"].contains(&word),
        "sage" => ["gray", "green"].contains(&word),
        "blue-gray" => ["gray", "blue"].contains(&word),
        "pale pink" => ["pink", "white"].contains(&word),
        "pale blue" => ["blue", "white"].contains(&word),
        "pale green" => ["green", "white"].contains(&word),
        "pale yellow" => ["yellow", "white"].contains(&word),
        "peach" => ["beige", "orange"].contains(&word),
        "taupe" => ["brown", "gray"].contains(&word),
        "gray-beige" => ["gray", "beige"].contains(&word),
        _ => false,
    }
}

/// The colour word of nine tenths of the pixels of a material, where it has one.
fn only_color(house: &House, material: MaterialId) -> Option<&'static str> {
    let material = &house.materials[material];
    let word = |linear: [f32; 3]| ColorVocabulary::Surface.word(linear);
    let Some(texture) = material.texture else {
        return Some(word(material.base_color));
    };
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let pixels = house.textures[texture].rgba().chunks_exact(4).step_by(97);
    for pixel in pixels {
        let linear = std::array::from_fn(|k| {
            material.base_color[k] * linear_from_srgb(f32::from(pixel[k]) / 255.0)
        });
        *counts.entry(word(linear)).or_default() += 1;
    }
    let all: usize = counts.values().sum();
    let (own, count) = counts.into_iter().max_by_key(|(_, count)| *count)?;
    (10 * count >= 9 * all).then_some(own)
}

#[test]
fn rooms_and_pieces_of_the_building_have_colors_and_substances() {
    let mut decided = [0, 0];
    for name in ["builtin:apartment", "seed:7", "seed:12"] {
        let house = house(name);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        for room in house.rooms.ids() {
            let facts = semantics.room(room);
            for color in ["white", "blue", "green", "gray", "beige", "pink"] {
                let own = house
                    .rooms
                    .ids()
                    .filter(|id| semantics.room(*id).noun == facts.noun);
                let own = own.map(|id| semantics.room(id).wall_color);
                let own: Vec<Option<&str>> = own.collect();
                let text = format!("There is a {color} {}.", facts.noun);
                let truth = check(&scene, &text).truth;
                let expected = if own.contains(&Some(color)) {
                    Truth::True
                } else if own.iter().flatten().any(|own| lies_between(own, color)) {
                    Truth::Undecided(UndecidedReason::DividedColor)
                } else {
                    Truth::False
                };
                assert_eq!(truth, expected, "{name}: {text}");
            }
        }
        // A piece of one material has its colour and substance, and no other.
        for (id, piece) in house.structure.iter_ids() {
            let [only] = piece.materials[..] else {
                continue;
            };
            let Some(own) = only_color(&house, only) else {
                continue;
            };
            let substance = library().get(&house.materials[only].substance);
            let kinds = dwell_semantics::form::Quality::Color;
            let asks = |quality| Clause::Is {
                subject: Phrase::Id(house.entity_of_structure(id).0.unsigned_abs()),
                quality,
            };
            let checker = Checker::new(&scene, Addressee::default());
            for word in ["white", "blue", "gray", own] {
                let verdict = checker.check(&asks(kinds(word.to_owned())));
                let expected = if lies_between(own, word) {
                    Truth::Undecided(UndecidedReason::DividedColor)
                } else {
                    Truth::from(word == own)
                };
                assert_eq!(verdict.truth, expected, "{name}: {}", piece.name);
                decided[usize::from(word == own)] += 1;
            }
            if let Some(substance) = substance {
                let quality = dwell_semantics::form::Quality::Material(substance.adjective.clone());
                assert!(
                    checker.check(&asks(quality)).truth.is_true(),
                    "{name}: {}",
                    piece.name
                );
            }
        }
    }
    assert!(decided.iter().all(|number| *number > 20), "{decided:?}");
}

#[test]
fn each_of_several_is_next_to_another() {
    let house = house("seed:7");
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let next_to = dwell_semantics::predicates::find("next_to").unwrap();
    let mut verdicts = BTreeSet::new();
    for (noun, things) in called(&scene) {
        let plural = &scene.facts(things[0]).plural;
        if scene.facts(things[0]).noun != noun || things.len() < 2 || noun.contains(" of ") {
            continue;
        }
        let beside = |a: &ObjectId| {
            let mut others = things.iter().filter(|b| *b != a);
            others.any(|b| {
                let pair = [Term::Object(*a), Term::Object(*b)];
                next_to.holds(&scene, &pair, None).is_true()
            })
        };
        let number = things.iter().filter(|thing| beside(thing)).count();
        for (text, expected) in [
            (
                format!("All {plural} are next to each other."),
                number == things.len(),
            ),
            (
                format!("At least two {plural} are next to each other."),
                number >= 2,
            ),
        ] {
            assert_eq!(check(&scene, &text).truth, expected.into(), "{text}");
            verdicts.insert(expected);
        }
    }
    assert_eq!(verdicts.len(), 2);
}

#[test]
fn oak_is_wooden_and_steel_is_metal() {
    let mut found = BTreeSet::new();
    for name in ["builtin:apartment", "seed:7", "seed:12", "seed:13"] {
        let house = house(name);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        for noun in called(&scene).into_keys() {
            for (member, family) in [
                ("oak", "wooden"),
                ("pine", "wooden"),
                ("steel", "metal"),
                ("brass", "metal"),
            ] {
                let is = |word: &str| check(&scene, &format!("There is a {word} {noun}.")).truth;
                if is(member).is_true() {
                    assert!(is(family).is_true(), "{name}: {member} {noun}");
                    found.insert(family);
                }
            }
        }
    }
    assert!(found.contains("metal"), "{found:?}");
}

#[test]
fn relations_of_descriptions_agree_with_those_of_things() {
    // The larger one with `DWELL_TEST_ALL=1`: it has ten times the pairs of nouns.
    let all = std::env::var_os("DWELL_TEST_ALL").is_some();
    let house = house(if all {
        "builtin:apartment"
    } else {
        "builtin:studio"
    });
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let nouns = called(&scene);
    let on = dwell_semantics::predicates::find("on").unwrap();
    let mut held = 0;
    for (a, first) in &nouns {
        for (b, second) in &nouns {
            let pairs = first
                .iter()
                .flat_map(|a| second.iter().map(move |b| (*a, *b)));
            let mut pairs = pairs.map(|(a, b)| [Term::Object(a), Term::Object(b)]);
            let expected = pairs.any(|pair| on.holds(&scene, &pair, None).is_true());
            let text = format!("A {a} is on a {b}.");
            assert_eq!(check(&scene, &text).truth, expected.into(), "{text}");
            if expected {
                held += 1;
                let verdict = check(&scene, &text);
                let witness = &verdict.witnesses[0];
                assert!(
                    on.holds(&scene, &witness.terms, None).is_true(),
                    "{witness:?}"
                );
                assert!(
                    check(&scene, &format!("No {a} is on a {b}."))
                        .truth
                        .is_false()
                );
            }
        }
    }
    assert!(held > 10, "{held}");
}

#[test]
fn what_cannot_be_asked_is_undecided_with_its_reason() {
    let house = house("builtin:apartment");
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let reason = |text: &str| check(&scene, text).truth.reason();
    assert_eq!(
        reason("A chair is to the left of a bed."),
        Some(UndecidedReason::NoViewer)
    );
    assert_eq!(
        reason("You are near a chair."),
        Some(UndecidedReason::NoListener)
    );
    assert_eq!(
        reason("Object 99999 is red."),
        Some(UndecidedReason::UnknownTerm)
    );
    // Nothing is a piano, so that what is said of the piano is false, and so is what is said of it not being so: it is the claim
    // about the piano that is false, not its opposite that is true.
    assert!(check(&scene, "The grand piano is red.").truth.is_false());
    let viewer = Viewer {
        world_from_camera: dwell_scene::Pose::from_position_yaw(
            house.rooms.as_slice()[0].bounds.center(),
            0.3,
        ),
    };
    let listener = Addressee {
        viewer: Some(viewer),
        agent: None,
    };
    let checker = Checker::new(&scene, listener);
    let left = checker
        .check(&clause("Some chair is to the left of some chair."))
        .truth;
    assert_ne!(left.reason(), Some(UndecidedReason::NoViewer));
}

#[test]
fn questions_get_what_was_counted() {
    let house = house("builtin:apartment");
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let checker = Checker::new(&scene, Addressee::default());
    let nouns = called(&scene);
    let chairs = &nouns["chair"];
    assert_eq!(
        checker.answer(&question("How many chairs are there?")),
        QuestionAnswer::Number(chairs.len())
    );
    let QuestionAnswer::Things(found) = checker.answer(&question("Which chair is wooden?")) else {
        panic!("ids");
    };
    let wooden = |id: &&ObjectId| {
        scene
            .facts(**id)
            .substances
            .iter()
            .any(|(substance, share)| substance.adjective == "wooden" && *share >= 0.2)
    };
    let expected: Vec<Term> = chairs
        .iter()
        .filter(wooden)
        .map(|id| Term::Object(*id))
        .collect();
    assert_eq!(found, expected);
    // It has several tables, and nothing is on all of them.
    let QuestionAnswer::Number(tables) = checker.answer(&question("How many tables are there?"))
    else {
        panic!("a number");
    };
    assert!(tables > 1);
    assert_eq!(
        checker.answer(&question("What is on the table?")),
        QuestionAnswer::None(UndecidedReason::SeveralFit)
    );
    let QuestionAnswer::Truth(verdict) = checker.answer(&question("Is there a bed?")) else {
        panic!("a truth value");
    };
    assert!(verdict.truth.is_true());
    assert_eq!(
        checker.answer(&question("What color is the chair?")),
        QuestionAnswer::None(UndecidedReason::SeveralFit)
    );
}

#[test]
fn sentences_are_checked_and_their_phrases_grounded() {
    let house = house("builtin:apartment");
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let checker = Checker::new(&scene, Addressee::default());
    let checked = checker.check_text("there's a bet").unwrap_err();
    assert!(
        checked.to_string().contains("\"bet\" (known are bed"),
        "{checked}"
    );
    assert!(checker.check_text("there's a bed").is_ok());
    let checked = checker
        .check_text("There is a sofa in the living room.")
        .unwrap();
    let Some(QuestionAnswer::Truth(verdict)) = checked.answer else {
        panic!("a truth value");
    };
    assert!(verdict.truth.is_true(), "{verdict:?}");
    let request = checker
        .check_text("Go to the kitchen, then find the bed.")
        .unwrap();
    assert!(request.answer.is_none());
    let said = semantics.language().say(&checked.form, None).unwrap();
    let grounded = checker.ground(&said);
    let text: Vec<&str> = grounded
        .iter()
        .map(|span| &said.text[span.start..span.end])
        .collect();
    assert_eq!(text, ["a sofa in the living room", "the living room"]);
    let sofas = &grounded[0].terms;
    assert!(!sofas.is_empty());
    for sofa in sofas {
        let sofa = sofa.object().unwrap();
        assert!(scene.facts(sofa).is_called("sofa"));
        assert_eq!(
            grounded[1].terms,
            [Term::Room(scene.room_of(sofa).unwrap())]
        );
    }
}

#[test]
fn ambiguous_nouns_ask_which_thing_is_meant() {
    let house = house("builtin:apartment");
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let checker = Checker::new(&scene, Addressee::default());
    let language = semantics.language();
    let asked = |text: &str| {
        let form = language.read(text).unwrap().forms.remove(0);
        checker.ambiguities(&form)
    };
    assert!(asked("Is there a bed?").is_empty());
    let mut named = 0;
    for noun in ["bed", "door", "window", "chair", "lamp", "picture", "plant"] {
        let found = asked(&format!("Find the {noun}."));
        let things = language.read(&format!("a {noun}")).unwrap();
        let Form::NounPhrase(Phrase::Described(what)) = &things.forms[0] else {
            panic!("{:?}", things.forms[0]);
        };
        let fitting = checker.matching_terms(what);
        if fitting.len() < 2 {
            assert!(found.is_empty(), "{noun}: {found:?}");
            continue;
        }
        let [only] = &found[..] else {
            panic!("{noun}: {found:?}");
        };
        assert_eq!(only.terms, fitting);
        let question = only.question.as_deref().unwrap();
        assert!(question.starts_with("Which "), "{question}");
        let Some((_, rest)) = question.trim_end_matches('?').split_once("do you mean, ") else {
            continue;
        };
        // Each of the phrases of the answer fits one of the things alone.
        let mut told: Vec<_> = rest
            .split(", ")
            .flat_map(|part| part.split(" or "))
            .map(|phrase| match &language.read(phrase).unwrap().forms[0] {
                Form::NounPhrase(phrase) => checker.denotation(phrase),
                other => panic!("{other:?}"),
            })
            .collect();
        assert!(told.iter().all(|terms| terms.len() == 1), "{question}");
        told.sort();
        assert_eq!(told.concat(), fitting, "{question}");
        named += 1;
    }
    assert!(named > 0);
}

#[test]
fn distances_parts_and_round_things_are_asked_for() {
    let house = crate::common::small_house().house;
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let checker = Checker::new(&scene, Addressee::default());
    let answer = |text: &str| checker.check_text(text).unwrap().answer.unwrap();
    // 5.9 m along one wall and 1.2 m along the other.
    assert_eq!(
        answer("How far is the fridge from the desk?"),
        QuestionAnswer::Number(6)
    );
    assert!(
        check(&scene, "The fridge is about 6 metres from the desk.")
            .truth
            .is_true()
    );
    let QuestionAnswer::Truth(verdict) = answer("The fridge has two doors.") else {
        panic!("a truth value");
    };
    assert_eq!(
        verdict.truth,
        Truth::Undecided(UndecidedReason::PartOfThing)
    );
    assert_eq!(
        answer("How many doors does the fridge have?"),
        QuestionAnswer::None(UndecidedReason::PartOfThing)
    );
    assert!(check(&scene, "The desk is round.").truth.is_false());
    let (kitchen, _) = open("seed:11").unwrap();
    let semantics = Semantics::new(&Arc::new(kitchen));
    let state = State::new(semantics.house());
    let scene = semantics.scene(&state);
    assert!(
        check(&scene, "There is a round table in the kitchen.")
            .truth
            .is_true()
    );
}
