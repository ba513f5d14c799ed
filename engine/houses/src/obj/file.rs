//! The content of an OBJ and an MTL file, nothing interpreted.

use std::ops::Range;

/// An index that a face corner does not give.
pub const NONE: u32 = u32::MAX;

/// A Wavefront OBJ file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ObjFile {
    /// Names after `mtllib`, in order.
    pub material_libraries: Vec<String>,
    /// `v`, file units. A coordinate that is no finite number is NaN.
    pub positions: Vec<[f32; 3]>,
    /// `vt`.
    pub texcoords: Vec<[f32; 2]>,
    /// `vn`, not normalized.
    pub normals: Vec<[f32; 3]>,
    /// Corners of all faces, one face after another; positions are in range, the others are in range or [`NONE`].
    pub corners: Vec<FaceCorner>,
    /// End of each face in `corners`.
    pub face_ends: Vec<u32>,
    /// Stretches of faces under the same `o`, `g` and `usemtl`; together they cover all faces in order.
    pub face_groups: Vec<FaceGroup>,
}

/// A corner of a face: 0-based indices, or [`NONE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceCorner {
    /// Index into `positions`.
    pub position: u32,
    /// Index into `texcoords`.
    pub texcoord: u32,
    /// Index into `normals`.
    pub normal: u32,
}

/// Faces under the same names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaceGroup {
    /// The last `o`, empty before the first.
    pub object: String,
    /// The last `g`, empty before the first.
    pub group: String,
    /// The last `usemtl`.
    pub material: Option<String>,
    /// The range of its faces.
    pub faces: Range<usize>,
}

impl ObjFile {
    /// The corners of face `face`.
    pub fn face(&self, face: usize) -> &[FaceCorner] {
        let start = if face == 0 {
            0
        } else {
            self.face_ends[face - 1] as usize
        };
        &self.corners[start..self.face_ends[face] as usize]
    }

    /// Returns the number of faces.
    pub fn face_count(&self) -> usize {
        self.face_ends.len()
    }

    /// Returns the number of triangles of the fanned faces.
    pub fn triangle_count(&self) -> usize {
        self.corners.len() - 2 * self.face_ends.len()
    }
}

/// A Wavefront MTL file; the order of materials is the order of SUNCG's overrides.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MtlFile {
    /// The materials in file order.
    pub materials: Vec<MtlMaterial>,
}

/// One `newmtl`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MtlMaterial {
    /// Its name.
    pub name: String,
    /// `Ka`, 0 to 1.
    pub ambient: Option<[f32; 3]>,
    /// `Kd`, 0 to 1.
    pub diffuse: Option<[f32; 3]>,
    /// `Ks`, 0 to 1.
    pub specular: Option<[f32; 3]>,
    /// `Ke`.
    pub emission: Option<[f32; 3]>,
    /// `Ns`, Phong exponent.
    pub shininess: Option<f32>,
    /// `d`, or 1 - `Tr`: 1 is opaque.
    pub opacity: Option<f32>,
    /// `illum`.
    pub illumination: Option<i32>,
    /// `map_Kd`, as written, options removed.
    pub diffuse_map: Option<String>,
}

impl MtlMaterial {
    /// Perceptual roughness of the Phong exponent, 0 to 1; `None` without a specular colour.
    ///
    /// # Source
    /// B. Walter et al., EGSR 2007, section 5: a Blinn-Phong exponent n acts like a Beckmann width with
    /// n = 2 / alpha² - 2; the perceptual roughness of glTF 2.0 is the root of alpha.
    pub fn roughness(&self) -> Option<f32> {
        let shines = self
            .specular
            .is_some_and(|color| color.iter().any(|c| *c > 0.0));
        let exponent = self.shininess.filter(|n| shines && *n > 0.0)?;
        Some((2.0 / (exponent + 2.0)).sqrt().sqrt())
    }
}
