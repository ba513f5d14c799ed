//! Speech about objects, rooms, houses and views.

mod contents;
mod hanging;
mod house;
mod object;
mod openings;
mod room;
mod view;

pub use house::describe_house;
pub use object::caption;
pub use room::describe_room;
pub use view::describe_view;
