//! Poses of instances.

use dwell_scene::Pose;
use glam::{Affine3A, Mat3, Quat, Vec3};

use super::file::{ObjectInstance, Template};

/// Largest scale, and the inverse of the smallest: anything beyond is a mistake.
const MAX_SCALE: f32 = 1e4;

/// The pose that an instance states; `None` when it is not finite or its rotation is zero.
pub(super) fn pose(instance: &ObjectInstance) -> Option<Pose> {
    let [w, x, y, z] = instance.rotation;
    let rotation = Quat::from_xyzw(x, y, z, w);
    let length = rotation.length();
    let position = Vec3::from_array(instance.translation);
    if !(position.is_finite() && length > 1e-6 && length.is_finite()) {
        return None;
    }
    Some(Pose::new(position, rotation.normalize()))
}

/// The scale of an instance, along its own axes; `None` when it flattens space or is not finite.
pub(super) fn scale(instance: &ObjectInstance) -> Option<Vec3> {
    let scale = Vec3::from_array(instance.non_uniform_scale) * instance.uniform_scale;
    let usable = |s: f32| s.is_finite() && (1.0 / MAX_SCALE..=MAX_SCALE).contains(&s.abs());
    scale.to_array().into_iter().all(usable).then_some(scale)
}

/// The pose of an instance, its scale, and [`template_from_asset`].
///
/// # Errors
/// The field that is not usable, and what it holds.
pub(super) fn placement(
    instance: &ObjectInstance,
    template: &Template,
) -> Result<(Pose, Vec3, Affine3A), String> {
    let pose = pose(instance).ok_or_else(|| {
        let (to, turn) = (instance.translation, instance.rotation);
        format!("translation is {to:?} and rotation {turn:?}")
    })?;
    let scale = scale(instance).ok_or_else(|| {
        let (all, each) = (instance.uniform_scale, instance.non_uniform_scale);
        format!("uniform_scale is {all} and non_uniform_scale {each:?}")
    })?;
    let frame = template_from_asset(template).ok_or_else(|| {
        let (up, front) = (template.up, template.front);
        let (scale, units) = (template.scale, template.units_to_meters);
        format!("in its template up is {up:?}, front {front:?}, scale {scale:?} and units_to_meters {units}")
    })?;
    Ok((pose, scale, frame))
}

/// From an asset's own axes to the template's (+Y up, -Z front), with its scale; `None` when the template's directions are
/// none or its scale is not usable.
fn template_from_asset(template: &Template) -> Option<Affine3A> {
    let up = Vec3::from_array(template.up).try_normalize()?;
    let front = Vec3::from_array(template.front);
    let front = (front - up * front.dot(up)).try_normalize()?;
    // Rows: right becomes +X, up +Y, front -Z.
    let frame = Mat3::from_cols(front.cross(up), up, -front).transpose();
    let scale = Vec3::from_array(template.scale) * template.units_to_meters;
    let usable = |s: f32| s.is_finite() && (1.0 / MAX_SCALE..=MAX_SCALE).contains(&s.abs());
    let all = scale.to_array().into_iter().all(usable);
    all.then(|| Affine3A::from_mat3(Mat3::from_diagonal(scale) * frame))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_asset_with_z_up_and_y_in_front_stands_up() {
        let template = Template {
            up: [0.0, 0.0, 1.0],
            front: [0.0, 1.0, 0.0],
            units_to_meters: 2.0,
            ..Template::default()
        };
        let map = template_from_asset(&template).unwrap();
        let moved = |v: Vec3| map.transform_point3(v);
        assert_eq!(moved(Vec3::Z), Vec3::Y * 2.0);
        assert_eq!(moved(Vec3::Y), Vec3::NEG_Z * 2.0);
        assert_eq!(moved(Vec3::X), Vec3::X * 2.0);
        assert_eq!(
            template_from_asset(&Template::default()),
            Some(Affine3A::IDENTITY)
        );
        let flat = Template {
            up: [0.0; 3],
            ..Template::default()
        };
        assert_eq!(template_from_asset(&flat), None);
    }
}
