//! Says how many things of generated houses lie where `assets/tidy_rules.csv` has them at the start, and which do not.
//!
//! `cargo run -p dwell-tests --example tidy_rules -- [FROM..TO]`: by default the houses of the seeds 0 to 99.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{Engines, World, WorldConfig};
use dwell_tests::tidiness::{below, is_tidy};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Kinds of exceptions that are listed.
const LISTED: usize = 60;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "0..100".to_owned());
    let (from, to) = seeds.split_once("..").ok_or("seeds are written FROM..TO")?;
    let (from, to): (u64, u64) = (from.parse()?, to.parse()?);
    let (mut tidy, mut all) = (0_u32, 0_u32);
    let mut exceptions: BTreeMap<String, u32> = BTreeMap::new();
    let config = WorldConfig {
        settle_s: Some(2.0),
        ..WorldConfig::default()
    };
    for seed in from..to {
        let (house, _) = dwell_houses::open(&format!("seed:{seed}"))?;
        let world = World::new(Engines::new(Arc::new(house)), &config)?;
        let house = world.house();
        for id in house.objects.ids().filter(|id| house.objects[*id].pickable) {
            let Some(fits) = is_tidy(&world, id) else {
                continue;
            };
            all += 1;
            tidy += u32::from(fits);
            if !fits {
                let middle = house.object_bounds(world.state(), id).center();
                let room = house.room_at(middle);
                let kind = room.and_then(|room| world.engines().semantics().room(room).kind);
                let class = &house.objects[id].category.coarse;
                let places = below(&world, id, 4);
                let kind = kind.map(|kind| kind.name);
                *exceptions
                    .entry(format!("{class} on {places:?} in {kind:?}"))
                    .or_default() += 1;
            }
        }
    }
    println!("{tidy} of {all} things of {} houses are tidy", to - from);
    let mut listed: Vec<(String, u32)> = exceptions.into_iter().collect();
    listed.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    for (what, count) in listed.into_iter().take(LISTED) {
        println!("{count} {what}");
    }
    Ok(())
}
