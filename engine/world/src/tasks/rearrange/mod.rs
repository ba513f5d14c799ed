//! Put everything back as it was: things lie elsewhere, furniture stands open or closed.
//!
//! # Source
//! The task in one phase of L. Weihs, M. Deitke, A. Kembhavi, R. Mottaghi, "Visual Room Rearrangement", CVPR 2021 (`RoomR`).

mod active_episode;
mod box_overlap;
mod energy;
mod settings;
mod shuffle;
mod wording;

use super::door_leaves::{self, DoorLeaves};
use super::goal_cells::LargestIslandIndex;
use super::relocation::{HandMover, MovableThings, MoveTarget, OriginalPlace, RestoreExpert};
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::{DiscreteAction, HandTarget};
use crate::episode::{Episode, GoalField, StepResult};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use active_episode::{ActiveEpisode, MEASURES, episode_goal};
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{Aabb, AgentBody, AgentId, JointId, ObjectId, Pose};
use dwell_semantics::vocabulary;
use energy::{ThingGoal, tracked_things};
use glam::Vec3;
use settings::RearrangeSettings;
use shuffle::{OpenableThing, openable_things};
use std::collections::BTreeMap;
use std::sync::Arc;
use wording::{RestingRelation, support_relation};

const NAME: &str = "Rearrange";
/// Things that are tried for one that is moved.
const TRIES: usize = 8;
/// Furthest angle from the middle of the view at which a place is in view: 45 degrees; its cosine.
const IN_VIEW: f32 = std::f32::consts::FRAC_1_SQRT_2;

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Put everything back as it was: one to five things lie elsewhere, or stand open or closed; then stop.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Placements],
    max_steps: 5000,
    actions: DiscreteAction::ALL.split_at(13).0,
    sensors: &[
        "rgb",
        "depth",
        "instance",
        "gps",
        "compass",
        "rearrangegoal",
    ],
    measures: MEASURES,
    settings: schema::fields_of::<RearrangeSettings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: RearrangeSettings = crate::parse_settings::parse_task_settings(value)?;
    settings.check()?;
    Ok(Box::new(Rearrange {
        settings,
        setup,
        offer: None,
        active: None,
    }))
}

/// What a house offers at its start.
#[derive(Debug)]
struct HouseOffer {
    movable: MovableThings,
    openable: Vec<OpenableThing>,
}

/// What was changed before an episode.
#[derive(Debug, Default)]
struct Shuffled {
    /// Furniture that was opened or closed.
    swung: Vec<ObjectId>,
    /// Where things lay that were moved.
    places: BTreeMap<ObjectId, OriginalPlace>,
    /// What they were in or on.
    rested: BTreeMap<ObjectId, RestingRelation>,
}

#[derive(Debug)]
struct Rearrange {
    settings: RearrangeSettings,
    setup: TaskSetup,
    /// Found once.
    offer: Option<HouseOffer>,
    active: Option<ActiveEpisode>,
}

/// The joints of the doors between rooms.
fn room_doors(grid: &NavGrid) -> Vec<JointId> {
    grid.doors().into_iter().map(|door| door.joint).collect()
}

impl Rearrange {
    fn unplayable(world: &World, why: &str) -> WorldError {
        WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why: why.to_owned(),
        }
    }

    /// Moves things and swings furniture.
    fn shuffle(
        &self,
        mover: &mut HandMover<'_>,
        offer: &HouseOffer,
        key: RandomKey,
    ) -> Result<Shuffled, WorldError> {
        let settings = &self.settings;
        let mut stream = key.child("count").stream();
        let (least, most) = (settings.min_things as usize, settings.max_things as usize);
        let count = least + stream.below(most - least + 1);
        let swung = stream.below((settings.max_openables as usize).min(count) + 1);
        let mut shuffled = Shuffled::default();
        let mut openable: Vec<&OpenableThing> = offer.openable.iter().collect();
        let mut stream = key.child("openables").stream();
        stream.shuffle(&mut openable);
        for thing in openable.into_iter().take(TRIES) {
            if shuffled.swung.len() < swung && thing.toggle_open(mover.world, &mut stream)? {
                shuffled.swung.push(thing.object);
            }
        }
        let mut stream = key.child("things").stream();
        let mut things: Vec<_> = offer.movable.things.iter().collect();
        things.retain(|thing| {
            let class = &mover.world.house().objects[thing.object].category.coarse;
            settings.classes.is_empty() || settings.classes.contains(class)
        });
        stream.shuffle(&mut things);
        let wanted = count - shuffled.swung.len();
        let supports = offer.movable.supports.iter().copied();
        let targets: Vec<MoveTarget> = supports.map(MoveTarget::Object).collect();
        for thing in things.into_iter().take(TRIES * wanted) {
            if shuffled.places.len() == wanted {
                break;
            }
            let Some(cell) = mover.try_put_back(thing, &mut stream)? else {
                continue;
            };
            let (house, state) = (mover.world.house(), mover.world.state());
            let bounds = house.object_bounds(state, thing.object);
            let world_from_part = state.part_pose[house.objects[thing.object].first_part];
            let middle = bounds.center();
            let distances = settings.min_move_m..=settings.max_move_m;
            // Well elsewhere on the same furniture is elsewhere, too.
            let is_allowed =
                |_: &World, _: MoveTarget, point: Vec3| distances.contains(&point.distance(middle));
            let rested = support_relation(mover.world, thing.object);
            mover.kept_free.push(bounds);
            if mover.try_move_to((thing.object, cell), &targets, &mut stream, &is_allowed)? {
                let place = OriginalPlace::new(thing, (bounds, world_from_part));
                shuffled.places.insert(thing.object, place);
                shuffled
                    .rested
                    .extend(rested.map(|rested| (thing.object, rested)));
            } else {
                mover.kept_free.pop();
            }
        }
        Ok(shuffled)
    }
}

impl Task for Rearrange {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.offer.is_some() {
            return Ok(());
        }
        let agent = self.setup.agent;
        let body: AgentBody = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        let doors = room_doors(&grid);
        self.offer = Some(HouseOffer {
            movable: MovableThings::of(world, (agent, &body), &grid),
            openable: if self.settings.max_openables > 0 {
                openable_things(world, agent, (&grid, &doors))
            } else {
                Vec::new()
            },
        });
        Ok(())
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        self.active = None;
        self.survey_house(world)?;
        let agent = self.setup.agent;
        let body = self.setup.body(world, NAME)?;
        let grid: Arc<NavGrid> = world.engines().nav_grid(&body)?;
        if self.settings.open_doors {
            door_leaves::open_all(world, &grid)?;
        }
        let leaves = DoorLeaves::of(world, &grid);
        let room = FreeStartCells::excluding_agents(world, placed, &body);
        let is_free = |cell: NavCell| {
            grid.island(cell) == Some(0)
                && !leaves.is_blocked(&grid, cell)
                && room.is_free(grid.position(cell))
        };
        let ground = LargestIslandIndex::of(&grid);
        let mut things = tracked_things(world, &room_doors(&grid));
        let mut mover = HandMover {
            world: &mut *world,
            agent,
            body,
            ground: &ground,
            is_free: &is_free,
            kept_free: Vec::new(),
        };
        let Some(offer) = &self.offer else {
            return Err(Self::unplayable(world, "it was not looked at"));
        };
        let shuffled = self.shuffle(&mut mover, offer, key.child("shuffle"))?;
        // Things that hands have put back lie as they do then.
        for thing in &mut things {
            if let (
                Some(place),
                ThingGoal::Pose {
                    world_from_part, ..
                },
            ) = (shuffled.places.get(&thing.object), &mut thing.goal)
            {
                *world_from_part = place.world_from_part;
            }
        }
        let start: Vec<f64> = things.iter().map(|thing| thing.energy(world)).collect();
        let misplaced = start.iter().filter(|energy| **energy > 0.0).count();
        if misplaced < self.settings.min_things as usize {
            let why = "it has too few things that can be taken and put elsewhere from where one can stand";
            return Err(Self::unplayable(world, why));
        }
        let swung: Vec<Aabb> = shuffled
            .swung
            .iter()
            .map(|object| world.house().object_bounds(world.state(), *object))
            .collect();
        let is_start = |cell: NavCell| {
            let feet = grid.position(cell) + Vec3::Y * 0.5 * body.height_m;
            let near = 0.5 * body.height_m;
            grid.island(cell) == Some(0)
                && !leaves.is_blocked(&grid, cell)
                && !swung.iter().any(|other| {
                    let around = other.grown(body.radius_m);
                    let (low, high) = (feet - Vec3::Y * near, feet + Vec3::Y * near);
                    around.intersects(&Aabb::new(low, high))
                })
        };
        let Some(cell) = room.sample(&grid, key.child("start"), is_start) else {
            return Err(Self::unplayable(
                world,
                "nobody of the agent's size can stand anywhere",
            ));
        };
        let (position, yaw_rad) = (grid.position(cell), random_yaw_rad(key));
        world.place_agent(agent, position, yaw_rad)?;
        let goal = episode_goal(&things, &start, world);
        let instruction = wording::instruction(world, &goal.placements, &shuffled.rested);
        // What is knocked over on the way is put back, too.
        let goals: BTreeMap<ObjectId, Pose> = things
            .iter()
            .filter_map(|thing| match thing.goal {
                ThingGoal::Pose {
                    world_from_part, ..
                } => Some((thing.object, world_from_part)),
                ThingGoal::Openness(_) => None,
            })
            .collect();
        let mut places = shuffled.places;
        for thing in &offer.movable.things {
            if let (Some(world_from_part), false) =
                (goals.get(&thing.object), places.contains_key(&thing.object))
            {
                let bounds = world.house().object_bounds(world.state(), thing.object);
                let at = (bounds, *world_from_part);
                places.insert(thing.object, OriginalPlace::new(thing, at));
            }
        }
        let setup = (agent, &grid, self.setup.stride);
        let openable = offer.openable.iter();
        let openable = openable.map(|thing| (thing.object, thing.cells.clone()));
        self.active = Some(ActiveEpisode {
            restorer: RestoreExpert::new(setup, places, openable.collect()),
            now: start.clone(),
            start,
            things,
        });
        Ok(Episode {
            agent,
            tokens: vocabulary::tokenize(&instruction)?,
            instruction,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, None),
            goal,
        })
    }

    fn snapshot(&self) -> Vec<u8> {
        let now = self.active.as_ref().map_or(&[][..], |active| &active.now);
        now.iter().flat_map(|energy| energy.to_le_bytes()).collect()
    }

    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        let told: Vec<f64> = bytes
            .chunks_exact(8)
            .map(|word| f64::from_le_bytes(word.try_into().unwrap_or_default()))
            .collect();
        let is_energy = |energy: &f64| (0.0..=1.0).contains(energy);
        match &mut self.active {
            Some(active) if 8 * active.now.len() == bytes.len() && told.iter().all(is_energy) => {
                active.now = told;
                Ok(())
            }
            _ => Err(WorldError::Snapshot(format!(
                "the energies of its things are {} bytes; allowed is 8 for each, 0 to 1",
                bytes.len()
            ))),
        }
    }

    fn hand_target(&self, world: &World, action: DiscreteAction) -> Option<HandTarget> {
        if action != DiscreteAction::Place || !self.settings.snap {
            return None;
        }
        let agent = world.state().agents.get(self.setup.agent)?;
        let held = agent.holding?;
        let active = self.active.as_ref()?;
        let thing = active.things.iter().find(|thing| thing.object == held)?;
        let ThingGoal::Pose {
            world_from_part,
            bounds,
            ..
        } = thing.goal
        else {
            return None;
        };
        let around = bounds.transformed(&world_from_part.to_affine());
        let middle = around.center();
        let eye = agent.eye_position();
        let looks = agent.world_from_eye().transform_vector(Vec3::NEG_Z);
        let in_view = (middle - eye).normalize_or(looks).dot(looks) >= IN_VIEW;
        let near = eye.distance(middle.with_y(around.min.y)) <= agent.body.reach_m;
        (in_view && near).then_some(HandTarget::Pose(world_from_part))
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        let agent = world.state().agents.get(self.setup.agent);
        let (Some(active), Some(agent)) = (&mut self.active, agent) else {
            return StepResult::default();
        };
        let progress = &mut episode.progress;
        progress.advance(agent.position, None, agent.collided);
        let pay = &self.settings.reward;
        let mut reward = pay.energy * active.update(world) + pay.step;
        if agent.collided {
            reward += pay.collision;
        }
        let stops = played.is_stop();
        let success = stops && active.now.iter().all(|energy| *energy == 0.0);
        if success {
            reward += pay.success;
        } else if stops {
            reward += pay.wrong_stop;
        }
        StepResult {
            reward,
            terminated: stops,
            success,
        }
    }

    fn measures(&self) -> Vec<f64> {
        let none = || vec![f64::NAN; MEASURES.len()];
        self.active
            .as_ref()
            .map_or_else(none, ActiveEpisode::measures)
    }

    fn expert(&mut self, world: &mut World, _: &Episode) -> DiscreteAction {
        let Some(active) = &mut self.active else {
            return DiscreteAction::Stop;
        };
        let misplaced = active.misplaced();
        active.restorer.next_action(world, &misplaced)
    }
}
