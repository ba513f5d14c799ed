//! URDF and MJCF.

use std::path::{Path, PathBuf};

use crate::kit::{Case, fails, png_of, put, warns};

pub(crate) const URDF: &str = r#"<robot name="r">
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>"#;

pub(crate) const MJCF: &str = r#"<mujoco model="m">
<asset></asset>
<worldbody>
<geom name="floor" type="plane" size="4 4 1"/>
<body name="a"><geom type="box" size="0.1 0.1 0.1" mass="1"/></body>
<body name="b"><joint name="j" type="hinge" axis="0 0 1"/><geom type="box" size="0.1 0.1 0.1" mass="1"/></body>
</worldbody></mujoco>"#;

/// The file in which `from` became `to`.
pub(crate) fn urdf(folder: &Path, from: &str, to: &str) -> PathBuf {
    assert!(URDF.contains(from));
    put(folder, "r.urdf", URDF.replacen(from, to, 1))
}

pub(crate) fn mjcf(folder: &Path, from: &str, to: &str) -> PathBuf {
    assert!(MJCF.contains(from));
    put(folder, "m.xml", MJCF.replacen(from, to, 1))
}

pub(crate) const BOX: &str = "<box size=\"1 1 1\"/>";
pub(crate) const ASSET: &str = "<asset></asset>";

pub(crate) const URDF_CASES: &[Case] = &[
    fails("an empty file", |d| put(d, "r.urdf", ""), &["r.urdf:1"]),
    fails(
        "bytes that are no text",
        |d| put(d, "r.urdf", [0xff; 100]),
        &["r.urdf", "invalid utf-8"],
    ),
    fails(
        "a million elements in each other",
        |d| put(d, "r.urdf", "<robot>".repeat(1_000_000)),
        &["r.urdf:1", "depth of elements 201", "200"],
    ),
    fails(
        "entities that multiply",
        |d| {
            put(
                d,
                "r.urdf",
                format!("<!DOCTYPE a [<!ENTITY b 'bbb'>]>{URDF}"),
            )
        },
        &["r.urdf:1", "DTD"],
    ),
    fails(
        "a negative velocity",
        |d| urdf(d, "velocity=\"1\"", "velocity=\"-2\""),
        &["r.urdf:5", "velocity", "from 0 up", "-2"],
    ),
    fails(
        "a negative effort",
        |d| urdf(d, "effort=\"1\"", "effort=\"-5\""),
        &["r.urdf:5", "effort", "from 0 up", "-5"],
    ),
    fails(
        "another root",
        |d| put(d, "r.urdf", "<sdf/>"),
        &["r.urdf", "<robot>", "<sdf>"],
    ),
    fails(
        "a size of 1e39",
        |d| urdf(d, BOX, "<box size=\"1e39 1 1\"/>"),
        &["r.urdf", "link[a]", "sizes of 1e-6 to 1000 m"],
    ),
    fails(
        "a size of nan",
        |d| urdf(d, BOX, "<box size=\"nan 1 1\"/>"),
        &["r.urdf:3", "link[a]", "size"],
    ),
    fails(
        "a colour of nan",
        |d| {
            let color = "<material name=\"m\"><color rgba=\"nan 0 0 1\"/></material></visual>";
            urdf(d, "</visual>", color)
        },
        &["r.urdf:3", "rgba", "finite numbers"],
    ),
    fails(
        "a joint without a parent that exists",
        |d| urdf(d, "parent link=\"a\"", "parent link=\"zz\""),
        &["r.urdf:5", "the name of a link, found \"zz\""],
    ),
    fails(
        "a mass of 1e39",
        |d| urdf(d, "mass value=\"1\"", "mass value=\"1e39\""),
        &["r.urdf:2", "link[a]", "mass", "1e-6 to 1e6 kg"],
    ),
    warns(
        "moments of inertia that no body has",
        |d| urdf(d, "ixx=\"1\"", "ixx=\"1e4\""),
        &["r.urdf", "no body has the moments of inertia"],
    ),
    fails(
        "a link twice",
        |d| urdf(d, "link name=\"b\"", "link name=\"a\""),
        &["r.urdf"],
    ),
    fails(
        "a joint to a link that does not exist",
        |d| urdf(d, "child link=\"b\"", "child link=\"c\""),
        &["r.urdf:5", "joint[j]", "\"c\""],
    ),
    fails(
        "a link that hangs on itself",
        |d| urdf(d, "parent link=\"a\"", "parent link=\"b\""),
        &["r.urdf", "link"],
    ),
    fails(
        "limits the wrong way round",
        |d| urdf(d, "lower=\"0\"", "lower=\"9\""),
        &["r.urdf", "joint[j]", "lower <= upper"],
    ),
    fails(
        "a mesh that does not exist",
        |d| urdf(d, BOX, "<mesh filename=\"none.stl\"/>"),
        &["r.urdf:3", "link[a]", "none.stl"],
    ),
    fails(
        "a mesh out of the folder",
        |d| urdf(d, BOX, "<mesh filename=\"../../etc/passwd.stl\"/>"),
        &[
            "r.urdf:3",
            "link[a]",
            "../../etc/passwd.stl",
            "leaves the folder",
        ],
    ),
    fails(
        "a mesh of a package that climbs out",
        |d| urdf(d, BOX, "<mesh filename=\"package://../../x.stl\"/>"),
        &["r.urdf:3", "link[a]", "leaves the folder"],
    ),
    fails(
        "a mesh by an absolute path",
        |d| urdf(d, BOX, "<mesh filename=\"file:///etc/passwd.stl\"/>"),
        &[
            "r.urdf:3",
            "link[a]",
            "/etc/passwd.stl",
            "leaves the folder",
        ],
    ),
    #[cfg(unix)]
    fails(
        "a mesh that is a link out of the folder",
        |d| {
            std::os::unix::fs::symlink("/etc/passwd", d.join("x.stl")).unwrap();
            urdf(d, BOX, "<mesh filename=\"x.stl\"/>")
        },
        &["r.urdf:3", "link[a]", "x.stl", "leaves the folder"],
    ),
    fails(
        "an STL that claims 4,000 million triangles",
        |d| {
            let mut bytes = vec![0; 80];
            bytes.extend(u32::MAX.to_le_bytes());
            put(d, "x.stl", bytes);
            urdf(d, BOX, "<mesh filename=\"x.stl\"/>")
        },
        &["r.urdf:3", "link[a]", "x.stl", "4294967295 triangles"],
    ),
    fails(
        "an empty mesh",
        |d| {
            put(d, "x.obj", "");
            urdf(d, BOX, "<mesh filename=\"x.obj\"/>")
        },
        &["r.urdf:3", "link[a]", "x.obj", "a mesh with triangles"],
    ),
];

pub(crate) const MJCF_CASES: &[Case] = &[
    fails(
        "a mass of nothing",
        |d| mjcf(d, "mass=\"1\"", "mass=\" \""),
        &["m.xml:5", "geom.mass", "numbers"],
    ),
    warns(
        "a colour of 7",
        |d| mjcf(d, "mass=\"1\"", "mass=\"1\" rgba=\"7 0 0 1\""),
        &["m.xml", "rgba", "7", "0 to 1"],
    ),
    fails(
        "a file that is cut",
        |d| put(d, "m.xml", &MJCF[..120]),
        &["m.xml:"],
    ),
    fails(
        "a million bodies in each other",
        |d| {
            put(
                d,
                "m.xml",
                format!("<mujoco><worldbody>{}", "<body>".repeat(1_000_000)),
            )
        },
        &["m.xml:1", "depth of elements 201", "200"],
    ),
    fails(
        "entities that multiply",
        |d| {
            put(
                d,
                "m.xml",
                format!("<!DOCTYPE a [<!ENTITY b 'bbb'>]>{MJCF}"),
            )
        },
        &["m.xml:1", "DTD"],
    ),
    fails(
        "a file that includes itself",
        |d| mjcf(d, ASSET, "<include file=\"m.xml\"/>"),
        &["m.xml", "includes itself"],
    ),
    fails(
        "a model that attaches itself",
        |d| {
            mjcf(
                d,
                ASSET,
                "<asset><model name=\"x\" file=\"m.xml\"/></asset>",
            )
        },
        &["m.xml", "includes itself"],
    ),
    fails(
        "files that include others twice, 40 deep",
        |d| {
            for k in 0..40 {
                let next = format!("<include file=\"f{}.xml\"/>", k + 1);
                put(
                    d,
                    &format!("f{k}.xml"),
                    format!("<mujoco>{next}{next}</mujoco>"),
                );
            }
            put(d, "f40.xml", "<mujoco/>");
            mjcf(d, ASSET, "<include file=\"f0.xml\"/>")
        },
        &["more than 64 files are included"],
    ),
    fails(
        "a model that is attached twice by one that is, 30 deep",
        |d| {
            for k in 0..30 {
                let model = format!("<asset><model name=\"n\" file=\"f{}.xml\"/></asset>", k + 1);
                let attach = "<attach model=\"n\" body=\"b\" prefix=\"x\"/>";
                let body = format!("<body name=\"b\">{attach}{attach}</body>");
                let text = format!("<mujoco>{model}<worldbody>{body}</worldbody></mujoco>");
                put(d, &format!("f{k}.xml"), text);
            }
            put(
                d,
                "f30.xml",
                "<mujoco><worldbody><body name=\"b\"/></worldbody></mujoco>",
            );
            mjcf(
                d,
                ASSET,
                "<asset><model name=\"n\" file=\"f0.xml\"/></asset>",
            )
        },
        &["count of elements", "1000000"],
    ),
    fails(
        "an include out of the folder",
        |d| mjcf(d, ASSET, "<include file=\"../../etc/passwd\"/>"),
        &[
            "m.xml:2",
            "include.file",
            "../../etc/passwd",
            "leaves the folder",
        ],
    ),
    fails(
        "a model out of the folder",
        |d| {
            mjcf(
                d,
                ASSET,
                "<asset><model name=\"x\" file=\"/etc/passwd\"/></asset>",
            )
        },
        &["m.xml:2", "model.file", "/etc/passwd", "leaves the folder"],
    ),
    #[cfg(unix)]
    fails(
        "an include below another folder that is a link out",
        |d| {
            put(
                d,
                "deep/b.xml",
                "<mujoco><include file=\"c.xml\"/></mujoco>",
            );
            put(d, "c.xml", "<mujoco/>");
            std::os::unix::fs::symlink("/etc/passwd", d.join("deep/c.xml")).unwrap();
            mjcf(d, ASSET, "<include file=\"deep/b.xml\"/>")
        },
        &["deep/c.xml", "leaves the folder"],
    ),
    fails(
        "an include that does not exist",
        |d| mjcf(d, ASSET, "<include file=\"none.xml\"/>"),
        &["none.xml", "No such file"],
    ),
    fails(
        "numbers that are words",
        |d| mjcf(d, "size=\"0.1 0.1 0.1\"", "size=\"a b c\""),
        &["m.xml"],
    ),
    fails(
        "a body of 1e39 m",
        |d| mjcf(d, "size=\"0.1 0.1 0.1\"", "size=\"1e39 1 1\""),
        &["m.xml:", "geom.size", "finite numbers below 3.4e38", "1e39"],
    ),
    fails(
        "a place of nan",
        |d| mjcf(d, "<body name=\"b\">", "<body name=\"b\" pos=\"nan 0 0\">"),
        &["m.xml:6", "body.pos", "finite numbers", "nan"],
    ),
    fails(
        "a place of words",
        |d| mjcf(d, "<body name=\"b\">", "<body name=\"b\" pos=\"1 x 0\">"),
        &["m.xml:6", "body.pos", "finite numbers", "\"x\""],
    ),
    fails(
        "a place with commas",
        |d| mjcf(d, "<body name=\"b\">", "<body name=\"b\" pos=\"1, 0, 0\">"),
        &["m.xml:6", "body.pos", "no commas", "\"1, 0, 0\""],
    ),
    fails(
        "a place of nan in the root's geom",
        |d| mjcf(d, "size=\"4 4 1\"", "size=\"4 4 1\" pos=\"0 nan 0\""),
        &["m.xml:4", "geom.pos", "finite numbers"],
    ),
    fails(
        "a turn of infinity in the root's geom",
        |d| mjcf(d, "size=\"4 4 1\"", "size=\"4 4 1\" quat=\"inf 0 0 0\""),
        &["m.xml:4", "geom.quat", "finite numbers"],
    ),
    fails(
        "a colour of nan",
        |d| mjcf(d, "size=\"4 4 1\"", "size=\"4 4 1\" rgba=\"nan 1 1 1\""),
        &["m.xml:4", "geom.rgba", "finite numbers"],
    ),
    warns(
        "a class of defaults that nothing defines",
        |d| {
            mjcf(
                d,
                "<body name=\"b\">",
                "<body name=\"b\" childclass=\"nope\">",
            )
        },
        &["m.xml:6", "body.childclass", "\"nope\" is not defined"],
    ),
    warns(
        "a class of defaults that is defined twice",
        |d| {
            let two = "<default><default class=\"a\"/><default class=\"a\"/></default>";
            mjcf(d, "<worldbody>", &format!("{two}<worldbody>"))
        },
        &["m.xml", "default.class", "\"a\" is defined twice"],
    ),
    fails(
        "300,000 attributes",
        |d| {
            let all: Vec<String> = (0..300_000).map(|k| format!("a{k}=\"\"")).collect();
            let all = format!(" {}", all.join(" "));
            mjcf(d, "<geom", &format!("<geom{all}"))
        },
        &["m.xml:4", "count of attributes", "128"],
    ),
    warns(
        "a mesh that does not exist",
        |d| {
            let text = MJCF.replace(ASSET, "<asset><mesh name=\"x\" file=\"none.stl\"/></asset>");
            put(
                d,
                "m.xml",
                text.replace(
                    "type=\"box\" size=\"0.1 0.1 0.1\"",
                    "type=\"mesh\" mesh=\"x\"",
                ),
            )
        },
        &["m.xml", "none.stl"],
    ),
    warns(
        "a mesh out of the folder",
        |d| {
            let text = MJCF.replace(ASSET, "<asset><mesh name=\"x\" file=\"../x.stl\"/></asset>");
            put(
                d,
                "m.xml",
                text.replace(
                    "type=\"box\" size=\"0.1 0.1 0.1\"",
                    "type=\"mesh\" mesh=\"x\"",
                ),
            )
        },
        &["m.xml", "../x.stl", "leaves the folder"],
    ),
    warns(
        "a mesh that no asset is",
        |d| {
            mjcf(
                d,
                "type=\"box\" size=\"0.1 0.1 0.1\"",
                "type=\"mesh\" mesh=\"none\"",
            )
        },
        &["m.xml", "body[a]", "none"],
    ),
    warns(
        "a texture of 60,000 by 60,000 pixels",
        |d| {
            put(d, "x.png", png_of(60_000, 60_000));
            put(
                d,
                "x.obj",
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1/1 2/1 3/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n",
            );
            let asset = "<asset><texture name=\"t\" type=\"2d\" file=\"x.png\"/><material name=\"w\" texture=\"t\"/><mesh name=\"x\" file=\"x.obj\"/></asset>";
            let text = MJCF.replace(ASSET, asset);
            let shape = "material=\"w\" type=\"mesh\" mesh=\"x\"";
            put(
                d,
                "m.xml",
                text.replacen("type=\"box\" size=\"0.1 0.1 0.1\"", shape, 1),
            )
        },
        &["m.xml", "x.png", "could not be read"],
    ),
];
