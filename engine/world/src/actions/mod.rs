//! Actions: what agents do in a step or with their hands. One file each, and one line in the table below.
//!
//! From the table come the discrete actions and their numbers, the reader of requests, the package's checks, and the pages.

mod action_set;
mod discrete;
mod hand_action_order;
mod kind;
mod look_down;
mod look_up;
mod move_forward;
mod pixel_target;
mod request;
mod step_action;
mod step_sizes;
mod stop;
mod target;
mod turn_left;
mod turn_right;
mod wait;

pub use action_set::ActionSet;
pub use discrete::{AgentAction, HandTarget};
pub use kind::ActionKind;
pub use request::HandActionRequest;
pub(crate) use step_action::actions_named;
pub use step_action::{ActionMode, ActionTarget, StepAction, StepUtterance};
pub use step_sizes::StepSizes;
pub use target::{ObjectRef, PixelCamera, TargetRequest};

use dwell_physics::actions as hand;
use kind::hand as of_hand;

/// Makes the table, and of its discrete actions an enum in the order of their numbers.
macro_rules! actions {
    (discrete: [$($Name:ident = $kind:expr,)+] others: [$($other:expr,)+]) => {
        /// A discrete action of an agent, one per step.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum DiscreteAction {
            $(#[doc = concat!("The action of [`ActionKind`] ", stringify!($kind), ".")] $Name,)+
        }

        impl DiscreteAction {
            /// All discrete actions, in the order of their numbers.
            pub const ALL: [Self; [$(stringify!($Name)),+].len()] = [$(Self::$Name),+];
        }

        /// All kinds of actions, the discrete ones first, in the order of their numbers.
        pub fn all() -> &'static [ActionKind] {
            const ALL: &[ActionKind] = &[$($kind,)+ $($other,)+];
            ALL
        }
    };
}

actions! {
    discrete: [
        Stop = stop::KIND,
        MoveForward = move_forward::KIND,
        TurnLeft = turn_left::KIND,
        TurnRight = turn_right::KIND,
        LookUp = look_up::KIND,
        LookDown = look_down::KIND,
        Wait = wait::KIND,
        Pick = of_hand::<hand::Pick>("pick"),
        Drop = of_hand::<hand::Drop>("drop"),
        Open = of_hand::<hand::Open>("open"),
        Close = of_hand::<hand::Close>("close"),
        Toggle = of_hand::<hand::Toggle>("toggle"),
        Place = of_hand::<hand::Place>("place"),
        PutIn = of_hand::<hand::PutIn>("put_in"),
        Throw = of_hand::<hand::Throw>("throw"),
        Push = of_hand::<hand::Push>("push"),
        Pull = of_hand::<hand::Pull>("pull"),
        Point = of_hand::<hand::Point>("point"),
        Grip = of_hand::<hand::Grip>("grip"),
    ]
    others: [
        of_hand::<hand::PlaceAt>("place_at"),
    ]
}

impl DiscreteAction {
    /// Those that environments have unless others are named: the first twelve.
    pub const DEFAULT: &[Self] = Self::ALL.split_at(12).0;

    /// All that one agent alone can do: all but the last.
    pub const ALONE: &[Self] = Self::ALL.split_at(18).0;

    /// The row of the table.
    pub fn kind(self) -> &'static ActionKind {
        &all()[self as usize]
    }

    /// The action's name, as in action lists and files.
    pub fn name(self) -> &'static str {
        self.kind().name
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_action_has_a_name_of_its_own_and_says_what_it_does() {
        let names: BTreeSet<&str> = all().iter().map(|kind| kind.name).collect();
        assert_eq!(names.len(), all().len());
        for kind in all() {
            let documented = kind.fields().iter().all(|field| !field.about.is_empty());
            assert!(documented && kind.description().ends_with('.'), "{kind:?}");
            let target = kind.target_description();
            assert_eq!(target.is_some(), kind.takes_target(), "{}", kind.name);
            assert!(target.is_none_or(|about| !about.is_empty()), "{kind:?}");
        }
    }

    #[test]
    fn a_discrete_action_is_called_as_its_variant_is() {
        for action in DiscreteAction::ALL {
            let variant = format!("{action:?}").to_lowercase();
            assert_eq!(action.name().replace('_', ""), variant);
        }
    }
}
