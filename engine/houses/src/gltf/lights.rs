//! `KHR_lights_punctual`, read: points and spots. The inverse of [`super::write`]'s lamps.
//!
//! # Source
//! Khronos, `KHR_lights_punctual` (glTF 2.0 Vendor Extensions): intensity of points and spots in cd, light along -Z of the node.

use std::f32::consts::{FRAC_PI_2, PI};

use ::gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Node, Root};
use dwell_scene::math::cos;
use glam::{Affine3A, Vec3};

use crate::import::ImportedLamp;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// lm of a lamp of 1 W, as [`dwell_scene::Light::power_w`] says.
pub(super) const LUMENS_PER_WATT: f32 = 100.0;
/// The narrowest cone, rad.
pub(super) const LEAST_CONE_RAD: f32 = 1e-3;
/// The strongest lamp, W.
const MOST_W: f32 = 1e5;

/// Properties of a lamp in our own files beside the extension's.
#[derive(Clone, Default)]
pub(super) struct LampExtras {
    pub(super) power_w: Option<f32>,
    pub(super) on: Option<bool>,
    pub(super) light_of: Option<String>,
    /// True for the sun of a sky.
    pub(super) sky: bool,
}

/// The light that a node carries, if it is of a kind that is read.
pub(super) fn light(
    json: &Root,
    node: &Node,
    world_from_node: Affine3A,
    said: LampExtras,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Option<ImportedLamp> {
    let index = (node
        .extensions
        .as_ref()?
        .khr_lights_punctual
        .as_ref()?
        .light)
        .value();
    let lights = json.extensions.as_ref()?.khr_lights_punctual.as_ref()?;
    let light = lights.lights.get(index)?;
    let cone = match light.type_ {
        Checked::Valid(Type::Point) => None,
        Checked::Valid(Type::Spot) => {
            let along = Vec3::from(world_from_node.matrix3 * glam::Vec3A::NEG_Z);
            let outer = (light.spot.as_ref()).map_or(PI / 4.0, |spot| spot.outer_cone_angle);
            let outer = if outer.is_finite() { outer } else { PI / 4.0 };
            Some((
                along.try_normalize()?,
                outer.clamp(LEAST_CONE_RAD, FRAC_PI_2),
            ))
        }
        _ => {
            if !said.sky {
                let what = "a directional light is not read; suns are, from extras.dwell.sky";
                report.warn(
                    at.clone(),
                    WarningKind::Simplified {
                        what: what.to_owned(),
                    },
                );
            }
            return None;
        }
    };
    let power_w = said
        .power_w
        .unwrap_or_else(|| power_w(light, cone.map(|cone| cone.1)));
    if !power_w.is_finite() || power_w < 0.0 || !light.color.iter().all(|c| c.is_finite()) {
        let what = "a light without a finite colour and intensity is not read".to_owned();
        report.warn(at.clone(), WarningKind::Simplified { what });
        return None;
    }
    Some(ImportedLamp {
        position: world_from_node.translation.into(),
        cone,
        color: light.color.map(|c| c.clamp(0.0, 1.0)),
        power_w: power_w.min(MOST_W),
        object_name: said.light_of,
        on: said.on.unwrap_or(true),
    })
}

/// Watts from candela over the sphere or the cone.
fn power_w(light: &Light, cutoff_rad: Option<f32>) -> f32 {
    let steradians = cutoff_rad.map_or(4.0 * PI, |half| 2.0 * PI * (1.0 - cos(half)));
    light.intensity * steradians / LUMENS_PER_WATT
}
