//! Memory watch: every byte that is allocated and freed is counted.
//!
//! Agents strew things about, so that ever more pieces of theirs are near each other, and physics keeps the contacts of each
//! such pair. How much that is, a world says that is restored from a snapshot: it holds what the state needs. What is held
//! beyond that may not grow.

use dwell::World;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Largest growth of the rest from the second tenth of a run to the last ("flat memory").
const GROWTH_BYTES: i64 = 1024 * 1024;
/// Looks in a run.
pub(crate) const LOOKS: usize = 100;

/// Returns what is allocated and not freed, bytes.
fn in_use() -> i64 {
    let stats = HEAP.stats();
    stats.bytes_allocated as i64 - stats.bytes_deallocated as i64
}

/// Memory over a run.
pub(crate) struct Watch {
    /// Before there was a world.
    empty: i64,
    /// Memory held beyond need, bytes, at each look.
    rest: Vec<i64>,
}

impl Watch {
    pub(crate) fn new() -> Self {
        Self {
            empty: in_use(),
            rest: Vec::with_capacity(LOOKS),
        }
    }

    /// Looks at a world, the only one there is; what it holds and what another one that is restored from its snapshot holds,
    /// bytes. Vectors that things are pushed to hold up to twice what is in them, those of the other world no more.
    pub(crate) fn look(&mut self, world: &World) -> [i64; 2] {
        let before = in_use();
        let mut other = World::new(world.engines().clone(), world.config()).unwrap();
        other.restore(&world.snapshot()).unwrap();
        let needed = in_use() - before;
        let held = before - self.empty;
        self.rest.push(held - 2 * needed);
        [held, needed]
    }

    /// Takes the memory held now as zero.
    pub(crate) fn begin(&mut self) {
        self.empty = in_use();
    }

    /// Looks at all that is held, where no world keeps what was strewn for long.
    pub(crate) fn look_at_all(&mut self) {
        self.rest.push(in_use() - self.empty);
    }

    /// The rest did not grow from the second tenth on. The least of ten looks counts, since a crowd that is awake takes room to
    /// work in for a while.
    pub(crate) fn check(&self) {
        let least = |tenth: usize| {
            let looks = &self.rest[tenth * LOOKS / 10..(tenth + 1) * LOOKS / 10];
            *looks.iter().min().expect("ten looks")
        };
        let tenths: Vec<i64> = (0..10).map(least).collect();
        let growth = growth(&tenths[1..]);
        println!("  memory beyond need grew by {growth} bytes: {tenths:?}");
        assert!(growth <= GROWTH_BYTES, "memory grew by {growth} bytes");
    }
}

/// Returns how far values that are noisy by themselves rise from the first to the last: the median of the slopes between any two of them
/// (T. P. Theil 1950, P. K. Sen 1968), times the way.
fn growth(values: &[i64]) -> i64 {
    let mut slopes: Vec<f64> = Vec::new();
    for (k, first) in values.iter().enumerate() {
        for (j, later) in values.iter().enumerate().skip(k + 1) {
            slopes.push((later - first) as f64 / (j - k) as f64);
        }
    }
    slopes.sort_by(f64::total_cmp);
    let middle = 0.5 * (slopes[slopes.len() / 2] + slopes[(slopes.len() - 1) / 2]);
    (middle * (values.len() - 1) as f64) as i64
}

/// A leak of 1.5 times the bound is found, and none where there is none, in noise as large as a crowded house makes.
#[test]
fn leaks_are_told_from_noise() {
    let noise = [12, -35, 49, 3, -41, 20, -15, 37, -8].map(|k| k * 20_000);
    for leak in [0, GROWTH_BYTES * 3 / 2] {
        let line = (0..9).map(|k| leak * k / 8);
        let values: Vec<i64> = line.zip(noise).map(|(a, b)| 5_000_000 + a + b).collect();
        assert_eq!(growth(&values) > GROWTH_BYTES, leak > 0, "{leak}");
    }
}

/// Memory that the system gave, bytes; 0 where it does not say.
pub(crate) fn resident_bytes() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = text.split_whitespace().nth(1);
    pages.map_or(0.0, |pages| pages.parse().unwrap_or(0.0) * 4096.0)
}
