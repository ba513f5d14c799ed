//! Materials and images.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

use ::gltf::json::{Root, material::AlphaMode, validation::Checked};
use dwell_scene::material::library;
use dwell_scene::parallel::Threads;
use dwell_scene::{MaterialId, Texture, TextureId, units};

use super::buffers::{Buffers, read_uri};
use crate::build::{Look, LookTable, PixelBudget, decode, pixels, substance_of, texture_name};
use crate::damage::Damage;
use crate::limits::MAX_IMAGE_BYTES;
use crate::report::{At, Report};
use crate::root::DataRoot;

/// The images that base colours use, decoded; `ids` has an entry for each image of the file.
pub(super) struct Images {
    pub(super) textures: Vec<Arc<Texture>>,
    pub(super) ids: Vec<Option<TextureId>>,
}

/// Decodes the images in use.
pub(super) fn images(
    json: &Root,
    buffers: &Buffers<'_>,
    root: &DataRoot,
    at: &At,
    threads: Threads,
    report: &mut Report,
) -> Images {
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
        move |reason: String| Damage::UnreadableTexture {
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
                    Damage::MissingMesh { path } => Damage::MissingTexture { path },
                    Damage::UnreadableMesh { path, reason } => {
                        Damage::UnreadableTexture { path, reason }
                    }
                    other => other,
                })
            }
            (None, None) => Err(unreadable(k)("neither bytes nor a path".to_owned())),
        }
    };
    // Sizes first: many images may name the same few bytes.
    let sizes = threads.map(used.len(), |k| pixels(&bytes_of(k)?).map_err(unreadable(k)));
    let mut budget = PixelBudget::default();
    let within: Vec<Result<(), Damage>> = sizes
        .into_iter()
        .enumerate()
        .map(|(k, size)| budget.take(size?).map_err(unreadable(k)))
        .collect();
    let decoded = threads.map(used.len(), |k| {
        within[k].clone()?;
        decode(&name_of(k), &bytes_of(k)?).map_err(unreadable(k))
    });
    let mut images = Images {
        textures: Vec::new(),
        ids: vec![None; json.images.len()],
    };
    for (k, result) in used.into_iter().zip(decoded) {
        match result {
            Ok(texture) => {
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

/// The materials of the file, and after them the one that primitives without a material show.
pub(super) fn materials(json: &Root, images: &Images, looks: &mut LookTable) -> Vec<MaterialId> {
    let mut ids = Vec::new();
    for (k, material) in json.materials.iter().enumerate() {
        let name = material
            .name
            .clone()
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| format!("material_{k}"));
        let pbr = &material.pbr_metallic_roughness;
        let texture =
            image_of(json, material).and_then(|image| images.ids.get(image).copied().flatten());
        let [r, g, b, a] = pbr.base_color_factor.0;
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
            } else if pbr.metallic_factor.0 > 0.5 {
                "steel"
            } else {
                ""
            };
            library().get_or_default(of_look)
        };
        let substance = named.unwrap_or_else(usual);
        ids.push(looks.add(&Look {
            srgb: [r, g, b].map(units::srgb_from_linear),
            texture,
            opacity,
            emission: material.emissive_factor.0,
            roughness: Some(pbr.roughness_factor.0),
            metallic: Some(pbr.metallic_factor.0),
            ..Look::plain(&name, substance)
        }));
    }
    ids.push(looks.add(&Look {
        srgb: [1.0; 3],
        ..Look::plain("default", library().default_substance())
    }));
    ids
}
