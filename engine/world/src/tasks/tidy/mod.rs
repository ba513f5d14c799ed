//! Put things away: some lie where they do not belong. Where kinds of things belong is written in `assets/tidy_rules.csv`.

mod rules;
mod settings;

use super::door_leaves::{self, DoorLeaves};
use super::goal_cells::LargestIslandIndex;
use super::relocation::{
    HandMover, Misplacement, MovableThings, MoveTarget, OriginalPlace, RestoreExpert,
};
use super::standing_room::FreeStartCells;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, StepResult, TaskMeasure};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId, PartId, Pose};
use dwell_semantics::vocabulary;
use glam::Vec3;
use rules::{FLOOR, has_rule, is_place_for, is_tidy, room_kind};
use settings::TidySettings;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

const NAME: &str = "Tidy";
const ASKED: &str = "Put things away.";
/// Things that are tried for one that is moved.
const TRIES: usize = 8;
/// A thing that moved by less lies as before, m.
const STILL_M: f32 = 0.001;
/// The most places of things of its kind where the expert puts a thing whose own it gives up.
const SPARE_PLACES: usize = 4;

const MEASURES: &[TaskMeasure] = &[
    TaskMeasure {
        name: "tidied",
        about: "Share of the things that lay where they do not belong which lie where they belong now.",
    },
    TaskMeasure {
        name: "untidy",
        about: "Number of things that lie where they do not belong now, or are held, of those that were moved and those that were tidy.",
    },
    TaskMeasure {
        name: "newly_untidy",
        about: "How many of these were tidy at the start.",
    },
];

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Put things away that lie where they do not belong, by written rules, then stop.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[],
    max_steps: 3000,
    actions: DiscreteAction::ALL.split_at(14).0,
    sensors: &["rgb", "depth", "semantic", "instance", "gps", "compass"],
    measures: MEASURES,
    settings: schema::fields_of::<TidySettings>,
    build,
};

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: TidySettings = crate::parse_settings::parse_task_settings(value)?;
    settings.check()?;
    Ok(Box::new(Tidy {
        settings,
        setup,
        offer: None,
        active: None,
    }))
}

/// What a house offers at its start.
#[derive(Debug)]
struct HouseOffer {
    /// What can be moved, and lies where it belongs.
    movable: MovableThings,
    /// All things that lie where they belong.
    tidy: Vec<ObjectId>,
}

/// A thing of which the rules say where it belongs.
#[derive(Clone, Copy, Debug)]
struct RuledThing {
    object: ObjectId,
    part: PartId,
    /// Whether it was moved before the episode began.
    displaced: bool,
    /// Where it was when it was looked at, and how it was then.
    seen_at: Pose,
    was_held: bool,
    is_tidy: bool,
}

/// The episode that is played.
#[derive(Debug)]
struct ActiveEpisode {
    things: Vec<RuledThing>,
    restorer: RestoreExpert,
}

impl ActiveEpisode {
    /// Looks at the things that have moved.
    fn update(&mut self, world: &World) {
        let scene = world.engines().semantics().scene(world.state());
        for thing in &mut self.things {
            let at = world.state().part_pose[thing.part];
            let is_held = world.state().held_by[thing.object].is_some();
            let moved = at.position.distance(thing.seen_at.position) > STILL_M
                || at.rotation.dot(thing.seen_at.rotation).abs() < 0.9999;
            // What came to rest since the latest step is looked at, too.
            if moved || is_held != thing.was_held || !thing.is_tidy {
                thing.is_tidy = is_tidy(&scene, thing.object);
                (thing.seen_at, thing.was_held) = (at, is_held);
            }
        }
    }

    fn untidy(&self) -> impl Iterator<Item = &RuledThing> {
        self.things.iter().filter(|thing| !thing.is_tidy)
    }

    fn measures(&self) -> Vec<f64> {
        let displaced = self.things.iter().filter(|thing| thing.displaced).count() as f64;
        let left = self.untidy().filter(|thing| thing.displaced).count() as f64;
        let all = self.untidy().count() as f64;
        vec![(displaced - left) / displaced, all, all - left]
    }
}

#[derive(Debug)]
struct Tidy {
    settings: TidySettings,
    setup: TaskSetup,
    /// Found once.
    offer: Option<HouseOffer>,
    active: Option<ActiveEpisode>,
}

impl Tidy {
    fn unplayable(world: &World, why: &str) -> WorldError {
        WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why: why.to_owned(),
        }
    }

    /// Puts things where they do not belong; returns where they lay.
    fn displace(
        &self,
        mover: &mut HandMover<'_>,
        movable: &MovableThings,
        key: RandomKey,
    ) -> Result<BTreeMap<ObjectId, OriginalPlace>, WorldError> {
        let settings = &self.settings;
        let mut stream = key.child("count").stream();
        let (least, most) = (settings.min_things as usize, settings.max_things as usize);
        let count = least + stream.below(most - least + 1);
        let mut stream = key.child("things").stream();
        let mut things: Vec<_> = movable.things.iter().collect();
        things.retain(|thing| {
            let class = &mover.world.house().objects[thing.object].category.coarse;
            settings.classes.is_empty() || settings.classes.contains(class)
        });
        stream.shuffle(&mut things);
        let engines = mover.world.engines().clone();
        let mut places = BTreeMap::new();
        for thing in things.into_iter().take(TRIES * count) {
            if places.len() == count {
                break;
            }
            let is_right = |world: &World| {
                let scene = engines.semantics().scene(world.state());
                is_tidy(&scene, thing.object)
            };
            let Some(cell) = mover.try_put_down(thing, &mut stream, &is_right)? else {
                continue;
            };
            let (house, state) = (mover.world.house().clone(), mover.world.state());
            let bounds = house.object_bounds(state, thing.object);
            let world_from_part = state.part_pose[house.objects[thing.object].first_part];
            let class = house.objects[thing.object].category.coarse.as_str();
            let distances = settings.min_move_m..=settings.max_move_m;
            let is_wrong = |world: &World, target: MoveTarget, point: Vec3| {
                let scene = engines.semantics().scene(world.state());
                let place = match target {
                    MoveTarget::Object(object) => house.objects[object].category.coarse.as_str(),
                    MoveTarget::Floor => FLOOR,
                };
                let room = room_kind(&scene, house.room_at(point + 0.05 * Vec3::Y));
                distances.contains(&point.distance(bounds.center()))
                    && !is_place_for(class, place, room)
            };
            let targets: Vec<MoveTarget> = if stream.uniform() < settings.floor_share {
                vec![MoveTarget::Floor]
            } else {
                movable
                    .supports
                    .iter()
                    .copied()
                    .map(MoveTarget::Object)
                    .collect()
            };
            mover.kept_free.push(bounds);
            let of_hand = (thing.object, cell);
            if mover.try_move_to(of_hand, &targets, &mut stream, &is_wrong)?
                && !is_tidy(
                    &engines.semantics().scene(mover.world.state()),
                    thing.object,
                )
            {
                let place = OriginalPlace::new(thing, (bounds, world_from_part));
                places.insert(thing.object, place);
            }
        }
        Ok(places)
    }
}

impl Task for Tidy {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey_house(&mut self, world: &World) -> Result<(), WorldError> {
        if self.offer.is_some() {
            return Ok(());
        }
        let agent = self.setup.agent;
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        let scene = world.engines().semantics().scene(world.state());
        let house = world.house();
        let ruled = house.objects.ids().filter(|object| {
            let thing = &house.objects[*object];
            thing.pickable && has_rule(&thing.category.coarse)
        });
        let tidy: Vec<ObjectId> = ruled
            .filter(|object| {
                dwell_scene::interrupt::unwind_if_cancelled();
                is_tidy(&scene, *object)
            })
            .collect();
        let mut movable = MovableThings::of(world, (agent, &body), &grid);
        movable.things.retain(|thing| tidy.contains(&thing.object));
        self.offer = Some(HouseOffer { movable, tidy });
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
        let allowed =
            |cell: NavCell| grid.island(cell) == Some(0) && !leaves.is_blocked(&grid, cell);
        let is_free = |cell: NavCell| allowed(cell) && room.is_free(grid.position(cell));
        let ground = LargestIslandIndex::of(&grid);
        let Some(offer) = &self.offer else {
            return Err(Self::unplayable(world, "it was not looked at"));
        };
        let mut mover = HandMover {
            world: &mut *world,
            agent,
            body,
            ground: &ground,
            is_free: &is_free,
            kept_free: Vec::new(),
        };
        let places = self.displace(&mut mover, &offer.movable, key.child("displace"))?;
        if places.len() < self.settings.min_things as usize {
            let why = "it has too few things that lie where they belong and can be taken and put elsewhere from where one can stand";
            return Err(Self::unplayable(world, why));
        }
        let is_start = |cell: NavCell| {
            let feet = grid.position(cell);
            let clear = |object: &ObjectId| {
                let bounds = world.house().object_bounds(world.state(), *object);
                feet.clamp(bounds.min, bounds.max).distance(feet) > body.radius_m
            };
            allowed(cell) && places.keys().all(clear)
        };
        let Some(cell) = room.sample(&grid, key.child("start"), is_start) else {
            return Err(Self::unplayable(
                world,
                "nobody of the agent's size can stand anywhere",
            ));
        };
        let (position, yaw_rad) = (grid.position(cell), random_yaw_rad(key));
        world.place_agent(agent, position, yaw_rad)?;
        let house = world.house();
        let things = offer.tidy.iter().map(|object| {
            let part = house.objects[*object].first_part;
            let displaced = places.contains_key(object);
            RuledThing {
                object: *object,
                part,
                displaced,
                seen_at: world.state().part_pose[part],
                was_held: false,
                is_tidy: !displaced,
            }
        });
        let goal = EpisodeGoal {
            kind: "tidying",
            objects: places.keys().copied().collect(),
            ..EpisodeGoal::default()
        };
        let things = things.collect();
        let displaced: BTreeSet<ObjectId> = places.keys().copied().collect();
        // What is knocked over on the way is put back, too.
        let mut places = places;
        for thing in &offer.movable.things {
            places.entry(thing.object).or_insert_with(|| {
                let bounds = house.object_bounds(world.state(), thing.object);
                let part = house.objects[thing.object].first_part;
                let at = (bounds, world.state().part_pose[part]);
                OriginalPlace::new(thing, at)
            });
        }
        // What is right for a thing is right for all of its kind.
        let spare_places = displaced.iter().map(|object| {
            let at = places[object].foot();
            let alike = offer.tidy.iter().filter(|other| {
                house.objects[**other].category == house.objects[*object].category
                    && !displaced.contains(*other)
            });
            let mut alike: Vec<&OriginalPlace> =
                alike.filter_map(|other| places.get(other)).collect();
            alike.sort_by(|a, b| b.foot().distance(at).total_cmp(&a.foot().distance(at)));
            let nearest = alike.len().saturating_sub(SPARE_PLACES);
            (*object, alike.into_iter().skip(nearest).cloned().collect())
        });
        let spare_places = spare_places.collect();
        let setup = (agent, &grid, self.setup.stride);
        self.active = Some(ActiveEpisode {
            things,
            restorer: RestoreExpert::new(setup, places, BTreeMap::new())
                .placing_by_view()
                .with_spare_places(spare_places),
        });
        Ok(Episode {
            agent,
            instruction: ASKED.to_owned(),
            tokens: vocabulary::tokenize(ASKED)?,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, None),
            goal,
        })
    }

    fn snapshot(&self) -> Vec<u8> {
        let things = self
            .active
            .as_ref()
            .map_or(&[][..], |active| &active.things);
        things.iter().map(|thing| u8::from(thing.is_tidy)).collect()
    }

    fn restore(&mut self, world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        match &mut self.active {
            Some(active) if active.things.len() == bytes.len() => {
                for (thing, is_tidy) in active.things.iter_mut().zip(bytes) {
                    thing.is_tidy = *is_tidy == 1;
                    thing.seen_at = world.state().part_pose[thing.part];
                    thing.was_held = world.state().held_by[thing.object].is_some();
                }
                Ok(())
            }
            _ => Err(WorldError::Snapshot(format!(
                "the order of its things is {} bytes; allowed is one for each",
                bytes.len()
            ))),
        }
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
        let before = active.untidy().count() as f64;
        active.update(world);
        let now = active.untidy().count() as f64;
        let pay = &self.settings.reward;
        let mut reward = pay.tidied * (before - now) + pay.step;
        if agent.collided {
            reward += pay.collision;
        }
        let stops = played.is_stop();
        let success = stops && now == 0.0;
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
        let untidy = active
            .untidy()
            .map(|thing| Misplacement::Thing(thing.object));
        let untidy: Vec<Misplacement> = untidy.collect();
        active.restorer.next_action(world, &untidy)
    }
}
