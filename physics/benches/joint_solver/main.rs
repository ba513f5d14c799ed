//! Benchmark of this crate's joint solver against rapier's, for `docs/decisions/0013-joint-solver.md`.
//!
//! Without `--bench` everything runs briefly, as a test.
#![expect(clippy::print_stdout, reason = "it prints a table")]

mod chain;
mod ours;
mod rapier;

use chain::{CONTROL_HZ, Chain, Motor, PHYSICS_HZ, Solver};
use ours::Ours;
use rapier::{Joints, Rapier};
use std::time::Instant;

const NAMES: [&str; 4] = ["ours", "multibody", "multibody, 8 sweeps", "impulse joints"];

fn one(chain: &Chain, k: usize) -> Box<dyn Solver> {
    match k {
        0 => Box::new(Ours::new(chain)),
        1 => Box::new(Rapier::new(chain, Joints::Multibody, 1)),
        2 => Box::new(Rapier::new(chain, Joints::Multibody, 8)),
        _ => Box::new(Rapier::new(chain, Joints::Impulse, 1)),
    }
}

fn all(chain: &Chain) -> [Box<dyn Solver>; 4] {
    std::array::from_fn(|k| one(chain, k))
}

/// Prints the energy drift of a double pendulum, as a share of what it gains from level to hanging.
fn drift(seconds: usize) {
    let chain = Chain::double_pendulum();
    let weight_j = chain.loads(&[0.0, 0.0])[0].abs();
    for (name, mut solver) in NAMES.iter().zip(all(&chain)) {
        let start = solver.energy_j();
        let mut worst = 0.0_f64;
        let mut told = Vec::new();
        for second in 1..=seconds {
            for _ in 0..CONTROL_HZ {
                solver.steps(1);
                worst = worst.max((solver.energy_j() - start).abs());
            }
            if [1, 10, 60, seconds].contains(&second) {
                let now = solver.energy_j() - start;
                told.push(format!(
                    "{second} s: {:+.2e} (worst {:.2e})",
                    now / weight_j,
                    worst / weight_j
                ));
            }
        }
        println!("double pendulum, energy: {name}: {}", told.join(", "));
    }
}

/// Prints the position error of an arm that holds a load against the one predicted from its stiffness, and its creep.
fn hold(seconds: usize) {
    for (stiffness, damping) in [(2000.0, 100.0), (1e5, 1e3), (1e6, 1e4)] {
        let chain = Chain::arm(Motor { stiffness, damping });
        for (name, mut solver) in NAMES.iter().zip(all(&chain)) {
            solver.steps((seconds - 1) * CONTROL_HZ);
            let before = solver.angles();
            let mut shakes = 0.0_f64;
            for _ in 0..CONTROL_HZ {
                solver.steps(1);
                shakes = solver
                    .rates()
                    .iter()
                    .fold(shakes, |most, rate| most.max(rate.abs()));
            }
            let now = solver.angles();
            let loads = chain.loads(&now);
            let off = now.iter().zip(&loads);
            let off = off.map(|(q, load)| (q - load / f64::from(stiffness)).abs());
            let creep = now.iter().zip(&before).map(|(a, b)| (a - b).abs());
            println!(
                "arm of six joints, {stiffness} N m/rad: {name}: off by {:.2e} rad, creeps {:.2e} rad/s, turns {shakes:.2e} rad/s",
                off.fold(0.0, f64::max),
                creep.fold(0.0, f64::max)
            );
        }
    }
}

/// Prints how far a bar overshoots its stop and its speed in the first steps after it; weight adds some 0.1 rad/s in each.
fn stop() {
    for rate in [10.0_f32, 20.0, 50.0] {
        let mut chain = Chain::pendulum();
        chain.limits = Some([-1.0, 1.0]);
        chain.start = vec![[0.0, rate]];
        chain.control_hz = PHYSICS_HZ;
        for (name, mut solver) in NAMES.iter().zip(all(&chain)) {
            let (mut beyond, mut back) = (f64::NEG_INFINITY, 0.0_f64);
            let mut left = 60;
            while left > 0 {
                solver.steps(1);
                let angle = solver.angles()[0];
                beyond = beyond.max(angle - 1.0);
                if angle > 0.99 && left > 3 {
                    left = 3;
                }
                back = back.min(solver.rates()[0]);
                left -= 1;
            }
            println!(
                "stop at {rate} rad/s: {name}: {beyond:+.2e} rad beyond, back at {back:.2} rad/s"
            );
        }
    }
}

/// Prints the creep of a level bar held by dry friction of 1.2 times its weight. rapier's rows have no such friction.
fn friction(seconds: usize) {
    let mut chain = Chain::pendulum();
    chain.friction = 1.2 * chain.loads(&[0.0])[0].abs() as f32;
    for (name, mut solver) in NAMES.iter().zip(all(&chain)).take(3) {
        solver.steps(seconds * CONTROL_HZ);
        let (angle, rate) = (solver.angles()[0], solver.rates()[0]);
        println!("friction: {name}: {angle:+.2e} rad after {seconds} s, turns {rate:+.2e} rad/s");
    }
}

/// Prints whether a repeated run, and a run continued from a snapshot, give the same bits.
fn bits(seconds: usize) {
    let chain = Chain::double_pendulum();
    for (k, name) in NAMES.iter().enumerate() {
        let (mut one, mut two) = (one(&chain, k), one(&chain, k));
        one.steps(seconds * CONTROL_HZ);
        two.steps(seconds * CONTROL_HZ);
        let repeats = one.bits() == two.bits();
        let mut again = one.restored();
        let mut same = 0;
        for _ in 0..seconds * CONTROL_HZ {
            one.steps(1);
            again.steps(1);
            let equal = |a: Vec<f64>, b: Vec<f64>| {
                a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits())
            };
            if !equal(one.angles(), again.angles()) || !equal(one.rates(), again.rates()) {
                break;
            }
            same += 1;
        }
        println!(
            "bits: {name}: repeats {repeats}, restored: {same} of {} control steps the same, {} bytes",
            seconds * CONTROL_HZ,
            one.bits().len()
        );
    }
}

/// Returns the time of a physics step: the median of some rounds.
fn speed(rounds: usize) {
    for count in [1, 6, 20] {
        let chain = Chain::held(count);
        let told: Vec<String> = NAMES
            .iter()
            .zip(all(&chain))
            .map(|(name, mut solver)| {
                solver.steps(CONTROL_HZ);
                let mut times: Vec<f64> = (0..rounds)
                    .map(|_| {
                        let start = Instant::now();
                        solver.steps(CONTROL_HZ);
                        start.elapsed().as_secs_f64() / PHYSICS_HZ as f64
                    })
                    .collect();
                times.sort_by(f64::total_cmp);
                let largest = solver
                    .angles()
                    .iter()
                    .fold(0.0_f64, |most, q| most.max(q.abs()));
                format!(
                    "{name} {:.1} us (gives way {largest:.3} rad)",
                    1e6 * times[rounds / 2]
                )
            })
            .collect();
        println!("speed, {count} joints: {}", told.join(", "));
    }
}

fn main() {
    let measured = std::env::args().any(|arg| arg == "--bench");
    drift(if measured { 300 } else { 1 });
    hold(if measured { 20 } else { 2 });
    stop();
    friction(if measured { 60 } else { 1 });
    bits(if measured { 20 } else { 1 });
    speed(if measured { 51 } else { 1 });
}
