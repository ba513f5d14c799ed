//! How well the questions of `EmbodiedQA` are answered by who sees nothing, from the answers in other houses: tables as Markdown.
//!
//! `cargo run -p dwell-tests --example question_priors -- 400 100 40`: numbers of houses of the splits train and val, of questions drawn in
//! each. With a file as fourth argument the texts are written there that are to be left out as guessable, beside those that are now.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{Engines, Env, EnvConfig, SensorConfig, WorldConfig};
use dwell_scene::interrupt;
use dwell_semantics::ask;
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::sync::Arc;

/// Share of the most frequent answer from which a text is guessable; by Wilson's interval of 95 % it must be more than half, too, so that
/// chance makes no text of a few houses guessable. A house counts once.
const GUESSABLE: f64 = 0.7;
const Z: f64 = 1.96;

/// The lower end of Wilson's interval (E. B. Wilson, 1927) of a share of `total`.
fn lower_bound(share: f64, total: f64) -> f64 {
    let z2 = Z * Z / total;
    let spread = Z * (share * (1.0 - share) / total + z2 / (4.0 * total)).sqrt();
    (share + z2 / 2.0 - spread) / (1.0 + z2)
}

/// A question that was drawn.
struct Drawn {
    house: u64,
    kind: &'static str,
    text: String,
    answer: usize,
}

type Counts = BTreeMap<usize, usize>;

/// The most frequent answer, and its share.
fn best(counts: &Counts) -> (usize, f64) {
    let total: usize = counts.values().sum();
    let (answer, count) = (counts.iter())
        .max_by_key(|(answer, count)| (**count, usize::MAX - **answer))
        .map_or((0, 0), |(answer, count)| (*answer, *count));
    (answer, count as f64 / total.max(1) as f64)
}

/// Questions of the houses of a split, whose seeds end in certain digits.
fn draw(
    digits: std::ops::RangeInclusive<u64>,
    houses: usize,
    each: u64,
) -> Result<Vec<Drawn>, Box<dyn Error>> {
    let seeds = (0..).filter(|seed: &u64| digits.contains(&(seed % 10)));
    let mut all = Vec::new();
    for house in seeds.take(houses) {
        interrupt::unwind_if_cancelled();
        let (opened, _) = dwell_houses::open(&format!("seed:{house}"))?;
        let config = EnvConfig {
            task: "EmbodiedQA".to_owned(),
            sensors: Some(vec![SensorConfig {
                kind: "question".to_owned(),
                settings: json!({}),
            }]),
            world: WorldConfig {
                settle_s: Some(0.0),
                ..WorldConfig::default()
            },
            ..EnvConfig::default()
        };
        let mut env = Env::new(Engines::new(Arc::new(opened)), &config)?;
        // Others in each house: kind and answer are drawn by the seed.
        for seed in house * each..(house + 1) * each {
            if let Err(error) = env.reset(seed) {
                println!("{error}");
                break;
            }
            let episode = env.episode(0)?;
            all.push(Drawn {
                house,
                kind: episode.goal.kind,
                text: episode.instruction.clone(),
                answer: env.expert_step(0)?.answer[0] as usize,
            });
        }
    }
    Ok(all)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, default: usize| -> Result<usize, Box<dyn Error>> {
        Ok(match arguments.get(at) {
            Some(text) => text.parse()?,
            None => default,
        })
    };
    let (train_houses, val_houses, each) = (number(0, 40)?, number(1, 10)?, number(2, 40)?);
    let train = draw(0..=7, train_houses, each as u64)?;
    let val = draw(8..=8, val_houses, each as u64)?;
    let mut by_text: BTreeMap<&str, (Counts, BTreeMap<u64, usize>)> = BTreeMap::new();
    let mut by_kind: BTreeMap<&str, Counts> = BTreeMap::new();
    for drawn in &train {
        let (counts, houses) = by_text.entry(&drawn.text).or_default();
        *counts.entry(drawn.answer).or_default() += 1;
        houses.entry(drawn.house).or_insert(drawn.answer);
        *by_kind
            .entry(drawn.kind)
            .or_default()
            .entry(drawn.answer)
            .or_default() += 1;
    }
    println!(
        "{} questions, {} texts in train; {} in val",
        train.len(),
        by_text.len(),
        val.len()
    );
    println!("| kind | questions | answers | most frequent answer | same for its text |");
    println!("| --- | --- | --- | --- | --- |");
    let mut all = [0.0; 2];
    for (kind, counts) in &by_kind {
        let own: Vec<&Drawn> = val.iter().filter(|drawn| drawn.kind == *kind).collect();
        let (constant, _) = best(counts);
        let by_constant = own.iter().filter(|drawn| drawn.answer == constant).count();
        let by_words = own.iter().filter(|drawn| {
            let known = by_text.get(drawn.text.as_str());
            drawn.answer == known.map_or(constant, |(counts, _)| best(counts).0)
        });
        let by_words = by_words.count();
        let share = |right: usize| 100.0 * right as f64 / own.len().max(1) as f64;
        all[0] += by_constant as f64;
        all[1] += by_words as f64;
        let (constant, answers) = (&ask::answers()[constant], counts.len());
        println!(
            "| `{kind}` | {} | {answers} | {:.0} % (`{constant}`) | {:.0} % |",
            own.len(),
            share(by_constant),
            share(by_words)
        );
    }
    let [constant, words] = all.map(|right| 100.0 * right / val.len().max(1) as f64);
    println!("| all | {} | | {constant:.0} % | {words:.0} % |", val.len());
    for kind in by_kind.keys() {
        let mut examples = train.iter().filter(|drawn| drawn.kind == *kind);
        for _ in 0..4 {
            if let Some(Drawn { text, answer, .. }) = examples.nth(7) {
                println!("{kind}: {text} {}", ask::answers()[*answer]);
            }
        }
    }
    if let Some(path) = arguments.get(3) {
        let known = std::fs::read_to_string(path).unwrap_or_default();
        let mut texts: BTreeSet<&str> = known.lines().collect();
        let guessable = by_text.iter().filter(|(_, (_, by_house))| {
            let mut counts = Counts::new();
            for answer in by_house.values() {
                *counts.entry(*answer).or_default() += 1;
            }
            let share = best(&counts).1;
            share >= GUESSABLE && lower_bound(share, by_house.len() as f64) > 0.5
        });
        texts.extend(guessable.map(|(text, _)| *text));
        let lines: Vec<&str> = texts.into_iter().collect();
        println!("{} guessable texts", lines.len());
        std::fs::write(path, lines.join("\n") + "\n")?;
    }
    Ok(())
}
