//! The acoustic model that rays, images and edges read and never change.

use crate::bands::{BAND_COUNT, BandValues, NOMINAL_CENTRES_HZ};
use crate::config::AcousticConfig;
use crate::echogram::MIN_DISTANCE_M;
use crate::laws::PathEffects;
use crate::planes::{DiffractionEdge, MIN_WALL_AREA_M2, Plane, PlaneTable};
use crate::surface::AcousticSurface;
use dwell_scene::bvh::Hit;
use dwell_scene::{Address, House, Id, MaterialId, Pose, State};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Distance from a panel to the next surface on a path, m: the mean free path of a living room.
const NEXT_WAY_M: f64 = 3.0;

/// Planes, edges, materials and air of a house in the state of one world.
///
/// Data of the house (its planes) is shared by clones; data of the world (overridden materials, moved planes) is not, and
/// is small.
#[derive(Clone, Debug)]
pub(crate) struct PropagationScene {
    house: Arc<House>,
    /// The settings, with the air as changed by laws.
    config: AcousticConfig,
    effects: PathEffects,
    table: Arc<PlaneTable>,
    /// Present positions of all planes.
    planes: Vec<Plane>,
    /// Present positions of the edges of moving parts.
    moving_edges: Vec<DiffractionEdge>,
    /// Present poses of the moving parts. Shape (moving part,).
    poses: Vec<Pose>,
    /// Shape (material,).
    surfaces: Vec<AcousticSurface>,
    overrides: BTreeMap<Address, f64>,
}

impl PropagationScene {
    /// The data of `house` in its initial state.
    pub(crate) fn new(house: Arc<House>, config: AcousticConfig) -> Self {
        let table = Arc::new(PlaneTable::new(&house));
        tracing::debug!(planes = table.len(), "acoustic planes built");
        Self {
            planes: table.initial_planes.clone(),
            moving_edges: table.edges().initial_edges(&house),
            poses: table.initial_poses(&house),
            surfaces: house
                .materials
                .ids()
                .map(|id| AcousticSurface::new(&house, None, id, &config))
                .collect(),
            overrides: BTreeMap::new(),
            effects: PathEffects::default(),
            table,
            config,
            house,
        }
    }

    /// Applies overridden materials and moved parts; cheap when nothing changed.
    pub(crate) fn update(&mut self, state: &State) {
        if state.overrides != self.overrides {
            self.overrides.clone_from(&state.overrides);
            let ids = self.house.materials.ids();
            self.surfaces = ids
                .map(|id| AcousticSurface::new(&self.house, Some(state), id, &self.config))
                .collect();
        }
        if self.table.update(&mut self.planes, &mut self.poses, state) {
            self.moving_edges = self.table.edges().moving_edges_in_state(&self.house, state);
        }
    }

    /// Applies laws' effects on air and sources; `stated`: the original settings.
    pub(crate) fn apply_effects(&mut self, effects: PathEffects, stated: &AcousticConfig) {
        self.config = effects.effective_config(stated);
        self.effects = effects;
    }

    pub(crate) fn house(&self) -> &Arc<House> {
        &self.house
    }

    /// Returns the settings, with the air as changed by laws.
    pub(crate) fn config(&self) -> &AcousticConfig {
        &self.config
    }

    /// Returns laws' effects on air and sources.
    pub(crate) fn effects(&self) -> &PathEffects {
        &self.effects
    }

    pub(crate) fn plane_table(&self) -> &PlaneTable {
        &self.table
    }

    /// Returns all planes at their present positions, largest of the static ones first.
    pub(crate) fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Returns all diffraction edges at their present positions.
    pub(crate) fn edges(&self) -> impl Iterator<Item = &DiffractionEdge> {
        let fixed = self.table.edges().static_edges.iter();
        fixed.chain(&self.moving_edges)
    }

    pub(crate) fn surface(&self, id: MaterialId) -> &AcousticSurface {
        // An id of another house counts as a hard wall; houses are compared where calls come in.
        self.surfaces
            .get(id.index())
            .unwrap_or(&AcousticSurface::RIGID)
    }

    /// Returns the fraction of reflected energy that a surface scatters at a ray's hit, after `straight_m` from the source
    /// or the last scattering and with a cosine of incidence. Shape (band,).
    ///
    /// A panel that is small against the wavelength scatters instead of mirroring. Images and rays share this rule, so that
    /// together they conserve energy; therefore the distance after the reflection, which rays do not know yet, counts as
    /// [`NEXT_WAY_M`]. Walls end at other walls, where their images go on: they mirror all waves. Sound that is diffracted
    /// around a panel that hangs at a wall, or leans out of one as folds do, meets the wall: waves that are long against
    /// the heights find one mirror.
    ///
    /// # Source
    /// J. H. Rindel, *Attenuation of sound reflections due to diffraction*, Proc. Nordic Acoustical Meeting 86, 257 (1986): below
    /// `f_g = c a / (2 S cos theta)` with `a = 2 d1 d2 / (d1 + d2)`, the amplitude falls with `f / f_g`. W. S. Ament, Proc. IRE 41,
    /// 142 (1953): a surface whose height varies by sigma (rms) mirrors `exp(-(2 k sigma cos theta)^2)` of the energy.
    pub(crate) fn scattering(
        &self,
        material: &AcousticSurface,
        hit: &Hit,
        cosine: f32,
        straight_m: f64,
    ) -> BandValues {
        let mut scattering = material.scattering;
        if !self.config.panel_size {
            return scattering;
        }
        let panel = self.table.panel(&self.house, hit);
        if panel.area_m2 >= MIN_WALL_AREA_M2 {
            return scattering;
        }
        let cosine = cosine.max(0.05);
        let way_m = 2.0 * straight_m * NEXT_WAY_M / (straight_m + NEXT_WAY_M);
        let speed = self.config.air.speed_of_sound_m_s();
        let limit_hz = (speed * way_m) as f32 / (2.0 * panel.area_m2 * cosine).max(1e-6);
        let rough_s = 2.0 * std::f32::consts::TAU / speed as f32 * panel.relief_depth_m * cosine;
        for (s, centre_hz) in scattering.iter_mut().zip(NOMINAL_CENTRES_HZ) {
            let ratio = centre_hz / limit_hz;
            if ratio < 1.0 {
                let rough = rough_s * centre_hz;
                let behind = libm::expf(-rough * rough);
                let mirrored = ratio * ratio + (1.0 - ratio * ratio) * behind;
                *s = 1.0 - (1.0 - *s) * mirrored;
            }
        }
        scattering
    }

    /// Returns whether the state overrides a parameter of the material called `name`.
    pub(crate) fn is_overridden(&self, name: &str) -> bool {
        let prefix = format!("material/{name}/");
        let mut addresses = self.overrides.keys();
        addresses.any(|address| address.as_str().starts_with(&prefix))
    }

    /// Returns the energy decay of air in each band, 1/m; zeros where air does not absorb.
    pub(crate) fn air_decay_per_m(&self) -> [f64; BAND_COUNT] {
        if self.config.air_absorption {
            let whole = self.config.air.energy_decay_per_m();
            self.effects.air_decay_per_m(whole)
        } else {
            [0.0; BAND_COUNT]
        }
    }

    /// Returns the energy of a free path: 1/d² less absorption by air.
    pub(crate) fn air_energy_loss(&self, length_m: f64) -> [f64; BAND_COUNT] {
        let distance = length_m.max(MIN_DISTANCE_M);
        self.air_decay_per_m()
            .map(|m| libm::exp(-m * length_m) / (distance * distance))
    }
}
