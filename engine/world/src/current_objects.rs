//! The agents and objects of a world as they are now.

use crate::world::World;
use dwell_scene::{Aabb, AgentId, AgentState, Id, ObjectId};
use serde::Serialize;
use std::collections::BTreeSet;

/// The agents as they are now: their bodies have the values in force, whatever set them.
pub fn effective_agents(world: &World) -> Vec<AgentState> {
    let state = world.state();
    let agents = state.agents.iter().enumerate();
    let now = agents.map(|(k, agent)| {
        let id = AgentId::from_index(k);
        let mut agent = *agent;
        agent.body.locomotion = state.locomotion(id);
        agent.body.camera_fov_deg = state.camera_fov_deg(id);
        agent
    });
    now.collect()
}

/// An object as it is now.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectState {
    /// The sensors' id.
    pub id: i32,
    /// The name.
    pub name: String,
    /// The coarse category.
    pub category: String,
    /// The middle of the box around it, m.
    pub center: [f32; 3],
    /// The edges of the box around it, m.
    pub size: [f32; 3],
    /// The room that holds its middle.
    pub room: Option<String>,
    /// True if a hand can take it, as far as shape and use say.
    pub pickable: bool,
    /// The agent that holds it.
    pub held_by: Option<u32>,
    /// True if it is switched on; `None` without a switch.
    pub on: Option<bool>,
    /// Openness, 0 to 1; `None` without a joint.
    pub openness: Option<f32>,
    /// The names of the objects that it rests on; `"building"` for floors and walls. Empty for what never moves.
    pub rests_on: Vec<String>,
    /// The names of the objects that it lies in; only for what a hand can take.
    pub lies_in: Vec<String>,
    /// True if it makes a sound of its own, such as a radio's, while it is switched on or has no switch.
    pub sounds: bool,
}

/// All objects as they are now.
pub fn object_states(world: &World) -> Vec<ObjectState> {
    let around = ObjectStateQueries::of(world);
    world
        .house()
        .objects
        .ids()
        .map(|id| around.object_state(id))
        .collect()
}

/// One object as it is now.
///
/// # Panics
/// For an object that does not exist.
pub fn object_state(world: &World, id: ObjectId) -> ObjectState {
    ObjectStateQueries::of(world).object_state(id)
}

/// Queries about all objects, answered once for all of them.
struct ObjectStateQueries<'a> {
    world: &'a World,
    /// Shape (object,).
    boxes: Vec<Aabb>,
    /// Shape (object,).
    carriers: Vec<Vec<Option<ObjectId>>>,
    sounding: BTreeSet<ObjectId>,
}

impl<'a> ObjectStateQueries<'a> {
    fn of(world: &'a World) -> Self {
        let (house, state) = (world.house(), world.state());
        Self {
            world,
            boxes: house.object_boxes(state),
            carriers: state.supports_of_all(house),
            sounding: house
                .emitters
                .iter()
                .map(|emitter| emitter.object)
                .collect(),
        }
    }

    fn object_state(&self, id: ObjectId) -> ObjectState {
        let (house, state) = (self.world.house(), self.world.state());
        let object = &house.objects[id];
        let bounds = &self.boxes[id.index()];
        let called = |id: ObjectId| house.objects[id].name.clone();
        let carriers = self.carriers[id.index()].iter();
        let rests_on = carriers.map(|by| by.map_or_else(|| "building".to_owned(), called));
        let lies_in = if object.pickable {
            state.containers_of(house, id, &self.boxes)
        } else {
            Vec::new()
        };
        ObjectState {
            id: house.entity_of_object(id).0,
            name: object.name.clone(),
            category: object.category.coarse.clone(),
            center: bounds.center().to_array(),
            size: bounds.size().to_array(),
            room: house
                .room_at(bounds.center())
                .map(|room| house.rooms[room].name.clone()),
            pickable: object.pickable,
            held_by: state.held_by[id].map(|agent| agent.0),
            on: object.switch.map(|_| state.switched_on[id]),
            openness: state.openness(house, id),
            rests_on: rests_on.collect(),
            lies_in: lies_in.into_iter().map(called).collect(),
            sounds: self.sounding.contains(&id),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use crate::engines::Engines;
    use std::sync::Arc;

    /// The state of one object is that among the states of all, and both are what the world's state says.
    #[test]
    fn one_object_is_told_as_all_are() {
        let (house, _) = dwell_houses::open("builtin:studio").unwrap();
        let engines = Engines::new(Arc::new(house));
        let world = World::new(engines, &WorldConfig::default()).unwrap();
        let (house, state) = (world.house(), world.state());
        let boxes = house.object_boxes(state);
        let all = object_states(&world);
        assert_eq!(all.len(), house.objects.len());
        for (id, now) in house.objects.ids().zip(&all) {
            assert_eq!(*now, object_state(&world, id));
            assert_eq!(now.rests_on.len(), state.supports_of(house, id).len());
            let around = house.objects.ids().filter(|container| {
                let outer = &boxes[container.index()];
                *container != id && house.encloses(state, *container, outer, &boxes[id.index()])
            });
            let names = around.map(|id| house.objects[id].name.clone());
            if now.pickable && now.held_by.is_none() {
                assert_eq!(now.lies_in, names.collect::<Vec<_>>(), "{}", now.name);
            }
        }
        assert!(all.iter().any(|now| !now.lies_in.is_empty()));
        assert!(all.iter().any(|now| now.rests_on == ["building"]));
    }
}
