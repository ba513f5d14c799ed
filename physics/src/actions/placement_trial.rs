//! Trial simulation of a placement: whether the object stays there.

use super::ActionContext;
use crate::contact::ContactHooks;
use crate::engine::RapierWorld;
use dwell_scene::math;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::Aabb;
use rapier3d::math::Pose as RapierPose;
use rapier3d::pipeline::QueryFilter;

/// Duration of a trial, and of the rest required at its end, s.
const TRIAL_S: f32 = 1.0;
const REST_S: f32 = 0.25;
/// Largest displacement and rotation during that rest, m and rad.
const REST_SHIFT_M: f32 = 5e-4;
const REST_TURN_RAD: f32 = 5e-3;
/// Largest displacement and rotation since the object was put down, m and rad.
const MAX_SHIFT_M: f32 = 0.01;
const MAX_TURN_RAD: f32 = 0.1;
/// Distance within which other objects take part, m.
const NEAR_M: f32 = 0.05;

fn moved(a: &RapierPose, b: &RapierPose, most_m: f32, most_rad: f32) -> bool {
    let turn = 2.0 * math::acos((a.rotation.inverse() * b.rotation).w.abs());
    (a.translation - b.translation).length() > most_m || turn > most_rad
}

impl ActionContext<'_> {
    /// Returns the pose at which a body put under a pose comes to rest, simulated by the same solver among near objects,
    /// which are fixed meanwhile; `None` when it slides, topples or rolls away.
    pub(super) fn simulated_rest_pose(&self, body: usize, pose: &RapierPose) -> Option<RapierPose> {
        let plan = &self.dynamics.model.bodies[body];
        let near = plan.bounds(pose).grown(NEAR_M);
        let mut trial = RapierWorld::new(
            &self.dynamics.settings,
            self.dynamics.engine.gravity.length(),
        );
        let ground = trial.bodies.insert(RigidBodyBuilder::fixed());
        let queries = self.dynamics.engine.queries(QueryFilter::default());
        let mut around: Vec<_> = queries
            .intersect_aabb_conservative(Aabb::new(near.min, near.max))
            .map(|(_, collider)| collider)
            .filter(|collider| {
                let entry = self.dynamics.entry_of(collider);
                entry.agent().is_none() && entry.body != Some(body as u32)
            })
            .filter(|collider| {
                let bounds = collider.compute_aabb();
                near.intersects(&dwell_scene::Aabb::new(bounds.mins, bounds.maxs))
            })
            .collect();
        around.sort_by_key(|collider| collider.user_data);
        for collider in around {
            let mut copy = collider.clone();
            copy.set_position_wrt_parent(*collider.position());
            trial
                .colliders
                .insert_with_parent(copy, ground, &mut trial.bodies);
        }
        let builder = RigidBodyBuilder::dynamic().pose(*pose).can_sleep(false);
        let handle = trial.bodies.insert(builder);
        for own in crate::body::colliders(&self.dynamics.engine, &self.dynamics.bodies[body]) {
            let collider = self.dynamics.engine.colliders.get(*own)?;
            let mut copy = collider.clone();
            if let Some(place) = collider.position_wrt_parent() {
                copy.set_position_wrt_parent(*place);
            }
            trial
                .colliders
                .insert_with_parent(copy, handle, &mut trial.bodies);
        }
        let hooks = ContactHooks {
            entries: &self.dynamics.entries,
            properties: self
                .dynamics
                .laws
                .contact_properties(&self.dynamics.model.house, &self.dynamics.table),
            excluded: &self.dynamics.collision_exclusions,
            friction_storage: self.dynamics.engine.friction_storage(),
            dt_s: self.dynamics.settings.dt_s,
        };
        let steps = (TRIAL_S / self.dynamics.settings.dt_s).ceil() as u32;
        let last = (REST_S / self.dynamics.settings.dt_s).ceil() as u32;
        let mut resting = *pose;
        for step in 0..steps {
            if step + last == steps {
                resting = *trial.bodies.get(handle)?.position();
                if moved(pose, &resting, MAX_SHIFT_M, MAX_TURN_RAD) {
                    return None;
                }
            }
            let flying = trial.bodies_in_free_flight();
            trial.step(flying, &hooks, &());
        }
        let end = *trial.bodies.get(handle)?.position();
        let rests = !moved(&resting, &end, REST_SHIFT_M, REST_TURN_RAD)
            && !moved(pose, &end, MAX_SHIFT_M, MAX_TURN_RAD)
            && crate::convert::from_rapier(&end).is_valid();
        rests.then_some(end)
    }
}
