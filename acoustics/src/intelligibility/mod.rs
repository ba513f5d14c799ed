//! Speech intelligibility: what is understood of speech at a place, from the room and the noise there.
//!
//! 1. A [`ModulationTransfer`] says how much of the fluctuations of speech the room leaves: m(F) by octave and
//!    modulation frequency (Schroeder 1981), from an [`Echogram`](crate::Echogram), an impulse response or a reverberation time.
//! 2. [`speech_transmission_index`] joins it with the octave levels of speech and noise at the ear, auditory masking and the threshold of
//!    hearing: the STI of IEC 60268-16:2011, 0 to 1, with the weights of male speech.
//! 3. [`token_recognition_probability`] is the probability with which a listener recognizes one of so many words at that STI, and
//!    [`hear_tokens`] draws what is heard of an utterance.
//!
//! Bands are the octaves of 125 Hz to 8 kHz: those of [`bands`](crate::bands) but the lowest. Levels are in dB SPL of all sound in a
//! band; [`octave_levels_db`] measures them in a signal, and [`received_levels_db`] gives them behind an echogram. The model is
//! for one ear, steady noise and listeners of normal hearing who know the language; two ears that hear noise from elsewhere gain some dB.
//!
//! ```
//! use dwell_acoustics::intelligibility::{
//!     ModulationTransfer, hear_tokens, received_levels_db, speech_transmission_index, token_recognition_probability,
//! };
//! use dwell_acoustics::{AcousticConfig, AcousticScene, Receiver, SoundSourcePose, utterance::VocalEffort};
//! use dwell_scene::{House, ShoeboxMaterials, parallel::Threads, random::RandomKey, rays::RayScene};
//! use glam::Vec3;
//! use std::sync::Arc;
//!
//! let house = Arc::new(House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default())?);
//! let (scene, rays) = (AcousticScene::new(house.clone(), AcousticConfig::rl())?, RayScene::new(house));
//! let (mouth, ear) = (SoundSourcePose::omni(Vec3::new(1.2, 1.4, 1.5)), Receiver::omni(Vec3::new(4.6, 1.2, 3.3)));
//! let key = RandomKey::root(1);
//! let echogram = scene.impulse_response(&rays, &mouth, &ear, key, Threads::ONE)?.echogram;
//! let speech_db = received_levels_db(&VocalEffort::Normal.octave_levels_db(), &echogram);
//! let transfer = ModulationTransfer::of_echogram(&echogram);
//! let heard_in = |noise_db| speech_transmission_index(&speech_db, &[noise_db; 7], &transfer);
//! let (quiet, loud) = (heard_in(20.0)?.sti, heard_in(70.0)?.sti);
//! assert!(quiet > 0.3 && loud < 0.1);
//! let probability = token_recognition_probability(quiet, 1243)?;
//! let heard = hear_tokens(&[17, 4], probability, 1243, key)?;
//! assert_eq!(heard.len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod levels;
mod modulation;
mod recognition;
mod transmission_index;
mod vocabulary_size;

pub use levels::{octave_levels_db, received_levels_db};
pub use modulation::{MODULATION_FREQUENCIES_HZ, ModulationTransfer};
pub use recognition::{hear_tokens, token_recognition_probability, word_score};
pub use transmission_index::{SpeechTransmission, speech_transmission_index};
