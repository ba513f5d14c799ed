//! Materials of slots, by the model's file and overrides.

use dwell_scene::material::{Substance, library};
use dwell_scene::{MaterialId, StructureKind, TextureId};

use super::super::file::SuncgMaterial;
use super::Converter;
use crate::import::{ImportedMaterial, category, substance_of};
use crate::obj::MaterialSlots;
use crate::obj::ParsedObj;
use crate::report::FileLocation;
use crate::warning_kind::{UnmappedKind, WarningKind};

impl<'a> Converter<'a> {
    /// The material of a slot of a wall, floor or ceiling.
    pub(super) fn structure_material(
        &mut self,
        files: &'a ParsedObj,
        slots: &MaterialSlots,
        slot: u16,
        kind: StructureKind,
    ) -> MaterialId {
        let usual = usual_of_structure(kind);
        let surface = self.slot_surface(files, slots, usize::from(slot));
        let substance = surface.named_substance().unwrap_or(usual);
        self.add_material(&surface, substance, false)
    }

    /// The material of a side of a wall or slab that has only those of `change`.
    pub(super) fn plain_structure_material(
        &mut self,
        change: Option<&'a SuncgMaterial>,
        kind: StructureKind,
        at: &FileLocation,
    ) -> MaterialId {
        let mut surface = SlotSurface::default();
        if let Some(change) = change {
            self.apply_override(&mut surface, change, at);
        }
        let substance = surface
            .named_substance()
            .unwrap_or_else(|| usual_of_structure(kind));
        self.add_material(&surface, substance, false)
    }

    /// The materials of an object's slots after its overrides.
    ///
    /// Overrides count positions in the model's MTL file; a name only labels one.
    pub(super) fn object_materials(
        &mut self,
        files: &'a ParsedObj,
        slots: &MaterialSlots,
        overrides: &[&'a SuncgMaterial],
        usual: &'static Substance,
        emissive: &[usize],
        at: &FileLocation,
    ) -> Vec<MaterialId> {
        if overrides.len() > slots.entries.len() {
            let damage = WarningKind::ExtraOverrides {
                found: overrides.len(),
                allowed: slots.entries.len(),
            };
            self.report.warn(at.field("materials"), damage);
        }
        (0..slots.entries.len())
            .map(|slot| {
                let mut surface = self.slot_surface(files, slots, slot);
                if let Some(&change) = overrides.get(slot) {
                    self.apply_override(
                        &mut surface,
                        change,
                        &at.field(format_args!("materials[{slot}]")),
                    );
                }
                let substance = self.substance(&surface, usual, at);
                self.add_material(&surface, substance, emissive.contains(&slot))
            })
            .collect()
    }

    /// The material of a box's face, which has only what its override says.
    pub(super) fn box_material(
        &mut self,
        change: Option<&'a SuncgMaterial>,
        at: &FileLocation,
    ) -> MaterialId {
        let mut surface = SlotSurface::default();
        if let Some(change) = change {
            self.apply_override(&mut surface, change, at);
        }
        let substance = self.substance(&surface, library().default_substance(), at);
        self.add_material(&surface, substance, false)
    }

    fn slot_surface(
        &mut self,
        files: &'a ParsedObj,
        slots: &MaterialSlots,
        slot: usize,
    ) -> SlotSurface<'a> {
        let Some(in_file) = slots.entries[slot].1 else {
            return SlotSurface::default();
        };
        let material = &files.mtl.materials[in_file];
        let mut surface = SlotSurface {
            srgb: material.diffuse.unwrap_or([1.0; 3]),
            opacity: material.opacity.unwrap_or(1.0),
            roughness: material.roughness(),
            emission: material.emission.unwrap_or([0.0; 3]),
            ..SlotSurface::default()
        };
        if let Some((path, _)) = files.textures[in_file]
            .as_ref()
            .and_then(|path| self.files.textures.get_key_value(path))
        {
            surface.texture = Some(path);
        }
        surface.names.push(&material.name);
        surface
    }

    fn apply_override(
        &mut self,
        surface: &mut SlotSurface<'a>,
        change: &'a SuncgMaterial,
        at: &FileLocation,
    ) {
        let diffuse = change.diffuse.as_deref().and_then(|text| {
            let color = parse_color(text);
            if color.is_none() {
                self.report.warn(
                    at.field("diffuse"),
                    WarningKind::BadColor {
                        found: text.to_owned(),
                    },
                );
            }
            color
        });
        // A missing texture was reported when the files were read; the model's own surface stays.
        let texture = change
            .texture
            .as_deref()
            .and_then(|name| self.files.override_texture_path(name));
        if let Some(name) = &change.name {
            surface.names.insert(0, name);
        }
        if let Some(path) = texture {
            // Its colour tints a texture; a plain slot's colour is what the texture replaces.
            if surface.texture.is_none() {
                surface.srgb = [1.0; 3];
            }
            surface.texture = Some(path);
        }
        if let Some(color) = diffuse {
            surface.srgb = color;
            // A colour alone takes the place of the model's texture.
            if texture.is_none() {
                surface.texture = None;
            }
        }
    }

    /// Returns the substance of a surface: by its names, by its transparency, else as usual for the kind of thing.
    fn substance(
        &mut self,
        surface: &SlotSurface<'_>,
        usual: &'static Substance,
        at: &FileLocation,
    ) -> &'static Substance {
        if let Some(found) = surface.named_substance() {
            return found;
        }
        if let Some(path) = surface.texture {
            let damage = WarningKind::Unmapped {
                what: UnmappedKind::Substance,
                name: crate::import::texture_name(path),
            };
            self.report.warn(at.clone(), damage);
        }
        if surface.opacity < 1.0 {
            library().get_or_default("glass")
        } else {
            usual
        }
    }

    fn add_material(
        &mut self,
        surface: &SlotSurface<'a>,
        substance: &'static Substance,
        glows: bool,
    ) -> MaterialId {
        let texture = surface.texture.map(|path| self.texture(path));
        let hex = || {
            surface
                .srgb
                .map(|c| format!("{:02x}", (c.clamp(0.0, 1.0) * 255.0).round() as u8))
                .concat()
        };
        let name = match surface.texture.map(crate::import::texture_name) {
            Some(name) if hex() == "ffffff" => name,
            Some(name) => format!("{name}_{}", hex()),
            None => format!("{}_{}", substance.name, hex()),
        };
        let emission = if glows {
            surface.srgb.map(dwell_scene::units::linear_from_srgb)
        } else {
            surface.emission
        };
        self.looks.add(&ImportedMaterial {
            name,
            srgb: surface.srgb,
            texture,
            opacity: surface.opacity,
            emission,
            roughness: surface.roughness,
            metallic: None,
            substance,
        })
    }

    /// The house's texture of a path; only those in use become part of it.
    fn texture(&mut self, path: &'a str) -> TextureId {
        *self
            .textures
            .entry(path)
            .or_insert_with(|| self.data.textures.push(self.files.textures[path].clone()))
    }
}

/// Returns the usual substance of walls, floors and ceilings.
fn usual_of_structure(kind: StructureKind) -> &'static Substance {
    let name = match kind {
        StructureKind::Floor => "floor",
        StructureKind::Ground => "ground",
        StructureKind::Ceiling => "ceiling",
        StructureKind::Wall | StructureKind::Other => "wall",
    };
    category([name]).map_or_else(|| library().default_substance(), |row| row.substance())
}

/// The look of a material slot.
struct SlotSurface<'a> {
    srgb: [f32; 3],
    /// Path of a texture that exists.
    texture: Option<&'a str>,
    opacity: f32,
    roughness: Option<f32>,
    emission: [f32; 3],
    /// Labels that may name its substance, the most specific first; the texture's name precedes them.
    names: Vec<&'a str>,
}

impl SlotSurface<'_> {
    fn named_substance(&self) -> Option<&'static Substance> {
        self.texture
            .and_then(substance_of)
            .or_else(|| self.names.iter().find_map(|name| substance_of(name)))
    }
}

impl Default for SlotSurface<'_> {
    fn default() -> Self {
        Self {
            srgb: [0.8; 3],
            texture: None,
            opacity: 1.0,
            roughness: None,
            emission: [0.0; 3],
            names: Vec::new(),
        }
    }
}

/// `#rrggbb` as sRGB-encoded values, each 0 to 1.
fn parse_color(text: &str) -> Option<[f32; 3]> {
    let digits = text.trim().strip_prefix('#')?;
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let value = u32::from_str_radix(digits, 16).ok()?;
    Some([16, 8, 0].map(|shift| (value >> shift & 255) as f32 / 255.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_six_hexadecimal_digits_are_a_color() {
        assert_eq!(parse_color("#8e00ff"), Some([142.0 / 255.0, 0.0, 1.0]));
        for text in ["8e00ff", "#8e00f", "#8e00fff", "#+e00ff", "red", "", "#ééé"] {
            assert_eq!(parse_color(text), None, "{text}");
        }
    }
}
