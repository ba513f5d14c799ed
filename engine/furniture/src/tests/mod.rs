//! Invariants of every entry of the catalogue, in every style, whatever is drawn, and of models that are built to measure.

mod affordances;
mod bodies;
mod built_to_measure;
mod cases;
mod joints;
mod sizes;
mod surfaces;
