//! Errors of readers of JSON, TOML and CSV in plain words: names of Rust's types mean nothing to the author of a file.

use std::fmt::Display;

/// Names of Rust's types in readers' messages, and their meanings in a file.
const TYPES: [(&[&str], &str); 7] = [
    (&["f32", "f64"], "a number"),
    (
        &["u8", "u16", "u32", "u64", "usize"],
        "a whole number from 0",
    ),
    (&["i8", "i16", "i32", "i64", "isize"], "a whole number"),
    (&["a boolean"], "true or false"),
    (&["a string"], "text"),
    (&["a map"], "values by name"),
    (&["a sequence"], "a list"),
];
/// Kinds of Rust's types, before the name of one of ours.
const KINDS: [(&str, &str); 5] = [
    ("struct ", "values by name"),
    ("tuple struct ", "a list"),
    ("newtype struct ", "a value"),
    ("enum ", "one of the known words"),
    ("unit ", "nothing"),
];
const EXPECTED: &str = "expected ";

/// The sentence of an error, with the expected value in plain words.
pub fn plain_parse_error(error: impl Display) -> String {
    let text = error.to_string();
    let text = text.replace(
        "recursion limit exceeded",
        "recursion limit exceeded: more than 127 lists and objects lie in each other",
    );
    let mut told = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find(EXPECTED) {
        let (before, after) = rest.split_at(at + EXPECTED.len());
        told.push_str(before);
        let (words, length) = type_in_words(after).unwrap_or(("", 0));
        told.push_str(words);
        rest = &after[length..];
    }
    told + rest
}

/// The words for the beginning of a text, and its length.
fn type_in_words(text: &str) -> Option<(&'static str, usize)> {
    let ends =
        |length: usize| !text[length..].starts_with(|c: char| c.is_alphanumeric() || c == '_');
    let types = TYPES
        .iter()
        .flat_map(|(names, words)| names.iter().map(move |name| (name, words)));
    let known = types
        .filter(|(name, _)| text.starts_with(**name) && ends(name.len()))
        .map(|(name, words)| (*words, name.len()));
    let ours = KINDS.iter().filter_map(|(kind, words)| {
        let name = text.strip_prefix(kind)?;
        let length = name.find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
        Some((*words, kind.len() + length.unwrap_or(name.len())))
    });
    known.chain(ours).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_of_rust_become_words() {
        for (text, told) in [
            (
                "invalid type: string \"x\", expected usize at line 1 column 5",
                "invalid type: string \"x\", expected a whole number from 0 at line 1 column 5",
            ),
            (
                "invalid value: integer `-1`, expected u8",
                "invalid value: integer `-1`, expected a whole number from 0",
            ),
            (
                "invalid type: null, expected struct HouseFile at line 1",
                "invalid type: null, expected values by name at line 1",
            ),
            (
                "invalid type: map, expected f32\nexpected i64",
                "invalid type: map, expected a number\nexpected a whole number",
            ),
            ("expected `,` or `}`", "expected `,` or `}`"),
            (
                "recursion limit exceeded at line 1",
                "recursion limit exceeded: more than 127 lists and objects lie in each other at line 1",
            ),
            ("expected f321", "expected f321"),
        ] {
            assert_eq!(plain_parse_error(text), told);
        }
    }
}
