//! Sentences that people wrote who saw pictures of houses and a list of words: what was understood as they meant it stays so, and
//! the others are answered by what was not understood.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_semantics::language::Language;

/// Sentences, each with what it is understood as in the engine's own words; `*` for what these words do not cover, `-` for what is
/// not understood, or not as it was meant.
const SENTENCES: &str = include_str!("sentences_of_people.tsv");

#[test]
fn sentences_of_people_are_understood_as_they_were_meant() {
    let english = Language::english();
    let (mut understood, mut all) = (0, 0);
    for line in SENTENCES.lines().filter(|line| !line.starts_with('#')) {
        let (text, meant) = line.split_once('\t').unwrap();
        all += 1;
        let reading = english.read(text);
        match (meant, reading) {
            ("-", Ok(_)) => {}
            ("-", Err(error)) => assert!(error.to_string().len() > 10, "{text}: {error}"),
            (_, Err(error)) => panic!("{text}: {error}"),
            (meant, Ok(reading)) => {
                understood += 1;
                let said = english.say(&reading.forms[0], None);
                if meant != "*" {
                    assert_eq!(said.map(|said| said.text).as_deref(), Some(meant), "{text}");
                }
            }
        }
    }
    assert_eq!((understood, all), (3954, 5123));
}
