//! The length of a text.

/// How much a text tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum TextLength {
    /// What is seen first: a thing's looks, the largest things of a room, the rooms of a house.
    Short,
    /// Also the place of a thing, and all that a room has in it.
    #[default]
    Normal,
    /// Also where things stand to each other.
    Long,
}

impl TextLength {
    /// All lengths, the shortest first.
    pub const ALL: [Self; 3] = [Self::Short, Self::Normal, Self::Long];

    /// The name in the interfaces.
    pub fn name(self) -> &'static str {
        match self {
            Self::Short => "short",
            Self::Normal => "normal",
            Self::Long => "long",
        }
    }

    /// The length of a name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|length| length.name() == name)
    }
}
