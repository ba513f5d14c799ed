//! Viscous damping: in proportion to velocity.

use crate::error::PhysicsError;
use crate::joints::{ExternalWrench, LinkLaw, LinkState};
use crate::laws::target::moving_bodies;
use crate::laws::{BodyLaw, LawContext, LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State, math};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "viscous_damping",
        version: 1,
        name: "linear drag (viscous damping)",
        equation: "dv/dt = -linear_per_s v and dw/dt = -angular_per_s w, with v the velocity of the centre of mass (m/s) and \
                   w the spin (rad/s); whatever the mass",
        source: "G. G. Stokes, Trans. Cambridge Phil. Soc. 9 (1851): drag in proportion to speed at low Reynolds numbers; \
                 L. D. Landau, E. M. Lifshitz, Fluid Mechanics (1987), section 20",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[
            ParamInfo {
                name: "linear_per_s",
                unit: "1/s",
                default: 0.0,
                low: 0.0,
                high: 100.0,
                plausible: [0.0, 0.5],
            },
            ParamInfo {
                name: "angular_per_s",
                unit: "1/s",
                default: 0.0,
                low: 0.0,
                high: 100.0,
                plausible: [0.0, 0.5],
            },
        ],
        regimes: &[LawRegime::Flight, LawRegime::Sliding, LawRegime::Rolling],
        probes: &[&[("linear_per_s", 0.1), ("angular_per_s", 0.1)]],
        rivals: &["drag", "rolling_resistance", "torsional_friction"],
        separating_experiment: "let the object move freely at speeds that differ by a factor of three or more: linear drag \
                                takes the same share of the speed in each second, quadratic drag a share that grows with \
                                it; friction acts in contact only",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct ViscousDamping {
    bodies: Vec<u32>,
    linear_per_s: f32,
    angular_per_s: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let bodies = moving_bodies(values, model)?;
    let law = Arc::new(ViscousDamping {
        bodies: bodies.into_iter().map(|(index, _)| index).collect(),
        linear_per_s: values.get_f32("linear_per_s"),
        angular_per_s: values.get_f32("angular_per_s"),
    });
    Ok(vec![LawEffect::Body(law.clone()), LawEffect::Link(law)])
}

impl BodyLaw for ViscousDamping {
    fn apply_half_step(&self, stage: &mut LawContext<'_>, half_dt_s: f32) {
        let linear = math::exp(-self.linear_per_s * half_dt_s);
        let angular = math::exp(-self.angular_per_s * half_dt_s);
        for body in &self.bodies {
            if let Some(rigid) = stage.free_body_mut(*body) {
                rigid.set_linvel(rigid.linvel() * linear, false);
                rigid.set_angvel(rigid.angvel() * angular, false);
            }
        }
    }
}

impl LinkLaw for ViscousDamping {
    fn wrench(&self, link: &LinkState) -> ExternalWrench {
        if self.bodies.binary_search(&link.body).is_err() {
            return ExternalWrench::default();
        }
        let linear = link.mass_kg * link.decay_per_s(self.linear_per_s.into());
        ExternalWrench {
            force: -linear * link.velocity,
            torque: -link.decay_per_s(self.angular_per_s.into())
                * (link.inertia * link.angular_velocity),
        }
    }
}
