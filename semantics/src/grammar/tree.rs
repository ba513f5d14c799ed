//! Abstract syntax trees: the content of a sentence, apart from its words.

/// An abstract syntax tree, as in Ranta's Grammatical Framework: functions applied to arguments. Languages with the same functions
/// share trees, and differ in their linearization.
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
    /// A whole number.
    Number {
        /// `"count"`, `"ordinal"` or `"digits"`.
        class: String,
        /// The number.
        value: u32,
    },
}

impl Tree {
    /// The function at the root; `None` for words and numbers.
    pub fn function(&self) -> Option<&str> {
        match self {
            Self::Apply { function, .. } => Some(function),
            Self::Entry { .. } | Self::Number { .. } => None,
        }
    }

    /// Returns whether a function stands anywhere in it.
    pub fn has_function(&self, is_it: &impl Fn(&str) -> bool) -> bool {
        match self {
            Self::Apply {
                function,
                arguments,
            } => is_it(function) || arguments.iter().any(|one| one.has_function(is_it)),
            Self::Entry { .. } | Self::Number { .. } => false,
        }
    }

    /// Returns a function applied to arguments.
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
