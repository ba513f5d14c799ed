//! The English lexicon: the file of function words, and the tables of nouns, rooms, colours and materials.

use crate::category::categories;
use crate::color::ColorVocabulary;
use crate::english::{GATHERING_WORDS, plural};
use crate::grammar::{GrammarError, Lexicon, LexiconEntry};
use crate::kind_noun::kind_nouns;
use crate::material_family::families;
use crate::room_kind::room_kinds;
use dwell_scene::material::library;
use serde::Deserialize;
use std::collections::BTreeMap;

pub(super) const NOUN: &str = "noun";
pub(super) const GATHERING: &str = "gathering";
pub(super) const GATHERED: &str = "gathered";
pub(super) const ROOM: &str = "room";
pub(super) const ROOM_NOUN: &str = "room_noun";
pub(super) const ROOM_SPOT: &str = "room_spot";
pub(super) const STRUCTURE: &str = "structure";
pub(super) const RELATION: &str = "relation";
pub(super) const VERB_RELATION: &str = "verb_relation";
pub(super) const ADJECTIVE_STATE: &str = "adjective_state";
pub(super) const ORDER: &str = "order";
pub(super) const ORDER_TO: &str = "order_to";
pub(super) const SUPERLATIVE: &str = "superlative";
pub(super) const VERB: &str = "verb";

type Texts = BTreeMap<String, Vec<String>>;
/// Texts with one and with several.
type TextPairs = BTreeMap<String, [Vec<String>; 2]>;

/// `lexicon.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LexiconFile {
    counts: Vec<String>,
    ordinals: Vec<String>,
    relation: Texts,
    #[serde(default)]
    converse: Texts,
    #[serde(default)]
    comparative: Texts,
    #[serde(default)]
    comparative_less: Texts,
    #[serde(default)]
    room_spot: Texts,
    verb_relation: TextPairs,
    noun: TextPairs,
    #[serde(default)]
    noun_synonym: Texts,
    #[serde(default)]
    verb_synonym: Texts,
    #[serde(default)]
    color_synonym: Texts,
    #[serde(default)]
    material_synonym: Texts,
    structure: TextPairs,
    state: Texts,
    adjective_state: Texts,
    size: Texts,
    order: Texts,
    superlative: Texts,
    order_to: Texts,
    verb: Texts,
}

/// Adds a noun in singular and plural. Of "pair of shoes" only the noun after the "of" is added; nouns of pieces of the building
/// have a class of their own.
pub(super) fn add_noun(lexicon: &mut Lexicon, one: &str, several: &str) {
    if lexicon.find(STRUCTURE, one).is_some() {
        return;
    }
    if let Some((head, tail)) = one.split_once(" of ")
        && GATHERING_WORDS.contains(&head)
    {
        lexicon.add_texts(GATHERED, tail, &[&[tail]]);
        // "The shoes", of which nobody counts the pairs; "the toilet paper".
        let texts: [&[&str]; 2] = if tail.ends_with('s') {
            [&[], &[tail]]
        } else {
            [&[tail], &[]]
        };
        lexicon.add_texts(NOUN, tail, &texts);
        return;
    }
    lexicon.add_texts(NOUN, one, &[&[one], &[several]]);
}

/// Adds the last word of a noun of several, where that is no noun yet: "rail" of "towel rail".
fn add_head(lexicon: &mut Lexicon, noun: &str) {
    let head = noun.rsplit(' ').next().unwrap_or(noun);
    let mut rooms = room_kinds().rows().iter();
    // "Kitchen" of "fitted kitchen" names a room.
    if rooms.any(|kind| kind.singular == head || kind.synonyms.contains(&head)) {
        return;
    }
    if noun.contains(" of ") || !noun.contains(' ') || lexicon.find(NOUN, head).is_some() {
        return;
    }
    lexicon.add_texts(NOUN, head, &[&[head], &[&plural(head)]]);
}

/// Adds a room's noun in singular and plural; `preposition` is that of being there: "in" or "on".
pub(super) fn add_room(lexicon: &mut Lexicon, noun: &str, several: &str, preposition: &str) {
    lexicon.add_texts(ROOM_NOUN, noun, &[&[noun], &[several]]);
    if preposition == "on" {
        lexicon.add_texts(ROOM, noun, &[&[], &[noun]]);
    } else {
        lexicon.add_texts(ROOM, noun, &[&[noun], &[]]);
    }
}

/// "Dark gray" and "dark grey".
fn spellings_of_gray(text: &str) -> Vec<String> {
    let british = text.replace("gray", "grey");
    if british == text {
        vec![british]
    } else {
        vec![text.to_owned(), british]
    }
}

fn borrowed(texts: &[String]) -> Vec<&str> {
    texts.iter().map(String::as_str).collect()
}

/// Builds the English lexicon from `lexicon.toml` and the tables.
///
/// # Errors
/// [`GrammarError`] for a file that cannot be read.
pub(super) fn english(file: &str) -> Result<Lexicon, GrammarError> {
    let file: LexiconFile =
        toml::from_str(file).map_err(|error| GrammarError::Syntax(error.to_string()))?;
    let mut lexicon = Lexicon::default();
    lexicon.set_numbers(&file.counts, &file.ordinals)?;
    let single = [
        (RELATION, &file.relation),
        ("converse", &file.converse),
        ("comparative", &file.comparative),
        ("comparative_less", &file.comparative_less),
        (ROOM_SPOT, &file.room_spot),
        ("state", &file.state),
        (ADJECTIVE_STATE, &file.adjective_state),
        ("size", &file.size),
        (ORDER, &file.order),
        (SUPERLATIVE, &file.superlative),
        (ORDER_TO, &file.order_to),
        (VERB, &file.verb),
    ];
    for (class, entries) in single {
        for (id, texts) in entries {
            lexicon.add_texts(class, id, &[&borrowed(texts)]);
        }
    }
    for (id, texts) in &file.verb_synonym {
        lexicon.add_read_only(LexiconEntry::of_texts(VERB, id, &[&borrowed(texts)]));
    }
    let pairs = [
        (VERB_RELATION, &file.verb_relation),
        (NOUN, &file.noun),
        (STRUCTURE, &file.structure),
    ];
    for (class, entries) in pairs {
        for (id, [one, several]) in entries {
            lexicon.add_texts(class, id, &[&borrowed(one), &borrowed(several)]);
        }
    }
    for one in GATHERING_WORDS {
        lexicon.add_texts(GATHERING, one, &[&[one], &[&plural(one)]]);
    }
    for row in categories().rows() {
        add_noun(&mut lexicon, row.singular, row.plural);
        for synonym in &row.synonyms {
            add_noun(&mut lexicon, synonym, &plural(synonym));
        }
    }
    for noun in kind_nouns().values() {
        add_noun(&mut lexicon, noun.singular, noun.plural);
        for synonym in &noun.synonyms {
            if lexicon.find(NOUN, synonym).is_none() {
                add_noun(&mut lexicon, synonym, &plural(synonym));
            }
        }
    }
    for (noun, synonyms) in &file.noun_synonym {
        for one in synonyms {
            if one.ends_with('s') {
                lexicon.add_texts(NOUN, noun, &[&[], &[one]]);
            } else {
                lexicon.add_texts(NOUN, noun, &[&[one], &[&plural(one)]]);
            }
        }
    }
    for row in categories().rows() {
        add_head(&mut lexicon, row.singular);
        for synonym in &row.synonyms {
            add_head(&mut lexicon, synonym);
        }
    }
    for kind in room_kinds().rows() {
        add_room(&mut lexicon, kind.singular, kind.plural, kind.preposition);
        for synonym in &kind.synonyms {
            add_room(&mut lexicon, synonym, &plural(synonym), kind.preposition);
        }
    }
    for word in ColorVocabulary::Spoken.words() {
        let synonyms = file.color_synonym.get(word).into_iter().flatten();
        let texts = std::iter::once(word).chain(synonyms.map(String::as_str));
        let texts: Vec<String> = texts.flat_map(spellings_of_gray).collect();
        lexicon.add_texts("color", word, &[&borrowed(&texts)]);
    }
    let substances = library().iter();
    let substances = substances.map(|substance| substance.adjective.as_str());
    for word in substances.chain(families()) {
        lexicon.add_texts("material", word, &[&[word]]);
        if let Some(synonyms) = file.material_synonym.get(word) {
            lexicon.add_texts("material", word, &[&borrowed(synonyms)]);
        }
    }
    Ok(lexicon)
}
