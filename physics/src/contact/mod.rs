//! Contacts: friction and restitution by pair of substances, events, pairs in contact.

mod approach;
mod body_motion;
mod collector;
mod collider_entry;
mod contact_law;
mod contact_pairs;
mod contact_tracker;
mod events;
mod friction;
mod hooks;
mod restitution;
pub(crate) mod rolling;
mod scope;
mod substances;

pub(crate) use body_motion::{BodyMotion, record_motion};
pub(crate) use collector::{ContactCollector, ContactReport};
pub use collider_entry::ContactEntity;
pub(crate) use collider_entry::{ColliderMetadata, entry_index};
pub(crate) use contact_law::{ContactLaw, ContactSide, ContactValues, LawContact};
pub(crate) use contact_pairs::contacts_within;
pub(crate) use contact_tracker::ContactTracker;
pub(crate) use events::merge_excess;
pub use events::{ContactEvent, ContactKind, ContactPhase, ExcessEventTotals};
pub(crate) use hooks::{CollisionExclusions, ContactHooks, ContactProperties, PairListingHooks};
pub(crate) use restitution::{RestitutionContext, RestitutionResult};
pub(crate) use scope::ContactScope;
pub(crate) use substances::ContactTable;
