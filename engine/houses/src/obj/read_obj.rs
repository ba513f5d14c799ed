//! Reads the text of an OBJ file.

use super::file::{FaceCorner, FaceGroup, NONE, ObjFile};
use super::lines::{float, integer, lines, name, shorten, split_word, words};
use crate::limits::MAX_CORNERS;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Reads OBJ text. Never fails: unreadable statements are left out and reported.
///
/// `file` names the file in the report.
pub fn read_obj(text: &[u8], file: &str, report: &mut LoadReport) -> ObjFile {
    let mut reader = ObjReader {
        obj: ObjFile::default(),
        at: FileLocation::file(file),
        report,
        names: CurrentNames::default(),
        pending: Vec::new(),
    };
    for (number, line) in lines(text) {
        reader.line(number, &line);
    }
    reader.finish()
}

#[derive(Default)]
struct CurrentNames {
    object: String,
    group: String,
    material: Option<String>,
}

struct ObjReader<'a> {
    obj: ObjFile,
    at: FileLocation,
    report: &'a mut LoadReport,
    names: CurrentNames,
    /// Corners of the face being read.
    pending: Vec<FaceCorner>,
}

impl ObjReader<'_> {
    fn line(&mut self, number: u32, line: &[u8]) {
        let (keyword, rest) = split_word(line);
        match keyword {
            b"v" => {
                let value = self.floats::<3>(rest, number, &WarningKind::NanVertices);
                self.obj.positions.push(value);
            }
            b"vn" => {
                let value = self.floats::<3>(rest, number, &WarningKind::NanAttributes);
                self.obj.normals.push(value);
            }
            b"vt" => {
                // One coordinate is legal and means v = 0; a third one is ignored.
                let mut value = [0.0; 2];
                let mut bad = false;
                for (slot, word) in value.iter_mut().zip(words(rest)) {
                    let number = float(word);
                    bad |= number.is_none();
                    *slot = number.unwrap_or(0.0);
                }
                if bad || rest.is_empty() {
                    self.report
                        .warn(self.at.line(number), WarningKind::NanAttributes);
                }
                self.obj.texcoords.push(value);
            }
            b"f" => self.face(number, rest),
            b"usemtl" => {
                self.close_run();
                self.names.material = Some(name(rest));
            }
            b"o" => {
                self.close_run();
                self.names.object = name(rest);
            }
            b"g" => {
                self.close_run();
                self.names.group = name(rest);
            }
            b"mtllib" => self.obj.material_libraries.push(name(rest)),
            // Smoothing groups add nothing to stored normals; points and lines have no surface.
            b"s" | b"p" | b"l" | b"vp" => {}
            _ => {
                let found = shorten(line);
                self.report
                    .warn(self.at.line(number), WarningKind::BadStatement { found });
            }
        }
    }

    /// `N` numbers; those missing or not finite are NaN.
    fn floats<const N: usize>(
        &mut self,
        rest: &[u8],
        number: u32,
        damage: &WarningKind,
    ) -> [f32; N] {
        let mut value = [f32::NAN; N];
        for (slot, word) in value.iter_mut().zip(words(rest)) {
            *slot = float(word).unwrap_or(f32::NAN);
        }
        if value.iter().any(|x| x.is_nan()) {
            self.report.warn(self.at.line(number), damage.clone());
        }
        value
    }

    fn face(&mut self, number: u32, rest: &[u8]) {
        self.pending.clear();
        let counts = [
            self.obj.positions.len(),
            self.obj.texcoords.len(),
            self.obj.normals.len(),
        ];
        for word in words(rest) {
            if word.split(|letter| *letter == b'/').count() > 3 {
                let reason = format!(
                    "corner {:?} has more than three indices, those of a vertex, a texture coordinate and a normal",
                    shorten(word)
                );
                return self.bad_face(number, &reason);
            }
            let mut indices = [NONE; 3];
            for ((slot, part), count) in indices
                .iter_mut()
                .zip(word.split(|&b| b == b'/'))
                .zip(counts)
            {
                if part.is_empty() {
                    continue;
                }
                // Negative indices count back from the newest element.
                let index = match integer(part) {
                    Some(i) if i > 0 => i - 1,
                    Some(i) if i < 0 => count as i64 + i,
                    _ => -1,
                };
                if index < 0 || index >= i64::from(NONE) {
                    return self.bad_face(
                        number,
                        &format!(
                            "index {:?} in {:?}; they count from 1, or back from -1, to at most {count} so far",
                            shorten(part),
                            shorten(word)
                        ),
                    );
                }
                *slot = index as u32;
            }
            let [position, texcoord, normal] = indices;
            if position == NONE {
                return self.bad_face(number, &format!("no vertex in {:?}", shorten(word)));
            }
            if self.pending.len() == MAX_CORNERS {
                return self.bad_face(number, &format!("more than {MAX_CORNERS} corners"));
            }
            self.pending.push(FaceCorner {
                position,
                texcoord,
                normal,
            });
        }
        if self.pending.len() < 3 {
            return self.bad_face(number, "fewer than three corners");
        }
        if self.obj.corners.len() + self.pending.len() >= NONE as usize {
            return self.bad_face(number, &format!("faces of more than {NONE} corners in all"));
        }
        self.obj.corners.append(&mut self.pending);
        self.obj.face_ends.push(self.obj.corners.len() as u32);
    }

    fn bad_face(&mut self, number: u32, reason: &str) {
        self.report.warn(
            self.at.line(number),
            WarningKind::BadFace {
                reason: reason.to_owned(),
            },
        );
    }

    /// Ends the stretch of faces under the current names.
    fn close_run(&mut self) {
        let start = self.obj.face_groups.last().map_or(0, |run| run.faces.end);
        let end = self.obj.face_ends.len();
        if start == end {
            return;
        }
        let names = &self.names;
        match self.obj.face_groups.last_mut() {
            // `usemtl` with the same name again is the same stretch.
            Some(run)
                if run.object == names.object
                    && run.group == names.group
                    && run.material == names.material =>
            {
                run.faces.end = end;
            }
            _ => self.obj.face_groups.push(FaceGroup {
                object: names.object.clone(),
                group: names.group.clone(),
                material: names.material.clone(),
                faces: start..end,
            }),
        }
    }

    fn finish(mut self) -> ObjFile {
        self.close_run();
        self.check_indices();
        self.obj
    }

    /// Faces may stand before their vertices, so ranges are checked at the end.
    fn check_indices(&mut self) {
        let obj = &mut self.obj;
        let (positions, texcoords, normals) = (
            obj.positions.len() as u32,
            obj.texcoords.len() as u32,
            obj.normals.len() as u32,
        );
        let mut bad_attributes = 0;
        for corner in &mut obj.corners {
            if corner.texcoord != NONE && corner.texcoord >= texcoords {
                corner.texcoord = NONE;
                bad_attributes += 1;
            }
            if corner.normal != NONE && corner.normal >= normals {
                corner.normal = NONE;
                bad_attributes += 1;
            }
        }
        self.report
            .warn_times(self.at.clone(), WarningKind::NanAttributes, bad_attributes);
        if obj.corners.iter().all(|corner| corner.position < positions) {
            return;
        }
        let old = std::mem::take(obj);
        let mut bad = 0;
        for run in &old.face_groups {
            let start = obj.face_ends.len();
            for face in run.faces.clone() {
                let corners = old.face(face);
                if corners.iter().all(|corner| corner.position < positions) {
                    obj.corners.extend_from_slice(corners);
                    obj.face_ends.push(obj.corners.len() as u32);
                } else {
                    bad += 1;
                }
            }
            if obj.face_ends.len() > start {
                obj.face_groups.push(FaceGroup {
                    faces: start..obj.face_ends.len(),
                    ..run.clone()
                });
            }
        }
        let reason = format!("a vertex beyond the {positions} of the file");
        self.report
            .warn_times(self.at.clone(), WarningKind::BadFace { reason }, bad);
        *obj = ObjFile {
            corners: std::mem::take(&mut obj.corners),
            face_ends: std::mem::take(&mut obj.face_ends),
            face_groups: std::mem::take(&mut obj.face_groups),
            ..old
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (ObjFile, LoadReport) {
        let mut report = LoadReport::new();
        let obj = read_obj(text.as_bytes(), "a.obj", &mut report);
        (obj, report)
    }

    #[test]
    fn every_form_of_a_corner_is_read() {
        let (obj, report) = read(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3\nf  1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\nf -3 -2 -1\n",
        );
        assert!(report.is_empty(), "{report}");
        let second = |face: usize| obj.face(face)[1];
        assert_eq!(
            second(0),
            FaceCorner {
                position: 1,
                texcoord: NONE,
                normal: NONE
            }
        );
        assert_eq!(
            second(1),
            FaceCorner {
                position: 1,
                texcoord: 0,
                normal: NONE
            }
        );
        assert_eq!(
            second(2),
            FaceCorner {
                position: 1,
                texcoord: NONE,
                normal: 0
            }
        );
        assert_eq!(
            second(3),
            FaceCorner {
                position: 1,
                texcoord: 0,
                normal: 0
            }
        );
        assert_eq!(second(4).position, 1);
    }

    #[test]
    fn unreadable_numbers_are_nan_and_named_by_line() {
        let (obj, report) = read("v 0 0 0\nv nan 0 -1.#IND\nv 1 2\n");
        assert!(
            obj.positions[1][0].is_nan()
                && obj.positions[1][2].is_nan()
                && obj.positions[2][2].is_nan()
        );
        assert_eq!(obj.positions[1][1].to_bits(), 0);
        assert_eq!(report.warnings()[0].at.line, Some(2));
        assert_eq!(report.warnings()[0].count, 2);
    }

    #[test]
    fn bad_faces_are_left_out_and_the_rest_stays_in_its_run() {
        let (obj, report) = read(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\no A\nf 1 2 9\nf 1 2 3\nf 1 2\nf 0 1 2\nf x 1 2\nf -9 1 2\no B\nusemtl m\nf 1 2 3\n",
        );
        assert_eq!(obj.face_count(), 2);
        assert_eq!(obj.face_groups.len(), 2);
        assert_eq!(
            (
                obj.face_groups[1].object.as_str(),
                obj.face_groups[1].material.as_deref(),
                obj.face_groups[1].faces.clone()
            ),
            ("B", Some("m"), 1..2)
        );
        assert_eq!(
            report.count(|d| matches!(d, WarningKind::BadFace { .. })),
            5
        );
    }

    #[test]
    fn continued_lines_and_carriage_returns_are_read() {
        let (obj, report) = read("v 0 0 0\r\nv 1 0 \\\r\n 0\r\nv 0 1 0\r\nf 1 \\\n2 3");
        assert!(report.is_empty(), "{report}");
        assert_eq!((obj.positions.len(), obj.triangle_count()), (3, 1));
    }
}
