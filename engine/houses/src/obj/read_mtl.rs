//! Reads the text of an MTL file.

use super::file::{MtlFile, MtlMaterial};
use super::lines::{float, integer, lines, name, shorten, split_word, words};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Reads MTL text. Never fails: unreadable statements are left out and reported.
///
/// `file` names the file in the report.
pub fn read_mtl(text: &[u8], file: &str, report: &mut LoadReport) -> MtlFile {
    let at = FileLocation::file(file);
    let mut mtl = MtlFile::default();
    for (number, line) in lines(text) {
        let (keyword, rest) = split_word(&line);
        if keyword == b"newmtl" {
            mtl.materials.push(MtlMaterial {
                name: name(rest),
                ..MtlMaterial::default()
            });
        } else if !mtl
            .materials
            .last_mut()
            .is_some_and(|material| statement(material, keyword, rest))
        {
            report.warn(
                at.line(number),
                WarningKind::BadStatement {
                    found: shorten(&line),
                },
            );
        }
    }
    mtl
}

/// Applies one statement; false when it is not understood.
fn statement(material: &mut MtlMaterial, keyword: &[u8], rest: &[u8]) -> bool {
    fn set<T>(slot: &mut Option<T>, value: Option<T>) -> bool {
        let understood = value.is_some();
        if understood {
            *slot = value;
        }
        understood
    }
    match keyword {
        b"Ka" => set(&mut material.ambient, color(rest)),
        b"Kd" => set(&mut material.diffuse, color(rest)),
        b"Ks" => set(&mut material.specular, color(rest)),
        b"Ke" => set(&mut material.emission, color(rest)),
        b"Ns" => set(
            &mut material.shininess,
            scalar(rest).filter(|exponent| *exponent >= 0.0),
        ),
        b"illum" => set(
            &mut material.illumination,
            integer(rest).and_then(|i| i32::try_from(i).ok()),
        ),
        b"d" => set(
            &mut material.opacity,
            unit_fraction(rest.strip_prefix(b"-halo").unwrap_or(rest)),
        ),
        // `d` and `Tr` state the same; `d` counts when both are there.
        b"Tr" => {
            material.opacity.is_some()
                || set(&mut material.opacity, unit_fraction(rest).map(|t| 1.0 - t))
        }
        _ if keyword.eq_ignore_ascii_case(b"map_kd") => {
            set(&mut material.diffuse_map, map_path(rest))
        }
        // Surface detail that the renderers here do not use.
        b"Tf" | b"Ni" | b"sharpness" | b"Pr" | b"Pm" | b"Ps" | b"Pc" | b"Pcr" | b"aniso"
        | b"anisor" | b"bump" | b"disp" | b"decal" | b"refl" | b"norm" => true,
        _ => keyword
            .get(..4)
            .is_some_and(|start| start.eq_ignore_ascii_case(b"map_")),
    }
}

fn scalar(rest: &[u8]) -> Option<f32> {
    words(rest).next().and_then(float)
}

/// A number from 0 to 1.
fn unit_fraction(rest: &[u8]) -> Option<f32> {
    scalar(rest).filter(|share| (0.0..=1.0).contains(share))
}

/// Three numbers, or one for a grey.
fn color(rest: &[u8]) -> Option<[f32; 3]> {
    let mut numbers = words(rest).map(float);
    let r = numbers.next()??;
    match (numbers.next(), numbers.next()) {
        (None, _) => Some([r; 3]),
        (Some(g), Some(b)) => Some([r, g?, b?]),
        _ => None,
    }
}

/// The file name of a texture statement, its options skipped.
fn map_path(rest: &[u8]) -> Option<String> {
    let mut rest = rest.trim_ascii();
    while rest.first() == Some(&b'-') {
        let (option, after) = split_word(rest);
        let at_most = match option {
            b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan" | b"-texres" | b"-boost"
            | b"-bm" | b"-type" => 1,
            b"-mm" => 2,
            b"-o" | b"-s" | b"-t" => 3,
            _ => break,
        };
        rest = after;
        for i in 0..at_most {
            let (value, after) = split_word(rest);
            // The vectors may be shorter than three; the first word that is no number begins the name.
            if i > 0 && float(value).is_none() {
                break;
            }
            rest = after;
        }
    }
    (!rest.is_empty()).then(|| name(rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (MtlFile, LoadReport) {
        let mut report = LoadReport::new();
        let mtl = read_mtl(text.as_bytes(), "a.mtl", &mut report);
        (mtl, report)
    }

    #[test]
    fn both_dialects_of_suncg_are_read() {
        let (mtl, report) = read(
            "newmtl material_0\nKa 0.6 0.6 0.6\nKd 0.640000 0.5 0.4\nKs 1 1 1\nNs 400\nd 0.500000\nillum 2\nmap_Kd ../../texture//wood_8.jpg\n\n\
             newmtl material_1\nillum 2\nd 1\nKd 0.9019607843137255 0.10980392156862745 0.3215686274509804 \n",
        );
        assert!(report.is_empty(), "{report}");
        let [object, room] = mtl.materials.as_slice() else {
            panic!("two materials")
        };
        assert_eq!(
            object.diffuse_map.as_deref(),
            Some("../../texture//wood_8.jpg")
        );
        assert_eq!(
            (object.opacity, object.shininess, object.illumination),
            (Some(0.5), Some(400.0), Some(2))
        );
        assert_eq!(
            room.diffuse,
            Some([0.901_960_8, 0.109_803_92, 0.321_568_64])
        );
        assert_eq!(
            (room.ambient, room.specular, room.shininess),
            (None, None, None)
        );
    }

    #[test]
    fn texture_options_are_skipped() {
        let (mtl, _) = read(
            "newmtl a\nmap_Kd -s 2 2 1 -o 0.5 -clamp on my wood.png\nnewmtl b\nmap_kd -wood.png\n",
        );
        assert_eq!(mtl.materials[0].diffuse_map.as_deref(), Some("my wood.png"));
        assert_eq!(mtl.materials[1].diffuse_map.as_deref(), Some("-wood.png"));
    }

    #[test]
    fn statements_without_meaning_are_reported_by_line() {
        let (mtl, report) = read("Kd 1 1 1\nnewmtl a\nKd 1 x 1\nKd 0.5\nTr 0.25\nhello\n");
        assert_eq!(
            (mtl.materials[0].diffuse, mtl.materials[0].opacity),
            (Some([0.5; 3]), Some(0.75))
        );
        let lines: Vec<_> = report.warnings().iter().map(|w| w.at.line).collect();
        assert_eq!(lines, [Some(1), Some(3), Some(6)]);
    }
}
