//! The contacts of a physics step: solution, correction of rebounds, and events.

use crate::articulation::WorldJoints;
use crate::contact::{
    BodyMotion, ContactCollector, ContactEvent, ContactHooks, ContactReport, ContactTracker,
    ExcessEventTotals, RestitutionContext, RestitutionResult, merge_excess, record_motion,
};
use crate::dynamics::Dynamics;
use crate::joints::JointKinematics;
use rapier3d::dynamics::RigidBodyHandle;

/// Contact data kept from step to step.
#[derive(Clone, Default)]
pub(crate) struct ContactPipeline {
    pub(crate) tracker: ContactTracker,
    /// The events of the last control step that were merged instead of reported one by one.
    pub(crate) merged_events: ExcessEventTotals,
    /// The motion of each body before the physics step.
    motion: Vec<BodyMotion>,
}

/// The effects of contacts in a physics step.
pub(crate) struct SolvedContacts {
    /// Bodies in free flight that hit something.
    landed: Vec<RigidBodyHandle>,
    reports: Vec<ContactReport>,
}

impl ContactPipeline {
    /// Runs rapier's physics step.
    pub(crate) fn solve(&mut self, dynamics: &mut Dynamics) -> SolvedContacts {
        let flying = dynamics.engine.bodies_in_free_flight();
        record_motion(&dynamics.engine, &self.tracker, &flying, &mut self.motion);
        let kept = dynamics.engine.friction_storage();
        let hooks = ContactHooks {
            entries: &dynamics.entries,
            properties: dynamics
                .laws
                .contact_properties(&dynamics.model.house, &dynamics.table),
            excluded: &dynamics.collision_exclusions,
            friction_storage: kept,
            dt_s: dynamics.settings.dt_s,
        };
        let config = &dynamics.settings.config;
        let slowest = config.event_min_speed_m_s.min(config.slide_min_speed_m_s);
        let collector = ContactCollector::new(&dynamics.entries, &self.motion, slowest, kept);
        let landed = dynamics.engine.step(flying, &hooks, &collector);
        let reports = collector.reports();
        SolvedContacts { landed, reports }
    }

    /// Corrects the rebounds of bodies that hit something in free flight. `joints_before`: each joint's coordinates before the step.
    pub(crate) fn correct_restitution(
        &self,
        dynamics: &mut Dynamics,
        articulation: &mut WorldJoints,
        solved: &SolvedContacts,
        joints_before: &[JointKinematics],
    ) -> RestitutionResult {
        let context = RestitutionContext {
            motions: &self.motion,
            entries: &dynamics.entries,
            trees: &articulation.trees,
            joints: &articulation.joints,
            joints_before,
            dt_s: dynamics.settings.dt_s,
        };
        let coordinates = &mut articulation.joint_coordinates;
        context.correct(&mut dynamics.engine, &solved.landed, coordinates)
    }

    /// Records the contacts of a physics step; events that ended or are immediate go to `events`.
    pub(crate) fn record_contacts(
        &mut self,
        dynamics: &Dynamics,
        solved: SolvedContacts,
        rebounds: &RestitutionResult,
        events: &mut Vec<ContactEvent>,
    ) {
        let (tick, settings) = (dynamics.tick, &dynamics.settings);
        self.tracker.add_reports(
            (solved.reports, &rebounds.added_impulses),
            tick,
            &settings.config,
            &dynamics.table,
            events,
        );
        self.tracker
            .record_ccd_lost_displacements(&dynamics.engine, &self.motion, settings.dt_s);
    }

    /// Emits the remaining events of a control step; `first`: the index of its first event.
    pub(crate) fn emit_remaining_events(
        &mut self,
        dynamics: &Dynamics,
        events: &mut Vec<ContactEvent>,
        first: usize,
    ) {
        let config = &dynamics.settings.config;
        self.tracker
            .emit_events(dynamics.tick, config, &dynamics.table, events);
        self.merged_events = merge_excess(events, first, config.max_events_per_step);
    }
}
