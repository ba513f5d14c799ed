//! How a text is told: its length, its style and its wording.

use dwell_scene::random::RandomKey;

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

/// How things are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextStyle {
    /// By their nouns, their places and what is open; with adjectives only where these tell things apart.
    Plain,
    /// Also by their colours, patterns, materials and sizes, and rooms by the look of floor and walls.
    #[default]
    Rich,
}

impl TextStyle {
    /// All styles.
    pub const ALL: [Self; 2] = [Self::Plain, Self::Rich];

    /// The name in the interfaces.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Rich => "rich",
        }
    }

    /// The style of a name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|style| style.name() == name)
    }
}

/// How a text is told.
#[derive(Clone, Copy, Debug, Default)]
pub struct TextOptions {
    /// How much it tells.
    pub length: TextLength,
    /// How it tells of things.
    pub style: TextStyle,
    /// Draws the wordings; `None` for the first ones.
    pub wording: Option<RandomKey>,
}

impl TextOptions {
    /// The options of the `k`-th of several texts, with a wording of its own.
    pub(super) fn for_nth_text(self, k: usize) -> Self {
        let wording = self.wording.map(|key| key.child(k as u64));
        Self { wording, ..self }
    }
}

impl From<TextLength> for TextOptions {
    fn from(length: TextLength) -> Self {
        Self {
            length,
            ..Self::default()
        }
    }
}
