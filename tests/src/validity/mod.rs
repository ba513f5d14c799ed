//! Rules that hold for every generated house. Tests look at hundreds of seeds, the bench `validity` at thousands.

mod geometric;
mod settled;

use dwell_houses::generate::{GeneratedHouse, HouseSpec, generate};
use dwell_scene::parallel::Threads;
use std::sync::Arc;

/// The depth of the checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckDepth {
    /// As the house stands.
    Geometric,
    /// After two seconds of physics, too.
    Settled,
}

/// Something that breaks a rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleViolation {
    /// `overlap` (more than 5 mm), `joint` (meets something in its range), `place` (out of its room), `light`, `name`,
    /// `reach` (a room that nobody can enter), `bytes` (not the same beside other houses), `start` (physics had to move
    /// it), `settle` (a pickable thing moved more than 2 cm in 2 s), `physics`, `generate`.
    pub rule: &'static str,
    /// The violation, in words.
    pub what: String,
}

/// The checks of one house.
#[derive(Clone, Debug)]
pub struct CheckCounts {
    /// The seed.
    pub seed: u64,
    /// Its numbers of rooms and objects.
    pub counts: [usize; 2],
    /// The omissions that the generator reported.
    pub given_up: Vec<String>,
    /// The violations.
    pub faults: Vec<RuleViolation>,
}

/// Looks at the house of a seed and spec.
pub fn check_house(seed: u64, spec: &HouseSpec, depth: CheckDepth) -> CheckCounts {
    let mut looked = CheckCounts {
        seed,
        counts: [0; 2],
        given_up: Vec::new(),
        faults: Vec::new(),
    };
    let GeneratedHouse { house, report } = match generate(seed, spec) {
        Ok(generated) => generated,
        Err(error) => {
            let (rule, what) = ("generate", error.to_string());
            looked.faults.push(RuleViolation { rule, what });
            return looked;
        }
    };
    looked.counts = [house.rooms.len(), house.objects.len()];
    looked.given_up = report.given_up;
    looked.faults = geometric::faults(&house);
    if depth == CheckDepth::Settled {
        looked.faults.extend(settled::faults(&Arc::new(house)));
    }
    looked
}

/// Seeds whose houses differ when they are made at the same time on two threads instead of one after the other.
pub fn thread_dependent_seeds(seeds: &[u64]) -> Vec<u64> {
    let number = |seed: u64| {
        let made = generate(seed, &HouseSpec::default());
        made.map(|generated| (generated.house.fingerprint(), generated.report))
            .ok()
    };
    let alone: Vec<_> = seeds.iter().map(|seed| number(*seed)).collect();
    let beside = Threads::new(2).map(seeds.len(), |k| number(seeds[k]));
    let differ = seeds
        .iter()
        .zip(alone.iter().zip(&beside))
        .filter(|(_, (a, b))| a.is_none() || a != b);
    differ.map(|(seed, _)| *seed).collect()
}
