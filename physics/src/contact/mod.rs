//! What happens where things touch: friction and bounce by pair of substances, events, who touches whom.

mod approach;
mod bounce;
mod collector;
mod entry;
mod events;
mod friction;
mod hooks;
mod motion;
mod ongoing;
pub(crate) mod rolling;
mod substances;
mod touching;

pub(crate) use bounce::Rebounds;
pub(crate) use collector::Collector;
pub use entry::Toucher;
pub(crate) use entry::{Entry, entry_index};
pub(crate) use events::bound;
pub use events::{ContactEvent, ContactKind, ContactPhase, MergedEvents};
pub(crate) use friction::Kept;
pub(crate) use hooks::{Dress, Excluded, Hooks};
pub(crate) use motion::{Motion, note_motion};
pub(crate) use ongoing::Ongoing;
pub(crate) use substances::ContactTable;
pub(crate) use touching::touching;
