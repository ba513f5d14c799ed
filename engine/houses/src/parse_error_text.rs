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

/// The smallest and the largest number of the types of whole numbers.
const LIMITS: [(&str, i128, i128); 10] = [
    ("u8", 0, u8::MAX as i128),
    ("u16", 0, u16::MAX as i128),
    ("u32", 0, u32::MAX as i128),
    ("u64", 0, u64::MAX as i128),
    ("usize", 0, usize::MAX as i128),
    ("i8", i8::MIN as i128, i8::MAX as i128),
    ("i16", i16::MIN as i128, i16::MAX as i128),
    ("i32", i32::MIN as i128, i32::MAX as i128),
    ("i64", i64::MIN as i128, i64::MAX as i128),
    ("isize", isize::MIN as i128, isize::MAX as i128),
];

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
        told.push_str(&limits_passed(before, &after[..length]).unwrap_or_default());
        rest = &after[length..];
    }
    told + rest
}

/// The limits of the type called `expected`, where the text before it tells a number beyond the largest or below a negative smallest
/// one: that a number is not negative is in the type's words.
fn limits_passed(before: &str, expected: &str) -> Option<String> {
    let (_, found) = before.rsplit_once("integer `")?;
    let number: i128 = found.split('`').next()?.parse().ok()?;
    let (_, low, high) = LIMITS.iter().find(|(name, ..)| *name == expected)?;
    if *low < 0 {
        let passed = number < *low || number > *high;
        return passed.then(|| format!(" from {low} to {high}"));
    }
    (number > *high).then(|| format!(" to {high}"))
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
            (
                "invalid value: integer `4294967296`, expected u32",
                "invalid value: integer `4294967296`, expected a whole number from 0 to 4294967295",
            ),
            (
                "invalid value: integer `-200`, expected i8 at line 1 column 5",
                "invalid value: integer `-200`, expected a whole number from -128 to 127 at line 1 column 5",
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
