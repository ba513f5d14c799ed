//! Plays the task `Dialogue` in houses of the split `val`: its scripted asker, the same one without questions and with questions drawn from
//! a list, and random actions; says how often each succeeds, by the number of things that the instruction fits.
//!
//! `cargo run -p dwell-tests --example dialogue_baselines -- [FROM..TO [EPISODES]]`: by default the first 30 houses of the split with 10
//! episodes each.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{DiscreteAction, Engines, Env, EnvConfig, QuestionTokens, StepAction, StepInfo};
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_semantics::vocabulary;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Every tenth seed is a house of the split: those that end in this digit.
const DIGIT: u64 = 8;

/// Who plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Player {
    /// The scripted asker.
    Expert,
    /// The same with questions drawn from a list in place of its own.
    RandomQuestions,
    /// The same without questions.
    NoQuestions,
    /// Actions with equal chances.
    RandomActions,
}

/// What came of some episodes.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    solved: u32,
    all: u32,
    questions: f64,
    steps: u64,
    /// The sum of 1 / n.
    chance: f64,
}

/// Yes-no questions that need no knowledge of the house.
fn questions() -> Vec<QuestionTokens> {
    let mut words: Vec<String> = dwell_semantics::color::ColorVocabulary::Plain
        .words()
        .into_iter()
        .map(str::to_owned)
        .collect();
    words.extend(["large", "small", "wooden", "metal", "plastic"].map(str::to_owned));
    let rooms = [
        "kitchen",
        "bedroom",
        "bathroom",
        "living room",
        "dining room",
        "hall",
        "study",
        "garage",
    ];
    words.extend(rooms.map(|room| format!("in the {room}")));
    let tokens = words.iter().filter_map(|word| {
        let said = vocabulary::tokenize(&format!("Is it {word}?")).ok()?;
        let mut tokens = QuestionTokens::default();
        for (token, word) in tokens.iter_mut().zip(said) {
            *token = word.cast_unsigned();
        }
        Some(tokens)
    });
    tokens.collect()
}

/// Plays an episode; the last step's info.
fn play(
    env: &mut Env,
    player: Player,
    asked: &[QuestionTokens],
    mut stream: RandomStream,
    steps: &mut u64,
) -> Result<StepInfo, Box<dyn std::error::Error>> {
    loop {
        let mut action = env.expert_step(0)?;
        if player == Player::RandomActions {
            let choices = DiscreteAction::DEFAULT;
            action = StepAction::from(choices[stream.below(choices.len())]);
        }
        if player == Player::RandomQuestions && action.question[0] != 0 {
            action.question = asked[stream.below(asked.len())];
        }
        let info = env.step(&[Some(action)])?.swap_remove(0);
        *steps += 1;
        if info.result.terminated || env.steps() >= 1000 {
            return Ok(info);
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let houses = words.first().map_or("0..30", String::as_str);
    let (from, to) = houses
        .split_once("..")
        .ok_or("houses are written FROM..TO")?;
    let (from, to): (u64, u64) = (from.parse()?, to.parse()?);
    let episodes: u64 = words.get(1).map_or(Ok(10), |count| count.parse())?;
    let asked = questions();
    let mut tallies: BTreeMap<(Player, usize), Tally> = BTreeMap::new();
    let mut refused = 0;
    for house in from..to {
        let name = format!("seed:{}?split=val", 10 * house + DIGIT);
        let (opened, _) = dwell_houses::open(&name)?;
        let engines = Engines::new(Arc::new(opened));
        for player in [
            Player::Expert,
            Player::RandomQuestions,
            Player::NoQuestions,
            Player::RandomActions,
        ] {
            let mut settings = json!({});
            if player == Player::NoQuestions {
                settings["max_questions"] = json!(0);
            }
            let config = EnvConfig {
                task: "Dialogue".to_owned(),
                task_settings: settings,
                sensors: Some(Vec::new()),
                ..EnvConfig::default()
            };
            let mut env = Env::new(engines.clone(), &config)?;
            for seed in house * 1000..house * 1000 + episodes {
                if let Err(error) = env.reset(seed) {
                    println!("{name}, episode {seed}: {error}");
                    refused += 1;
                    continue;
                }
                let stream = RandomKey::root(seed).child("player").child(house).stream();
                let mut steps = 0;
                let info = play(&mut env, player, &asked, stream, &mut steps)?;
                let things = info.measures[2] as usize;
                if player == Player::Expert && !info.result.success {
                    let said = env.episode(0).map(|own| own.instruction.clone());
                    println!(
                        "{name}, episode {seed}: not solved: {said:?} {:?}",
                        info.measures
                    );
                }
                for count in [0, things] {
                    let tally = tallies.entry((player, count)).or_default();
                    tally.all += 1;
                    tally.solved += u32::from(info.result.success);
                    tally.questions += info.measures[0];
                    tally.steps += steps;
                    tally.chance += 1.0 / things as f64;
                }
            }
        }
    }
    println!("{refused} episodes could not be played");
    for ((player, things), tally) in tallies {
        let of = if things == 0 {
            "all".to_owned()
        } else {
            format!("n = {things}")
        };
        let count = f64::from(tally.all);
        println!(
            "{player:?}, {of}: {} of {} ({:.1} %), chance {:.1} %, {:.2} questions, {:.0} steps",
            tally.solved,
            tally.all,
            100.0 * f64::from(tally.solved) / count,
            100.0 * tally.chance / count,
            tally.questions / count,
            tally.steps as f64 / count
        );
    }
    Ok(())
}
