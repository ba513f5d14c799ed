//! Plays tasks of several agents in houses of the split `val`, by experts and by random actions, and says what each agent reached.
//!
//! `cargo run -p dwell-tests --example team_baselines -- TASK WHO [FROM..TO [EPISODES [SETTINGS]]]`: WHO has a letter for each agent, `e` for
//! its expert, `r` for random actions, `w` for random actions other than stop, `s` for one that stands still; by default the first 20 houses of the split with 5
//! episodes each. SETTINGS are those of the task, as JSON.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{AgentConfig, DiscreteAction, Engines, Env, EnvConfig, StepAction, WorldConfig};
use dwell_scene::AgentBody;
use dwell_scene::random::RandomKey;
use std::sync::Arc;

/// Every tenth seed is a house of the split: those that end in this digit.
const DIGIT: u64 = 8;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (Some(task), Some(who)) = (words.first(), words.get(1)) else {
        return Err("a task is needed, and who plays: ee, er, ...".into());
    };
    let houses = words.get(2).map_or("0..20", String::as_str);
    let (from, to) = houses
        .split_once("..")
        .ok_or("houses are written FROM..TO")?;
    let (from, to): (u64, u64) = (from.parse()?, to.parse()?);
    let episodes: u64 = words.get(3).map_or(Ok(5), |count| count.parse())?;
    let settings = words.get(4).map_or("null", String::as_str);
    let who: Vec<char> = who.chars().collect();
    let role = |agent| AgentConfig {
        agent,
        ..AgentConfig::default()
    };
    let config = EnvConfig {
        task: task.clone(),
        task_settings: serde_json::from_str(settings)?,
        sensors: Some(Vec::new()),
        world: WorldConfig {
            agents: vec![AgentBody::default(); who.len()],
            ..WorldConfig::default()
        },
        agents: (0..who.len() as u32).map(role).collect(),
        ..EnvConfig::default()
    };
    let choices = config.chosen_actions(0)?;
    let kind = dwell::tasks::find(task)?;
    let (mut played, mut refused, mut steps) = (0_u32, 0_u32, 0_u64);
    let mut solved = vec![0_u32; who.len()];
    let mut paid = vec![0.0; who.len()];
    let mut measures = vec![(0.0, 0_u32); kind.measures.len()];
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
            let mut stream = RandomKey::root(seed).child("random").child(house).stream();
            let mut last = Vec::new();
            for _ in 0..kind.max_steps {
                let mut actions: Vec<Option<StepAction>> = Vec::new();
                for (k, letter) in who.iter().enumerate() {
                    let action = match letter {
                        'e' => env.expert_step(k)?,
                        's' => DiscreteAction::Wait.into(),
                        'w' => choices[1 + stream.below(choices.len() - 1)].into(),
                        _ => choices[stream.below(choices.len())].into(),
                    };
                    actions.push(Some(action));
                }
                last = env.step(&actions)?;
                steps += 1;
                for (sum, info) in paid.iter_mut().zip(&last) {
                    *sum += info.result.reward;
                }
                if last.iter().all(|info| info.result.terminated) {
                    break;
                }
            }
            played += 1;
            for (count, info) in solved.iter_mut().zip(&last) {
                *count += u32::from(info.result.success);
            }
            let told: Vec<f64> = last
                .first()
                .map_or(Vec::new(), |info| info.measures.clone());
            for ((sum, count), value) in measures.iter_mut().zip(&told) {
                if !value.is_nan() {
                    (*sum, *count) = (*sum + value, *count + 1);
                }
            }
            if last.iter().all(|info| !info.result.success) {
                println!("{name}, episode {seed}: nobody, {told:?}");
            }
        }
    }
    let mean = |sum: f64, count: u32| sum / f64::from(count.max(1));
    println!(
        "{played} episodes, {refused} refused, {:.0} steps each",
        mean(steps as f64, played)
    );
    println!("success by agent: {solved:?}");
    let paid: Vec<f64> = paid.into_iter().map(|sum| mean(sum, played)).collect();
    println!("reward by agent: {paid:.2?}");
    for (measure, (sum, count)) in kind.measures.iter().zip(measures) {
        println!(
            "{}: {:.3} in {count} episodes",
            measure.name,
            mean(sum, count)
        );
    }
    Ok(())
}
