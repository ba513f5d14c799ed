//! Robots from URDF and MJCF: what gets into a house, and what is refused.
#![expect(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use dwell_houses::{HousesError, Robot, open, open_robot, with_robot};
use dwell_scene::{House, JointKind, Mobility, Pose, ShoeboxMaterials, State, interrupt};
use glam::{DQuat, DVec3, Quat, Vec3};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const URDF: &str = include_str!("arm.urdf");
const MJCF: &str = include_str!("arm.xml");

/// A box of 20 mm by 80 mm by 40 mm in millimetres, as a text STL file.
fn palm() -> String {
    let mesh = dwell_scene::Mesh::cuboid(Vec3::new(0.0, -40.0, -20.0), Vec3::new(20.0, 40.0, 20.0));
    let mut text = "solid palm\n".to_owned();
    for k in 0..mesh.triangles.len() {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for p in mesh.corners(k) {
            text += &[
                "vertex",
                &p.x.to_string(),
                &p.y.to_string(),
                &p.z.to_string(),
            ]
            .join(" ");
            text.push('\n');
        }
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid palm\n"
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn with(name: &str, text: &str) -> (Self, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("palm.stl"), palm()).unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        (Self(folder), path)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }
}

fn robot(name: &str, text: &str) -> Robot {
    let (_folder, path) = Folder::with(name, text);
    let (robot, report) = open_robot(&path).unwrap();
    assert!(report.is_empty(), "{report}");
    robot
}

fn room() -> House {
    House::shoebox([4.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap()
}

/// Independent forward kinematics of the arm, in its file's axes (+Z up): the left finger's origin on the base.
fn finger(turn: f64, elbow: f64, slide: f64) -> DVec3 {
    let palm = DVec3::new(0.22, 0.03 - slide, 0.0);
    let fore = DVec3::new(0.0, 0.0, 0.3) + DQuat::from_rotation_y(elbow) * palm;
    DVec3::new(0.0, 0.0, 0.1) + DQuat::from_rotation_z(turn) * fore
}

/// The file's axes in the house: forward +X is -Z, left +Y is -X, up +Z is +Y.
fn ours(p: DVec3) -> Vec3 {
    DVec3::new(-p.y, p.z, -p.x).as_vec3()
}

#[test]
fn an_arm_stands_in_a_house_as_its_file_says() {
    for (name, text) in [("arm.urdf", URDF), ("arm.xml", MJCF)] {
        let arm = robot(name, text);
        let base = Pose::new(Vec3::new(1.0, 0.5, 2.0), Quat::from_rotation_y(0.7));
        let before = room();
        let house = with_robot(&before, &arm, "helper", base, true).unwrap();
        assert!(std::sync::Arc::ptr_eq(
            &before.meshes.as_slice()[0],
            &house.meshes.as_slice()[0]
        ));
        let object = &house.objects[house.object_named("helper").unwrap()];
        assert_eq!(object.mobility, Mobility::Articulated);
        let parts: Vec<_> = object.parts().collect();
        let names: Vec<_> = parts
            .iter()
            .map(|part| house.parts[*part].name.as_str())
            .collect();
        assert_eq!(names, ["base", "upper", "fore", "left", "right"], "{name}");
        assert!(house.parts[parts[0]].fixed);
        let joints: Vec<_> = house
            .joints_of(house.object_named("helper").unwrap())
            .collect();
        let kinds = joints.iter().map(|joint| house.joints[*joint].kind);
        let expected = [
            JointKind::Hinge,
            JointKind::Hinge,
            JointKind::Slide,
            JointKind::Slide,
        ];
        assert!(kinds.eq(expected));
        assert_eq!(house.joints[joints[0]].limits, None);
        let [low, high] = house.joints[joints[1]].limits.unwrap();
        assert!((low + 1.5).abs() < 1e-6 && (high - 1.5).abs() < 1e-6);
        let mimic = house.joints[joints[3]].mimic.unwrap();
        assert_eq!((mimic.leader, mimic.multiplier), (joints[2], 1.0));
        assert_eq!(house.joints[joints[0]].friction, 0.1);
        assert_eq!(house.joints[joints[0]].servo.unwrap().max_effort, 40.0);
        // The palm is fixed to the fore arm: mass and inertia of both (steel rules: parallel axes by hand).
        let fore = &house.parts[parts[2]];
        assert!((fore.mass_kg.unwrap() - 1.2).abs() < 1e-6);
        let center = fore.inertial.unwrap().part_from_principal.position;
        assert!(
            (center - Vec3::new((0.1 + 0.2 * 0.2) / 1.2, 0.0, 0.0)).length() < 1e-5,
            "{center}"
        );
        // Every pose by independent kinematics.
        let state = State::new(&house);
        for (turn, elbow, slide) in [(0.0, 0.0, 0.0), (2.5, -1.1, 0.01), (-0.4, 0.9, 0.025)] {
            let mut pose = state.part_pose[parts[0]];
            for (joint, q) in joints.iter().zip([turn, elbow, slide]) {
                pose = state.world_from_child(&house, *joint, &pose, q as f32);
            }
            let expected = base.transform_point(ours(finger(turn, elbow, slide)));
            assert!(
                (pose.position - expected).length() < 2e-6,
                "{name}: {} {expected}",
                pose.position
            );
        }
        let start = base.transform_point(ours(finger(0.0, 0.0, 0.0)));
        assert!((state.part_pose[parts[3]].position - start).length() < 2e-6);
    }
}

#[test]
fn a_robot_opens_alone_on_a_ground() {
    for (name, text) in [("arm.urdf", URDF), ("arm.xml", MJCF)] {
        let (_folder, path) = Folder::with(name, text);
        let (house, _) = open(&path.to_string_lossy()).unwrap();
        assert_eq!((house.objects.len(), house.joints.len()), (1, 4));
        assert_eq!(house.name, "arm");
        let geometry = house.object_bounds(&State::new(&house), dwell_scene::ObjectId(0));
        assert!(
            geometry.min.y.abs() < 1e-5 && (geometry.max.y - 0.425).abs() < 1e-5,
            "{geometry:?}"
        );
    }
}

/// Links of a box each, every joint on the link before it.
fn chain(links: usize) -> String {
    let mass = r#"<mass value="1"/><inertia ixx="1" iyy="1" izz="1"/>"#;
    let shape = r#"<visual><geometry><box size=".1 .1 .1"/></geometry></visual>"#;
    let mut text = "<robot name='chain'>\n".to_owned();
    for k in 0..links {
        writeln!(
            text,
            "<link name='l{k}'><inertial>{mass}</inertial>{shape}</link>"
        )
        .unwrap();
    }
    for k in 1..links {
        let ends = format!("<parent link='l{}'/><child link='l{k}'/>", k - 1);
        writeln!(text, "<joint name='j{k}' type='continuous'>{ends}</joint>").unwrap();
    }
    text + "</robot>\n"
}

#[test]
fn a_long_chain_opens_and_can_be_stopped_on_the_way() {
    let (_folder, path) = Folder::with("chain.urdf", &chain(20_000));
    let (house, report) = open(&path.to_string_lossy()).unwrap();
    assert_eq!((house.parts.len(), house.joints.len()), (20_000, 19_999));
    assert!(report.is_empty(), "{report}");
    // Of one colour, so of one material.
    assert_eq!(house.materials.len(), 2);
    let stopped = interrupt::interruptible(|| true, || open_robot(&path).is_ok());
    assert!(stopped.is_err(), "{stopped:?}");
}

#[test]
fn a_name_that_is_taken_is_refused() {
    let arm = robot("arm.urdf", URDF);
    let house = with_robot(&room(), &arm, "helper", Pose::IDENTITY, true).unwrap();
    let error = with_robot(&house, &arm, "helper", Pose::IDENTITY, false).unwrap_err();
    assert!(matches!(error, HousesError::Scene { .. }), "{error}");
    let two = with_robot(&house, &arm, "other", Pose::from_position(Vec3::ONE), false).unwrap();
    assert_eq!(two.joints.len(), 8);
    assert_eq!(
        two.objects[two.object_named("other").unwrap()].mobility,
        Mobility::Movable
    );
}

fn fault(name: &str, text: &str) -> String {
    let (folder, path) = Folder::with(name, text);
    std::fs::write(folder.path().join("palm.dae"), "<COLLADA/>").unwrap();
    open_robot(&path).unwrap_err().to_string()
}

/// The bad input of issue 3: an error with file, node and field, each.
#[test]
fn bad_robots_are_refused_with_file_node_and_field() {
    let mut wrong: Vec<String> = Vec::new();
    let cases = [
        (
            r#"<parent link="upper"/>"#,
            r#"<parent link="fore"/>"#,
            vec!["link", "loop"],
        ),
        (
            r#"<child link="palm"/>"#,
            r#"<child link="upper"/>"#,
            vec!["joint[mount].child", "loop"],
        ),
        (
            r#"<mass value="1.5"/>"#,
            r#"<mass value="0"/>"#,
            vec!["arm.urdf:11", "link[upper].inertial.mass.value", "mass"],
        ),
        (
            r#"<mass value="1.5"/>"#,
            r#"<mass value="nan"/>"#,
            vec!["link[upper].inertial.mass.value", "finite"],
        ),
        (
            "package://arm/palm.stl",
            "http://127.0.0.1/palm.stl",
            vec![
                "link[palm].visual.geometry.mesh.filename",
                "expected a path, or package://NAME/PATH",
                "http://127.0.0.1/palm.stl",
            ],
        ),
        (
            "package://arm/palm.stl",
            "package://arm/plam.stl",
            vec!["link[palm].visual.geometry.mesh.filename", "plam.stl"],
        ),
        (
            "package://arm/palm.stl",
            "../../secret.stl",
            vec![
                "link[palm].visual.geometry.mesh.filename",
                "leaves the folder",
            ],
        ),
        (
            "package://arm/palm.stl",
            "package://../../etc/secret.stl",
            vec![
                "link[palm].visual.geometry.mesh.filename",
                "leaves the folder",
            ],
        ),
        (
            "package://arm/palm.stl",
            "palm.dae",
            vec!["link[palm].visual.geometry.mesh.filename", ".stl, .obj"],
        ),
        (
            r#"<origin xyz="0 0 0.3" rpy="0 0 0"/>"#,
            r#"<origin xyz="0 inf 0.3"/>"#,
            vec!["joint[elbow].origin.xyz", "finite"],
        ),
        (
            r#"<axis xyz="0 1 0"/>"#,
            r#"<axis xyz="0 0 0"/>"#,
            vec!["axis.xyz", "direction"],
        ),
        (
            r#"type="revolute""#,
            r#"type="floating""#,
            vec!["joint[elbow].type", "floating"],
        ),
        (
            r#"lower="-1.5""#,
            r#"lower="2""#,
            vec!["joint[elbow].limit", "lower"],
        ),
        (
            r#"<mimic joint="left_slide"/>"#,
            r#"<mimic joint="none"/>"#,
            vec!["mimic.joint", "none"],
        ),
        (
            r#"<mimic joint="left_slide"/>"#,
            r#"<mimic joint="left_slide" multiplier="1e38"/>"#,
            vec!["mimic.multiplier", "-1000 to 1000"],
        ),
        (
            r#"<mimic joint="left_slide"/>"#,
            r#"<mimic joint="left_slide" offset="-1e38"/>"#,
            vec!["mimic.offset", "-10000 to 10000"],
        ),
        (
            r#"izz="0.001""#,
            r#"izz="-0.001""#,
            vec!["link[upper].inertial.inertia", "positive"],
        ),
        (r#"name="mount""#, r#"name="elbow""#, vec!["name", "once"]),
        ("</robot>", "", vec!["arm.urdf"]),
    ];
    for (old, new, words) in cases {
        assert!(URDF.contains(old), "{old}");
        let message = fault("arm.urdf", &URDF.replacen(old, new, 1));
        wrong.extend(
            words
                .iter()
                .filter(|word| !message.contains(**word))
                .map(|word| format!("{new}: no {word:?} in {message}")),
        );
    }
    let cases = [
        (
            r#"mass="1.5""#,
            r#"mass="0""#,
            vec!["body[upper].inertial.mass"],
        ),
        (
            "palm.stl",
            "../palm.stl",
            vec!["body[palm].geom[0].mesh", "leaves the folder"],
        ),
        (
            "palm.stl",
            "plam.stl",
            vec!["body[palm].geom[0].mesh", "plam.stl"],
        ),
        (
            "<worldbody>",
            r#"<include file="../x.xml"/><worldbody>"#,
            vec!["include.file", "leaves"],
        ),
        (
            r#"name="elbow" axis"#,
            r#"name="elbow" type="ball" axis"#,
            vec!["joint[elbow].type", "ball"],
        ),
    ];
    for (old, new, words) in cases {
        let message = fault("arm.xml", &MJCF.replacen(old, new, 1));
        let words = words.iter().chain(&["arm.xml"]);
        wrong.extend(
            words
                .filter(|word| !message.contains(**word))
                .map(|word| format!("{new}: no {word:?} in {message}")),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_cut_or_flipped_byte_makes_the_readers_panic() {
    for (name, text) in [("arm.urdf", URDF), ("arm.xml", MJCF)] {
        let (_folder, path) = Folder::with(name, text);
        let mut key = 0x9e37_79b9_u32;
        for _ in 0..300 {
            key = key.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let mut bytes = text.as_bytes().to_vec();
            let place = key as usize % bytes.len();
            match key >> 30 {
                0 => bytes.truncate(place),
                1 => bytes[place] = b"-9e\"<>/ "[(key >> 8) as usize % 8],
                2 => {
                    bytes.remove(place);
                }
                _ => bytes.insert(place, b'9'),
            }
            std::fs::write(&path, bytes).unwrap();
            if let Ok((robot, _)) = open_robot(&path) {
                let _ = with_robot(&room(), &robot, "r", Pose::IDENTITY, true);
            }
        }
    }
}
