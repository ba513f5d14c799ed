//! The building and the tables of a house: rooms with their slabs, walls with openings, instances of models.

pub(crate) mod assembly;
pub(crate) mod openings;
pub(crate) mod outline;
pub(crate) mod room;
pub(crate) mod stairs;
pub(crate) mod wall;
pub(crate) mod yaw;
