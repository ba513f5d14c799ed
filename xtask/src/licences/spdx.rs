//! SPDX licence expressions, as far as manifests use them: identifiers, `WITH`, `AND`, `OR`, parentheses, and the old `A/B`.
//!
//! # Source
//! SPDX specification 2.3, annex D: `WITH` binds strongest, then `AND`, then `OR`.

use std::collections::BTreeSet;

/// Returns whether `allowed` licences are enough to use something under `expression`.
pub(crate) fn is_satisfied(expression: &str, allowed: &BTreeSet<String>) -> Result<bool, String> {
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let mut words: Vec<&str> = spaced.split_whitespace().rev().collect();
    let value = either(&mut words, allowed)?;
    match words.pop() {
        None => Ok(value),
        Some(word) => Err(format!("{word:?} where the expression should end")),
    }
}

// `words` is a stack: the next word is the last.
fn either(words: &mut Vec<&str>, allowed: &BTreeSet<String>) -> Result<bool, String> {
    let mut value = both(words, allowed)?;
    while words.last() == Some(&"OR") {
        words.pop();
        value |= both(words, allowed)?;
    }
    Ok(value)
}

fn both(words: &mut Vec<&str>, allowed: &BTreeSet<String>) -> Result<bool, String> {
    let mut value = one(words, allowed)?;
    while words.last() == Some(&"AND") {
        words.pop();
        value &= one(words, allowed)?;
    }
    Ok(value)
}

fn one(words: &mut Vec<&str>, allowed: &BTreeSet<String>) -> Result<bool, String> {
    match words.pop() {
        None => Err("ends where a licence should stand".to_owned()),
        Some("(") => {
            let value = either(words, allowed)?;
            if words.pop() == Some(")") {
                Ok(value)
            } else {
                Err("a parenthesis stays open".to_owned())
            }
        }
        Some(word @ (")" | "AND" | "OR" | "WITH")) => {
            Err(format!("{word:?} where a licence should stand"))
        }
        Some(name) if words.last() == Some(&"WITH") => {
            words.pop();
            let exception = words.pop().ok_or("ends after WITH")?;
            // An exception only adds permissions.
            Ok(allowed.contains(name) || allowed.contains(&format!("{name} WITH {exception}")))
        }
        Some(name) => Ok(allowed.contains(name)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ok(expression: &str) -> bool {
        let allowed = ["MIT", "Apache-2.0", "Zlib"].map(str::to_owned).into();
        is_satisfied(expression, &allowed).unwrap()
    }

    #[test]
    fn one_of_several_is_enough() {
        assert!(ok("MIT") && ok("GPL-3.0 OR MIT") && ok("Unlicense/MIT"));
        assert!(!ok("GPL-3.0") && !ok("GPL-3.0 OR LGPL-2.1"));
    }

    #[test]
    fn all_of_several_are_needed() {
        assert!(ok("MIT AND Zlib") && !ok("MIT AND GPL-3.0"));
    }

    #[test]
    fn and_binds_stronger_than_or() {
        assert!(ok("MIT OR GPL-3.0 AND LGPL-2.1"));
        assert!(!ok("(MIT OR GPL-3.0) AND LGPL-2.1"));
    }

    #[test]
    fn exceptions_only_add() {
        assert!(ok("Apache-2.0 WITH LLVM-exception"));
        assert!(!ok("GPL-2.0 WITH Classpath-exception-2.0"));
    }

    #[test]
    fn broken_expressions_are_errors() {
        for text in [
            "", "MIT OR", "(MIT", "MIT)", "MIT Zlib", "AND MIT", "MIT WITH",
        ] {
            assert!(is_satisfied(text, &BTreeSet::new()).is_err(), "{text:?}");
        }
    }
}
