//! The task of putting things away: rules against rays that look for what is below a thing, and the houses against the rules.

use dwell::{DiscreteAction, Engines, Env, EnvConfig, StepInfo};
use dwell_scene::ObjectId;
use dwell_tests::tidiness::{below, is_tidy};
use glam::Vec3;
use serde_json::{Value, json};
use std::sync::Arc;

fn env(settings: Value) -> Env {
    let config = EnvConfig {
        task: "Tidy".to_owned(),
        task_settings: settings,
        ..EnvConfig::default()
    };
    dwell_tests::env_with(config, &[])
}

fn step(env: &mut Env, action: DiscreteAction) -> StepInfo {
    env.step(&[Some(action)])
        .expect("an episode runs")
        .remove(0)
}

/// The rules say of most things of houses that they are where they belong.
#[test]
fn the_rules_hold_where_houses_have_their_things() {
    let (mut tidy, mut all) = (0, 0);
    for name in ["builtin:apartment", "builtin:studio", "seed:11"] {
        let (house, _) = dwell_houses::open(name).unwrap();
        let mut free = dwell_tests::env_in(
            Engines::new(Arc::new(house)),
            EnvConfig {
                task: "Free".to_owned(),
                ..EnvConfig::default()
            },
            &[],
        );
        free.reset(0).unwrap();
        let world = free.world();
        let loose = world.house().objects.ids();
        let loose = loose.filter(|id| world.house().objects[*id].pickable);
        for told in loose.filter_map(|id| is_tidy(world, id)) {
            all += 1;
            tidy += usize::from(told);
        }
    }
    assert!(all > 100, "{all}");
    assert!(tidy * 100 >= all * 85, "{tidy} of {all}");
}

/// What is displaced lies where no rule has it, at rest, and who stops then has not succeeded; the expert puts all of it where a rule
/// has it, and what it is paid is the number of things and the success.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn things_lie_where_they_do_not_belong_and_then_where_they_do() {
    let mut env = env(json!({"reward": {"step": 0.0, "wrong_stop": -0.5}}));
    let (mut solved, mut on_floor) = (0, 0);
    for seed in 0..4 {
        env.reset(seed).unwrap();
        let goal = env.episode(0).unwrap().goal.objects.clone();
        assert!((1..=3).contains(&goal.len()), "{seed}");
        for object in &goal {
            assert_eq!(
                is_tidy(env.world(), *object),
                Some(false),
                "{seed}: {object:?}"
            );
            on_floor += usize::from(below(env.world(), *object, 0).contains("floor"));
        }
        let before: Vec<Vec3> = middles(&env, &goal);
        for _ in 0..20 {
            let info = step(&mut env, DiscreteAction::Wait);
            assert_eq!(info.measures, [0.0, goal.len() as f64, 0.0], "{seed}");
        }
        for (was, is) in before.iter().zip(middles(&env, &goal)) {
            assert!(was.distance(is) < 0.005, "{seed}");
        }
        let info = step(&mut env, DiscreteAction::Stop);
        assert!(!info.result.success && (info.result.reward + 0.5).abs() < 1e-9);
        env.reset(seed).unwrap();
        let mut paid = 0.0;
        for _ in 0..3000 {
            let action = env.expert_action(0).unwrap();
            let info = step(&mut env, action);
            paid += info.result.reward;
            if info.result.terminated {
                solved += usize::from(info.result.success);
                if info.result.success {
                    assert!(
                        (paid - goal.len() as f64 - 2.5).abs() < 1e-9,
                        "{seed}: {paid}"
                    );
                    let tidy = goal
                        .iter()
                        .filter(|id| is_tidy(env.world(), **id) == Some(true));
                    assert_eq!(tidy.count(), goal.len(), "{seed}");
                    assert_eq!(info.measures, [1.0, 0.0, 0.0]);
                }
                break;
            }
        }
    }
    assert_eq!(solved, 4);
    assert!(on_floor > 0);
}

fn middles(env: &Env, objects: &[ObjectId]) -> Vec<Vec3> {
    let world = env.world();
    let middle = |id: &ObjectId| world.house().object_bounds(world.state(), *id).center();
    objects.iter().map(middle).collect()
}

/// The same seed gives the same bits, whatever was played before; a restored snapshot goes on with the same measures.
#[test]
fn episodes_come_from_their_seeds() {
    let (mut first, mut second) = (env(Value::Null), env(Value::Null));
    second.reset(9).unwrap();
    for seed in [3, 4] {
        first.reset(seed).unwrap();
        second.reset(seed).unwrap();
        assert_eq!(first.world().hash(), second.world().hash());
        for _ in 0..60 {
            let action = first.expert_action(0).unwrap();
            step(&mut first, action);
        }
        second.restore(&first.snapshot().unwrap()).unwrap();
        for action in [
            DiscreteAction::Drop,
            DiscreteAction::Wait,
            DiscreteAction::MoveForward,
        ] {
            assert_eq!(
                step(&mut first, action),
                step(&mut second, action),
                "{seed}"
            );
        }
    }
}

#[test]
fn settings_that_no_episode_can_keep_to_are_refused() {
    let told = |settings: Value| {
        let config = EnvConfig {
            task: "Tidy".to_owned(),
            task_settings: settings,
            ..EnvConfig::default()
        };
        let mut env = dwell_tests::try_env_in(dwell_tests::apartment(), config, &[])
            .map_err(|e| e.to_string())?;
        env.reset(0).map_err(|error| error.to_string())
    };
    for (settings, part) in [
        (json!({"max_things": 21}), "max_things is 21"),
        (json!({"floor_share": 1.5}), "floor_share is 1.5"),
        (json!({"reward": {"tidied": null}}), "tidied"),
        (
            json!({"classes": ["motorcycle"]}),
            "too few things that lie where they belong",
        ),
    ] {
        let error = told(settings).unwrap_err();
        assert!(error.contains(part), "{error}");
    }
}
