//! Words against the scene.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

mod algebra;
mod antecedents;
mod apartment;
mod boundaries;
mod changes;
mod check;
mod color_names_by_readers;
mod common;
mod grounded_texts;
mod heaps;
mod language;
mod lengths;
mod patterns;
mod plural_and_parts;
mod predicates;
mod predicates_page;
mod properties;
mod random_forms;
mod real_house;
mod references;
mod room_kinds;
mod route_walks;
mod routes;
mod sentences_of_people;
mod speech;
mod swaps;
mod views;
mod wording;
