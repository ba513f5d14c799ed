//! Sound at microphones and ears: ray tracing, band materials, impulse responses.
//!
//! An [`AcousticScene`] is the acoustic model of a house. Between a [`SoundSourcePose`] and a [`Receiver`] it finds an
//! [`Echogram`] (exact early paths and a traced energy tail, per octave band), and from that an [`ImpulseResponse`]. A
//! [`Stream`] convolves sources with them, block by block, in step with a world. [`signals`], [`recordings`] and
//! [`contact`] are the sounds of things, [`utterance`] those of speakers, [`metrics`] the acoustic parameters of rooms, and
//! [`intelligibility`] what is understood in them.
//!
//! Units: pressure in Pa, energy e = 1/d² for a free path of d metres (amplitude 1/d re 1 m), sample 0 of a response is the
//! moment of the impulse. Channels: left, right.
//!
//! ```
//! use dwell_acoustics::{AcousticConfig, AcousticScene, Receiver, SoundSourcePose, metrics};
//! use dwell_scene::{House, ShoeboxMaterials, parallel::Threads, random::RandomKey, rays::RayScene};
//! use glam::Vec3;
//! use std::sync::Arc;
//!
//! let house = Arc::new(House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default())?);
//! let (scene, rays) = (AcousticScene::new(house.clone(), AcousticConfig::rl())?, RayScene::new(house));
//! let (source, ear) = (SoundSourcePose::omni(Vec3::new(1.2, 1.4, 1.5)), Receiver::omni(Vec3::new(4.6, 1.2, 3.3)));
//! let response = scene.impulse_response(&rays, &source, &ear, RandomKey::root(1), Threads::ONE)?;
//! assert_eq!(response.echogram.paths[0].order(), 0);
//! assert!(metrics::echogram_metrics(&response.echogram)[4].edt_s.unwrap() > 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod air;
pub mod bands;
mod config;
pub mod contact;
mod diffraction;
mod directions;
mod directivity;
mod echogram;
mod error;
mod fft;
pub mod hdf5;
pub mod head;
mod image_sources;
pub mod intelligibility;
pub mod laws;
mod material_report;
pub mod metrics;
mod microphone_chain;
mod minimum_phase;
mod planes;
mod propagation_scene;
mod ray_margin;
mod receiver;
mod receiver_channel;
pub mod recordings;
mod reflection;
mod response;
mod scene;
pub mod signals;
mod spectrogram;
mod sphere_sequences;
mod stream;
mod surface;
mod synthesis;
mod tail;
mod transmission;
pub mod utterance;

pub use air::Air;
pub use config::AcousticConfig;
pub use directions::{CELL_COUNT, DirectionalEnergy, direction_cell, direction_in_cell};
pub use directivity::Directivity;
pub use echogram::{
    Echogram, EnergyHistogram, MIN_DISTANCE_M, PropagationPath, RayStatistics, SPAN_COUNT,
};
pub use error::AcousticsError;
pub use head::{Head, HeadId};
pub use material_report::{MaterialAcoustics, MaterialReport};
pub use planes::{DiffractionEdge, NO_PLANE, Plane, PlaneTable};
pub use receiver::{MAX_MICROPHONES, Microphone, Receiver, ReceiverKind, SoundSourcePose};
pub use recordings::Recording;
pub use response::ImpulseResponse;
pub use scene::{AcousticScene, EarlyPath};
pub use spectrogram::Spectrogram;
pub use stream::{ActiveSource, BlockReport, Stream, StreamConfig};
