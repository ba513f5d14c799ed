//! Meshes and materials as OBJ and MTL text.

use std::fmt::Write as _;

use dwell_scene::{Material, Mesh, units};
use glam::{Affine3A, Vec3};

/// The text of an OBJ file under construction.
///
/// Numbers are written as the shortest that read back as the same bits.
#[derive(Default)]
pub(crate) struct ObjWriter {
    text: String,
    /// Lines of each kind written so far: v, vt, vn.
    counts: [usize; 3],
}

impl ObjWriter {
    /// Appends a mesh after `map`, under the name `object` when it has one; `slot_name` names the material of a slot.
    pub(crate) fn mesh(
        &mut self,
        object: Option<&str>,
        mesh: &Mesh,
        map: &Affine3A,
        slot_name: impl Fn(u16) -> String,
    ) {
        // Writing into a string cannot fail.
        if let Some(object) = object {
            let _ = writeln!(self.text, "o {}", object.replace(['\n', '\r'], " "));
        }
        for p in &mesh.positions {
            let p = if *map == Affine3A::IDENTITY {
                *p
            } else {
                map.transform_point3(*p)
            };
            let _ = writeln!(self.text, "v {} {} {}", p.x, p.y, p.z);
        }
        for uv in &mesh.uvs {
            let _ = writeln!(self.text, "vt {} {}", uv.x, uv.y);
        }
        let normal_map = map.matrix3.inverse().transpose();
        for n in &mesh.normals {
            let n = if *map == Affine3A::IDENTITY {
                *n
            } else {
                (normal_map * *n).normalize_or(Vec3::Y)
            };
            let _ = writeln!(self.text, "vn {} {} {}", n.x, n.y, n.z);
        }
        let mirrors = map.matrix3.determinant() < 0.0;
        let mut shown = None;
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let slot = mesh.slot(k);
            if shown != Some(slot) {
                let _ = writeln!(self.text, "usemtl {}", slot_name(slot));
                shown = Some(slot);
            }
            self.text.push('f');
            let [a, b, c] = *triangle;
            for vertex in if mirrors { [a, c, b] } else { [a, b, c] } {
                self.corner(mesh, vertex as usize);
            }
            self.text.push('\n');
        }
        self.counts[0] += mesh.positions.len();
        self.counts[1] += mesh.uvs.len();
        self.counts[2] += mesh.normals.len();
    }

    fn corner(&mut self, mesh: &Mesh, vertex: usize) {
        let [v, vt, vn] = self.counts.map(|count| count + vertex + 1);
        let _ = match (mesh.uvs.is_empty(), mesh.normals.is_empty()) {
            (true, true) => write!(self.text, " {v}"),
            (false, true) => write!(self.text, " {v}/{vt}"),
            (true, false) => write!(self.text, " {v}//{vn}"),
            (false, false) => write!(self.text, " {v}/{vt}/{vn}"),
        };
    }

    /// Returns the text so far.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The file's text; its materials stand in `mtl_file`.
    pub(crate) fn into_text(self, mtl_file: &str) -> String {
        format!("mtllib {mtl_file}\n{}", self.text)
    }
}

/// A material as one `newmtl`; `texture` is the path of its image relative to the file's folder.
pub(crate) fn mtl_material(name: &str, material: &Material, texture: Option<&str>) -> String {
    let [r, g, b] = material.base_color.map(units::srgb_from_linear);
    // The exponent whose roughness this is; see `MtlMaterial::roughness`.
    let alpha = f64::from(material.roughness).powi(2).max(1e-3);
    let exponent = (2.0 / (alpha * alpha) - 2.0).max(1e-3);
    let mut text = format!(
        "newmtl {name}\nKd {r} {g} {b}\nKs 1 1 1\nNs {exponent}\nd {}\nillum 2\n",
        material.opacity
    );
    if material.emission.iter().any(|e| *e > 0.0) {
        let [r, g, b] = material.emission;
        let _ = writeln!(text, "Ke {r} {g} {b}");
    }
    if let Some(texture) = texture {
        let _ = writeln!(text, "map_Kd {texture}");
    }
    text
}
