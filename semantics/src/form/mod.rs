//! The logical form: the meaning of a claim, a request or a question, apart from its words.
//!
//! Captions, instructions, questions, goals and the claims of other authors' texts are forms. [`crate::language`] turns forms into
//! text and text into forms; `docs/words.md` defines the meaning of each.

mod clause;
mod phrase;
mod question;
mod request;

pub use clause::{Clause, Quality};
pub use phrase::{Description, Modifier, Noun, Phrase, PlaceInOrder, Quantifier};
pub use question::{AttributeKind, Question};
pub use request::{Request, RequestStep};

use serde::{Deserialize, Serialize};

/// The logical form of a sentence: a claim, a request or a question.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// A clause that is asserted.
    Claim(Clause),
    /// A plan to carry out.
    Request(Request),
    /// A question to answer.
    Question(Question),
}
