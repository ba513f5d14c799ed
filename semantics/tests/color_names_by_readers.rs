//! Colours of things against the words of readers who saw pictures alone: three runs of a vision-language model, no people. The things
//! are of ten generated houses of which none was used when the table of names was fitted.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_semantics::{Semantics, color};
use std::collections::BTreeMap;
use std::sync::Arc;

const NAMES: &str = include_str!("color_names_by_readers.tsv");

/// What a reader said: the words that people would name, the main one first, and what it could as well be called.
fn words(cell: &str) -> (Vec<&str>, Vec<&str>) {
    let (named, other) = cell.split_once(" (").unwrap_or((cell, ""));
    let other = other.trim_end_matches(')');
    (
        named.split_whitespace().collect(),
        other.split_whitespace().collect(),
    )
}

#[test]
fn colours_are_those_that_readers_name() {
    let mut houses: BTreeMap<&str, Vec<Vec<&str>>> = BTreeMap::new();
    for line in NAMES.lines().filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = line.split('\t').collect();
        houses.entry(cells[0]).or_default().push(cells);
    }
    let (mut asked, mut silent, mut main, mut close) = (0, 0, 0, 0);
    for (name, rows) in houses {
        let house = Arc::new(dwell_houses::open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        for row in rows {
            let id = house
                .objects
                .ids()
                .find(|id| house.objects[*id].name == row[1]);
            let spoken = semantics.facts(id.unwrap()).spoken_colors();
            let readers: Vec<_> = row[2..].iter().map(|cell| words(cell)).collect();
            let main_words = || readers.iter().map(|(named, _)| named[0]);
            let votes = |word: &str| main_words().filter(|other| *other == word).count();
            let majority = main_words().find(|word| 2 * votes(word) > readers.len());
            let Some(majority) = majority.filter(|word| !["clear", "patterned"].contains(word))
            else {
                continue;
            };
            let Some((word, _)) = spoken.first() else {
                silent += 1;
                continue;
            };
            asked += 1;
            // Things of two colours are named by both; cream is what some call white, others beige.
            let meets = |own: &str, given: &&str| own == *given || color::divides(own, given);
            main += u32::from(spoken.iter().any(|(own, _)| meets(own, &majority)));
            let mut given = readers
                .iter()
                .flat_map(|(named, other)| named.iter().chain(other));
            close += u32::from(given.any(|given| meets(word, given)));
        }
    }
    println!(
        "{asked} things: {main} by the word of the majority, {close} by any that was given; {silent} without a colour"
    );
    assert!(asked >= 250);
    assert!(main * 100 >= asked * 92, "{main} of {asked}");
    assert!(close * 100 >= asked * 96, "{close} of {asked}");
}
