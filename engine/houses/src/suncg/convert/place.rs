//! Axes, scale and transforms.

use dwell_scene::Aabb;
use glam::{Affine3A, DMat4, DVec3, Mat3A, Vec3};

use super::super::file::{SuncgBounds, SuncgHouse};
use crate::error::HousesError;
use crate::report::FileLocation;

/// Scale and axes of the file against the world (+Y up, front +Z, metres).
pub(super) fn world_from_file(
    house: &SuncgHouse,
    at: &FileLocation,
) -> Result<Affine3A, HousesError> {
    let scale = house.scale_to_meters.unwrap_or(1.0);
    if !(1e-6..=1e6).contains(&scale) {
        let (at, expected) = (at.field("scaleToMeters"), "a number from 1e-6 to 1e6");
        return Err(HousesError::Field {
            at,
            expected,
            found: scale.to_string(),
        });
    }
    let direction = |field: &'static str, given: &Option<Vec<f64>>, usual: DVec3| {
        let Some(given) = given else { return Ok(usual) };
        let vector = if let [x, y, z] = given[..] {
            DVec3::new(x, y, z)
        } else {
            DVec3::ZERO
        };
        let (at, expected) = (at.field(field), "a direction of three numbers");
        vector.try_normalize().ok_or_else(|| HousesError::Field {
            at,
            expected,
            found: format!("{given:?}"),
        })
    };
    let up = direction("up", &house.up, DVec3::Y)?;
    let front = direction("front", &house.front, DVec3::Z)?;
    if up.dot(front).abs() > 1e-3 {
        let (at, expected) = (at.field("front"), "a direction at right angles to up");
        return Err(HousesError::Field {
            at,
            expected,
            found: format!("{:?}", front.to_array()),
        });
    }
    // Rows of the rotation are the file's directions of the world's axes.
    let right = up.cross(front);
    let rotation = Mat3A::from_cols(right.as_vec3a(), up.as_vec3a(), front.as_vec3a()).transpose();
    Ok(Affine3A {
        matrix3: rotation * scale as f32,
        translation: glam::Vec3A::ZERO,
    })
}

/// A node's transform: 16 numbers, column by column.
///
/// # Errors
/// A sentence when it places nothing.
pub(super) fn transform(numbers: Option<&[f64]>) -> Result<DMat4, String> {
    let numbers = numbers.ok_or("missing")?;
    let numbers: &[f64; 16] = numbers
        .try_into()
        .map_err(|_| format!("{} numbers, expected 16", numbers.len()))?;
    if let Some(i) = numbers.iter().position(|x| !x.is_finite()) {
        return Err(format!("number {i} is not finite"));
    }
    let matrix = DMat4::from_cols_array(numbers);
    let last = matrix.row(3);
    if (last - glam::DVec4::W).abs().max_element() > 1e-6 {
        return Err(format!(
            "numbers 3, 7, 11, 15 are {:?}, expected [0, 0, 0, 1]",
            last.to_array()
        ));
    }
    if matrix.determinant().abs() < 1e-9 {
        return Err("it flattens space".to_owned());
    }
    if matrix.w_axis.truncate().abs().max_element() > 30_000.0 {
        return Err("it lies farther than 30 km from the origin".to_owned());
    }
    Ok(matrix)
}

/// Scale and mirror without the rounding of the rotation that was removed from them: instances of a model that differ by a
/// turn alone have the same bits.
pub(super) fn snap_to_integers(mut rest: Affine3A) -> Affine3A {
    let snap = |x: f32| {
        if (x - x.round()).abs() < 4e-6 {
            x.round()
        } else {
            x
        }
    };
    for column in [
        &mut rest.matrix3.x_axis,
        &mut rest.matrix3.y_axis,
        &mut rest.matrix3.z_axis,
    ] {
        *column = glam::Vec3A::new(snap(column.x), snap(column.y), snap(column.z));
    }
    rest
}

/// A box of the file in the world; `None` when it is not one.
pub(super) fn bounds(file: Option<&SuncgBounds>, world_from_file: &Affine3A) -> Option<Aabb> {
    let corner = |numbers: &Option<Vec<f64>>| match numbers.as_deref() {
        Some(&[x, y, z]) => Some(Vec3::new(x as f32, y as f32, z as f32)).filter(|p| p.is_finite()),
        _ => None,
    };
    let (min, max) = (corner(&file?.min)?, corner(&file?.max)?);
    min.cmple(max)
        .all()
        .then(|| Aabb { min, max }.transformed(world_from_file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_are_read_column_by_column() {
        let numbers = [
            0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 41.0, 0.5, 40.0, 1.0,
        ];
        let matrix = transform(Some(&numbers)).unwrap();
        assert_eq!(
            matrix.transform_point3(DVec3::X),
            DVec3::new(41.0, 0.5, 39.0)
        );
    }

    #[test]
    fn useless_transforms_say_why() {
        let mut numbers = DMat4::IDENTITY.to_cols_array();
        assert_eq!(transform(None).unwrap_err(), "missing");
        assert_eq!(
            transform(Some(&numbers[..15])).unwrap_err(),
            "15 numbers, expected 16"
        );
        numbers[5] = 0.0;
        assert_eq!(transform(Some(&numbers)).unwrap_err(), "it flattens space");
        numbers[5] = f64::NAN;
        assert_eq!(
            transform(Some(&numbers)).unwrap_err(),
            "number 5 is not finite"
        );
        // Row by row, the translation stands where the last row belongs.
        let row_major = [
            1.0, 0.0, 0.0, 41.0, 0.0, 1.0, 0.0, 0.5, 0.0, 0.0, 1.0, 40.0, 0.0, 0.0, 0.0, 1.0,
        ];
        assert_eq!(
            transform(Some(&row_major)).unwrap_err(),
            "numbers 3, 7, 11, 15 are [41.0, 0.5, 40.0, 1.0], expected [0, 0, 0, 1]"
        );
    }

    #[test]
    fn z_up_files_are_turned_upright() {
        let house = SuncgHouse {
            up: Some(vec![0.0, 0.0, 1.0]),
            front: Some(vec![0.0, -1.0, 0.0]),
            scale_to_meters: Some(0.01),
            ..SuncgHouse::default()
        };
        let map = world_from_file(&house, &FileLocation::file("house.json")).unwrap();
        // HoME's (x, -z, y) form, in centimetres: (42, -39, 1) m there is (42, 1, 39) m here.
        assert!(
            map.transform_point3(Vec3::new(4200.0, -3900.0, 100.0))
                .abs_diff_eq(Vec3::new(42.0, 1.0, 39.0), 1e-4)
        );
    }
}
