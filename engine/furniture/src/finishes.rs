//! Finishes: what a surface is made of and how it looks, before a house gives it ids.

use super::textures::{Srgb, TexturePattern};
use dwell_scene::material::{Substance, library};
use dwell_scene::{Material, TextureId};

/// The substance and the appearance of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// Name of the material; a number is appended where appearances differ.
    pub name: &'static str,
    /// A name of `assets/materials.toml`.
    pub substance: &'static str,
    /// Colour; multiplies the image.
    pub srgb: Srgb,
    /// The image.
    pub pattern: Option<TexturePattern>,
    /// Edge of one repeat of the image, m; 0: the image fills its surface once, as the shape's coordinates say.
    pub tile_m: f32,
    /// Fraction of light that does not pass; `None`: the substance's.
    pub opacity: Option<f32>,
    /// Linear light that it sends out.
    pub emission: [f32; 3],
}

/// White: an image shows as it is.
const WHITE: Srgb = [255; 3];

impl Finish {
    /// A plain colour.
    pub const fn plain(name: &'static str, substance: &'static str, srgb: Srgb) -> Self {
        Self {
            name,
            substance,
            srgb,
            pattern: None,
            tile_m: 0.0,
            opacity: None,
            emission: [0.0; 3],
        }
    }

    /// A repeating image.
    pub const fn tiled(
        name: &'static str,
        substance: &'static str,
        generator: &'static str,
        colors: [Srgb; 3],
        tile_m: f32,
    ) -> Self {
        let pattern = Some(TexturePattern {
            generator,
            colors,
            seed: 1,
        });
        Self {
            pattern,
            tile_m,
            ..Self::plain(name, substance, WHITE)
        }
    }

    /// One image over the whole surface.
    pub const fn picture(
        name: &'static str,
        substance: &'static str,
        generator: &'static str,
        colors: [Srgb; 3],
        seed: u64,
    ) -> Self {
        let pattern = Some(TexturePattern {
            generator,
            colors,
            seed,
        });
        Self {
            pattern,
            ..Self::plain(name, substance, WHITE)
        }
    }

    /// The same finish, glowing.
    #[must_use]
    pub const fn emissive(mut self, emission: [f32; 3]) -> Self {
        self.emission = emission;
        self
    }

    /// The same finish, letting light through.
    #[must_use]
    pub const fn transparent(mut self, opacity: f32) -> Self {
        self.opacity = Some(opacity);
        self
    }

    /// Share of substance in bars and thin plates of it: metal ones are tubes and sheets.
    pub fn hollow_fill_fraction(&self) -> f32 {
        let metals = ["steel", "chrome", "brass", "aluminium"];
        if metals.contains(&self.substance) {
            0.15
        } else {
            1.0
        }
    }

    /// Share of substance in something stuffed that it covers: the whole weighs as much as upholstery.
    pub fn padded_fill_fraction(&self) -> f32 {
        let stuffed = library().get_or_default("upholstery").density_kg_m3;
        (stuffed / self.substance().density_kg_m3).min(1.0)
    }

    /// Returns what it is made of.
    pub fn substance(&self) -> &'static Substance {
        library().get_or_default(self.substance)
    }

    /// The material of a house.
    pub fn material(&self, name: String, texture: Option<TextureId>) -> Material {
        let mut material = Material::from_substance(name, self.substance()).with_srgb(self.srgb);
        material.texture = texture;
        material.emission = self.emission;
        material.opacity = self.opacity.unwrap_or(material.opacity);
        material
    }
}

// ---- woods

/// Light oak.
pub const fn oak() -> Finish {
    Finish::tiled(
        "oak",
        "oak",
        "wood",
        [[196, 158, 110], [158, 116, 72], [0; 3]],
        0.8,
    )
}

/// Dark walnut.
pub const fn walnut() -> Finish {
    Finish::tiled(
        "walnut",
        "wood",
        "wood",
        [[120, 82, 54], [74, 46, 30], [0; 3]],
        0.8,
    )
}

/// Pale pine.
pub const fn pine() -> Finish {
    Finish::tiled(
        "pine",
        "pine",
        "wood",
        [[226, 192, 140], [200, 156, 100], [0; 3]],
        0.7,
    )
}

/// Reddish beech.
pub const fn beech() -> Finish {
    Finish::tiled(
        "beech",
        "wood",
        "wood",
        [[214, 164, 118], [188, 132, 88], [0; 3]],
        0.7,
    )
}

/// Golden brown teak.
pub const fn teak() -> Finish {
    Finish::tiled(
        "teak",
        "wood",
        "wood",
        [[178, 128, 82], [146, 98, 58], [0; 3]],
        0.8,
    )
}

/// Boards with white lacquer.
pub const fn white_lacquer() -> Finish {
    Finish::plain("white_lacquer", "particle_board", [238, 236, 230])
}

/// Grey boards, for carcasses behind light fronts: the gaps show.
pub const fn grey_board() -> Finish {
    Finish::plain("grey_board", "particle_board", [168, 168, 164])
}

/// Boards with lacquer of a colour.
pub const fn lacquer(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "particle_board", srgb)
}

// ---- cloth

/// Woven upholstery over foam.
pub const fn upholstery(name: &'static str, srgb: Srgb) -> Finish {
    Finish {
        srgb,
        ..Finish::tiled(name, "upholstery", "weave", [WHITE, [225; 3], [0; 3]], 0.06)
    }
}

/// Woven cloth.
pub const fn cloth(name: &'static str, srgb: Srgb) -> Finish {
    Finish {
        srgb,
        ..Finish::tiled(name, "textile", "weave", [WHITE, [225; 3], [0; 3]], 0.05)
    }
}

/// Terry, pile.
pub const fn terry(name: &'static str, srgb: Srgb) -> Finish {
    Finish {
        srgb,
        ..Finish::tiled(name, "textile", "carpet", [WHITE, [215; 3], [0; 3]], 0.25)
    }
}

/// Grained leather.
pub const fn leather(name: &'static str, srgb: Srgb) -> Finish {
    Finish {
        srgb,
        ..Finish::tiled(name, "leather", "leather", [WHITE, WHITE, WHITE], 0.2)
    }
}

// ---- metals, plastics, glass, ceramics

/// Brushed steel.
pub const fn steel() -> Finish {
    Finish::plain("steel", "steel", [168, 171, 175])
}

/// Steel lacquered in a colour.
pub const fn painted_steel(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "steel", srgb)
}

/// Chrome.
pub const fn chrome() -> Finish {
    Finish::plain("chrome", "chrome", [205, 209, 213])
}

/// Brass.
pub const fn brass() -> Finish {
    Finish::plain("brass", "brass", [186, 152, 84])
}

/// Plastic of a colour.
pub const fn plastic(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "plastic", srgb)
}

/// Black plastic.
pub const fn black_plastic() -> Finish {
    plastic("black_plastic", [34, 34, 36])
}

/// The bulk of a device.
pub const fn electronics(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "electronics", srgb)
}

/// Enamelled casing of a household appliance.
pub const fn enamel(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "appliance", srgb)
}

/// Clear glass.
pub const fn glass() -> Finish {
    Finish::plain("glass", "glass", [205, 226, 226]).transparent(0.18)
}

/// A mirror.
pub const fn mirror() -> Finish {
    Finish::plain("mirror", "mirror", [196, 208, 212])
}

/// Glazed ceramics of a colour.
pub const fn porcelain(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "porcelain", srgb)
}

/// White sanitary ceramics.
pub const fn sanitary_ware() -> Finish {
    Finish::plain("white_porcelain", "porcelain", [244, 244, 240])
}

/// Terracotta.
pub const fn terracotta() -> Finish {
    Finish::tiled(
        "terracotta",
        "clay",
        "plaster",
        [[186, 104, 66], [0; 3], [0; 3]],
        0.3,
    )
}

/// Polished stone for worktops.
pub const fn granite() -> Finish {
    Finish::tiled(
        "granite",
        "stone",
        "speckle",
        [[92, 90, 90], [52, 52, 54], [150, 148, 146]],
        0.3,
    )
}

/// Veined marble.
pub const fn marble() -> Finish {
    Finish::tiled(
        "marble",
        "marble",
        "marble",
        [[232, 229, 222], [128, 126, 128], [210, 206, 200]],
        0.9,
    )
}

// ---- nature and paper

/// Leaves of a plant.
pub const fn foliage(name: &'static str, green: Srgb, rib: Srgb) -> Finish {
    Finish::tiled(name, "leaves", "foliage", [green, rib, [0; 3]], 0.12)
}

/// Potting soil.
pub const fn soil() -> Finish {
    Finish::tiled(
        "soil",
        "soil",
        "speckle",
        [[70, 50, 36], [44, 30, 22], [96, 72, 54]],
        0.2,
    )
}

/// Basket work.
pub const fn rattan() -> Finish {
    Finish::tiled(
        "rattan",
        "rattan",
        "wicker",
        [[206, 164, 106], [120, 84, 48], [0; 3]],
        0.12,
    )
}

/// The edges of a book's pages.
pub const fn book_page_edges() -> Finish {
    Finish::tiled(
        "pages",
        "paper",
        "pages",
        [[238, 230, 210], [0; 3], [0; 3]],
        0.03,
    )
}

/// Paper or card of a colour.
pub const fn paper(name: &'static str, srgb: Srgb) -> Finish {
    Finish::plain(name, "paper", srgb)
}

/// A lit lampshade of cloth.
pub const fn lampshade(name: &'static str, srgb: Srgb) -> Finish {
    cloth(name, srgb).emissive([0.42, 0.36, 0.26])
}

/// A lit bulb or diffuser of milk glass.
pub const fn milk_glass() -> Finish {
    Finish::plain("milk_glass", "glass", [255, 250, 240])
        .transparent(1.0)
        .emissive([0.9, 0.84, 0.7])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_finish_is_of_a_known_substance() {
        let all = [
            oak(),
            walnut(),
            pine(),
            beech(),
            white_lacquer(),
            lacquer("l", WHITE),
            upholstery("u", WHITE),
            cloth("c", WHITE),
            terry("t", WHITE),
            leather("l", WHITE),
            steel(),
            painted_steel("p", WHITE),
            chrome(),
            brass(),
            plastic("p", WHITE),
            black_plastic(),
            electronics("d", WHITE),
            enamel("e", WHITE),
            glass(),
            mirror(),
            porcelain("p", WHITE),
            sanitary_ware(),
            terracotta(),
            granite(),
            marble(),
            foliage("f", WHITE, WHITE),
            soil(),
            rattan(),
            book_page_edges(),
            paper("p", WHITE),
            lampshade("l", WHITE),
            milk_glass(),
        ];
        for finish in all {
            assert!(library().get(finish.substance).is_some(), "{finish:?}");
            finish
                .material("m".into(), None)
                .check(finish.name)
                .unwrap();
        }
    }
}
