//! Instructions for feet and hands: their words are read anew, and what became of the house is judged by them.

mod judge;

use dwell::{DiscreteAction, Engines, Env, EnvConfig};
use dwell_scene::random::RandomKey;
use dwell_scene::{Aabb, AgentId};
use glam::Vec3;
use judge::{Judge, Meant, meant};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::Arc;

const ME: AgentId = AgentId(0);

/// Plays an episode to its end. Gives back the actions, whether it was called a success, and whether the judge of this file calls it one.
fn play(
    env: &mut Env,
    seed: u64,
    mut policy: impl FnMut(usize, &mut Env) -> DiscreteAction,
) -> (Vec<DiscreteAction>, bool, bool) {
    env.reset(seed).expect("the task can be played");
    let mut judge = Judge::new(meant(env));
    let mut actions = Vec::new();
    for k in 0..1500 {
        let action = if k == 1499 {
            DiscreteAction::Stop
        } else {
            policy(k, env)
        };
        actions.push(action);
        let looked_at = env.world().object_in_view_centre(ME);
        let info = env.step(&[Some(action)]);
        let info = info.expect("the episode goes on").swap_remove(0);
        let points = action == DiscreteAction::Point && info.action_success;
        judge.look(env, looked_at.filter(|_| points));
        let whole = info.measures[0];
        assert!((0.0..=1.0).contains(&whole));
        assert!(!info.result.success || whole == 1.0, "{seed}: {whole}");
        if info.result.terminated {
            return (actions, info.result.success, judge.is_fulfilled(env));
        }
    }
    unreachable!("stop ends an episode")
}

fn env_in(house: dwell_scene::House, settings: Value) -> Env {
    let config = EnvConfig {
        task: "InstructionFollowing-v1".to_owned(),
        task_settings: settings,
        ..EnvConfig::default()
    };
    dwell_tests::env_in(Engines::new(Arc::new(house)), config, &[])
}

fn is_hand(action: DiscreteAction) -> bool {
    action.kind().is_hand_action()
}

/// Every plan of the expert is accepted, and what breaks it is rejected: to stop in between, to keep the hands still, to walk at random.
/// The task's verdict is that of the words in every case.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn verdicts_are_those_of_the_words() {
    let (houses, episodes) = if dwell_tests::runs_all() {
        (1000, 2)
    } else {
        (4, 5)
    };
    let mut kinds = BTreeSet::new();
    let mut wrong = Vec::new();
    let (mut accepted, mut rejected, mut played) = (0, 0, 0);
    for number in 0..houses {
        let (house, _) = dwell_houses::open(&format!("seed:{}", 700 + number)).unwrap();
        let mut env = env_in(
            house,
            json!({"max_sequence_steps": 3, "max_distance_m": 15.0}),
        );
        // Others in each house: the form of an instruction is drawn by the seed.
        for seed in number * episodes..(number + 1) * episodes {
            let key = RandomKey::root(seed).child("perturbed");
            let (plan, success, judged) =
                play(&mut env, seed, |_, env| env.expert_action(0).unwrap());
            let text = format!(
                "seed:{}#{seed} {}",
                700 + number,
                env.episode(0).unwrap().instruction
            );
            kinds.insert(env.episode(0).unwrap().goal.kind);
            let mut compare = |(success, judged): (bool, bool), how: &str| {
                if success != judged {
                    wrong.push(format!("{text} {how}: success {success}, meant {judged}"));
                }
            };
            compare((success, judged), "by the expert");
            played += 1;
            accepted += usize::from(success);
            // To stop before the end.
            let end = key.child("end").stream().below(plan.len());
            let (_, success, judged) = play(&mut env, seed, |k, _| {
                if k < end {
                    plan[k]
                } else {
                    DiscreteAction::Stop
                }
            });
            compare((success, judged), &format!("until {end}"));
            // To go, and do nothing.
            let (_, success, judged) =
                play(&mut env, seed, |k, _| match plan[k.min(plan.len() - 1)] {
                    action if is_hand(action) => DiscreteAction::Wait,
                    action => action,
                });
            compare((success, judged), "without hands");
            if meant_hands(&mut env, seed) {
                assert!(!success, "{text} without hands");
                rejected += 1;
            }
            let mut stream = key.child("walk").stream();
            let (_, success, judged) = play(&mut env, seed, |k, _| match stream.below(40) {
                0 if k > 20 => DiscreteAction::Stop,
                n => DiscreteAction::ALL[1 + n % 17],
            });
            compare((success, judged), "at random");
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    // How often the expert succeeds is measured elsewhere, over more episodes.
    assert!(
        accepted * 10 >= 9 * played,
        "the expert did {accepted} of {played}"
    );
    assert!(
        rejected * 3 > played && kinds.len() > 4,
        "{rejected} {kinds:?}"
    );
}

/// Whether the instruction of a seed asks for something of the hands.
fn meant_hands(env: &mut Env, seed: u64) -> bool {
    env.reset(seed).expect("the task can be played");
    meant(env).steps.iter().any(|step| !step.of[0].is_passing())
}

/// An episode that is restored after its first step is done knows that it is.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_restored_instruction_knows_what_is_done() {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let settings = json!({
        "forms": ["sequence"],
        "kinds": ["go_to_room", "find_object", "pick_up", "open", "close", "switch_on", "switch_off", "bring"],
    });
    let mut env = env_in(house.clone(), settings.clone());
    let mut other = env_in(house, settings);
    let mut checked = 0;
    for seed in 0..12 {
        let (plan, success, _) = play(&mut env, seed, |_, env| env.expert_action(0).unwrap());
        // How often the expert succeeds is tested above.
        if !success {
            continue;
        }
        env.reset(seed).unwrap();
        let first = meant(&env).steps[0].of[0];
        // Where the first step is passing, nothing but the snapshot says that it is done.
        if !first.is_place() {
            continue;
        }
        let mut saved = None;
        for action in &plan {
            env.step(&[Some(*action)]).unwrap();
            if saved.is_some() && !first.is_so(&env, None) {
                saved = Some(env.snapshot().unwrap());
                break;
            }
            if first.is_so(&env, None) {
                saved = Some(Vec::new());
            }
        }
        let Some(saved) = saved.filter(|saved| !saved.is_empty()) else {
            continue;
        };
        let after = env.steps() as usize;
        other.reset(100 + seed).unwrap();
        other.restore(&saved).unwrap();
        let mut last = None;
        for action in &plan[after..] {
            last = Some(other.step(&[Some(*action)]).unwrap().swap_remove(0));
        }
        assert!(last.is_some_and(|info| info.result.success), "{seed}");
        checked += 1;
    }
    assert!(checked >= 1);
}

/// What falls on the way is fetched from where it lies, also by an episode that is restored there: it is rewarded as the one that goes on.
#[test]
fn what_was_let_go_on_the_way_is_fetched_from_there() {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let settings = json!({"forms": ["single"], "kinds": ["bring"]});
    let mut env = env_in(house.clone(), settings.clone());
    let mut other = env_in(house, settings);
    let (mut played, mut fetched) = (0, 0);
    for seed in 0..6 {
        env.reset(seed).unwrap();
        let mut held = 0;
        let mut is_over = false;
        while held < 12 && !is_over {
            let action = env.expert_action(0).unwrap();
            is_over = env.step(&[Some(action)]).unwrap()[0].result.terminated;
            held += u32::from(env.world().state().agents[ME].holding.is_some());
        }
        if is_over {
            continue;
        }
        // Far enough from where it lay that the way to there is another one.
        let action = |action: DiscreteAction| [Some(action)];
        env.step(&action(DiscreteAction::Drop)).unwrap();
        for _ in 0..30 {
            env.step(&action(DiscreteAction::Wait)).unwrap();
        }
        let saved = env.snapshot().unwrap();
        other.reset(100 + seed).unwrap();
        other.restore(&saved).unwrap();
        played += 1;
        loop {
            let next = env.expert_action(0).unwrap();
            let info = env.step(&[Some(next)]).unwrap().swap_remove(0);
            let again = other.step(&[Some(next)]).unwrap().swap_remove(0);
            assert_eq!(
                (info.result.reward.to_bits(), env.world().hash()),
                (again.result.reward.to_bits(), other.world().hash()),
                "{seed}"
            );
            if info.result.terminated {
                fetched += u32::from(info.result.success);
                break;
            }
        }
    }
    assert!(
        played >= 4 && fetched + 1 >= played,
        "{fetched} of {played}"
    );
}

/// Fewer things, and shorter ways with what is carried.
#[test]
fn instructions_are_as_hard_as_they_are_asked() {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let most_left = |settings: Value| {
        let mut env = env_in(house.clone(), settings);
        let left = (0..30).map(|seed| {
            env.reset(seed).unwrap();
            let step = meant(&env).steps.swap_remove(0);
            let so = step.of.iter().filter(|own| own.is_so(&env, None)).count();
            step.needed - so
        });
        left.max()
    };
    assert!(most_left(json!({"forms": ["quantity"]})) > Some(2));
    assert_eq!(
        most_left(json!({"forms": ["quantity"], "max_things": 2})),
        Some(2)
    );
    let distance_m = |from: Aabb, to: Vec3| to.distance(to.clamp(from.min, from.max));
    // The straight distance from a thing to where it is put, at most as far as two arms reach further than the way.
    let furthest_m = |settings: Value| {
        let mut env = env_in(house.clone(), settings);
        let ways_m = (0..30).map(|seed| {
            env.reset(seed).unwrap();
            let Meant::PutOn(thing, place) = meant(&env).steps[0].of[0] else {
                panic!("something is put on something");
            };
            let world = env.world();
            let bounds = |object| world.house().object_bounds(world.state(), object);
            distance_m(bounds(place), bounds(thing).center())
        });
        ways_m.fold(0.0, f32::max)
    };
    let kinds = json!({"forms": ["single"], "kinds": ["put_on"]});
    assert!(furthest_m(kinds) > 5.0);
    let short = json!({"forms": ["single"], "kinds": ["put_on"], "max_transport_m": 1.0});
    assert!(furthest_m(short) < 4.0);
}

#[test]
fn settings_out_of_range_are_refused() {
    let told = |settings: Value| {
        let config = EnvConfig {
            task: "InstructionFollowing-v1".to_owned(),
            task_settings: settings,
            ..EnvConfig::default()
        };
        let made = dwell_tests::try_env_in(dwell_tests::apartment(), config, &[]);
        made.unwrap_err().to_string()
    };
    assert!(told(json!({"kinds": []})).contains("at least one of go_to_room"));
    assert!(told(json!({"kinds": ["fly"]})).contains("fly"));
    assert!(told(json!({"forms": []})).contains("at least one of single"));
    assert!(told(json!({"max_sequence_steps": 4})).contains("2 or 3"));
    assert!(told(json!({"max_things": 5})).contains("1 to 4"));
    assert!(told(json!({"max_transport_m": -1.0})).contains("max_transport_m"));
    assert!(
        told(json!({"words": "some"})).contains("held")
            || told(json!({"words": "some"})).contains("train")
    );
    assert!(told(json!({"step_done_reward": 1e9})).contains("step_done_reward"));
}
