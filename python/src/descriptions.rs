//! Texts about houses for Python, with the things that they are about.

use crate::answers::PyValue;
use crate::errors::PyFault;
use crate::values::JsonArgument;
use crate::world_access::WorldAccess;
use dwell_scene::House;
use dwell_scene::random::RandomKey;
use dwell_semantics::check::{Addressee, GroundedPhrase};
use dwell_semantics::describe::{
    GroundedText, TextLength, TextOptions, TextStyle, captions, describe_changes, describe_house,
    describe_rooms, describe_route, describe_view,
};
use dwell_semantics::form::Form;
use dwell_semantics::graph::scene_graph;
use dwell_semantics::instruct::{
    Instruction, InstructionGoal, InstructionKind, candidates, choose,
};
use dwell_semantics::{SemanticScene, Term};
use serde::Serialize;
use serde_json::{Value, json};

/// The levels of which there are texts of several lengths, and of both styles.
const LEVELS_WITH_LENGTHS: [&str; 5] = ["object", "room", "house", "view", "route"];
const LEVELS_WITH_STYLES: [&str; 4] = ["object", "room", "house", "view"];
/// The levels of texts, in the order of the documentation.
const LEVELS: &str = "object, room, house, view, route, changes, graph, instructions";

/// The things of a text by their ids.
#[derive(Serialize)]
struct ThingIds {
    /// The sensors' ids of objects, agents and pieces of the building, ascending.
    ids: Vec<i32>,
    /// Rooms, counted from 0, ascending.
    rooms: Vec<u32>,
}

impl ThingIds {
    fn of(house: &House, terms: &[Term]) -> Self {
        let (mut ids, mut rooms) = (Vec::new(), Vec::new());
        for term in terms {
            match term {
                Term::Object(id) => ids.push(house.entity_of_object(*id).0),
                Term::Structure(id) => ids.push(house.entity_of_structure(*id).0),
                Term::Agent(id) => ids.push(house.entity_of_agent(*id).0),
                Term::Room(id) => rooms.push(id.0),
                Term::Storey(_) | Term::Part(_) => {}
            }
        }
        ids.sort_unstable();
        rooms.sort_unstable();
        Self { ids, rooms }
    }
}

/// The number of letters before a byte of a text: Python counts letters.
pub(crate) fn char_offset(text: &str, byte: usize) -> usize {
    if text.is_ascii() {
        byte
    } else {
        text[..byte].chars().count()
    }
}

/// A noun phrase of a text by its letters, with the ids of its things.
#[derive(Serialize)]
pub(crate) struct SpanRow {
    start: usize,
    end: usize,
    #[serde(flatten)]
    things: ThingIds,
}

/// The noun phrases of a text.
pub(crate) fn spans(house: &House, text: &str, phrases: &[GroundedPhrase]) -> Vec<SpanRow> {
    let spans = phrases.iter().map(|phrase| SpanRow {
        start: char_offset(text, phrase.start),
        end: char_offset(text, phrase.end),
        things: ThingIds::of(house, &phrase.terms),
    });
    spans.collect()
}

/// A claim of a text by its letters.
#[derive(Serialize)]
struct ClaimRow<'a> {
    start: usize,
    end: usize,
    form: &'a Form,
    #[serde(flatten)]
    things: ThingIds,
}

/// A text with what it is about.
#[derive(Serialize)]
pub(crate) struct TextRow<'a> {
    text: &'a str,
    spans: Vec<SpanRow>,
    claims: Vec<ClaimRow<'a>>,
    #[serde(flatten)]
    things: ThingIds,
}

/// A text by its letters, with the ids of the things that it is about.
pub(crate) fn text_row<'a>(house: &House, text: &'a GroundedText) -> TextRow<'a> {
    let claims = text.claims.iter().map(|claim| ClaimRow {
        start: char_offset(&text.text, claim.start),
        end: char_offset(&text.text, claim.end),
        form: &claim.form,
        things: ThingIds::of(house, &claim.terms),
    });
    let terms = text.claims.iter().flat_map(|claim| &claim.terms);
    let mut all: Vec<Term> = terms.copied().collect();
    all.sort_unstable();
    all.dedup();
    TextRow {
        text: &text.text,
        spans: spans(house, &text.text, &text.phrases),
        claims: claims.collect(),
        things: ThingIds::of(house, &all),
    }
}

/// Returns an instruction with its goal and its noun phrases, by the ids of sensors and of the scene graph.
fn instruction_row(scene: &SemanticScene<'_>, instruction: &Instruction) -> Result<Value, PyFault> {
    let house = scene.house();
    let phrases = instruction.ground(scene);
    Ok(json!({
        "kind": instruction.kind.name(),
        "text": instruction.text,
        "form": serde_json::to_value(&instruction.form)?,
        "spans": spans(house, &instruction.text, &phrases),
        "goal": goal(house, &instruction.goal),
    }))
}

/// Returns the goal of an instruction: ids of objects, rooms counted from 0.
fn goal(house: &House, goal: &InstructionGoal) -> Value {
    let ids = goal.objects.iter().map(|id| house.entity_of_object(*id).0);
    json!({
        "rooms": goal.rooms,
        "objects": ids.collect::<Vec<_>>(),
        "radius_m": goal.radius_m,
        "in_sight": goal.in_sight,
    })
}

/// How a text is told: the names of its length and its style, and the seed of its wording.
pub(crate) type TextArguments<'a> = (&'a str, &'a str, Option<u64>);

/// The options of a text; some levels have only one length or style. One seed does not choose the same wordings in every house.
fn text_options(
    house: &House,
    level: &str,
    (length, style, seed): TextArguments<'_>,
) -> Result<TextOptions, PyFault> {
    let unknown = |what: &str, name: &str, allowed: &[&str]| {
        let allowed = allowed.join(", ");
        PyFault::Config(format!("{what} is {name:?}; allowed are {allowed}"))
    };
    let only = |what: &str, name: &str, levels: &[&str]| {
        let levels = levels.join(", ");
        PyFault::Config(format!(
            "{what} is {name:?} with level {level:?}; only the levels {levels} have others than the default"
        ))
    };
    let lengths = TextLength::ALL.map(TextLength::name);
    let found = TextLength::find(length).ok_or_else(|| unknown("length", length, &lengths))?;
    if found != TextLength::default() && !LEVELS_WITH_LENGTHS.contains(&level) {
        return Err(only("length", length, &LEVELS_WITH_LENGTHS));
    }
    let styles = TextStyle::ALL.map(TextStyle::name);
    let told = TextStyle::find(style).ok_or_else(|| unknown("style", style, &styles))?;
    if told != TextStyle::default() && !LEVELS_WITH_STYLES.contains(&level) {
        return Err(only("style", style, &LEVELS_WITH_STYLES));
    }
    Ok(TextOptions {
        length: found,
        style: told,
        wording: seed.map(|seed| RandomKey::root(seed).child(house.name.as_str())),
    })
}

/// What is to be described.
#[derive(Default)]
pub(crate) struct DescriptionRequest<'a> {
    /// The level.
    pub(crate) level: &'a str,
    /// How it is told.
    pub(crate) options: TextArguments<'a>,
    /// Who listens.
    pub(crate) listener: Addressee,
    /// The goal of a route.
    pub(crate) to: Option<Term>,
    /// The scene before the changes.
    pub(crate) before: Option<&'a SemanticScene<'a>>,
}

/// Texts about a house as it stands in a state: a mapping each.
///
/// # Errors
/// [`PyFault::Config`] for an unknown level, length or style, and for a level without what it needs.
pub(crate) fn describe_level(
    scene: &SemanticScene<'_>,
    request: &DescriptionRequest<'_>,
) -> Result<PyValue, PyFault> {
    let (house, level, listener) = (scene.house(), request.level, request.listener);
    let needs = |what: &str| {
        PyFault::Config(format!(
            "level is {level:?}: World.describe has it, with {what}"
        ))
    };
    let options = text_options(house, level, request.options)?;
    let (_, _, seed) = request.options;
    let texts = match level {
        "house" => vec![describe_house(scene, options)],
        "room" => describe_rooms(scene, options),
        "object" => captions(scene, options),
        "view" | "route" if listener.viewer.is_none() => {
            return Err(needs("viewer or agent"));
        }
        "view" => vec![describe_view(scene, listener, options)],
        "route" => {
            let to = request.to.ok_or_else(|| needs("to, a thing or a room"))?;
            let route = describe_route(scene, listener, to, options);
            route.into_iter().collect()
        }
        "changes" => {
            let before = request.before.ok_or_else(|| needs("since, a snapshot"))?;
            vec![describe_changes(before, scene, listener, options.wording)]
        }
        "graph" => {
            let text = serde_json::to_string(&scene_graph(scene, None))?;
            return PyValue::of(&[json!({ "text": text })]);
        }
        "instructions" => {
            let mut rows = Vec::new();
            for kind in InstructionKind::ALL {
                for (k, instruction) in candidates(scene, kind).into_iter().enumerate() {
                    let worded = seed.and_then(|seed| {
                        let key = RandomKey::root(seed).child(k as u64);
                        choose(scene.semantics, std::slice::from_ref(&instruction), key)
                    });
                    rows.push(instruction_row(scene, &worded.unwrap_or(instruction))?);
                }
            }
            return PyValue::of(&rows);
        }
        other => {
            return Err(PyFault::Config(format!(
                "level is {other:?}; allowed are {LEVELS}"
            )));
        }
    };
    let rows: Vec<TextRow<'_>> = texts.iter().map(|text| text_row(house, text)).collect();
    PyValue::of(&rows)
}

impl WorldAccess<'_> {
    /// Texts of a level about the world as it is, `since` a snapshot or `to` a goal where the level needs them.
    pub(crate) fn describe(
        &self,
        level: &str,
        options: TextArguments<'_>,
        listener: Addressee,
        to: Option<JsonArgument>,
        since: Option<&[u8]>,
    ) -> Result<PyValue, PyFault> {
        let to = to.map(|to| self.term(&to.read()?)).transpose()?;
        let before = since.map(|bytes| self.world.state_of_snapshot(bytes));
        let before = before.transpose()?;
        let semantics = self.world.engines().semantics();
        let before = before.as_ref().map(|state| semantics.scene(state));
        let request = DescriptionRequest {
            level,
            options,
            listener,
            to,
            before: before.as_ref(),
        };
        describe_level(&self.scene(), &request)
    }
}
