//! The lidar: distances along rays around an agent's body.

use super::{
    Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_scene::bvh::{PacketHits, RayMask, RayPacket};
use dwell_scene::random::RandomKey;
use dwell_scene::space::Pose;
use dwell_scene::{AgentState, interrupt, math};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ABOUT: &str = "Distances along rays around the body, m; what is nearer reads min_range_m, what is further, and nothing at all, max_range_m. \
                     Rings from the lowest to the highest. The beams of a ring go counter-clockwise as those of a ROS LaserScan: the first at -fov_deg / 2 from \
                     ahead, the next fov_deg / (beams - 1) further to the left, or fov_deg / beams where they go all round; shape (rings, beams).";

/// Most rays.
const MOST_RAYS: u64 = 1 << 18;
/// Rays that are traced together.
const PACKET: usize = 16;

pub(super) const KIND: SensorKind = SensorKind {
    name: "lidar",
    about: ABOUT,
    build,
    settings: schema::fields_of::<LidarConfig>,
    image: None,
    goal_part: None,
};

/// The settings of a lidar. Its own agent's body is not in its way; what the agent holds is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct LidarConfig {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
    /// Which agent's body; by default that of the one whom the environment is about.
    agent: Option<u32>,
    /// Beams of a ring, 1 to 65,536, default 360; a single one points to the middle of the field.
    beams: u32,
    /// The field of a ring, degrees, above 0 to 360; default 360: all round, from straight behind.
    fov_deg: f32,
    /// Number of rings, 1 to 256, default 1; at most 262,144 rays together.
    rings: u32,
    /// Angle of the lowest ring above the horizontal, degrees, -90 to 90; default -15. A single ring is half way to the highest.
    lowest_deg: f32,
    /// Angle of the highest ring above the horizontal, degrees, `lowest_deg` to 90; default 15.
    highest_deg: f32,
    /// The angle of each ring above the horizontal, degrees, -90 to 90, in place of `rings`, `lowest_deg` and `highest_deg`; 1 to 256 of
    /// them, the rows of the observation in this order.
    elevations_deg: Option<Vec<f32>>,
    /// Nearest distance that it measures, m; above 0, default 0.05.
    min_range_m: f32,
    /// Furthest distance that it measures, m; above `min_range_m`, at most 1,000, default 10.
    max_range_m: f32,
    /// Position relative to the point between the agent's feet: to the right, up, back, m; -10 to 10 each, default 0.5 m above it.
    position_m: [f32; 3],
    /// Its own turn relative to the body, degrees to the left, -360 to 360; default 0.
    yaw_deg: f32,
    /// Standard deviation of the error of a distance within its range, m, 0 to 10; default 0. Drawn anew in each step, by the
    /// episode's seed and the sensor's name.
    noise_m: f32,
}

impl Default for LidarConfig {
    fn default() -> Self {
        Self {
            name: None,
            agent: None,
            beams: 360,
            fov_deg: 360.0,
            rings: 1,
            lowest_deg: -15.0,
            highest_deg: 15.0,
            elevations_deg: None,
            min_range_m: 0.05,
            max_range_m: 10.0,
            position_m: [0.0, 0.5, 0.0],
            yaw_deg: 0.0,
            noise_m: 0.0,
        }
    }
}

impl LidarConfig {
    /// Checks every range.
    fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: &str| {
            Err(WorldError::Config {
                field,
                found,
                allowed: allowed.to_owned(),
            })
        };
        if !(1..=65_536).contains(&self.beams) {
            return fault("beams", self.beams.to_string(), "1 to 65536");
        }
        if !(self.fov_deg > 0.0 && self.fov_deg <= 360.0) {
            let allowed = "above 0, at most 360 degrees";
            return fault("fov_deg", self.fov_deg.to_string(), allowed);
        }
        if !(1..=256).contains(&self.rings) {
            return fault("rings", self.rings.to_string(), "1 to 256");
        }
        if !(-90.0..=90.0).contains(&self.lowest_deg) {
            let allowed = "-90 to 90 degrees";
            return fault("lowest_deg", self.lowest_deg.to_string(), allowed);
        }
        if !(self.lowest_deg..=90.0).contains(&self.highest_deg) {
            let allowed = format!("lowest_deg, {}, to 90 degrees", self.lowest_deg);
            return fault("highest_deg", self.highest_deg.to_string(), &allowed);
        }
        if let Some(angles) = &self.elevations_deg {
            let fits = (1..=256).contains(&angles.len())
                && angles.iter().all(|angle| (-90.0..=90.0).contains(angle));
            if !fits {
                let allowed = "1 to 256 angles of -90 to 90 degrees";
                return fault("elevations_deg", format!("{angles:?}"), allowed);
            }
            let without = Self::default();
            let own = (self.rings, self.lowest_deg, self.highest_deg);
            if own != (without.rings, without.lowest_deg, without.highest_deg) {
                let found = "beside rings, lowest_deg or highest_deg".to_owned();
                return fault("elevations_deg", found, "either the angles or their range");
            }
        }
        let rings = self
            .elevations_deg
            .as_ref()
            .map_or(u64::from(self.rings), |all| all.len() as u64);
        let rays = rings * u64::from(self.beams);
        if rays > MOST_RAYS {
            let allowed = format!("at most {MOST_RAYS} rays in all rings together");
            return fault(
                "beams",
                format!("{} in {rings} rings", self.beams),
                &allowed,
            );
        }
        if !(self.min_range_m > 0.0 && self.min_range_m < 1000.0) {
            let allowed = "above 0, below 1000 m";
            return fault("min_range_m", self.min_range_m.to_string(), allowed);
        }
        if !(self.max_range_m > self.min_range_m && self.max_range_m <= 1000.0) {
            let allowed = format!("above min_range_m, {}, at most 1000 m", self.min_range_m);
            return fault("max_range_m", self.max_range_m.to_string(), &allowed);
        }
        if !self.position_m.iter().all(|part| part.abs() <= 10.0) {
            let allowed = "-10 to 10 m along each axis";
            return fault("position_m", format!("{:?}", self.position_m), allowed);
        }
        if !(-360.0..=360.0).contains(&self.yaw_deg) {
            let allowed = "-360 to 360 degrees";
            return fault("yaw_deg", self.yaw_deg.to_string(), allowed);
        }
        if !(0.0..=10.0).contains(&self.noise_m) {
            return fault("noise_m", self.noise_m.to_string(), "0 to 10 m");
        }
        Ok(())
    }

    /// Returns the angle of each beam from ahead, rad to the left. Shape (beam,).
    fn beam_angles_rad(&self) -> Vec<f32> {
        let beams = self.beams as usize;
        let gaps = if self.fov_deg < 360.0 {
            beams - 1
        } else {
            beams
        };
        let angle = |k: usize| match (beams, gaps) {
            (1, _) => 0.0,
            (_, gaps) => self.fov_deg * (k as f32 / gaps as f32 - 0.5),
        };
        (0..beams).map(|k| angle(k).to_radians()).collect()
    }

    /// Returns the angle of each ring above the horizontal, rad. Shape (ring,).
    fn elevations_rad(&self) -> Vec<f32> {
        if let Some(angles) = &self.elevations_deg {
            return angles.iter().map(|angle| angle.to_radians()).collect();
        }
        let (low, high) = (self.lowest_deg, self.highest_deg);
        let share = |k: u32| match self.rings {
            1 => 0.5,
            rings => k as f32 / (rings - 1) as f32,
        };
        (0..self.rings)
            .map(|k| (low + (high - low) * share(k)).to_radians())
            .collect()
    }
}

#[derive(Debug)]
struct LidarSensor {
    body: ObservedAgent,
    config: LidarConfig,
    /// Shape (beam,).
    beams_rad: Vec<f32>,
    /// Sine and cosine. Shape (ring,).
    rings: Vec<(f32, f32)>,
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: LidarConfig = parse_sensor_settings(value)?;
    config.check()?;
    let rings = config.elevations_rad().into_iter().map(math::sin_cos);
    Ok(Box::new(LidarSensor {
        body: ObservedAgent {
            name: super::key(KIND.name, config.name.clone())?,
            agent: setup.agent(config.agent)?,
        },
        beams_rad: config.beam_angles_rad(),
        rings: rings.collect(),
        config,
    }))
}

impl LidarSensor {
    /// Measures without errors; infinite where nothing is hit within range.
    fn measure(&self, world: &World, agent: &AgentState, out: &mut [f32]) {
        let world_from_agent = Pose::from_position_yaw(agent.position, agent.yaw_rad);
        let origin = world_from_agent.transform_point(Vec3::from_array(self.config.position_m));
        let ahead_rad = agent.yaw_rad + self.config.yaw_deg.to_radians();
        let hidden = world.house().entity_of_agent(self.body.agent);
        let mask = RayMask::EYE.union(RayMask::BODY);
        let directions: Vec<(f32, f32)> = self
            .beams_rad
            .iter()
            .map(|left_rad| math::sin_cos(ahead_rad + left_rad))
            .collect();
        for ((up, level), row) in self
            .rings
            .iter()
            .zip(out.chunks_exact_mut(directions.len()))
        {
            interrupt::unwind_if_cancelled();
            for (beams, ranges) in directions.chunks(PACKET).zip(row.chunks_mut(PACKET)) {
                let mut rays = RayPacket::<PACKET>::new(origin);
                for (k, (sine, cosine)) in beams.iter().enumerate() {
                    let direction = Vec3::new(-sine * level, *up, -cosine * level);
                    rays.set(k, direction, 0.0, self.config.max_range_m);
                }
                let mut hits = PacketHits::new();
                world.rays().closest_packet(&rays, mask, hidden, &mut hits);
                ranges.copy_from_slice(&hits.distance_m[..ranges.len()]);
            }
        }
    }

    /// Adds the errors of what was measured, and keeps all within the range.
    fn finish(&self, key: RandomKey, ranges: &mut [f32]) {
        let LidarConfig {
            min_range_m,
            max_range_m,
            noise_m,
            ..
        } = self.config;
        let mut stream = key.stream();
        for range in ranges {
            if noise_m > 0.0 {
                // One draw for each ray, whatever it hits.
                let error_m = (f64::from(noise_m) * stream.normal()) as f32;
                if *range <= max_range_m {
                    *range += error_m;
                }
            }
            *range = range.clamp(min_range_m, max_range_m);
        }
    }
}

impl Sensor for LidarSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.body.name.clone(),
            shape: vec![self.rings.len(), self.beams_rad.len()],
            dtype: Dtype::Float32,
            unit: "m",
            low: f64::from(self.config.min_range_m),
            high: f64::from(self.config.max_range_m),
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) = (self.body.state(seen), out) {
            self.measure(seen.world, agent, out);
            self.finish(seen.key, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use dwell_scene::AgentId;
    use serde_json::json;

    fn angles_deg(config: &LidarConfig) -> Vec<f32> {
        let all = config.beam_angles_rad().into_iter();
        all.map(f32::to_degrees).map(f32::round).collect()
    }

    #[test]
    fn beams_go_to_the_left_and_rings_upwards() {
        let of = |beams, fov_deg| LidarConfig {
            beams,
            fov_deg,
            ..LidarConfig::default()
        };
        assert_eq!(angles_deg(&of(4, 360.0)), [-180.0, -90.0, 0.0, 90.0]);
        assert_eq!(angles_deg(&of(3, 90.0)), [-45.0, 0.0, 45.0]);
        for fov_deg in [90.0, 360.0] {
            assert_eq!(angles_deg(&of(1, fov_deg)), [0.0]);
        }
        let rings = |rings| LidarConfig {
            rings,
            highest_deg: 5.0,
            ..LidarConfig::default()
        };
        let rounded = |config: LidarConfig| -> Vec<f32> {
            let all = config.elevations_rad().into_iter();
            all.map(f32::to_degrees).map(f32::round).collect()
        };
        assert_eq!(rounded(rings(1)), [-5.0]);
        assert_eq!(rounded(rings(3)), [-15.0, -5.0, 5.0]);
    }

    #[test]
    fn a_wrong_setting_is_refused_with_what_is_allowed() {
        let config = WorldConfig::default();
        let setup = SensorSetup {
            config: &config,
            agent: AgentId(0),
        };
        for (settings, told) in [
            (json!({"beams": 0}), "beams is 0; allowed is 1 to 65536"),
            (
                json!({"beams": 65536, "rings": 5}),
                "beams is 65536 in 5 rings; allowed is at most 262144 rays in all rings together",
            ),
            (
                json!({"max_range_m": 0.01}),
                "max_range_m is 0.01; allowed is above min_range_m, 0.05, at most 1000 m",
            ),
            (
                json!({"elevations_deg": [0.0], "rings": 2}),
                "elevations_deg is beside rings, lowest_deg or highest_deg; allowed is either the angles or their range",
            ),
            (
                json!({"highest_deg": -20.0}),
                "highest_deg is -20; allowed is lowest_deg, -15, to 90 degrees",
            ),
            (
                json!({"elevations_deg": [0.0, 91.0]}),
                "elevations_deg is [0.0, 91.0]; allowed is 1 to 256 angles of -90 to 90 degrees",
            ),
        ] {
            assert_eq!(build(&settings, setup).unwrap_err().to_string(), told);
        }
        let rows = build(&json!({"elevations_deg": [0.0, 30.0, -30.0]}), setup).unwrap();
        assert_eq!(rows.spec().shape, [3, 360]);
    }
}
