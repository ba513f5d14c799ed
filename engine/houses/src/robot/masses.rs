//! Links that are fixed to each other, their common mass, and principal axes.

use dwell_scene::{Inertial, Pose};
use glam::{DMat3, DQuat, DVec3};

use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

use super::model::{LinkInertia, Robot, RobotJoint, RobotJointKind};

/// Factor by which numbers of a few digits may violate the triangle inequality of moments.
const ROUNDING: f64 = 1.01;

/// The links of a robot that fixed joints connect.
pub(super) struct FixedJointTree<'a> {
    /// The fixed joints below each link. Shape (link,).
    below: Vec<Vec<&'a RobotJoint>>,
}

impl<'a> FixedJointTree<'a> {
    pub(super) fn new(robot: &'a Robot) -> Self {
        let mut below = vec![Vec::new(); robot.links.len()];
        for joint in &robot.joints {
            if joint.kind == RobotJointKind::Fixed {
                below[joint.parent].push(joint);
            }
        }
        Self { below }
    }

    /// The link `first` and all that is fixed to it, each with its pose on `first`.
    pub(super) fn rigid_group(&self, first: usize) -> Vec<(usize, Pose)> {
        let mut group = vec![(first, Pose::IDENTITY)];
        let mut next = 0;
        while let Some(&(link, first_from_link)) = group.get(next) {
            group.extend(self.below[link].iter().map(|joint| {
                let place =
                    first_from_link * joint.parent_from_joint * joint.child_from_joint.inverse();
                (joint.child, place)
            }));
            next += 1;
        }
        group
    }
}

/// The common mass of links, in the frame of the first; `None` when none has a mass.
pub(super) fn combined_inertia(robot: &Robot, group: &[(usize, Pose)]) -> Option<LinkInertia> {
    let placed: Vec<LinkInertia> = group
        .iter()
        .filter_map(|(link, place)| {
            let weight = robot.links[*link].inertial?;
            let turn = DMat3::from_quat(place.rotation.as_dquat().normalize());
            Some(LinkInertia {
                mass: weight.mass,
                center: place.position.as_dvec3() + turn * weight.center,
                inertia: turn * weight.inertia * turn.transpose(),
            })
        })
        .collect();
    LinkInertia::sum(&placed)
}

impl LinkInertia {
    /// Several masses as one; `None` for none.
    pub(crate) fn sum(lumps: &[Self]) -> Option<Self> {
        let mass: f64 = lumps.iter().map(|lump| lump.mass).sum();
        if lumps.is_empty() {
            return None;
        }
        let moment: DVec3 = lumps.iter().map(|lump| lump.center * lump.mass).sum();
        let center = moment / mass;
        let mut inertia = DMat3::ZERO;
        for lump in lumps {
            let d = lump.center - center;
            let outer = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            let steiner = DMat3::from_diagonal(DVec3::splat(d.length_squared())) - outer;
            inertia += lump.inertia + steiner * lump.mass;
        }
        Some(Self {
            mass,
            center,
            inertia,
        })
    }

    /// Reports moments that violate the triangle inequality by more than rounding: the largest is above the sum of the others.
    pub(crate) fn report_impossible(&self, at: &FileLocation, report: &mut LoadReport) {
        let (moments, _) = self.principal();
        let largest = moments.max_element();
        let others = moments.element_sum() - largest;
        if largest > ROUNDING * others {
            let [x, y, z] = moments.to_array();
            let what = format!(
                "no body has the moments of inertia {x:.3e}, {y:.3e} and {z:.3e} kg m²: the largest is above the sum of the \
                 others, which are raised"
            );
            report.warn(at.clone(), WarningKind::Simplified { what });
        }
    }

    /// The principal moments, and their axes as columns (Jacobi's rotations).
    fn principal(&self) -> (DVec3, DMat3) {
        let (mut m, mut axes) = (self.inertia, DMat3::IDENTITY);
        for _ in 0..24 {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let (app, aqq, apq) = (m.col(p)[p], m.col(q)[q], m.col(q)[p]);
                if apq == 0.0 {
                    continue;
                }
                let theta = 0.5 * libm_atan2(2.0 * apq, aqq - app);
                let axis = match (p, q) {
                    (0, 1) => DVec3::Z,
                    (0, 2) => DVec3::NEG_Y,
                    _ => DVec3::X,
                };
                let turn = DMat3::from_axis_angle(axis, -theta);
                m = turn.transpose() * m * turn;
                axes *= turn;
            }
        }
        let moments = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
        (moments.max(DVec3::splat(1e-12)), axes)
    }

    /// The principal axes and moments. Impossible moments, as rounded files hold, are moved to the nearest
    /// possible ones.
    pub(super) fn inertial(&self) -> Inertial {
        let (mut moments, axes) = self.principal();
        let largest = moments.max_element();
        let others = moments.element_sum() - largest;
        if largest > others {
            // Half of the excess goes to the smaller ones.
            let more = 0.5 * (largest - others);
            moments = DVec3::from_array(
                moments
                    .to_array()
                    .map(|value| if value < largest { value + more } else { value }),
            );
        }
        let rotation = DQuat::from_mat3(&axes).normalize();
        Inertial {
            part_from_principal: Pose::new(self.center.as_vec3(), rotation.as_quat()),
            moments: moments.as_vec3(),
        }
    }
}

/// The angle of a rotation in Jacobi's method; any answer leads to the same axes, so platform differences do not matter.
fn libm_atan2(y: f64, x: f64) -> f64 {
    f64::from(dwell_scene::math::atan2(y as f32, x as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_give_the_matrix_back() {
        let turn = DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0));
        let inertia = turn * DMat3::from_diagonal(DVec3::new(0.3, 0.2, 0.45)) * turn.transpose();
        let weight = LinkInertia {
            mass: 2.0,
            center: DVec3::X,
            inertia,
        };
        let found = weight.inertial();
        let axes = DMat3::from_quat(found.part_from_principal.rotation.as_dquat());
        let again = axes * DMat3::from_diagonal(found.moments.as_dvec3()) * axes.transpose();
        for k in 0..3 {
            let off = (again.col(k) - inertia.col(k)).length();
            assert!(off < 1e-6, "{again:?} {inertia:?}");
        }
        assert!(found.is_valid());
    }
}
