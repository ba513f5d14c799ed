//! Materials and images.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

use ::gltf::json::{Root, material::AlphaMode, validation::Checked};
use dwell_scene::material::{Bands, library};
use dwell_scene::parallel::Threads;
use dwell_scene::{Material, MaterialId, Texture, TextureId, units};
use serde::Deserialize;

use super::buffers::{Buffers, read_uri};
use super::extras::dwell_extras;
use crate::data_root::DataRoot;
use crate::import::{
    ImportedMaterial, MaterialTableBuilder, PixelBudget, decode, header_pixel_count,
    is_truncated_jpeg, substance_of, texture_name,
};
use crate::limits::MAX_IMAGE_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::unit_factors::unit_factors;
use crate::warning_kind::WarningKind;

/// The images that base colours use, decoded; `ids` has an entry for each image of the file.
pub(super) struct DecodedImages {
    pub(super) textures: Vec<Arc<Texture>>,
    pub(super) ids: Vec<Option<TextureId>>,
}

/// Decodes the images in use.
pub(super) fn images(
    json: &Root,
    buffers: &Buffers<'_>,
    root: &DataRoot,
    at: &FileLocation,
    threads: Threads,
    report: &mut LoadReport,
) -> DecodedImages {
    let used: BTreeSet<usize> = json
        .materials
        .iter()
        .filter_map(|material| image_of(json, material))
        .filter(|image| *image < json.images.len())
        .collect();
    let used: Vec<usize> = used.into_iter().collect();
    let name_of = |k: usize| {
        let image = &json.images[used[k]];
        let own = image.name.clone().or_else(|| {
            image
                .uri
                .as_deref()
                .filter(|uri| !uri.starts_with("data:"))
                .map(texture_name)
        });
        own.filter(|name| !name.is_empty())
            .unwrap_or_else(|| format!("image_{}", used[k]))
    };
    let unreadable = |k: usize| {
        move |reason: String| WarningKind::UnreadableTexture {
            path: name_of(k),
            reason,
        }
    };
    let bytes_of = |k: usize| {
        let image = &json.images[used[k]];
        let in_view = image
            .buffer_view
            .and_then(|view| json.buffer_views.get(view.value()));
        match (in_view, &image.uri) {
            (Some(view), _) => buffers
                .view(view)
                .map(Cow::Borrowed)
                .ok_or_else(|| unreadable(k)("no such bytes".to_owned())),
            (None, Some(uri)) => {
                let bytes = read_uri(uri, root, MAX_IMAGE_BYTES);
                bytes.map(Cow::Owned).map_err(|damage| match damage {
                    WarningKind::MissingMesh { path } => WarningKind::MissingTexture { path },
                    WarningKind::UnreadableMesh { path, reason } => {
                        WarningKind::UnreadableTexture { path, reason }
                    }
                    other => other,
                })
            }
            (None, None) => Err(unreadable(k)("neither bytes nor a path".to_owned())),
        }
    };
    // Sizes first: many images may name the same few bytes.
    let sizes = threads.map(used.len(), |k| {
        header_pixel_count(&bytes_of(k)?).map_err(unreadable(k))
    });
    let mut budget = PixelBudget::default();
    let within: Vec<Result<(), WarningKind>> = sizes
        .into_iter()
        .enumerate()
        .map(|(k, size)| budget.reserve(size?).map_err(unreadable(k)))
        .collect();
    let decoded = threads.map(used.len(), |k| {
        within[k].clone()?;
        let bytes = bytes_of(k)?;
        let texture = decode(&name_of(k), &bytes).map_err(unreadable(k))?;
        Ok((texture, is_truncated_jpeg(&bytes)))
    });
    let mut images = DecodedImages {
        textures: Vec::new(),
        ids: vec![None; json.images.len()],
    };
    for (k, result) in used.into_iter().zip(decoded) {
        match result {
            Ok((texture, cut)) => {
                if cut {
                    let path = texture.name.clone();
                    let at = at.field(format_args!("images[{k}]"));
                    report.warn(at, WarningKind::TruncatedTexture { path });
                }
                images.ids[k] = Some(TextureId(images.textures.len() as u32));
                images.textures.push(Arc::new(texture));
            }
            Err(damage) => report.warn(at.field(format_args!("images[{k}]")), damage),
        }
    }
    images
}

fn image_of(json: &Root, material: &::gltf::json::Material) -> Option<usize> {
    let texture = material
        .pbr_metallic_roughness
        .base_color_texture
        .as_ref()?
        .index;
    Some(json.textures.get(texture.value())?.source.value())
}

/// A material's `extras.dwell`: what it is beyond its looks.
#[derive(Default, Deserialize)]
#[serde(default)]
struct DwellMaterialExtras {
    substance: Option<String>,
    emission: Option<[f32; 3]>,
    density_kg_m3: Option<f32>,
    friction: Option<f32>,
    restitution: Option<f32>,
    absorption: Option<Bands>,
    scattering: Option<Bands>,
    transmission_loss_db: Option<Bands>,
}

impl DwellMaterialExtras {
    fn read(material: &::gltf::json::Material, at: &FileLocation, report: &mut LoadReport) -> Self {
        dwell_extras(
            material.extras.as_ref().map(|extras| extras.get()),
            at,
            report,
        )
    }

    /// Replaces those of the substance by its numbers.
    fn refine(self, material: &mut Material) {
        fn set<T>(to: &mut T, value: Option<T>) {
            if let Some(value) = value {
                *to = value;
            }
        }
        set(&mut material.emission, self.emission);
        set(&mut material.density_kg_m3, self.density_kg_m3);
        set(&mut material.friction, self.friction);
        set(&mut material.restitution, self.restitution);
        set(&mut material.absorption, self.absorption);
        set(&mut material.scattering, self.scattering);
        set(
            &mut material.transmission_loss_db,
            self.transmission_loss_db,
        );
    }
}

/// The materials of the file, and after them the one of primitives without a material, if there are such.
pub(super) fn materials(
    json: &Root,
    images: &DecodedImages,
    trusted: bool,
    looks: &mut MaterialTableBuilder,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Vec<MaterialId> {
    let mut ids = Vec::new();
    for (k, material) in json.materials.iter().enumerate() {
        let name = material
            .name
            .clone()
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| format!("material_{k}"));
        let pbr = &material.pbr_metallic_roughness;
        let mut not_finite = 0_u64;
        let mut finite = |factor: f32, usual: f32| {
            if factor.is_finite() {
                return factor;
            }
            not_finite += 1;
            usual
        };
        let [r, g, b, a] = pbr.base_color_factor.0.map(|x| finite(x, 1.0));
        let emission = material.emissive_factor.0.map(|x| finite(x, 0.0));
        let roughness = finite(pbr.roughness_factor.0, 1.0);
        let metallic = finite(pbr.metallic_factor.0, 1.0);
        if not_finite > 0 {
            let damage = WarningKind::BadField {
                found: "a factor that is too large".to_owned(),
                expected: "0 to 1".to_owned(),
            };
            let at = at.field(format_args!("materials[{k}]"));
            report.warn_times(at, damage, not_finite);
        }
        let at = at.field(format_args!("materials[{k}]"));
        let factors = [r, g, b, a, roughness, metallic].map(f64::from);
        let [r, g, b, a, roughness, metallic] = unit_factors(factors, &at, report);
        let texture =
            image_of(json, material).and_then(|image| images.ids.get(image).copied().flatten());
        let opacity = if material.alpha_mode == Checked::Valid(AlphaMode::Blend) {
            a
        } else {
            1.0
        };
        let named = substance_of(&name)
            .or_else(|| texture.and_then(|id| substance_of(&images.textures[id.0 as usize].name)));
        let usual = || {
            let of_look = if opacity < 1.0 {
                "glass"
            } else if metallic > 0.5 {
                "steel"
            } else {
                ""
            };
            library().get_or_default(of_look)
        };
        let known = if trusted {
            DwellMaterialExtras::read(material, &at, report)
        } else {
            DwellMaterialExtras::default()
        };
        let said = known.substance.as_deref();
        let said = said.and_then(|name| library().get(name));
        let substance = said.or(named).unwrap_or_else(usual);
        let id = looks.add(&ImportedMaterial {
            srgb: [r, g, b].map(units::srgb_from_linear),
            texture,
            opacity,
            emission,
            roughness: Some(roughness),
            metallic: Some(metallic),
            ..ImportedMaterial::plain(&name, substance)
        });
        looks.modify(id, |material| {
            // The colour of the file takes precedence over one that was rounded on the way.
            if trusted && said.is_some() {
                material.base_color = [r, g, b].map(|c| c.clamp(0.0, 1.0));
            }
            known.refine(material);
        });
        ids.push(id);
    }
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let without = primitives.any(|primitive| primitive.material.is_none());
    if without || ids.is_empty() {
        ids.push(looks.add(&ImportedMaterial {
            srgb: [1.0; 3],
            ..ImportedMaterial::plain("default", library().default_substance())
        }));
    }
    ids
}
