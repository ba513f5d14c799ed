//! Houses of MJCF, written by hand.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use dwell_houses::{HousesError, LoadReport, WarningKind, open};
use dwell_scene::{House, JointKind, Mobility, Object, ObjectId, State, StructureKind};
use glam::Vec3;

/// A kitchen (x 0 to 4, y 0 to 3) and a living room (y 3 to 6); +Z up.
const HOUSE: &str = include_str!("robots/rooms.xml");

fn opened(text: &str) -> Result<(House, LoadReport), HousesError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, text).unwrap();
    open(&path.to_string_lossy())
}

fn object<'a>(house: &'a House, name: &str) -> (ObjectId, &'a Object) {
    house
        .objects
        .iter_ids()
        .find(|(_, o)| o.source_id == name)
        .unwrap()
}

/// The file's +X is our -Z, its +Y our -X, its +Z our +Y.
fn ours(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(-y, z, -x)
}

#[test]
fn floors_become_rooms_and_walls_the_building() {
    let (house, report) = opened(HOUSE).unwrap();
    assert_eq!(
        (house.name.as_str(), house.source.as_str()),
        ("two_rooms", "mjcf")
    );
    let round = |x: f32| (x * 1e4).round() / 1e4;
    let rooms: Vec<_> = house
        .rooms
        .iter()
        .map(|room| {
            (
                room.name.as_str(),
                room.kinds[0].as_str(),
                round(room.area_m2()),
                round(room.ceiling_y),
            )
        })
        .collect();
    assert_eq!(
        rooms,
        [
            ("kitchen_1", "kitchen", 12.0, 2.5),
            ("living_room_1", "living room", 12.0, 2.5)
        ]
    );
    let count = |kind: StructureKind| house.structure.iter().filter(|p| p.kind == kind).count();
    assert_eq!(count(StructureKind::Wall), 3);
    assert_eq!(count(StructureKind::Ceiling), 1);
    assert_eq!(count(StructureKind::Ground), 1);
    let south = house
        .structure
        .iter()
        .find(|p| p.name == "wall_south")
        .unwrap();
    let bounds = house.meshes[south.mesh].bounds();
    let (a, b) = (ours(0.0, -0.1, 0.0), ours(4.0, 0.0, 2.5));
    assert!(bounds.min.abs_diff_eq(a.min(b), 1e-5) && bounds.max.abs_diff_eq(a.max(b), 1e-5));
    let kitchen = house
        .structure
        .iter()
        .find(|p| p.name == "floor_kitchen")
        .unwrap();
    assert_eq!(house.materials[kitchen.materials[0]].substance, "wood");
    let unmapped: Vec<_> = report
        .unmapped_name_counts()
        .map(|(_, name, _)| name)
        .collect();
    assert_eq!(unmapped, ["Qux7"]);
}

#[test]
fn a_floor_that_leans_is_a_room_and_one_that_stands_upright_is_reported() {
    let kitchen = r#"<body name="floor_kitchen">"#;
    assert!(HOUSE.contains(kitchen));
    // 1 degree about X, then 45.
    let leaning = r#"<body name="floor_kitchen" quat="0.99996 0.00873 0 0">"#;
    let (house, _) = opened(&HOUSE.replacen(kitchen, leaning, 1)).unwrap();
    assert_eq!(house.rooms.len(), 2);
    assert!((house.rooms.as_slice()[0].area_m2() - 12.0).abs() < 0.02);
    let (house, report) = opened(&HOUSE.replacen(
        kitchen,
        r#"<body name="floor_kitchen" quat="0.924 0.383 0 0">"#,
        1,
    ))
    .unwrap();
    assert_eq!(house.rooms.len(), 1);
    let told = sentences(&report);
    assert!(
        told.iter()
            .any(|row| row.contains("worldbody.floor_kitchen")
                && row.contains("no face that is level")),
        "{told:?}"
    );
}

#[test]
fn bodies_become_objects_that_stand_move_and_open_as_the_file_says() {
    let (house, report) = opened(HOUSE).unwrap();
    let state = State::new(&house);
    let kinds = |name: &str| {
        let (_, o) = object(&house, name);
        let room = o.room.map(|room| house.rooms[room].name.as_str());
        (o.category.coarse.as_str(), o.mobility, o.pickable, room)
    };
    assert_eq!(
        kinds("table_2"),
        ("table", Mobility::Fixed, false, Some("kitchen_1"))
    );
    assert_eq!(
        kinds("mug_1"),
        ("cup", Mobility::Movable, true, Some("kitchen_1"))
    );
    assert_eq!(
        kinds("dresser_1"),
        (
            "dresser",
            Mobility::Articulated,
            false,
            Some("living_room_1")
        )
    );
    assert_eq!(
        kinds("quxwidget"),
        ("", Mobility::Movable, true, Some("living_room_1"))
    );
    assert_eq!(kinds("door_1").1, Mobility::Articulated);
    // A quarter turn about the file's z takes the handle from +X to +Y.
    let (mug, _) = object(&house, "mug_1");
    let bounds = house.object_bounds(&state, mug);
    let (a, b) = (ours(1.96, 1.46, 0.72), ours(2.04, 1.56, 0.82));
    assert!(bounds.min.abs_diff_eq(a.min(b), 2e-3), "{bounds:?}");
    assert!(bounds.max.abs_diff_eq(a.max(b), 2e-3), "{bounds:?}");
    let joint = |name: &str| house.joints.iter().find(|j| j.name == name).unwrap();
    let hinge = joint("door_hinge");
    assert_eq!(
        (hinge.kind, hinge.limits),
        (JointKind::Hinge, Some([0.0, 1.5]))
    );
    // Opened, the leaf's far edge goes from (2.39, 3) to a circle about (1.5, 3).
    let parent = house.parts[hinge.parent.unwrap()].world_from_part;
    let far = Vec3::new(0.89, 0.0, 1.0);
    let shut = hinge.world_from_child(&parent, 0.0).transform_point(far);
    let wide = hinge.world_from_child(&parent, 1.5).transform_point(far);
    assert!(shut.abs_diff_eq(ours(2.39, 3.0, 1.0), 1e-5), "{shut}");
    let (s, c) = 1.5_f32.sin_cos();
    assert!(
        wide.abs_diff_eq(ours(1.5 + 0.89 * c, 3.0 + 0.89 * s, 1.0), 1e-5),
        "{wide}"
    );
    let slide = joint("drawer_slide");
    let parent = house.parts[slide.parent.unwrap()].world_from_part;
    let out = slide.world_from_child(&parent, 0.3).position;
    assert!(out.abs_diff_eq(ours(1.0, 5.0, 0.6), 1e-5), "{out}");
    let said =
        |d: &WarningKind| matches!(d, WarningKind::Simplified { what } if what.contains("spinner"));
    assert_eq!(report.count(said), 1, "{report}");
}

#[test]
fn a_single_body_is_still_a_robot_on_a_ground() {
    let text = r#"<mujoco model="arm"><worldbody><geom type="plane" size="1 1 1"/>
        <body name="base"><geom type="box" size="0.1 0.1 0.1"/></body></worldbody></mujoco>"#;
    let (house, _) = opened(text).unwrap();
    assert_eq!(house.objects.as_slice()[0].category.coarse, "robot");
    assert!(house.rooms.is_empty());
}

#[test]
fn broken_houses_say_what_is_wrong() {
    let error = opened(&HOUSE.replace("</mujoco>", "")).unwrap_err();
    assert!(matches!(error, HousesError::Syntax { .. }), "{error}");
    let error = opened("<html><body/></html>").unwrap_err().to_string();
    assert!(
        error.ends_with("its root is <html>, expected <mujoco>"),
        "{error}"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    let text: Vec<u8> = HOUSE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    std::fs::write(&path, [&[0xff, 0xfe], &text[..]].concat()).unwrap();
    let error = open(&path.to_string_lossy()).unwrap_err().to_string();
    assert!(error.contains("scene.xml: no UTF-8 text"), "{error}");
    let (house, report) = opened(&HOUSE.replace("mass=\"0.3\"", "mass=\"-1\"")).unwrap();
    assert!(house.objects.iter().all(|o| o.source_id != "mug_1"));
    assert!(report.to_string().contains("mug_1"), "{report}");
    let (_, report) = opened(&HOUSE.replace(
        "<geom type=\"box\" size=\"0.1 0.1 0.1\" mass=\"1\"/>",
        "<geom type=\"mesh\" mesh=\"none\"/>",
    ))
    .unwrap();
    assert!(
        report.to_string().contains("the name of a mesh"),
        "{report}"
    );
}

/// A floor of a mesh with texture coordinates under an image of four colours, and a box of the same material.
#[test]
fn materials_show_their_images_on_meshes_with_texture_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let obj = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    put("meshes/floor.obj", obj.as_bytes());
    let image = image::RgbaImage::from_fn(2, 2, |x, y| {
        image::Rgba([200 * x as u8, 100 * y as u8, 50, 255])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).unwrap();
    put("images/boards.png", png.get_ref());
    let text = r#"<mujoco model="den"><compiler meshdir="meshes" texturedir="images"/>
      <asset><mesh name="floor" file="floor.obj"/>
        <texture name="boards" type="2d" file="boards.png"/><texture name="gone" type="2d" file="gone.png"/>
        <material name="oak" texture="boards"/><material name="lost" texture="gone" rgba="1 0 0 1"/></asset>
      <worldbody>
        <body name="floor_kitchen"><geom type="mesh" mesh="floor" material="oak"/></body>
        <body name="floor_office" pos="5 0 0"><geom type="mesh" mesh="floor" material="lost"/></body>
        <body name="rug_1" pos="1 1 0.1"><freejoint/><geom type="mesh" mesh="floor" material="oak" mass="1"/></body>
        <body name="box_1" pos="1 1 1"><freejoint/><geom type="box" size="0.1 0.1 0.1" material="oak"/></body>
      </worldbody></mujoco>"#;
    let path = put("scene.xml", text.as_bytes());
    let (house, report) = open(&path.to_string_lossy()).unwrap();
    assert_eq!(house.textures.len(), 1, "{report}");
    let texture = &house.textures.as_slice()[0];
    assert_eq!((texture.name.as_str(), texture.width), ("boards", 2));
    let floor = |name: &str| {
        let piece = house.structure.iter().find(|p| p.name == name).unwrap();
        (
            &house.materials[piece.materials[0]],
            &house.meshes[piece.mesh],
        )
    };
    let (material, mesh) = floor("floor_kitchen");
    assert!(material.texture.is_some() && material.base_color == [1.0; 3]);
    // The corner at the file's (4, 3) shows the image's upper right corner.
    let corner = mesh
        .positions
        .iter()
        .position(|p| p.abs_diff_eq(ours(4.0, 3.0, 0.0), 1e-5));
    assert_eq!(mesh.uvs[corner.unwrap()], glam::Vec2::ONE);
    let part = |name: &str| &house.parts[object(&house, name).1.first_part];
    let shown = |name: &str| house.materials[part(name).materials[0]].texture.is_some();
    assert!(shown("rug_1") && !shown("box_1"));
    assert!(!house.meshes[part("rug_1").mesh].uvs.is_empty());
    // A missing image is reported; the colour stays.
    let (material, _) = floor("floor_office");
    assert!(
        material.texture.is_none() && material.base_color[0] > 0.9 && material.base_color[1] < 0.1
    );
    assert_eq!(
        report.count(|d| matches!(d, WarningKind::UnreadableTexture { .. })),
        1
    );
}

/// The sentences of a report.
fn sentences(report: &LoadReport) -> Vec<String> {
    report.warnings().iter().map(ToString::to_string).collect()
}

/// [`HOUSE`] with more in its world.
fn house_with(more: &str) -> String {
    HOUSE.replacen("</worldbody>", &format!("{more}</worldbody>"), 1)
}

#[test]
fn bodies_in_elements_that_are_not_read_are_reported() {
    let body = r#"<body name="q"><geom type="box" size="1 1 1"/></body>"#;
    for (more, said) in [
        (
            format!(
                "<replicate count='3'><replicate count='9'>{body}</replicate>{body}</replicate>"
            ),
            "<replicate> is not read; with it 2 bodies",
        ),
        (
            format!("<frame><bodyy>{body}</bodyy></frame>"),
            "<bodyy> is not read; with it 1 bodies",
        ),
        (
            "<body name='x'><geom size='1'/><composite type='cable' count='4 1 1'/></body>"
                .to_owned(),
            "<composite> is not read",
        ),
        (
            "<flexcomp name='cloth' type='grid'/>".to_owned(),
            "<flexcomp> is not read",
        ),
    ] {
        let (_, report) = opened(&house_with(&more)).unwrap();
        let found = sentences(&report)
            .iter()
            .filter(|line| line.contains(said))
            .count();
        assert_eq!(found, 1, "{more}");
    }
    let (_, report) = opened(HOUSE).unwrap();
    assert!(
        !sentences(&report)
            .iter()
            .any(|line| line.contains("is not read; with it"))
    );
}

#[test]
fn what_no_body_has_is_reported() {
    let thing = |inertial: &str| {
        house_with(&format!(
            r#"<body name="ball" pos="1 1 1"><freejoint/><geom size="0.1"/>
            <inertial pos="0 0 0" mass="1" {inertial}/></body>"#
        ))
    };
    let about = |text: &str, said: &str| {
        let (house, report) = opened(text).unwrap();
        let found = sentences(&report)
            .iter()
            .filter(|line| line.contains(said))
            .count();
        let (_, ball) = object(&house, "ball");
        let root = ball.parts().next().unwrap();
        assert!(house.parts[root].world_from_part.rotation.is_finite());
        found
    };
    let moments = "no body has the moments of inertia";
    assert_eq!(about(&thing(r#"diaginertia="1e4 1 1""#), moments), 1);
    assert_eq!(about(&thing(r#"fullinertia="1 1 3 0 0 0""#), moments), 1);
    // As files round them.
    assert_eq!(about(&thing(r#"diaginertia="2.001 1 1""#), moments), 0);
    let turned = thing(r#"diaginertia="1 1 1" quat="0 0 0 0""#);
    assert_eq!(about(&turned, "<inertial quat> of length 0"), 1);
    let turned = thing(r#"diaginertia="1 1 1""#)
        .replace(r#"pos="1 1 1""#, r#"pos="1 1 1" quat="0 0 0 0.0""#);
    assert_eq!(about(&turned, "<body quat> of length 0"), 1);
}
