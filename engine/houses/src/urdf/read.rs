//! Conversion of the file into a [`Robot`].

use std::collections::BTreeMap;
use std::path::Path;

use dwell_scene::{Pose, Servo, interrupt};
use glam::{DMat3, DVec3, EulerRot, Quat, Vec3};
use roxmltree::Node;

use crate::data_root::parent_folder;
use crate::error::HousesError;
use crate::limits::MAX_NODES;
use crate::report::{FileLocation, LoadReport};
use crate::robot::{
    LinkInertia, LinkShape, Robot, RobotFileLoader, RobotJoint, RobotJointKind, RobotLink,
    ShapeGeometry, check,
};
use crate::unit_factors::unit_factors;
use crate::warning_kind::WarningKind;
use crate::xml::{self, LineIndex};

/// Position error at which a position motor that states no gains applies full effort, rad or m: URDF names no gains, so they come
/// from the limits of effort and velocity.
const FULL_EFFORT_AT: f32 = 0.02;

/// Reads a URDF file.
///
/// # Errors
/// Those of [`open_robot`](crate::open_robot).
pub(crate) fn read(path: &Path, report: &mut LoadReport) -> Result<Robot, HousesError> {
    let files = RobotFileLoader::of_file(path)?;
    let text = files.text()?;
    let at = FileLocation::file(&files.file);
    let document = xml::parse(&text, &at)?;
    let root = document.root_element();
    if root.tag_name().name() != "robot" {
        return Err(HousesError::Field {
            at,
            expected: "a <robot>",
            found: format!("<{}>", root.tag_name().name()),
        });
    }
    let mut reader = UrdfReader {
        at,
        lines: LineIndex::new(&document),
        files,
        report,
        colours: BTreeMap::new(),
    };
    for material in named(root, "material") {
        reader.material(material)?;
    }
    let mut links = Vec::new();
    let mut places = BTreeMap::new();
    for node in named(root, "link") {
        interrupt::unwind_if_cancelled();
        let link = reader.link(node)?;
        places.insert(link.name.clone(), links.len());
        links.push(link);
        if links.len() > MAX_NODES {
            break;
        }
    }
    let mut joints = Vec::new();
    for node in named(root, "joint") {
        interrupt::unwind_if_cancelled();
        joints.push(reader.joint(node, &places)?);
    }
    check(Robot {
        name: root.attribute("name").unwrap_or("robot").to_owned(),
        source: reader.files.file.clone(),
        format: "urdf",
        links,
        joints,
        fixed_base: true,
    })
}

fn named<'a, 'b>(node: Node<'a, 'b>, name: &'static str) -> impl Iterator<Item = Node<'a, 'b>> {
    node.children()
        .filter(move |child| child.tag_name().name() == name)
}

fn first<'a, 'b>(node: Node<'a, 'b>, name: &'static str) -> Option<Node<'a, 'b>> {
    named(node, name).next()
}

struct UrdfReader<'r> {
    at: FileLocation,
    lines: LineIndex,
    files: RobotFileLoader,
    report: &'r mut LoadReport,
    colours: BTreeMap<String, [f32; 4]>,
}

impl UrdfReader<'_> {
    fn fault<T>(
        &self,
        node: Node<'_, '_>,
        field: &str,
        expected: &'static str,
        found: impl Into<String>,
    ) -> Result<T, HousesError> {
        Err(HousesError::Field {
            at: self.place(node).field(field),
            expected,
            found: found.into(),
        })
    }

    /// The line of a node, and the link or joint it is in: `arm.urdf:12: link[hand].visual`.
    fn place(&self, node: Node<'_, '_>) -> FileLocation {
        let line = self.lines.line(node);
        let mut words: Vec<String> = node
            .ancestors()
            .filter(|node| node.is_element() && node.tag_name().name() != "robot")
            .map(|node| {
                let tag = node.tag_name().name();
                node.attribute("name")
                    .map_or_else(|| tag.to_owned(), |name| format!("{tag}[{name}]"))
            })
            .collect();
        words.reverse();
        let at = self.at.line(line);
        if words.is_empty() {
            at
        } else {
            at.field(words.join("."))
        }
    }

    fn numbers<const N: usize>(
        &self,
        node: Node<'_, '_>,
        field: &str,
        usual: [f64; N],
    ) -> Result<[f64; N], HousesError> {
        let Some(text) = node.attribute(field) else {
            return Ok(usual);
        };
        let found: Option<Vec<f64>> = text
            .split_whitespace()
            .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
            .collect();
        if let Some(Ok(numbers)) = found.map(<[f64; N]>::try_from) {
            return Ok(numbers);
        }
        let expected = match N {
            1 => "a finite number",
            3 => "3 finite numbers",
            _ => "4 finite numbers",
        };
        self.fault(node, field, expected, format!("{text:?}"))
    }

    fn needed(&self, node: Node<'_, '_>, field: &str) -> Result<f64, HousesError> {
        if node.attribute(field).is_none() {
            return self.fault(node, field, "a finite number", "nothing");
        }
        Ok(self.numbers(node, field, [0.0])?[0])
    }

    fn name(&self, node: Node<'_, '_>) -> Result<String, HousesError> {
        match node.attribute("name") {
            Some(name) => Ok(name.to_owned()),
            None => self.fault(node, "name", "a name", "nothing"),
        }
    }

    /// `<origin xyz rpy>`: turns about the fixed axes x, y, z, in that order.
    fn origin(&self, node: Node<'_, '_>) -> Result<Pose, HousesError> {
        let Some(origin) = first(node, "origin") else {
            return Ok(Pose::IDENTITY);
        };
        let xyz = self.numbers(origin, "xyz", [0.0; 3])?;
        let [roll, pitch, yaw] = self.numbers(origin, "rpy", [0.0; 3])?.map(|x| x as f32);
        let rotation = Quat::from_euler(EulerRot::ZYX, yaw, pitch, roll);
        Ok(Pose::new(DVec3::from_array(xyz).as_vec3(), rotation))
    }

    fn material(&mut self, node: Node<'_, '_>) -> Result<(), HousesError> {
        if let (Some(name), Some(color)) = (node.attribute("name"), first(node, "color")) {
            let rgba = self.numbers(color, "rgba", [0.8, 0.8, 0.8, 1.0])?;
            let at = self.place(color).field("rgba");
            let rgba = unit_factors(rgba, &at, self.report);
            self.colours.insert(name.to_owned(), rgba);
        }
        if first(node, "texture").is_some() {
            let what = "textures of robots are not read; the plain colour is used".to_owned();
            let at = self.place(node);
            self.report.warn(at, WarningKind::Simplified { what });
        }
        Ok(())
    }

    fn link(&mut self, node: Node<'_, '_>) -> Result<RobotLink, HousesError> {
        let weight = match first(node, "inertial") {
            Some(inertial) => Some(self.link_inertia(inertial)?),
            None => None,
        };
        let mut shapes = [Vec::new(), Vec::new()];
        for (list, tag) in shapes.iter_mut().zip(["visual", "collision"]) {
            for shape in named(node, tag) {
                list.push(self.shape(shape)?);
            }
        }
        let [visuals, collisions] = shapes;
        Ok(RobotLink {
            name: self.name(node)?,
            inertial: weight,
            visuals,
            collisions,
        })
    }

    fn link_inertia(&mut self, node: Node<'_, '_>) -> Result<LinkInertia, HousesError> {
        let Some(mass) = first(node, "mass") else {
            return self.fault(node, "mass", "a <mass>", "nothing");
        };
        let value = self.needed(mass, "value")?;
        if !(1e-6..=1e6).contains(&value) {
            return self.fault(mass, "value", "a mass of 1e-6 to 1e6 kg", value.to_string());
        }
        let Some(inertia) = first(node, "inertia") else {
            return self.fault(node, "inertia", "an <inertia>", "nothing");
        };
        let m = |field| self.needed(inertia, field);
        let off = |field| Ok::<f64, HousesError>(self.numbers(inertia, field, [0.0])?[0]);
        let (xx, yy, zz) = (m("ixx")?, m("iyy")?, m("izz")?);
        let (xy, xz, yz) = (off("ixy")?, off("ixz")?, off("iyz")?);
        let local = DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
        let origin = self.origin(node)?;
        let turn = DMat3::from_quat(origin.rotation.as_dquat().normalize());
        let weight = LinkInertia {
            mass: value,
            center: origin.position.as_dvec3(),
            inertia: turn * local * turn.transpose(),
        };
        weight.report_impossible(&self.place(inertia), self.report);
        Ok(weight)
    }

    fn shape(&mut self, node: Node<'_, '_>) -> Result<LinkShape, HousesError> {
        let link_from_shape = self.origin(node)?;
        let Some(geometry) = first(node, "geometry") else {
            return self.fault(node, "geometry", "a <geometry>", "nothing");
        };
        let Some(form) = geometry.children().find(Node::is_element) else {
            return self.fault(
                geometry,
                "shape",
                "box, cylinder, sphere or mesh",
                "nothing",
            );
        };
        let solid = match form.tag_name().name() {
            "box" => {
                let size = self.numbers(form, "size", [0.0; 3])?;
                ShapeGeometry::Cuboid {
                    half: 0.5 * DVec3::from_array(size).as_vec3(),
                }
            }
            "sphere" => ShapeGeometry::Ball {
                radius: self.needed(form, "radius")? as f32,
            },
            kind @ ("cylinder" | "capsule") => {
                let radius = self.needed(form, "radius")? as f32;
                let half_height = 0.5 * self.needed(form, "length")? as f32;
                if kind == "cylinder" {
                    ShapeGeometry::Cylinder {
                        half_height,
                        radius,
                    }
                } else {
                    ShapeGeometry::Capsule {
                        half_height,
                        radius,
                    }
                }
            }
            "mesh" => {
                let at = self.place(form).field("filename");
                let Some(name) = form.attribute("filename") else {
                    return self.fault(form, "filename", "a path", "nothing");
                };
                let local = ["package://", "file://"];
                if name.contains("://") && !local.iter().any(|start| name.starts_with(start)) {
                    let expected = "a path, or package://NAME/PATH";
                    return self.fault(form, "filename", expected, format!("{name:?}"));
                }
                let scale = self.numbers(form, "scale", [1.0; 3])?;
                let folder = parent_folder(&self.files.file).to_owned();
                let path = self.files.resolve(&folder, name, &at)?;
                ShapeGeometry::Mesh {
                    mesh: self.files.mesh(&path, &at, self.report)?,
                    scale: DVec3::from_array(scale).as_vec3(),
                }
            }
            other => {
                let expected = "box, cylinder, sphere, capsule or mesh";
                return self.fault(geometry, "shape", expected, format!("<{other}>"));
            }
        };
        let mut shape = LinkShape {
            link_from_shape,
            geometry: solid,
            rgba: None,
            material: String::new(),
            image: None,
        };
        if let Some(material) = first(node, "material") {
            self.material(material)?;
            let name = material.attribute("name").unwrap_or("");
            shape.rgba = self.colours.get(name).copied();
            name.clone_into(&mut shape.material);
        }
        Ok(shape)
    }

    fn joint(
        &mut self,
        node: Node<'_, '_>,
        places: &BTreeMap<String, usize>,
    ) -> Result<RobotJoint, HousesError> {
        let link = |tag: &'static str| {
            let name = first(node, tag).and_then(|end| end.attribute("link"));
            if let Some(place) = name.and_then(|name| places.get(name)) {
                return Ok(*place);
            }
            let found = name.map_or_else(|| "none".to_owned(), |name| format!("{name:?}"));
            self.fault(node, tag, "the name of a link", found)
        };
        let (parent, child) = (link("parent")?, link("child")?);
        let kind = node.attribute("type").unwrap_or("");
        let (motion, bounded) = match kind {
            "fixed" => (RobotJointKind::Fixed, false),
            "revolute" => (RobotJointKind::Hinge, true),
            "continuous" => (RobotJointKind::Hinge, false),
            "prismatic" => (RobotJointKind::Slide, true),
            _ => {
                let expected = "fixed, revolute, continuous or prismatic";
                return self.fault(node, "type", expected, format!("{kind:?}"));
            }
        };
        let axis = match first(node, "axis") {
            Some(axis) => {
                let xyz = DVec3::from_array(self.numbers(axis, "xyz", [1.0, 0.0, 0.0])?);
                match xyz.try_normalize() {
                    Some(axis) => axis.as_vec3(),
                    None => return self.fault(axis, "xyz", "a direction", format!("{xyz}")),
                }
            }
            None => Vec3::X,
        };
        let limit = first(node, "limit");
        let of_limit = |field: &str| match limit {
            Some(limit) => Ok(Some(self.numbers(limit, field, [0.0])?[0] as f32)),
            None => Ok::<_, HousesError>(None),
        };
        if bounded && limit.is_none() {
            return self.fault(node, "limit", "a <limit>", "nothing");
        }
        let limits = match (bounded, of_limit("lower")?, of_limit("upper")?) {
            (true, Some(low), Some(high)) => Some([low, high]),
            _ => None,
        };
        let (effort, velocity) = (of_limit("effort")?, of_limit("velocity")?);
        for (field, found) in [("effort", effort), ("velocity", velocity)] {
            if let (Some(limit), Some(found)) = (limit, found.filter(|x| *x < 0.0)) {
                return self.fault(limit, field, "a number from 0 up", found.to_string());
            }
        }
        let dynamics = first(node, "dynamics");
        let of_dynamics = |field: &str| match dynamics {
            Some(dynamics) => Ok(self.numbers(dynamics, field, [0.0])?[0] as f32),
            None => Ok::<_, HousesError>(0.0),
        };
        let mimic = match first(node, "mimic") {
            Some(mimic) => {
                let multiplier = self.numbers(mimic, "multiplier", [1.0])?[0] as f32;
                let offset = self.numbers(mimic, "offset", [0.0])?[0] as f32;
                let leader = mimic.attribute("joint").unwrap_or("").to_owned();
                Some((leader, multiplier, offset))
            }
            None => None,
        };
        let moves = motion != RobotJointKind::Fixed && mimic.is_none();
        let servo = effort
            .filter(|effort| moves && *effort > 0.0)
            .map(|effort| servo(effort, velocity.unwrap_or(0.0)));
        Ok(RobotJoint {
            name: self.name(node)?,
            parent,
            child,
            kind: motion,
            parent_from_joint: self.origin(node)?,
            child_from_joint: Pose::IDENTITY,
            axis,
            limits,
            initial: 0.0,
            friction: of_dynamics("friction")?,
            damping: of_dynamics("damping")?,
            armature: 0.0,
            servo,
            mimic,
        })
    }
}

/// Returns the motor of a joint with an effort limit. URDF knows no gains: stiff enough for full effort at 0.02 rad (or m) off,
/// damped as strongly as a tenth of a second of that, and carrying weight by feed-forward, as controllers of arms do.
fn servo(effort: f32, velocity: f32) -> Servo {
    let stiffness = effort / FULL_EFFORT_AT;
    Servo {
        stiffness,
        damping: 0.1 * stiffness,
        max_effort: effort,
        velocity_gain: 0.1 * stiffness,
        max_velocity: (velocity > 0.0).then_some(velocity),
        gear: 1.0,
        feed_forward: true,
    }
}
