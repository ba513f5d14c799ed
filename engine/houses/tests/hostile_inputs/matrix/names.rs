//! Houses that are named, not read.

use std::path::PathBuf;

use super::Cell::{Cannot, Is};
use super::{Column, Row};
use crate::kit::fails;

const NO_FILE: &str = "Such houses are named by a string; no file is read.";
const NO_NUMBER: &str = "A name has no numbers and no fields.";

pub(super) const BUILTIN: Column = Column {
    format: "builtin",
    known: &[],
    cells: &[
        (
            Row::Cut,
            Is(fails(
                "an empty name",
                |_| PathBuf::from("builtin:"),
                &["no built-in house \"\""],
            )),
        ),
        (Row::MissingMesh, Cannot(NO_FILE)),
        (Row::EmptyMesh, Cannot(NO_FILE)),
        (Row::Nan, Cannot(NO_NUMBER)),
        (Row::Infinite, Cannot(NO_NUMBER)),
        (Row::Huge, Cannot(NO_NUMBER)),
        (Row::UnknownModel, Cannot(NO_FILE)),
        (
            Row::Parent,
            Is(fails(
                "..",
                |_| PathBuf::from("builtin:../studio"),
                &["no built-in house \"../studio\""],
            )),
        ),
        (
            Row::Absolute,
            Is(fails(
                "absolute",
                |_| PathBuf::from("builtin:/etc/passwd"),
                &["no built-in house \"/etc/passwd\""],
            )),
        ),
        (Row::Link, Cannot(NO_FILE)),
        (Row::TextureParent, Cannot(NO_FILE)),
        (Row::TextureAbsolute, Cannot(NO_FILE)),
        (Row::TextureLink, Cannot(NO_FILE)),
        (Row::Claim, Cannot(NO_FILE)),
        (
            Row::Recursion,
            Is(fails(
                "of itself",
                |_| PathBuf::from("builtin:builtin:studio"),
                &["no built-in house \"builtin:studio\""],
            )),
        ),
        (Row::Duplicate, Cannot(NO_NUMBER)),
        (Row::Index, Cannot(NO_NUMBER)),
        (Row::WrongType, Cannot(NO_NUMBER)),
        (Row::Lying, Cannot(NO_FILE)),
        (Row::Bomb, Cannot(NO_FILE)),
        (Row::Later, Cannot(NO_NUMBER)),
        (
            Row::UnknownHouse,
            Is(fails(
                "castle",
                |_| PathBuf::from("builtin:castle"),
                &["no built-in house \"castle\"", "studio"],
            )),
        ),
    ],
};

pub(super) const SEED: Column = Column {
    format: "seed",
    known: &[],
    cells: &[
        (
            Row::Cut,
            Is(fails(
                "no seed",
                |_| PathBuf::from("seed:"),
                &["seed: found"],
            )),
        ),
        (Row::MissingMesh, Cannot(NO_FILE)),
        (Row::EmptyMesh, Cannot(NO_FILE)),
        (
            Row::Nan,
            Is(fails(
                "nan",
                |_| PathBuf::from("seed:1?area_m2=nan"),
                &["area_m2"],
            )),
        ),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |_| PathBuf::from("seed:1?area_m2=inf"),
                &["area_m2"],
            )),
        ),
        (
            Row::Huge,
            Is(fails(
                "1e39",
                |_| PathBuf::from("seed:1?area_m2=1e39"),
                &["area_m2"],
            )),
        ),
        (
            Row::UnknownModel,
            Is(fails(
                "a style",
                |_| PathBuf::from("seed:1?style=none"),
                &["style"],
            )),
        ),
        (Row::Parent, Cannot(NO_FILE)),
        (Row::Absolute, Cannot(NO_FILE)),
        (Row::Link, Cannot(NO_FILE)),
        (Row::TextureParent, Cannot(NO_FILE)),
        (Row::TextureAbsolute, Cannot(NO_FILE)),
        (Row::TextureLink, Cannot(NO_FILE)),
        (
            Row::Claim,
            Is(fails(
                "storeys",
                |_| PathBuf::from("seed:1?storeys=2000000000"),
                &["storeys"],
            )),
        ),
        (
            Row::Recursion,
            Is(fails(
                "of itself",
                |_| PathBuf::from("seed:seed:7"),
                &["seed: found seed:7"],
            )),
        ),
        (
            Row::Duplicate,
            Is(fails(
                "a field twice",
                |_| PathBuf::from("seed:1?home=studio&home=house"),
                &["home: found it twice"],
            )),
        ),
        (
            Row::Index,
            Is(fails(
                "2^64",
                |_| PathBuf::from("seed:18446744073709551616"),
                &["seed: found"],
            )),
        ),
        (
            Row::WrongType,
            Is(fails(
                "a word",
                |_| PathBuf::from("seed:one"),
                &["seed: found one"],
            )),
        ),
        (Row::Lying, Cannot(NO_FILE)),
        (Row::Bomb, Cannot(NO_FILE)),
        (
            Row::Later,
            Is(fails(
                "version",
                |_| PathBuf::from("seed:1?version=99"),
                &["version"],
            )),
        ),
        (
            Row::UnknownHouse,
            Is(fails(
                "castle",
                |_| PathBuf::from("seed:1?home=castle"),
                &["castle"],
            )),
        ),
    ],
};
