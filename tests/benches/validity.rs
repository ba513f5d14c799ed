//! Thousands of seeds against every rule that a generated house must keep.
//!
//! `cargo bench --profile dev -p dwell-tests --bench validity -- --from 0 --to 10000` looks at houses as they stand;
//! `--settled` lets physics run for two seconds in each, too. Each fault is one line, `seed rule what`; counts follow every
//! hundred seeds, so that a run that was ended goes on with `--from`. Without seeds: the first four, to see that it works.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell_houses::generate::HouseSpec;
use dwell_scene::parallel::Threads;
use dwell_tests::validity::{CheckDepth, check_house, thread_dependent_seeds};
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::time::Instant;

/// Seeds between two lines of counts.
const CHUNK: u64 = 100;

fn number(arguments: &[String], name: &str) -> Option<u64> {
    let at = arguments.iter().position(|argument| argument == name)?;
    arguments.get(at + 1)?.parse().ok()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    let from = number(&arguments, "--from").unwrap_or(0);
    let to = number(&arguments, "--to").unwrap_or(from + 4);
    let threads = number(&arguments, "--threads").map_or_else(Threads::default, |count| {
        Threads::new(count.max(1) as usize)
    });
    let depth = if arguments.iter().any(|argument| argument == "--settled") {
        CheckDepth::Settled
    } else {
        CheckDepth::Geometric
    };
    let began = Instant::now();
    let (mut faulty, mut given_up, mut counts) = (0, 0, [0; 2]);
    let mut by_rule = BTreeMap::<&str, usize>::new();
    let mut seed = from;
    while seed < to {
        let chunk: Vec<u64> = (seed..to.min(seed + CHUNK)).collect();
        for looked in threads.map(chunk.len(), |k| {
            check_house(chunk[k], &HouseSpec::default(), depth)
        }) {
            for fault in &looked.faults {
                println!("{} {} {}", looked.seed, fault.rule, fault.what);
                *by_rule.entry(fault.rule).or_default() += 1;
            }
            faulty += usize::from(!looked.faults.is_empty());
            given_up += usize::from(!looked.given_up.is_empty());
            counts = [0, 1].map(|k| counts[k] + looked.counts[k]);
        }
        for other in thread_dependent_seeds(&chunk) {
            println!("{other} bytes differ beside other houses");
            *by_rule.entry("bytes").or_default() += 1;
        }
        seed += chunk.len() as u64;
        println!(
            "seeds {from}..{seed}: {faulty} houses with faults {by_rule:?}, {given_up} that gave something up, {} rooms, {} objects, {:.0} s",
            counts[0],
            counts[1],
            began.elapsed().as_secs_f64()
        );
    }
    if by_rule.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
