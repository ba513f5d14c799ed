//! The part of a house's worlds that they share: the house, and each engine's view of it, made at first use.

use crate::air_position::emission_points;
use crate::config::WorldConfig;
use crate::error::WorldError;
use crate::initial_state::InitialWorld;
use crate::recordings::RecordingCache;
use crate::release_memory::ReleaseOnDrop;
use crate::texture_memory;
use dwell_acoustics::signals::Signal;
use dwell_acoustics::{AcousticConfig, AcousticScene, Head, HeadId};
use dwell_physics::PhysicsModel;
use dwell_render::{BackEnd, CpuRenderer, Renderer};
use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::parallel::apart_from_pool;
use dwell_scene::{House, SoundFileId, State};
use dwell_semantics::Semantics;
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};

/// Grids of walkers that a house keeps: enough for the bodies of a world, few enough for large houses.
const KEPT_GRIDS: usize = 8;

/// A house with the engines' shared views of it. A thousand worlds over one house share one of these.
#[derive(Debug)]
pub struct Engines {
    house: Arc<House>,
    renderer: OnceLock<Arc<CpuRenderer>>,
    /// Held while the renderer is made.
    making: Mutex<()>,
    /// Renderers by back end.
    pictures: Mutex<BTreeMap<BackEnd, Arc<Renderer>>>,
    semantics: OnceLock<Semantics>,
    physics: OnceLock<Arc<PhysicsModel>>,
    /// Scenes by preset and sample rate.
    acoustics: Mutex<BTreeMap<(String, u32), AcousticScene>>,
    heads: Mutex<BTreeMap<HeadId, Head>>,
    recordings: RecordingCache,
    /// The points from which the house's own sounds are heard. Shape (emitter,).
    emitter_places: OnceLock<Vec<Vec3>>,
    /// Grids of the house as it starts, by walker, the latest at the end.
    grids: Mutex<Vec<Arc<NavGrid>>>,
    /// The initial state of the latest config, as long as a world of it is left.
    start: Mutex<Option<(WorldConfig, Weak<InitialWorld>)>>,
    /// The last field: it is dropped after all others.
    _heap: ReleaseOnDrop,
}

impl Engines {
    /// Shares `house`; nothing is computed yet.
    pub fn new(house: Arc<House>) -> Arc<Self> {
        Arc::new(Self {
            house,
            renderer: OnceLock::new(),
            making: Mutex::default(),
            pictures: Mutex::default(),
            semantics: OnceLock::new(),
            physics: OnceLock::new(),
            acoustics: Mutex::default(),
            heads: Mutex::default(),
            recordings: RecordingCache::default(),
            emitter_places: OnceLock::new(),
            grids: Mutex::default(),
            start: Mutex::default(),
            _heap: ReleaseOnDrop,
        })
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        &self.house
    }

    /// The renderer with the house's textures and tables, made at first use.
    ///
    /// # Errors
    /// [`WorldError::Config`] or [`WorldError::Render`] for images that the free memory does not hold.
    pub fn cpu_renderer(&self) -> Result<&CpuRenderer, WorldError> {
        self.shared_cpu_renderer().map(|tables| &**tables)
    }

    fn shared_cpu_renderer(&self) -> Result<&Arc<CpuRenderer>, WorldError> {
        // One thread makes it; the others wait, as twice the memory may not be there.
        let _made = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(tables) = self.renderer.get() {
            return Ok(tables);
        }
        texture_memory::check(&self.house)?;
        let tables = apart_from_pool(|| CpuRenderer::try_new(&self.house))?;
        let tables = Arc::new(tables);
        Ok(self.renderer.get_or_init(|| tables))
    }

    /// A back end over the house, made at first use.
    ///
    /// # Errors
    /// [`WorldError::Render`] for a graphics adapter that is not there, fails, or is too small for the house; as
    /// [`Engines::cpu_renderer`].
    pub fn image_renderer(&self, back_end: &BackEnd) -> Result<Arc<Renderer>, WorldError> {
        let mut made = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(renderer) = made.get(back_end) {
            return Ok(renderer.clone());
        }
        let tables = self.shared_cpu_renderer()?.clone();
        let renderer = Arc::new(apart_from_pool(|| Renderer::new(back_end, tables))?);
        made.insert(back_end.clone(), renderer.clone());
        Ok(renderer)
    }

    /// Returns the semantics of the house.
    pub fn semantics(&self) -> &Semantics {
        if let Some(made) = self.semantics.get() {
            return made;
        }
        // Without a lock, so that all threads help; the one that loses a race is dropped, as they are equal.
        let made = Semantics::new(&self.house);
        self.semantics.get_or_init(|| made)
    }

    /// The shapes of the house's bodies.
    pub fn physics_model(&self) -> &Arc<PhysicsModel> {
        self.physics
            .get_or_init(|| Arc::new(apart_from_pool(|| PhysicsModel::new(self.house.clone()))))
    }

    /// Returns the initial state of worlds of a config; worlds that run side by side share it.
    pub(crate) fn initial_world(
        &self,
        config: &WorldConfig,
    ) -> Result<Arc<InitialWorld>, WorldError> {
        let mut latest = self.start.lock().unwrap_or_else(PoisonError::into_inner);
        let shared = latest.as_ref().filter(|(of, _)| of == config);
        if let Some(start) = shared.and_then(|(_, start)| start.upgrade()) {
            return Ok(start);
        }
        let start = apart_from_pool(|| InitialWorld::new(self.physics_model(), config))?;
        let start = Arc::new(start);
        *latest = Some((config.clone(), Arc::downgrade(&start)));
        Ok(start)
    }

    /// The house prepared for sound with the settings called `preset`; what belongs to the house is shared.
    ///
    /// # Errors
    /// [`WorldError::Config`] for an unknown preset, [`WorldError::Acoustics`] for a rate out of range.
    pub fn acoustic_scene(&self, preset: &str, rate_hz: u32) -> Result<AcousticScene, WorldError> {
        let mut scenes = self
            .acoustics
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(scene) = scenes.get(&(preset.to_owned(), rate_hz)) {
            return Ok(scene.clone());
        }
        let Some(config) = AcousticConfig::preset(preset) else {
            let allowed = AcousticConfig::PRESETS.join(", ");
            return Err(WorldError::Config {
                field: "sound_preset",
                found: format!("{preset:?}"),
                allowed,
            });
        };
        let config = AcousticConfig { rate_hz, ..config };
        let scene = apart_from_pool(|| AcousticScene::new(self.house.clone(), config))?;
        Ok(scenes
            .entry((preset.to_owned(), rate_hz))
            .or_insert(scene)
            .clone())
    }

    /// Returns whether the scene of [`Self::acoustic_scene`] is made, or being made.
    pub(crate) fn has_acoustic_scene(&self, preset: &str, rate_hz: u32) -> bool {
        let Ok(scenes) = self.acoustics.try_lock() else {
            return true;
        };
        scenes.contains_key(&(preset.to_owned(), rate_hz))
    }

    /// Returns whether the tables of pictures are made.
    pub(crate) fn has_renderer(&self) -> bool {
        self.renderer.get().is_some()
    }

    /// Adds a head for the agents' ears; [`WorldConfig::sound_head`] names it.
    pub fn add_head(&self, head: &Head) {
        let mut heads = self.heads.lock().unwrap_or_else(PoisonError::into_inner);
        heads.entry(head.id()).or_insert_with(|| head.clone());
    }

    /// A head that was added.
    ///
    /// # Errors
    /// [`WorldError::Config`] for one that was not.
    pub(crate) fn head(&self, id: HeadId) -> Result<Head, WorldError> {
        let heads = self.heads.lock().unwrap_or_else(PoisonError::into_inner);
        heads.get(&id).cloned().ok_or_else(|| WorldError::Config {
            field: "sound_head",
            found: id.0.to_string(),
            allowed: "heads that the house's engines were given".to_owned(),
        })
    }

    /// A sound file below `root` at a sample rate, and its check sum; read again once it was written anew.
    pub(crate) fn recording(
        &self,
        root: Option<&str>,
        name: &str,
        rate_hz: u32,
    ) -> Result<(Signal, u64), WorldError> {
        self.recordings.open(root, name, rate_hz)
    }

    /// The points from which the house's own sounds are heard, in the frames of their parts, m. Shape (emitter,).
    pub(crate) fn emission_points(&self) -> &[Vec3] {
        self.emitter_places
            .get_or_init(|| apart_from_pool(|| emission_points(&self.house)))
    }

    /// A sound file of the house at a sample rate; decoded once.
    pub(crate) fn house_sound_file(
        &self,
        id: SoundFileId,
        rate_hz: u32,
    ) -> Result<Signal, WorldError> {
        self.recordings.house_sound_file(&self.house, id, rate_hz)
    }

    /// Refuses a house with an invalid sound file, before it is heard.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] with the file and what plays it.
    pub(crate) fn check_sounds(&self) -> Result<(), WorldError> {
        self.recordings.check_house(&self.house)
    }

    /// Returns the navigation grid of a body in the house as it starts, with all doors open; shared as that of [`Engines::nav_grid_of_config`].
    ///
    /// # Errors
    /// As [`Engines::nav_grid_of_config`].
    pub fn nav_grid(&self, body: &dwell_scene::AgentBody) -> Result<Arc<NavGrid>, WorldError> {
        self.nav_grid_of_config(&NavConfig {
            radius_m: body.radius_m,
            height_m: body.height_m,
            step_m: body.step_height_m,
            doors: DoorPolicy::Open,
            ..NavConfig::default()
        })
    }

    /// Returns the navigation grid of a walker in the house as it starts. Grids of the latest eight walkers are kept and shared.
    ///
    /// # Errors
    /// [`WorldError::Scene`] for a setting out of range, or a house too large for the grid.
    pub fn nav_grid_of_config(&self, config: &NavConfig) -> Result<Arc<NavGrid>, WorldError> {
        let kept = |grids: &mut Vec<Arc<NavGrid>>| {
            let place = grids.iter().position(|grid| grid.config() == config)?;
            grids[place..].rotate_left(1);
            grids.last().cloned()
        };
        if let Some(grid) = kept(&mut self.grids()) {
            return Ok(grid);
        }
        // Without the lock: other threads go on meanwhile, and a stopped build leaves nothing behind.
        let built = NavGrid::build(&self.house, &State::new(&self.house), config)?;
        let mut grids = self.grids();
        if let Some(first) = kept(&mut grids) {
            return Ok(first);
        }
        let built = Arc::new(built);
        grids.push(built.clone());
        if grids.len() > KEPT_GRIDS {
            grids.remove(0);
        }
        Ok(built)
    }

    fn grids(&self) -> MutexGuard<'_, Vec<Arc<NavGrid>>> {
        self.grids.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grids_of_the_latest_walkers_are_shared() {
        let (house, _) = dwell_houses::open("builtin:studio").unwrap();
        let engines = Engines::new(Arc::new(house));
        let walker = |k: usize| NavConfig {
            cell_m: 0.25 + 0.01 * k as f32,
            ..NavConfig::default()
        };
        let first = engines.nav_grid_of_config(&walker(0)).unwrap();
        assert!(Arc::ptr_eq(
            &first,
            &engines.nav_grid_of_config(&walker(0)).unwrap()
        ));
        for k in 1..=KEPT_GRIDS {
            // The grid that is requested again stays longest.
            assert!(Arc::ptr_eq(
                &first,
                &engines.nav_grid_of_config(&walker(0)).unwrap()
            ));
            assert_eq!(
                engines.nav_grid_of_config(&walker(k)).unwrap().config(),
                &walker(k)
            );
        }
        assert!(Arc::ptr_eq(
            &first,
            &engines.nav_grid_of_config(&walker(0)).unwrap()
        ));
        assert_eq!(engines.grids().len(), KEPT_GRIDS);
        assert!(
            engines
                .nav_grid_of_config(&NavConfig {
                    cell_m: f32::NAN,
                    ..walker(0)
                })
                .is_err()
        );
        let body = dwell_scene::AgentBody::default();
        let theirs = engines.nav_grid(&body).unwrap();
        assert!(Arc::ptr_eq(&theirs, &engines.nav_grid(&body).unwrap()));
    }
}
