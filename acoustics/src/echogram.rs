//! Echograms: energies by time, band and direction of arrival.

use crate::bands::{BAND_COUNT, BandValues};
use crate::directions::DirectionalEnergy;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Least distance of source and receiver, m: nearer, 1/d has no meaning for real sources.
pub const MIN_DISTANCE_M: f64 = 0.1;

/// One deterministic path from source to receiver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PropagationPath {
    /// The planes that reflect it, from the source on. Shape (order,).
    pub planes: Vec<u32>,
    /// Points at which it bends around edges, from the source on, m; a diffracted path is not reflected. Shape (0 to 2,).
    pub diffraction_points: Vec<Vec3>,
    /// Its length, m.
    pub length_m: f64,
    /// Energy at the receiver re 1/d² of a free path, air included. Shape (band,).
    pub energy: BandValues,
    /// Direction of arrival: from the receiver towards the incoming sound, unit length, world.
    pub arrival: Vec3,
    /// Direction of departure from the source, unit length, world.
    pub departure: Vec3,
    /// Number of walls that it passes through.
    pub walls: u32,
    /// True for inverted pressure: it left the source from a lobe of negative gain.
    pub inverted: bool,
}

impl PropagationPath {
    /// Returns whether it is the straight one, in sight or through walls.
    pub fn is_direct(&self) -> bool {
        self.planes.is_empty() && self.diffraction_points.is_empty()
    }

    /// Returns the number of reflections.
    pub fn order(&self) -> usize {
        self.planes.len()
    }
}

/// Energy of the tail over time, and its directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyHistogram {
    /// Width of a bin, s.
    pub bin_s: f64,
    /// Energy re 1/d² of a free path, air included, from the moment of the impulse on. Shape (bin, band).
    pub bins: Vec<[f64; BAND_COUNT]>,
    /// Bins that share one entry of `directions`; at least 1.
    pub bins_per_direction: usize,
    /// Directions of arrival. Shape (ceil(bin / `bins_per_direction`),).
    pub directions: Vec<DirectionalEnergy>,
}

impl EnergyHistogram {
    /// Sum over all bins. Shape (band,).
    pub fn total(&self) -> [f64; BAND_COUNT] {
        let mut sum = [0.0; BAND_COUNT];
        for bin in &self.bins {
            for (total, energy) in sum.iter_mut().zip(bin) {
                *total += energy;
            }
        }
        sum
    }

    /// Returns the directions of arrival of the energy of bin `bin`, if they are known.
    pub fn directions_at(&self, bin: usize) -> Option<&DirectionalEnergy> {
        self.directions.get(bin / self.bins_per_direction.max(1))
    }

    /// Time span, s.
    pub fn duration_s(&self) -> f64 {
        self.bin_s * self.bins.len() as f64
    }
}

/// Number of time spans in [`RayStatistics::error_over_time`].
pub const SPAN_COUNT: usize = 7;

/// Statistics of the traced rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayStatistics {
    /// Rays emitted.
    pub rays: u64,
    /// Straight pieces that ended on a surface.
    pub segments: u64,
    /// Number of rays that left the house, those that rays split into included.
    pub escaped: u64,
    /// Mean length of the pieces, m: 4 V / S in a closed room with scattering walls that absorb alike.
    pub mean_free_path_m: f64,
    /// Radius of the largest detection sphere around the receiver, m.
    pub receiver_radius_m: f64,
    /// Standard error of the tail's energy over its mean, from the scatter among groups of rays; 0 where nothing arrives.
    /// Shape (band,).
    pub relative_error: BandValues,
    /// The same for spans of time, all bands together, from the scatter among rays: up to 20, 40, 80, 160, 320, 640 ms, and later.
    /// Shape (span,).
    pub error_over_time: [f32; SPAN_COUNT],
    /// Volume visible from the receiver, m³: that of a convex room, and an underestimate behind corners.
    pub visible_volume_m3: f64,
}

/// All energies between one source and one receiver, without any noise realisation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Echogram {
    /// Direct sound, low-order reflections and diffracted paths, by length.
    pub paths: Vec<PropagationPath>,
    /// Everything else.
    pub tail: EnergyHistogram,
    /// Statistics of the traced rays.
    pub ray_statistics: RayStatistics,
    /// Position of the source, m.
    pub source: Vec3,
    /// Straight distance from source to receiver, m, whatever is between: nothing is heard before that.
    pub direct_length_m: f64,
    /// Speed of sound, m/s.
    pub speed_m_s: f64,
}

impl Echogram {
    /// The direct path, if sound gets through.
    pub fn direct(&self) -> Option<&PropagationPath> {
        self.paths.iter().find(|path| path.is_direct())
    }

    /// Returns the arrival time of a path, s.
    pub fn delay_s(&self, path: &PropagationPath) -> f64 {
        path.length_m / self.speed_m_s
    }

    /// Energy of paths and tail together. Shape (band,).
    pub fn total(&self) -> [f64; BAND_COUNT] {
        let mut sum = self.tail.total();
        for path in &self.paths {
            for (total, energy) in sum.iter_mut().zip(path.energy) {
                *total += f64::from(energy);
            }
        }
        sum
    }

    /// Returns whether there is no energy at all.
    pub fn is_silent(&self) -> bool {
        self.total().iter().all(|energy| *energy == 0.0)
    }
}
