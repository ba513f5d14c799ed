//! Truth values of three-valued logic: true, false, and undecided with a reason.

use serde::{Deserialize, Serialize};

/// The reason why a truth value or an answer is undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UndecidedReason {
    /// The number of arguments is not that of the predicate.
    WrongCount,
    /// The predicate is not defined for this kind of thing.
    WrongKind,
    /// The house or the state has no such thing.
    UnknownTerm,
    /// It depends on a viewer, and none is given.
    NoViewer,
    /// It is about the listener, and no agent is one.
    NoListener,
    /// One of the things is not in front of the viewer.
    NotInFront,
    /// No predicate or order has this name.
    UnknownPredicate,
    /// A definite description fits several things, and the clause has not the same truth value for all.
    SeveralFit,
    /// The order needs a reference, and none is given.
    NoReference,
    /// The reference has no front of its own, or lies on its side.
    NoFront,
    /// The thing does not open.
    DoesNotOpen,
    /// The thing has no switch.
    NoSwitch,
    /// The thing is no container.
    NoContainer,
    /// One of the things has no colour of its own, like glass and mirrors.
    NoColor,
    /// The thing's colour lies between two words, and people divide on which it is.
    DividedColor,
    /// One of the things has no main substance.
    NoMaterial,
    /// The agent does not stand on walkable floor.
    NotOnFloor,
    /// There are fewer things than the place in the order.
    TooFew,
    /// Neighbours in the order differ by less than its margin.
    TooClose,
    /// "It" stands for nothing that was named before.
    NoAntecedent,
    /// Its measures lie between a word and its opposite.
    Borderline,
    /// It is about parts of a thing, such as the doors of a wardrobe, which a scene does not tell apart.
    PartOfThing,
}

impl UndecidedReason {
    /// The reason as a sentence.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::WrongCount => "It is asked of another number of things than it relates.",
            Self::WrongKind => "It says nothing about such a kind of thing.",
            Self::UnknownTerm => "There is no such thing here.",
            Self::NoViewer => "It depends on where somebody looks from, and no viewer is given.",
            Self::NoListener => "It is about who is spoken to, and no agent is given.",
            Self::NotInFront => "One of the things is not in front of the viewer.",
            Self::UnknownPredicate => "No relation of this name is defined here.",
            Self::SeveralFit => "Several things fit the description.",
            Self::NoReference => "Nothing is named to which it is compared.",
            Self::NoFront => "The thing has no front of its own, or it does not stand upright.",
            Self::DoesNotOpen => "It does not open.",
            Self::NoSwitch => "It has no switch.",
            Self::NoContainer => "Nothing goes into it.",
            Self::NoColor => "One of the things has no colour of its own.",
            Self::DividedColor => {
                "Its colour lies between two words: some would call it so, others not."
            }
            Self::NoMaterial => "One of the things is made of no one substance.",
            Self::NotOnFloor => "The agent stands where nobody can walk.",
            Self::TooFew => "There are not so many of them.",
            Self::TooClose => "Two of them are too close in the order to be told apart.",
            Self::NoAntecedent => "Nothing was named before that \"it\" could stand for.",
            Self::Borderline => "Its measures lie between the word and its opposite.",
            Self::PartOfThing => "It is about parts of a thing, which are not told apart here.",
        }
    }
}

/// A truth value of strong three-valued logic.
///
/// # Source
/// S. C. Kleene, *Introduction to Metamathematics*, North-Holland 1952, § 64.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Truth {
    /// True.
    True,
    /// False.
    False,
    /// Neither, for this reason.
    Undecided(UndecidedReason),
}

impl Truth {
    /// Returns whether it is true.
    pub fn is_true(self) -> bool {
        self == Self::True
    }

    /// Returns whether it is false.
    pub fn is_false(self) -> bool {
        self == Self::False
    }

    /// Returns the value; `None` where it is undecided.
    pub fn value(self) -> Option<bool> {
        match self {
            Self::True => Some(true),
            Self::False => Some(false),
            Self::Undecided(_) => None,
        }
    }

    /// Returns why it is undecided, if it is.
    pub fn reason(self) -> Option<UndecidedReason> {
        match self {
            Self::Undecided(reason) => Some(reason),
            _ => None,
        }
    }

    /// Conjunction: false where one is false; else undecided, for the first reason, where one is undecided.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::False, _) | (_, Self::False) => Self::False,
            (Self::Undecided(reason), _) | (_, Self::Undecided(reason)) => Self::Undecided(reason),
            (Self::True, Self::True) => Self::True,
        }
    }

    /// Disjunction: true where one is true; else undecided, for the first reason, where one is undecided.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        !((!self).and(!other))
    }
}

impl std::ops::Not for Truth {
    type Output = Self;

    fn not(self) -> Self {
        match self {
            Self::True => Self::False,
            Self::False => Self::True,
            Self::Undecided(_) => self,
        }
    }
}

impl From<bool> for Truth {
    fn from(value: bool) -> Self {
        if value { Self::True } else { Self::False }
    }
}

impl From<Result<bool, UndecidedReason>> for Truth {
    fn from(value: Result<bool, UndecidedReason>) -> Self {
        value.map_or_else(Self::Undecided, Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const U: Truth = Truth::Undecided(UndecidedReason::NoViewer);
    const V: Truth = Truth::Undecided(UndecidedReason::NoFront);

    /// The truth tables of Kleene 1952, § 64.
    #[test]
    fn the_tables_are_those_of_strong_three_valued_logic() {
        use Truth::{False, True};
        let rows = [
            (True, True, True, True),
            (True, False, False, True),
            (True, U, U, True),
            (False, True, False, True),
            (False, False, False, False),
            (False, U, False, U),
            (U, True, U, True),
            (U, False, False, U),
            (U, V, U, U),
        ];
        for (a, b, and, or) in rows {
            assert_eq!((a.and(b), a.or(b)), (and, or), "{a:?} {b:?}");
        }
        assert_eq!((!True, !False, !U), (False, True, U));
        assert_eq!((True.value(), U.value()), (Some(true), None));
    }
}
