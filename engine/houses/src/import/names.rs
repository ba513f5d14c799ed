//! Unique names.

use std::collections::{BTreeMap, BTreeSet};

/// A generator of unique names.
#[derive(Debug, Default)]
pub(crate) struct UniqueNames {
    taken: BTreeSet<String>,
    /// The number to try next for a base, so that a thousand equal names do not cost a million look-ups.
    next: BTreeMap<String, u32>,
}

impl UniqueNames {
    /// Where these names are given already.
    pub(crate) fn taken<'a>(names: impl Iterator<Item = &'a String>) -> Self {
        Self {
            taken: names.cloned().collect(),
            next: BTreeMap::new(),
        }
    }

    /// `base` when it is free, else `base_2`, `base_3`, ...
    pub(crate) fn unique(&mut self, base: &str) -> String {
        let base = if base.is_empty() { "unnamed" } else { base };
        if self.taken.insert(base.to_owned()) {
            return base.to_owned();
        }
        let next = self.next.entry(base.to_owned()).or_insert(2);
        loop {
            let name = format!("{base}_{next}");
            *next += 1;
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }

    /// `base_1`, `base_2`, ...: the numbering of objects of a category.
    pub(crate) fn numbered(&mut self, base: &str) -> String {
        let base = if base.is_empty() { "thing" } else { base };
        let next = self.next.entry(base.to_owned()).or_insert(1);
        loop {
            let name = format!("{base}_{next}");
            *next += 1;
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_is_given_twice() {
        let mut names = UniqueNames::default();
        let given = [
            names.unique("a"),
            names.unique("a_2"),
            names.unique("a"),
            names.unique("a"),
            names.numbered("a"),
            names.unique(""),
        ];
        assert_eq!(given, ["a", "a_2", "a_3", "a_4", "a_5", "unnamed"]);
        assert_eq!(
            (names.numbered("chair"), names.numbered("chair")),
            ("chair_1".into(), "chair_2".into())
        );
    }
}
