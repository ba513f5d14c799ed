//! Things of a house that a hand can take from somewhere and put somewhere else: what they are, how they are moved before an episode
//! begins, and how an expert brings them back.

mod hand_mover;
mod manipulation;
mod movable_things;
mod restore_expert;
mod setting_checks;

pub(super) use hand_mover::{HandMover, MoveTarget};
pub(super) use movable_things::{MovableThing, MovableThings};
pub(super) use restore_expert::{Misplacement, OriginalPlace, RestoreExpert};
pub(super) use setting_checks::{
    MOST_THINGS, check_classes, check_counts, check_moves, check_rewards, setting_error,
};
