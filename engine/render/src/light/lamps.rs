//! Lamps as point sources.

use super::room_grid::RoomGrid;
use dwell_scene::{House, Light, LightShape, State, math};
use glam::Vec3;
use std::f32::consts::PI;

/// Luminous flux of a lamp of one watt, lm: SUNCG's watts are those of efficient lamps.
pub(crate) const LUMEN_PER_WATT: f32 = 100.0;

/// Distance below which a lamp shines as at this distance, m: it has a size in truth.
const NEAREST_M: f32 = 0.05;

/// Parts of a glowing line, as fractions of its length: midpoints of equal quarters.
const LINE_PARTS: [f32; 4] = [0.125, 0.375, 0.625, 0.875];

/// A lamp that is on, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointLamp {
    pub(crate) position: Vec3,
    /// From there to its ends, m: a piece of a glowing line has a length.
    pub(super) half_length: Vec3,
    /// Intensity along the axis, cd, for red, green and blue.
    pub(super) intensity: Vec3,
    /// The cone, if it is a spot: axis, cosine of the half angle, exponent.
    pub(super) cone: Option<(Vec3, f32, f32)>,
    pub(super) attenuation: [f32; 3],
    /// The thing that it belongs to; light passes that thing's surfaces (shades).
    pub(crate) entity: i32,
    /// Position of its room.
    pub(crate) room: Option<usize>,
    /// Position among those that cast shadows, see [`super::lamp_clusters`]; or [`super::lamp_clusters::NONE`].
    pub(crate) cluster: u32,
    /// Luminous flux, lm, for red, green and blue.
    pub(crate) flux_lm: Vec3,
}

impl PointLamp {
    /// Illuminance on a surface that faces along `normal` (unit length), lx, for red, green and blue: I cos / (c + l d +
    /// q d²), which is the inverse square law for SUNCG's usual attenuation (0, 0, 1).
    #[inline]
    pub(crate) fn illuminance(&self, point: Vec3, normal: Vec3, entity: i32) -> Vec3 {
        let way = self.position - point;
        let distance = way.length().max(NEAREST_M);
        let direction = way / distance;
        let cosine = normal.dot(direction);
        let cosine = if entity == self.entity {
            cosine.abs()
        } else {
            cosine
        };
        if cosine <= 0.0 {
            return Vec3::ZERO;
        }
        let mut part = 1.0;
        if let Some((axis, cutoff, exponent)) = self.cone {
            let turn = -axis.dot(direction);
            if turn < cutoff {
                return Vec3::ZERO;
            }
            if exponent > 0.0 {
                part = math::pow(turn.max(0.0), exponent);
            }
        }
        let [constant, linear, quadratic] = self.attenuation;
        let weakening = constant + distance * (linear + distance * quadratic);
        self.intensity * (part * cosine / weakening.max(NEAREST_M * NEAREST_M))
    }
}

/// Appends the lamps of a light in this state: none while it is off, four for a line.
pub(crate) fn add_lamps(
    house: &House,
    state: &State,
    grid: &RoomGrid,
    light: &Light,
    lamps: &mut Vec<PointLamp>,
) {
    if !state.is_on(house, light.object) || light.power_w <= 0.0 {
        return;
    }
    let world_from_part = state.part_pose[light.part];
    let flux_lm = Vec3::from_array(light.color) * (light.power_w * LUMEN_PER_WATT);
    let attenuation = if light.attenuation.iter().sum::<f32>() > 0.0 {
        light.attenuation
    } else {
        [0.0, 0.0, 1.0]
    };
    let lamp = |point_in_part: Vec3, share: f32, intensity: Vec3, cone| {
        let position = world_from_part.transform_point(point_in_part);
        PointLamp {
            position,
            half_length: Vec3::ZERO,
            intensity: intensity * share,
            cone,
            attenuation,
            entity: house.entity_of_object(light.object).0,
            room: grid.room_at(position),
            cluster: super::lamp_clusters::NONE,
            flux_lm: flux_lm * share,
        }
    };
    match light.shape {
        LightShape::Point => lamps.push(lamp(light.position, 1.0, flux_lm / (4.0 * PI), None)),
        LightShape::Spot {
            direction,
            cutoff_rad,
            dropoff_rate,
        } => {
            let axis = world_from_part
                .transform_vector(direction)
                .normalize_or(Vec3::NEG_Y);
            let (cutoff, exponent) = (math::cos(cutoff_rad.clamp(0.01, PI)), dropoff_rate.max(0.0));
            // The integral of cos^n over the cone; beyond 90 degrees an exponent has no meaning and counts as 0.
            let exponent = if cutoff < 0.0 { 0.0 } else { exponent };
            let rest = if exponent > 0.0 {
                math::pow(cutoff, exponent + 1.0)
            } else {
                cutoff
            };
            let solid_angle = 2.0 * PI * (1.0 - rest) / (exponent + 1.0);
            lamps.push(lamp(
                light.position,
                1.0,
                flux_lm / solid_angle.max(1e-3),
                Some((axis, cutoff, exponent)),
            ));
        }
        LightShape::Line { end } => {
            let share = 1.0 / LINE_PARTS.len() as f32;
            let half = world_from_part.transform_vector(end - light.position) * (0.5 * share);
            for part in LINE_PARTS {
                let at = light.position.lerp(end, part);
                lamps.push(PointLamp {
                    half_length: half,
                    ..lamp(at, share, flux_lm / (4.0 * PI), None)
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{
        Category, HouseData, Level, LevelId, Mesh, Mobility, Object, ObjectId, Part, PartId, Pose,
    };
    use std::sync::Arc;

    /// The lamps of a light of 7 W at the origin.
    fn lamps(shape: LightShape) -> Vec<PointLamp> {
        let mut data = HouseData::default();
        data.levels.push(Level {
            name: "0".into(),
            bounds: dwell_scene::Aabb::EMPTY,
        });
        let mesh = data
            .meshes
            .push(Arc::new(Mesh::cuboid(Vec3::ZERO, Vec3::ONE)));
        let substance = dwell_scene::material::library().get_or_default("plaster");
        let material = data
            .materials
            .push(dwell_scene::Material::from_substance("m", substance));
        data.objects.push(Object {
            name: "lamp".into(),
            source_id: String::new(),
            model: "lamp".into(),
            category: Category::default(),
            level: LevelId(0),
            room: None,
            mobility: Mobility::Movable,
            pickable: false,
            switch: None,
            first_part: PartId(0),
            part_count: 1,
        });
        data.parts.push(Part {
            object: ObjectId(0),
            name: "root".into(),
            fixed: false,
            world_from_part: Pose::IDENTITY,
            mesh,
            part_from_mesh: glam::Affine3A::IDENTITY,
            materials: vec![material],
            colliders: Vec::new(),
            mass_kg: None,
            density_kg_m3: 500.0,
            inertial: None,
        });
        let light = Light {
            object: ObjectId(0),
            part: PartId(0),
            position: Vec3::ZERO,
            shape,
            color: [1.0, 0.5, 0.0],
            power_w: 7.0,
            attenuation: [0.0, 0.0, 1.0],
        };
        data.lights.push(light.clone());
        let house = House::new(data).unwrap();
        let mut lamps = Vec::new();
        add_lamps(
            &house,
            &State::new(&house),
            &RoomGrid::new(&house),
            &light,
            &mut lamps,
        );
        lamps
    }

    #[test]
    fn illuminance_is_intensity_times_cosine_over_distance_squared() {
        let [lamp] = lamps(LightShape::Point)[..] else {
            panic!("one lamp")
        };
        let point = Vec3::new(1.0, -2.0, 0.5);
        let found = lamp.illuminance(point, Vec3::Y, 99);
        let expected = 700.0 / (4.0 * PI) * (2.0 / 5.25_f32.sqrt()) / 5.25;
        assert!((found - Vec3::new(expected, 0.5 * expected, 0.0)).length() < 1e-4 * expected);
        assert_eq!(lamp.illuminance(point, Vec3::NEG_Y, 99), Vec3::ZERO);
        // Its own shade shines from behind.
        assert!((lamp.illuminance(point, Vec3::NEG_Y, 1) - found).length() < 1e-6);
    }

    /// The illuminance of a sphere around the lamp, integrated over even points (spiral), is the flux.
    #[test]
    fn every_lamp_sends_out_its_flux() {
        let spot = |cutoff_rad: f32, dropoff_rate: f32| LightShape::Spot {
            direction: Vec3::NEG_Y,
            cutoff_rad,
            dropoff_rate,
        };
        let line = LightShape::Line { end: Vec3::X * 0.4 };
        for shape in [
            LightShape::Point,
            spot(0.7, 0.0),
            spot(1.2, 5.0),
            spot(2.0, 0.0),
            line,
        ] {
            let (count, radius) = (20_000, 50.0_f32);
            let all = lamps(shape);
            let mut sum = 0.0;
            for k in 0..count {
                let y = 1.0 - (2.0 * k as f32 + 1.0) / count as f32;
                let ring = (1.0 - y * y).sqrt();
                let (sin, cos) = (k as f32 * 2.399_963_2).sin_cos();
                let out = Vec3::new(ring * cos, y, ring * sin);
                for lamp in &all {
                    sum += lamp.illuminance(out * radius, -out, 99).x;
                }
            }
            let flux = sum / count as f32 * 4.0 * PI * radius * radius;
            assert!((flux - 700.0).abs() < 0.01 * 700.0, "{shape:?}: {flux}");
        }
    }
}
