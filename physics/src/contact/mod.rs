//! What happens where things touch: friction and bounce by pair of substances, events, who touches whom.

mod collector;
mod entry;
mod events;
mod hooks;
mod ongoing;
pub(crate) mod rolling;
mod substances;
mod touching;

pub(crate) use collector::{Collector, Motion, note_motion};
pub use entry::Toucher;
pub(crate) use entry::{Entry, entry_index};
pub(crate) use events::bound;
pub use events::{ContactEvent, ContactKind, ContactPhase, MergedEvents};
pub(crate) use hooks::{Dress, Excluded, Hooks};
pub(crate) use ongoing::Ongoing;
pub(crate) use substances::ContactTable;
pub(crate) use touching::touching;
