//! OBJ and MTL.

use std::fmt::Write as _;

use crate::kit::{Case, fails, obj_of, png_of, put, warns};

pub(crate) const CASES: &[Case] = &[
    fails(
        "an empty file",
        |d| put(d, "a.obj", ""),
        &["a.obj", "not one triangle"],
    ),
    fails(
        "only vertices",
        |d| put(d, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        &["a.obj", "not one triangle"],
    ),
    fails(
        "coordinates of 1e30 m",
        |d| put(d, "a.obj", obj_of("a.mtl").replace("v 1 0 0", "v 1e30 0 0")),
        &["a.obj", "structure[0] \"floor\"", "32768 m"],
    ),
    warns(
        "a floor that stands upright",
        |d| {
            let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\no floor_hall\nf 1 2 3\n";
            put(d, "a.obj", text)
        },
        &["a.obj: floor_hall", "no face that is level"],
    ),
    fails(
        "50,001 things",
        |d| {
            let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
            for k in 0..50_001 {
                write!(text, "o t{k}\nf 1 2 3\n").unwrap();
            }
            put(d, "a.obj", text)
        },
        &["a.obj", "o: count of things 50001", "50000"],
    ),
    fails(
        "65,536 materials",
        |d| {
            put(d, "a.mtl", "newmtl a\n".repeat(65_536));
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.obj", "mtllib: count of materials 65536", "65535"],
    ),
    warns(
        "numbers that are none",
        |d| {
            put(
                d,
                "a.obj",
                obj_of("a.mtl").replace("v 1 0 0", "v 1 1e39 nan\nv 1 0 0"),
            )
        },
        &["a.obj:5", "not finite numbers"],
    ),
    warns(
        "a corner at index 0, at -9 and beyond 64 bits",
        |d| {
            let faces = "f 0 1 2\nf -9 1 2\nf 99999999999999999999 1 2\n";
            put(d, "a.obj", format!("{}{faces}", obj_of("a.mtl")))
        },
        &["a.obj:8", "index \"0\"", "count from 1, or back from -1"],
    ),
    warns(
        "a corner of five indices",
        |d| put(d, "a.obj", format!("{}f 1/2/3/4/5 2 3\n", obj_of("a.mtl"))),
        &["a.obj:8", "\"1/2/3/4/5\" has more than three indices"],
    ),
    warns(
        "an opacity of 7",
        |d| {
            put(d, "a.mtl", "newmtl a\nd 7\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.mtl:2", "\"d 7\""],
    ),
    warns(
        "a shininess below 0",
        |d| {
            put(d, "a.mtl", "newmtl a\nNs -1e30\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.mtl:2", "\"Ns -1e30\""],
    ),
    warns(
        "a face of 100,001 corners",
        |d| {
            put(
                d,
                "a.obj",
                format!("{}f{}\n", obj_of("a.mtl"), " 1".repeat(100_001)),
            )
        },
        &["a.obj:8", "more than 100000 corners"],
    ),
    warns(
        "a line that goes on without end",
        |d| {
            put(
                d,
                "a.obj",
                format!("{}{}", obj_of("a.mtl"), "x \\\n".repeat(300_000)),
            )
        },
        &["a.obj:8", "is not understood"],
    ),
    warns(
        "a library out of the folder",
        |d| put(d, "a.obj", obj_of("../../etc/passwd")),
        &["a.obj", "../../etc/passwd", "leaves the house's folder"],
    ),
    warns(
        "a library by an absolute path",
        |d| put(d, "a.obj", obj_of("C:\\secret.mtl")),
        &["a.obj", "secret.mtl", "leaves the house's folder"],
    ),
    #[cfg(unix)]
    warns(
        "a library that is a link out of the folder",
        |d| {
            std::os::unix::fs::symlink("/etc/passwd", d.join("a.mtl")).unwrap();
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.obj", "a.mtl"],
    ),
    warns(
        "a texture out of the folder",
        |d| {
            put(d, "a.mtl", "newmtl a\nmap_Kd ../x.png\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.mtl", "../x.png", "leaves the house's folder"],
    ),
    warns(
        "a texture of 60,000 by 60,000 pixels",
        |d| {
            put(d, "x.png", png_of(60_000, 60_000));
            put(d, "a.mtl", "newmtl a\nmap_Kd x.png\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["x.png", "could not be read"],
    ),
    warns(
        "a texture that is a text",
        |d| {
            put(d, "x.png", "hello");
            put(d, "a.mtl", "newmtl a\nmap_Kd x.png\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["x.png", "could not be read"],
    ),
    warns(
        "a library named 100,000 times",
        |d| {
            put(d, "a.mtl", "newmtl a\nKd 1 x 1\n");
            put(
                d,
                "a.obj",
                format!("{}{}", "mtllib a.mtl\n".repeat(100_000), obj_of("a.mtl")),
            )
        },
        &["a.mtl:2", "is not understood"],
    ),
    warns(
        "a colour of nan",
        |d| {
            put(d, "a.mtl", "newmtl a\nKd nan inf 0\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.mtl:2", "is not understood"],
    ),
    warns(
        "a material twice",
        |d| {
            put(d, "a.mtl", "newmtl a\nnewmtl a\n");
            put(d, "a.obj", obj_of("a.mtl"))
        },
        &["a.obj", "\"a\" is defined again"],
    ),
    warns(
        "a vertex under 40,000 texture coordinates",
        |d| {
            let mut text = obj_of("none.mtl");
            for k in 0..40_000 {
                writeln!(text, "vt {k} 0").unwrap();
            }
            for k in 1..=40_000 {
                writeln!(text, "f 1/{k} 2/{k} 3/{k}").unwrap();
            }
            put(d, "a.obj", text)
        },
        &["a.obj", "none.mtl"],
    ),
    warns(
        "ten thousand things over 400,000 vertices",
        |d| {
            let mut text = obj_of("none.mtl");
            text += &"v 0 0 1\n".repeat(400_000);
            for k in 0..10_000 {
                write!(text, "o t{k}\nf 1 2 400003\n").unwrap();
            }
            put(d, "a.obj", text)
        },
        &["a.obj", "none.mtl"],
    ),
];
