//! The episode that is played: the things that count, their energies, and what is told of them.

use super::box_overlap::OrientedBox;
use super::energy::{ThingGoal, TrackedThing};
use crate::episode::{EpisodeGoal, ObjectPlacement, TaskMeasure};
use crate::tasks::relocation::{Misplacement, RestoreExpert};
use crate::world::World;
use dwell_scene::Pose;

pub(super) const MEASURES: &[TaskMeasure] = &[
    TaskMeasure {
        name: "energy_start",
        about: "Sum of the energies of all things at the start; each is 0 (as it was) to 1.",
    },
    TaskMeasure {
        name: "energy_end",
        about: "The same now.",
    },
    TaskMeasure {
        name: "energy_prop",
        about: "energy_end as a share of energy_start.",
    },
    TaskMeasure {
        name: "prop_fixed",
        about: "Share of the things that were misplaced at the start and are as they were now.",
    },
    TaskMeasure {
        name: "prop_fixed_strict",
        about: "prop_fixed where nothing else is misplaced now, else 0.",
    },
    TaskMeasure {
        name: "prop_misplaced",
        about: "Number of things that are misplaced now, as a share of those at the start.",
    },
    TaskMeasure {
        name: "newly_misplaced",
        about: "Number of things that are misplaced now and were not at the start.",
    },
];

/// The episode that is played.
#[derive(Debug)]
pub(super) struct ActiveEpisode {
    pub(super) things: Vec<TrackedThing>,
    /// Energies at the start, and now. Shape (thing,).
    pub(super) start: Vec<f64>,
    pub(super) now: Vec<f64>,
    pub(super) restorer: RestoreExpert,
}

impl ActiveEpisode {
    /// Looks at the energies now; returns by how much their sum fell.
    pub(super) fn update(&mut self, world: &World) -> f64 {
        let before: f64 = self.now.iter().sum();
        self.now = self
            .things
            .iter()
            .map(|thing| thing.energy(world))
            .collect();
        before - self.now.iter().sum::<f64>()
    }

    pub(super) fn measures(&self) -> Vec<f64> {
        let (start, now): (f64, f64) = (self.start.iter().sum(), self.now.iter().sum());
        let pairs = || self.start.iter().zip(&self.now);
        let count = |is: &dyn Fn(f64, f64) -> bool| {
            pairs()
                .filter(|(before, after)| is(**before, **after))
                .count() as f64
        };
        let misplaced = count(&|before, _| before > 0.0);
        let fixed = count(&|before, after| before > 0.0 && after == 0.0);
        let newly = count(&|before, after| before == 0.0 && after > 0.0);
        let left = count(&|_, after| after > 0.0);
        let share = fixed / misplaced;
        let strict = if newly > 0.0 { 0.0 } else { share };
        vec![
            start,
            now,
            now / start,
            share,
            strict,
            left / misplaced,
            newly,
        ]
    }

    /// What is not as it is to be.
    pub(super) fn misplaced(&self) -> Vec<Misplacement> {
        let things = self.things.iter().zip(&self.now);
        let misplaced = things.filter(|(_, energy)| **energy > 0.0);
        let misplaced = misplaced.map(|(thing, _)| match thing.goal {
            ThingGoal::Pose { .. } => Misplacement::Thing(thing.object),
            ThingGoal::Openness(goal) => Misplacement::Furniture(thing.object, goal > 0.5),
        });
        misplaced.collect()
    }
}

/// What sensors and infos tell of the things that are to be put back.
pub(super) fn episode_goal(
    things: &[TrackedThing],
    energies: &[f64],
    world: &World,
) -> EpisodeGoal {
    let misplaced = things.iter().zip(energies);
    let misplaced = misplaced.filter(|(_, energy)| **energy > 0.0);
    let placements = misplaced.map(|(thing, _)| match thing.goal {
        ThingGoal::Pose {
            world_from_part,
            bounds,
            ..
        } => {
            let goal = OrientedBox::of(world_from_part, &bounds);
            ObjectPlacement {
                object: thing.object,
                world_from_box: goal.world_from_box,
                size: 2.0 * goal.half,
                openness: None,
            }
        }
        ThingGoal::Openness(openness) => {
            let bounds = world.house().object_bounds(world.state(), thing.object);
            ObjectPlacement {
                object: thing.object,
                world_from_box: Pose::from_position(bounds.center()),
                size: bounds.size(),
                openness: Some(openness),
            }
        }
    });
    let placements: Vec<ObjectPlacement> = placements.collect();
    EpisodeGoal {
        kind: "rearrangement",
        objects: placements.iter().map(|one| one.object).collect(),
        placements,
        ..EpisodeGoal::default()
    }
}
