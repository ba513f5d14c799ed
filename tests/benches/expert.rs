//! Plays the expert of a task in houses and says where it fails.
//!
//! `cargo bench --profile dev -p dwell-tests --bench expert -- [TASK] [FROM..TO [HOUSE...]]`: by default instruction following, the
//! first 20 seeds in the built-in apartment.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{Engines, Env, EnvConfig};
use dwell_scene::AgentId;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let mut config = EnvConfig {
        sensors: Some(Vec::new()),
        ..EnvConfig::default()
    };
    if words.first().is_some_and(|word| !word.contains("..")) {
        config.task = words.remove(0);
    }
    let most_steps = dwell::tasks::find(&config.task)?.max_steps;
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
    for name in &words {
        let (house, _) = dwell_houses::open(name)?;
        let mut env = Env::new(Engines::new(Arc::new(house)), &config)?;
        let (mut solved, mut steps) = (0, 0);
        for seed in from..to {
            if let Err(error) = env.reset(seed) {
                println!("episode {seed}: {error}");
                continue;
            }
            solved += u64::from(play(&mut env, seed, most_steps)?);
            steps += env.steps();
        }
        let count = to - from;
        println!(
            "{name}: {solved} of {count} episodes solved, {} steps each",
            steps / count.max(1)
        );
    }
    Ok(())
}

/// Returns whether the expert solves the episode that has begun; says how it ended where not.
fn play(env: &mut Env, seed: u64, most_steps: u64) -> Result<bool, dwell::WorldError> {
    let (mut last, mut measures) = (Vec::new(), Vec::new());
    for step in 0..most_steps {
        let action = env.expert_action(0)?;
        let info = &env.step(&[Some(action)])?[0];
        let notice = if info.action_success {
            ""
        } else {
            &info.action_error
        };
        last.push(format!("{action:?} {notice}"));
        measures.clone_from(&info.measures);
        if info.result.terminated {
            if info.result.success {
                return Ok(true);
            }
            tell(env, seed, step, (&last, &measures));
            return Ok(false);
        }
    }
    tell(env, seed, most_steps, (&last, &measures));
    Ok(false)
}

fn tell(env: &Env, seed: u64, steps: u64, (actions, measures): (&[String], &[f64])) {
    let agent = env.world().state().agents[AgentId(0)];
    let text = env.episode(0).map_or("", |episode| &episode.instruction);
    if let Ok(episode) = env.episode(0) {
        for id in &episode.goal.objects {
            let (house, state) = (env.world().house(), env.world().state());
            let at = house.object_bounds(state, *id);
            let goal = episode.goal.placements.iter().find(|one| one.object == *id);
            println!(
                "  {} goal {:?} now {:.2} size {:.2} open {:?} held {:?}",
                house.objects[*id].name,
                goal.map(|one| (one.world_from_box.position, one.openness)),
                at.center(),
                at.size(),
                state.openness(house, *id),
                state.held_by[*id]
            );
        }
    }
    let mut k = 0;
    for (step, action) in actions.iter().enumerate() {
        let plain = ["Move", "Turn", "Look", "Wait"]
            .iter()
            .any(|w| action.starts_with(w))
            && !action.contains("way");
        if !plain && k < 60 && (step == 0 || actions[step - 1] != *action) {
            k += 1;
            println!("    {step} {action}");
        }
    }
    let last = &actions[actions.len().saturating_sub(6)..];
    let names = env.task_measures(0).unwrap_or_default().iter();
    for (measure, value) in names.zip(measures) {
        let name = measure.name;
        println!("{name}: {value}");
    }
    println!(
        "episode {seed}, {steps} steps: {text:?}, at {:.3} {:.2} rad, {last:?}",
        agent.position, agent.yaw_rad
    );
}
