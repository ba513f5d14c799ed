//! Referring expressions as texts.

use super::text::{GroundedText, TextWriter};
use crate::check::{Addressee, Checker};
use crate::form::{Description, Phrase};
use crate::scene::{SemanticScene, Term};
use crate::view::{ReferStrategy, ViewSurvey, refer_by_survey, refer_to};
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
    Some(told(&checker, description, target, wording))
}

/// As [`describe_reference`], where what the checker's listener sees is known.
pub fn describe_reference_in_view(
    checker: &Checker<'_>,
    survey: &ViewSurvey,
    target: ObjectId,
    strategy: ReferStrategy,
    wording: Option<RandomKey>,
) -> Option<GroundedText> {
    let description = refer_by_survey(checker, Some(survey), target, strategy)?;
    Some(told(checker, description, target, wording))
}

fn told(
    checker: &Checker<'_>,
    description: Description,
    target: ObjectId,
    wording: Option<RandomKey>,
) -> GroundedText {
    let mut writer = TextWriter::new(checker, wording);
    writer.say_phrase_about(Phrase::from(description), Term::Object(target));
    writer.finish()
}
