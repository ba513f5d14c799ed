//! What happens where things touch: friction and bounce by pair of substances, events, who touches whom.

mod entry;
mod events;
mod hooks;
mod substances;
mod touching;

pub use entry::Toucher;
pub(crate) use entry::{Entry, entry_index};
pub use events::ContactEvent;
pub(crate) use events::{Collector, Impacts, Motion, note_motion};
pub(crate) use hooks::{Dress, Excluded, Hooks};
pub(crate) use substances::ContactTable;
pub(crate) use touching::touching;
