//! Checks of predicates a second, and what a step costs that asks twenty of them of a scene that was just made.
//!
//! `cargo bench -p dwell-benches --bench words_checks -- builtin:apartment seed:3`: the houses; without `--bench` a few checks, once.

#![expect(clippy::unwrap_used, reason = "a bench may stop at the first surprise")]
#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentState, House, RoomId, State};
use dwell_semantics::predicates::{Predicate, all};
use dwell_semantics::{SemanticScene, Semantics, Term, Viewer};
use glam::Vec3;
use std::sync::Arc;
use std::time::Instant;

/// Questions of each kind that are timed alone.
const EACH: usize = 2_000;
/// Predicates that a step asks.
const ASKED: usize = 20;

/// One question.
type Question = (usize, [Term; 3]);

/// Questions about things of the kinds that their predicates take, near and far alike, without `reachable`, which walks the house
/// once for each agent and state.
fn questions(scene: &SemanticScene<'_>, count: usize, seed: u64) -> Vec<Question> {
    let mut stream = RandomKey::root(seed).stream();
    let terms: Vec<Term> = scene.terms().collect();
    let asked: Vec<usize> = (0..all().len())
        .filter(|code| all()[*code].name() != "reachable")
        .collect();
    (0..count)
        .map(|k| {
            let code = asked[k % asked.len()];
            let mut args = [terms[0]; 3];
            for (arg, kinds) in args.iter_mut().zip(all()[code].argument_kinds()) {
                let fitting = || terms.iter().filter(|term| kinds.contains(&term.kind()));
                let number = fitting().count().max(1);
                let found = fitting().nth(stream.below(number));
                *arg = found.copied().unwrap_or(terms[0]);
            }
            (code, args)
        })
        .collect()
}

fn ask(scene: &SemanticScene<'_>, questions: &[Question], viewer: &Viewer) -> usize {
    let holds = |(code, args): &&Question| {
        let predicate: &dyn Predicate = all()[*code];
        let args = &args[..predicate.arity()];
        predicate.holds(scene, args, Some(viewer)).is_true()
    };
    questions.iter().filter(holds).count()
}

fn populated(house: &House) -> State {
    let mut state = State::new(house);
    let mut feet = house
        .points_in_room(RoomId(0), 5)
        .first()
        .copied()
        .unwrap_or(Vec3::ZERO);
    feet.y = house.rooms.as_slice()[0].floor_y;
    state
        .agents
        .push(AgentState::new(AgentBody::default(), feet, 0.4));
    // As after some steps of physics: everything loose has settled by a hair.
    for (part, pose) in house.parts.ids().zip(state.part_pose.iter_mut()) {
        if !house.parts[part].fixed {
            pose.position.y -= 1e-4;
        }
    }
    state
}

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let bench = arguments.iter().any(|argument| argument == "--bench");
    arguments.retain(|argument| !argument.starts_with("--"));
    if arguments.is_empty() {
        arguments = vec!["builtin:apartment".to_owned(), "seed:3".to_owned()];
    }
    let count = if bench { 200_000 } else { 400 };
    for name in &arguments {
        let (house, _) = dwell_houses::open(name).unwrap();
        let house = Arc::new(house);
        let semantics = Semantics::new(&house);
        let state = populated(&house);
        let viewer = Viewer::of_agent(&state, dwell_scene::AgentId(0)).unwrap();
        let questions = questions(&semantics.scene(&state), count, 1);
        println!("{name}: {} things", house.objects.len());
        for threads in [1, 2] {
            let began = Instant::now();
            let pieces: Vec<&[Question]> = questions.chunks(count.div_ceil(threads)).collect();
            let held: usize = Threads::new(threads)
                .map(pieces.len(), |k| {
                    ask(&semantics.scene(&state), pieces[k], &viewer)
                })
                .iter()
                .sum();
            let rate = count as f64 / began.elapsed().as_secs_f64();
            println!("  {threads} threads: {rate:.0} checks a second ({held} of {count} hold)");
        }
        let steps = if bench { 200 } else { 2 };
        let began = Instant::now();
        for k in 0..steps {
            let first = (k * ASKED) % (count - ASKED);
            let scene = semantics.scene(&state);
            std::hint::black_box(ask(&scene, &questions[first..first + ASKED], &viewer));
        }
        let each_ms = began.elapsed().as_secs_f64() * 1e3 / steps as f64;
        println!("  a new scene and {ASKED} checks: {each_ms:.3} ms");
        if bench {
            by_predicate(&semantics, &state, &viewer);
        }
    }
}

/// The mean time of a check of each predicate, the slowest first.
fn by_predicate(semantics: &Semantics, state: &State, viewer: &Viewer) {
    let scene = semantics.scene(state);
    let all_of_them = questions(&scene, EACH * all().len(), 2);
    let mut rows: Vec<(f64, &str)> = Vec::new();
    for (code, predicate) in all().iter().enumerate() {
        let own = all_of_them.iter().filter(|(asked, _)| *asked == code);
        let own: Vec<Question> = own.copied().collect();
        let began = Instant::now();
        std::hint::black_box(ask(&scene, &own, viewer));
        let each_us = began.elapsed().as_secs_f64() * 1e6 / own.len().max(1) as f64;
        rows.push((each_us, predicate.name()));
    }
    rows.sort_by(|p, q| q.0.total_cmp(&p.0));
    for (each_us, name) in rows.iter().take(8) {
        println!("  {name}: {each_us:.1} µs");
    }
}
