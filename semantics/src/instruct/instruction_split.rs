//! Splits of instructions by their words: what is kept from training, so that one can test what was learnt of words and what of
//! sentences.
//!
//! # Source
//! Held-out combinations of colour and noun, and of relation and noun, as tests of systematic generalization: L. Ruis et al., "A
//! Benchmark for Systematic Generalization in Grounded Language Understanding", `NeurIPS` 2020 (gSCAN, splits B to E); B. Lake and
//! M. Baroni, "Generalization without Systematicity", ICML 2018 (SCAN).

use super::task::{keeps_to_limits, say};
use crate::form::{Form, Noun, Phrase, RequestStep};
use crate::language::{Language, Sentence};
use dwell_scene::random::RandomKey;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Relations that are held out. Others are as common, so that neither side is empty in most houses.
const RELATIONS: [&str; 3] = ["under", "above", "between"];
/// One of so many pairs of colour and noun is held out.
const PAIRS: u64 = 5;
/// Wordings that are drawn for one instruction until one has what is asked.
const DRAWS: u64 = 16;

/// Which instructions are asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InstructionSplit {
    /// All.
    #[default]
    All,
    /// None with anything that is held out.
    Train,
    /// Those with a held-out pair of colour and noun, and nothing else that is held out: one in five pairs, by the letters of both.
    Colors,
    /// Those with a held-out relation, and nothing else that is held out: `under`, `above` and `between`.
    Relations,
    /// Those in a held-out wording, and with nothing else that is held out: the last of the wordings of a rule or verb.
    Wordings,
}

impl InstructionSplit {
    /// Returns whether a form has what is asked, its wording aside.
    pub fn admits(self, form: &Form) -> bool {
        let (mut pair, mut relation) = (false, false);
        for phrase in form.phrases() {
            let Phrase::Described(own) = phrase else {
                continue;
            };
            if let Noun::Object(noun) = &own.noun {
                pair |= own.colors.iter().any(|color| is_held_out_pair(color, noun));
            }
            let relations = own.modifiers.iter().map(|own| own.predicate.as_str());
            relation |= relations.into_iter().any(|own| RELATIONS.contains(&own));
        }
        match self {
            Self::All => true,
            Self::Train | Self::Wordings => !pair && !relation,
            Self::Colors => pair && !relation,
            Self::Relations => relation && !pair,
        }
    }

    /// The text of a form in a wording drawn from `key`; `None` where the language has no words for it, too many, or none of the split.
    fn say(self, language: &Language, form: &Form, key: RandomKey) -> Option<Sentence> {
        if self == Self::All {
            return say(language, form, Some(key));
        }
        (0..DRAWS).find_map(|k| {
            let mut stream = key.child("wording").child(k).stream();
            let mut is_held_out = false;
            let mut choose = |count: usize| {
                let last = count - 1;
                let chosen = match self {
                    Self::Wordings => stream.below(count),
                    _ => stream.below(last.max(1)),
                };
                is_held_out |= last > 0 && chosen == last;
                chosen
            };
            let said = language.say_choosing(form, &mut choose)?;
            let fits = is_held_out == (self == Self::Wordings);
            (fits && keeps_to_limits(&said)).then_some(said)
        })
    }

    /// The instruction of some requests, one after the other, in a wording drawn from `key`; `None` where the language has no words for
    /// it, too many, or it is none of the split.
    pub fn compose(
        self,
        language: &Language,
        requests: Vec<RequestStep>,
        key: RandomKey,
    ) -> Option<Sentence> {
        let form = Form::Request(requests);
        self.admits(&form)
            .then(|| self.say(language, &form, key))
            .flatten()
    }
}

/// Returns whether a pair of colour and noun is held out.
fn is_held_out_pair(color: &str, noun: &str) -> bool {
    let key = RandomKey::root(0).child("held out").child(color);
    key.child(noun).stream().bits().is_multiple_of(PAIRS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form::{Description, Modifier, Quantifier};
    use std::collections::BTreeSet;

    const COLORS: [&str; 8] = [
        "red", "green", "blue", "white", "black", "gray", "brown", "yellow",
    ];
    const NOUNS: [&str; 6] = ["chair", "table", "lamp", "book", "mug", "sofa"];

    fn thing(color: &str, noun: &str) -> Description {
        let mut own = Description::new(Quantifier::The, Noun::Object(noun.to_owned()));
        own.colors.push(color.to_owned());
        own
    }

    fn request(verb: &str, object: Description) -> RequestStep {
        RequestStep::Do {
            verb: verb.to_owned(),
            object: object.into(),
        }
    }

    fn texts(split: InstructionSplit, request: &RequestStep) -> BTreeSet<String> {
        let language = Language::english();
        let keys = (0..40).map(RandomKey::root);
        keys.filter_map(|key| split.compose(language, vec![request.clone()], key))
            .map(|said| said.text)
            .collect()
    }

    /// Each pair is asked in training or held out, never both, and some 20 % are held out: of 48 pairs 4 to 16, outside of which a fair
    /// draw falls once in 200 times on either side.
    #[test]
    fn pairs_are_in_one_split_alone() {
        let mut held_out = 0;
        for color in COLORS {
            for noun in NOUNS {
                let asked = Form::Request(vec![request("find", thing(color, noun))]);
                let splits = [InstructionSplit::Train, InstructionSplit::Colors];
                let [train, colors] = splits.map(|split| split.admits(&asked));
                assert!(train != colors, "{color} {noun}");
                held_out += usize::from(colors);
                assert!(
                    !InstructionSplit::Relations.admits(&asked)
                        && InstructionSplit::All.admits(&asked)
                );
            }
        }
        assert!((4..=16).contains(&held_out), "{held_out}");
    }

    #[test]
    fn relations_are_in_one_split_alone() {
        let noun = |noun: &str| Description::new(Quantifier::The, Noun::Object(noun.to_owned()));
        for (relation, is_held_out) in [("under", true), ("on", false), ("next_to", false)] {
            let beside = Modifier::new(relation, [noun("table").into()]);
            let asked = Form::Request(vec![request("find", noun("book").with_modifier(beside))]);
            assert_eq!(
                InstructionSplit::Relations.admits(&asked),
                is_held_out,
                "{relation}"
            );
            assert_eq!(
                InstructionSplit::Train.admits(&asked),
                !is_held_out,
                "{relation}"
            );
        }
    }

    /// No wording of training is one of those that are held out, and both are several.
    #[test]
    fn wordings_are_in_one_split_alone() {
        let noun = |noun: &str| Description::new(Quantifier::The, Noun::Object(noun.to_owned()));
        for verb in ["find", "pick_up", "close"] {
            let asked = request(verb, noun("book"));
            let train = texts(InstructionSplit::Train, &asked);
            let held_out = texts(InstructionSplit::Wordings, &asked);
            assert!(!train.is_empty() && !held_out.is_empty(), "{verb}");
            assert!(
                train.is_disjoint(&held_out),
                "{verb}: {train:?} {held_out:?}"
            );
            let all = texts(InstructionSplit::All, &asked);
            assert!(
                all.iter().any(|text| held_out.contains(text)),
                "{verb}: {all:?}"
            );
        }
    }
}
