//! Answer a question about the house: walk, look, and say the answer with `stop`.
//!
//! # Source
//! A. Das et al., "Embodied Question Answering", CVPR 2018: the task, its kinds of questions, and what is measured of the way.

mod arrangement;
mod candidates;
mod progress;
mod settings;

use super::door_leaves::DoorLeaves;
use super::navigation::{Leg, NavigationRules};
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{
    Answer, AnswerField, Episode, GoalField, MAX_ANSWER_FIELDS, StepResult, TaskMeasure,
};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use candidates::{QuestionCandidate, enumerate_questions};
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::ask::{self, QuestionKind};
use dwell_semantics::vocabulary;
use progress::QuestionProgress;
use settings::EmbodiedQaSettings;
use std::collections::BTreeMap;
use std::sync::Arc;

const NAME: &str = "EmbodiedQA";
/// Questions that are tried for an episode.
const DRAWS: u64 = 64;

const MEASURES: &[TaskMeasure] = &[
    TaskMeasure {
        name: "answer_correct",
        about: "1 where the answer that was given with `stop` is right, else 0.",
    },
    TaskMeasure {
        name: "distance_decrease",
        about: "By how much nearer the goal is than at the start, m.",
    },
    TaskMeasure {
        name: "min_distance_to_goal",
        about: "The least distance to the goal so far, m.",
    },
    TaskMeasure {
        name: "in_goal_room",
        about: "1 where the agent is in the room in which the answer is seen, else 0.",
    },
    TaskMeasure {
        name: "entered_goal_room",
        about: "1 where it has been there at any time of the episode, else 0.",
    },
];

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Answer a question about the house: walk, look, and say the answer with stop.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Question],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "question", "question_tokens"],
    measures: MEASURES,
    settings: schema::fields_of::<EmbodiedQaSettings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = EmbodiedQaSettings::parse(value, setup)?;
    Ok(Box::new(EmbodiedQa {
        settings,
        rules,
        setup,
        offers: BTreeMap::new(),
        active: None,
    }))
}

/// The question of an episode.
#[derive(Debug)]
struct ActiveQuestion {
    /// The number of the right answer.
    answer: usize,
    /// The way to where it is seen.
    leg: Leg,
    offer: Arc<QuestionCandidate>,
    progress: QuestionProgress,
}

/// What a house offers of a kind of question, by answer.
type OffersByAnswer = BTreeMap<&'static str, Vec<Arc<QuestionCandidate>>>;

#[derive(Debug)]
struct EmbodiedQa {
    settings: EmbodiedQaSettings,
    rules: NavigationRules,
    setup: TaskSetup,
    /// Questions that the house offers at its start, by kind; found once.
    offers: BTreeMap<QuestionKind, OffersByAnswer>,
    active: Option<ActiveQuestion>,
}

impl EmbodiedQa {
    /// A question: first its kind, then its answer, so that rare answers are as often right as others, then the question itself.
    fn draw(&self, key: RandomKey) -> Option<Arc<QuestionCandidate>> {
        let mut stream = key.stream();
        let kinds: Vec<&OffersByAnswer> = self.offers.values().collect();
        let answers: Vec<&Vec<Arc<QuestionCandidate>>> = stream.choose(&kinds)?.values().collect();
        let offers = stream.choose(&answers)?;
        stream.choose(offers).cloned()
    }

    /// Returns where the agent starts to look for the answer of a question, which it then stands ready for; `None` where it cannot.
    fn place(
        &mut self,
        world: &mut World,
        (offer, grid): (&Arc<QuestionCandidate>, &Arc<NavGrid>),
        room: &FreeStartCells,
        key: RandomKey,
    ) -> Result<Option<Pose>, WorldError> {
        let (agent, stride) = (self.setup.agent, self.setup.stride);
        let leg = Leg::new(agent, grid.clone(), offer.goal.clone(), stride);
        let leaves = DoorLeaves::of(world, grid);
        let opened = arrangement::opened_bounds(world, offer.asked.sets);
        let apart_m = self.setup.body(world, NAME)?.radius_m + arrangement::APART_M;
        let stands_free = |cell: NavCell| {
            let feet = grid.position(cell);
            let mut opened = opened.iter();
            opened
                .all(|part| feet.clamp(part.min, part.max).with_y(feet.y).distance(feet) > apart_m)
        };
        let allowed = |cell: NavCell| {
            grid.island(cell) == Some(0)
                && (leg.guide.distance_at(cell))
                    .is_some_and(|way_m| self.rules.allow_start(way_m, || leg.straight_m(cell)))
                && !leaves.is_blocked(grid, cell)
                && stands_free(cell)
        };
        let Some(start) = room.sample(grid, key.child("start"), allowed) else {
            return Ok(None);
        };
        let (position, yaw_rad) = (grid.position(start), random_yaw_rad(key));
        world.place_agent(agent, position, yaw_rad)?;
        // As the house stands now, with its doors as they are and the state of the thing that is asked about.
        let scene = world.engines().semantics().scene(world.state());
        let answer = offer.asked.answer_in(&scene);
        if answer != Some(offer.asked.answer) {
            return Ok(None);
        }
        let Some(answer) = answer.and_then(ask::answer_index) else {
            return Ok(None);
        };
        let start_m = leg.guide.distance_at(start);
        let is_there = offer.is_in_room(world, agent);
        self.active = Some(ActiveQuestion {
            answer,
            leg,
            offer: offer.clone(),
            progress: QuestionProgress::begin(start_m, is_there),
        });
        Ok(Some(Pose::from_position_yaw(position, yaw_rad)))
    }

    fn not_playable(&self, world: &World) -> WorldError {
        let [least, most] = self.rules.distance_m;
        let why = if self.offers.is_empty() {
            "it has nothing to ask about of the kinds that are asked for: no thing or room that has a name of its own and that one can go to and see, or of yes and no only one"
                .to_owned()
        } else {
            format!(
                "no question of the kinds that are asked for can be walked to from {least} to {most} m away"
            )
        };
        WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why,
        }
    }
}

impl Task for EmbodiedQa {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if !self.offers.is_empty() {
            return Ok(());
        }
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        for offer in enumerate_questions(world, self.setup.agent, &grid, &self.settings.kinds) {
            let of_kind = self.offers.entry(offer.asked.kind).or_default();
            let alike = of_kind.entry(offer.asked.answer).or_default();
            alike.push(Arc::new(offer));
        }
        // Who asks whether something is so where the answer is always the same asks nothing.
        let is_open = |by_answer: &OffersByAnswer| {
            by_answer.len() > 1 || !["yes", "no"].iter().any(|own| by_answer.contains_key(own))
        };
        self.offers.retain(|_, by_answer| is_open(by_answer));
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        self.active = None;
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        self.rules.arrange_doors(world, &grid, &self.setup)?;
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        for k in 0..DRAWS {
            interrupt::unwind_if_cancelled();
            let key = key.child("question").child(k);
            let Some(offer) = self.draw(key.child("kind")) else {
                break;
            };
            let Some(undo) = arrangement::arrange(world, offer.asked.sets)? else {
                continue;
            };
            let Some(start) = self.place(world, (&offer, &grid), &room, key)? else {
                undo.apply(world)?;
                continue;
            };
            let wording = key.child("wording").child(world.house().name.as_str());
            let engines = world.engines().clone();
            let text = offer.asked.worded(engines.semantics().language(), wording);
            let start_m = self
                .active
                .as_ref()
                .and_then(|active| active.progress.start_m);
            return Ok(Episode {
                agent: self.setup.agent,
                tokens: vocabulary::tokenize(&text)?,
                instruction: text,
                start,
                progress: NavigationMetrics::new(start.position, start_m),
                goal: offer.goal.told.clone(),
            });
        }
        Err(self.not_playable(world))
    }

    fn snapshot(&self) -> Vec<u8> {
        let active = self.active.as_ref();
        active.map_or_else(Vec::new, |active| active.progress.to_bytes())
    }

    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let no_episode = || WorldError::Snapshot("no question is asked".to_owned());
        let active = self.active.as_mut().ok_or_else(no_episode)?;
        active.progress = QuestionProgress::from_bytes(bytes)?;
        Ok(())
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        let id = self.setup.agent;
        let (Some(active), Some(agent)) = (&mut self.active, world.state().agents.get(id)) else {
            return StepResult::default();
        };
        let left_m = active.leg.guide.distance_m(world);
        let gain_m = episode
            .progress
            .advance(agent.position, left_m, agent.collided);
        let is_there = active.offer.is_in_room(world, id);
        active
            .progress
            .advance(episode.progress.distance_m, is_there);
        let stops = played.is_stop();
        if stops {
            let is_right = played.action.answer[0].round() == active.answer as f32;
            active.progress.answered = Some(is_right);
        }
        let is_right = active.progress.answered == Some(true);
        (self.rules).step_result((gain_m, agent.collided), stops, || is_right)
    }

    fn answer_fields(&self) -> Vec<AnswerField> {
        let choices = ask::answers();
        vec![AnswerField {
            name: "answer",
            about: "The answer, by its number in the closed list.",
            unit: "",
            range: [0.0, choices.len() as f32 - 1.0],
            choices: Some(choices.to_vec()),
        }]
    }

    fn expert_answer(&self, _world: &World) -> Answer {
        let mut answer = [0.0; MAX_ANSWER_FIELDS];
        if let Some(active) = &self.active {
            answer[0] = active.answer as f32;
        }
        answer
    }

    fn measures(&self) -> Vec<f64> {
        let active = self.active.as_ref();
        active.map_or_else(
            || vec![f64::NAN; MEASURES.len()],
            |active| active.progress.measures().to_vec(),
        )
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let active = self.active.as_mut();
        let step = active.and_then(|active| active.leg.approach(world));
        step.unwrap_or(DiscreteAction::Stop)
    }
}
