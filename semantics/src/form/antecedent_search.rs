//! The search of antecedents among what was named before.

use super::antecedent::{Mention, Resolver};
use super::mention::{is_indefinite_singular, may_be_one, meets_selectional_restriction};
use super::visit::PhraseRole;
use super::{Description, Form, Noun, Phrase, Quantifier};

impl Resolver {
    /// What "they" stands for: the last thing that a clause is about, several of them before one.
    pub(super) fn things_named(&self) -> Option<&Description> {
        let named = |mention: &'_ Mention| match &mention.phrase {
            Phrase::Described(_) => Form::NounPhrase(mention.phrase.clone()).is_free_of_anaphora(),
            _ => false,
        };
        let earlier = || self.mentions.iter().rev().filter(|mention| named(mention));
        let is_topic = |mention: &&Mention| mention.role == PhraseRole::Topic;
        let is_definite = |mention: &&Mention| matches!(&mention.phrase, Phrase::Described(own) if own.quantifier == Quantifier::The);
        let is_several = |mention: &&Mention| !may_be_one(&mention.phrase);
        // "The wardrobe has three doors, and all of them are shut": the doors.
        let found = earlier()
            .find(|mention| is_topic(mention) && is_several(mention))
            .or_else(|| {
                earlier().find(|mention| mention.with_said.is_some() && is_several(mention))
            })
            // "The cup is next to the plate, and they are white" names both, which no phrase of the form does.
            .or_else(|| earlier().find(|mention| is_topic(mention) && !is_definite(mention)))?;
        match &found.phrase {
            Phrase::Described(named) => Some(found.with_said.as_ref().unwrap_or(named)),
            _ => None,
        }
    }

    /// The last room that an earlier clause or step is about.
    pub(super) fn room_before(&self) -> Option<Phrase> {
        let mut rooms = self.mentions.iter().rev().filter(|mention| {
            mention.unit < self.unit
                && matches!(
                    &mention.phrase,
                    Phrase::Described(own)
                        if matches!(own.noun, Noun::Room(_)) && own.quantifier == Quantifier::The
                )
        });
        rooms.next().map(|mention| mention.phrase.clone())
    }

    /// The noun of the last object that differs from `own` in a quality of the same kind: "the purple vase on the shelf next to the
    /// yellow one" is next to a yellow vase.
    pub(super) fn contrasted(&self, own: &Description) -> Option<Noun> {
        let differs = |named: &Description| {
            let colors = !own.colors.is_empty() && !named.colors.is_empty();
            let sizes = own.size.is_some() && named.size.is_some();
            let states = own.state.is_some() && named.state.is_some();
            let materials = own.material.is_some() && named.material.is_some();
            colors && own.colors != named.colors
                || sizes && own.size != named.size
                || states && own.state != named.state
                || materials && own.material != named.material
        };
        self.mentions
            .iter()
            .rev()
            .find_map(|mention| match &mention.phrase {
                Phrase::Described(named)
                    if matches!(named.noun, Noun::Object(_)) && differs(named) =>
                {
                    Some(named.noun.clone())
                }
                _ => None,
            })
    }

    /// The noun of the last object in a role, else of the last one.
    pub(super) fn noun_in_role(&self, role: PhraseRole) -> Option<Noun> {
        let noun = |mention: &Mention| match &mention.phrase {
            Phrase::Described(own) if matches!(own.noun, Noun::Object(_)) => Some(own.noun.clone()),
            _ => None,
        };
        let mentions = || self.mentions.iter().rev();
        let same = mentions()
            .filter(|mention| mention.role == role)
            .find_map(noun);
        // "Both armchairs are yellow, but the nearest one has a pillow on it": the nearest armchair.
        let earlier = || {
            mentions()
                .filter(|mention| mention.unit < self.unit)
                .find_map(noun)
        };
        same.or_else(earlier).or_else(|| mentions().find_map(noun))
    }

    /// The noun of what the same clause compares.
    pub(super) fn compared_noun(&self) -> Option<Noun> {
        self.mentions.iter().rev().find_map(|mention| {
            let is_compared = mention.unit == self.unit && mention.role == PhraseRole::Topic;
            match &mention.phrase {
                Phrase::Described(own) if is_compared && matches!(own.noun, Noun::Object(_)) => {
                    Some(own.noun.clone())
                }
                _ => None,
            }
        })
    }

    /// The things that "it" may stand for, the preferred one first.
    pub(super) fn candidates(&self, verb: Option<&str>) -> Vec<Phrase> {
        let mut found = self.named_before(verb);
        // What stands for something itself is no antecedent.
        found.retain(|phrase| Form::NounPhrase(phrase.clone()).is_free_of_anaphora());
        found
    }

    pub(super) fn named_before(&self, verb: Option<&str>) -> Vec<Phrase> {
        if let Some(subject) = &self.subject {
            return vec![subject.clone()];
        }
        let earlier = self
            .mentions
            .iter()
            .filter(|mention| mention.unit < self.unit);
        let mut earlier: Vec<&Mention> = earlier.collect();
        // What a step is about before landmarks, of either the last one first.
        earlier.sort_by_key(|mention| {
            let suits =
                verb.is_none_or(|verb| meets_selectional_restriction(verb, &mention.phrase));
            let landmark = mention.role == PhraseRole::Landmark;
            (
                !suits,
                landmark,
                usize::MAX - mention.unit,
                !mention.is_argument,
            )
        });
        let mut phrases: Vec<Phrase> = Vec::new();
        for mention in earlier {
            let is_room = matches!(
                &mention.phrase,
                Phrase::Described(own) if matches!(own.noun, Noun::Room(_))
            );
            // "The hood is above it": not above itself.
            let mut own = self.mentions.iter();
            let is_own = own.any(|own| own.unit == self.unit && own.phrase == mention.phrase);
            // "A pan is on the stove, and it is empty": a pan on the stove.
            let phrase = match &mention.with_said {
                Some(said) if is_indefinite_singular(said) => said.clone().into(),
                _ => mention.phrase.clone(),
            };
            if !is_room && !is_own && !phrases.contains(&phrase) {
                phrases.push(phrase);
            }
        }
        // "One chair is behind the table, and the other is in front of it": of the table.
        let others: Vec<Noun> = self
            .mentions
            .iter()
            .filter(|mention| mention.unit == self.unit)
            .filter_map(|mention| match &mention.phrase {
                // "The floor behind it" is not behind a floor.
                Phrase::Described(own) => (matches!(own.noun, Noun::Structure(_))
                    || own
                        .modifiers
                        .iter()
                        .any(|modifier| modifier.arguments.contains(&Phrase::NamedBefore)))
                .then(|| own.noun.clone()),
                _ => None,
            })
            .collect();
        let is_other = |phrase: &Phrase| matches!(phrase, Phrase::Described(own) if others.contains(&own.noun));
        if phrases.iter().any(|phrase| !is_other(phrase)) {
            phrases.retain(|phrase| !is_other(phrase));
        }
        // "Both bottles are on the table, and the tray is next to it": next to the table.
        if phrases.iter().any(may_be_one) {
            phrases.retain(may_be_one);
        }
        if phrases.is_empty() {
            // "The cup is larger than the tray that supports it": a thing of the same clause, not the one described.
            let own = self
                .mentions
                .iter()
                .filter(|mention| mention.unit == self.unit && mention.role == PhraseRole::Topic);
            let own: Vec<&Mention> = own.collect();
            if let [first, .., _] = own[..] {
                phrases.push(first.phrase.clone());
            }
        }
        phrases
    }
}
