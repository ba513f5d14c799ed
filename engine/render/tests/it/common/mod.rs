//! Small houses and views for tests.
#![allow(dead_code, reason = "each test file uses its share")]

use dwell_render::{Camera, CpuRenderer, Frame, ImageChannels, View};
use dwell_scene::material::library;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomStream;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Aabb, Category, House, HouseData, Level, LevelId, Material, Mesh, Mobility, Object, ObjectId,
    Part, PartId, Pose, State, space,
};
use glam::{Affine3A, Vec2, Vec3};
use std::sync::Arc;

/// A house that grows object by object.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) data: HouseData,
}

impl Builder {
    /// Nothing but a storey.
    pub(crate) fn empty() -> Self {
        let mut data = HouseData {
            name: "test".into(),
            source: "test@1".into(),
            ..HouseData::default()
        };
        data.levels.push(Level {
            name: "0".into(),
            bounds: Aabb::new(Vec3::splat(-10.0), Vec3::splat(10.0)),
        });
        Self { data }
    }

    /// The furniture of a house, to be added to.
    pub(crate) fn from(house: &House) -> Self {
        Self {
            data: house.data().clone(),
        }
    }

    /// A material of plaster with this name, to be changed.
    pub(crate) fn plaster(name: &str) -> Material {
        Material::from_substance(name, library().get_or_default("plaster"))
    }

    /// One thing of one part.
    pub(crate) fn add(
        &mut self,
        name: &str,
        mesh: Mesh,
        material: Material,
        movable: bool,
        place: Pose,
    ) -> ObjectId {
        let mesh = self.data.meshes.push(Arc::new(mesh));
        let material = self.data.materials.push(material);
        let first_part = PartId(self.data.parts.len() as u32);
        let object = self.data.objects.push(Object {
            name: name.into(),
            source_id: name.into(),
            model: name.into(),
            category: Category {
                coarse: "box".into(),
                ..Category::default()
            },
            level: LevelId(0),
            room: None,
            mobility: if movable {
                Mobility::Movable
            } else {
                Mobility::Fixed
            },
            pickable: false,
            switch: None,
            first_part,
            part_count: 1,
        });
        self.data.parts.push(Part {
            object,
            name: "root".into(),
            fixed: !movable,
            world_from_part: place,
            mesh,
            part_from_mesh: Affine3A::IDENTITY,
            materials: vec![material],
            colliders: Vec::new(),
            mass_kg: None,
            density_kg_m3: 500.0,
            inertial: None,
        });
        object
    }

    pub(crate) fn build(self) -> World {
        World::new(House::new(self.data).unwrap())
    }
}

/// A house, its state, its rays and its renderer.
pub(crate) struct World {
    pub(crate) house: Arc<House>,
    pub(crate) state: State,
    pub(crate) scene: RayScene,
    pub(crate) renderer: CpuRenderer,
}

impl World {
    pub(crate) fn new(house: House) -> Self {
        Self::over(Arc::new(house))
    }

    pub(crate) fn over(house: Arc<House>) -> Self {
        Self {
            state: State::new(&house),
            scene: RayScene::new(house.clone()),
            renderer: CpuRenderer::new(&house),
            house,
        }
    }

    pub(crate) fn shot(&self, view: &View) -> Frame {
        self.shot_with(view, Threads::ONE)
    }

    pub(crate) fn shot_with(&self, view: &View, threads: Threads) -> Frame {
        let mut frame = Frame::new(&view.camera, ImageChannels::ALL);
        self.renderer
            .render(
                &self.scene,
                &self.state,
                &[*view],
                &mut [frame.as_mut()],
                threads,
            )
            .unwrap();
        frame
    }
}

/// A rectangle across Z at `z`, facing +Z, with texture coordinates 0 to 1.
pub(crate) fn quad(min: Vec2, max: Vec2, z: f32) -> Mesh {
    Mesh {
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        ..Mesh::rectangle([
            Vec3::new(min.x, min.y, z),
            Vec3::new(max.x, min.y, z),
            Vec3::new(max.x, max.y, z),
            Vec3::new(min.x, max.y, z),
        ])
    }
}

/// A camera at `eye` that looks at `target`.
pub(crate) fn look(camera: Camera, eye: Vec3, target: Vec3) -> View {
    View::new(
        camera,
        Pose::new(eye, space::rotation_from_forward(target - eye).unwrap()),
    )
}

/// A pixel of an RGB image.
pub(crate) fn pixel(frame: &Frame, camera: &Camera, x: usize, y: usize) -> [u8; 3] {
    let first = (y * camera.width() as usize + x) * 3;
    [frame.rgb[first], frame.rgb[first + 1], frame.rgb[first + 2]]
}

/// A point in a cube around the origin.
pub(crate) fn point(stream: &mut RandomStream, half: f32) -> Vec3 {
    Vec3::new(
        stream.range(-half, half),
        stream.range(-half, half),
        stream.range(-half, half),
    )
}

/// Distance along a ray of any length to a triangle, by a solution of three equations in double precision.
pub(crate) fn meets(origin: Vec3, direction: Vec3, corners: [Vec3; 3]) -> Option<f64> {
    let [a, b, c] = corners.map(|p| p.as_dvec3() - origin.as_dvec3());
    let d = direction.as_dvec3();
    // a + u (b - a) + v (c - a) = t d, by Cramer's rule.
    let (e, f) = (b - a, c - a);
    let determinant = e.dot(f.cross(d));
    if determinant.abs() < 1e-14 {
        return None;
    }
    let u = (-a).dot(f.cross(d)) / determinant;
    let v = e.dot((-a).cross(d)) / determinant;
    let t = -e.dot(f.cross(-a)) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}
