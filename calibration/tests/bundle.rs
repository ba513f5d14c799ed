//! Bundles that are damaged, incomplete or hostile: every one is refused with its place, and none brings anything down.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use dwell_calibration::bundle::file::BundleKind;
use dwell_calibration::{CalibrationError, CalibrationOptions, calibrate};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A change to a bundle that was sound.
fn after(change: impl FnOnce(&Path)) -> String {
    let folder = tempfile::tempdir().unwrap();
    dwell_calibration::example::write(folder.path(), 1).unwrap();
    change(folder.path());
    // A bundle that is read after all is stopped before the work begins.
    let found = calibrate(
        folder.path(),
        &CalibrationOptions::default(),
        &mut |fraction, _| fraction < 0.04,
    );
    found.unwrap_err().to_string()
}

fn replace(folder: &Path, file: &str, from: &str, to: &str) {
    let path = folder.join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{file} holds no {from}");
    fs::write(path, text.replacen(from, to, 1)).unwrap();
}

#[test]
fn faults_are_named_with_file_line_and_field() {
    let cases: Vec<(&str, &str, &str, &[&str])> = vec![
        (
            "manifest.json",
            "\"version\": 1",
            "\"version\": 7",
            &["manifest.json", "version is 7", "1 to 3, the versions"],
        ),
        (
            "manifest.json",
            "\"mass_kg\": 0.0027",
            "\"mass_kg\": -1",
            &["scene.bodies[0].mass_kg", "-1"],
        ),
        (
            "manifest.json",
            "\"licence\"",
            "\"license\"",
            &["manifest.json line", "license"],
        ),
        (
            "manifest.json",
            "\"unit\": \"m\"",
            "\"unit\": \"mm\"",
            &["channels[0].unit", "mm"],
        ),
        (
            "trajectory.csv",
            ",ball,x,",
            ",boll,x,",
            &["trajectory.csv line 2", "boll", "ball"],
        ),
        (
            "trajectory.csv",
            ",ball,x,",
            ",ball,w,",
            &["trajectory.csv line 2", "channel", "\"w\""],
        ),
        (
            "trajectory.csv",
            "throw_00,",
            "throw_99,",
            &["trajectory.csv line 2", "throw_99", "episodes.csv"],
        ),
        (
            "trajectory.csv",
            "12.50000",
            "NaN",
            &["trajectory.csv line 2", "t_s", "NaN"],
        ),
        (
            "trajectory.csv",
            "12.50000",
            "soon",
            &[
                "trajectory.csv line 2",
                "column \"t_s\" is \"soon\"",
                "a number",
            ],
        ),
        (
            "trajectory.csv",
            "12.50000",
            "",
            &[
                "trajectory.csv line 2",
                "column \"t_s\" is missing",
                "fill it in",
            ],
        ),
        (
            "trajectory.csv",
            "12.50000",
            "12,50000",
            &[
                "trajectory.csv line 2: 6 cells, and the head has 5",
                "write points",
            ],
        ),
        (
            "trajectory.csv",
            "episode,t_s",
            "episode,t",
            &["line 2", "missing field `t_s`", "the head has"],
        ),
        (
            "trajectory.csv",
            "throw_00,12.51000,ball,y",
            "throw_00,12.50000,ball,y",
            &[
                "episode throw_00: t_s is 12.5 twice",
                "leave one of the two rows out",
            ],
        ),
        (
            "manifest.json",
            "\"g_m_s2\": null",
            "\"g_m_s2\": -9.81",
            &["g_m_s2 is -9.81", "how strong it is, which is 9.81"],
        ),
        (
            "episodes.csv",
            "throw_01",
            "throw_00",
            &["episodes.csv line 3", "again"],
        ),
    ];
    for (file, from, to, told) in cases {
        let message = after(|folder| replace(folder, file, from, to));
        for word in told {
            assert!(message.contains(word), "{file} {from} -> {to}: {message}");
        }
    }
    let message = after(|folder| fs::remove_file(folder.join("trajectory.csv")).unwrap());
    assert!(message.contains("trajectory.csv"), "{message}");
    let message = after(|folder| {
        fs::write(
            folder.join("episodes.csv"),
            "episode,split_group,conditions\n",
        )
        .unwrap();
    });
    assert!(message.contains("episodes.csv"), "{message}");
    let message = after(|folder| fs::remove_file(folder.join("manifest.json")).unwrap());
    assert!(
        message.contains("`dwell measure import` makes"),
        "{message}"
    );
    let missing = calibrate(
        Path::new("no such folder"),
        &CalibrationOptions::default(),
        &mut |_, _| true,
    );
    assert!(matches!(missing, Err(CalibrationError::Read { .. })));
}

/// A room whose `ir.csv` names a file outside of the bundle.
fn room(folder: &Path, file: &str) -> String {
    let side = r#"{"absorption": {"centres_hz": [1000.0], "values": [0.1]}}"#;
    let sides = ["floor", "ceiling", "west", "east", "north", "south"]
        .map(|name| format!("\"{name}\": {side}"))
        .join(",");
    let manifest = format!(
        r#"{{"version": 1, "title": "r", "licence": "CC0-1.0", "kind": "impulse_response",
            "scene": {{"room": {{"size_m": [4, 3, 5], "surfaces": {{{sides}}}}}}}}}"#
    );
    fs::write(folder.join("manifest.json"), manifest).unwrap();
    fs::write(
        folder.join("episodes.csv"),
        "episode,split_group,conditions\na,a,\nb,b,\nc,c,\nd,d,\n",
    )
    .unwrap();
    let head = "episode,file,source_x,source_y,source_z,receiver_x,receiver_y,receiver_z,rate_hz";
    fs::write(
        folder.join("ir.csv"),
        format!("{head}\na,{file},1,1,1,2,2,2,16000\n"),
    )
    .unwrap();
    let found = calibrate(folder, &CalibrationOptions::default(), &mut |_, _| true);
    found.unwrap_err().to_string()
}

#[test]
fn no_path_leads_out_of_the_bundle() {
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("secret.wav"), b"RIFF").unwrap();
    let folder = tempfile::tempdir().unwrap();
    for file in ["../secret.wav", "/etc/hostname", "ir/../../x.wav", ""] {
        let message = room(folder.path(), file);
        assert!(message.contains("inside the bundle"), "{file}: {message}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(
            outside.path().join("secret.wav"),
            folder.path().join("link.wav"),
        )
        .unwrap();
        let message = room(folder.path(), "link.wav");
        assert!(message.contains("link out of the bundle"), "{message}");
    }
    fs::write(folder.path().join("x.wav"), b"RIFF\xff\xff\xff\xffWAVEfmt ").unwrap();
    assert!(room(folder.path(), "x.wav").contains("x.wav"));
}

/// Cuts and flipped bytes anywhere never panic.
#[test]
fn damaged_bytes_are_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    dwell_calibration::example::write(folder.path(), 2).unwrap();
    for name in ["manifest.json", "episodes.csv"] {
        let path = folder.path().join(name);
        let sound = fs::read(&path).unwrap();
        for k in (0..sound.len()).step_by(13) {
            let mut bytes = sound.clone();
            bytes[k] ^= 0x15;
            fs::write(&path, &bytes).unwrap();
            drop(calibrate(
                folder.path(),
                &CalibrationOptions::default(),
                &mut |fraction, _| fraction < 0.04,
            ));
            fs::write(&path, &sound[..k]).unwrap();
            drop(calibrate(
                folder.path(),
                &CalibrationOptions::default(),
                &mut |fraction, _| fraction < 0.04,
            ));
        }
        fs::write(&path, &sound).unwrap();
    }
}

/// A drive whose table can be damaged: 60 samples of a robot that goes straight on.
fn drive(change: impl Fn(usize, &mut [f64; 6])) -> Result<(BundleKind, usize), String> {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    put(
        "manifest.json",
        r#"{"version": 3, "title": "d", "licence": "CC0-1.0", "kind": "drive",
            "scene": {"base": {"wheel_radius_m": 0.05, "wheel_base_m": 0.2, "rate_hz": 20}}}"#
            .into(),
    );
    let (mut episodes, mut rows) = (
        "episode,split_group,conditions\n".to_owned(),
        "episode,t_s,x,y,heading,left_rad,right_rad\n".to_owned(),
    );
    for episode in 0..4 {
        writeln!(episodes, "d{episode},g{episode},straight").unwrap();
        for k in 0..60 {
            let step = if k == 0 { 0.0 } else { 0.2 };
            let mut row = [0.05 * k as f64, 0.01 * k as f64, 0.0, 0.0, step, step];
            change(k, &mut row);
            let cells = row.map(|cell| cell.to_string()).join(",");
            writeln!(rows, "d{episode},{cells}").unwrap();
        }
    }
    put("episodes.csv", episodes);
    put("drive.csv", rows);
    dwell_calibration::check_bundle(folder.path()).map_err(|error| error.to_string())
}

#[test]
fn faults_of_drives_are_named() {
    assert_eq!(drive(|_, _| ()).unwrap(), (BundleKind::Drive, 4));
    let told = drive(|k, row| row[0] += if k == 7 { 0.03 } else { 0.0 }).unwrap_err();
    assert!(told.contains("t_s") && told.contains("sample 7"), "{told}");
    let told = drive(|_, row| (row[4], row[5]) = (-row[4], -row[5])).unwrap_err();
    assert!(told.contains("count backwards"), "{told}");
    let told = drive(|k, row| row[3] = if k == 3 { f64::NAN } else { 0.0 }).unwrap_err();
    assert!(
        told.contains("heading") && told.contains("line 5"),
        "{told}"
    );
}

/// Flights of the example with their heights in feet, and with three seconds missing.
#[test]
fn feet_and_gaps_are_refused() {
    let each = |folder: &Path, change: fn(usize, &str, f64, f64) -> (f64, f64)| {
        let path = folder.join("trajectory.csv");
        let text = fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        let mut changed = format!("{}\n", lines.next().unwrap());
        for (k, line) in lines.enumerate() {
            let cells: Vec<&str> = line.split(',').collect();
            let (t, value) = (cells[1].parse().unwrap(), cells[4].parse().unwrap());
            let (t, value) = change(k, cells[0], t, value);
            let (episode, entity, channel) = (cells[0], cells[2], cells[3]);
            writeln!(changed, "{episode},{t:.9},{entity},{channel},{value:.9}").unwrap();
        }
        fs::write(path, changed).unwrap();
    };
    let told = after(|folder| each(folder, |_, _, t, value| (t, value / 0.3048)));
    assert!(told.contains("lengths in feet? Divide by 3.2808"), "{told}");
    let told = after(|folder| {
        each(folder, |k, _, t, value| {
            (if k < 12 { t } else { t + 3.0 }, value)
        });
    });
    assert!(
        told.contains("less than 0.5 s from sample to sample"),
        "{told}"
    );
    assert!(told.contains("fill the gap in"), "{told}");
}
