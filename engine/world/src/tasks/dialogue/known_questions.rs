//! The scripted asker: which question it asks next, and which things it has not ruled out.
//!
//! It knows the house and the things that the instruction fits, and of the one that is meant the oracle's replies alone.
//!
//! # Source
//! The question whose reply has the greatest expected information (C. E. Shannon, "A mathematical theory of communication", Bell System
//! Technical Journal 27, 379, 1948): things that have the same reply are one outcome, and all that are left are equally probable.

use crate::episode::{MAX_QUESTION_TOKENS, QuestionTokens};
use dwell_semantics::check::Checker;
use dwell_semantics::dialogue::{self, AmbiguousInstruction, Reply};
use dwell_semantics::{Term, vocabulary};
use std::collections::BTreeMap;

/// Least expected information of a question that is worth a thought, bits.
const LEAST_BITS: f64 = 1e-9;

/// A question, and which things would have the same reply to it.
#[derive(Clone, Debug)]
struct KnownQuestion {
    tokens: QuestionTokens,
    /// A number for each thing, the same for the same reply. Shape (thing,).
    outcomes: Vec<usize>,
}

/// The questions that an asker knows in an episode.
#[derive(Clone, Debug)]
pub(super) struct KnownQuestions {
    questions: Vec<KnownQuestion>,
}

/// What a question costs and what success is worth to the asker.
#[derive(Clone, Copy, Debug)]
pub(super) struct DialogueRewards {
    pub(super) success: f64,
    pub(super) question_cost: f64,
}

/// The words of a question as it is asked; `None` for too many, and words outside the vocabulary.
fn question_tokens(text: &str) -> Option<QuestionTokens> {
    let words = vocabulary::tokenize(text).ok()?;
    let mut words = words
        .into_iter()
        .take_while(|token| *token != vocabulary::PAD);
    let mut tokens = [0; MAX_QUESTION_TOKENS];
    for (token, word) in tokens.iter_mut().zip(words.by_ref()) {
        *token = word.cast_unsigned();
    }
    words.next().is_none().then_some(tokens)
}

impl KnownQuestions {
    /// Asks each question of the pool in thought, of each thing.
    pub(super) fn new(checker: &Checker<'_>, asked: &AmbiguousInstruction) -> Self {
        let pool = dialogue::question_pool(checker, &asked.things);
        let known = pool.into_iter().filter_map(|question| {
            let tokens = question_tokens(&question.text)?;
            let mut replies: Vec<Reply> = Vec::new();
            let outcomes = asked.things.iter().map(|thing| {
                let reply = dialogue::reply(checker, &question.form, Term::Object(*thing));
                let known = replies.iter().position(|own| *own == reply);
                known.unwrap_or_else(|| {
                    replies.push(reply);
                    replies.len() - 1
                })
            });
            let outcomes: Vec<usize> = outcomes.collect();
            (replies.len() > 1).then_some(KnownQuestion { tokens, outcomes })
        });
        Self {
            questions: known.collect(),
        }
    }

    /// Returns whether some question tells each two of so many things apart.
    pub(super) fn distinguishes_all(&self, things: usize) -> bool {
        let told = |one: usize, other: usize| {
            let mut questions = self.questions.iter();
            questions.any(|question| question.outcomes[one] != question.outcomes[other])
        };
        (0..things).all(|one| (0..one).all(|other| told(one, other)))
    }

    /// The question to ask next, of `left` things and with `budget` questions left; `None` where a guess is worth as much.
    pub(super) fn next_question(
        &self,
        left: &[usize],
        budget: u32,
        stakes: DialogueRewards,
    ) -> Option<QuestionTokens> {
        if left.len() < 2 || budget == 0 {
            return None;
        }
        let (question, parts) = self.best_split(left)?;
        let asked = self.value_of_parts(&parts, left.len(), budget, stakes);
        (asked > guess_value(left.len(), stakes)).then_some(question.tokens)
    }

    /// The question with the greatest expected information, the first of several, and the things by its outcomes.
    fn best_split(&self, left: &[usize]) -> Option<(&KnownQuestion, Vec<Vec<usize>>)> {
        let mut best: Option<(f64, &KnownQuestion, Vec<Vec<usize>>)> = None;
        for question in &self.questions {
            let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
            for thing in left {
                parts
                    .entry(question.outcomes[*thing])
                    .or_default()
                    .push(*thing);
            }
            let parts: Vec<Vec<usize>> = parts.into_values().collect();
            let bits = information_bits(&parts, left.len());
            let known = best.as_ref().map_or(LEAST_BITS, |(bits, ..)| *bits);
            if bits > known + LEAST_BITS {
                best = Some((bits, question, parts));
            }
        }
        best.map(|(_, question, parts)| (question, parts))
    }

    /// What is expected after a question, its cost taken off.
    fn value_of_parts(
        &self,
        parts: &[Vec<usize>],
        count: usize,
        budget: u32,
        stakes: DialogueRewards,
    ) -> f64 {
        let parts = parts
            .iter()
            .map(|part| part.len() as f64 / count as f64 * self.value(part, budget - 1, stakes));
        parts.sum::<f64>() - stakes.question_cost
    }

    /// What is expected where one goes on asking as long as it pays.
    fn value(&self, left: &[usize], budget: u32, stakes: DialogueRewards) -> f64 {
        let guess = guess_value(left.len(), stakes);
        if left.len() < 2 || budget == 0 {
            return guess;
        }
        let Some((_, parts)) = self.best_split(left) else {
            return guess;
        };
        guess.max(self.value_of_parts(&parts, left.len(), budget, stakes))
    }
}

/// What is expected of a guess among so many things.
fn guess_value(things: usize, stakes: DialogueRewards) -> f64 {
    stakes.success / things.max(1) as f64
}

/// The expected information of a question by how many things have each reply, bits.
fn information_bits(parts: &[Vec<usize>], count: usize) -> f64 {
    let shares = parts.iter().map(|part| part.len() as f64 / count as f64);
    let ln = |share: f64| f64::from(dwell_scene::math::ln(share as f32));
    shares
        .map(|share| -share * ln(share) / std::f64::consts::LN_2)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STAKES: DialogueRewards = DialogueRewards {
        success: 2.5,
        question_cost: 0.1,
    };

    /// Questions by their outcomes; the first token is the question's number.
    fn asker(outcomes: &[&[usize]]) -> KnownQuestions {
        let questions = outcomes.iter().zip(1..).map(|(outcomes, number)| {
            let mut tokens = [0; MAX_QUESTION_TOKENS];
            tokens[0] = number;
            KnownQuestion {
                tokens,
                outcomes: outcomes.to_vec(),
            }
        });
        KnownQuestions {
            questions: questions.collect(),
        }
    }

    #[test]
    fn the_question_that_halves_comes_before_those_that_single_one_out() {
        let own = asker(&[&[0, 0, 0, 1], &[0, 0, 1, 1], &[1, 0, 0, 0], &[0, 1, 0, 1]]);
        let first = |left: &[usize], budget| {
            let asked = own.next_question(left, budget, STAKES);
            asked.map(|tokens| tokens[0])
        };
        assert_eq!(first(&[0, 1, 2, 3], 8), Some(2));
        assert_eq!(first(&[0, 1], 8), Some(3));
        assert_eq!(first(&[2, 3], 8), Some(1));
        assert_eq!(first(&[2], 8), None);
        assert_eq!(first(&[0, 1, 2, 3], 0), None);
        assert!(own.distinguishes_all(4));
        assert!(!asker(&[&[0, 0, 1]]).distinguishes_all(3));
    }

    /// Of two things a question raises the chance from one half to one: worth half of the success, 1.25, and no more.
    #[test]
    fn a_question_is_asked_where_it_pays() {
        let own = asker(&[&[0, 1]]);
        for (question_cost, is_asked) in [(1.24, true), (1.26, false)] {
            let stakes = DialogueRewards {
                question_cost,
                ..STAKES
            };
            let asked = own.next_question(&[0, 1], 1, stakes);
            assert_eq!(asked.is_some(), is_asked, "{question_cost}");
        }
        // What tells nothing is not asked, free as it may be.
        let stakes = DialogueRewards {
            question_cost: 0.0,
            ..STAKES
        };
        assert_eq!(asker(&[&[0, 0]]).next_question(&[0, 1], 9, stakes), None);
    }

    #[test]
    fn words_become_tokens_up_to_the_most() {
        let tokens = question_tokens("Is it red?").unwrap();
        let words: Vec<i32> = tokens.iter().map(|token| token.cast_signed()).collect();
        assert_eq!(vocabulary::detokenize(&words), "is it red ?");
        assert_eq!(question_tokens("Is it xyzzy?"), None);
        assert_eq!(question_tokens(&"red ".repeat(17)), None);
        assert!(question_tokens(&"red ".repeat(16)).is_some());
    }
}
