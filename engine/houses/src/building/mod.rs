//! The building and the tables of a house: rooms with their slabs, walls with openings, and ways to put things in their
//! place.

pub(crate) mod assembly;
pub(crate) mod plan;
pub(crate) mod site;
pub(crate) mod wall;
