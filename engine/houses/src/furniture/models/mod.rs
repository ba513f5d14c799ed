//! Parametric models of household things. A model is a function or a small struct of sizes and finishes that gives a
//! [`Model`](super::model::Model); [`all`] lists one specimen of each.

pub(crate) mod appliances;
pub(crate) mod bath;
pub(crate) mod bath_things;
pub(crate) mod bed;
pub(crate) mod bookshelf;
mod cabinet;
pub(crate) mod chair;
pub(crate) mod cooker;
pub(crate) mod crockery;
pub(crate) mod decoration;
pub(crate) mod desk;
pub(crate) mod dresser;
pub(crate) mod food;
pub(crate) mod fridge;
pub(crate) mod gadgets;
pub(crate) mod kitchen_unit;
pub(crate) mod lamps;
pub(crate) mod nightstand;
pub(crate) mod openings;
pub(crate) mod plants;
pub(crate) mod radio;
pub(crate) mod seats;
pub(crate) mod sofa;
pub(crate) mod stairs;
pub(crate) mod table;
pub(crate) mod taps;
pub(crate) mod television;
pub(crate) mod textiles;
pub(crate) mod toilet;
pub(crate) mod tv_stand;
pub(crate) mod wardrobe;

#[cfg(test)]
pub(crate) mod specimens;
#[cfg(test)]
mod tests;
