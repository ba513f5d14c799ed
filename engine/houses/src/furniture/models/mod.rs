//! Parametric models of household things. A model is a function or a small struct of sizes and finishes that gives a
//! [`Model`](super::model::Model); [`all`] lists one specimen of each.

pub(crate) mod appliances;
pub(crate) mod bath;
pub(crate) mod bath_more;
pub(crate) mod bath_things;
pub(crate) mod bed;
pub(crate) mod beds;
pub(crate) mod bookshelf;
pub(crate) mod cabinet;
pub(crate) mod chair;
pub(crate) mod chairs;
pub(crate) mod cooker;
pub(crate) mod crockery;
pub(crate) mod decoration;
pub(crate) mod desk;
pub(crate) mod devices;
pub(crate) mod dresser;
pub(crate) mod food;
pub(crate) mod fridge;
pub(crate) mod gadgets;
pub(crate) mod games;
pub(crate) mod hobby;
pub(crate) mod kitchen_unit;
pub(crate) mod lamps;
pub(crate) mod machines;
pub(crate) mod music;
pub(crate) mod nightstand;
pub(crate) mod openings;
pub(crate) mod outdoor;
pub(crate) mod plants;
pub(crate) mod radio;
pub(crate) mod room_parts;
pub(crate) mod seats;
pub(crate) mod sofa;
pub(crate) mod stairs;
pub(crate) mod storage;
pub(crate) mod table;
pub(crate) mod tables;
pub(crate) mod tableware;
pub(crate) mod taps;
pub(crate) mod television;
pub(crate) mod textiles;
pub(crate) mod toilet;
pub(crate) mod tv_stand;
pub(crate) mod wardrobe;
pub(crate) mod wear;

#[cfg(test)]
pub(crate) mod specimens;
#[cfg(test)]
mod tests;
