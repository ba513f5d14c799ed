//! Settings of the accuracy and extent of sound propagation.

use crate::air::Air;
use crate::error::{AcousticsError, check_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of an [`AcousticScene`](crate::AcousticScene).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each turns one effect off, independently of the others"
)]
pub struct AcousticConfig {
    /// Sample rate of impulse responses, Hz; 8,000 to 192,000.
    #[schemars(range(min = 8_000, max = 192_000))]
    pub rate_hz: u32,
    /// Rays of the energy tail; 0 (no tail) to 10,000,000.
    pub rays: usize,
    /// Longest time that a ray travels, s; 0.02 to 20. Responses end 0.05 s later at most.
    pub max_duration_s: f64,
    /// Width of the histogram's bins, s; 0.0005 to 0.05.
    pub bin_s: f64,
    /// Highest order of the image sources; 0 (direct sound only) to 4. Specular paths of higher orders belong to the tail.
    pub image_order: usize,
    /// Number of the largest planes that are combined exhaustively, as long as that makes at most 20,000 sequences an order; 0 to 200.
    pub image_planes: usize,
    /// Rays from the receiver that discover further sequences of planes; 0 to 100,000.
    pub discovery_rays: usize,
    /// Decay of the rays' energy down to which their number is kept, dB; 10 to 120. Above it, faint rays end and strong
    /// ones split, so that there are always as many; below, their number falls with their energy. Bands count alike.
    pub roulette_db: f64,
    /// Radius of the detection sphere in which paths with specular last reflections are counted, m; 0.05 to 2. It holds for
    /// paths up to 8 m and grows with their length, up to 0.35 of the cube root of the volume in sight.
    pub receiver_radius_m: f64,
    /// Relative standard error of the tail's energy, in every band, below which no more rays are traced; 0 (all rays) to 1.
    pub max_error: f64,
    /// Random arrivals a second in the tail's pressure; 500 to 100,000. Denser ones cannot be distinguished.
    pub arrivals_per_s: f64,
    /// Makes panels below 4 m² mirror only short waves and scatter long ones, except panels that hang at a wall or lean out
    /// of one.
    pub panel_size: bool,
    /// Makes surfaces absorb more at grazing and less at normal incidence; their tables' coefficients are for a diffuse
    /// field. Without it they hold for every angle.
    pub absorption_by_angle: bool,
    /// Temperature, humidity, pressure.
    pub air: Air,
    /// Enables absorption by air.
    pub air_absorption: bool,
    /// Lets sound pass through walls and doors by their materials' transmission loss.
    pub transmission: bool,
    /// Enables diffraction: paths around what hides the source, and the shadowing by edges beside the straight line.
    pub diffraction: bool,
    /// Radius of the spherical head, m; 0.03 to 0.2.
    pub head_radius_m: f64,
}

impl Default for AcousticConfig {
    /// [`AcousticConfig::full`].
    fn default() -> Self {
        Self::full()
    }
}

impl AcousticConfig {
    /// Settings for listening and measuring: 5,000 rays, images to order 3, two seconds.
    pub fn full() -> Self {
        Self {
            rate_hz: 16_000,
            rays: 5_000,
            max_duration_s: 2.0,
            bin_s: 0.004,
            image_order: 3,
            image_planes: 40,
            discovery_rays: 2_000,
            roulette_db: 40.0,
            receiver_radius_m: 0.5,
            max_error: 0.0,
            arrivals_per_s: 10_000.0,
            panel_size: true,
            absorption_by_angle: true,
            air: Air::default(),
            air_absorption: true,
            transmission: true,
            diffraction: true,
            head_radius_m: 0.0875,
        }
    }

    /// Settings for learning agents: 300 rays, images to order 2, one second.
    pub fn rl() -> Self {
        Self {
            rays: 300,
            arrivals_per_s: 4_000.0,
            max_duration_s: 1.0,
            bin_s: 0.008,
            image_order: 2,
            image_planes: 16,
            discovery_rays: 200,
            roulette_db: 25.0,
            ..Self::full()
        }
    }

    /// Reference settings for comparisons: 50,000 rays, images to order 3, four seconds in bins of 2 ms.
    pub fn reference() -> Self {
        Self {
            rays: 50_000,
            max_duration_s: 4.0,
            bin_s: 0.002,
            image_planes: 80,
            discovery_rays: 10_000,
            roulette_db: 60.0,
            ..Self::full()
        }
    }

    /// Returns the settings called `name`: one of [`Self::PRESETS`].
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "rl" => Some(Self::rl()),
            "full" => Some(Self::full()),
            "reference" => Some(Self::reference()),
            _ => None,
        }
    }

    /// The names of all settings, the quickest first.
    pub const PRESETS: [&'static str; 3] = ["rl", "full", "reference"];

    /// Returns the number of bins of a tail's histogram.
    pub(crate) fn bin_count(&self) -> usize {
        (self.max_duration_s / self.bin_s).ceil() as usize
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] names the field.
    pub fn check(&self) -> Result<(), AcousticsError> {
        const AT: &str = "acoustics";
        let whole = |field, value: usize, high: usize, allowed| {
            check_range(AT, field, value as f64, (0.0, high as f64), allowed)
        };
        let rate = f64::from(self.rate_hz);
        check_range(AT, "rate_hz", rate, (8_000.0, 192_000.0), "8000 to 192000")?;
        whole("rays", self.rays, 10_000_000, "0 to 10000000")?;
        check_range(
            AT,
            "max_duration_s",
            self.max_duration_s,
            (0.02, 20.0),
            "0.02 to 20",
        )?;
        check_range(AT, "bin_s", self.bin_s, (0.0005, 0.05), "0.0005 to 0.05")?;
        whole("image_order", self.image_order, 4, "0 to 4")?;
        whole("image_planes", self.image_planes, 200, "0 to 200")?;
        whole(
            "discovery_rays",
            self.discovery_rays,
            100_000,
            "0 to 100000",
        )?;
        check_range(
            AT,
            "roulette_db",
            self.roulette_db,
            (10.0, 120.0),
            "10 to 120",
        )?;
        check_range(
            AT,
            "receiver_radius_m",
            self.receiver_radius_m,
            (0.05, 2.0),
            "0.05 to 2",
        )?;
        check_range(
            AT,
            "arrivals_per_s",
            self.arrivals_per_s,
            (500.0, 100_000.0),
            "500 to 100000",
        )?;
        check_range(AT, "max_error", self.max_error, (0.0, 1.0), "0 to 1")?;
        check_range(
            AT,
            "head_radius_m",
            self.head_radius_m,
            (0.03, 0.2),
            "0.03 to 0.2",
        )?;
        self.air.check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_in_range_and_bad_numbers_are_named() {
        for name in AcousticConfig::PRESETS {
            AcousticConfig::preset(name).unwrap().check().unwrap();
        }
        let bad = AcousticConfig {
            rate_hz: 4_000,
            ..AcousticConfig::rl()
        };
        assert_eq!(
            bad.check().unwrap_err().to_string(),
            "acoustics: rate_hz is 4000; allowed are 8000 to 192000"
        );
        let bad = AcousticConfig {
            bin_s: f64::NAN,
            ..AcousticConfig::rl()
        };
        assert!(bad.check().unwrap_err().to_string().contains("bin_s"));
    }
}
