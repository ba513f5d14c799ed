//! Heads: filters between a sound field and the ears.
//!
//! A [`Head`] is a rigid sphere or a measurement of a person or a manikin. A scene has a built-in sphere, and every head
//! added by [`AcousticScene::add_head`](crate::AcousticScene::add_head); receivers refer to one by its [`HeadId`].

mod head_set;
mod measured;
mod series;
mod sphere;

pub(crate) use head_set::{HeadSet, PlacedEar};
pub use measured::{HeadSummary, HrirMeasurement};
pub(crate) use series::sphere_response;
pub use sphere::woodworth_delay_s;

use crate::error::{AcousticsError, check_range};
use measured::{HeadResponses, MeasuredHead};
use serde::{Deserialize, Serialize};
use sphere::SphericalHead;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};
use xxhash_rust::xxh3::xxh3_64;

/// Left or right; the channel order of everything binaural.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ear {
    /// Channel 0; at -X of the head.
    Left,
    /// Channel 1; at +X of the head.
    Right,
}

impl Ear {
    /// Both, in the order of the channels.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the direction of the ear, in head space (forward -Z, right +X).
    pub fn axis_in_head(self) -> glam::Vec3 {
        match self {
            Self::Left => glam::Vec3::NEG_X,
            Self::Right => glam::Vec3::X,
        }
    }
}

/// The id of a head, a hash of its contents: equal heads have equal ids, in every process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct HeadId(pub u64);

/// A head of a receiver. A clone is the same head.
#[derive(Clone)]
pub struct Head {
    id: HeadId,
    shape: HeadModel,
}

#[derive(Clone)]
enum HeadModel {
    Sphere { radius_m: f64 },
    Measured(Arc<MeasuredHeadCache>),
}

/// A measurement, and its tables by sample rate (Hz) and number of bins.
struct MeasuredHeadCache {
    responses: HeadResponses,
    tables: Mutex<BTreeMap<(u64, usize), Arc<MeasuredHead>>>,
}

/// The filters of a head for one sample rate and one speed of sound.
#[derive(Clone, Debug)]
enum HeadTables {
    Sphere(Arc<SphericalHead>),
    Measured(Arc<MeasuredHead>),
}

impl Head {
    /// A rigid sphere with ears at both ends of a diameter. `radius_m`: 0.03 to 0.2.
    ///
    /// # Errors
    /// [`AcousticsError::Range`].
    ///
    /// # Source
    /// R. O. Duda, W. L. Martens, JASA 104, 3048 (1998).
    pub fn spherical(radius_m: f64) -> Result<Self, AcousticsError> {
        check_range("head", "radius_m", radius_m, (0.03, 0.2), "0.03 to 0.2")?;
        let mut bytes = b"sphere".to_vec();
        bytes.extend_from_slice(&radius_m.to_le_bytes());
        Ok(Self {
            id: HeadId(xxh3_64(&bytes)),
            shape: HeadModel::Sphere { radius_m },
        })
    }

    /// A measured head; [`HrirMeasurement`] describes the processing.
    ///
    /// # Errors
    /// [`AcousticsError::Head`] names the fault of the measurement.
    ///
    /// # Determinism
    /// Equal measurements give equal bits.
    pub fn measured(measurement: &HrirMeasurement) -> Result<Self, AcousticsError> {
        let responses = HeadResponses::new(measurement)?;
        Ok(Self {
            id: HeadId(measurement.hash()),
            shape: HeadModel::Measured(Arc::new(MeasuredHeadCache {
                responses,
                tables: Mutex::default(),
            })),
        })
    }

    /// Returns its id.
    pub fn id(&self) -> HeadId {
        self.id
    }

    /// Returns the summary of the measurement; `None` for a sphere.
    pub fn summary(&self) -> Option<&HeadSummary> {
        match &self.shape {
            HeadModel::Sphere { .. } => None,
            HeadModel::Measured(measured) => Some(measured.responses.summary()),
        }
    }

    /// Returns tables for spectra of `bins` values up to half of `rate_hz`, in air with `speed_m_s`; those of a measurement are made once.
    fn tables(&self, speed_m_s: f64, rate_hz: f64, bins: usize) -> HeadTables {
        match &self.shape {
            HeadModel::Sphere { radius_m } => {
                let sphere = SphericalHead::new(*radius_m, speed_m_s, rate_hz, bins);
                HeadTables::Sphere(Arc::new(sphere))
            }
            HeadModel::Measured(measured) => {
                let made = measured.tables.lock();
                let mut made = made.unwrap_or_else(PoisonError::into_inner);
                let tables = made
                    .entry((rate_hz.to_bits(), bins))
                    .or_insert_with(|| Arc::new(measured.responses.tables(rate_hz, bins)));
                HeadTables::Measured(tables.clone())
            }
        }
    }
}

impl PartialEq for Head {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl fmt::Debug for Head {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut name = f.debug_struct("Head");
        name.field("id", &self.id);
        match &self.shape {
            HeadModel::Sphere { radius_m } => name.field("radius_m", radius_m),
            HeadModel::Measured(measured) => name.field("about", measured.responses.summary()),
        };
        name.finish_non_exhaustive()
    }
}
