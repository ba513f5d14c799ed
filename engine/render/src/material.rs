//! Materials as cameras see them.

use crate::color::SrgbTables;
use crate::texture::Textures;
use dwell_scene::bvh::flat::PackedRow;
use dwell_scene::{House, Id, Material};

/// No texture.
const NONE: u32 = u32::MAX;

/// Metalness from which on a smooth surface is a mirror.
const MIRROR_METALLIC: f32 = 0.9;
/// Roughness up to which a metal is a mirror: smoother than polished steel.
const MIRROR_ROUGHNESS: f32 = 0.05;

/// One material, prepared.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadingMaterial {
    /// Colour in linear light; multiplies the texture.
    pub(crate) base: [f32; 3],
    /// Position of the image, or [`NONE`].
    texture: u32,
    /// The share of light that does not pass straight through; multiplies the texture's alpha.
    pub(crate) opacity: f32,
    /// Light of its own, in units of display white.
    pub(crate) emission: [f32; 3],
    /// Pixels of the image, across times down.
    pub(crate) texel_count: f32,
    /// The bytes of an opaque colour without texture.
    plain: Option<[u8; 3]>,
    /// True if light may pass.
    pub(crate) transmits_light: bool,
    /// Perceptual roughness, 0 to 1.
    pub(crate) roughness: f32,
    /// 0 (no metal) to 1 (metal).
    pub(crate) metallic: f32,
    /// True if lit pictures show its reflections.
    pub(crate) mirror: bool,
}

impl ShadingMaterial {
    pub(crate) fn new(material: &Material, textures: &Textures) -> Self {
        let srgb = SrgbTables::tables();
        let mut look = Self {
            base: material.base_color,
            texture: NONE,
            opacity: material.opacity,
            emission: material.emission,
            texel_count: 0.0,
            plain: None,
            transmits_light: material.opacity < 1.0,
            roughness: material.roughness,
            metallic: material.metallic,
            mirror: material.metallic >= MIRROR_METALLIC && material.roughness <= MIRROR_ROUGHNESS,
        };
        if let Some(texture) = material.texture {
            if let Some([r, g, b, a]) = textures.uniform_color(texture) {
                // An image of one colour is a colour.
                look.base = std::array::from_fn(|k| look.base[k] * srgb.decode([r, g, b][k]));
                look.opacity *= f32::from(a) / 255.0;
                look.transmits_light |= a < 255;
            } else {
                let (width, height) = textures.size(texture);
                look.texture = texture.index() as u32;
                look.texel_count = width * height;
                look.transmits_light |= textures.has_transparency(texture);
            }
        }
        if look.texture == NONE && !look.transmits_light {
            look.plain = Some(srgb.encode3(look.base));
        }
        look
    }

    /// Returns the look of agents' bodies: a middle blue, unlike most furniture.
    pub(crate) fn agent_body() -> Self {
        let base = [0.08, 0.19, 0.42];
        Self {
            base,
            texture: NONE,
            opacity: 1.0,
            emission: [0.0; 3],
            texel_count: 0.0,
            plain: Some(SrgbTables::tables().encode3(base)),
            transmits_light: false,
            roughness: 1.0,
            metallic: 0.0,
            mirror: false,
        }
    }

    /// Every material of a house, in order.
    pub(crate) fn all(house: &House, textures: &Textures) -> Vec<Self> {
        house
            .materials
            .iter()
            .map(|material| Self::new(material, textures))
            .collect()
    }

    /// The image.
    #[inline]
    pub(crate) fn texture(&self) -> Option<u32> {
        (self.texture != NONE).then_some(self.texture)
    }

    /// As rows: colour and opacity; emission and pixels of the image; the image and whether it is a mirror.
    pub(crate) fn packed_rows(&self) -> [PackedRow; 3] {
        let row = |[x, y, z]: [f32; 3], last: f32| [x, y, z, last].map(f32::to_bits);
        [
            row(self.base, self.opacity),
            row(self.emission, self.texel_count),
            [self.texture, u32::from(self.mirror), 0, 0],
        ]
    }

    /// The bytes of an opaque colour without texture.
    #[inline]
    pub(crate) fn opaque_srgb(&self) -> Option<[u8; 3]> {
        self.plain
    }
}
