//! Classes of things, as the semantic image numbers them.

use dwell_scene::{House, Object, StructureKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The class of nothing.
const VOID: i32 = 0;
/// `otherprop` of NYU-40.
const OTHER_PROP: i32 = 40;

struct ClassTable {
    names: Vec<String>,
    /// Classes by name and by alias.
    class: BTreeMap<String, i32>,
    /// The NYU-40 class of each row; 0 for void.
    nyu40_of_row: Vec<i32>,
    /// Names of the NYU-40 classes; 0 is void.
    nyu40: Vec<String>,
}

/// `assets/categories.csv`: column 1 is the name, column 6 its aliases with `;` between, 7 and 8 the NYU-40 class.
static TABLE: LazyLock<ClassTable> = LazyLock::new(|| {
    let text = include_str!("../../../assets/categories.csv");
    let mut table = ClassTable {
        names: vec!["void".to_owned()],
        class: BTreeMap::new(),
        nyu40_of_row: vec![VOID],
        nyu40: vec![String::new(); 41],
    };
    "void".clone_into(&mut table.nyu40[0]);
    for row in text.lines().skip(1) {
        let mut cells = row.split(',');
        let Some(name) = cells.next().filter(|name| !name.is_empty()) else {
            continue;
        };
        let class = table.names.len() as i32;
        table.names.push(name.to_owned());
        table.class.insert(name.to_owned(), class);
        let aliases = cells.nth(4).unwrap_or_default();
        let number = cells.next().and_then(|cell| cell.parse().ok());
        let number = number.filter(|number: &usize| *number < table.nyu40.len());
        table.nyu40_of_row.push(number.unwrap_or_default() as i32);
        if let (Some(number), Some(name)) = (number, cells.next()) {
            name.clone_into(&mut table.nyu40[number]);
        }
        for alias in aliases.split(';').filter(|alias| !alias.is_empty()) {
            table.class.entry(alias.to_owned()).or_insert(class);
        }
    }
    table
});

/// The table of classes of semantic images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ClassSet {
    /// `table`, `chair`, ...: the rows of `assets/categories.csv`.
    Coarse = 0,
    /// `coffee_table`, `office_chair`, ...: the finest name that the house's file gives.
    Fine = 1,
    /// The 40 classes of NYU Depth V2, numbered as there.
    Nyu40 = 2,
}

impl ClassSet {
    /// All tables.
    pub const ALL: [Self; 3] = [Self::Coarse, Self::Fine, Self::Nyu40];

    /// The names of classes; a pixel's value is a position in this list, and 0 is `"void"`.
    ///
    /// Coarse and fine: after void come the rows of `assets/categories.csv` in file order, the same number in every house (the
    /// file grows at its end); then the names of this house's objects that the file does not know, sorted. NYU-40: 1 `"wall"`
    /// to 40 `"otherprop"` in every house.
    pub fn names(self, house: &House) -> Vec<String> {
        if self == Self::Nyu40 {
            return TABLE.nyu40.clone();
        }
        let mut names = TABLE.names.clone();
        names.extend(self.unlisted_classes(house).into_keys());
        names
    }

    /// The names of an object that are tried, in order.
    fn candidate_names(self, object: &Object) -> [&str; 2] {
        let category = &object.category;
        match self {
            Self::Fine => [&category.fine, &category.coarse],
            Self::Coarse | Self::Nyu40 => [&category.coarse, &category.fine],
        }
        .map(String::as_str)
    }

    /// The class of an object by the file: of the first name that it knows, if that is the first that the object has.
    fn listed_class(self, object: &Object) -> Option<i32> {
        let mut names = self.candidate_names(object).into_iter();
        let class = |name: &str| TABLE.class.get(name).copied();
        if self == Self::Fine {
            return names.find(|name| !name.is_empty()).and_then(class);
        }
        names.find_map(class)
    }

    /// Names that the file does not know, with their classes.
    fn unlisted_classes(self, house: &House) -> BTreeMap<String, i32> {
        let mut names: BTreeMap<String, i32> = house
            .objects
            .iter()
            .filter(|object| self.listed_class(object).is_none())
            .map(|object| (self.preferred_name(object).to_owned(), VOID))
            .collect();
        for (class, value) in (TABLE.names.len() as i32..).zip(names.values_mut()) {
            *value = class;
        }
        names
    }

    fn preferred_name(self, object: &Object) -> &str {
        let mut names = self.candidate_names(object).into_iter();
        names.find(|name| !name.is_empty()).unwrap_or("object")
    }

    /// The NYU-40 class of an object: by its own NYU-40 name, else by the row of its name, else other prop.
    fn nyu40(object: &Object) -> i32 {
        let own = object.category.nyu40.as_str();
        let named = TABLE.nyu40.iter().position(|name| name == own);
        let by_row = || {
            Self::Coarse
                .listed_class(object)
                .map(|row| TABLE.nyu40_of_row[row as usize])
        };
        named
            .filter(|class| *class > 0)
            .map(|class| class as i32)
            .or_else(by_row)
            .unwrap_or(OTHER_PROP)
    }
}

/// The classes of the semantic image; a pixel's value is a position in this list. See [`ClassSet::names`].
pub fn semantic_classes(house: &House) -> Vec<String> {
    ClassSet::Coarse.names(house)
}

/// The class of every entity of a house.
#[derive(Clone, Debug)]
pub struct EntityClasses {
    /// Classes of void, structure pieces, objects, by [`dwell_scene::EntityId`]; the last one is that of agents.
    classes: Vec<i32>,
}

impl EntityClasses {
    /// The classes of the entities of `house`, by a table.
    pub fn new(house: &House, table: ClassSet) -> Self {
        let strange = table.unlisted_classes(house);
        let named = |name: &str| {
            let row = TABLE.class.get(name).copied().unwrap_or(VOID);
            match table {
                ClassSet::Nyu40 => TABLE.nyu40_of_row[row as usize],
                ClassSet::Coarse | ClassSet::Fine => row,
            }
        };
        let mut classes = vec![VOID];
        classes.extend(house.structure.iter().map(|piece| match piece.kind {
            StructureKind::Wall => named("wall"),
            StructureKind::Floor => named("floor"),
            StructureKind::Ceiling => named("ceiling"),
            StructureKind::Ground => named("ground"),
            StructureKind::Other => named("box"),
        }));
        classes.extend(house.objects.iter().map(|object| {
            match table {
                ClassSet::Nyu40 => ClassSet::nyu40(object),
                ClassSet::Coarse | ClassSet::Fine => table
                    .listed_class(object)
                    .or_else(|| strange.get(table.preferred_name(object)).copied())
                    .unwrap_or(VOID),
            }
        }));
        classes.push(named("person"));
        Self { classes }
    }

    /// The classes of void, structure pieces, objects in order, and of agents.
    pub(crate) fn all(&self) -> &[i32] {
        &self.classes
    }

    /// The class of an entity's number; agents follow the objects.
    #[inline]
    pub fn of(&self, entity: i32) -> i32 {
        self.classes[(entity.max(0) as usize).min(self.classes.len() - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::ShoeboxMaterials;

    #[test]
    fn walls_floors_and_ceilings_have_classes_of_their_own() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let names = semantic_classes(&house);
        assert_eq!(names[0], "void");
        let classes = EntityClasses::new(&house, ClassSet::Coarse).classes;
        let words: Vec<&str> = classes
            .iter()
            .map(|class| names[*class as usize].as_str())
            .collect();
        assert_eq!(
            words,
            [
                "void", "floor", "ceiling", "wall", "wall", "wall", "wall", "person"
            ]
        );
    }

    #[test]
    fn aliases_name_the_class_of_their_row() {
        assert_eq!(TABLE.class["tv"], TABLE.class["television"]);
        assert!(TABLE.names.len() > 100);
        for (k, name) in TABLE.names.iter().enumerate().skip(1) {
            assert_eq!(TABLE.class[name] as usize, k, "{name}");
        }
    }

    #[test]
    fn the_forty_classes_have_their_numbers() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let names = ClassSet::Nyu40.names(&house);
        assert_eq!(names.len(), 41);
        assert!(names.iter().all(|name| !name.is_empty()));
        // N. Silberman et al., ECCV 2012, with the 40 classes of S. Gupta et al., CVPR 2013.
        for (number, name) in [
            (1, "wall"),
            (2, "floor"),
            (22, "ceiling"),
            (25, "television"),
            (31, "person"),
            (40, "otherprop"),
        ] {
            assert_eq!(names[number], name);
        }
        let classes = EntityClasses::new(&house, ClassSet::Nyu40).classes;
        assert_eq!(classes, [0, 2, 22, 1, 1, 1, 1, 31]);
    }

    /// A fine name is shown where there is one, and the same number everywhere where the file knows it.
    #[test]
    fn fine_classes_tell_apart_what_coarse_ones_join() {
        let (house, _) = dwell_houses::open("builtin:studio").unwrap();
        let [coarse, fine] = [ClassSet::Coarse, ClassSet::Fine];
        let tables =
            [coarse, fine].map(|table| (table.names(&house), EntityClasses::new(&house, table)));
        for (id, object) in house.objects.iter_ids() {
            let entity = house.entity_of_object(id).0;
            let [a, b] =
                [0, 1].map(|k: usize| tables[k].0[tables[k].1.of(entity) as usize].as_str());
            let same = |name: &str, shown: &str| {
                name == shown || TABLE.class.get(name) == TABLE.class.get(shown)
            };
            assert!(
                object.category.coarse.is_empty() || same(&object.category.coarse, a),
                "{a}"
            );
            assert!(
                object.category.fine.is_empty() || same(&object.category.fine, b),
                "{b}"
            );
            let nyu = EntityClasses::new(&house, ClassSet::Nyu40).of(entity);
            assert!((1..=40).contains(&nyu));
        }
    }
}
