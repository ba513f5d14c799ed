//! Lamps and the sun as `KHR_lights_punctual`.
//!
//! # Source
//! Khronos, `KHR_lights_punctual` (glTF 2.0 Vendor Extensions): intensity in cd (of directional
//! lights in lx), attenuation by the inverse square of the
//! distance, light along -Z of its node. 1 W of a lamp counts as 100 lm, as [`Light::power_w`] says.

use std::f32::consts::{FRAC_PI_2, PI};

use dwell_scene::math::cos;
use dwell_scene::{HouseData, Light, LightShape, Sky};
use glam::{Quat, Vec3};
use serde_json::{Value, json};

use super::super::lights::{LEAST_CONE_RAD, LUMENS_PER_WATT};
use crate::export_loss::ExportLosses;

/// The name of the extension.
pub(super) const EXTENSION: &str = "KHR_lights_punctual";

/// A light of the file, and the node that carries it: in the world, as it stands at the start.
pub(super) struct LightWithNode {
    pub(super) light: Value,
    pub(super) node: Value,
}

/// The `index`-th light of the file.
pub(super) fn light(house: &HouseData, light: &Light, index: usize) -> LightWithNode {
    let object = &house.objects[light.object];
    let part = &house.parts[light.part];
    let lumens = light.power_w * LUMENS_PER_WATT;
    let mut at = part.world_from_part.transform_point(light.position);
    let mut turn = Quat::IDENTITY;
    let mut value = json!({"name": object.name, "color": light.color, "type": "point"});
    let candela = match light.shape {
        LightShape::Point => lumens / (4.0 * PI),
        LightShape::Line { end } => {
            at = (at + part.world_from_part.transform_point(end)) / 2.0;
            lumens / (4.0 * PI)
        }
        LightShape::Spot {
            direction,
            cutoff_rad,
            ..
        } => {
            let outer = cutoff_rad.clamp(LEAST_CONE_RAD, FRAC_PI_2);
            let along = part.world_from_part.transform_vector(direction);
            turn = Quat::from_rotation_arc(Vec3::NEG_Z, along.normalize_or(Vec3::NEG_Z));
            value["type"] = json!("spot");
            value["spot"] = json!({"innerConeAngle": 0.0, "outerConeAngle": outer});
            lumens / (2.0 * PI * (1.0 - cos(outer)))
        }
    };
    let shines = object.switch != Some(false);
    value["intensity"] = json!(if shines { candela } else { 0.0 });
    let node = json!({
        "name": format!("{}.light", object.name),
        "translation": at.to_array(),
        "rotation": turn.to_array(),
        "extensions": {EXTENSION: {"light": index}},
        "extras": {"dwell": {
            "light_of": object.name, "power_w": light.power_w, "on": shines,
            "light": {
                "part": part.name, "position": light.position, "shape": light.shape, "color": light.color,
                "power_w": light.power_w, "attenuation": light.attenuation,
            },
        }},
    });
    LightWithNode { light: value, node }
}

/// The sun: a directional light along -Z of its node, its intensity in lx. All of the sky stands in the node's extras.
pub(super) fn sun(sky: &Sky, index: usize) -> LightWithNode {
    let rgb = Vec3::from_array(sky.sun_lx);
    let most = rgb.max_element();
    let color = if most > 0.0 { rgb / most } else { Vec3::ONE };
    let turn = Quat::from_rotation_arc(Vec3::NEG_Z, -sky.to_sun);
    LightWithNode {
        light: json!({
            "name": "sun", "type": "directional", "color": color.to_array(), "intensity": most,
        }),
        node: json!({
            "name": "sun",
            "rotation": turn.normalize().to_array(),
            "extensions": {EXTENSION: {"light": index}},
            "extras": {"dwell": {"sky": sky}},
        }),
    }
}

/// Adds what the extension cannot say of lights; extras say it.
pub(super) fn add_light_losses(house: &HouseData, losses: &mut ExportLosses) {
    let count = |is: fn(&Light) -> bool| house.lights.iter().filter(|light| is(light)).count();
    losses.add(
        "glowing lines; they shine from their middles",
        count(|light| matches!(light.shape, LightShape::Line { .. })),
    );
    losses.add(
        "how spots fade towards the edge of their cones",
        count(|light| matches!(light.shape, LightShape::Spot { .. })),
    );
    losses.add(
        "attenuation of light other than by the square of the distance",
        count(|light| light.attenuation != [0.0, 0.0, 1.0]),
    );
    losses.add(
        "light of the sky; the sun shines, the sky is listed in extras",
        usize::from(house.sky.is_some()),
    );
}
