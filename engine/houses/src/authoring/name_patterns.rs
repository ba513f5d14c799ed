//! Patterns of foreign names: `*` stands for any letters, `?` for one, without regard to case.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use dwell_scene::interrupt::CancelPoller;

use super::edit_errors::invalid_field;
use crate::error::HousesError;
use crate::limits::MAX_LETTERS_COMPARED;

/// Letters compared between two checks for cancellation: a millisecond or two.
const LETTERS_PER_CHECK: usize = 1_000_000;
/// Letters compared between two looks at what is left of the bound.
const LETTERS_PER_COUNT: usize = 10_000;

/// The work of comparing names with patterns, which has a bound and can be cancelled.
pub(super) struct ComparisonWork {
    letters_left: u64,
    poller: CancelPoller,
}

impl Default for ComparisonWork {
    fn default() -> Self {
        Self::up_to(MAX_LETTERS_COMPARED)
    }
}

impl ComparisonWork {
    fn up_to(letters: u64) -> Self {
        Self {
            letters_left: letters,
            poller: CancelPoller::new(LETTERS_PER_CHECK),
        }
    }

    /// Counts letters that were compared.
    ///
    /// # Errors
    /// [`HousesError::Spec`] for more than the bound.
    fn count(&mut self, letters: usize) -> Result<(), HousesError> {
        self.poller.count_many(letters);
        let left = self.letters_left.checked_sub(letters as u64);
        self.letters_left = left.ok_or_else(|| {
            let found =
                format!("more than {MAX_LETTERS_COMPARED} letters of names to compare with them");
            let possible = "fewer patterns, with fewer *, or shorter names in the house's file";
            invalid_field("patterns", found, possible)
        })?;
        Ok(())
    }
}

/// The rows of a map by their patterns.
pub(super) struct NamePatterns<'a, T> {
    /// The letters of each pattern, the pattern and its row; those with the most plain letters first.
    rows: Vec<(Vec<char>, &'a str, &'a T)>,
}

impl<'a, T> NamePatterns<'a, T> {
    pub(super) fn new(rows: &'a BTreeMap<String, T>) -> Self {
        let plain = |pattern: &str| pattern.chars().filter(|c| !matches!(c, '*' | '?')).count();
        let rows = rows
            .iter()
            .map(|(pattern, row)| (letters(pattern), pattern.as_str(), row));
        let mut rows: Vec<_> = rows.collect();
        rows.sort_by_key(|(_, pattern, _)| Reverse(plain(pattern)));
        Self { rows }
    }

    /// The row whose pattern fits one of the names with the most plain letters; of equals the first.
    ///
    /// # Errors
    /// [`HousesError::Spec`] for more work than the bound.
    pub(super) fn best_match<'n>(
        &self,
        names: impl IntoIterator<Item = &'n str>,
        work: &mut ComparisonWork,
    ) -> Result<Option<(&'a str, &'a T)>, HousesError> {
        let mut names: Vec<&str> = names.into_iter().collect();
        // Most files have one name for a thing and its model.
        names.dedup();
        let names: Vec<Vec<char>> = names.into_iter().map(letters).collect();
        for (word, pattern, row) in &self.rows {
            for name in &names {
                if fits(word, name, work)? {
                    return Ok(Some((pattern, row)));
                }
            }
        }
        Ok(None)
    }
}

fn letters(text: &str) -> Vec<char> {
    text.chars().flat_map(char::to_lowercase).collect()
}

/// Returns whether a name fits a pattern.
fn fits(pattern: &[char], name: &[char], work: &mut ComparisonWork) -> Result<bool, HousesError> {
    let (mut p, mut n) = (0, 0);
    // After the last star: the position in the pattern, and the part of the name that the star has taken.
    let mut star: Option<(usize, usize)> = None;
    let mut compared = 1;
    while n < name.len() {
        compared += 1;
        if compared == LETTERS_PER_COUNT {
            work.count(compared)?;
            compared = 0;
        }
        match pattern.get(p) {
            Some('*') => {
                p += 1;
                star = Some((p, n));
            }
            Some(c) if *c == '?' || *c == name[n] => {
                p += 1;
                n += 1;
            }
            _ => {
                let Some((after, taken)) = star else {
                    work.count(compared)?;
                    return Ok(false);
                };
                (p, n) = (after, taken + 1);
                star = Some((after, taken + 1));
            }
        }
    }
    work.count(compared)?;
    Ok(pattern[p..].iter().all(|c| *c == '*'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::interrupt;

    #[test]
    fn patterns_fit_as_in_a_shell_and_the_longest_counts() {
        let is = |pattern: &str, name: &str| {
            let mut work = ComparisonWork::default();
            fits(&letters(pattern), &letters(name), &mut work).unwrap()
        };
        assert!(
            is("Wood_*", "wood_12")
                && is("*", "")
                && is("a?c*", "ABCde")
                && is("*a*b*", "xxaxxbxx")
        );
        assert!(!is("wood", "wood_1") && !is("a?c", "ac") && !is("*a*b", "xxbxxa"));
        let rows: BTreeMap<String, u8> = [
            ("*".into(), 0),
            ("wood*".into(), 1),
            ("wood_dark*".into(), 2),
        ]
        .into();
        let patterns = NamePatterns::new(&rows);
        let of = |name: &str| {
            let found = patterns.best_match([name], &mut ComparisonWork::default());
            found.unwrap().map(|(_, row)| *row)
        };
        assert_eq!(
            (of("Wood_Dark_3"), of("wood_3"), of("x")),
            (Some(2), Some(1), Some(0))
        );
    }

    /// Of those with as many plain letters the first in order counts, whichever name it fits.
    #[test]
    fn of_equals_the_first_pattern_counts() {
        let rows: BTreeMap<String, u8> = [("*ab".into(), 0), ("ab*".into(), 1)].into();
        let patterns = NamePatterns::new(&rows);
        let mut work = ComparisonWork::default();
        let found = patterns.best_match(["abc", "cab"], &mut work).unwrap();
        assert_eq!(found, Some(("*ab", &0)));
    }

    /// Patterns that fit nothing, against long names.
    fn stubborn(count: usize) -> BTreeMap<String, u8> {
        let pattern = |k: usize| format!("{}*b{k}", "*a".repeat(120));
        (0..count).map(|k| (pattern(k), 0)).collect()
    }

    #[test]
    fn long_names_against_many_patterns_can_be_stopped() {
        let rows = stubborn(4000);
        let patterns = NamePatterns::new(&rows);
        let name = "a".repeat(5000);
        let stopped = interrupt::interruptible(
            || true,
            || {
                let mut work = ComparisonWork::up_to(u64::MAX);
                (0..500).all(|_| {
                    let found = patterns.best_match([name.as_str()], &mut work);
                    found.unwrap().is_none()
                })
            },
        );
        assert!(stopped.is_err(), "{stopped:?}");
    }

    #[test]
    fn one_long_name_can_be_stopped() {
        let pattern = letters(&format!("*{}b", "a".repeat(250)));
        let name = vec!['a'; 4_000_000];
        let stopped = interrupt::interruptible(
            || true,
            || fits(&pattern, &name, &mut ComparisonWork::up_to(u64::MAX)).unwrap(),
        );
        assert!(stopped.is_err(), "{stopped:?}");
    }

    #[test]
    fn more_work_than_the_bound_is_refused() {
        let rows = stubborn(2);
        let patterns = NamePatterns::new(&rows);
        let name = "a".repeat(50_000);
        let with = |letters: u64| {
            let mut work = ComparisonWork::up_to(letters);
            patterns.best_match([name.as_str()], &mut work).map(drop)
        };
        assert!(with(1_000_000).is_ok());
        let told = with(100_000).unwrap_err().to_string();
        assert!(
            told.starts_with("patterns: found more than 10000000000 letters"),
            "{told}"
        );
    }
}
