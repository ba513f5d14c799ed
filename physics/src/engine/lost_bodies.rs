//! Bodies that rapier removes because their position or velocity is not finite.

use super::RapierWorld;
use glam::Vec3;
use rapier3d::dynamics::RigidBodyHandle;

impl RapierWorld {
    /// Restores a removed body, at rest at its position.
    pub(crate) fn restore_removed(&mut self, handle: RigidBodyHandle) {
        let Some(body) = self.bodies.get_mut(handle) else {
            return;
        };
        if !body.position().translation.is_finite() || !body.position().rotation.is_finite() {
            // It never had a finite position.
            return;
        }
        body.set_linvel(Vec3::ZERO, false);
        body.set_angvel(Vec3::ZERO, false);
        body.set_enabled(true);
        body.wake_up(true);
        for collider in body.colliders().to_vec() {
            if let Some(collider) = self.colliders.get_mut(collider) {
                collider.set_enabled(true);
            }
        }
        let attached = self.joints.attached_joints(handle);
        let joints: Vec<_> = attached.map(|(_, _, joint, _)| joint).collect();
        for joint in joints {
            if let Some(joint) = self.joints.get_mut(joint, true) {
                joint.impulses = Default::default();
            }
        }
    }
}
