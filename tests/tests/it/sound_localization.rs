//! The task of saying where a sound is, against geometry worked out another way and against the ears.

use dwell::{Batch, DiscreteAction, Env, EnvConfig, StepAction, StepInfo};
use dwell_scene::AgentId;
use dwell_scene::parallel::Threads;
use dwell_tests::observations::observe;
use glam::{Quat, Vec3};
use serde_json::{Value, json};

fn env(settings: Value) -> Env {
    let config = EnvConfig {
        task: "SoundLocalization".to_owned(),
        task_settings: settings,
        ..EnvConfig::default()
    };
    dwell_tests::env_with(config, &["audio"])
}

fn stop(answer: [f32; 4]) -> StepAction {
    StepAction {
        answer,
        ..DiscreteAction::Stop.into()
    }
}

fn answered(env: &mut Env, seed: u64, answer: [f32; 4]) -> StepInfo {
    begin(env, seed);
    let infos = env.step(&[Some(stop(answer))]);
    infos.expect("an episode runs").remove(0)
}

/// Begins an episode and lets the agent come to rest.
fn begin(env: &mut Env, seed: u64) {
    env.reset(seed).expect("the task can be played");
    for _ in 0..4 {
        env.step(&[Some(DiscreteAction::Wait)])
            .expect("an episode runs");
    }
}

/// The source that plays, m.
fn source(env: &Env) -> Vec3 {
    let own = env.world().house().emitters.len() as u64;
    let played: Vec<Vec3> = env
        .world()
        .sounds()
        .into_iter()
        .filter(|sound| sound.handle >= own)
        .map(|sound| Vec3::from_array(sound.position))
        .collect();
    assert_eq!(played.len(), 1);
    played[0]
}

/// The expert's answer, turned into a point by rotations, is the source; it is as far and as high as the settings say, and in sight.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_right_answer_points_at_the_source() {
    let mut env = env(json!({"min_distance_m": 1.0, "max_distance_m": 4.0, "min_height_m": 0.5}));
    let (mut left, mut above) = (0, 0);
    for seed in 0..40 {
        begin(&mut env, seed);
        let [azimuth, elevation, distance_m, class] = env.expert_step(0).unwrap().answer;
        let agent = env.world().state().agents[AgentId(0)];
        let turn =
            Quat::from_rotation_y(agent.yaw_rad + azimuth) * Quat::from_rotation_x(elevation);
        let point = agent.eye_position() + turn * Vec3::NEG_Z * distance_m;
        let truth = source(&env);
        assert!((point - truth).length() < 1e-3, "{seed}: {point} {truth}");
        assert!((1.0..=4.0).contains(&distance_m));
        let height_m = truth.y - agent.position.y;
        assert!((0.45..=2.05).contains(&height_m), "{height_m}");
        left += u32::from(azimuth > 0.0);
        above += u32::from(elevation > 0.0);
        assert!((0.0..8.0).contains(&class));
        let info = env
            .step(&[Some(stop([azimuth, elevation, distance_m, class]))])
            .unwrap()
            .remove(0);
        assert!(info.result.success && info.result.terminated);
        // The agent may still come to rest by fractions of a millimetre.
        assert!(
            info.measures[..3].iter().all(|error| *error < 0.05),
            "{:?}",
            info.measures
        );
        assert!(info.measures[3] < 1e-4);
        assert_eq!(info.measures[4], 1.0);
    }
    // On both sides, above and below the head, in 40 episodes.
    assert!(
        (8..=32).contains(&left) && (2..=38).contains(&above),
        "{left} {above}"
    );
}

/// Errors are those of spherical trigonometry, success is decided by the settings' angle and class, and rewards are the settings'.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn errors_are_angles_on_the_sphere() {
    let settings = json!({
        "success_angle_deg": 25.0,
        "reward": {"angle": -0.01, "step": -0.25, "success": 3.0}
    });
    let mut env = env(settings);
    for seed in 0..12 {
        begin(&mut env, seed);
        let [azimuth, elevation, distance_m, class] = env.expert_step(0).unwrap().answer;
        for (turn, rise) in [(0.2_f32, 0.1_f32), (0.4, -0.1), (-3.0, 0.3), (0.0, -0.6)] {
            let told = [azimuth + turn, elevation + rise, 1.5 * distance_m, class];
            let info = answered(&mut env, seed, told);
            // Haversines (R. W. Sinnott, Sky and Telescope 68, 1984), where the engine takes half angles between vectors.
            let half = |angle: f32| f64::from(angle / 2.0).sin().powi(2);
            let level = f64::from(elevation).cos() * f64::from(elevation + rise).cos();
            let expected_deg = 2.0 * (half(rise) + level * half(turn)).sqrt().asin().to_degrees();
            let [azimuth_deg, elevation_deg, angular_deg, distance, right] = info.measures[..]
            else {
                panic!("{:?}", info.measures);
            };
            assert!((azimuth_deg - f64::from(turn.abs()).to_degrees()).abs() < 1e-3);
            assert!((elevation_deg - f64::from(rise.abs()).to_degrees()).abs() < 1e-3);
            assert!(
                (angular_deg - expected_deg).abs() < 0.02,
                "{angular_deg} {expected_deg}"
            );
            assert!((distance - 0.5).abs() < 1e-3);
            assert_eq!(right, 1.0);
            assert_eq!(info.result.success, expected_deg < 25.0);
            let paid = -0.25 - 0.01 * expected_deg + if expected_deg < 25.0 { 3.0 } else { 0.0 };
            assert!((info.result.reward - paid).abs() < 1e-3);
        }
        let other = answered(
            &mut env,
            seed,
            [azimuth, elevation, distance_m, 7.0 - class],
        );
        assert!(!other.result.success && other.measures[4] == 0.0);
        let none = answered(&mut env, seed, [f32::NAN; 4]);
        assert!(!none.result.success && none.measures.iter().all(|error| error.is_nan()));
        assert!((none.result.reward + 0.25 + 1.8).abs() < 1e-9);
    }
    let mut any_class = self::env(json!({"needs_class": false}));
    begin(&mut any_class, 1);
    let [azimuth, elevation, distance_m, class] = any_class.expert_step(0).unwrap().answer;
    let told = [azimuth, elevation, distance_m, 7.0 - class];
    assert!(answered(&mut any_class, 1, told).result.success);
}

/// The ear on the side that the answer says is the louder one.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_nearer_ear_hears_it_louder() {
    // A noise of all frequencies near the head: further away, or with tones, the room decides which ear hears more.
    let settings = json!({"sounds": ["vacuum_cleaner"], "max_distance_m": 1.0});
    let mut batch = Batch::new(vec![env(settings)], Threads::ONE).unwrap();
    let (mut sides, mut right) = (0, 0);
    for seed in 0..24 {
        batch.reset(&[Some(seed)]).unwrap();
        let azimuth = batch.expert_answers().unwrap()[0][0];
        // Near the middle the room decides.
        if azimuth.sin().abs() < 0.5 {
            continue;
        }
        let mut energy = [0.0_f64; 2];
        for _ in 0..30 {
            batch.step(&[Some(DiscreteAction::Wait)]).unwrap();
            let bytes = observe(&mut batch).remove(0);
            let samples: Vec<f32> = bytes
                .chunks_exact(4)
                .map(|word| f32::from_le_bytes(word.try_into().unwrap()))
                .collect();
            for (ear, part) in energy.iter_mut().zip(samples.chunks(samples.len() / 2)) {
                *ear += part.iter().map(|x| f64::from(x * x)).sum::<f64>();
            }
        }
        sides += 1;
        right += usize::from((energy[0] > energy[1]) == (azimuth > 0.0));
    }
    // Walls close by turn it around now and then. Ears that know nothing would be as often right in two of a thousand series.
    let by_chance: f64 = (right..=sides).map(|k| binomial_half(sides, k)).sum();
    assert!(sides >= 12 && by_chance < 0.002, "{right} of {sides}");
}

/// The probability of `k` heads in `n` throws of a coin.
fn binomial_half(n: usize, k: usize) -> f64 {
    let ways: f64 = (0..k).map(|j| (n - j) as f64 / (k - j) as f64).product();
    ways * 0.5_f64.powi(n as i32)
}

#[test]
fn settings_that_no_episode_can_keep_to_are_refused() {
    let told = |settings: Value| {
        let config = EnvConfig {
            task: "SoundLocalization".to_owned(),
            task_settings: settings,
            ..EnvConfig::default()
        };
        let mut env = dwell_tests::try_env_in(dwell_tests::apartment(), config, &[])
            .map_err(|e| e.to_string())?;
        env.reset(0).map_err(|error| error.to_string())
    };
    for (settings, part) in [
        (json!({"sounds": []}), "at least one signal"),
        (
            json!({"sounds": ["vacuum_cleaner", "vacuum_cleaner"]}),
            "each sound once",
        ),
        (json!({"sounds": ["no"]}), "no"),
        (json!({"max_distance_m": 60.0}), "max_distance_m is 60"),
        (json!({"min_distance_m": 7.0}), "min_distance_m is 7"),
        (json!({"min_height_m": 3.0}), "min_height_m is 3"),
        (
            json!({"success_angle_deg": 200.0}),
            "success_angle_deg is 200",
        ),
        (json!({"reward": {"angle": 1e9}}), "reward.angle"),
        (
            json!({"min_distance_m": 49.0, "max_distance_m": 50.0}),
            "no place for an agent",
        ),
    ] {
        let error = told(settings).unwrap_err();
        assert!(error.contains(part), "{error}");
    }
}
