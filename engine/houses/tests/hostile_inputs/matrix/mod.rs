//! Every kind of hostile input against every format: a cell is an input with what must be said of it, or the reason why the
//! format cannot hold such a thing. The page `docs/hostile-input.md` shows the table; `UPDATE_GOLDEN=1` writes it there.

mod meshes;
mod names;
mod ours;
mod robots;
mod scenes;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use dwell_houses::formats;

use crate::kit::{Case, Ends};

macro_rules! rows {
    ($($(#[$doc:meta])* $name:ident = $title:literal,)*) => {
        /// A kind of hostile input.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub(crate) enum Row {
            $($name,)*
        }

        impl Row {
            /// All kinds, with what the page calls them.
            const ALL: &'static [(Self, &'static str)] = &[$((Self::$name, $title),)*];
        }
    };
}

rows! {
    Cut = "the file is cut",
    MissingMesh = "a mesh is missing",
    EmptyMesh = "a mesh is empty",
    Nan = "a number is NaN",
    Infinite = "a number is infinite",
    Huge = "a number is 1e39",
    UnknownModel = "a model that nobody knows",
    Parent = "`..` in a model's path",
    Absolute = "an absolute path of a model",
    Link = "a model is a link",
    TextureParent = "`..` in a texture's path",
    TextureAbsolute = "an absolute path of a texture",
    TextureLink = "a texture is a link",
    Claim = "a header claims 2 GB",
    Recursion = "something contains itself",
    Duplicate = "one id twice",
    Index = "an index out of range",
    WrongType = "a value of the wrong type",
    Lying = "a buffer lies about its length",
    Bomb = "an image bombs",
    Later = "a later version",
    UnknownHouse = "a HOUSE that is none",
}

/// The case of a format for a kind of input.
pub(crate) enum Cell {
    /// The input of this name in the format's own table.
    Has(&'static str),
    /// An input that only the matrix has.
    Is(Case),
    /// No input of the format can be so.
    Cannot(&'static str),
}

/// A format's cells.
pub(crate) struct Column {
    pub(crate) format: &'static str,
    /// The inputs that other tests try.
    pub(crate) known: &'static [Case],
    pub(crate) cells: &'static [(Row, Cell)],
}

/// The matrix's own inputs of a format.
pub(crate) fn inputs(column: &Column) -> impl Iterator<Item = &Case> {
    column.cells.iter().filter_map(|(_, cell)| match cell {
        Cell::Is(case) => Some(case),
        _ => None,
    })
}

pub(crate) fn columns() -> [&'static Column; 12] {
    [
        &names::BUILTIN,
        &names::SEED,
        &ours::PLAN,
        &ours::NATIVE,
        &scenes::HABITAT,
        &scenes::PROCTHOR,
        &scenes::MEASURED,
        &scenes::SUNCG,
        &meshes::GLTF,
        &meshes::OBJ,
        &robots::URDF,
        &robots::MJCF,
    ]
}

impl Column {
    /// Returns how the inputs of a row end.
    fn ends(&self, row: Row) -> &Cell {
        let mut own = self.cells.iter().filter(|(of, _)| *of == row);
        let found = own.next().map(|(_, cell)| cell);
        let format = self.format;
        assert!(own.next().is_none(), "{format}: {row:?} has two cells");
        found.unwrap_or_else(|| panic!("{format}: {row:?} has no cell"))
    }

    fn known(&self, name: &str) -> &Case {
        let found = self.known.iter().find(|case| case.name == name);
        found.unwrap_or_else(|| panic!("{}: no input {name:?}", self.format))
    }
}

/// The table for the page: `error`, `report`, or the letter of a reason.
fn page() -> String {
    let columns = columns();
    let names: Vec<&str> = columns.iter().map(|column| column.format).collect();
    let all: Vec<&str> = formats().iter().map(|format| format.name).collect();
    assert_eq!(names, all, "every format has its column");
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    let mut order = Vec::new();
    let mut text = format!("| | {} |\n|{}\n", names.join(" | "), " --- |".repeat(13));
    for (row, title) in Row::ALL {
        write!(text, "| {title} |").unwrap();
        for column in columns {
            let word = |case: &Case| match case.ends {
                Ends::Fails(_) => "error".to_owned(),
                Ends::Warns(_) => "report".to_owned(),
            };
            let shown = match column.ends(*row) {
                Cell::Is(case) => word(case),
                Cell::Has(name) => word(column.known(name)),
                Cell::Cannot(reason) => {
                    let number = *reasons.entry(reason).or_insert_with(|| {
                        order.push(*reason);
                        order.len()
                    });
                    number.to_string()
                }
            };
            write!(text, " {shown} |").unwrap();
        }
        text.push('\n');
    }
    text.push('\n');
    for (k, reason) in order.iter().enumerate() {
        writeln!(text, "{}. {reason}", k + 1).unwrap();
    }
    text
}

const BEGIN: &str = "<!-- the matrix begins -->\n\n";
const END: &str = "\n<!-- the matrix ends -->";

#[test]
fn the_page_shows_the_matrix() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/hostile-input.md");
    let old = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = old.split_once(BEGIN).expect("the page marks the matrix");
    let (_, after) = rest.split_once(END).expect("the page marks its end");
    let new = format!("{before}{BEGIN}{}{END}{after}", page());
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, new).unwrap();
        return;
    }
    assert!(
        new == old,
        "docs/hostile-input.md shows another matrix; UPDATE_GOLDEN=1 writes it"
    );
}
