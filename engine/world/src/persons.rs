//! Persons in a world: their strides, gestures and joints.

use crate::error::WorldError;
use crate::world::World;
use dwell_physics::ActionOutcome;
use dwell_scene::person::{PersonSkeleton, advance_persons, skeleton_of};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Gesture, Id, ReachGesture, ResolvedPersonColors, Side};

/// How long a hand stays at what it acted on, s.
const REACH_S: f32 = 0.6;

impl World {
    /// Draws the colours of persons that are not stated.
    pub(crate) fn draw_persons(&mut self, key: RandomKey) {
        let key = key.child("person");
        for (agent, person) in &mut self.state.persons {
            person.look =
                ResolvedPersonColors::draw(&person.body.colors, key.child(agent.index() as u64));
        }
    }

    /// Advances persons by the step that was made.
    pub(crate) fn advance_persons(&mut self) {
        let step_s = self.config.step_s() as f32;
        advance_persons(&mut self.state, &self.before.agents, step_s);
    }

    /// Shows where a person's hand has acted.
    pub(crate) fn show_reach(&mut self, agent: AgentId, outcome: &ActionOutcome) {
        if !outcome.success || !self.state.persons.contains_key(&agent) {
            return;
        }
        let house = self.engines.house();
        let from = skeleton_of(house, &self.state, agent).map(|joints| joints.head);
        let touched = outcome.object.zip(from).and_then(|(object, from)| {
            dwell_scene::person::grasp_point(house, &self.state, object, from)
        });
        if let (Some(point), Some(person)) = (touched, self.state.persons.get_mut(&agent)) {
            person.reach = Some(ReachGesture {
                point,
                left_s: REACH_S,
            });
        }
    }

    /// Sets what a person looks at and reaches for, at once and until it is set again.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist or is no person, and for points that are not finite or
    /// farther than 1 km from the origin.
    pub fn set_gesture(&mut self, agent: AgentId, gesture: Gesture) -> Result<(), WorldError> {
        self.check_person(agent)?;
        let wrong = gesture
            .named_points()
            .find(|(_, point)| !point.is_finite() || point.abs().max_element() > 1000.0);
        if let Some((name, point)) = wrong {
            let found = point.to_array();
            return Err(WorldError::InvalidCall(format!(
                "{name} of a gesture is {found:?}; allowed are finite coordinates of -1000 to 1000 m"
            )));
        }
        if let Some(person) = self.state.persons.get_mut(&agent) {
            person.gesture = gesture;
        }
        self.rays.update(&self.state);
        Ok(())
    }

    /// Returns what a person looks at and reaches for.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist or is no person.
    pub fn gesture(&self, agent: AgentId) -> Result<Gesture, WorldError> {
        self.check_person(agent)?;
        let person = self.state.persons.get(&agent);
        Ok(person.map_or_else(Gesture::default, |person| person.gesture))
    }

    /// Returns the joints of a person.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist or is no person.
    pub fn person_joints(&self, agent: AgentId) -> Result<PersonSkeleton, WorldError> {
        self.check_person(agent)?;
        skeleton_of(self.house(), &self.state, agent).ok_or_else(|| no_person(agent))
    }

    /// Returns the hand with which a person holds and reaches.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist or is no person.
    pub fn person_hand(&self, agent: AgentId) -> Result<Side, WorldError> {
        self.check_person(agent)?;
        let person = self.state.persons.get(&agent);
        Ok(person.map_or_else(Side::default, |person| person.body.hand))
    }

    fn check_person(&self, agent: AgentId) -> Result<(), WorldError> {
        let count = self.state.agents.len();
        if agent.index() >= count {
            return Err(WorldError::InvalidCall(format!(
                "no agent {}; there are {count}, counted from 0",
                agent.0
            )));
        }
        if self.state.persons.contains_key(&agent) {
            Ok(())
        } else {
            Err(no_person(agent))
        }
    }
}

fn no_person(agent: AgentId) -> WorldError {
    WorldError::InvalidCall(format!(
        "agent {} is no person: its body is a capsule; persons have a body of the kind \"person\"",
        agent.0
    ))
}
