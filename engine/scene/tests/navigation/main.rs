//! The walkable grid against rays, closed forms and plain searches that share no code with it.

mod doors;
mod room;
mod storeys;
mod support;
mod ways;
