//! The logical form: the meaning of a claim, a request, a question or a noun phrase, apart from its words.
//!
//! Captions, instructions, questions, goals and the claims of other authors' texts are forms. [`crate::language`] turns forms into
//! text and text into forms; `docs/words.md` defines the meaning of each.

mod antecedent;
mod antecedent_search;
mod clause;
mod identity;
mod mention;
mod own_parts;
mod phrase;
mod question;
mod request;
mod visit;

pub use clause::{Clause, Quality, RoomSurface, RoomSurfaceKind};
pub(crate) use mention::topic_of;
pub use phrase::{Description, Modifier, Noun, OrdinalSelection, Phrase, Quantifier};
pub use question::{AttributeKind, Question};
pub use request::{RequestStep, TurnDirection};

use serde::{Deserialize, Serialize};

/// The logical form of a sentence, or of a noun phrase on its own.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// A clause that is asserted.
    Claim(Clause),
    /// Steps to carry out one after the other.
    Request(Vec<RequestStep>),
    /// A question to answer.
    Question(Question),
    /// A noun phrase on its own: a caption or a referring expression. True of a scene that has what it describes.
    NounPhrase(Phrase),
    /// Several forms in one sentence: "find the lamp and tell me whether it is on".
    Several(Vec<Form>),
}
