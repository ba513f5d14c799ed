//! The `cpu` back end: ray casting, always there, the same bits for any number of threads.

mod camera_rays;
mod flat_shading;
mod motion;
mod path_tracer;
mod sampler;
mod shade;
mod shadow;
mod tile;
mod unoccluded;

use crate::error::RenderError;
use crate::frame::{FrameMut, Preset, PreviousPoses, View};
use crate::light::{Lighting, LightingInputs, StaticLighting};
use crate::material::ShadingMaterial;
use crate::semantic::{ClassSet, EntityClasses};
use crate::texture::Textures;
use crate::triangle_table::TriangleTable;
pub(crate) use camera_rays::VISIBLE_MASK;
use dwell_scene::bvh::{Ray, TriangleBvh};
use dwell_scene::parallel::Threads;
use dwell_scene::parallel::apart_from_pool;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, House, State};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use tile::ImageBand;

/// Rows of an image that one thread takes at a time; a multiple of a packet's edge.
const BAND_ROWS: usize = 8;
/// Renders views of one house, in any of its worlds.
///
/// Pictures show the following: RGB is what a camera sees, glass and other materials that let light through included. Depth,
/// instance and semantic refer to the nearest surface, **glass itself** where there is glass; the holes of a texture with
/// alpha count as surface, too. Surfaces are seen from both sides. Of surfaces that coincide the one with the lower id is
/// seen.
///
/// # Determinism
/// Equal input, equal bits, for any number of threads and for any company in a batch.
///
/// ```
/// use dwell_render::{Camera, CpuRenderer, Frame, ImageChannels, View};
/// use dwell_scene::{House, Pose, ShoeboxMaterials, State, parallel::Threads, rays::RayScene};
/// use std::sync::Arc;
///
/// let house = Arc::new(House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default())?);
/// let (scene, state) = (RayScene::new(house.clone()), State::new(&house));
/// let view = View::new(Camera::from_fov(64, 64, 90.0)?, Pose::from_position(glam::Vec3::new(3.0, 1.5, 4.0)));
/// let mut frame = Frame::new(&view.camera, ImageChannels::ALL);
/// CpuRenderer::new(&house).render(&scene, &state, &[view], &mut [frame.as_mut()], Threads::ONE)?;
/// assert!((frame.depth[32 * 64 + 32] - 4.0).abs() < 1e-4); // the north wall
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct CpuRenderer {
    house: Arc<House>,
    pub(crate) textures: Textures,
    pub(crate) shading_materials: Vec<ShadingMaterial>,
    pub(crate) triangle_table: TriangleTable,
    /// Class of every entity, by each table.
    classes: [EntityClasses; 3],
    /// Boxes around the surface of each part, in its own space. Shape (part,).
    part_bounds: OnceLock<Vec<Aabb>>,
    /// Made for the first lit view.
    light: OnceLock<StaticLighting>,
    /// The light of worlds in earlier calls, that of the latest last.
    lightings: Mutex<VecDeque<Lighting>>,
    /// The trees of meshes, made when one is rendered alone. Shape (mesh,).
    trees: Vec<OnceLock<Arc<TriangleBvh>>>,
}

/// One view of one world, for a batch.
#[derive(Debug)]
pub struct RenderJob<'a> {
    /// The world's surfaces, up to date with `state`.
    pub scene: &'a RayScene,
    /// The world.
    pub state: &'a State,
    /// The view.
    pub view: View,
    /// The previous frame, for flow; without it nothing has moved.
    pub before: Option<PreviousPoses<'a>>,
    /// The first wanted row and the one behind the last; `None`: all.
    pub rows: Option<(u32, u32)>,
    /// The buffers for its images: of the rows that are wanted.
    pub frame: FrameMut<'a>,
}

impl<'a> RenderJob<'a> {
    /// All rows of a view in which nothing has moved.
    pub fn new(scene: &'a RayScene, state: &'a State, view: View, frame: FrameMut<'a>) -> Self {
        Self {
            scene,
            state,
            view,
            before: None,
            rows: None,
            frame,
        }
    }

    /// The first row and the one behind the last.
    pub(crate) fn row_range(&self) -> (usize, usize) {
        let height = self.view.camera.height();
        let (first, end) = self.rows.unwrap_or((0, height));
        let end = end.min(height);
        (first.min(end) as usize, end as usize)
    }
}

impl CpuRenderer {
    /// As [`Self::try_new`], for houses that are known to fit.
    ///
    /// # Panics
    /// Where the memory does not hold the house's images.
    pub fn new(house: &Arc<House>) -> Self {
        Self::try_new(house).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Prepares textures, colours and the tables of all triangles of a house, to be shared by all worlds over it.
    /// [`texture_bytes`](crate::texture_bytes) says before what its images take.
    ///
    /// # Errors
    /// [`RenderError::Memory`] where the system refuses the memory of the house's images.
    pub fn try_new(house: &Arc<House>) -> Result<Self, RenderError> {
        let textures = Textures::new(house)?;
        let mut looks = ShadingMaterial::all(house, &textures);
        looks.push(ShadingMaterial::agent_body());
        let surfaces = TriangleTable::new(house, &looks);
        tracing::debug!(
            texture_bytes = textures.bytes(),
            triangle_bytes = surfaces.bytes(),
            materials = looks.len(),
            "cpu renderer prepared"
        );
        Ok(Self {
            classes: ClassSet::ALL.map(|table| EntityClasses::new(house, table)),
            part_bounds: OnceLock::new(),
            house: house.clone(),
            textures,
            shading_materials: looks,
            triangle_table: surfaces,
            light: OnceLock::new(),
            lightings: Mutex::default(),
            trees: house.meshes.iter().map(|_| OnceLock::new()).collect(),
        })
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        &self.house
    }

    /// Renders views of one world. `frames`: one for each view.
    ///
    /// # Errors
    /// [`RenderError::Count`], [`RenderError::Length`], [`RenderError::Pose`] or [`RenderError::OtherHouse`] for what does
    /// not fit; then nothing is written.
    pub fn render(
        &self,
        scene: &RayScene,
        state: &State,
        views: &[View],
        frames: &mut [FrameMut<'_>],
        threads: Threads,
    ) -> Result<(), RenderError> {
        if views.len() != frames.len() {
            return Err(RenderError::Count {
                views: views.len(),
                frames: frames.len(),
            });
        }
        let pairs = views.iter().zip(frames);
        let mut jobs: Vec<RenderJob<'_>> = pairs
            .map(|(view, frame)| RenderJob::new(scene, state, *view, frame.reborrow()))
            .collect();
        self.render_batch(&mut jobs, threads)
    }

    /// Renders views of any worlds over the house.
    ///
    /// # Errors
    /// As [`Self::render`]; numbers in messages are positions in `jobs`.
    pub fn render_batch(
        &self,
        jobs: &mut [RenderJob<'_>],
        threads: Threads,
    ) -> Result<(), RenderError> {
        for (k, job) in jobs.iter().enumerate() {
            self.check(k, job)?;
        }
        // Views of one world follow one another as a rule: its light is made once.
        let mut lightings: Vec<Lighting> = Vec::new();
        let mut lit: Vec<Option<usize>> = Vec::new();
        let mut last: Option<&State> = None;
        for job in jobs.iter() {
            if job.view.preset == Preset::Flat || job.frame.rgb.is_none() {
                lit.push(None);
                continue;
            }
            if !last.is_some_and(|state| std::ptr::eq(state, job.state)) {
                last = Some(job.state);
                lightings.push(self.cached_or_computed_lighting(job.scene, job.state));
            }
            lit.push(Some(lightings.len() - 1));
        }
        let mut bands = Vec::new();
        for (job, lit) in jobs.iter_mut().zip(lit) {
            let light = lit.map(|k| {
                let eye = job.view.world_from_camera.position;
                (
                    &lightings[k],
                    lightings[k].exposure(self.static_lighting(), eye),
                )
            });
            ImageBand::split(job, light, &mut bands);
        }
        threads.for_each(&mut bands, |_, band| band.render(self));
        drop(bands);
        self.lightings().extend(lightings);
        Ok(())
    }

    pub(crate) fn check(&self, view: usize, job: &RenderJob<'_>) -> Result<(), RenderError> {
        if !Arc::ptr_eq(&self.house, job.scene.house()) {
            return Err(RenderError::OtherHouse { view });
        }
        let pose = &job.view.world_from_camera;
        if !pose.is_valid() {
            return Err(RenderError::Pose {
                view,
                found: format!("{:?} {:?}", pose.position, pose.rotation),
            });
        }
        let (first, end) = job.row_range();
        let pixels = (end - first) * job.view.camera.width() as usize;
        job.frame.check(view, pixels)
    }

    pub(crate) fn static_lighting(&self) -> &StaticLighting {
        self.light.get_or_init(|| {
            apart_from_pool(|| {
                StaticLighting::new(&self.house, &self.shading_materials, &self.textures)
            })
        })
    }

    /// The light of a world as it stands: kept where all its inputs are as they were, else computed in the memory that was used
    /// longest ago; see [`Self::return_to_lighting_cache`].
    pub(crate) fn cached_or_computed_lighting(&self, scene: &RayScene, state: &State) -> Lighting {
        let inputs = LightingInputs {
            house: &self.house,
            fixed: self.static_lighting(),
            scene,
            state,
        };
        let hash = inputs.hash();
        let mut lighting = {
            let mut all = self.lightings();
            let kept = all.iter().position(|lighting| lighting.may_match(hash));
            all.remove(kept.unwrap_or(0)).unwrap_or_default()
        };
        let bvh = scene.bvh();
        lighting.update(
            &inputs,
            hash,
            |point| self.is_sun_visible(bvh, point),
            |from, to, hidden| self.is_unoccluded(bvh, &Ray::segment(from, to, 0.0), hidden),
        );
        lighting
    }

    /// Returns the light of [`Self::cached_or_computed_lighting`] for reuse.
    pub(crate) fn return_to_lighting_cache(&self, lighting: Lighting) {
        self.lightings().push_back(lighting);
    }

    fn lightings(&self) -> MutexGuard<'_, VecDeque<Lighting>> {
        self.lightings
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// The class of every entity, by a table.
    pub fn classes(&self, table: ClassSet) -> &EntityClasses {
        &self.classes[table as usize]
    }

    /// The class of an entity in the semantic image.
    #[inline]
    fn class(&self, entity: i32) -> i32 {
        self.classes[ClassSet::Coarse as usize].of(entity)
    }

    /// Boxes around the surface of each part, in its own space; made at first use. Shape (part,).
    pub(crate) fn part_bounds(&self) -> &[Aabb] {
        self.part_bounds.get_or_init(|| {
            let parts = self.house.parts.iter();
            parts
                .map(|part| {
                    let mesh = &self.house.meshes[part.mesh];
                    let points = mesh.triangles.iter().flatten();
                    Aabb::from_points(points.map(|vertex| {
                        let point = mesh.positions[*vertex as usize];
                        part.part_from_mesh.transform_point3(point)
                    }))
                })
                .collect()
        })
    }
}
