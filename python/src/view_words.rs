//! What is said of a view in one go, answers to many forms, and the claims of foreign texts, for Python.

use crate::answers::PyValue;
use crate::descriptions::{char_offset, spans, text_row};
use crate::errors::PyFault;
use crate::language::truth;
use crate::values::JsonArgument;
use crate::world::PyWorld;
use crate::world_access::WorldAccess;
use dwell_scene::Id;
use dwell_scene::random::RandomKey;
use dwell_semantics::check::{Checker, ClaimScope, ClaimVerdict, JudgedClaim};
use dwell_semantics::describe::{
    TextLength, TextOptions, describe_reference_in_view, describe_views,
};
use dwell_semantics::form::Form;
use dwell_semantics::predicates::{self, Predicate};
use dwell_semantics::view::{ReferStrategy, ViewSurvey};
use dwell_semantics::{SemanticScene, Term, UndecidedReason, object_attributes};
use pyo3::prelude::*;
use serde_json::{Value, json};

impl WorldAccess<'_> {
    fn claim_row(
        &self,
        checker: &Checker<'_>,
        text: &str,
        own: &JudgedClaim,
    ) -> Result<Value, PyFault> {
        let scene = checker.scene();
        let said = own.form.as_ref();
        let said = said.and_then(|form| scene.semantics.language().say(form, None));
        let phrases = said.iter().flat_map(|said| checker.ground(said));
        let phrases = phrases.zip(said.iter().cycle()).map(|(phrase, said)| {
            json!({
                "start": char_offset(&said.text, phrase.start),
                "end": char_offset(&said.text, phrase.end),
                "things": self.terms_json(&phrase.terms),
            })
        });
        let (status, reason, witnesses, elsewhere) = match &own.verdict {
            ClaimVerdict::Judged {
                verdict,
                holds_elsewhere,
            } => {
                let status = match truth(verdict.truth) {
                    Value::Bool(true) => "true",
                    Value::Bool(false) => "false",
                    _ => "undecided",
                };
                let reason = verdict.truth.reason().map(UndecidedReason::sentence);
                let witnesses = verdict.witnesses.iter().map(|witness| {
                    json!({
                        "predicate": witness.predicate,
                        "things": self.terms_json(&witness.terms),
                        "truth": truth(witness.truth),
                    })
                });
                let witnesses: Vec<Value> = witnesses.collect();
                let reason = reason.map(ToString::to_string);
                (status, reason, witnesses, *holds_elsewhere)
            }
            ClaimVerdict::NotUnderstood(error) => {
                ("not_understood", Some(error.to_string()), Vec::new(), false)
            }
            ClaimVerdict::NoClaim => ("no_claim", None, Vec::new(), false),
        };
        Ok(json!({
            "start": char_offset(text, own.start),
            "end": char_offset(text, own.end),
            "text": &text[own.start..own.end],
            "status": status,
            "reason": reason,
            "said": said.as_ref().map(|said| said.text.clone()),
            "form": serde_json::to_value(&own.form)?,
            "witnesses": witnesses,
            "phrases": phrases.collect::<Vec<Value>>(),
            "holds_elsewhere": elsewhere,
        }))
    }
}

/// The claims of a text of another author, each with its verdict: a mapping each. `scope` is `"house"` or `"view"`.
#[pyfunction]
pub(crate) fn world_judge_text(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    text: &str,
    viewer: JsonArgument,
    agent: Option<usize>,
    of_view: bool,
) -> PyResult<PyValue> {
    world.get().read_interruptible(py, |running| {
        let scene = running.scene();
        let checker = Checker::new(&scene, running.listener(viewer, agent)?);
        let scope = if of_view {
            ClaimScope::View
        } else {
            ClaimScope::House
        };
        let judged = checker.judge_claims(text, scope);
        let judged = judged.map_err(|error| PyFault::Config(error.error.to_string()))?;
        let rows: Result<Vec<Value>, PyFault> = judged
            .iter()
            .map(|own| running.claim_row(&checker, text, own))
            .collect();
        PyValue::of(&rows?)
    })
}

/// What is said of forms in a scene: for each the text with its phrases and the answer, or nothing where there are no words for it.
#[pyfunction]
pub(crate) fn world_answers(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    forms: JsonArgument,
    viewer: JsonArgument,
    agent: Option<usize>,
    seed: Option<u64>,
) -> PyResult<PyValue> {
    world.get().read_interruptible(py, |running| {
        let forms: Vec<Form> = forms.read()?;
        let scene = running.scene();
        let house = scene.house();
        let checker = Checker::new(&scene, running.listener(viewer, agent)?);
        let wording = seed.map(RandomKey::root);
        let rows = forms.iter().enumerate().map(|(k, form)| {
            let key = wording.map(|key| key.child(k as u64));
            let Some(said) = scene.semantics.language().say(form, key) else {
                return Value::Null;
            };
            let answer = checker
                .answer_to(form)
                .map(|answer| running.answer(&answer));
            let phrases = checker.ground(&said);
            json!({
                "text": said.text,
                "spans": spans(house, &said.text, &phrases),
                "answer": answer,
            })
        });
        PyValue::of(&rows.collect::<Vec<Value>>())
    })
}

/// Pairs of `things` of which one of `named` holds: subject, predicate, object.
fn relations_among(
    running: &WorldAccess<'_>,
    checker: &Checker<'_>,
    things: &[Term],
    named: &[&'static dyn Predicate],
) -> Vec<Value> {
    let (scene, viewer) = (checker.scene(), checker.listener().viewer.as_ref());
    let mut found = Vec::new();
    let mut tell = |subject: &Term, predicate: &dyn Predicate, object: &Term| {
        let ids = [subject, object].map(|term| running.entity_id(*term));
        found.push(json!([ids[0], predicate.name(), ids[1]]));
    };
    for subject in things {
        for predicate in named.iter().copied() {
            if predicate.is_listed() {
                let related = predicate.related(scene, *subject);
                let others = things.iter().filter(|other| related.contains(other));
                others.for_each(|other| tell(subject, predicate, other));
                continue;
            }
            for other in things.iter().filter(|other| *other != subject) {
                if predicate
                    .holds(scene, &[*subject, *other], viewer)
                    .is_true()
                {
                    tell(subject, predicate, other);
                }
            }
        }
    }
    found
}

fn thing_row(scene: &SemanticScene<'_>, survey: &ViewSurvey, term: Term) -> Result<Value, PyFault> {
    let Term::Object(object) = term else {
        return Ok(Value::Null);
    };
    let facts = scene.facts(object);
    let seen = survey.objects.get(&object);
    let mut row = serde_json::to_value(object_attributes(scene, object))?;
    let colors: Vec<&str> = facts
        .spoken_colors()
        .iter()
        .map(|(word, _)| *word)
        .collect();
    if let Value::Object(fields) = &mut row {
        fields.insert("spoken_colors".to_owned(), json!(colors));
        fields.insert("material".to_owned(), json!(facts.material_word()));
        fields.insert(
            "ray_share".to_owned(),
            json!(seen.map_or(0.0, |own| own.share)),
        );
        fields.insert(
            "unhidden".to_owned(),
            json!(seen.map_or(0.0, |own| own.unhidden)),
        );
        fields.insert(
            "distance_m".to_owned(),
            json!(seen.map(|own| own.distance_m)),
        );
        fields.insert("is_opening".to_owned(), json!(facts.belongs_to_opening()));
    }
    Ok(row)
}

/// What is said of what a viewer sees: `captions` by length, of the things of `ids` their `things` (attributes and how much is seen of
/// them), `references` (by strategy) and the `relations` among them by the predicates of `names`; the `room` that the viewer is in.
#[pyfunction]
pub(crate) fn world_view_words(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    viewer: JsonArgument,
    ids: Vec<i64>,
    names: Vec<String>,
    seed: Option<u64>,
) -> PyResult<PyValue> {
    world.get().read_interruptible(py, |running| {
        let listener = running.listener(viewer, None)?;
        let Some(viewer) = listener.viewer else {
            return Err(PyFault::Config("viewer is None; expected one".to_owned()));
        };
        let scene = running.scene();
        let house = scene.house();
        let objects: Result<Vec<_>, PyFault> =
            ids.iter().map(|id| running.object(&json!(id))).collect();
        let objects = objects?;
        let named: Result<Vec<&'static dyn Predicate>, _> =
            names.iter().map(|name| predicates::find(name)).collect();
        let named = named.map_err(|error| PyFault::Config(error.to_string()))?;
        let checker = Checker::new(&scene, listener);
        let survey = ViewSurvey::of(&scene, &viewer);
        let wording = seed.map(|seed| RandomKey::root(seed).child(house.name.as_str()));
        let options = TextLength::ALL.map(|length| TextOptions {
            length,
            wording,
            ..TextOptions::default()
        });
        let mut captions = serde_json::Map::new();
        let texts = describe_views(&checker, &survey, &options);
        for (length, text) in TextLength::ALL.iter().zip(&texts) {
            let row = serde_json::to_value(text_row(house, text))?;
            captions.insert(length.name().to_owned(), row);
        }
        let mut references = Vec::new();
        for (id, object) in ids.iter().zip(&objects) {
            for strategy in ReferStrategy::ALL {
                let text =
                    describe_reference_in_view(&checker, &survey, *object, strategy, wording);
                if let Some(text) = text {
                    let mut row = serde_json::to_value(text_row(house, &text))?;
                    row["id"] = json!(id);
                    row["strategy"] = json!(strategy.name());
                    references.push(row);
                }
            }
        }
        let terms: Vec<Term> = objects.iter().copied().map(Term::Object).collect();
        let things: Result<Vec<Value>, PyFault> = terms
            .iter()
            .map(|term| thing_row(&scene, &survey, *term))
            .collect();
        let room = house.room_at(viewer.world_from_camera.position);
        PyValue::of(&json!({
            "captions": captions,
            "references": references,
            "things": things?,
            "relations": relations_among(running, &checker, &terms, &named),
            "room": room.map(Id::index),
        }))
    })
}
