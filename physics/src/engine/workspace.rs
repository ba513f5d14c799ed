//! Working memory of the solver for one world: new memory leads to the same steps. Two worlds may not share it, since
//! rapier keeps lists of its world's fixed colliders and joints there.

use rapier3d::dynamics::{CCDSolver, MultibodyJointSet, SoftBodySet};
use rapier3d::pipeline::PhysicsPipeline;

/// Number of bodies whose memory is not worth releasing.
const FEW_BODIES: usize = 4;
/// Steps with less than a quarter of the memory in use before it is released.
const PATIENCE_STEPS: u32 = 32;

/// The parts of rapier that need not be kept between steps. A copy makes them anew.
pub(crate) struct Workspace {
    pub(crate) pipeline: PhysicsPipeline,
    pub(crate) ccd: CCDSolver,
    pub(crate) multibodies: MultibodyJointSet,
    pub(crate) soft_bodies: SoftBodySet,
    /// The most awake bodies since the pipeline was made.
    most: usize,
    /// Steps since more than a quarter of that were.
    quiet_steps: u32,
}

impl Workspace {
    pub(crate) fn new() -> Self {
        Self {
            pipeline: PhysicsPipeline::new(),
            ccd: CCDSolver::new(),
            multibodies: MultibodyJointSet::new(),
            soft_bodies: SoftBodySet::new(),
            most: 0,
            quiet_steps: 0,
        }
    }

    /// Releases memory that was needed when far more bodies were awake than now: rapier keeps that of its largest step.
    pub(crate) fn shrink_to_fit(&mut self, awake: usize) {
        self.most = self.most.max(awake);
        self.quiet_steps = if 4 * awake < self.most && self.most > FEW_BODIES {
            self.quiet_steps + 1
        } else {
            0
        };
        if self.quiet_steps >= PATIENCE_STEPS {
            *self = Self::new();
        }
    }
}

impl Clone for Workspace {
    fn clone(&self) -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{FEW_BODIES, PATIENCE_STEPS, Workspace};

    #[test]
    fn memory_of_a_crowd_is_given_back_after_a_long_quiet_only() {
        let mut workspace = Workspace::new();
        workspace.shrink_to_fit(10 * FEW_BODIES);
        for _ in 0..PATIENCE_STEPS - 1 {
            workspace.shrink_to_fit(FEW_BODIES);
        }
        assert_eq!(workspace.most, 10 * FEW_BODIES);
        workspace.shrink_to_fit(3 * FEW_BODIES);
        assert_eq!(workspace.quiet_steps, 0);
        for _ in 0..PATIENCE_STEPS {
            workspace.shrink_to_fit(FEW_BODIES);
        }
        assert_eq!((workspace.most, workspace.quiet_steps), (0, 0));
    }
}
