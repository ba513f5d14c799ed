//! Templates of text: words, arguments and words that agree with them.

use super::GrammarError;
use std::borrow::Cow;

/// A variant of a category, such as singular or plural.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VariantPattern<'a> {
    /// Any variant of the argument.
    Any,
    /// The variant of this name; else a variable over the variants of its category, with one value throughout a rule.
    Named(&'a str),
}

/// An element of a template.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum TemplateElement<'a> {
    /// A word as it stands, in lower case, or a punctuation mark.
    Word(Cow<'a, str>),
    /// `[be.n]`: a word of the grammar's own in a variant.
    Inflected(&'a str, VariantPattern<'a>),
    /// `{1.n}`: an argument, counted from 0 here.
    Argument(usize, VariantPattern<'a>),
}

/// A category with a variant: `cn.n`.
pub(super) fn category(text: &str) -> (&str, VariantPattern<'_>) {
    match text.split_once('.') {
        Some((name, variant)) => (name, VariantPattern::Named(variant)),
        None => (text, VariantPattern::Any),
    }
}

/// A word in lower case.
fn lower_case(word: &str) -> Cow<'_, str> {
    if word
        .bytes()
        .all(|letter| letter.is_ascii() && !letter.is_ascii_uppercase())
    {
        Cow::Borrowed(word)
    } else {
        Cow::Owned(word.to_lowercase())
    }
}

/// Reads a template such as `"{1.n} [be.n] {2} {3} ."`; pieces are separated by spaces.
///
/// # Errors
/// [`GrammarError::Template`] for brackets that do not close and arguments that are not a number from 1 to `arity`.
pub(super) fn read(text: &str, arity: usize) -> Result<Vec<TemplateElement<'_>>, GrammarError> {
    let fault = |why: &'static str| GrammarError::Template {
        template: text.to_owned(),
        why,
    };
    let mut pieces = Vec::new();
    for part in text.split_whitespace() {
        let inner = |open: char, close: char| {
            let rest = part.strip_prefix(open)?;
            Some(rest.strip_suffix(close))
        };
        if let Some(inside) = inner('{', '}') {
            let inside = inside.ok_or_else(|| fault("{ without }"))?;
            let (number, variant) = category(inside);
            let number: usize = number
                .parse()
                .ok()
                .filter(|number| (1..=arity).contains(number))
                .ok_or_else(|| fault("an argument is a number from 1 to that of the arguments"))?;
            pieces.push(TemplateElement::Argument(number - 1, variant));
        } else if let Some(inside) = inner('[', ']') {
            let inside = inside.ok_or_else(|| fault("[ without ]"))?;
            let (name, variant) = category(inside);
            pieces.push(TemplateElement::Inflected(name, variant));
        } else {
            pieces.push(TemplateElement::Word(lower_case(part)));
        }
    }
    if pieces.is_empty() {
        return Err(fault("it has no words"));
    }
    Ok(pieces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn templates_are_words_arguments_and_words_that_agree() {
        let named = VariantPattern::Named;
        assert_eq!(
            read("{1.n} [be.n] on {2}", 2).unwrap(),
            [
                TemplateElement::Argument(0, named("n")),
                TemplateElement::Inflected("be", named("n")),
                TemplateElement::Word("on".into()),
                TemplateElement::Argument(1, VariantPattern::Any),
            ]
        );
        for wrong in ["{3} x", "{0}", "{x}", "{1", "[be", ""] {
            assert!(read(wrong, 2).is_err(), "{wrong}");
        }
    }
}
