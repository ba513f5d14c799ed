//! Parametric models of household things. A model is a function or a small struct of sizes and finishes that gives a
//! [`Model`](super::model::Model); `specimens::all` lists one specimen of each.

pub mod appliances;
pub mod bath;
pub mod bath_more;
pub mod bath_things;
pub mod bed;
pub mod beds;
pub mod bookshelf;
pub mod cabinet_parts;
pub mod chair;
pub mod chairs;
pub mod cooker;
pub mod crockery;
pub mod decoration;
pub mod desk;
pub mod devices;
pub mod dresser;
pub mod food;
pub mod fridge;
pub mod gadgets;
pub mod hobby;
pub mod kitchen_unit;
pub mod lamps;
pub mod machines;
pub mod music;
pub mod nightstand;
pub mod openings;
pub mod outdoor;
pub mod plants;
pub mod radio;
pub mod recreation;
pub mod room_parts;
pub mod seats;
pub mod sofa;
pub mod stairs;
pub mod storage;
pub mod table;
pub mod tables;
pub mod tableware;
pub mod taps;
pub mod television;
pub mod textiles;
pub mod toilet;
pub mod tv_stand;
pub mod wardrobe;
pub mod wear;

#[cfg(test)]
pub mod specimens;
#[cfg(test)]
mod tests;
