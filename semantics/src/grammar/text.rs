//! Phrases as written text: spaces, capitals, articles by sound; and the spans of a tree's parts.

use super::linearize::LinearizedNode;
use crate::english::article;

/// The place of a subtree in the text of its tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Argument numbers from the root to the subtree, counted from 0.
    pub path: Vec<usize>,
    /// The first byte of the text.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
}

#[derive(Default)]
struct Writer {
    words: Vec<String>,
    /// Words, not bytes.
    parts: Vec<Span>,
}

impl Writer {
    fn add(&mut self, phrases: &[LinearizedNode], path: &mut Vec<usize>) {
        for phrase in phrases {
            match phrase {
                LinearizedNode::Word(word) => self.words.push(word.clone()),
                LinearizedNode::Part(at, inside) => {
                    let start = self.words.len();
                    path.push(*at);
                    self.add(inside, path);
                    self.parts.push(Span {
                        path: path.clone(),
                        start,
                        end: self.words.len(),
                    });
                    path.pop();
                }
            }
        }
    }
}

/// Returns the text of `phrases` as a sentence, and the spans of its parts in bytes.
pub(super) fn write(phrases: &[LinearizedNode]) -> (String, Vec<Span>) {
    let mut writer = Writer::default();
    writer.add(phrases, &mut Vec::new());
    let Writer { words, mut parts } = writer;
    let mut text = String::new();
    let mut places: Vec<(usize, usize)> = Vec::with_capacity(words.len());
    for (k, word) in words.iter().enumerate() {
        let is_mark = word.chars().all(|letter| !letter.is_alphanumeric());
        if k > 0 && !is_mark {
            text.push(' ');
        }
        let start = text.len();
        let following = words.get(k + 1).map_or("", String::as_str);
        let word = if word == "a" {
            article(following)
        } else {
            word
        };
        if k == 0 {
            text.push_str(&crate::english::capitalized(word));
        } else {
            text.push_str(word);
        }
        places.push((start, text.len()));
    }
    for part in &mut parts {
        let first = places.get(part.start).map_or(text.len(), |place| place.0);
        let last = part.end.checked_sub(1).and_then(|at| places.get(at));
        (part.start, part.end) = (first, last.map_or(first, |place| place.1));
    }
    parts.sort_by(|p, q| p.path.cmp(&q.path));
    (text, parts)
}
