//! Rooms for tests.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]
#![allow(dead_code, reason = "every test file uses another part of this")]

use dwell_acoustics::{AcousticConfig, AcousticScene, Echogram, SoundSourcePose};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Bands, House, HouseData, LawSpec, Level, LevelId, Material, Mesh, ShoeboxMaterials, Structure,
    StructureKind, material::library,
};
use glam::Vec3;
use std::sync::Arc;

/// A room with its rays.
pub(crate) struct Hall {
    pub(crate) house: Arc<House>,
    pub(crate) scene: AcousticScene,
    pub(crate) rays: RayScene,
}

/// A material that absorbs and scatters equally at all frequencies and lets nothing through.
pub(crate) fn material(absorption: f32, scattering: f32) -> Material {
    Material {
        absorption: Bands::constant(absorption),
        scattering: Bands::constant(scattering),
        transmission_loss_db: Bands::constant(Material::MAX_TRANSMISSION_LOSS_DB),
        ..Material::from_substance("test", library().default_substance())
    }
}

/// A law with some of its values given.
pub(crate) fn law(id: &str, values: &[(&str, f64)]) -> LawSpec {
    LawSpec::new(id, 1, values)
}

/// Settings without air, transmission or diffraction, with walls that mirror all waves and reflect at all angles alike, at
/// 343.2 m/s.
pub(crate) fn dry(rays: usize) -> AcousticConfig {
    AcousticConfig {
        rays,
        air_absorption: false,
        transmission: false,
        diffraction: false,
        panel_size: false,
        absorption_by_angle: false,
        ..AcousticConfig::full()
    }
}

impl Hall {
    pub(crate) fn new(house: House, config: AcousticConfig) -> Self {
        let house = Arc::new(house);
        Self {
            scene: AcousticScene::new(house.clone(), config).unwrap(),
            rays: RayScene::new(house.clone()),
            house,
        }
    }

    pub(crate) fn shoebox(size_m: [f32; 3], material: &Material, config: AcousticConfig) -> Self {
        let materials = ShoeboxMaterials::uniform(material);
        Self::new(House::shoebox(size_m, &materials).unwrap(), config)
    }

    pub(crate) fn echogram(&self, source: Vec3, receiver: Vec3, key: RandomKey) -> Echogram {
        let source = SoundSourcePose::omni(source);
        let threads = Threads::new(2);
        self.scene
            .echogram(&self.rays, &source, receiver, key, threads)
            .unwrap()
    }
}

/// A house of loose pieces, each a mesh in world space with one material.
pub(crate) fn pieces(items: Vec<(Mesh, Material)>) -> House {
    let mut data = HouseData::default();
    data.levels.push(Level {
        name: "0".into(),
        bounds: dwell_scene::Aabb::EMPTY,
    });
    for (k, (mesh, material)) in items.into_iter().enumerate() {
        let mesh = data.meshes.push(Arc::new(mesh));
        let material = data.materials.push(Material {
            name: format!("material {k}"),
            ..material
        });
        data.structure.push(Structure {
            name: format!("piece {k}"),
            kind: StructureKind::Other,
            room: None,
            level: LevelId(0),
            mesh,
            materials: vec![material],
        });
    }
    House::new(data).unwrap()
}

/// A rectangle with `origin` and two edges, cut into `n` times `n` squares of two triangles.
pub(crate) fn rectangle(origin: Vec3, u: Vec3, v: Vec3, n: usize) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..=n {
            mesh.positions
                .push(origin + u * (i as f32 / n as f32) + v * (j as f32 / n as f32));
        }
    }
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    for i in 0..n {
        for j in 0..n {
            mesh.triangles
                .push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles
                .push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

/// The six sides of a box from the origin, each cut into `n` times `n` squares: floor, ceiling, west, east, north, south.
pub(crate) fn box_sides(size: Vec3, n: usize) -> [Mesh; 6] {
    let (x, y, z) = (Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z);
    [
        rectangle(Vec3::ZERO, z, x, n),
        rectangle(y, x, z, n),
        rectangle(Vec3::ZERO, y, z, n),
        rectangle(x, z, y, n),
        rectangle(Vec3::ZERO, x, y, n),
        rectangle(z, y, x, n),
    ]
}
