//! Words as numbers: the vocabulary of instructions.

use crate::error::SemanticsError;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The version of `assets/vocabulary.txt`: a number changes its meaning only with it.
pub const VERSION: u32 = 1;
/// The number of tokens of every text, padding included.
pub const LENGTH: usize = 32;
/// The token of padding.
pub const PAD: i32 = 0;

/// Splits a text into words and marks: lower case, `.`, `,`, `?` and `!` apart.
pub fn words(text: &str) -> Vec<String> {
    let mut spaced = text.to_lowercase();
    for (mark, apart) in [(".", " . "), (",", " , "), ("?", " ? "), ("!", " ! ")] {
        spaced = spaced.replace(mark, apart);
    }
    spaced.split_whitespace().map(str::to_owned).collect()
}

/// The words in the order of their tokens; token k is line k, counted from 1; 0 is padding.
pub fn vocabulary() -> &'static [&'static str] {
    static WORDS: OnceLock<Vec<&'static str>> = OnceLock::new();
    WORDS.get_or_init(|| {
        include_str!("../../assets/vocabulary.txt")
            .lines()
            .collect()
    })
}

/// The number of different tokens, padding included: the `nvec` of a space of tokens.
pub fn size() -> usize {
    vocabulary().len() + 1
}

fn by_word() -> &'static BTreeMap<&'static str, i32> {
    static TOKENS: OnceLock<BTreeMap<&'static str, i32>> = OnceLock::new();
    TOKENS.get_or_init(|| {
        vocabulary()
            .iter()
            .zip(1..)
            .map(|(word, token)| (*word, token))
            .collect()
    })
}

/// A text as tokens. Shape ([`LENGTH`],), padded with [`PAD`].
///
/// # Errors
/// [`SemanticsError::UnknownWord`], or [`SemanticsError::TooLong`] for more than [`LENGTH`] tokens.
pub fn tokenize(text: &str) -> Result<Vec<i32>, SemanticsError> {
    let words = words(text);
    if words.len() > LENGTH {
        return Err(SemanticsError::TooLong {
            text: text.to_owned(),
            found: words.len(),
            allowed: LENGTH,
        });
    }
    let mut tokens = Vec::with_capacity(LENGTH);
    for word in words {
        match by_word().get(word.as_str()) {
            Some(token) => tokens.push(*token),
            None => {
                return Err(SemanticsError::UnknownWord {
                    word,
                    text: text.to_owned(),
                    version: VERSION,
                });
            }
        }
    }
    tokens.resize(LENGTH, PAD);
    Ok(tokens)
}

/// The words of tokens, with spaces between them; unknown tokens and padding are left out.
pub fn detokenize(tokens: &[i32]) -> String {
    let known = tokens.iter().filter_map(|token| {
        usize::try_from(*token)
            .ok()
            .and_then(|k| k.checked_sub(1))
            .and_then(|k| vocabulary().get(k))
    });
    known.copied().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_come_back_as_words() {
        let tokens = tokenize("Go to the kitchen.").unwrap();
        assert_eq!(tokens.len(), LENGTH);
        assert_eq!(detokenize(&tokens), "go to the kitchen .");
        assert_eq!(tokens[5..], [PAD; LENGTH - 5]);
        assert!(tokens.iter().all(|t| (0..size() as i32).contains(t)));
        let message = tokenize("Go to the xyzzy.").unwrap_err().to_string();
        assert_eq!(
            message,
            "\"xyzzy\" in \"Go to the xyzzy.\" is not in vocabulary version 1"
        );
        assert!(tokenize(&"the ".repeat(LENGTH + 1)).is_err());
    }
}
