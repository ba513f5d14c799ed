//! Tasks ask for what they say, tell it to sensors, and are judged by their own rules.

use dwell::tasks::{self, TaskKind};
use dwell::{Batch, DiscreteAction, Env, EnvConfig};
use dwell_scene::AgentId;
use dwell_scene::parallel::Threads;
use dwell_tests::observations::{goal_sensors, observe};
use serde_json::{Value, json};

/// The tasks with a goal to walk to.
fn with_goal() -> impl Iterator<Item = &'static TaskKind> {
    let walks = |kind: &&TaskKind| {
        let mut settings = (kind.settings)().into_iter();
        settings.any(|field| field.name == "min_path_ratio") && kind.min_agents == 1
    };
    tasks::all().iter().filter(walks)
}

fn env_with(task: &str, settings: Value, sensors: &[&str]) -> Env {
    let config = EnvConfig {
        task: task.to_owned(),
        task_settings: settings,
        ..EnvConfig::default()
    };
    dwell_tests::env_with(config, sensors)
}

fn batch_of(env: Env) -> Batch {
    Batch::new(vec![env], Threads::ONE).expect("one environment")
}

/// What a batch of one environment observes with a sensor.
fn seen(batch: &mut Batch, name: &str) -> Vec<u8> {
    let specs = batch.sensor_specs();
    let place = specs.iter().position(|spec| spec.name == name);
    let place = place.expect("the environment has the sensor");
    observe(batch).swap_remove(place)
}

/// The sounds that do not belong to the house's own objects.
fn played(env: &Env) -> Vec<dwell::SoundState> {
    let own = env.world().house().emitters.len() as u64;
    let sounds = env.world().sounds().into_iter();
    sounds.filter(|sound| sound.handle >= own).collect()
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    let words = bytes.chunks_exact(4);
    words
        .map(|word| f32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect()
}

fn ints(bytes: &[u8]) -> Vec<i32> {
    let words = bytes.chunks_exact(4);
    words
        .map(|word| i32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect()
}

/// Nobody succeeds by stopping at once; and who stops in vain is paid what the settings say.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn stopping_at_the_start_is_no_success() {
    for kind in with_goal() {
        let settings =
            json!({"reward": {"wrong_stop": -0.5, "step": -0.25}, "min_distance_m": 0.0});
        let mut env = env_with(kind.name, settings, &[]);
        for seed in 0..if dwell_tests::runs_all() { 20 } else { 6 } {
            env.reset(seed).unwrap();
            let info = &env.step(&[Some(DiscreteAction::Stop)]).unwrap()[0];
            assert!(
                !info.result.success && info.result.terminated,
                "{} {seed}",
                kind.name
            );
            assert!(
                (info.result.reward + 0.75).abs() < 1e-9,
                "{} {seed}",
                kind.name
            );
        }
    }
}

/// Starts keep to the asked distances, and to the ratio of the walkable to the straight one.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn starts_lie_as_far_as_asked() {
    for kind in with_goal() {
        let settings = json!({"min_distance_m": 3.0, "max_distance_m": 5.0});
        let mut env = env_with(kind.name, settings, &[]);
        for seed in 0..if dwell_tests::runs_all() { 10 } else { 4 } {
            env.reset(seed).unwrap();
            let start_m = env.episode(0).unwrap().progress.start_distance_m.unwrap();
            assert!(
                (3.0..=5.0).contains(&start_m),
                "{} {seed}: {start_m}",
                kind.name
            );
        }
    }
    // No way is a hundred times as long as the straight line, in any task.
    for kind in with_goal() {
        let mut env = env_with(kind.name, json!({"min_path_ratio": 100.0}), &[]);
        assert!(env.reset(0).is_err(), "{}", kind.name);
    }
    let settings = json!({"min_path_ratio": 1.5});
    let mut env = env_with("PointNav", settings, &[]);
    for seed in 0..10 {
        env.reset(seed).unwrap();
        let episode = env.episode(0).unwrap();
        let goal = episode.goal.position.unwrap();
        let straight_m = f64::from(goal.distance(episode.start.position));
        let start_m = episode.progress.start_distance_m.unwrap();
        assert!(
            start_m >= 1.499 * straight_m,
            "{seed}: {start_m} {straight_m}"
        );
    }
    let mut far = env_with(
        "PointNav",
        json!({"min_distance_m": 900.0, "max_distance_m": 1e3}),
        &[],
    );
    let told = far.reset(1).unwrap_err().to_string();
    assert!(told.contains("from 900 to 1000 m away"), "{told}");
}

/// With `ends_at_goal` the way of the expert ends in success before it stops, in every task.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn an_episode_that_ends_at_its_goal_needs_no_stop() {
    for kind in with_goal() {
        let mut sparse = json!({"ends_at_goal": true, "reward": {"distance": 0.0}});
        if kind.name == "InstructionFollowing-v1" {
            sparse["step_done_reward"] = json!(0.0);
        }
        let mut env = env_with(kind.name, sparse, &[]);
        for seed in 0..if dwell_tests::runs_all() { 3 } else { 1 } {
            env.reset(seed).unwrap();
            let ended = (0..kind.max_steps).find_map(|_| {
                let action = env.expert_action(0).unwrap();
                let info = env.step(&[Some(action)]).unwrap().swap_remove(0);
                if !info.result.terminated {
                    assert!((info.result.reward + 0.01).abs() < 1e-9);
                }
                info.result.terminated.then_some((action, info.result))
            });
            let (action, result) = ended.unwrap();
            assert!(
                result.success && action != DiscreteAction::Stop,
                "{} {seed}",
                kind.name
            );
            assert!((result.reward - 2.49).abs() < 1e-9);
        }
    }
}

/// The same bits of the goals' sensors at any number of threads, and from a restored snapshot; the goal is told the same.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn sensors_of_goals_give_the_same_after_restoring_and_with_threads() {
    for kind in with_goal() {
        let sensors = goal_sensors(kind);
        let made = || env_with(kind.name, Value::Null, &sensors);
        let mut pair = Batch::new(vec![made(), made()], Threads::new(2)).unwrap();
        pair.reset(&[Some(4), Some(9)]).unwrap();
        let forward = [Some(DiscreteAction::MoveForward); 2];
        pair.step(&forward).unwrap();
        let (told, snapshot) = {
            let env = &pair.envs()[1];
            (
                env.episode(0).unwrap().goal.clone(),
                env.snapshot().unwrap(),
            )
        };
        let both = observe(&mut pair);
        let mut other = batch_of(made());
        other.reset(&[Some(1)]).unwrap();
        other.restore(0, &snapshot).unwrap();
        assert_eq!(
            other.envs()[0].episode(0).unwrap().goal,
            told,
            "{}",
            kind.name
        );
        for (alone, both) in observe(&mut other).iter().zip(&both) {
            assert!(*alone == both[alone.len()..], "{}", kind.name);
            assert!(!alone.is_empty());
        }
    }
}

/// Who turns by the angle and walks the distance stands on the goal.
#[test]
fn a_point_goal_is_given_as_seen_from_the_agent() {
    let mut batch = batch_of(dwell_tests::env_of(
        "PointNav",
        &["pointgoal_with_gps_compass"],
    ));
    for seed in 0..12 {
        batch.reset(&[Some(seed)]).unwrap();
        for action in [DiscreteAction::TurnLeft, DiscreteAction::MoveForward] {
            batch.step(&[Some(action)]).unwrap();
            let [distance_m, angle_rad] = floats(&seen(&mut batch, "pointgoal_with_gps_compass"))
                .try_into()
                .unwrap();
            let env = &batch.envs()[0];
            let agent = env.world().state().agents[AgentId(0)];
            // Of the agent's own frame: ahead and to the left at yaw 0 are -z and -x.
            let heading = agent.yaw_rad + angle_rad;
            let there_x = agent.position.x - distance_m * heading.sin();
            let there_z = agent.position.z - distance_m * heading.cos();
            let goal = env.episode(0).unwrap().goal.position.unwrap();
            let miss_m = (there_x - goal.x).hypot(there_z - goal.z);
            assert!(miss_m < 1e-3, "{seed}: {miss_m}");
        }
    }
}

/// What is told as a class is what the things are in the semantic image, and the rooms are of the kind.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn classes_and_kinds_are_those_of_the_goals() {
    let mut batch = batch_of(dwell_tests::env_of(
        "ObjectNav",
        &["objectgoal", "semantic", "instruction"],
    ));
    for seed in 0..8 {
        batch.reset(&[Some(seed)]).unwrap();
        let class = ints(&seen(&mut batch, "objectgoal"))[0];
        let env = &batch.envs()[0];
        let (goal, house) = (&env.episode(0).unwrap().goal, env.world().house().clone());
        let names = dwell_render::semantic_classes(&house);
        let name = &names[class as usize];
        assert_eq!(goal.class_name(), Some(name.as_str()));
        for object in &goal.objects {
            assert_eq!(&house.objects[*object].category.coarse, name, "{seed}");
        }
        let of_class = house
            .objects
            .iter()
            .filter(|object| object.category.coarse == *name);
        assert_eq!(of_class.count(), goal.objects.len(), "{seed}");
        // The expert stops in front of one; the image shows the class there.
        let mut seen_it = false;
        for _ in 0..1000 {
            let action = batch.expert_actions().unwrap()[0];
            if action == DiscreteAction::Stop {
                seen_it = ints(&seen(&mut batch, "semantic")).contains(&class);
                break;
            }
            batch.step(&[Some(action)]).unwrap();
        }
        assert!(seen_it, "{seed}: {name}");
    }
    let mut rooms = batch_of(dwell_tests::env_of("RoomNav", &["roomgoal", "instruction"]));
    for seed in 0..8 {
        rooms.reset(&[Some(seed)]).unwrap();
        let kind = ints(&seen(&mut rooms, "roomgoal"))[0];
        let env = &rooms.envs()[0];
        let (episode, semantics) = (env.episode(0).unwrap(), env.world().engines().semantics());
        let row = &dwell_semantics::room_kind::room_kinds().rows()[kind as usize - 1];
        assert!(
            episode.instruction.contains(row.singular),
            "{}",
            episode.instruction
        );
        for room in env.world().house().rooms.ids() {
            let is_asked = episode.goal.rooms.contains(&room);
            let of_kind = semantics
                .room(room)
                .kind
                .is_some_and(|kind| kind.name == row.name);
            assert_eq!(is_asked, of_kind, "{seed}");
        }
    }
}

/// The picture at the goal is the one that the agent sees when it stands there.
#[test]
fn an_image_goal_is_what_is_seen_there() {
    let mut batch = batch_of(dwell_tests::env_of("ImageNav", &["imagegoal", "rgb"]));
    for seed in 0..4 {
        batch.reset(&[Some(seed)]).unwrap();
        let goal = batch.envs()[0].episode(0).unwrap().goal.clone();
        let wanted = seen(&mut batch, "imagegoal");
        assert_ne!(seen(&mut batch, "rgb"), wanted);
        let env = batch.env_mut(0).unwrap();
        env.world_mut()
            .place_agent(AgentId(0), goal.position.unwrap(), goal.yaw_rad)
            .unwrap();
        let there = seen(&mut batch, "rgb");
        // The body, which the picture leaves out, takes a little light from other places.
        let other = there.iter().zip(&wanted).filter(|(a, b)| a != b).count();
        assert!(
            50 * other < wanted.len(),
            "{seed}: {other} of {}",
            wanted.len()
        );
        let distinct: std::collections::BTreeSet<&u8> = wanted.iter().collect();
        assert!(distinct.len() > 8, "{seed}: a picture of nothing");
    }
}

/// A source plays over the goal, and is heard there louder than at the start.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_sound_comes_from_the_goal() {
    let level = |settings: Value| {
        let mut batch = batch_of(env_with("AudioNav", settings, &["audio", "spectrogram"]));
        batch.reset(&[Some(3)]).unwrap();
        let wait = [Some(DiscreteAction::Wait)];
        let loudness = |batch: &mut Batch| {
            let mut sum = 0.0;
            for _ in 0..40 {
                batch.step(&wait).unwrap();
                let heard = floats(&seen(batch, "audio"));
                sum += heard
                    .iter()
                    .map(|x| f64::from(*x) * f64::from(*x))
                    .sum::<f64>();
            }
            sum
        };
        let env = &batch.envs()[0];
        let goal = env.episode(0).unwrap().goal.position.unwrap();
        let played = played(env);
        assert_eq!(played.len(), 1);
        let source = glam::Vec3::from_array(played[0].position);
        assert!((source - goal - glam::Vec3::Y * 1.5).length() < 1e-5);
        let far = loudness(&mut batch);
        let spectrum: f32 = floats(&seen(&mut batch, "spectrogram")).iter().sum();
        let env = batch.env_mut(0).unwrap();
        env.world_mut().place_agent(AgentId(0), goal, 0.0).unwrap();
        let near = loudness(&mut batch);
        assert!(near > 4.0 * far, "{near} {far}");
        let near_spectrum: f32 = floats(&seen(&mut batch, "spectrogram")).iter().sum();
        assert!(near_spectrum > spectrum);
        near
    };
    let loud = level(json!({"sounds": ["alarm"], "level_db": 110.0}));
    let soft = level(json!({"sounds": ["alarm"], "level_db": 90.0}));
    let louder_db = 10.0 * (loud / soft).log10();
    assert!((louder_db - 20.0).abs() < 0.5, "{louder_db} dB");
}

/// The thing that is asked for sounds as its kind does, and falls silent; others sound otherwise.
#[test]
fn a_thing_sounds_once_and_others_sound_otherwise() {
    let settings = json!({"distractors": 2});
    let mut env = env_with("SemanticAudioNav", settings, &[]);
    let mut classes = std::collections::BTreeSet::new();
    for seed in 0..10 {
        env.reset(seed).unwrap();
        let goal = env.episode(0).unwrap().goal.clone();
        classes.insert(goal.class);
        let played = played(&env);
        assert!(
            played.iter().all(|sound| !sound.loops) && played.len() == 3,
            "{seed}"
        );
        let (house, state) = (env.world().house(), env.world().state());
        let bounds = house.object_bounds(state, goal.objects[0]).grown(0.01);
        assert!(
            bounds.contains(glam::Vec3::from_array(played[0].position)),
            "{seed}"
        );
        let others = played[1..].iter();
        assert!(
            others.clone().all(|sound| sound.sound != played[0].sound),
            "{seed}"
        );
    }
    assert!(classes.len() > 2);
}

/// What does not exist is refused by name, and so is a sensor of goals that a task does not have.
#[test]
fn unknown_names_and_misplaced_sensors_are_refused() {
    let told = |task: &str, settings: Value, sensors: &[&str]| {
        let config = EnvConfig {
            task: task.to_owned(),
            task_settings: settings,
            ..EnvConfig::default()
        };
        let made = dwell_tests::try_env_in(dwell_tests::apartment(), config, sensors);
        made.unwrap_err().to_string()
    };
    assert!(told("RoomNav", json!({"rooms": ["castle"]}), &[]).contains("castle"));
    assert!(told("ObjectNav", json!({"classes": ["dragon"]}), &[]).contains("dragon"));
    assert!(told("AudioNav", json!({"sounds": ["dragon"]}), &[]).contains("dragon"));
    assert!(told("AudioNav", json!({"sounds": []}), &[]).contains("at least one signal"));
    assert!(told("AudioNav", json!({"level_db": 300.0}), &[]).contains("level_db"));
    assert!(told("SemanticAudioNav", json!({"distractors": 9}), &[]).contains("0 to 8"));
    assert!(
        told("PointNav", json!({"success_distance_m": 0.0}), &[]).contains("success_distance_m")
    );
    assert!(told("PointNav", json!({"reward": {"sucess": 1.0}}), &[]).contains("sucess"));
    assert_eq!(
        told("Free", Value::Null, &["objectgoal"]),
        "sensors is \"objectgoal\"; allowed is that with the task ObjectNav or SemanticAudioNav or Cooperate alone, not with Free"
    );
    let lacking = |settings: Value, task: &str| {
        let mut env = env_with(task, settings, &[]);
        env.reset(0).unwrap_err().to_string()
    };
    let told = lacking(json!({"rooms": ["freight_elevator"]}), "RoomNav");
    assert!(
        told.contains("it has no room of the kinds that are asked for"),
        "{told}"
    );
    let told = lacking(json!({"classes": ["motorcycle"]}), "ObjectNav");
    assert!(told.contains("it has no thing of the classes"), "{told}");
}
