//! Settings of a stream's updates.

use crate::error::{AcousticsError, check_range};
use serde::{Deserialize, Serialize};

/// Settings of a [`Stream`](crate::Stream).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StreamConfig {
    /// Samples of a block; 16 to 65,536. At 16 kHz and 20 control steps a second: 800.
    pub block_samples: usize,
    /// Displacement of source or listener that requires a new impulse response, m; 0 to 10. 0: any.
    pub update_distance_m: f32,
    /// Rotation of the head that requires a new impulse response, rad; 0 to 3.2.
    pub update_angle_rad: f32,
    /// Displacement of a door or another large part that requires a new impulse response, m (or rotation, rad); 0 to 10.
    pub update_part_m: f32,
    /// Early paths of a source with gliding delays while it or the listener moves: all direct ones, and reflections up to
    /// this many; the others change with the impulse response. 0 (none) to 64. Microphone arrays have none.
    pub tracked_reflections: usize,
    /// The share of all rays that an update of the tail traces where only source or listener have moved; the rest is
    /// reused, unless these rays indicate another tail: then all are traced. 0.001 to 1.
    pub update_share: f64,
    /// The share of all rays that impulse responses of the first block trace, 0.001 to 1. Below 1 a stream begins at once: all
    /// rays follow in the next blocks, one source in each, where the listener stays.
    pub start_share: f64,
    /// Rays of new impulse responses in one block, 0 to 10,000,000; updates beyond wait for later blocks, and the old
    /// responses are used until then. Early paths and synthesis of a response count as rays, too. 0: as many as they need.
    pub update_rays: usize,
    /// Most sources at once; the first in the list win, and those beyond are silent. 1 to 1,000.
    pub max_sources: usize,
}

impl Default for StreamConfig {
    /// [`StreamConfig::full`].
    fn default() -> Self {
        Self::full()
    }
}

impl StreamConfig {
    /// Settings for listening: 12 early paths glide, the rest is updated every 35 cm and 2 degrees.
    pub fn full() -> Self {
        Self {
            block_samples: 800,
            update_distance_m: 0.35,
            update_angle_rad: 0.035,
            update_part_m: 0.03,
            tracked_reflections: 12,
            update_share: 0.1,
            start_share: 1.0,
            update_rays: 600,
            max_sources: 64,
        }
    }

    /// Settings for learning agents: 6 early paths glide, the rest is updated every 50 cm and 10 degrees.
    pub fn rl() -> Self {
        Self {
            update_distance_m: 0.5,
            update_angle_rad: 0.175,
            update_part_m: 0.15,
            tracked_reflections: 6,
            update_share: 0.15,
            start_share: 0.2,
            update_rays: 0,
            max_sources: 16,
            ..Self::full()
        }
    }

    /// Reference settings for comparisons: every early path glides, and everything is updated every 5 cm and 2 degrees with all its rays.
    pub fn reference() -> Self {
        Self {
            update_distance_m: 0.05,
            tracked_reflections: 64,
            update_share: 1.0,
            update_rays: 0,
            ..Self::full()
        }
    }

    /// Returns the settings called `name`: one of [`AcousticConfig::PRESETS`](crate::AcousticConfig::PRESETS).
    pub fn preset(name: &str) -> Option<Self> {
        match name {
            "full" => Some(Self::full()),
            "rl" => Some(Self::rl()),
            "reference" => Some(Self::reference()),
            _ => None,
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] names the field.
    pub fn check(&self) -> Result<(), AcousticsError> {
        const AT: &str = "sound stream";
        let number = |field, value: f32, high, allowed| {
            check_range(AT, field, f64::from(value), (0.0, high), allowed)
        };
        check_range(
            AT,
            "block_samples",
            self.block_samples as f64,
            (16.0, 65_536.0),
            "16 to 65536",
        )?;
        number("update_distance_m", self.update_distance_m, 10.0, "0 to 10")?;
        number("update_angle_rad", self.update_angle_rad, 3.2, "0 to 3.2")?;
        number("update_part_m", self.update_part_m, 10.0, "0 to 10")?;
        check_range(
            AT,
            "moving_paths",
            self.tracked_reflections as f64,
            (0.0, 64.0),
            "0 to 64",
        )?;
        let share = |field, value| check_range(AT, field, value, (1e-3, 1.0), "0.001 to 1");
        share("update_share", self.update_share)?;
        share("start_share", self.start_share)?;
        check_range(
            AT,
            "update_rays",
            self.update_rays as f64,
            (0.0, 1e7),
            "0 to 10000000",
        )?;
        check_range(
            AT,
            "max_sources",
            self.max_sources as f64,
            (1.0, 1000.0),
            "1 to 1000",
        )
    }
}
