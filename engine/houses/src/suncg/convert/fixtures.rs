//! Lights of lamps, and sounds.

use dwell_scene::{Light, LightShape, ObjectId, Part, PartId, SoundEmitter, units};
use glam::Vec3;

use super::super::metadata::SuncgLight;
use super::Converter;
use crate::report::FileLocation;
use crate::warning_kind::WarningKind;

/// Smallest cone of a lamp that is no mistake, rad.
const LEAST_CUTOFF_RAD: f32 = 0.01;

impl Converter<'_> {
    /// Adds the lights of a model to a part; returns whether it has any.
    pub(super) fn add_lights(
        &mut self,
        model: &str,
        object: ObjectId,
        part_id: PartId,
        at: &FileLocation,
    ) -> bool {
        let lights = self.files.lights.get(model);
        let part = &self.data.parts[part_id];
        let made: Vec<Light> = lights
            .iter()
            .filter_map(|light| convert_light(light, object, part_id, part))
            .collect();
        if made.len() < lights.len() {
            let damage = WarningKind::BadRow {
                reason: format!("a light of model {model:?} has no usable place, power or kind"),
            };
            self.report
                .warn_times(at.clone(), damage, (lights.len() - made.len()) as u64);
        }
        self.data.lights.extend(made);
        !lights.is_empty()
    }

    /// Adds the sounds of a model while it is on; returns whether there are any.
    ///
    /// Sounds of a moment (a ring, a bark) have no start in the tables and are reported as left out.
    pub(super) fn sounds(
        &mut self,
        model: &str,
        categories: &[&str],
        object: ObjectId,
        part_id: PartId,
        at: &FileLocation,
    ) -> bool {
        let part = &self.data.parts[part_id];
        let mesh = &self.data.meshes[part.mesh];
        let position = part.part_from_mesh.transform_point3(mesh.bounds().center());
        let before = self.data.emitters.len();
        for (event, recording) in self.files.sounds.sounds_of_model(model, categories) {
            let Some((signal, level_db)) =
                substitute_signal(recording).filter(|_| is_continuous_event(event))
            else {
                let what =
                    format!("the sound {recording:?} of {event:?} has no lasting signal; left out");
                self.report
                    .warn(at.clone(), WarningKind::Simplified { what });
                continue;
            };
            let emitter = SoundEmitter::looping(object, part_id, position, signal, level_db);
            self.data.emitters.push(emitter);
        }
        self.data.emitters.len() > before
    }
}

fn convert_light(
    light: &SuncgLight,
    object: ObjectId,
    part_id: PartId,
    part: &Part,
) -> Option<Light> {
    let vector = |v: [f64; 3]| Some(Vec3::from(v.map(|x| x as f32))).filter(|v| v.is_finite());
    let map = part.part_from_mesh;
    let position = map.transform_point3(vector(light.position)?);
    let direction = || {
        map.transform_vector3(vector(light.direction?)?)
            .try_normalize()
    };
    let shape = match light.kind.as_str() {
        "PointLight" => LightShape::Point,
        "SpotLight" => LightShape::Spot {
            direction: direction()?,
            cutoff_rad: (light.cutoff_angle.unwrap_or(std::f64::consts::FRAC_PI_2) as f32)
                .clamp(LEAST_CUTOFF_RAD, std::f32::consts::PI),
            dropoff_rate: (light.dropoff_rate.unwrap_or(1.0) as f32).clamp(0.0, 128.0),
        },
        "LineLight" => LightShape::Line {
            end: map.transform_point3(vector(light.position2?)?),
        },
        _ => return None,
    };
    let color = u32::from_str_radix(light.color.strip_prefix('#').unwrap_or("ffffff"), 16)
        .unwrap_or(0x00ff_ffff);
    let color =
        [16, 8, 0].map(|shift| units::linear_from_srgb((color >> shift & 255) as f32 / 255.0));
    let power_w = light.power as f32;
    let attenuation = light.attenuation.map(|x| x as f32);
    let usable =
        (0.0..=1e5).contains(&power_w) && attenuation.iter().all(|x| x.is_finite() && *x >= 0.0);
    usable.then_some(Light {
        object,
        part: part_id,
        position,
        shape,
        color,
        power_w,
        attenuation,
    })
}

/// Returns whether an event lasts while a thing is on: `on`, `on_2`, and SUNCG's own words for it.
fn is_continuous_event(event: &str) -> bool {
    event.starts_with("on") || ["music", "exhaust", "drop"].contains(&event)
}

/// The signal that stands for a recording, which SUNCG names and does not ship, and its level at 1 m, dB SPL; the nearest
/// one where ours has other machines. Levels are estimates of ours. Other names are signals already.
fn substitute_signal(recording: &str) -> Option<(&str, f32)> {
    let stem = recording.rsplit('/').next().unwrap_or(recording);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    Some(match stem {
        "tv" | "television" => ("television", 62.0),
        "music" | "radio" => ("radio", 65.0),
        "dishwasher" => ("washing_machine", 48.0),
        "vacuum_cleaner" => ("fan", 75.0),
        "air_conditioner" => ("fan", 45.0),
        "kitchen_exhaust" => ("fan", 60.0),
        "water_drop" => ("tap", 50.0),
        "car_beep" | "alarm_clock" | "doorbell" | "cat" | "dog" | "" => return None,
        stem => (stem, 60.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_name_signals() {
        assert_eq!(substitute_signal("tv.wav"), Some(("television", 62.0)));
        assert_eq!(
            substitute_signal("sounds/dishwasher.wav").map(|s| s.0),
            Some("washing_machine")
        );
        assert_eq!(substitute_signal("kettle.wav").map(|s| s.0), Some("kettle"));
        assert_eq!(
            (substitute_signal("dog.wav"), substitute_signal(".wav")),
            (None, None)
        );
        assert!(
            is_continuous_event("on")
                && is_continuous_event("on_2")
                && !is_continuous_event("doorbell")
        );
    }
}
