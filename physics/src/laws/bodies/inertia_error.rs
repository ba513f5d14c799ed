//! Error of a body's inertia tensor.

use crate::error::PhysicsError;
use crate::inertia::{BodyInertia, MassLaw};
use crate::laws::target::moving_bodies;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use glam::{Mat3, Vec3};
use std::sync::Arc;

const fn moment(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "1",
        default: 0.0,
        low: -0.5,
        high: 2.0,
        plausible: [-0.2, 0.3],
    }
}

const fn product(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "1",
        default: 0.0,
        low: -0.3,
        high: 0.3,
        plausible: [-0.05, 0.05],
    }
}

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "inertia_error",
        version: 1,
        name: "error of the inertia",
        equation: "I_ij = s_i s_j (J_ij + p_ij sqrt(J_ii J_jj)) with s_i = sqrt((1 + scale) (1 + i)), J the inertia about \
                   the centre of mass from shape and density (kg m2), i one of x, y, z and p_ij one of xy, yz, zx, in the \
                   frame of each body's first part; p_ii = 0, the mass stays",
        source: "L. D. Landau, E. M. Lifshitz, Mechanics (1976), section 32",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[
            moment("scale"),
            moment("x"),
            moment("y"),
            moment("z"),
            product("xy"),
            product("yz"),
            product("zx"),
        ],
        regimes: &[LawRegime::Flight, LawRegime::Impact],
        probes: &[&[("x", 0.1), ("y", 0.1), ("z", 0.1)]],
        rivals: &["mass", "center_of_mass_offset", "collision_shape"],
        separating_experiment: "spin the object freely about three axes for the ratios of its moments (the scale cannot be \
                                seen without a force), and let it hit the floor with a corner, or add a known mass, for \
                                the scale",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct InertiaError {
    bodies: Vec<u32>,
    /// `s` of the equation.
    scale: Vec3,
    /// `p` for xy, yz, zx.
    products: Vec3,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let of = |names: [&str; 3]| Vec3::from_array(names.map(|name| values.get_f32(name)));
    let all = 1.0 + values.get_f32("scale");
    let plans = moving_bodies(values, model)?;
    let law = InertiaError {
        bodies: plans.iter().map(|(index, _)| *index).collect(),
        scale: ((Vec3::ONE + of(["x", "y", "z"])) * all).map(f32::sqrt),
        products: of(["xy", "yz", "zx"]),
    };
    for (index, plan) in plans {
        let mut inertia = BodyInertia::of(&model.house, plan, state, &vec![1.0; plan.parts.len()]);
        // A link without mass of its own has no inertia to change.
        if !inertia.is_positive() {
            continue;
        }
        law.modify_mass_properties(index, &mut inertia);
        if !inertia.is_positive() {
            return Err(PhysicsError::Range {
                at: format!(
                    "law {}, object {:?}",
                    values.info.id, model.house.objects[plan.object].name
                ),
                field: "xy, yz, zx",
                found: law.products.to_string(),
                allowed: "products that leave the inertia positive definite",
            });
        }
    }
    Ok(vec![LawEffect::Mass(Arc::new(law))])
}

impl MassLaw for InertiaError {
    fn modify_mass_properties(&self, body: u32, inertia: &mut BodyInertia) {
        if self.bodies.binary_search(&body).is_err() {
            return;
        }
        let own = inertia.tensor;
        let root = Vec3::new(own.x_axis.x, own.y_axis.y, own.z_axis.z).map(f32::sqrt);
        let [xy, yz, zx] = self.products.to_array();
        let wrong = Mat3::from_cols(
            Vec3::new(0.0, xy, zx),
            Vec3::new(xy, 0.0, yz),
            Vec3::new(zx, yz, 0.0),
        );
        let scaled =
            |by: Vec3, tensor: Mat3| Mat3::from_diagonal(by) * tensor * Mat3::from_diagonal(by);
        inertia.tensor = scaled(self.scale, own + scaled(root, wrong));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_changes_its_entry() {
        let law = InertiaError {
            bodies: vec![3],
            scale: Vec3::new(1.5, 1.2, 0.9).map(f32::sqrt),
            products: Vec3::new(0.1, -0.2, 0.05),
        };
        let own = BodyInertia {
            mass_kg: 2.0,
            center: Vec3::X,
            tensor: Mat3::from_diagonal(Vec3::new(1.0, 4.0, 9.0)),
            gravity_scale: 1.0,
        };
        let mut found = own;
        law.modify_mass_properties(2, &mut found);
        assert_eq!(found, own);
        law.modify_mass_properties(3, &mut found);
        let (xy, yz) = (0.1 * 2.0 * 1.8_f32.sqrt(), -0.2 * 6.0 * 1.08_f32.sqrt());
        let zx = 0.05 * 3.0 * 1.35_f32.sqrt();
        let expected = Mat3::from_cols(
            Vec3::new(1.5, xy, zx),
            Vec3::new(xy, 4.8, yz),
            Vec3::new(zx, yz, 8.1),
        );
        assert!(found.tensor.abs_diff_eq(expected, 1e-5), "{}", found.tensor);
        assert!(found.is_positive());
        assert_eq!((found.mass_kg, found.center), (2.0, Vec3::X));
    }
}
