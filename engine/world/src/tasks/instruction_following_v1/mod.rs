//! Do what an instruction says with feet and hands; then stop.
//!
//! Each step has conditions. A step is done as soon as enough of them hold after the steps before it are done. At the end the conditions
//! of things must still hold (a fridge that was to be opened is open), but for those that a later step undoes; where the agent is and
//! looks counts for the last step alone. What was not to be done must never have been so.
//!
//! A route is followed by one whose own path passes its milestones in order, and who stops at its end.

mod active_form;
mod active_instruction;
mod active_route;
mod drawn_instruction;
mod drawn_route;
mod planned_step;
mod settings;
mod step_candidates;
mod step_places;

use super::door_leaves::DoorLeaves;
use super::navigation::NavigationRules;
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, StepResult, TaskMeasure};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use active_form::ActiveForm;
use active_instruction::ActiveInstruction;
use active_route::ActiveRoute;
use drawn_instruction::{DrawnInstruction, InstructionForm, InstructionSampler};
use drawn_route::{DrawnRoute, RouteSampler};
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, Entity, ObjectId, Pose};
use dwell_semantics::instruct::{RouteMilestone, StepCondition, StepKind};
use dwell_semantics::vocabulary;
use settings::InstructionFollowingV1Settings;
use std::sync::Arc;
use step_candidates::{StepCandidates, can_carry_out};

const NAME: &str = "InstructionFollowing-v1";
/// Instructions that are tried for an episode.
const DRAWS: u64 = 128;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 1,
    about: "Follow an instruction with feet and hands: one step or several, with conditions, numbers and what is not to be done; then stop.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[],
    max_steps: 1000,
    actions: &[
        DiscreteAction::Stop,
        DiscreteAction::MoveForward,
        DiscreteAction::TurnLeft,
        DiscreteAction::TurnRight,
        DiscreteAction::LookUp,
        DiscreteAction::LookDown,
        DiscreteAction::Wait,
        DiscreteAction::Pick,
        DiscreteAction::Drop,
        DiscreteAction::Open,
        DiscreteAction::Close,
        DiscreteAction::Toggle,
        DiscreteAction::Place,
        DiscreteAction::PutIn,
        DiscreteAction::Point,
    ],
    sensors: &[
        "rgb",
        "depth",
        "semantic",
        "audio",
        "instruction",
        "instruction_tokens",
    ],
    measures: &[
        TaskMeasure {
            name: "goal_condition_success",
            about: "Share of the instruction's conditions that hold, or of a route's milestones that were passed, 0 to 1.",
        },
        TaskMeasure {
            name: "ndtw",
            about: "Of a route: how closely the path keeps to it (nDTW), 0 to 1.",
        },
        TaskMeasure {
            name: "sdtw",
            about: "Of a route: nDTW in success, else 0 (SDTW).",
        },
    ],
    settings: schema::fields_of::<InstructionFollowingV1Settings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = InstructionFollowingV1Settings::read(value)?;
    let asked = settings.kinds.iter().copied();
    let kinds: Vec<StepKind> = asked
        .filter(|kind| can_carry_out(*kind, setup.actions))
        .collect();
    let has_steps = settings
        .forms
        .iter()
        .any(|form| *form != InstructionForm::Route);
    if kinds.is_empty() && has_steps {
        let names: Vec<&str> = settings.kinds.iter().map(|kind| kind.name()).collect();
        return Err(WorldError::Config {
            field: "kinds",
            found: names.join(", "),
            allowed: "at least one that the agent's actions can carry out".to_owned(),
        });
    }
    Ok(Box::new(InstructionFollowingV1 {
        settings,
        kinds,
        rules,
        setup,
        pool: None,
        active: None,
        measured: [f64::NAN; 3],
    }))
}

#[derive(Debug)]
struct InstructionFollowingV1 {
    settings: InstructionFollowingV1Settings,
    /// Kinds of steps that the agent's actions can carry out.
    kinds: Vec<StepKind>,
    rules: NavigationRules,
    setup: TaskSetup,
    /// What the house offers at its start; found once.
    pool: Option<StepCandidates>,
    active: Option<ActiveForm>,
    /// The values of the kind's measures, in their order.
    measured: [f64; 3],
}

impl InstructionFollowingV1 {
    /// Why nothing can be asked in a house.
    fn lack(&self, world: &World) -> WorldError {
        let offers = |kind: &&StepKind| self.pool.as_ref().is_some_and(|pool| pool.has(**kind));
        let offered: Vec<&str> = self
            .kinds
            .iter()
            .filter(offers)
            .map(|own| own.name())
            .collect();
        let forms: Vec<&str> = self.settings.forms.iter().map(|own| own.name()).collect();
        let why = if self
            .settings
            .forms
            .iter()
            .all(|own| *own == InstructionForm::Route)
        {
            "no route of three steps or more was found that can be told without doubt in one instruction and begins at the asked distance"
                .to_owned()
        } else if offered.is_empty() {
            "it has nothing to do of the kinds that are asked for, or nothing that one can go to and reach".to_owned()
        } else {
            format!(
                "it offers {}, but no instruction of the forms {} was found that can be walked to from the asked distance",
                offered.join(", "),
                forms.join(", ")
            )
        };
        WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why,
        }
    }
}

impl Task for InstructionFollowingV1 {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.pool.is_some() {
            return Ok(());
        }
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        let with_groups = self.settings.forms.contains(&InstructionForm::Quantity);
        let agent = (self.setup.agent, body);
        let pool =
            StepCandidates::from_world(world, agent, &grid, &self.surveyed_kinds(), with_groups);
        self.pool = Some(pool);
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        let (agent, stride) = (self.setup.agent, self.setup.stride);
        let body = self.setup.body(world, NAME)?;
        let grid: Arc<NavGrid> = world.engines().nav_grid(&body)?;
        self.rules.arrange_doors(world, &grid, &self.setup)?;
        let leaves = DoorLeaves::of(world, &grid);
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        let engines = world.engines().clone();
        let language = engines.semantics().language();
        for k in 0..DRAWS {
            interrupt::unwind_if_cancelled();
            let key = key.child("instruction").child(k);
            if self.form(key.child("steps")) == Some(InstructionForm::Route) {
                let site = (&grid, &leaves, &room);
                if let Some(episode) = self.begin_route(world, site, &body, key)? {
                    return Ok(episode);
                }
                continue;
            }
            let Some((form, drawn)) = self.draw(world, &grid, key.child("steps")) else {
                continue;
            };
            let wording = key.child("wording").child(world.house().name.as_str());
            let sentence = self
                .settings
                .words
                .compose(language, drawn.requests, wording);
            let Some(sentence) = sentence else {
                continue;
            };
            let goal = told(form, &drawn.steps);
            let plan = (agent, &grid, stride);
            let mut active = ActiveInstruction::new(drawn.steps, drawn.forbidden, plan);
            let allowed = |cell: NavCell| {
                grid.island(cell) == Some(0)
                    && active.geodesic_from_m(cell).is_some_and(|way_m| {
                        self.rules
                            .allow_start(way_m, || active.straight_line_from_m(cell))
                    })
                    && !leaves.is_blocked(&grid, cell)
            };
            let Some(start) = room.sample(&grid, key.child("start"), allowed) else {
                continue;
            };
            let yaw_rad = random_yaw_rad(key);
            let position = grid.position(start);
            world.place_agent(agent, position, yaw_rad)?;
            if active.advance(world, agent, None) > 0 || active.is_violated() {
                continue;
            }
            let distance_m = active.distance_m(world);
            let episode = Episode {
                agent,
                tokens: vocabulary::tokenize(&sentence.text)?,
                instruction: sentence.text,
                start: Pose::from_position_yaw(position, yaw_rad),
                progress: NavigationMetrics::new(position, distance_m),
                goal,
            };
            self.play(world, ActiveForm::Steps(Box::new(active)));
            return Ok(episode);
        }
        Err(self.lack(world))
    }

    fn snapshot(&self) -> Vec<u8> {
        let active = self.active.as_ref();
        active.map_or_else(Vec::new, ActiveForm::snapshot)
    }

    fn restore(&mut self, world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let Some(active) = &mut self.active else {
            return Err(WorldError::Snapshot("no instruction has begun".to_owned()));
        };
        active.restore(world, self.setup.agent, bytes)?;
        self.measure(world, false);
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
        let newly_done = active.advance(world, id, pointed_object(world, played));
        let left_m = active.distance_m(world);
        let gain_m = episode
            .progress
            .advance(agent.position, left_m, agent.collided);
        let is_reached = || active.is_fulfilled(world, id);
        let stops = played.is_stop();
        let mut result = (self.rules).step_result((gain_m, agent.collided), stops, is_reached);
        result.reward += self.settings.step_done_reward * newly_done as f64;
        self.measure(world, result.success);
        result
    }

    fn measures(&self) -> Vec<f64> {
        self.measured.to_vec()
    }

    fn expert(&mut self, world: &mut World, _episode: &Episode) -> DiscreteAction {
        let active = self.active.as_mut();
        active.map_or(DiscreteAction::Stop, |active| active.expert_action(world))
    }
}

impl InstructionFollowingV1 {
    /// The kinds of steps of which places and words are looked up: a route ends at a thing that is found.
    fn surveyed_kinds(&self) -> Vec<StepKind> {
        let forms = &self.settings.forms;
        let is_route = |form: &InstructionForm| *form == InstructionForm::Route;
        let mut kinds = if forms.iter().all(is_route) {
            Vec::new()
        } else {
            self.kinds.clone()
        };
        if forms.iter().any(is_route) && !kinds.contains(&StepKind::FindObject) {
            kinds.push(StepKind::FindObject);
        }
        kinds
    }

    /// The form that is drawn from `key`.
    fn form(&self, key: RandomKey) -> Option<InstructionForm> {
        key.stream().choose(&self.settings.forms).copied()
    }

    /// Begins to play an instruction.
    fn play(&mut self, world: &World, active: ActiveForm) {
        self.active = Some(active);
        self.measure(world, false);
    }

    fn measure(&mut self, world: &World, success: bool) {
        if let Some(active) = &self.active {
            let ndtw = active.ndtw();
            let sdtw = if success { ndtw } else { 0.0 * ndtw };
            let conditions = active.condition_success(world, self.setup.agent);
            self.measured = [conditions, ndtw, sdtw];
        }
    }

    /// Begins an episode with a route, drawn from `key`; `None` where that which was drawn cannot be told.
    fn begin_route(
        &mut self,
        world: &mut World,
        (grid, leaves, room): (&Arc<NavGrid>, &DoorLeaves, &FreeStartCells),
        body: &AgentBody,
        key: RandomKey,
    ) -> Result<Option<Episode>, WorldError> {
        let agent = self.setup.agent;
        let Some(pool) = &self.pool else {
            return Ok(None);
        };
        let scene = world.engines().semantics().scene(world.state());
        let draw = RouteSampler {
            pool,
            world,
            scene: &scene,
            grid,
            rules: &self.rules,
            leaves,
            room,
            eye_m: body.eye_height_m,
        };
        let Some(drawn) = draw.draw(key.child("route")) else {
            return Ok(None);
        };
        let language = scene.semantics.language();
        let wording = key.child("wording").child(world.house().name.as_str());
        let words = self.settings.words;
        let sentence = words.compose(language, drawn.route.requests(), wording);
        let active = ActiveRoute::new(&drawn, (agent, grid, self.setup.stride));
        let (Some(sentence), Some(mut active)) = (sentence, active) else {
            return Ok(None);
        };
        let position = grid.position(drawn.start);
        world.place_agent(agent, position, drawn.yaw_rad)?;
        if active.advance(world) > 0 {
            return Ok(None);
        }
        let episode = Episode {
            agent,
            tokens: vocabulary::tokenize(&sentence.text)?,
            instruction: sentence.text,
            start: Pose::from_position_yaw(position, drawn.yaw_rad),
            progress: NavigationMetrics::new(position, active.distance_m(world)),
            goal: told_of_route(&drawn),
        };
        self.play(world, ActiveForm::Route(Box::new(active)));
        Ok(Some(episode))
    }

    /// An instruction, drawn from `key`; `None` where that which was drawn cannot be done.
    fn draw(
        &self,
        world: &World,
        grid: &NavGrid,
        key: RandomKey,
    ) -> Option<(InstructionForm, DrawnInstruction)> {
        let pool = self.pool.as_ref()?;
        let offered = self.kinds.iter().copied().filter(|kind| pool.has(*kind));
        let scene = world.engines().semantics().scene(world.state());
        let draw = InstructionSampler {
            pool,
            scene: &scene,
            grid,
            kinds: &offered.collect::<Vec<StepKind>>(),
            settings: &self.settings,
        };
        let mut stream = key.stream();
        let form = *stream.choose(&self.settings.forms)?;
        Some((form, draw.draw(form, &mut stream)?))
    }
}

/// The thing that a step pointed at.
fn pointed_object(world: &World, played: &ExecutedAction<'_>) -> Option<ObjectId> {
    let pointed = played.outcome.pointed.filter(|_| played.outcome.success)?;
    match world.house().entity(pointed.entity)? {
        Entity::Object(object) => Some(object),
        _ => None,
    }
}

/// What sensors and infos tell of a route: its doors and landmarks, and the rooms that it names, in order.
fn told_of_route(drawn: &DrawnRoute) -> EpisodeGoal {
    let mut goal = EpisodeGoal {
        kind: InstructionForm::Route.name(),
        ..EpisodeGoal::default()
    };
    for step in &drawn.route.steps {
        match step.milestone {
            RouteMilestone::Left(room) | RouteMilestone::Entered(room) => goal.rooms.push(room),
            RouteMilestone::Through { door, .. } => goal.objects.push(door),
            RouteMilestone::Passed(thing) => goal.objects.push(thing),
            RouteMilestone::Turned { .. } => {}
            RouteMilestone::Reached(end) => {
                goal.objects.extend(end.object());
                goal.rooms.extend(end.room());
            }
        }
    }
    goal
}

/// What sensors and infos tell of an instruction.
fn told(form: InstructionForm, steps: &[planned_step::PlannedStep]) -> EpisodeGoal {
    let kind = match form {
        InstructionForm::Single => steps[0].step.kind.name(),
        form => form.name(),
    };
    let conditions = || {
        steps
            .iter()
            .flat_map(|own| own.step.conditions.iter().copied())
    };
    EpisodeGoal {
        kind,
        objects: conditions().flat_map(StepCondition::objects).collect(),
        rooms: conditions().filter_map(StepCondition::room).collect(),
        ..EpisodeGoal::default()
    }
}
