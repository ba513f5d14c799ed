//! Classes of things, as the semantic image numbers them.

use dwell_scene::{House, StructureKind};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The class of nothing.
pub(crate) const VOID: i32 = 0;

struct Table {
    names: Vec<String>,
    /// By name and by alias.
    class: BTreeMap<String, i32>,
}

/// `assets/categories.csv`: column 1 is the name, column 6 its aliases with `;` between.
static TABLE: LazyLock<Table> = LazyLock::new(|| {
    let text = include_str!("../../../assets/categories.csv");
    let mut table = Table {
        names: vec!["void".to_owned()],
        class: BTreeMap::new(),
    };
    for row in text.lines().skip(1) {
        let mut cells = row.split(',');
        let Some(name) = cells.next().filter(|name| !name.is_empty()) else {
            continue;
        };
        let class = table.names.len() as i32;
        table.names.push(name.to_owned());
        table.class.insert(name.to_owned(), class);
        for alias in cells
            .nth(4)
            .unwrap_or_default()
            .split(';')
            .filter(|alias| !alias.is_empty())
        {
            table.class.entry(alias.to_owned()).or_insert(class);
        }
    }
    table
});

/// The classes of the semantic image; a pixel's value is a position in this list.
///
/// 0 is `"void"`. Then come the rows of `assets/categories.csv` in file order: the same number in every house (the file
/// grows at its end). Then the categories of this house's objects that the file does not know, sorted by name.
pub fn semantic_classes(house: &House) -> Vec<String> {
    let mut names = TABLE.names.clone();
    names.extend(strange_names(house).into_keys());
    names
}

/// The class of every entity: structure pieces, then objects, by [`dwell_scene::EntityId`]; agents, which come after, are
/// the last entry.
pub(crate) fn class_of_entities(house: &House) -> Vec<i32> {
    let strange = strange_names(house);
    let named = |name: &str| TABLE.class.get(name).copied().unwrap_or(VOID);
    let mut classes = vec![VOID];
    classes.extend(house.structure.iter().map(|piece| match piece.kind {
        StructureKind::Wall => named("wall"),
        StructureKind::Floor => named("floor"),
        StructureKind::Ceiling => named("ceiling"),
        StructureKind::Ground => named("ground"),
        StructureKind::Other => named("box"),
    }));
    classes.extend(house.objects.iter().map(|object| {
        let name = class_name(object);
        known(object)
            .or_else(|| strange.get(name).copied())
            .unwrap_or(VOID)
    }));
    classes.push(named("person"));
    classes
}

/// The class of the coarse name, else of the fine one, else of the NYU-40 one.
fn known(object: &dwell_scene::Object) -> Option<i32> {
    let category = &object.category;
    [&category.coarse, &category.fine]
        .into_iter()
        .find_map(|name| TABLE.class.get(name.as_str()).copied())
}

fn class_name(object: &dwell_scene::Object) -> &str {
    let category = &object.category;
    [&category.coarse, &category.fine]
        .into_iter()
        .find(|name| !name.is_empty())
        .map_or("object", String::as_str)
}

/// Categories that the table does not have, with their classes.
fn strange_names(house: &House) -> BTreeMap<String, i32> {
    let mut names: BTreeMap<String, i32> = house
        .objects
        .iter()
        .filter(|object| known(object).is_none())
        .map(|object| (class_name(object).to_owned(), VOID))
        .collect();
    for (class, value) in (TABLE.names.len() as i32..).zip(names.values_mut()) {
        *value = class;
    }
    names
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
        let classes = class_of_entities(&house);
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
}
