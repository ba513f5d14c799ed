//! What must hold for every entry of the catalogue, in every style, whatever is drawn.

mod affordances;
mod bodies;
mod cases;
mod joints;
mod sizes;
