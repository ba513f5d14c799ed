//! The route of an episode: which milestones the agent has passed, and where the expert goes next.

use super::drawn_route::DrawnRoute;
use crate::actions::{DiscreteAction, StepSizes};
use crate::error::WorldError;
use crate::tasks::navigation::{ELSEWHERE_M, Leg, NavigationGoal};
use crate::world::World;
use dwell_scene::AgentId;
use dwell_scene::navigation::NavGrid;
use dwell_semantics::instruct::{
    ConditionContext, DynamicTimeWarping, RouteInstruction, RouteTracker, StepCondition,
};
use std::sync::Arc;

/// Distance behind the place where a step is done to which one walks for it, as places of the way: two of 0.1 m.
const FURTHER: usize = 2;
/// Distance of the cell nearest to a place of the way, m.
const NEAR_M: f32 = 0.5;
/// How often the expert goes back for a step that it missed.
const RETURNS: u32 = 2;
/// Smallest distance between the places of the way that a path is compared with, m.
const LEAST_SPACING_M: f32 = 0.1;

/// The place to walk to for a step.
#[derive(Clone, Debug)]
struct StepPlace {
    goal: Arc<NavigationGoal>,
    /// The way from there to the end, m.
    later_m: f64,
}

/// The route of the episode that is played.
#[derive(Debug)]
pub(super) struct ActiveRoute {
    agent: AgentId,
    walk: RouteTracker,
    warp: DynamicTimeWarping,
    end: StepCondition,
    places: Vec<StepPlace>,
    /// The way to the first step that is not done, and its number.
    leg: Leg,
    leg_step: usize,
    /// The expert's way, and the step that it goes to: those before it are done, or it has been at their places.
    expert_leg: Leg,
    expert_step: usize,
    /// The start of the way, to which it goes back for a first step that was missed.
    start: Arc<NavigationGoal>,
    /// True while it goes back to where a missed step begins, and how often it has.
    goes_back: bool,
    returns: u32,
}

impl ActiveRoute {
    /// Begins before the first step. `None` where a place of the route is off the grid.
    pub(super) fn new(
        drawn: &DrawnRoute,
        (agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes),
    ) -> Option<Self> {
        let DrawnRoute {
            route, end, goal, ..
        } = drawn;
        let places = step_places(route, goal, grid)?;
        let start = NavigationGoal::at_cell("", grid, drawn.start, 0.0);
        let leg = Leg::new(agent, grid.clone(), places[0].goal.clone(), stride);
        Some(Self {
            agent,
            walk: route.walk(),
            warp: DynamicTimeWarping::new(&route.way, stride.forward_m.max(LEAST_SPACING_M)),
            end: *end,
            places,
            expert_leg: leg.clone(),
            expert_step: 0,
            leg,
            leg_step: 0,
            start: Arc::new(start),
            goes_back: false,
            returns: 0,
        })
    }

    fn is_at_end(&self, world: &World) -> bool {
        let scene = world.engines().semantics().scene(world.state());
        self.end.holds(&ConditionContext {
            scene: &scene,
            rays: world.rays(),
            agent: self.agent,
            pointed_at: None,
        })
    }

    /// Goes on to where the agent is; returns how many steps became done.
    pub(super) fn advance(&mut self, world: &World) -> usize {
        let Some(agent) = world.state().agents.get(self.agent) else {
            return 0;
        };
        let before = self.walk.passed_count();
        let scene = world.engines().semantics().scene(world.state());
        let place = [agent.position, agent.eye_position()];
        let is_at_end = self.is_at_end(world);
        self.walk.advance((&scene, world.rays()), place, is_at_end);
        self.warp.add(agent.position);
        let done = self.walk.passed_count();
        self.lead_on();
        done - before
    }

    /// Leads to the first step that is not done.
    fn lead_on(&mut self) {
        let step = self.walk.passed_count().min(self.places.len() - 1);
        if step != self.leg_step {
            self.leg = self.leg.with_goal(self.places[step].goal.clone());
            self.leg_step = step;
        }
    }

    /// The walkable way that is left, by the places of all steps that are not done, m.
    pub(super) fn distance_m(&self, world: &World) -> Option<f64> {
        let left_m = self.leg.guide.distance_m(world)?;
        Some(left_m + self.places[self.leg_step].later_m)
    }

    /// Returns whether all steps are done and the agent is where it is to stop.
    pub(super) fn is_fulfilled(&self, world: &World) -> bool {
        self.walk.passed_count() == self.places.len() && self.is_at_end(world)
    }

    /// The share of the steps that are done, 0 to 1; the last counts where the agent is at the end now.
    pub(super) fn condition_success(&self, world: &World) -> f64 {
        let all = self.places.len();
        let mut done = self.walk.passed_count();
        if done == all && !self.is_at_end(world) {
            done -= 1;
        }
        done as f64 / all as f64
    }

    /// How closely the path so far keeps to the way, nDTW, 0 to 1.
    pub(super) fn ndtw(&self) -> f64 {
        self.warp.ndtw()
    }

    /// The action of the expert: to the place of each step in order, then to the end; back to where a step begins that it missed.
    pub(super) fn expert_action(&mut self, world: &World) -> DiscreteAction {
        let last = self.places.len() - 1;
        if self.is_fulfilled(world) {
            return DiscreteAction::Stop;
        }
        let next = self.walk.passed_count().min(last);
        if self.goes_back {
            if let Some(action) = self.expert_leg.walk(world) {
                return action;
            }
            self.goes_back = false;
            self.expert_leg = self.expert_leg.with_goal(self.places[next].goal.clone());
            self.expert_step = next;
        }
        self.lead_expert(next);
        while self.expert_step < last {
            if let Some(action) = self.expert_leg.walk(world) {
                return action;
            }
            self.lead_expert(self.expert_step + 1);
        }
        if let Some(action) = self.expert_leg.approach(world) {
            return action;
        }
        if next < last && self.returns < RETURNS {
            let before = next.checked_sub(1).map(|step| &self.places[step].goal);
            let back = before.unwrap_or(&self.start).clone();
            self.expert_leg = self.expert_leg.with_goal(back);
            (self.goes_back, self.returns) = (true, self.returns + 1);
            return DiscreteAction::Wait;
        }
        if self.expert_leg.exclude_goals_within(world, ELSEWHERE_M) {
            return DiscreteAction::Wait;
        }
        DiscreteAction::Stop
    }

    /// Leads the expert on to a step, never back.
    fn lead_expert(&mut self, step: usize) {
        if step > self.expert_step {
            self.expert_leg = self.expert_leg.with_goal(self.places[step].goal.clone());
            self.expert_step = step;
        }
    }

    /// What it keeps beside the world: the progress of the walk, and of its comparison with the way.
    pub(super) fn snapshot(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.walk.progress(), self.warp.progress()))
            .expect("plain data can always be written to memory")
    }

    /// Takes over what a snapshot keeps.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] for bytes that are none of this route.
    pub(super) fn restore(&mut self, bytes: &[u8]) -> Result<(), WorldError> {
        let fault = |what: &str| WorldError::Snapshot(format!("the progress of its route {what}"));
        let (walk, warp) = postcard::from_bytes(bytes)
            .map_err(|error| fault(&format!("is unreadable: {error}")))?;
        if !self.walk.restore(walk) || !self.warp.restore(warp) {
            return Err(fault("is that of another one"));
        }
        self.lead_on();
        self.expert_leg = self.leg.clone();
        (self.expert_step, self.goes_back, self.returns) = (self.leg_step, false, 0);
        Ok(())
    }
}

/// The places to walk to for the steps of a route: a little behind where each is done, and the end.
fn step_places(
    route: &RouteInstruction,
    end: &Arc<NavigationGoal>,
    grid: &NavGrid,
) -> Option<Vec<StepPlace>> {
    let (last, before) = route.steps.split_last()?;
    let mut at_m = Vec::with_capacity(route.way.len());
    let mut walked_m = 0.0;
    for (k, place) in route.way.iter().enumerate() {
        walked_m += f64::from(place.distance(route.way[k.saturating_sub(1)]));
        at_m.push(walked_m);
    }
    let mut places = Vec::new();
    for step in before {
        let done = at_m.partition_point(|at_m| *at_m < step.way_m);
        let at = (done + FURTHER).min(route.way.len() - 1);
        let cell = grid.nearest(route.way[at], NEAR_M)?;
        places.push(StepPlace {
            goal: Arc::new(NavigationGoal::at_cell("", grid, cell, 0.0)),
            later_m: last.way_m - at_m[at],
        });
    }
    places.push(StepPlace {
        goal: end.clone(),
        later_m: 0.0,
    });
    Some(places)
}
