//! The discrete actions that an agent has.

use super::DiscreteAction;

/// A set of discrete actions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ActionSet(u32);

impl ActionSet {
    /// The set of some actions.
    pub fn of(actions: &[DiscreteAction]) -> Self {
        let bits = actions.iter().map(|action| 1 << (*action as u32));
        Self(bits.fold(0, |all, bit| all | bit))
    }

    /// Returns whether an action is one of them.
    pub fn contains(self, action: DiscreteAction) -> bool {
        self.0 & (1 << (action as u32)) != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_it_is_made_of() {
        const { assert!(DiscreteAction::ALL.len() <= u32::BITS as usize) };
        let set = ActionSet::of(DiscreteAction::DEFAULT);
        for action in DiscreteAction::ALL {
            let is_default = DiscreteAction::DEFAULT.contains(&action);
            assert_eq!(set.contains(action), is_default, "{action:?}");
        }
    }
}
