//! Mass, centre of mass and inertia of a body.

use crate::model::{BodyDefinition, PhysicsModel};
use dwell_scene::{House, State};
use glam::{Mat3, Vec3};
use rapier3d::dynamics::MassProperties;
use std::fmt::Debug;
use std::sync::Arc;

/// Mass, centre of mass and inertia of a body, in the body's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodyInertia {
    pub(crate) mass_kg: f32,
    /// The centre of mass, m.
    pub(crate) center: Vec3,
    /// About the centre of mass, kg·m².
    pub(crate) tensor: Mat3,
    /// Ratio of weight to mass times gravity.
    pub(crate) gravity_scale: f32,
}

impl BodyInertia {
    /// Returns the inertia of a body's pieces and stated parts in a world, with each part's density times its factor. Shape
    /// of `factors`: (part,).
    pub(crate) fn of(house: &House, plan: &BodyDefinition, state: &State, factors: &[f32]) -> Self {
        let given = plan.explicit_mass_properties(house, state, factors);
        let mut all = given.unwrap_or_default();
        for piece in &plan.pieces {
            let factor = plan.mass_factor_of(piece, factors);
            let own = piece.shape.mass_properties(piece.density_kg_m3 * factor);
            all += own.transform_by(&piece.pose);
        }
        Self {
            mass_kg: all.mass(),
            center: all.local_com,
            tensor: all.reconstruct_inertia_matrix(),
            gravity_scale: 1.0,
        }
    }

    /// Returns whether the tensor is symmetric and positive definite.
    pub(crate) fn is_positive(&self) -> bool {
        // Sylvester's criterion: all leading principal minors are positive.
        let t = self.tensor;
        let minor = t.x_axis.x * t.y_axis.y - t.x_axis.y * t.y_axis.x;
        t.is_finite() && t.x_axis.x > 0.0 && minor > 0.0 && t.determinant() > 0.0
    }

    /// In rapier's form.
    pub(crate) fn properties(&self) -> MassProperties {
        MassProperties::with_inertia_matrix(self.center, self.mass_kg, self.tensor)
    }
}

/// A law that changes mass properties.
pub(crate) trait MassLaw: Debug + Send + Sync {
    /// Changes mass, centre of mass or inertia of a body, once when laws or masses change.
    fn modify_mass_properties(&self, body: u32, inertia: &mut BodyInertia);
}

/// Returns the inertia of each body whose parts state it or that a law changes; the colliders of such a body have no
/// density. Shape (body,).
pub(crate) fn explicit_inertias(
    model: &PhysicsModel,
    state: &State,
    factors: &[Vec<f32>],
    laws: &[Arc<dyn MassLaw>],
) -> Vec<Option<BodyInertia>> {
    let bodies = model.bodies.iter().zip(factors).enumerate();
    bodies
        .map(|(index, (plan, factor))| {
            if laws.is_empty() && !plan.has_explicit_inertia {
                return None;
            }
            let own = BodyInertia::of(&model.house, plan, state, factor);
            let mut changed = own;
            for law in laws {
                law.modify_mass_properties(index as u32, &mut changed);
            }
            (changed != own || plan.has_explicit_inertia).then_some(changed)
        })
        .collect()
}
