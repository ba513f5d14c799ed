//! Episodes that state their start and goal begin, go on and end as drawn ones do.

use dwell::{
    Batch, DiscreteAction, Env, EnvConfig, EpisodeSpec, GoalField, StatedGoal, StatedStart,
    WorldError, tasks,
};
use dwell_scene::AgentId;
use dwell_scene::parallel::Threads;
use dwell_tests::observations::{goal_sensors, observe};
use glam::Vec3;
use serde_json::{Value, json};

/// An environment in which nobody's doors are in the way: all stand open.
fn env(task: &str, sensors: &[&str]) -> Env {
    let config = EnvConfig {
        task: task.to_owned(),
        task_settings: json!({"open_doors": true}),
        ..EnvConfig::default()
    };
    dwell_tests::env_with(config, sensors)
}

/// What the episode of an environment would state, had it not been drawn.
fn drawn(env: &Env) -> EpisodeSpec {
    let episode = env.episode(0).expect("an episode has begun");
    let agent = env.world().state().agents[AgentId(0)];
    let goal = match episode.goal.kind {
        "object" => StatedGoal {
            class: episode.goal.class_name().map(str::to_owned),
            ..StatedGoal::default()
        },
        _ => StatedGoal {
            position: episode.goal.position.map(|place| place.to_array()),
            ..StatedGoal::default()
        },
    };
    EpisodeSpec {
        start: Some(StatedStart {
            position: agent.position.to_array(),
            yaw_rad: Some(agent.yaw_rad),
            ..StatedStart::default()
        }),
        goal: Some(goal),
    }
}

/// Steps between those of which observations are compared; states are compared at each.
const OBSERVED_EVERY: usize = 12;

/// The steps of the expert, at most so many: hashes, what is observed at times, success and SPL.
fn played(batch: &mut Batch, most: usize) -> (Vec<u64>, Vec<Vec<Vec<u8>>>, bool, f64) {
    let (mut hashes, mut seen) = (Vec::new(), Vec::new());
    for step in 0..most {
        hashes.push(batch.envs()[0].world().hash());
        if step % OBSERVED_EVERY == 0 {
            seen.push(observe(batch));
        }
        let action = batch.expert_actions().expect("an episode runs")[0];
        let infos = batch.step(&[Some(action)]).expect("an expert's action");
        let info = infos[0].as_ref().expect("the environment stepped");
        if info.result.terminated {
            seen.push(observe(batch));
            let spl = info.progress.spl(info.result.success);
            return (hashes, seen, info.result.success, spl);
        }
    }
    (hashes, seen, false, f64::NAN)
}

/// With the same seed a stated episode has the bits of the drawn one: observations, states, SPL.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn an_episode_that_states_what_was_drawn_is_the_drawn_one() {
    for task in ["PointNav", "ObjectNav", "AudioNav"] {
        let mut sensors = vec!["gps", "compass"];
        sensors.push(if task == "AudioNav" { "audio" } else { "rgb" });
        sensors.extend(goal_sensors(tasks::find(task).unwrap()));
        let one = || Batch::new(vec![env(task, &sensors)], Threads::ONE).unwrap();
        let (mut first, mut second) = (one(), one());
        first.reset(&[Some(5)]).unwrap();
        let spec = drawn(&first.envs()[0]);
        // Nothing of an episode before is left.
        second.reset(&[Some(8)]).unwrap();
        second
            .reset_stated(&[Some(5)], &[vec![spec.clone()]])
            .unwrap();
        // Sound takes its time.
        let most = if task == "AudioNav" { 25 } else { 400 };
        let (hashes, seen, success, spl) = played(&mut first, most);
        assert_eq!(success, task != "AudioNav");
        let (own_hashes, own_seen, own_success, own_spl) = played(&mut second, most);
        assert_eq!(own_hashes, hashes, "{task}");
        assert!(own_seen == seen, "{task}");
        assert_eq!((own_success, own_spl.to_bits()), (success, spl.to_bits()));
        // Of another seed only what was not stated differs.
        let mut other = env(task, &sensors);
        other.reset_stated(77, &[spec]).unwrap();
        first.reset(&[Some(5)]).unwrap();
        let (own, drawn) = (
            other.episode(0).unwrap(),
            first.envs()[0].episode(0).unwrap(),
        );
        assert_eq!((own.start, &own.goal), (drawn.start, &drawn.goal));
        assert_eq!(own.progress, drawn.progress);
        assert_eq!(own.instruction, drawn.instruction);
    }
}

/// A start alone leaves the goal to the seed, and a goal alone the start.
#[test]
fn what_is_not_stated_is_drawn() {
    let mut env = env("PointNav", &["gps"]);
    env.reset(1).unwrap();
    let whole = drawn(&env);
    let start = EpisodeSpec {
        goal: None,
        ..whole.clone()
    };
    let goal = EpisodeSpec {
        start: None,
        ..whole
    };
    let (mut starts, mut goals) = (Vec::new(), Vec::new());
    for seed in 2..8 {
        env.reset_stated(seed, std::slice::from_ref(&start))
            .unwrap();
        let (own, pose) = (env.episode(0).unwrap(), env.episode(0).unwrap().start);
        assert_eq!(
            Some(pose.position.to_array()),
            start.start.map(|s| s.position)
        );
        let way_m = own.progress.start_distance_m.unwrap();
        assert!((1.0..=30.0).contains(&way_m));
        goals.push(own.goal.position.unwrap());
        env.reset_stated(seed, std::slice::from_ref(&goal)).unwrap();
        let own = env.episode(0).unwrap();
        let stated = goal.goal.as_ref().and_then(|goal| goal.position);
        assert_eq!(own.goal.position.map(|at| at.to_array()), stated);
        starts.push(own.start.position);
    }
    assert!(goals.iter().any(|at| *at != goals[0]));
    assert!(starts.iter().any(|at| *at != starts[0]));
}

/// A snapshot holds what is stated: another environment goes on with the same bits.
#[test]
fn a_stated_episode_goes_on_from_a_snapshot() {
    let mut env = env("PointNav", &["pointgoal_with_gps_compass"]);
    env.reset(3).unwrap();
    let spec = drawn(&env);
    env.reset_stated(12, &[spec]).unwrap();
    env.step(&[Some(DiscreteAction::MoveForward)]).unwrap();
    let saved = env.snapshot().unwrap();
    let mut other = self::env("PointNav", &["pointgoal_with_gps_compass"]);
    other.restore(&saved).unwrap();
    assert_eq!(other.episode(0).unwrap().goal, env.episode(0).unwrap().goal);
    assert_eq!(
        other.expert_actions().unwrap(),
        env.expert_actions().unwrap()
    );
    let steps = [&mut env, &mut other].map(|one| {
        let info = one.step(&[Some(DiscreteAction::MoveForward)]).unwrap();
        (one.world().hash(), info)
    });
    assert_eq!(steps[0], steps[1]);
}

/// Things may be stated by ids and by where they are: these alone count.
#[test]
fn things_are_stated_by_ids_and_places() {
    let mut env = env("ObjectNav", &["objectgoal"]);
    let house = env.world().house().clone();
    let mut seeds = 0..200;
    let several = seeds
        .find(|seed| env.reset(*seed).is_ok() && env.episode(0).unwrap().goal.objects.len() > 1);
    env.reset(several.expect("a class with several things"))
        .unwrap();
    let class = env
        .episode(0)
        .unwrap()
        .goal
        .class_name()
        .unwrap()
        .to_owned();
    let all = env.episode(0).unwrap().goal.objects.clone();
    let mut found = 0;
    let beds = json!({"goal": {"class": "bed", "also": ["double_bed", "single_bed"]}});
    env.reset_stated(4, &[EpisodeSpec::from_json(&beds).unwrap()])
        .unwrap();
    let asked = &env.episode(0).unwrap().goal;
    assert_eq!(asked.class_name(), Some("bed"));
    assert!(
        asked
            .objects
            .iter()
            .all(|thing| house.objects[*thing].name.contains("bed"))
    );
    for thing in &all {
        let middle = house.object_bounds(env.world().state(), *thing).center();
        let by_id = json!({"goal": {"objects": [house.entity_of_object(*thing).0]}});
        let by_place = json!({"goal": {"class": class, "positions": [middle.to_array()]}});
        for spec in [by_id, by_place] {
            let spec = EpisodeSpec::from_json(&spec).unwrap();
            // Some things nobody can stand near; those are refused.
            if env.reset_stated(4, &[spec]).is_ok() {
                assert_eq!(env.episode(0).unwrap().goal.objects, [*thing]);
                found += 1;
            }
        }
    }
    assert!(found >= 2 && found % 2 == 0, "{found} of {}", all.len());
}

fn told(env: &mut Env, spec: &Value) -> String {
    let spec = EpisodeSpec::from_json(spec).expect("its fields are right");
    let error = env.reset_stated(1, &[spec]);
    assert!(env.episode(0).is_err());
    error.expect_err("the house lacks it").to_string()
}

#[test]
fn what_the_house_does_not_have_is_told() {
    let mut point = env("PointNav", &["gps"]);
    point.reset(1).unwrap();
    let here = point.world().state().agents[AgentId(0)].position;
    let up = (here + Vec3::Y * 0.8).to_array();
    let error = told(&mut point, &json!({"start": {"position": up}}));
    assert!(error.starts_with("episode.start.position is ["), "{error}");
    let nearest = format!("the nearest is {:?}, 0.80 m away", here.to_array());
    assert!(error.ends_with(&nearest), "{error}");
    let error = told(
        &mut point,
        &json!({"goal": {"position": [500.0, 0.0, 0.0]}}),
    );
    assert!(
        error.starts_with("episode.goal.position is [500.0, 0.0, 0.0]"),
        "{error}"
    );
    let error = told(&mut point, &json!({"goal": {"class": "bed"}}));
    assert!(
        error.ends_with("allowed is of PointNav one with position"),
        "{error}"
    );
    let error = told(&mut point, &json!({"goal": {}}));
    assert!(error.contains("without a position"), "{error}");

    let mut object = env("ObjectNav", &["gps"]);
    let house = object.world().house();
    let last = house.objects.ids().last().expect("the house has things");
    let beyond = house.entity_of_object(last).0 + 1;
    for (goal, expected) in [
        (
            json!({"class": "chairs and tables"}),
            "no class \"chairs and tables\"; of the ",
        ),
        (
            json!({"class": "treadmill"}),
            "allowed is a class that the house has: ",
        ),
        (
            json!({"objects": [beyond]}),
            "allowed is ids of the house's",
        ),
        (
            json!({"class": "sofa", "positions": [[0, 50, 0]]}),
            "within 0.5 m of a thing of the class \"sofa\"",
        ),
        (
            json!({"positions": [[0, 0, 0]]}),
            "one of ObjectNav with a class, or with objects",
        ),
        (
            json!({"objects": [0], "positions": [[0, 0, 0]]}),
            "allowed is one of the two",
        ),
        (
            json!({"sound": "alarm"}),
            "one with class, also, objects, positions",
        ),
    ] {
        let error = told(&mut object, &json!({ "goal": goal }));
        assert!(error.contains(expected), "{error}");
    }

    let mut sound = env("AudioNav", &["gps"]);
    let at = here.to_array();
    for (more, expected) in [
        (json!({"sound": "fanfare"}), "fanfare"),
        (
            json!({"sound": "alarm", "sound_file": "a.wav"}),
            "one with sound and sound_file",
        ),
        (
            json!({"sound_file": "a.wav"}),
            "a recording has no usual level",
        ),
        (
            json!({"sound_file": "a.wav", "level_db": 70.0}),
            "sound_root",
        ),
        (json!({"level_db": 900.0}), "level_db is 900"),
    ] {
        let mut goal = json!({ "position": at });
        goal.as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        let error = told(&mut sound, &json!({ "goal": goal }));
        assert!(error.contains(expected), "{error}");
    }
}

/// Of floors between which there is no way, one is no goal for who starts on the other.
#[test]
fn a_goal_without_a_way_is_told() {
    let mut env = env("PointNav", &["gps"]);
    env.reset(1).unwrap();
    let grid = env
        .world()
        .engines()
        .nav_grid(&env.world().state().agents[AgentId(0)].body)
        .unwrap();
    let away = grid.walkable().find(|cell| grid.island(*cell) != Some(0));
    let away = grid.position(away.expect("a second island")).to_array();
    let mut spec = drawn(&env);
    spec.goal = Some(StatedGoal {
        position: Some(away),
        ..StatedGoal::default()
    });
    let error = env.reset_stated(1, &[spec]).unwrap_err().to_string();
    assert!(
        error.starts_with("episode.goal is one to which no way leads from the start"),
        "{error}"
    );
}

/// Every task takes stated episodes, or refuses them with a sentence: none plays something else.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn tasks_that_draw_everything_refuse_stated_episodes() {
    for kind in tasks::all().iter().filter(|kind| kind.min_agents == 1) {
        let mut env = dwell_tests::env_of(kind.name, &["gps"]);
        let spec = json!({"goal": {"position": [0.0, 500.0, 0.0]}});
        let spec = EpisodeSpec::from_json(&spec).unwrap();
        let error = env.reset_stated(1, &[spec]).unwrap_err();
        assert!(
            matches!(error, WorldError::Config { .. }),
            "{}: {error}",
            kind.name
        );
    }
}

/// A sound that is stated to come later and to end is heard then, and at no other time; a snapshot goes on with it.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_sound_begins_and_ends_when_it_is_stated() {
    let mut batch = Batch::new(vec![env("AudioNav", &["audio"])], Threads::ONE).unwrap();
    batch.reset(&[Some(3)]).unwrap();
    let mut spec = drawn(&batch.envs()[0]);
    let goal = spec.goal.as_mut().unwrap();
    (goal.sound, goal.level_db) = (Some("vacuum_cleaner".to_owned()), Some(110.0));
    (goal.offset_s, goal.duration_s) = (Some(0.5), Some(1.0));
    (spec.start.as_mut().unwrap()).position = goal.position.unwrap();
    batch.reset_stated(&[Some(3)], &[vec![spec]]).unwrap();
    let wait = [Some(DiscreteAction::Wait)];
    let energy = |batch: &mut Batch| {
        batch.step(&wait).unwrap();
        let bytes = observe(batch).swap_remove(0);
        let samples = bytes
            .chunks_exact(4)
            .map(|word| f64::from(f32::from_le_bytes(word.try_into().expect("four bytes"))));
        samples.map(|sample| sample * sample).sum::<f64>()
    };
    let rate_hz = 20.0;
    let mut heard = Vec::new();
    let mut saved = None;
    for step in 0..60 {
        heard.push(energy(&mut batch));
        if step == 15 {
            saved = Some(batch.envs()[0].snapshot().unwrap());
        }
    }
    let loudest = heard.iter().copied().fold(0.0, f64::max);
    let loud: Vec<usize> = (0..heard.len())
        .filter(|k| heard[*k] > 0.01 * loudest)
        .collect();
    let (first, last) = (
        loud[0] as f64 / rate_hz,
        loud[loud.len() - 1] as f64 / rate_hz,
    );
    // A window of `audio` is longer than a step, and rooms ring on.
    assert!((0.45..=0.6).contains(&first), "{first} s: {heard:?}");
    assert!((1.4..=2.2).contains(&last), "{last} s: {heard:?}");
    batch.restore(0, &saved.unwrap()).unwrap();
    let again: Vec<f64> = (16..60).map(|_| energy(&mut batch)).collect();
    assert_eq!(again, heard[16..]);
}

/// Goals that are stated go to the sensors of goals as drawn ones do.
#[test]
fn sensors_of_goals_tell_stated_goals() {
    let kind = tasks::find("PointNav").unwrap();
    assert_eq!(kind.goal_parts, [GoalField::Position]);
    let mut batch = Batch::new(
        vec![env("PointNav", &["pointgoal_with_gps_compass"])],
        Threads::ONE,
    )
    .unwrap();
    batch.reset(&[Some(2)]).unwrap();
    let mut spec = drawn(&batch.envs()[0]);
    let start = spec.start.as_mut().unwrap();
    (start.yaw_rad, start.yaw_deg) = (None, Some(90.0));
    let goal = Vec3::from_array(spec.goal.as_ref().unwrap().position.unwrap());
    let from = Vec3::from_array(start.position);
    batch.reset_stated(&[Some(9)], &[vec![spec]]).unwrap();
    let bytes = observe(&mut batch).swap_remove(0);
    let told: Vec<f32> = bytes
        .chunks_exact(4)
        .map(|word| f32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect();
    // Who faces left, along -X, has +Z to the left.
    let (ahead, left) = (from.x - goal.x, goal.z - from.z);
    assert!((told[0] - ahead.hypot(left)).abs() < 1e-4, "{told:?}");
    let off = told[1] - left.atan2(ahead);
    assert!(off.abs() < 1e-4, "{told:?}");
}
