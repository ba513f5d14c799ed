//! Questions about houses: their words are read anew, and their answers worked out from outlines, boxes, joints and pixels.

mod answers_of_house;
mod color_words;

use answers_of_house::{
    answer, answer_of_house, bounds, gap_m, kind, question, rests_on, room_around, text, thing,
};
use color_words::words_of;
use dwell::sensors::{ImageObservationOptions, ObservationData};
use dwell::{
    CameraMount, DiscreteAction, Engines, Env, EnvConfig, ImageRequest, StepAction, StepInfo,
};
use dwell_render::{Camera, Preset};
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::ask::answer_index;
use dwell_semantics::category::categories;
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::form::{Clause, Question};
use glam::Vec3;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

const ME: AgentId = AgentId(0);

fn config(settings: Value) -> EnvConfig {
    EnvConfig {
        task: "EmbodiedQA".to_owned(),
        task_settings: settings,
        ..EnvConfig::default()
    }
}

fn env(settings: Value) -> Env {
    dwell_tests::env_with(config(settings), &["question"])
}

/// A generated house with its engines, made once.
fn generated() -> Arc<Engines> {
    static HOUSE: OnceLock<Arc<Engines>> = OnceLock::new();
    let open = || {
        let (house, _) = dwell_houses::open("seed:3").expect("a generated house");
        Engines::new(Arc::new(house))
    };
    HOUSE.get_or_init(open).clone()
}

fn in_both(settings: &Value) -> [Env; 2] {
    [dwell_tests::apartment(), generated()]
        .map(|engines| dwell_tests::env_in(engines, config(settings.clone()), &["question"]))
}

/// Rooms by their outlines, numbers by the house's list, nearness by boxes, states by joints and switches; and every kind is asked for.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn answers_are_those_of_the_house() {
    let mut judged: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for mut env in in_both(&Value::Null) {
        for seed in 0..120 {
            env.reset(seed).unwrap();
            let given = answer(&mut env);
            let (own, others) = judged.entry(kind(&env)).or_default().split_at_mut(1);
            others[0] += 1;
            let Some(expected) = answer_of_house(&env) else {
                continue;
            };
            assert_eq!(given, expected, "{seed}: {}", text(&env));
            own[0] += 1;
        }
    }
    let kinds: Vec<&str> = judged.keys().copied().collect();
    assert_eq!(
        kinds,
        [
            "color",
            "color_room",
            "comparison",
            "count",
            "existence",
            "location",
            "place",
            "state"
        ]
    );
    for (kind, [judged, all]) in judged {
        let is_judged = !["color", "color_room", "place"].contains(&kind);
        assert!(!is_judged || 2 * judged >= all, "{kind}: {judged} of {all}");
    }
}

/// What is on a thing rests on it by rays, what is next to it is near by its box and in its room; it is called as the answer says.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn what_is_somewhere_is_there() {
    let (mut on, mut beside) = (0, 0);
    for mut env in in_both(&json!({"kinds": ["place"]})) {
        for seed in 0..40 {
            env.reset(seed).unwrap();
            let given = answer(&mut env);
            let Question::Which {
                clause:
                    Clause::Holds {
                        predicate,
                        arguments,
                    },
                ..
            } = question(&env)
            else {
                panic!("{}", text(&env));
            };
            let landmark = thing(&env, &arguments[1]);
            let there = env.episode(0).unwrap().goal.objects.clone();
            let house = env.world().house().clone();
            for thing in there {
                let row = categories().of(&house.objects[thing].category);
                assert_eq!(row.map(|row| row.singular), Some(given), "{}", text(&env));
                if predicate == "on" {
                    assert!(rests_on(&env, thing, landmark), "{}", text(&env));
                    on += 1;
                    continue;
                }
                let [own, other] = [thing, landmark].map(|object| bounds(&env, object));
                let gap_m = gap_m(&own, &other);
                let rooms = [own, other].map(|bounds| room_around(&house, bounds.center()));
                assert!(
                    gap_m < 1.0 && rooms[0] == rooms[1],
                    "{} {gap_m}",
                    text(&env)
                );
                beside += 1;
            }
        }
    }
    assert!(on >= 5 && beside >= 5, "{on} {beside}");
}

/// The colour that is asked for is that of most of the thing's pixels, as the expert sees it where it answers.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn colors_are_those_of_the_pixels() {
    let (mut agree, mut judged) = (0, 0);
    let mut words: BTreeSet<&str> = BTreeSet::new();
    for mut env in in_both(&json!({"kinds": ["color", "color_room"]})) {
        for seed in 0..10 {
            env.reset(seed).unwrap();
            let given = answer(&mut env);
            for _ in 0..1000 {
                let step = env.expert_step(0).unwrap();
                if step.action == DiscreteAction::Stop {
                    break;
                }
                env.step(&[Some(step)]).unwrap();
            }
            let object = env.episode(0).unwrap().goal.objects[0];
            let entity = env.world().house().entity_of_object(object).0;
            let request = ImageRequest {
                camera: Camera::from_fov(64, 48, 90.0).unwrap(),
                mount: CameraMount::Agent(ME, Pose::IDENTITY),
                preset: Preset::Flat,
            };
            let names = ["albedo", "instance"].map(str::to_owned);
            let options = ImageObservationOptions::default();
            let world = env.world_mut();
            let seen = world
                .image_observations(&request, &names, options, Threads::ONE)
                .unwrap();
            let (ObservationData::Float32(albedo), ObservationData::Int32(instance)) =
                (&seen[0].data, &seen[1].data)
            else {
                panic!("an albedo and an instance image");
            };
            let own = albedo.chunks_exact(3).zip(instance);
            let own = own.filter(|(_, id)| **id == entity);
            let own: Vec<[f32; 3]> = own.map(|(rgb, _)| [rgb[0], rgb[1], rgb[2]]).collect();
            if own.len() < 12 {
                continue;
            }
            judged += 1;
            words.insert(given);
            let fits = own.iter().filter(|rgb| words_of(**rgb).contains(&given));
            agree += usize::from(2 * fits.count() >= own.len());
        }
    }
    // A face that is turned away may have another colour than most of the thing. By chance a third would agree: these words overlap.
    assert!(judged >= 10 && words.len() >= 3, "{judged} {words:?}");
    assert!(10 * agree >= 8 * judged, "{agree} of {judged}");
}

/// Every text keeps to the limits, each of its definite phrases means one thing or room, and it is read as a question with that answer.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn every_question_means_one_thing_and_has_one_answer() {
    let mut texts = BTreeSet::new();
    for mut env in in_both(&Value::Null) {
        for seed in 200..300 {
            env.reset(seed).unwrap();
            let (text, given) = (text(&env), answer(&mut env));
            assert!(text.ends_with('?') && text.len() <= 120, "{text}");
            let charset = dwell_semantics::instruct::CHARSET;
            assert!(
                text.chars().all(|letter| charset.contains(letter)),
                "{text}"
            );
            let tokens = dwell_semantics::vocabulary::tokenize(&text).unwrap();
            assert_eq!(env.episode(0).unwrap().tokens, tokens);
            let scene = env.world().engines().semantics().scene(env.world().state());
            let checker = Checker::new(&scene, Addressee::default());
            let told = checker.check_text(&text).unwrap();
            assert!(
                told.answer.is_some_and(|answer| answer.is_decided()),
                "{text}"
            );
            assert!(checker.ambiguities(&told.form).is_empty(), "{text}");
            assert!(answer_index(given).is_some());
            texts.insert(text);
        }
    }
    assert!(texts.len() > 60, "{}", texts.len());
}

/// `yes` is as often right as `no`, within what chance allows in 999 of 1,000 runs.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn yes_and_no_are_as_frequent() {
    for kind in ["existence", "comparison", "state"] {
        let mut env = env(json!({"kinds": [kind]}));
        let (count, mut yes) = (200, 0);
        for seed in 0..count {
            env.reset(seed).unwrap();
            yes += u64::from(answer(&mut env) == "yes");
        }
        // 3.29 standard deviations of a fair coin.
        let far = 3.29 * (count as f64).sqrt() / 2.0;
        let miss = (yes as f64 - count as f64 / 2.0).abs();
        assert!(miss < far, "{kind}: {yes} of {count}");
    }
}

fn stop(answer: f32) -> StepAction {
    StepAction {
        answer: [answer, 0.0, 0.0, 0.0],
        ..DiscreteAction::Stop.into()
    }
}

fn stopped(env: &mut Env, seed: u64, answer: f32) -> StepInfo {
    env.reset(seed).expect("the task can be played");
    let infos = env.step(&[Some(stop(answer))]);
    infos.expect("the episode goes on").remove(0)
}

/// The right answer is a success wherever it is given; each other one costs what the settings say, and so does none.
#[test]
fn answers_are_paid_as_the_settings_say() {
    let reward = json!({"distance": 0.0, "step": -0.25, "success": 3.0, "wrong_answer": -0.5});
    let mut env = env(json!({"reward": reward}));
    for seed in 0..6 {
        env.reset(seed).unwrap();
        let right = env.expert_step(0).unwrap().answer[0];
        let wait = &env.step(&[Some(DiscreteAction::Wait)]).unwrap()[0];
        assert!(!wait.result.terminated && (wait.result.reward + 0.25).abs() < 1e-9);
        assert!(wait.measures[0].is_nan());
        let info = stopped(&mut env, seed, right);
        assert!(info.result.success && info.result.terminated);
        assert!((info.result.reward - 2.75).abs() < 1e-9);
        assert_eq!(info.measures[0], 1.0);
        for wrong in [right + 1.0, right - 1.0, -1.0, 1e9, f32::NAN, f32::INFINITY] {
            let info = stopped(&mut env, seed, wrong);
            assert!(!info.result.success && info.result.terminated, "{wrong}");
            assert!((info.result.reward + 0.75).abs() < 1e-9);
            assert_eq!(info.measures[0], 0.0);
        }
    }
}

/// What is measured of the way is what one measures by oneself step by step; and after a snapshot it goes on the same.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_way_is_measured_and_goes_on_after_a_snapshot() {
    let mut env = env(json!({"min_distance_m": 3.0}));
    let mut entered_later = 0;
    for seed in 0..6 {
        env.reset(seed).unwrap();
        let goal = env.episode(0).unwrap().goal.clone();
        let start_m = env.episode(0).unwrap().progress.start_distance_m.unwrap();
        assert!(start_m >= 3.0);
        let house = env.world().house().clone();
        let (mut least_m, mut entered, mut began_inside) = (start_m, false, None);
        let (mut saved, mut done) = (None, Vec::new());
        let mut last = Vec::new();
        for step in 0..1000 {
            // Half of the way, and then back: the least distance and the entered room are remembered.
            let action = match step {
                60..=66 => DiscreteAction::TurnLeft.into(),
                _ => env.expert_step(0).unwrap(),
            };
            done.push(action);
            let info = env.step(&[Some(action)]).unwrap().remove(0);
            let feet = env.world().state().agents[ME].position;
            let inside = room_around(&house, feet + Vec3::Y * 0.1) == Some(goal.rooms[0]);
            began_inside.get_or_insert(inside);
            entered |= inside;
            let now_m = info.progress.distance_m.unwrap();
            least_m = least_m.min(now_m);
            let [correct, decrease_m, told_least_m, is_there, was_there] = info.measures[..] else {
                panic!("{:?}", info.measures);
            };
            assert!((decrease_m - (start_m - now_m)).abs() < 1e-9);
            assert!((told_least_m - least_m).abs() < 1e-9);
            assert_eq!(
                [is_there, was_there],
                [inside, entered].map(|is| f64::from(u8::from(is)))
            );
            assert_eq!(correct.is_nan(), !info.result.terminated);
            last = info.measures.clone();
            if info.result.terminated {
                assert!(info.result.success, "{seed}");
                break;
            }
            if step == 40 {
                saved = Some(env.snapshot().unwrap());
            }
        }
        assert!(entered && last[0] == 1.0, "{seed}: {}", text(&env));
        entered_later += usize::from(began_inside == Some(false));
        let Some(saved) = saved else {
            continue;
        };
        let mut other = self::env(json!({"min_distance_m": 3.0}));
        other.reset(seed + 50).unwrap();
        other.restore(&saved).unwrap();
        assert_eq!(text(&other), text(&env));
        let mut ends = Vec::new();
        for action in &done[41..] {
            ends = other.step(&[Some(*action)]).unwrap().remove(0).measures;
        }
        assert_eq!(ends, last, "{seed}");
    }
    assert!(entered_later >= 2, "{entered_later}");
}

#[test]
fn starts_lie_so_many_steps_away() {
    for count in [10_u32, 30, 50] {
        let mut env = env(json!({"start_actions": count}));
        for seed in 0..5 {
            env.reset(seed).unwrap();
            let start_m = env.episode(0).unwrap().progress.start_distance_m.unwrap();
            let expected_m = f64::from(count) * 0.1;
            assert!((start_m - expected_m).abs() <= 0.0501, "{count}: {start_m}");
        }
    }
}

/// The kinds that are asked for are the only ones; what no episode can keep to is refused, and so is a house without an answer.
#[test]
fn settings_are_kept_or_refused() {
    let mut one = env(json!({"kinds": ["count", "count"]}));
    for seed in 0..10 {
        one.reset(seed).unwrap();
        assert_eq!(kind(&one), "count");
        let number: usize = answer(&mut one).parse().unwrap();
        assert!(number <= 5);
    }
    let told = |engines: Arc<Engines>, settings: Value| {
        let mut env = dwell_tests::try_env_in(engines, config(settings), &[])
            .map_err(|error| error.to_string())?;
        env.reset(0).map_err(|error| error.to_string())
    };
    for (settings, part) in [
        (
            json!({"kinds": []}),
            "kinds is none; allowed is at least one of location",
        ),
        (json!({"kinds": ["why"]}), "why"),
        (json!({"start_actions": 0}), "start_actions is 0"),
        (json!({"min_distance_m": 40.0}), "min_distance_m is 40"),
        (
            json!({"reward": {"wrong_answer": 1e9}}),
            "reward.wrong_answer",
        ),
        (json!({"reward": {"step": 1e9}}), "reward.step"),
        (
            json!({"min_distance_m": 900.0, "max_distance_m": 1000.0}),
            "no question of the kinds that are asked for can be walked to from 900 to 1000 m away",
        ),
    ] {
        let error = told(dwell_tests::apartment(), settings).unwrap_err();
        assert!(error.contains(part), "{error}");
    }
    let bare = dwell_tests::sensing::bare_room([4.0, 3.0, 4.0]);
    let error = told(bare, Value::Null).unwrap_err();
    assert!(error.contains("it has nothing to ask about"), "{error}");
    let misplaced = EnvConfig::default();
    let error = dwell_tests::try_env_in(dwell_tests::apartment(), misplaced, &["question"]);
    let error = error.unwrap_err().to_string();
    assert!(error.contains("with the task EmbodiedQA alone"), "{error}");
}
