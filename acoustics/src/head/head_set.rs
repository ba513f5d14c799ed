//! Heads in a scene, and ears on receivers.

use super::{Ear, Head, HeadId, HeadTables, SphericalHead};
use crate::bands::BandValues;
use crate::config::AcousticConfig;
use crate::minimum_phase::MinimumPhaseDesigner;
use glam::{Quat, Vec3};
use realfft::num_complex::Complex;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The heads of a scene, tabulated for its sample rate and air.
#[derive(Clone, Debug)]
pub(crate) struct HeadSet {
    rate_hz: f64,
    speed_m_s: f64,
    bins: usize,
    built_in: HeadTables,
    others: BTreeMap<HeadId, (Head, HeadTables)>,
}

impl HeadSet {
    /// The set of the built-in head alone.
    pub(crate) fn new(config: &AcousticConfig) -> Self {
        let rate_hz = f64::from(config.rate_hz);
        let speed_m_s = config.air.speed_of_sound_m_s();
        Self::with_bins(
            config.head_radius_m,
            speed_m_s,
            rate_hz,
            MinimumPhaseDesigner::bins_at(rate_hz),
        )
    }

    /// A set of a sphere alone, for spectra of `bins` values.
    pub(crate) fn with_bins(radius_m: f64, speed_m_s: f64, rate_hz: f64, bins: usize) -> Self {
        let sphere = SphericalHead::new(radius_m, speed_m_s, rate_hz, bins);
        Self {
            rate_hz,
            speed_m_s,
            bins,
            built_in: HeadTables::Sphere(Arc::new(sphere)),
            others: BTreeMap::new(),
        }
    }

    /// Adds a head that receivers may use.
    pub(crate) fn add(&mut self, head: &Head) {
        if !self.contains(head.id()) {
            let tables = head.tables(self.speed_m_s, self.rate_hz, self.bins);
            self.others.insert(head.id(), (head.clone(), tables));
        }
    }

    /// Returns whether a head is in the set.
    pub(crate) fn contains(&self, id: HeadId) -> bool {
        self.others.contains_key(&id)
    }

    /// Returns the same heads in other air.
    pub(crate) fn with_speed_of_sound_of(&self, config: &AcousticConfig) -> Self {
        let mut heads = Self::new(config);
        for (head, _) in self.others.values() {
            heads.add(head);
        }
        heads
    }

    /// Returns the ears of a head with orientation `rotation`: left, right. `None`: the built-in head, as for an unknown one.
    pub(crate) fn ears(&self, id: Option<HeadId>, rotation: Quat) -> [PlacedEar; 2] {
        let known = id.and_then(|id| self.others.get(&id));
        let head = known.map_or(&self.built_in, |(_, tables)| tables);
        Ear::BOTH.map(|ear| PlacedEar {
            ear,
            axis: rotation * ear.axis_in_head(),
            head_from_world: rotation.inverse(),
            head: head.clone(),
        })
    }
}

/// One ear of a head in the world.
#[derive(Clone, Debug)]
pub(crate) struct PlacedEar {
    ear: Ear,
    /// The ear's axis, world.
    axis: Vec3,
    head_from_world: Quat,
    head: HeadTables,
}

impl PlacedEar {
    /// Returns gain of amplitude and delay re the head's centre (s) in each band, for a wave from `towards`, unit length, world.
    pub(crate) fn gain_and_delay(&self, towards: Vec3) -> (BandValues, BandValues) {
        match &self.head {
            HeadTables::Sphere(sphere) => sphere.gain_and_delay(f64::from(self.axis.dot(towards))),
            HeadTables::Measured(measured) => {
                measured.gain_and_delay(self.ear, self.head_from_world * towards)
            }
        }
    }

    /// Multiplies a path's spectrum by the response without its delay, and returns the delay re the head's centre, s.
    pub(crate) fn apply_undelayed_response(
        &self,
        towards: Vec3,
        spectrum: &mut [Complex<f32>],
    ) -> f64 {
        match &self.head {
            HeadTables::Sphere(sphere) => {
                let cosine = f64::from(self.axis.dot(towards));
                sphere.apply_undelayed_response(cosine, spectrum);
                sphere.delay_s(cosine)
            }
            HeadTables::Measured(measured) => measured.apply_undelayed_response(
                self.ear,
                self.head_from_world * towards,
                spectrum,
            ),
        }
    }
}
