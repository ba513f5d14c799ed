//! Recovery of bodies that the solver loses: those whose position or velocity is no longer finite.
//!
//! rapier removes such a body from its world for good. Here it is put back at its last position, at rest, with a notice:
//! nothing is lost for the rest of an episode.

use super::PhysicsWorld;
use crate::outcome::{ActionOutcome, DelayedOutcome, OutcomeCode};

impl PhysicsWorld {
    /// Restores bodies that the last step lost. Returns whether there were any.
    pub(crate) fn recover_non_finite(&mut self) -> bool {
        let lost = self.dynamics.engine.take_removed_bodies();
        if lost.is_empty() {
            return false;
        }
        // Without them, so that contacts and warm starts forget them.
        self.dynamics.flush();
        let model = self.dynamics.model.clone();
        for handle in lost {
            self.dynamics.engine.restore_removed(handle);
            let Some(index) = self.dynamics.body_of(handle) else {
                continue;
            };
            let object = model.bodies[index].object;
            let name = self.dynamics.name_of(object);
            tracing::warn!(object = %model.house.objects[object].name, "the solver lost a body");
            self.notices.push(DelayedOutcome {
                agent: None,
                outcome: ActionOutcome::failed(
                    OutcomeCode::NonFiniteState,
                    format!("The {name} moved beyond all numbers and was stopped where it was."),
                    Some(object),
                ),
            });
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PhysicsConfig;
    use dwell_scene::State;
    use glam::Vec3;
    use std::sync::Arc;

    /// A body whose velocity is not finite stays where it was, and the world goes on, from a snapshot, too.
    #[test]
    fn what_is_lost_is_stopped_and_told() {
        let house = Arc::new(
            dwell_houses::open("builtin:studio")
                .expect("it is built in")
                .0,
        );
        let mut state = State::new(&house);
        let config = PhysicsConfig::default();
        let (mut world, _) =
            PhysicsWorld::new(house.clone(), config.clone(), &mut state).expect("it opens");
        let mut events = Vec::new();
        let mut step = |world: &mut PhysicsWorld, state: &mut State| {
            world.step(state, &[], &mut events).expect("it goes on");
        };
        step(&mut world, &mut state);
        let is_free = |(_, body): &(usize, &crate::body::BodyHandle)| {
            let rigid = world.dynamics.engine.bodies.get(body.handle);
            rigid.is_some_and(rapier3d::dynamics::RigidBody::is_dynamic)
        };
        let (place, body) = world
            .dynamics
            .bodies
            .iter()
            .enumerate()
            .find(is_free)
            .expect("things are free");
        let (part, handle) = (world.dynamics.model.bodies[place].root(), body.handle);
        let before = state.part_pose[part];
        let body = world
            .dynamics
            .engine
            .bodies
            .get_mut(handle)
            .expect("it is there");
        body.set_linvel(Vec3::NAN, true);
        step(&mut world, &mut state);
        let told: Vec<_> = world
            .delayed_outcomes()
            .iter()
            .map(|notice| notice.outcome.code)
            .collect();
        assert!(told.contains(&OutcomeCode::NonFiniteState), "{told:?}");
        let moved = state.part_pose[part].position - before.position;
        assert!(moved.length() < 0.01, "{moved}");
        assert!(
            world
                .dynamics
                .engine
                .bodies
                .iter()
                .all(|(_, body)| body.is_enabled())
        );
        let saved = (state.clone(), world.snapshot());
        let mut again = PhysicsWorld::new(house.clone(), config, &mut state.clone())
            .expect("it opens")
            .0;
        let mut other = saved.0;
        again.restore(&mut other, &saved.1).expect("it fits");
        for _ in 0..20 {
            for (world, state) in [(&mut world, &mut state), (&mut again, &mut other)] {
                step(world, state);
            }
            assert_eq!(world.hash(), again.hash());
        }
        assert!(world.delayed_outcomes().is_empty());
    }
}
