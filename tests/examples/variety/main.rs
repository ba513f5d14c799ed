//! Variety of generated houses, and near copies among them: tables as Markdown, plots as one SVG.
//!
//! `cargo run -p dwell-tests --example variety -- docs/images/generator-variety.svg 1000`: file, number of seeds.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

mod facts;
mod nearest;
mod svg;

use dwell_houses::generate::{HouseSpec, generate};
use dwell_scene::parallel::Threads;
use facts::Facts;
use nearest::{COPY_OVERLAP, Nearest};
use std::collections::BTreeMap;
use std::error::Error;
use svg::{Bars, Plots};

/// S. Song et al., "Semantic Scene Completion from a Single Depth Image", CVPR 2017, section 4: 45,622 houses with 404,058
/// rooms and 5,697,217 objects of 84 categories.
const SUNCG: [f64; 4] = [45_622.0, 404_058.0, 5_697_217.0, 84.0];

/// Mean, least, median, largest.
fn spread(values: impl Iterator<Item = f64>) -> [f64; 4] {
    let mut all: Vec<f64> = values.collect();
    all.sort_by(f64::total_cmp);
    let Some((least, largest)) = all.first().zip(all.last()) else {
        return [0.0; 4];
    };
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    [mean, *least, all[all.len() / 2], *largest]
}

fn row(what: &str, [mean, least, median, largest]: [f64; 4], suncg: &str) {
    println!("| {what} | {mean:.1} | {least:.0} | {median:.0} | {largest:.0} | {suncg} |");
}

/// Returns how many values fall into each bin of `width`, by the bin's lower end.
fn histogram(values: impl Iterator<Item = f64>, width: f64) -> Bars {
    let mut bins = BTreeMap::<i64, f64>::new();
    for value in values {
        *bins.entry((value / width).floor() as i64).or_default() += 1.0;
    }
    let label = |(bin, count): (i64, f64)| (format!("{}", bin as f64 * width), count);
    bins.into_iter().map(label).collect()
}

fn counted<'a>(names: impl Iterator<Item = &'a str>, most: usize) -> Bars {
    let mut counts = BTreeMap::<&str, f64>::new();
    for name in names {
        *counts.entry(name).or_default() += 1.0;
    }
    let mut rows: Bars = counts
        .into_iter()
        .map(|(name, count)| (name.to_owned(), count))
        .collect();
    rows.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    rows.truncate(most);
    rows
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let file = arguments.get(1).ok_or("the file of the plots")?;
    let count: usize = arguments.get(2).map_or(Ok(1000), |word| word.parse())?;
    let made = Threads::default().map(count, |seed| {
        let generated = generate(seed as u64, &HouseSpec::default());
        generated.map(|generated| Facts::of(seed as u64, &generated))
    });
    let all = made.into_iter().collect::<Result<Vec<Facts>, _>>()?;
    let nearest = Threads::default().map(all.len(), |k| Nearest::of(&all, k));
    tables(&all, &nearest);
    std::fs::write(file, plots(&all, &nearest).svg())?;
    Ok(())
}

fn tables(all: &[Facts], nearest: &[Nearest]) {
    let [houses, rooms, objects, categories] = SUNCG;
    let per = |f: fn(&Facts) -> f64| spread(all.iter().map(f));
    println!(
        "| {} houses | mean | least | median | largest | SUNCG |",
        all.len()
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    row(
        "rooms in a house",
        per(|f| f.rooms.len() as f64),
        &format!("mean {:.1}", rooms / houses),
    );
    row(
        "objects in a house",
        per(|f| f.objects as f64),
        &format!("mean {:.0}", objects / houses),
    );
    let in_rooms = all
        .iter()
        .flat_map(|f| f.rooms.iter().map(|room| room.objects as f64));
    row(
        "objects in a room",
        spread(in_rooms),
        &format!("mean {:.1}", objects / rooms),
    );
    row(
        "categories in a house",
        per(|f| f.categories.len() as f64),
        "",
    );
    row("floor of a house, m²", per(|f| f.area_m2), "");
    row("colours in a house", per(|f| f.colours.len() as f64), "");
    row("storeys", per(|f| f.storeys as f64), "");
    let union = |f: fn(&Facts) -> &std::collections::BTreeSet<String>| {
        let names: std::collections::BTreeSet<&String> = all.iter().flat_map(f).collect();
        names.len()
    };
    println!();
    println!(
        "{} categories in all (SUNCG: {categories:.0} coarse ones), {} colours.",
        union(|f| &f.categories),
        union(|f| &f.colours)
    );
    println!();
    println!("| rooms that are joined | share of houses with such a pair | pairs |");
    println!("| --- | --- | --- |");
    let pairs = counted(
        all.iter().flat_map(|f| f.links.iter().map(String::as_str)),
        20,
    );
    for (pair, count) in pairs {
        let with = all.iter().filter(|f| f.links.contains(&pair)).count();
        println!(
            "| {pair} | {:.0} % | {count:.0} |",
            100.0 * with as f64 / all.len() as f64
        );
    }
    let copies: Vec<&Nearest> = nearest.iter().filter(|n| n.is_copy()).collect();
    let twins = nearest.iter().filter(|n| n.graph == 0).count();
    println!();
    println!(
        "{twins} of {} houses have another one with the same rooms and doors between them; the furniture of the nearest one \
         overlaps by {:.2} in the mean and {:.2} at most. Near copies (the same rooms and doors, and an overlap of at least \
         {COPY_OVERLAP}): {}.",
        all.len(),
        nearest.iter().map(|n| n.overlap).sum::<f64>() / nearest.len().max(1) as f64,
        nearest.iter().map(|n| n.overlap).fold(0.0, f64::max),
        copies.len()
    );
    for copy in copies.iter().take(10) {
        println!(
            "- seeds {} and {}: {:.2}",
            copy.seed, copy.other, copy.overlap
        );
    }
}

fn plots(all: &[Facts], nearest: &[Nearest]) -> Plots {
    let per = |f: fn(&Facts) -> f64| all.iter().map(f);
    let mut plots = Plots::default();
    plots.add(
        "rooms in a house",
        histogram(per(|f| f.rooms.len() as f64), 1.0),
    );
    let in_rooms = all
        .iter()
        .flat_map(|f| f.rooms.iter().map(|room| room.objects as f64));
    plots.add("objects in a room, in fives", histogram(in_rooms, 5.0));
    plots.add(
        "floor of a house, in 20 m²",
        histogram(per(|f| f.area_m2), 20.0),
    );
    plots.add(
        "categories in a house, in fives",
        histogram(per(|f| f.categories.len() as f64), 5.0),
    );
    plots.add(
        "colours in a house, in fives",
        histogram(per(|f| f.colours.len() as f64), 5.0),
    );
    let overlap = nearest.iter().map(|n| (100.0 * n.overlap).min(99.9));
    plots.add(
        "furniture shared with the nearest house, in 5 %",
        histogram(overlap, 5.0),
    );
    let rooms = all
        .iter()
        .flat_map(|f| f.rooms.iter().map(|room| room.kind.as_str()));
    plots.add_wide("rooms by kind", counted(rooms, 18));
    let links = all.iter().flat_map(|f| f.links.iter().map(String::as_str));
    plots.add_wide("pairs of rooms that are joined", counted(links, 24));
    let things = all
        .iter()
        .flat_map(|f| f.things.iter().map(|(_, category)| category.as_str()));
    plots.add_wide(
        "objects by category, the 40 most frequent",
        counted(things, 40),
    );
    plots
}
