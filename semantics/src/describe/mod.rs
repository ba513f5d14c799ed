//! Speech about objects, rooms, houses and views.

mod contents;
mod house;
mod object;
mod room;
mod view;

pub use house::describe_house;
pub use object::caption;
pub use room::describe_room;
pub use view::describe_view;
