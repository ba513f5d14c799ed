//! The promise of `docs/determinism.md`: an episode of 500 steps (its first 100 in `make test`), all of whose observations and states have the bits of the
//! golden digest, for any number of threads, in company or alone, in a fresh process, after a restored snapshot and after
//! another world ran in the same process.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "it tells its digests")]

use dwell::{Batch, DiscreteAction, Engines, Env, EnvConfig, WorldConfig};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, Locomotion};
use dwell_tests::law;
use dwell_tests::observations::observe;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

const STEPS: usize = 500;
/// Steps whose golden digest is of its own, so that `make test` need not play all.
const GOLDEN_STEPS: usize = 100;
/// Number of steps that are compared one by one where the whole episode would take too long.
const FIRST_STEPS: usize = 60;
const SEED: u64 = 2024;
/// Set for a process that plays again, to where its digests go.
const AGAIN: &str = "DWELL_DETERMINISM_OUT";
/// Writes golden files anew. The golden digest asks that its value says why.
const UPDATE: &str = "UPDATE_GOLDEN";

/// An environment with every sensor, noise in what it sees and hears, and wind.
fn noisy_env() -> Env {
    let laws = vec![
        law("shot_read_noise", &[("gain", 0.002), ("read", 0.01)]),
        law("kinect_depth", &[("axial", 1.0), ("lateral", 1.0)]),
        law("microphone_noise", &[("sigma_pa", 0.001)]),
        law("wind", &[("x_m_s", 0.5), ("area_m2", 0.02)]),
    ];
    let config = EnvConfig {
        task: "Free".to_owned(),
        world: WorldConfig {
            laws,
            ..WorldConfig::default()
        },
        ..EnvConfig::default()
    };
    dwell_tests::env_of_every_sensor(config)
}

fn batch(count: usize, threads: usize) -> Batch {
    let envs = (0..count).map(|_| noisy_env()).collect();
    Batch::new(envs, Threads::new(threads)).unwrap()
}

/// Everything but `stop`, walking more often than not.
fn actions() -> Vec<DiscreteAction> {
    let mut stream = RandomKey::root(31).child("actions").stream();
    let draw = |_| match stream.below(3) {
        0 => DiscreteAction::DEFAULT[1 + stream.below(DiscreteAction::DEFAULT.len() - 1)],
        _ => DiscreteAction::ALL[1 + stream.below(3)],
    };
    (0..STEPS).map(draw).collect()
}

/// A number for the state and all observations of environment `k` of several.
fn digest(batch: &mut Batch, k: usize) -> u64 {
    let count = batch.envs().len();
    let specs = batch.sensor_specs();
    let mut bytes = batch.envs()[k].world().hash().to_le_bytes().to_vec();
    for (sensor, (spec, seen)) in specs.iter().zip(observe(batch)).enumerate() {
        if spec.dtype == dwell::sensors::Dtype::Text {
            bytes.extend_from_slice(batch.text_observations(sensor)[k].as_bytes());
        } else {
            let one = seen.len() / count;
            bytes.extend_from_slice(&seen[k * one..(k + 1) * one]);
        }
    }
    xxh3_64(&bytes)
}

/// Plays `actions` in all environments; the digests of environment `k` after each.
fn play(batch: &mut Batch, k: usize, actions: &[DiscreteAction]) -> Vec<u64> {
    let count = batch.envs().len();
    let mut digests = Vec::with_capacity(actions.len());
    for action in actions {
        batch.step(&vec![Some(*action); count]).unwrap();
        digests.push(digest(batch, k));
    }
    digests
}

/// Plays the first [`GOLDEN_STEPS`]; all with `DWELL_TEST_ALL=1`, and where golden digests are written.
fn episode(threads: usize) -> Vec<u64> {
    let whole = dwell_tests::runs_all() || std::env::var_os(UPDATE).is_some();
    let steps = if whole { STEPS } else { GOLDEN_STEPS };
    let mut batch = batch(1, threads);
    batch.reset(&[Some(SEED)]).unwrap();
    play(&mut batch, 0, &actions()[..steps])
}

/// Asserts that two episodes are equal, or names the step at which they part.
fn assert_same(found: &[u64], expected: &[u64], what: &str) {
    let apart = found.iter().zip(expected).position(|(a, b)| a != b);
    assert_eq!(apart, None, "{what}: the step at which bits differ");
    assert_eq!(found.len(), expected.len(), "{what}");
}

fn one_number(digests: &[u64]) -> u64 {
    let bytes: Vec<u8> = digests.iter().flat_map(|one| one.to_le_bytes()).collect();
    xxh3_64(&bytes)
}

/// The kind of machine whose digest is committed; others are on their own, since the Fourier transforms of sound differ.
fn is_the_golden_kind() -> bool {
    #[cfg(all(target_arch = "x86_64", target_os = "linux"))]
    return is_x86_feature_detected!("avx") && is_x86_feature_detected!("fma");
    #[cfg(not(all(target_arch = "x86_64", target_os = "linux")))]
    return false;
}

/// Compares with the last line of a golden file, `DIGEST  WHY`, or adds one where [`UPDATE`] says why.
fn check_golden(file: &str, digest: u64) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("digests")
        .join(file);
    if !is_the_golden_kind() {
        println!("skipped: the golden digest is of x86-64 Linux with AVX and FMA");
        return;
    }
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let golden = text.lines().last().and_then(|line| line.split_once("  "));
    let found = format!("{digest:016x}");
    if golden.is_some_and(|(golden, _)| golden == found) {
        return;
    }
    let why = std::env::var(UPDATE).unwrap_or_default();
    assert!(
        why.trim().len() >= 10,
        "the episode has the digest {found}, not {golden:?}. If it changed on purpose, {UPDATE}=\"why it changed\" writes it \
         to tests/digests/{file}"
    );
    std::fs::write(&path, format!("{text}{found}  {}\n", why.trim())).unwrap();
}

#[test]
fn an_episode_has_the_bits_of_the_golden_digest_in_every_process_and_for_any_number_of_threads() {
    if let Some(out) = std::env::var_os(AGAIN) {
        let text: Vec<String> = episode(7).iter().map(u64::to_string).collect();
        std::fs::write(out, text.join("\n")).unwrap();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("digests");
    // A test's thread has the test's path as its name.
    let this = std::thread::current();
    let mut other = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", this.name().unwrap()])
        .env(AGAIN, &out)
        .spawn()
        .unwrap();
    let first = episode(1);
    assert!(other.wait().unwrap().success());
    let again: Vec<u64> = std::fs::read_to_string(&out)
        .unwrap()
        .lines()
        .map(|line| line.parse().unwrap())
        .collect();
    assert_same(&again, &first, "7 threads in a fresh process");
    let mut different = first.clone();
    different.sort_unstable();
    different.dedup();
    assert_eq!(
        different.len(),
        first.len(),
        "every step is told from every other"
    );
    check_golden("first_steps.txt", one_number(&first[..GOLDEN_STEPS]));
    if first.len() == STEPS {
        check_golden("episode.txt", one_number(&first));
    }
}

/// In company, after another house was played in with other laws by another body, and on after a snapshot that went through
/// bytes while the world went astray.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn company_other_worlds_and_snapshots_change_no_bit() {
    let actions = &actions()[..FIRST_STEPS];
    let mut alone = batch(1, 2);
    alone.reset(&[Some(SEED)]).unwrap();
    let expected = play(&mut alone, 0, actions);

    let (house, _) = dwell_houses::open("seed:11?home=studio").unwrap();
    let robot = AgentBody {
        locomotion: Locomotion::DifferentialDrive(dwell_scene::DifferentialDrive::default()),
        ..AgentBody::default()
    };
    let elsewhere = EnvConfig {
        task: "Free".to_owned(),
        world: WorldConfig {
            agents: vec![robot],
            laws: vec![law("drag", &[("c_d", 1.0), ("area_m2", 0.1)])],
            ..WorldConfig::default()
        },
        ..EnvConfig::default()
    };
    let other = Env::new(Engines::new(Arc::new(house)), &elsewhere).unwrap();
    let mut other = Batch::new(vec![other], Threads::new(2)).unwrap();
    other.reset(&[Some(5)]).unwrap();
    let mut company = batch(3, 2);
    company
        .reset(&[Some(SEED + 1), Some(SEED), Some(SEED + 2)])
        .unwrap();
    let mut found = Vec::new();
    let mut kept = Vec::new();
    for (k, action) in actions.iter().enumerate() {
        if k == FIRST_STEPS / 2 {
            kept = company.env(1).unwrap().snapshot().unwrap();
        }
        other.step(&[Some(actions[FIRST_STEPS - 1 - k])]).unwrap();
        found.extend(play(&mut company, 1, &[*action]));
    }
    assert_same(&found, &expected, "in company, beside another house");

    let half = FIRST_STEPS / 2;
    let mut astray = batch(1, 7);
    astray.reset(&[Some(99)]).unwrap();
    play(&mut astray, 0, &actions[..5]);
    astray.restore(0, &kept).unwrap();
    let found = play(&mut astray, 0, &actions[half..]);
    assert_same(&found, &expected[half..], "after a snapshot");
}
