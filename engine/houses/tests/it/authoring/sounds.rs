//! The user's own sound files.

use super::{edited, middle, refused, studio};
use dwell_houses::{native, open};
use serde_json::{Value, json};
use std::fs;

/// Returns what begins as a WAV file; a house carries it as it is.
fn write(folder: &tempfile::TempDir, name: &str, more: &str) -> String {
    let path = folder.path().join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, format!("RIFF{more}")).unwrap();
    path.to_string_lossy().into_owned()
}

fn emitter(at: [f32; 3], name: &str, file: &str) -> Value {
    json!({"add_emitter": {"at": at, "name": name, "sound": {"file": file, "level_db": 60, "loops": false, "start_s": 2.5}}})
}

#[test]
fn a_house_carries_its_sound_files_through_copies_and_the_native_form() {
    let folder = tempfile::tempdir().unwrap();
    let kettle = write(&folder, "kettle.wav", "one");
    let other = write(&folder, "b/kettle.wav", "two");
    let house = studio();
    let at = middle(&house);
    let with = edited(
        &house,
        json!([
            emitter(at, "a", &kettle),
            emitter(at, "b", &kettle),
            emitter(at, "c", &other),
            {"add": {"what": {"copy": {"object": "c"}}, "name": "d", "place": {"at": at}}},
        ]),
    );
    let names: Vec<&str> = with.sound_files.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["kettle.wav", "kettle_2.wav"]);
    let added = &with.emitters[house.emitters.len()..];
    let told: Vec<_> = added
        .iter()
        .map(|e| {
            (
                e.signal.as_str(),
                e.sound_file.unwrap().0,
                e.loops,
                e.start_s,
            )
        })
        .collect();
    let (one, two) = (
        ("kettle.wav", 0, false, 2.5),
        ("kettle_2.wav", 1, false, 2.5),
    );
    assert_eq!(told, [one, one, two, two]);

    let path = folder.path().join("mine.dwell");
    native::write(&with, &path).unwrap();
    assert_eq!(fs::read(path.join("sound_1.wav")).unwrap(), b"RIFFtwo");
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert!(report.is_empty() && again == with);
    assert_eq!(again.fingerprint(), with.fingerprint());

    // A copy into another house brings its file along.
    let from = path.to_string_lossy();
    let far = edited(
        &house,
        json!([{"add": {"what": {"copy": {"house": from, "object": "c"}}, "name": "far", "place": {"at": at}}}]),
    );
    let (sound, emitter) = (&far.sound_files.as_slice()[0], far.emitters.last().unwrap());
    assert_eq!(sound.bytes, b"RIFFtwo");
    assert_eq!(
        (&emitter.signal, emitter.sound_file.unwrap().0),
        (&sound.name, 0)
    );

    // What nobody sounds like any more is dropped, and what is behind it moves up.
    let remove = |name: &str| json!({"remove": {"object": name}});
    let less = edited(&with, json!([remove("a"), remove("b")]));
    assert_eq!(less.sound_files.len(), 1);
    assert_eq!(less.emitters.last().unwrap().sound_file.unwrap().0, 0);
    let none = edited(&less, json!([remove("c"), remove("d")]));
    assert_eq!(none.data(), house.data());
}

#[test]
fn sounds_that_cannot_be_are_refused_with_their_field() {
    let folder = tempfile::tempdir().unwrap();
    let kettle = write(&folder, "kettle.wav", "one");
    fs::write(folder.path().join("a.mp3"), "ID3").unwrap();
    let mp3 = folder.path().join("a.mp3").to_string_lossy().into_owned();
    let house = studio();
    let at = middle(&house);
    let told = |sound: Value| refused(&house, json!([{"add_emitter": {"at": at, "sound": sound}}]));
    for (sound, words) in [
        (
            json!({"file": kettle, "signal": "radio", "level_db": 60}),
            "signal, file: found both",
        ),
        (json!({"level_db": 60}), "signal, file: found nothing"),
        (
            json!({"file": "", "level_db": 60}),
            "sound.file: found nothing",
        ),
        (
            json!({"file": mp3, "level_db": 60}),
            "which begins with \"ID3\"; possible: WAV",
        ),
        (json!({"file": "none.wav", "level_db": 60}), "none.wav"),
        (
            json!({"file": kettle, "level_db": 200}),
            "level_db: found 200",
        ),
        (
            json!({"file": kettle, "level_db": 60, "start_s": -1}),
            "start_s: found -1",
        ),
    ] {
        let told = told(sound);
        assert!(told.contains(words), "{told}");
    }
}

#[test]
fn a_plan_reads_sounds_below_its_folder_only() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder, "out.wav", "out");
    write(&folder, "in/sounds/a.wav", "in");
    let inside = folder.path().join("in");
    let plan = |file: &str| {
        let text =
            json!({"house": "builtin:studio", "edits": [emitter([1.0, 1.0, 1.0], "a", file)]});
        let path = inside.join("a.plan.json");
        fs::write(&path, text.to_string()).unwrap();
        open(&path.to_string_lossy()).map(|(house, _)| house)
    };
    let house = plan("sounds/a.wav").unwrap();
    assert_eq!(house.sound_files.as_slice()[0].bytes, b"RIFFin");
    let absolute = folder.path().join("out.wav");
    let mut outside = vec![
        "../out.wav".to_owned(),
        absolute.to_string_lossy().into_owned(),
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&absolute, inside.join("link.wav")).unwrap();
        outside.push("link.wav".to_owned());
    }
    for file in outside {
        let told = plan(&file).unwrap_err().to_string();
        assert!(told.contains("leaves the folder"), "{told}");
    }
}
