//! Conversion of looks of files into materials of the house, each once.

use std::collections::BTreeMap;

use dwell_scene::material::Substance;
use dwell_scene::{IdVec, Material, MaterialId, TextureId, units};

use super::UniqueNames;

/// A surface's look in its file, and its substance.
#[derive(Debug, Clone)]
pub(crate) struct ImportedMaterial {
    /// The name for the material.
    pub(crate) name: String,
    /// sRGB-encoded colour, each 0 to 1; multiplies the texture.
    pub(crate) srgb: [f32; 3],
    /// The image, if there is one.
    pub(crate) texture: Option<TextureId>,
    /// Opacity; 1 is opaque.
    pub(crate) opacity: f32,
    /// Emitted light, linear.
    pub(crate) emission: [f32; 3],
    /// As in glTF 2.0; `None`: the substance's.
    pub(crate) roughness: Option<f32>,
    /// As in glTF 2.0; `None`: the substance's.
    pub(crate) metallic: Option<f32>,
    /// Its substance.
    pub(crate) substance: &'static Substance,
}

impl ImportedMaterial {
    /// A grey surface of `substance`.
    pub(crate) fn plain(name: &str, substance: &'static Substance) -> Self {
        Self {
            name: name.to_owned(),
            srgb: [0.8; 3],
            texture: None,
            opacity: 1.0,
            emission: [0.0; 3],
            roughness: None,
            metallic: None,
            substance,
        }
    }
}

/// The key of equal looks, as bits.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct MaterialKey {
    name: String,
    numbers: [u32; 9],
    texture: Option<TextureId>,
    substance: String,
}

/// Materials of a house under construction; equal looks are one material.
#[derive(Debug, Default)]
pub(crate) struct MaterialTableBuilder {
    materials: IdVec<MaterialId, Material>,
    known: BTreeMap<MaterialKey, MaterialId>,
    names: UniqueNames,
}

impl MaterialTableBuilder {
    /// The material of `look`, made when it is new. Numbers out of range are brought into it.
    pub(crate) fn add(&mut self, look: &ImportedMaterial) -> MaterialId {
        let unit = |value: f32| {
            if value.is_finite() {
                value.clamp(0.0, 1.0)
            } else {
                0.0
            }
        };
        let srgb = look.srgb.map(unit);
        let emission = look.emission.map(|value| {
            if value.is_finite() {
                value.clamp(0.0, 1e6)
            } else {
                0.0
            }
        });
        let opacity = unit(look.opacity);
        let roughness = look.roughness.map_or(look.substance.roughness, unit);
        let metallic = look.metallic.map_or(look.substance.metallic, unit);
        let [r, g, b] = srgb;
        let [er, eg, eb] = emission;
        let numbers = [r, g, b, er, eg, eb, opacity, roughness, metallic].map(f32::to_bits);
        // A slash would split the parameter address `material/<name>/...`.
        let name = look.name.replace(['/', '\\'], "-");
        let key = MaterialKey {
            name: name.clone(),
            numbers,
            texture: look.texture,
            substance: look.substance.name.clone(),
        };
        if let Some(&id) = self.known.get(&key) {
            return id;
        }
        let material = Material {
            base_color: srgb.map(units::linear_from_srgb),
            texture: look.texture,
            emission,
            opacity,
            metallic,
            roughness,
            ..Material::from_substance(self.names.unique(&name), look.substance)
        };
        let id = self.materials.push(material);
        self.known.insert(key, id);
        id
    }

    /// Changes a material that was added.
    pub(crate) fn modify(&mut self, id: MaterialId, change: impl FnOnce(&mut Material)) {
        if let Some(material) = self.materials.get_mut(id) {
            change(material);
        }
    }

    /// All materials.
    pub(crate) fn finish_materials(self) -> IdVec<MaterialId, Material> {
        self.materials
    }
}
