//! Names of the materials that robots add to a house.

use std::collections::{BTreeMap, BTreeSet};

use dwell_scene::{IdVec, Material, MaterialId};

/// Marks behind a name before they are numbered: a name for each of many colours would get longer and longer.
const MAX_MARKS: usize = 8;

/// The names of a house's materials.
#[derive(Debug, Default)]
pub(crate) struct MaterialNames {
    taken: BTreeSet<String>,
    /// Materials of the house whose names are in `taken`.
    seen: usize,
    /// The number of marks to try next for a name, so that a thousand equal names do not cost a million look-ups.
    next: BTreeMap<String, usize>,
}

impl MaterialNames {
    /// Takes the names of materials that a house has got since the last call.
    pub(super) fn add_new(&mut self, materials: &IdVec<MaterialId, Material>) {
        let new = materials.iter().skip(self.seen);
        self.taken.extend(new.map(|material| material.name.clone()));
        self.seen = materials.len();
    }

    /// `base` when it is free, else with a mark behind it, or with as many as are needed; many are a number.
    pub(super) fn unique(&mut self, base: &str) -> String {
        if self.taken.insert(base.to_owned()) {
            return base.to_owned();
        }
        let marks = self.next.entry(base.to_owned()).or_insert(1);
        loop {
            let name = if *marks <= MAX_MARKS {
                format!("{base}{}", "'".repeat(*marks))
            } else {
                format!("{base}'{marks}")
            };
            *marks += 1;
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
    fn no_name_is_given_twice_and_none_gets_long() {
        let mut names = MaterialNames::default();
        let mut table = IdVec::default();
        let add = |table: &mut IdVec<MaterialId, Material>, name: &str| {
            let steel = dwell_scene::material::library().get_or_default("steel");
            table.push(Material::from_substance(name, steel))
        };
        add(&mut table, "a");
        names.add_new(&table);
        assert_eq!([names.unique("a"), names.unique("b")], ["a'", "b"]);
        add(&mut table, "a''");
        names.add_new(&table);
        assert_eq!(names.unique("a"), "a'''");
        let many: BTreeSet<String> = (0..1000).map(|_| names.unique("a")).collect();
        assert_eq!(many.len(), 1000);
        assert!(many.iter().all(|name| name.len() < 10), "{many:?}");
    }
}
