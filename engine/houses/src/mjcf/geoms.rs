//! Geoms: visual shapes, collision shapes, and masses.

use glam::{DMat3, DVec3, Quat, Vec3};
use mjcf_rs::Model;
use mjcf_rs::body::{Body, Geom, GeomType};

use super::read::pose;
use crate::data_root::parent_folder;
use crate::error::HousesError;
use crate::report::{FileLocation, LoadReport};
use crate::robot::{LinkInertia, LinkShape, RobotFileLoader, ShapeGeometry};
use crate::unit_factors::unit_factors;
use crate::warning_kind::WarningKind;
use dwell_scene::{Pose, Texture};
use std::sync::Arc;

/// The density of a geom that states none, kg/m³ (MuJoCo's).
const USUAL_DENSITY_KG_M3: f64 = 1000.0;
/// Half of the edges of a plane without end, m.
const PLANE_M: f32 = 20.0;
/// Half of the thickness of the box that stands for a plane, m.
const PLANE_DEPTH_M: f32 = 0.05;
/// Group from which on geoms are drawn for debugging only, by MuJoCo's custom.
const HIDDEN_GROUP: i32 = 3;

/// A geom of a body.
pub(super) struct BodyGeom {
    pub(super) shape: LinkShape,
    /// Its name in the file.
    pub(super) name: Option<String>,
    pub(super) has_contacts: bool,
    pub(super) is_visible: bool,
    /// True for a plane, which is held as a flat box.
    pub(super) is_plane: bool,
    /// Mass as stated, kg.
    mass: Option<f64>,
    /// Density, kg/m³.
    density: f64,
}

/// The geoms of a body that are solid.
pub(super) fn body_geoms(
    model: &Model,
    body: &Body,
    files: &mut RobotFileLoader,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Result<Vec<BodyGeom>, HousesError> {
    let of_world = std::ptr::eq(body, &raw const model.bodies[0].body);
    let mut pieces = Vec::with_capacity(body.geoms.len());
    for (k, geom) in body.geoms.iter().enumerate() {
        let name = geom.name.clone().unwrap_or(k.to_string());
        let at = at.field(format_args!("geom[{name}]"));
        if let Some(shape) = shape(model, geom, of_world, files, &at, report)? {
            let touches = is_collidable(geom);
            pieces.push(BodyGeom {
                shape,
                name: geom.name.clone(),
                is_plane: geom.type_ == GeomType::Plane,
                has_contacts: touches,
                is_visible: geom.group < HIDDEN_GROUP || !touches,
                mass: geom.mass,
                density: geom.density.unwrap_or(USUAL_DENSITY_KG_M3),
            });
        }
    }
    Ok(pieces)
}

fn is_collidable(geom: &Geom) -> bool {
    geom.contype != 0 || geom.conaffinity != 0
}

fn shape(
    model: &Model,
    geom: &Geom,
    of_world: bool,
    files: &mut RobotFileLoader,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Result<Option<LinkShape>, HousesError> {
    let [a, b, c] = geom.size.map(|x| x as f32);
    let mut link_from_shape = pose(&geom.pose);
    let mut half_length = b;
    if let Some([x, y, z, u, v, w]) = geom.fromto {
        let (from, to) = (DVec3::new(x, y, z), DVec3::new(u, v, w));
        let way = to - from;
        half_length = 0.5 * way.length() as f32;
        let along = way.normalize_or(DVec3::Z).as_vec3();
        let middle = (0.5 * (from + to)).as_vec3();
        link_from_shape = Pose::new(middle, Quat::from_rotation_arc(Vec3::Z, along));
    }
    let solid = match geom.type_ {
        GeomType::Box => ShapeGeometry::Cuboid {
            half: Vec3::new(a, b, c),
        },
        GeomType::Sphere => ShapeGeometry::Ball { radius: a },
        GeomType::Cylinder => ShapeGeometry::Cylinder {
            half_height: half_length,
            radius: a,
        },
        GeomType::Capsule => ShapeGeometry::Capsule {
            half_height: half_length,
            radius: a,
        },
        GeomType::Ellipsoid => ShapeGeometry::Ellipsoid {
            radii: Vec3::new(a, b, c),
        },
        GeomType::Mesh => {
            let at = at.field("mesh");
            let name = geom.mesh.as_deref().unwrap_or("");
            let found = || HousesError::Field {
                at: at.clone(),
                expected: "the name of a mesh of <asset> with a file",
                found: format!("{name:?}"),
            };
            let asset = model.assets.mesh(name).ok_or_else(found)?;
            let file = asset.file.as_deref().ok_or_else(found)?;
            let inside = match (&model.compiler.mesh_dir, &model.compiler.asset_dir) {
                (Some(folder), _) | (None, Some(folder)) => format!("{folder}/{file}"),
                (None, None) => file.to_owned(),
            };
            let path = files.resolve(parent_folder(&files.file), &inside, &at)?;
            link_from_shape = link_from_shape * pose(&asset.refpose).inverse();
            ShapeGeometry::Mesh {
                mesh: files.mesh(&path, &at, report)?,
                scale: DVec3::from_array(asset.scale).as_vec3(),
            }
        }
        // A plane of the world; a robot has none.
        GeomType::Plane if of_world => {
            let size = |x: f32| if x > 0.0 { x } else { PLANE_M };
            let half = Vec3::new(size(a), size(b), PLANE_DEPTH_M);
            link_from_shape = link_from_shape * Pose::from_position(Vec3::NEG_Z * PLANE_DEPTH_M);
            ShapeGeometry::Cuboid { half }
        }
        GeomType::Plane | GeomType::Hfield | GeomType::Sdf => {
            let what = format!("a geom of the type {:?} is not read on a robot", geom.type_);
            report.warn(at.clone(), WarningKind::Simplified { what });
            return Ok(None);
        }
    };
    let material = geom.material.clone().unwrap_or_default();
    let asset = model.assets.material(&material);
    let rgba = geom.rgba.or(asset.and_then(|asset| asset.rgba));
    let image = match &solid {
        ShapeGeometry::Mesh { mesh, .. } if !mesh.uvs.is_empty() => {
            let name = asset.and_then(|asset| asset.texture.as_deref());
            name.and_then(|name| image(model, name, files, at, report))
        }
        _ => None,
    };
    Ok(Some(LinkShape {
        link_from_shape,
        geometry: solid,
        rgba: rgba.map(|rgba| unit_factors(rgba, &at.field("rgba"), report)),
        material,
        image,
    }))
}

/// The image of a texture that lies flat on meshes; cubes, skies and those without a file have none.
fn image(
    model: &Model,
    name: &str,
    files: &mut RobotFileLoader,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Option<Arc<Texture>> {
    let texture = model.assets.texture(name)?;
    if texture.type_.as_deref() != Some("2d") {
        return None;
    }
    let file = texture.file.as_deref()?;
    let inside = match (&model.compiler.texture_dir, &model.compiler.asset_dir) {
        (Some(folder), _) | (None, Some(folder)) => format!("{folder}/{file}"),
        (None, None) => file.to_owned(),
    };
    let at = at.field("material.texture");
    match files.resolve(parent_folder(&files.file), &inside, &at) {
        Ok(path) => files.image(&path, &at, report),
        Err(error) => {
            let (path, reason) = (inside, error.to_string());
            report.warn(at, WarningKind::UnreadableTexture { path, reason });
            None
        }
    }
}

/// The mass of a body from its geoms; `None` for a body without one.
pub(super) fn mass_of_geoms(
    pieces: &[BodyGeom],
    at: &FileLocation,
) -> Result<Option<LinkInertia>, HousesError> {
    let mut lumps: Vec<LinkInertia> = Vec::new();
    for piece in pieces {
        let (volume, center, spread) = volume_properties(&piece.shape);
        let mass = piece.mass.unwrap_or(piece.density * volume);
        if !(mass.is_finite() && mass >= 0.0) {
            return Err(HousesError::Field {
                at: at.field("geom.mass"),
                expected: "a mass of at least 0",
                found: mass.to_string(),
            });
        }
        if mass > 0.0 && volume > 0.0 {
            lumps.push(LinkInertia {
                mass,
                center,
                inertia: spread * (mass / volume),
            });
        }
    }
    Ok(LinkInertia::sum(&lumps))
}

/// Volume, centre, and inertia about it at density 1, of a shape's surface (by tetrahedra to the origin).
///
/// # Source
/// B. Mirtich, Fast and Accurate Computation of Polyhedral Mass Properties (1996); here the closed form for tetrahedra.
fn volume_properties(shape: &LinkShape) -> (f64, DVec3, DMat3) {
    let mesh = shape.geometry.surface();
    let turn = DMat3::from_quat(shape.link_from_shape.rotation.as_dquat().normalize());
    let at = shape.link_from_shape.position.as_dvec3();
    let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for k in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(k).map(Vec3::as_dvec3);
        let six = a.dot(b.cross(c));
        volume += six / 6.0;
        first += (a + b + c) * (six / 24.0);
        let sum = a + b + c;
        for (p, weight) in [(a, 1.0), (b, 1.0), (c, 1.0), (sum, 1.0)] {
            second += DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (weight * six / 120.0);
        }
    }
    if volume <= 0.0 {
        return (0.0, at, DMat3::ZERO);
    }
    let center = first / volume;
    let about =
        second - DMat3::from_cols(center * center.x, center * center.y, center * center.z) * volume;
    let trace = about.x_axis.x + about.y_axis.y + about.z_axis.z;
    let inertia = DMat3::from_diagonal(DVec3::splat(trace)) - about;
    (
        volume,
        at + turn * center,
        turn * inertia * turn.transpose(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_its_moments() {
        let shape = LinkShape {
            link_from_shape: Pose::from_position(Vec3::new(1.0, 2.0, 3.0)),
            geometry: ShapeGeometry::Cuboid {
                half: Vec3::new(0.1, 0.2, 0.3),
            },
            rgba: None,
            material: String::new(),
            image: None,
        };
        let (volume, center, inertia) = volume_properties(&shape);
        assert!((volume - 0.048).abs() < 1e-6);
        assert!((center - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-6);
        let expected = 0.048 / 3.0 * DVec3::new(0.04 + 0.09, 0.01 + 0.09, 0.01 + 0.04);
        for k in 0..3 {
            assert!(
                (inertia.col(k)[k] - expected[k]).abs() < 1e-7,
                "{inertia:?}"
            );
        }
    }
}
