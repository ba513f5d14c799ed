//! Pictures and shapes of worlds for people: maps, doll's houses, meshes for viewers.

use crate::answers::PyValue;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::house::PyHouse;
use crate::values::JsonArgument;
use crate::world::PyWorld;
use dwell_render::DollhouseConfig;
use dwell_scene::parallel::Threads;
use dwell_scene::{House, LevelId};
use glam::Vec3;
use numpy::{IntoPyArray, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

type RgbArray<'py> = Bound<'py, PyArray3<u8>>;

/// A storey from above: the picture (height, width, 3), x and z of its upper left corner, pixels a metre.
#[pyfunction]
pub(crate) fn map<'py>(
    py: Python<'py>,
    world: &Bound<'py, PyWorld>,
    level: u32,
    longest_edge: u32,
) -> PyResult<(RgbArray<'py>, f32, f32, f32)> {
    let (rgb, map) = world.get().read_interruptible(py, |running| {
        let world = &running.world;
        let threads = Threads::try_resolve(None)?;
        Ok(dwell::map_picture(
            world,
            LevelId(level),
            longest_edge,
            threads,
        )?)
    })?;
    let size = (map.view.camera.height(), map.view.camera.width());
    let picture = picture(py, rgb, size)?;
    Ok((picture, map.corner.x, map.corner.y, map.pixels_per_m))
}

/// A storey from outside, cut open. `config`: the fields of the native `DollhouseConfig`.
#[pyfunction]
pub(crate) fn dollhouse<'py>(
    py: Python<'py>,
    world: &Bound<'py, PyWorld>,
    level: u32,
    config: JsonArgument,
) -> PyResult<RgbArray<'py>> {
    let (rgb, size) = world.get().read_interruptible(py, |running| {
        let world = &running.world;
        let config: DollhouseConfig = config.read()?;
        let threads = Threads::try_resolve(None)?;
        let (rgb, doll) = dwell::dollhouse_picture(world, LevelId(level), &config, threads)?;
        Ok((rgb, (doll.view.camera.height(), doll.view.camera.width())))
    })?;
    picture(py, rgb, size)
}

fn picture(py: Python<'_>, rgb: Vec<u8>, (height, width): (u32, u32)) -> PyResult<RgbArray<'_>> {
    rgb.into_pyarray(py)
        .reshape([height as usize, width as usize, 3])
}

/// Names and doors of a storey's plan.
#[pyfunction]
pub(crate) fn floor_plan(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    level: u32,
) -> PyResult<PyValue> {
    world.get().read_interruptible(py, |running| {
        PyValue::of(&dwell::floor_plan(running.world, LevelId(level)))
    })
}

/// Lamps, sources of sound, joints and boxes as they stand.
#[pyfunction]
pub(crate) fn fixtures(py: Python<'_>, world: &Bound<'_, PyWorld>) -> PyResult<PyValue> {
    world.get().read_interruptible(py, |running| {
        PyValue::of(&dwell::scene_overlay(running.world)?)
    })
}

/// The triangles of each room and material as they stand, a mapping each.
#[pyfunction]
pub(crate) fn surfaces<'py>(
    py: Python<'py>,
    world: &Bound<'py, PyWorld>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let (house, surfaces) = world.get().read_interruptible(py, |running| {
        let world = &running.world;
        Ok((world.house().clone(), dwell::room_surfaces(world)))
    })?;
    let mapping = |surface: dwell::RoomMaterialMesh| {
        let row = PyDict::new(py);
        let material = &house.materials[surface.material];
        let room = surface.room.map(|room| house.rooms[room].name.as_str());
        let [r, g, b] = material.base_color;
        row.set_item("room", room)?;
        row.set_item("ceiling", surface.ceiling)?;
        row.set_item("material", &material.name)?;
        row.set_item("color", [r, g, b, material.opacity])?;
        row.set_item("texture", material.texture.map(|texture| texture.0))?;
        let vectors =
            |all: Vec<Vec3>| -> Vec<f32> { all.into_iter().flat_map(|p| p.to_array()).collect() };
        let uvs: Vec<f32> = surface.uvs.into_iter().flat_map(|p| p.to_array()).collect();
        let triangles: Vec<u32> = surface.triangles.into_iter().flatten().collect();
        let rows = |parts: usize, numbers: Vec<f32>| {
            let count = numbers.len() / parts;
            numbers.into_pyarray(py).reshape([count, parts])
        };
        row.set_item("positions", rows(3, vectors(surface.positions))?)?;
        row.set_item("normals", rows(3, vectors(surface.normals))?)?;
        row.set_item("uvs", rows(2, uvs)?)?;
        let count = triangles.len() / 3;
        row.set_item("triangles", triangles.into_pyarray(py).reshape([count, 3])?)?;
        Ok(row)
    };
    surfaces.into_iter().map(mapping).collect()
}

/// A texture's image, sRGB with opacity. Shape (height, width, 4).
#[pyfunction]
pub(crate) fn texture<'py>(
    py: Python<'py>,
    house: &Bound<'py, PyHouse>,
    texture: u32,
) -> PyResult<RgbArray<'py>> {
    let house: &House = house.get().engines.house();
    let Some(found) = house.textures.get(dwell_scene::TextureId(texture)) else {
        let count = house.textures.len();
        let fault = PyFault::Config(format!("no texture {texture}; there are {count}"));
        return Err(crate::errors::to_python(fault));
    };
    let (height, width) = (found.height as usize, found.width as usize);
    let rgba = py.engine(|| Ok::<_, PyFault>(found.rgba().to_vec()))?;
    rgba.into_pyarray(py).reshape([height, width, 4])
}
