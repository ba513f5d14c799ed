//! Texts about objects, rooms, houses and views. Each is made of forms, so that it can be checked.

mod changes;
mod hanging;
mod house;
mod item;
mod object;
mod openings;
mod options;
mod reference;
mod room;
mod route;
mod seen_colors;
mod surroundings;
mod text;
mod view;
mod view_places;

pub use changes::describe_changes;
pub use house::describe_house;
pub use object::{caption, captions};
pub use options::{TextLength, TextOptions, TextStyle};
pub use reference::{describe_reference, describe_reference_in_view};
pub use room::{describe_room, describe_rooms};
pub use route::describe_route;
pub use text::{GroundedText, TextClaim};
pub use view::{describe_view, describe_views};
