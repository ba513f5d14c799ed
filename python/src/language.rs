//! Forms and sentences for Python.

use crate::answers;
use crate::descriptions::{char_offset, text_row};
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::values::JsonArgument;
use crate::world::PyWorld;
use crate::world_access::WorldAccess;
use dwell_scene::AgentId;
use dwell_scene::Id;
use dwell_scene::random::RandomKey;
use dwell_semantics::check::{Addressee, CheckResult, Checker, QuestionAnswer};
use dwell_semantics::describe::describe_reference;
use dwell_semantics::form::Form;
use dwell_semantics::language::Language;
use dwell_semantics::view::ReferStrategy;
use dwell_semantics::{Term, Truth, UndecidedReason};
use pyo3::prelude::*;
use serde_json::{Value, json};

impl WorldAccess<'_> {
    pub(crate) fn listener(
        &self,
        viewer: JsonArgument,
        agent: Option<usize>,
    ) -> Result<Addressee, PyFault> {
        let agent = agent.map(|agent| self.agent(agent)).transpose()?;
        let eyes = |agent: AgentId| dwell_semantics::Viewer::of_agent(self.world.state(), agent);
        let viewer = self.viewer(viewer)?;
        Ok(Addressee {
            viewer: viewer.or_else(|| agent.and_then(eyes)),
            agent,
        })
    }

    /// A term by its kind, the sensors' id or its number, and its name.
    pub(crate) fn term_json(&self, term: Term) -> Value {
        let kind = match term {
            Term::Object(_) => "object",
            Term::Structure(_) => "structure",
            Term::Agent(_) => "agent",
            Term::Room(_) => "room",
            Term::Storey(_) => "storey",
            Term::Part(_) => "part",
        };
        json!({"kind": kind, "id": self.entity_id(term), "name": self.name_of(term)})
    }

    /// The sensors' id of a thing, or the number of a room, storey or part.
    pub(crate) fn entity_id(&self, term: Term) -> i32 {
        let house = self.world.house();
        match term {
            Term::Object(id) => house.entity_of_object(id).0,
            Term::Structure(id) => house.entity_of_structure(id).0,
            Term::Agent(id) => house.entity_of_agent(id).0,
            Term::Room(id) => id.index() as i32,
            Term::Storey(id) => id.index() as i32,
            Term::Part(id) => id.index() as i32,
        }
    }

    pub(crate) fn terms_json(&self, terms: &[Term]) -> Value {
        terms.iter().map(|term| self.term_json(*term)).collect()
    }

    fn verdict(&self, verdict: &CheckResult) -> Value {
        let witnesses = verdict.witnesses.iter().map(|witness| {
            json!({
                "predicate": witness.predicate,
                "things": self.terms_json(&witness.terms),
                "truth": truth(witness.truth),
            })
        });
        json!({
            "truth": truth(verdict.truth),
            "reason": verdict.truth.reason().map(UndecidedReason::sentence),
            "witnesses": witnesses.collect::<Vec<Value>>(),
        })
    }

    pub(crate) fn answer(&self, answer: &QuestionAnswer) -> Value {
        match answer {
            QuestionAnswer::Truth(verdict) => self.verdict(verdict),
            QuestionAnswer::Things(terms) => json!({"things": self.terms_json(terms)}),
            QuestionAnswer::Number(number) => json!({"number": number}),
            QuestionAnswer::Alternatives(numbers) => json!({"alternatives": numbers}),
            QuestionAnswer::Words(words) => json!({"words": words}),
            QuestionAnswer::None(reason) => json!({"reason": reason.sentence()}),
        }
    }
}

pub(crate) fn truth(truth: Truth) -> Value {
    truth.value().map_or(Value::Null, Value::Bool)
}

fn unread(error: dwell_semantics::language::ParseError) -> PyFault {
    PyFault::Config(error.to_string())
}

/// The forms that a sentence may stand for, the preferred one first.
#[pyfunction]
pub(crate) fn language_read(py: Python<'_>, text: &str) -> PyResult<answers::PyValue> {
    py.engine(|| {
        let reading = Language::english().read(text).map_err(unread)?;
        answers::PyValue::of(&reading.forms)
    })
}

/// The text of a form with the bytes of its noun phrases; nothing where English has no words for it.
#[pyfunction]
pub(crate) fn language_say(
    py: Python<'_>,
    form: JsonArgument,
    seed: Option<u64>,
) -> PyResult<Option<String>> {
    py.engine(|| {
        let form: Form = form.read()?;
        let said = Language::english().say(&form, seed.map(RandomKey::root));
        Ok::<_, PyFault>(said.map(|said| said.text))
    })
}

/// A sentence read with the nouns of the house, and checked or answered: one mapping.
#[pyfunction]
pub(crate) fn world_check_text(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    text: &str,
    viewer: JsonArgument,
    agent: Option<usize>,
) -> PyResult<answers::PyValue> {
    world.get().read_interruptible(py, |running| {
        let scene = running.scene();
        let checker = Checker::new(&scene, running.listener(viewer, agent)?);
        let checked = checker.check_text(text).map_err(unread)?;
        let said = scene.semantics.language().say(&checked.form, None);
        let phrases = said.iter().flat_map(|said| {
            let grounded = checker.ground(said);
            let phrases = grounded.into_iter().map(|phrase| {
                json!({
                    "start": char_offset(&said.text, phrase.start),
                    "end": char_offset(&said.text, phrase.end),
                    "things": running.terms_json(&phrase.terms),
                })
            });
            phrases.collect::<Vec<Value>>()
        });
        let phrases: Vec<Value> = phrases.collect();
        let ambiguous = checker.ambiguities(&checked.form);
        let ambiguities = ambiguous.iter().map(
            |found| json!({"things": running.terms_json(&found.terms), "question": found.question}),
        );
        answers::PyValue::of(&json!({
            "form": serde_json::to_value(&checked.form)?,
            "other_forms": serde_json::to_value(&checked.others)?,
            "said": said.map(|said| said.text),
            "phrases": phrases,
            "ambiguities": ambiguities.collect::<Vec<Value>>(),
            "answer": checked.answer.map(|answer| running.answer(&answer)),
        }))
    })
}

/// The words by which a listener finds an object, a text of one row; none where no words do.
#[pyfunction]
pub(crate) fn world_refer(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    named: JsonArgument,
    viewer: JsonArgument,
    strategy: &str,
    seed: Option<u64>,
) -> PyResult<answers::PyValue> {
    world.get().read_interruptible(py, |running| {
        let strategy = ReferStrategy::find(strategy).ok_or_else(|| {
            let allowed = ReferStrategy::ALL.map(ReferStrategy::name).join(", ");
            PyFault::Config(format!("strategy is {strategy:?}; allowed are {allowed}"))
        })?;
        let object = running.object(&named.read()?)?;
        let listener = running.listener(viewer, None)?;
        let scene = running.scene();
        let house = scene.house();
        let wording = seed.map(|seed| RandomKey::root(seed).child(house.name.as_str()));
        let text = describe_reference(&scene, listener, object, strategy, wording);
        let rows: Vec<_> = text.iter().map(|text| text_row(house, text)).collect();
        answers::PyValue::of(&rows)
    })
}
