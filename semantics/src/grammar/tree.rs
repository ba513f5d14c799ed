//! Abstract syntax: what a sentence says, apart from its words.

/// A tree of functions applied to arguments, in the sense of Ranta's Grammatical Framework: two languages that share functions
/// share trees, and differ in how these become text.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Tree {
    /// A function of the grammar with its arguments.
    Apply {
        /// Its name.
        function: String,
        /// Its arguments, as many as the grammar says.
        arguments: Vec<Tree>,
    },
    /// An entry of the lexicon.
    Entry {
        /// Its class, such as `"noun"`.
        class: String,
        /// Its name in the class.
        id: String,
    },
    /// A whole number of a class that counts or orders.
    Number {
        /// `"count"`, `"ordinal"` or `"digits"`.
        class: String,
        /// The number.
        value: u32,
    },
}

impl Tree {
    /// A function with its arguments.
    pub fn apply(function: &str, arguments: impl Into<Vec<Self>>) -> Self {
        Self::Apply {
            function: function.to_owned(),
            arguments: arguments.into(),
        }
    }

    /// An entry of the lexicon.
    pub fn entry(class: &str, id: &str) -> Self {
        Self::Entry {
            class: class.to_owned(),
            id: id.to_owned(),
        }
    }
}
