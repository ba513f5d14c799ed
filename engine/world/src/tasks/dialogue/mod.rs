//! Find the thing that an ambiguous instruction means: ask the oracle which it is, go there, and stop.
//!
//! "Find the chair.", where there are several. An oracle without a body, as at the other end of a telephone, hears every question and
//! knows which one is meant; it replies what the checker of forms answers.
//!
//! # Source
//! J. Thomason et al., "Vision-and-Dialog Navigation", `CoRL` 2019: an ambiguous target, and an oracle with privileged knowledge; X. Gao et
//! al., "`DialFRED`", IEEE Robotics and Automation Letters 7(4), 10049 (2022): questions are the agent's own choice, an oracle answers
//! them from the simulator's state; T.-C. Chi et al., "Just Ask", AAAI 2020: each question costs.

mod candidates;
mod known_questions;
mod progress;
mod settings;

use super::door_leaves::DoorLeaves;
use super::navigation::{ELSEWHERE_M, Leg, NavigationRules};
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{
    Episode, GoalField, MAX_QUESTION_TOKENS, QuestionTokens, StepResult, TaskMeasure,
};
use crate::error::WorldError;
use crate::expert::LookAction;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use candidates::{DialogueCandidate, enumerate_instructions};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::dialogue::{self, Reply};
use dwell_semantics::instruct::InstructionGoal;
use dwell_semantics::{Term, vocabulary};
use glam::Vec3;
use known_questions::{DialogueRewards, KnownQuestions};
use progress::DialogueProgress;
use settings::DialogueSettings;
use std::collections::BTreeMap;
use std::sync::Arc;

const NAME: &str = "Dialogue";
/// Instructions that are tried for an episode.
const DRAWS: u64 = 64;
/// Starts that are tried for an instruction, where one has a thing reached already.
const STARTS: u64 = 8;

const MEASURES: &[TaskMeasure] = &[
    TaskMeasure {
        name: "questions_asked",
        about: "How many questions were answered, understood or not.",
    },
    TaskMeasure {
        name: "questions_not_understood",
        about: "How many of them the oracle did not understand.",
    },
    TaskMeasure {
        name: "candidates",
        about: "How many things the instruction fits.",
    },
    TaskMeasure {
        name: "stopped_at_candidate",
        about: "1 where the agent stopped at one of them, the one that is meant or another, else 0.",
    },
];

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Find the thing that an ambiguous instruction means: ask an oracle which it is, each question at a cost; then stop at it.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Replies],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &[
        "rgb",
        "depth",
        "semantic",
        "instruction",
        "instruction_tokens",
        "reply",
        "reply_tokens",
    ],
    measures: MEASURES,
    settings: schema::fields_of::<DialogueSettings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    Ok(Box::new(Dialogue::new(value, setup)?))
}

#[derive(Debug)]
struct Dialogue {
    settings: DialogueSettings,
    rules: NavigationRules,
    setup: TaskSetup,
    /// What the house offers at its start, by the number of things; found once.
    offers: BTreeMap<usize, Vec<DialogueCandidate>>,
    active: Option<ActiveDialogue>,
}

/// An episode under way.
#[derive(Debug)]
struct ActiveDialogue {
    offer: DialogueCandidate,
    /// The thing that is meant, by its place among those that fit.
    meant: usize,
    /// The way to it.
    leg: Leg,
    progress: DialogueProgress,
    /// What the oracle replied in the latest step.
    reply: Option<Reply>,
    asker: KnownQuestions,
    /// The things in the order in which the scripted asker guesses.
    guesses: Vec<usize>,
    /// The thing that it goes to, and its way.
    chosen: Option<(usize, Leg)>,
}

impl ActiveDialogue {
    /// Answers a question, and rules out what has another reply.
    fn ask(&mut self, world: &World, agent: AgentId, question: &QuestionTokens) {
        let words: Vec<i32> = question
            .iter()
            .take_while(|token| **token != 0)
            .map(|token| token.cast_signed())
            .collect();
        let scene = world.engines().semantics().scene(world.state());
        let checker = Checker::new(&scene, Addressee::agent(&scene, agent));
        let asked = &self.offer.asked;
        let read = (asked.topic).read_question(&checker, &vocabulary::detokenize(&words));
        let reply = match read {
            Err(_) => Reply::not_understood(),
            Ok(form) => {
                let of = |place: usize| {
                    dialogue::reply(&checker, &form, Term::Object(asked.things[place]))
                };
                let heard = of(self.meant);
                self.progress.retain(|place| of(place) == heard);
                heard
            }
        };
        self.progress.count_question(reply.understood);
        self.reply = Some(reply);
    }

    /// The thing that an agent stands at: of those that it has reached the one that it looks at, else the one nearest to the middle of
    /// its view.
    fn stands_at(&self, world: &World, agent: AgentId, radius_m: f32) -> Option<usize> {
        let eye = world.state().agents.get(agent)?.world_from_eye();
        let ahead = eye.transform_vector(Vec3::NEG_Z);
        let (scene, house) = (
            world.engines().semantics().scene(world.state()),
            world.house(),
        );
        let hit = world
            .rays()
            .closest(&Ray::new(eye.position, ahead), RayMask::EYE);
        let looked_at = hit.map(|hit| world.rays().surface(&hit).entity);
        let places = self.offer.asked.things.iter().enumerate();
        let reached = places.filter(|(_, thing)| {
            let goal = InstructionGoal::objects(vec![**thing], radius_m);
            goal.is_reached(&scene, world.rays(), agent)
        });
        let ranked = reached.map(|(place, thing)| {
            if looked_at == Some(house.entity_of_object(*thing)) {
                return (2.0, place);
            }
            let way = house.object_bounds(world.state(), *thing).center() - eye.position;
            (way.normalize_or_zero().dot(ahead), place)
        });
        let best = ranked.max_by(|one, other| one.0.total_cmp(&other.0).then(other.1.cmp(&one.1)));
        best.map(|(_, place)| place)
    }

    /// The question that the scripted asker asks now.
    fn next_question(
        &self,
        settings: &DialogueSettings,
        rules: &NavigationRules,
    ) -> Option<QuestionTokens> {
        let stakes = DialogueRewards {
            success: rules.rewards.success,
            question_cost: settings.question_cost,
        };
        let budget = settings.max_questions.saturating_sub(self.progress.asked());
        (self.asker).next_question(&self.progress.remaining(), budget, stakes)
    }
}

impl Dialogue {
    fn new(value: &serde_json::Value, setup: TaskSetup) -> Result<Self, WorldError> {
        let (settings, rules) = DialogueSettings::parse(value)?;
        Ok(Self {
            settings,
            rules,
            setup,
            offers: BTreeMap::new(),
            active: None,
        })
    }

    /// An instruction: first the number of its things, then the instruction.
    fn draw(&self, key: RandomKey) -> Option<&DialogueCandidate> {
        let mut stream = key.stream();
        let by_count: Vec<&Vec<DialogueCandidate>> = self.offers.values().collect();
        let alike: &[DialogueCandidate] = stream.choose(&by_count)?;
        stream.choose(alike)
    }

    /// A start that is as good for each thing of an instruction, none of which the agent has reached there; it stands there then.
    fn place(
        &self,
        world: &mut World,
        (grid, legs): (&Arc<NavGrid>, &[Leg]),
        room: &FreeStartCells,
        key: RandomKey,
    ) -> Result<Option<(NavCell, Pose)>, WorldError> {
        let leaves = DoorLeaves::of(world, grid);
        let allowed = |cell: NavCell| {
            let is_far = |leg: &Leg| {
                let way_m = leg.guide.distance_at(cell);
                way_m.is_some_and(|way_m| self.rules.allow_start(way_m, || leg.straight_m(cell)))
            };
            grid.island(cell) == Some(0)
                && legs.iter().all(is_far)
                && !leaves.is_blocked(grid, cell)
        };
        for attempt in 0..STARTS {
            let key = key.child(attempt);
            let Some(cell) = room.sample(grid, key.child("start"), allowed) else {
                return Ok(None);
            };
            let (position, yaw_rad) = (grid.position(cell), random_yaw_rad(key));
            world.place_agent(self.setup.agent, position, yaw_rad)?;
            if !legs.iter().any(|leg| leg.is_reached(world, None)) {
                return Ok(Some((cell, Pose::from_position_yaw(position, yaw_rad))));
            }
        }
        Ok(None)
    }

    /// Why no episode could begin.
    fn not_playable(&self, world: &World) -> WorldError {
        let [least, most] = self.rules.distance_m;
        let number: usize = self.offers.values().map(Vec::len).sum();
        let why = if number == 0 {
            format!(
                "no instruction fits {} to {} things all of which one can stand near and see",
                self.settings.min_candidates, self.settings.max_candidates
            )
        } else {
            format!(
                "of {number} instructions none was found whose things questions tell apart and can all be walked to from {least} to {most} m away"
            )
        };
        WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why,
        }
    }
}

impl Task for Dialogue {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.offers.is_empty() {
            let grid = world.engines().nav_grid(&self.setup.body(world, NAME)?)?;
            self.offers = enumerate_instructions(world, self.setup.agent, &grid, &self.settings);
        }
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        self.active = None;
        let agent = self.setup.agent;
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        self.rules.arrange_doors(world, &grid, &self.setup)?;
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        for k in 0..DRAWS {
            interrupt::unwind_if_cancelled();
            let key = key.child("dialogue").child(k);
            let Some(offer) = self.draw(key.child("instruction")).cloned() else {
                break;
            };
            let goals = offer.goals.iter().cloned();
            let legs = goals.map(|goal| Leg::new(agent, grid.clone(), goal, self.setup.stride));
            let mut legs: Vec<Leg> = legs.collect();
            let Some((cell, start)) = self.place(world, (&grid, &legs), &room, key)? else {
                continue;
            };
            let engines = world.engines().clone();
            let scene = engines.semantics().scene(world.state());
            let checker = Checker::new(&scene, Addressee::agent(&scene, agent));
            let asker = KnownQuestions::new(&checker, &offer.asked);
            let count = offer.asked.things.len();
            if !asker.distinguishes_all(count) {
                continue;
            }
            // Of all that fits one is as probable as another, wherever the agent stands.
            let meant = key.child("meant").stream().below(count);
            let mut guesses: Vec<usize> = (0..count).collect();
            key.child("guess").stream().shuffle(&mut guesses);
            let leg = legs.swap_remove(meant);
            let distance_m = leg.guide.distance_at(cell);
            let episode = Episode {
                agent,
                tokens: vocabulary::tokenize(&offer.asked.text)?,
                instruction: offer.asked.text.clone(),
                start,
                progress: NavigationMetrics::new(start.position, distance_m),
                goal: leg.goal.told.clone(),
            };
            self.active = Some(ActiveDialogue {
                offer,
                meant,
                leg,
                progress: DialogueProgress::begin(count),
                reply: None,
                asker,
                guesses,
                chosen: None,
            });
            return Ok(episode);
        }
        Err(self.not_playable(world))
    }

    fn snapshot(&self) -> Vec<u8> {
        let active = self.active.as_ref();
        active.map_or_else(Vec::new, |active| {
            active.progress.to_bytes(active.reply.as_ref())
        })
    }

    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let no_episode = || WorldError::Snapshot("no dialogue is under way".to_owned());
        let active = self.active.as_mut().ok_or_else(no_episode)?;
        let count = active.offer.asked.things.len();
        (active.progress, active.reply) =
            DialogueProgress::from_bytes(bytes, count, self.settings.max_questions)?;
        active.chosen = None;
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
        let (stops, question) = (played.is_stop(), &played.action.question);
        active.reply = None;
        let is_asked = question[0] != 0 && !stops;
        let is_answered = is_asked && active.progress.asked() < self.settings.max_questions;
        if is_answered {
            active.ask(world, id, question);
        }
        let mut success = false;
        if stops {
            let radius_m = self.settings.success_distance_m as f32;
            let place = active.stands_at(world, id, radius_m);
            active.progress.record_stop(place);
            success = place == Some(active.meant);
        }
        let mut result = (self.rules).step_result((gain_m, agent.collided), stops, || success);
        if is_answered {
            result.reward -= self.settings.question_cost;
        }
        result
    }

    fn measures(&self) -> Vec<f64> {
        let active = self.active.as_ref();
        active.map_or_else(
            || vec![f64::NAN; MEASURES.len()],
            |active| active.progress.measures().to_vec(),
        )
    }

    fn reply(&self) -> Option<&Reply> {
        self.active.as_ref()?.reply.as_ref()
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        if active.next_question(&self.settings, &self.rules).is_some() {
            return DiscreteAction::Wait;
        }
        let left = active.progress.remaining();
        let guess = active.guesses.iter().find(|place| left.contains(place));
        let Some(target) = guess.copied() else {
            return DiscreteAction::Stop;
        };
        if active
            .chosen
            .as_ref()
            .is_none_or(|(place, _)| *place != target)
        {
            let leg = active.leg.with_goal(active.offer.goals[target].clone());
            active.chosen = Some((target, leg));
        }
        let radius_m = self.settings.success_distance_m as f32;
        let is_there = active.stands_at(world, self.setup.agent, radius_m) == Some(target);
        let thing = active.offer.asked.things[target];
        let Some((_, leg)) = &mut active.chosen else {
            return DiscreteAction::Stop;
        };
        if let Some(step) = leg.walk(world) {
            return step;
        }
        if is_there {
            return DiscreteAction::Stop;
        }
        let middle = world.house().object_bounds(world.state(), thing).center();
        let turn = match leg.look_at(world, thing) {
            LookAction::Turn(turn) => Some(turn),
            LookAction::Done => None,
            LookAction::Missed => leg.face(world, middle),
        };
        if let Some(turn) = turn {
            return turn;
        }
        // It looks in vain: from elsewhere, then.
        if leg.exclude_goals_within(world, ELSEWHERE_M) {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }

    fn expert_question(&self) -> QuestionTokens {
        let active = self.active.as_ref();
        let asked = active.and_then(|active| active.next_question(&self.settings, &self.rules));
        asked.unwrap_or([0; MAX_QUESTION_TOKENS])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actions::{ActionSet, AgentAction, StepAction, StepSizes};
    use crate::config::WorldConfig;
    use crate::engines::Engines;
    use dwell_scene::AgentBody;

    const ME: AgentId = AgentId(0);

    /// Plays the scripted asker, whose oracle means the thing with this number whatever was drawn; at which thing it stopped.
    fn stops_at(world: &mut World, task: &mut Dialogue, key: RandomKey, means: usize) -> usize {
        let mut episode = task.reset(world, &[], key).unwrap();
        task.active.as_mut().unwrap().meant = means;
        for _ in 0..600 {
            let action = StepAction {
                question: task.expert_question(),
                ..task.expert(world, &episode).into()
            };
            let step = AgentAction::new(ME, action.action, StepSizes::default());
            let outcome = world.step_discrete_actions(&[step]).unwrap().swap_remove(0);
            let played = ExecutedAction {
                action: &action,
                outcome: &outcome,
            };
            if task.judge(world, &mut episode, &played).terminated {
                let radius_m = task.settings.success_distance_m as f32;
                let active = task.active.as_ref().unwrap();
                return active.stands_at(world, ME, radius_m).unwrap();
            }
        }
        panic!("{}: it goes on", episode.instruction);
    }

    /// It goes to what the replies are about, not to what was drawn.
    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn the_asker_goes_where_the_replies_lead() {
        let house = dwell_houses::builtin::build("apartment").unwrap();
        let config = WorldConfig {
            agents: vec![AgentBody::default()],
            ..WorldConfig::default()
        };
        let mut world = World::new(Engines::new(Arc::new(house)), &config).unwrap();
        let setup = TaskSetup {
            agent: ME,
            stride: StepSizes::default(),
            actions: ActionSet::of(DiscreteAction::DEFAULT),
        };
        let settings = serde_json::json!({"max_candidates": 4});
        let mut task = Dialogue::new(&settings, setup).unwrap();
        world.reset(RandomKey::root(0)).unwrap();
        task.survey_house(&world).unwrap();
        for seed in 0..3 {
            let key = RandomKey::root(seed);
            world.reset(key).unwrap();
            task.reset(&mut world, &[], key).unwrap();
            let count = task.active.as_ref().unwrap().offer.asked.things.len();
            for means in 0..count {
                world.reset(key).unwrap();
                assert_eq!(
                    stops_at(&mut world, &mut task, key, means),
                    means,
                    "seed {seed}"
                );
            }
        }
    }
}
