//! Plays the expert of a task and random actions in houses of the split `val`, and says how often both succeed.
//!
//! `cargo run -p dwell-tests --example task_baselines -- TASK [FROM..TO [EPISODES]]`: by default the first 50 houses of the split with 20
//! episodes each.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{DiscreteAction, Engines, Env, EnvConfig};
use dwell_scene::random::{RandomKey, RandomStream};
use std::sync::Arc;

/// Every tenth seed is a house of the split: those that end in this digit.
const DIGIT: u64 = 8;

/// What came of some episodes.
#[derive(Debug, Default)]
struct Tally {
    solved: u32,
    steps: u64,
    all: u32,
}

impl Tally {
    fn says(&self, who: &str) {
        let mean = self.steps as f64 / f64::from(self.all.max(1));
        println!(
            "{who}: {} of {}, {mean:.0} steps each",
            self.solved, self.all
        );
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let task = words.first().ok_or("a task is needed")?;
    let houses = words.get(1).map_or("0..50", String::as_str);
    let (from, to) = houses
        .split_once("..")
        .ok_or("houses are written FROM..TO")?;
    let (from, to): (u64, u64) = (from.parse()?, to.parse()?);
    let episodes: u64 = words.get(2).map_or(Ok(20), |count| count.parse())?;
    let config = EnvConfig {
        task: task.clone(),
        sensors: Some(Vec::new()),
        ..EnvConfig::default()
    };
    let choices = config.chosen_actions(0)?;
    let most_steps = dwell::tasks::find(task)?.max_steps;
    let (mut expert, mut random, mut refused) = (Tally::default(), Tally::default(), 0);
    for house in from..to {
        let name = format!("seed:{}?split=val", 10 * house + DIGIT);
        let (opened, _) = dwell_houses::open(&name)?;
        let mut env = Env::new(Engines::new(Arc::new(opened)), &config)?;
        for seed in 0..episodes {
            if let Err(error) = env.reset(seed) {
                println!("{name}, episode {seed}: {error}");
                refused += 1;
                continue;
            }
            if !play(&mut env, (&choices, most_steps), None, &mut expert)? {
                println!("{name}, episode {seed}: not solved");
            }
            env.reset(seed)?;
            let stream = RandomKey::root(seed).child("random").child(house).stream();
            play(&mut env, (&choices, most_steps), Some(stream), &mut random)?;
        }
    }
    println!("{refused} episodes could not be played");
    expert.says("expert");
    random.says("random");
    Ok(())
}

/// Plays an episode by the expert, or with a stream by random actions; returns whether it succeeds.
fn play(
    env: &mut Env,
    (choices, most_steps): (&[DiscreteAction], u64),
    mut stream: Option<RandomStream>,
    tally: &mut Tally,
) -> Result<bool, dwell::WorldError> {
    tally.all += 1;
    for _ in 0..most_steps {
        let action = match &mut stream {
            None => env.expert_action(0)?,
            Some(stream) => choices[stream.below(choices.len())],
        };
        let result = env.step(&[Some(action)])?[0].result;
        tally.steps += 1;
        if result.terminated {
            tally.solved += u32::from(result.success);
            return Ok(result.success);
        }
    }
    Ok(false)
}
