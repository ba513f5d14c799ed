//! Lamps' lights and things that sound.

use dwell_scene::{Light, LightShape, ObjectId, Part, PartId, SoundEmitter, units};
use glam::Vec3;

use super::super::metadata::LightFile;
use super::Converter;
use crate::damage::Damage;
use crate::report::At;

/// A lamp's cone narrower than this is a mistake, rad.
const LEAST_CUTOFF_RAD: f32 = 0.01;

impl Converter<'_> {
    /// The lights of a model on a part; returns whether it has any.
    pub(super) fn lights(
        &mut self,
        model: &str,
        object: ObjectId,
        part_id: PartId,
        at: &At,
    ) -> bool {
        let lights = self.files.lights.get(model);
        let part = &self.data.parts[part_id];
        let made: Vec<Light> = lights
            .iter()
            .filter_map(|light| convert_light(light, object, part_id, part))
            .collect();
        if made.len() < lights.len() {
            let damage = Damage::BadRow {
                reason: format!("a light of model {model:?} has no usable place, power or kind"),
            };
            self.report
                .warn_times(at.clone(), damage, (lights.len() - made.len()) as u64);
        }
        self.data.lights.extend(made);
        !lights.is_empty()
    }

    /// What a model sounds like; returns whether it sounds at all.
    pub(super) fn sounds(
        &mut self,
        model: &str,
        categories: &[&str],
        object: ObjectId,
        part_id: PartId,
    ) -> bool {
        let part = &self.data.parts[part_id];
        let mesh = &self.data.meshes[part.mesh];
        let position = part.part_from_mesh.transform_point3(mesh.bounds().center());
        let before = self.data.emitters.len();
        for (event, recording) in self.files.sounds.of(model, categories) {
            // One event is what is heard while the thing is on; rings and calls have no start in the table.
            let _ = event;
            let signal = signal_of(recording);
            let level_db = level_db(&signal);
            self.data.emitters.push(SoundEmitter {
                object,
                part: part_id,
                position,
                signal,
                level_db,
            });
        }
        self.data.emitters.len() > before
    }
}

fn convert_light(
    light: &LightFile,
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

/// The signal that stands for a recording: SUNCG names recordings and ships none.
fn signal_of(recording: &str) -> String {
    let stem = recording.rsplit('/').next().unwrap_or(recording);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    match stem {
        "tv" => "television",
        "music" => "radio",
        stem => stem,
    }
    .to_owned()
}

/// Level at 1 m, dB SPL: estimates of ours for household sounds.
fn level_db(signal: &str) -> f32 {
    match signal {
        "vacuum_cleaner" => 75.0,
        "car_beep" => 90.0,
        "alarm_clock" | "doorbell" | "dog" => 72.0,
        "kitchen_exhaust" => 60.0,
        "dishwasher" | "air_conditioner" => 48.0,
        "water_drop" => 40.0,
        _ => 62.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_name_signals() {
        assert_eq!(
            (signal_of("tv.wav"), signal_of("sounds/dishwasher.wav")),
            ("television".into(), "dishwasher".into())
        );
    }
}
