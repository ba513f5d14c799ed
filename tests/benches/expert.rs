//! Plays the expert of instruction following in houses and says where it fails.
//!
//! `cargo bench --profile dev -p dwell-tests --bench expert -- [FROM..TO [HOUSE...]]`: by default the first 20 seeds in the
//! built-in apartment.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{Engines, Env, EnvConfig};
use dwell_scene::AgentId;
use std::sync::Arc;

/// Steps after which an episode counts as not solved.
const MOST_STEPS: usize = 1000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let seeds = if words.is_empty() {
        "0..20".to_owned()
    } else {
        words.remove(0)
    };
    let (from, to) = seeds.split_once("..").ok_or("seeds are written FROM..TO")?;
    let (from, to): (u64, u64) = (from.parse()?, to.parse()?);
    if words.is_empty() {
        words.push("builtin:apartment".to_owned());
    }
    let config = EnvConfig {
        sensors: Some(Vec::new()),
        ..EnvConfig::default()
    };
    for name in &words {
        let (house, _) = dwell_houses::open(name)?;
        let mut env = Env::new(Engines::new(Arc::new(house)), &config)?;
        let mut solved = 0;
        for seed in from..to {
            env.reset(seed)?;
            solved += u64::from(play(&mut env, seed)?);
        }
        println!("{name}: {solved} of {} episodes solved", to - from);
    }
    Ok(())
}

/// Returns whether the expert solves the episode that has begun; says how it ended where not.
fn play(env: &mut Env, seed: u64) -> Result<bool, dwell::WorldError> {
    let mut last = Vec::new();
    for step in 0..MOST_STEPS {
        let action = env.expert_action(0)?;
        let info = &env.step(&[Some(action)])?[0];
        let notice = if info.action_success {
            ""
        } else {
            &info.action_error
        };
        last.push(format!("{action:?} {notice}"));
        if info.result.terminated {
            if info.result.success {
                return Ok(true);
            }
            tell(env, seed, step, &last);
            return Ok(false);
        }
    }
    tell(env, seed, MOST_STEPS, &last);
    Ok(false)
}

fn tell(env: &Env, seed: u64, steps: usize, actions: &[String]) {
    let agent = env.world().state().agents[AgentId(0)];
    let text = env.episode(0).map_or("", |episode| &episode.instruction);
    let last = &actions[actions.len().saturating_sub(6)..];
    println!(
        "episode {seed}, {steps} steps: {text:?}, at {:.3} {:.2} rad, {last:?}",
        agent.position, agent.yaw_rad
    );
}
