//! The logical form: what is claimed, asked for or asked, apart from its words.
//!
//! Captions, instructions, questions, goals and claims of foreign texts are forms. [`crate::language`] turns forms into text and
//! text into forms; `docs/words.md` says what each means.

mod clause;
mod phrase;
mod question;
mod request;

pub use clause::{Clause, Quality};
pub use phrase::{Description, Modifier, Noun, Phrase, Quantifier, Selection};
pub use question::{AttributeKind, Question};
pub use request::{Plan, Step};

use serde::{Deserialize, Serialize};

/// A claim, a request or a question.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Something that is true or false.
    Claim(Clause),
    /// Something to do.
    Request(Plan),
    /// Something to answer.
    Question(Question),
}
