//! Referring expressions as texts.

use super::text::{GroundedText, TextWriter};
use crate::check::{Addressee, Checker};
use crate::form::Phrase;
use crate::scene::{SemanticScene, Term};
use crate::view::{ReferStrategy, refer_to};
use dwell_scene::ObjectId;
use dwell_scene::random::RandomKey;

/// The words by which a listener finds `target` and nothing else: one that looks at it among what is in sight, any other in the house.
/// `None` where no words do. `wording` draws the wordings.
pub fn describe_reference(
    scene: &SemanticScene<'_>,
    listener: Addressee,
    target: ObjectId,
    strategy: ReferStrategy,
    wording: Option<RandomKey>,
) -> Option<GroundedText> {
    let checker = Checker::new(scene, listener);
    let description = refer_to(&checker, target, strategy)?;
    let mut writer = TextWriter::new(&checker, wording);
    writer.say_phrase_about(Phrase::from(description), Term::Object(target));
    Some(writer.finish())
}
