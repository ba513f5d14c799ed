//! Reads sentences, one a line, and prints what each is understood as, or why it is not: for whoever works on a grammar.
//!
//! `cargo run -p dwell-semantics --example read_sentences GRAMMAR.toml LEXICON.toml < SENTENCES.txt`

use dwell_semantics::language::Language;
use std::io::{BufRead, Write};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [grammar, lexicon] = &files[..] else {
        return Err("expected GRAMMAR.toml LEXICON.toml, and sentences on standard input".into());
    };
    let language = Language::new(
        &std::fs::read_to_string(grammar)?,
        &std::fs::read_to_string(lexicon)?,
    )?;
    let mut out = std::io::stdout().lock();
    let (mut read, mut all) = (0, 0);
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        all += 1;
        match language.read(&line) {
            Ok(reading) => {
                read += 1;
                let said = language.say(&reading.forms[0], None);
                let said = said.map_or_else(|| format!("{:?}", reading.forms[0]), |said| said.text);
                writeln!(out, "+ {line}\n    {said}")?;
            }
            Err(error) => writeln!(out, "- {line}\n    {error}")?,
        }
    }
    writeln!(out, "{read} of {all} are read")?;
    Ok(())
}
