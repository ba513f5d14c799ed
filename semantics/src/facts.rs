//! State-independent facts about an object: kind, colours, substances, size.

use crate::category::{SemanticCategory, categories};
use crate::clear_glass::CLEAR_OPACITY;
use crate::color::{
    ColorShare, ColorVocabulary, MaterialColors, SurfacePattern, color_words, speakers_disagree,
};
use crate::curtain_panels::is_in_two_panels;
use crate::english::singular_and_plural;
use crate::form::{Description, Noun};
use crate::geometry::triangle_area_m2;
use crate::kind_noun::{KindNoun, kind_nouns};
use crate::material_family::family_of;
use crate::noun_by_size::noun_by_size;
use crate::size::SizeClass;
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::material::{Substance, library};
use dwell_scene::{Aabb, House, MaterialId, ObjectId};
use glam::Vec3;

/// Share of the surface, and of what is seen of it, from which a substance gives a thing its adjective.
const MADE_OF_SHARE: f32 = 0.5;
/// Share of what is seen of a thing from which somebody may name a colour beside its main one.
const TRACE_SHARE: f32 = 0.03;
/// Share of what is seen of a thing from which its frame gives it its colour, where the rest is clear.
const FRAME_SHARE: f32 = 0.1;

/// The lasting facts about an object.
#[derive(Clone, Debug)]
pub struct ObjectFacts {
    /// Its category, if the table knows it.
    pub category: Option<&'static SemanticCategory>,
    /// The words for its kind within the category, where it has any.
    pub(crate) kind: Option<&'static KindNoun>,
    /// Spoken noun, for one.
    pub noun: String,
    /// Spoken noun, for several.
    pub plural: String,
    /// Its sorts of colour by share of what is seen of it where it stands at the start, from around and a little above (below, for
    /// what hangs), largest first; by share of its whole surface where nothing of it is seen. Screens, clear glass, mirrors, the pots of plants and the
    /// cabinets of sinks are left out.
    pub patches: Vec<ColorShare>,
    /// Its colours in spoken words with their shares, largest first; empty for things that are nearly all clear glass or mirror.
    pub colors: Vec<(&'static str, f32)>,
    /// The pattern of most of it; `None` for plain things, and for pictures, globes, screens and books.
    pub pattern: Option<SurfacePattern>,
    /// Whether at least half of what is seen of it is clear glass or mirror.
    pub(crate) is_mostly_clear: bool,
    /// Its substances with their shares of the surface, largest first.
    pub substances: Vec<(&'static Substance, f32)>,
    /// The substance of at least [`MADE_OF_SHARE`] of what is seen of it, as of its colours.
    seen_substance: Option<&'static Substance>,
    /// Edges of the box around it in the axes of its root part, m.
    pub extents_m: Vec3,
    /// Its size for its kind.
    pub size: SizeClass,
}

impl ObjectFacts {
    pub(crate) fn gather(
        house: &House,
        paints: &MaterialColors,
        seen: &[(MaterialId, f32)],
        id: ObjectId,
    ) -> Self {
        let object = &house.objects[id];
        let category = categories().of(&object.category);
        let kind = kind_nouns().get(object.category.fine.as_str());
        let is_pair =
            category.is_some_and(|row| row.name == "curtain") && is_in_two_panels(house, id);
        let kind = kind.or_else(|| kind_nouns().get("curtain_pair").filter(|_| is_pair));
        let extents_m = own_box(house, id).size();
        let by_size = category.and_then(|row| noun_by_size(row, extents_m));
        let (noun, plural) = match (kind, category) {
            (Some(kind), _) => (kind.singular.to_owned(), kind.plural.to_owned()),
            (None, Some(row)) => by_size.map_or_else(
                || (row.singular.to_owned(), row.plural.to_owned()),
                singular_and_plural,
            ),
            (None, None) => unknown_noun(&object.category),
        };
        let (noun, plural) = match noun.as_str() {
            // An object, as opposed to a piece of the building.
            "wall" | "floor" | "ceiling" => singular_and_plural(&format!("{noun} piece")),
            _ => (noun, plural),
        };
        let areas = areas_m2(house, id);
        let shown: &[(MaterialId, f32)] = if seen.is_empty() { &areas } else { seen };
        let named = named_surfaces(house, category, shown);
        let clear = shown.iter().filter(|(id, _)| is_clear(house, *id));
        let is_mostly_clear = 2.0 * area_m2(clear) >= area_m2(shown.iter()) && !shown.is_empty();
        let patches = patches(house, paints, &named);
        let pattern = pattern(paints, category, &named)
            .filter(|_| kind.is_none_or(|own| own.singular != "globe"));
        let substances = substances(house, &areas);
        let seen_substance = main_substance(house, shown);
        let mut colors = color_words(&patches, ColorVocabulary::Spoken);
        // Flowers have the colour of their petals.
        let is_petal = |(word, _): &(&str, f32)| !word.contains("green") && *word != "sage";
        if category.is_some_and(|row| row.name == "flowers") && colors.iter().any(is_petal) {
            colors.retain(is_petal);
        }
        Self {
            category,
            kind,
            noun,
            plural,
            colors,
            patches,
            pattern,
            is_mostly_clear,
            substances,
            seen_substance,
            extents_m,
            // Kinds within a category have no usual size in its table.
            size: SizeClass::of(extents_m, category.filter(|_| kind.is_none())),
        }
    }

    /// The words for its colours in `vocabulary` with their shares of what is seen of it, largest first; none for what is
    /// nearly all clear glass or mirror.
    pub fn color_shares(&self, vocabulary: ColorVocabulary) -> Vec<(&'static str, f32)> {
        if self.colors.is_empty() {
            return Vec::new();
        }
        color_words(&self.patches, vocabulary)
    }

    /// The words for its colours in `vocabulary`, largest share first.
    pub fn color_words(&self, vocabulary: ColorVocabulary) -> Vec<&'static str> {
        color_words(&self.patches, vocabulary)
            .into_iter()
            .map(|(word, _)| word)
            .collect()
    }

    /// Returns whether its category, or that of NYU-40, is one of `names`.
    fn is_one_of(&self, names: &[&str]) -> bool {
        self.category
            .is_some_and(|row| names.contains(&row.nyu40_name) || names.contains(&row.name))
    }

    /// Returns whether its looks do not say its main substance: chrome under paint, the cloth of a toy, the glass of a window.
    fn hides(&self, substance: &Substance) -> bool {
        let is_gray = |word: &str| word.contains("gray");
        match substance.adjective.as_str() {
            "glass" => self.is_one_of(&["window", "mirror"]),
            "upholstered" => !self.is_one_of(&["sofa", "chair", "bed", "ottoman", "armchair"]),
            // A wicker front makes no wicker wardrobe.
            "wicker" => !self.is_one_of(&["chair", "sofa", "box", "bag", "basket", "ottoman"]),
            "chrome" => self.colors.first().is_some_and(|(word, _)| !is_gray(word)),
            // Painted.
            "steel" => {
                let plain =
                    |word: &str| is_gray(word) || ["black", "white", "cream"].contains(&word);
                self.is_one_of(&["whiteboard"])
                    || self.colors.first().is_some_and(|(word, _)| !plain(word))
            }
            _ => false,
        }
    }

    /// Returns whether it shows a colour; undecided for a colour on which people divide, and of things that have none.
    pub(crate) fn shows_color(&self, word: &str) -> Truth {
        if self.colors.is_empty() {
            return Truth::Undecided(UndecidedReason::NoColor);
        }
        shows_color(self.colors.iter().map(|(own, _)| *own), word)
    }

    /// Its colours in spoken words with their shares of what a viewer sees of it, largest first; `rays`: how many meet each of its
    /// materials.
    pub(crate) fn colors_in_view(
        &self,
        house: &House,
        paints: &MaterialColors,
        rays: &[(MaterialId, f32)],
    ) -> Vec<(&'static str, f32)> {
        let named = named_surfaces(house, self.category, rays);
        let patches = patches(house, paints, &named);
        color_words(&patches, ColorVocabulary::Spoken)
    }

    /// Returns whether at least [`TRACE_SHARE`] of what is seen of it has a colour, or one that some people call so.
    pub(crate) fn shows_trace_of(&self, word: &str) -> bool {
        let seen = self
            .patches
            .iter()
            .filter(|patch| patch.share >= TRACE_SHARE);
        let mut words = seen.filter_map(|patch| Some(ColorVocabulary::Spoken.word(patch.linear?)));
        words.any(|own| own == word || speakers_disagree(own, word))
    }

    /// Returns whether some people would call it of a size: those who would if its edges were a fifth shorter or a quarter longer.
    pub(crate) fn may_be_called_size(&self, size: SizeClass) -> bool {
        let row = self.category.filter(|_| self.kind.is_none());
        let scaled = |scale: &f32| SizeClass::of(self.extents_m * *scale, row);
        [0.8, 1.0, 1.25].iter().map(scaled).any(|own| own == size)
    }

    /// The colours a speaker would use: the one of most of the surface, else the two largest, as of a pattern; none without a surface,
    /// when no two cover most of it, for racks, laptops and what is mostly clear glass, and for pictures that are not nearly all of one or that one
    /// is the paper's.
    pub fn spoken_colors(&self) -> &[(&'static str, f32)] {
        // "A white picture" leaves open whether paper, mat or frame is meant; racks have the colours of what hangs on them to some,
        // their own to others, a laptop is as much case as keys; nobody says a yellow glass table of a clear one with a golden frame.
        if self.is_one_of(&["hanger", "towel_rack", "laptop"])
            || self.is_mostly_clear && !self.is_one_of(&["window"])
        {
            return &[];
        }
        let is_picture = self.is_one_of(&["picture"]);
        let is_paper = |word: &str| ["white", "cream", "light gray"].contains(&word);
        match self.colors[..] {
            [(word, share), ..] if is_picture && (share < 0.9 || is_paper(word)) => &[],
            [(_, p), (_, q), ..] if self.pattern.is_some() && p + q >= 0.75 => &self.colors[..2],
            [(_, share), ..] if share >= 0.6 => &self.colors[..1],
            [(_, p), (_, q), ..] if p + q >= 0.75 => &self.colors[..2],
            [(_, share)] if share >= 0.5 => &self.colors[..1],
            _ => &[],
        }
    }

    /// The adjective of its main substance; `None` when none prevails, or another in what is seen of it (a white wardrobe has oak sides), when the kind of thing implies it
    /// already, and for things with a part that stands for them.
    pub fn material_word(&self) -> Option<&'static str> {
        let (substance, share) = self.substances.first()?;
        let is_seen = self
            .seen_substance
            .is_some_and(|own| own.name == substance.name);
        if !is_seen || self.category.and_then(defining_substance).is_some() || self.hides(substance)
        {
            return None;
        }
        let dull = [
            "hard_surface",
            "hollow_door",
            "particle_board",
            "thin_carpet",
            "thick_carpet",
            "electronics",
            "appliance",
            "human",
            "animal",
            "leaves",
            "food",
            "books",
            "paper",
            "wax",
            "foam",
            "painted_plaster",
            "mirror",
            "light_curtain",
            "heavy_curtain",
            "water",
            "textile",
            "carpet",
        ];
        let said = self.noun.split(' ').any(|word| {
            substance.adjective == word
                || substance.noun == word
                || substance.words.iter().any(|w| w == word)
        });
        (*share >= MADE_OF_SHARE && !said && !dull.contains(&substance.name.as_str()))
            .then_some(substance.adjective.as_str())
    }

    /// The words for what it is made of: its adjectives and the families of these, each once.
    pub(crate) fn material_words(&self) -> impl Iterator<Item = &'static str> {
        let mut words: Vec<&'static str> = Vec::new();
        for word in self.adjectives() {
            for word in std::iter::once(word).chain(family_of(word)) {
                if !words.contains(&word) {
                    words.push(word);
                }
            }
        }
        words.into_iter()
    }

    /// The adjectives of the substances on at least a fifth of its surface, largest share first.
    pub(crate) fn adjectives(&self) -> impl Iterator<Item = &'static str> {
        let large = self.substances.iter().filter(|(_, share)| *share >= 0.2);
        large.map(|(substance, _)| substance.adjective.as_str())
    }

    /// Returns whether noun, size, colours and material of a description fit it; its state and modifiers are left aside.
    pub(crate) fn matches_properties(&self, description: &Description) -> bool {
        self.fits_with(description, Truth::is_true)
    }

    /// The same, or whether some people would say that they fit.
    pub(crate) fn may_match_properties(&self, description: &Description) -> bool {
        self.fits_with(description, |color| !color.is_false())
            && (description.colors.is_empty() || !self.colors.is_empty())
    }

    fn fits_with(&self, description: &Description, accepts: impl Fn(Truth) -> bool) -> bool {
        let Noun::Object(noun) = &description.noun else {
            return false;
        };
        let shows = |color: &String| accepts(self.shows_color(color));
        let made_of = |word: &String| self.material_words().any(|own| own == *word);
        self.is_called(noun)
            && description.colors.iter().all(shows)
            && description.material.as_ref().is_none_or(made_of)
            && description.size.is_none_or(|size| self.size == size)
    }

    /// Returns whether it is a rug, on which things stand as on the floor.
    pub(crate) fn is_rug(&self) -> bool {
        self.category.is_some_and(|row| row.name == "rug")
    }

    /// Returns whether it belongs to a hole in a wall: a door, a window, a curtain. It marks no place of other things.
    pub fn belongs_to_opening(&self) -> bool {
        let classes = ["door", "window", "curtain", "blinds"];
        self.category
            .is_some_and(|row| classes.contains(&row.nyu40_name))
    }

    /// Returns whether it divides a room and people see through a part of it.
    pub(crate) fn is_glazed_partition(&self) -> bool {
        let is_partition = self.category.is_some_and(|row| row.name == "partition");
        is_partition && self.adjectives().any(|own| own == "glass")
    }

    pub(crate) fn is_window(&self) -> bool {
        self.category.is_some_and(|row| row.name == "window")
    }

    /// Returns whether it closes or frames a way between rooms.
    pub fn is_door(&self) -> bool {
        let names = ["door", "garage_door", "arch"];
        self.category.is_some_and(|row| names.contains(&row.name))
    }

    /// Returns whether it may be called `noun`: its spoken noun, a synonym, a more general last word ("table" for a
    /// coffee table), or "thing".
    pub fn is_called(&self, noun: &str) -> bool {
        if noun == Noun::ANY_OBJECT {
            return true;
        }
        let matches = |name: &str| {
            name == noun
                || name
                    .strip_suffix(noun)
                    .is_some_and(|rest| rest.ends_with(' '))
        };
        let kind = self.kind.into_iter().flat_map(|kind| &kind.synonyms);
        // Of an alarm clock, "wall clock" is another kind of its category.
        let is_of_another_kind = |synonym: &str| {
            self.kind.is_some()
                && self.category.is_some_and(|row| {
                    let rest = synonym.strip_suffix(row.singular);
                    rest.is_some_and(|rest| rest.ends_with(' '))
                })
        };
        let row = self.category.into_iter();
        let row = row.flat_map(|row| &row.synonyms);
        let row = row.filter(|synonym| !is_of_another_kind(synonym));
        matches(&self.noun) || kind.chain(row).any(|name| matches(name))
    }
}

/// The noun for a category outside the table: its own name in plain letters.
fn unknown_noun(category: &dwell_scene::Category) -> (String, String) {
    let name = if category.fine.is_empty() {
        &category.coarse
    } else {
        &category.fine
    };
    let plain: String = name
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                ' '
            }
        })
        .collect();
    let noun = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    if noun.is_empty() {
        ("thing".to_owned(), "things".to_owned())
    } else {
        singular_and_plural(&noun)
    }
}

/// The box around all parts, in the axes of the root part.
fn own_box(house: &House, id: ObjectId) -> Aabb {
    let object = &house.objects[id];
    let root_from_world = house.parts[object.first_part].world_from_part.inverse();
    let mut bounds = Aabb::EMPTY;
    for part in object.parts() {
        let part = &house.parts[part];
        let root_from_mesh =
            (root_from_world * part.world_from_part).to_affine() * part.part_from_mesh;
        for point in &house.meshes[part.mesh].positions {
            bounds.add_point(root_from_mesh.transform_point3(*point));
        }
    }
    bounds
}

type Substances = Vec<(&'static Substance, f32)>;

/// The whole surface by material, m².
fn areas_m2(house: &House, id: ObjectId) -> Vec<(MaterialId, f32)> {
    let mut areas: Vec<(MaterialId, f64)> = Vec::new();
    for part in house.objects[id].parts() {
        let part = &house.parts[part];
        let mesh = &house.meshes[part.mesh];
        let vertices = mesh.positions.iter();
        let placed: Vec<Vec3> = vertices
            .map(|vertex| part.part_from_mesh.transform_point3(*vertex))
            .collect();
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            let Some(material) = part.materials.get(usize::from(mesh.slot(triangle))) else {
                continue;
            };
            let area = triangle_area_m2(corners.map(|vertex| placed[vertex as usize]));
            match areas.iter_mut().find(|(known, _)| known == material) {
                Some((_, sum)) => *sum += area,
                None => areas.push((*material, area)),
            }
        }
    }
    let rounded = areas.into_iter().map(|(id, area)| (id, area as f32));
    rounded.filter(|(_, area)| *area > 0.0).collect()
}

/// The part of `areas` after which a thing's colour is named; none of what is nearly all glass or mirror.
fn named_surfaces(
    house: &House,
    category: Option<&SemanticCategory>,
    areas: &[(MaterialId, f32)],
) -> Vec<(MaterialId, f32)> {
    let screened = category.is_some_and(|row| {
        row.nyu40_name == "television" || ["tablet", "cellphone"].contains(&row.name)
    });
    // A television has the colour of its frame, whatever is on.
    let is_screen = |id: MaterialId| {
        let material = &house.materials[id];
        material.texture.is_some() || material.emission.iter().any(|light| *light > 0.0)
    };
    // Clear glass and mirrors have the colour of what lies behind or before them.
    let own = areas.iter().copied();
    let own: Vec<_> = own
        .filter(|(id, _)| !(screened && is_screen(*id) || is_clear(house, *id)))
        .collect();
    if area_m2(own.iter()) < FRAME_SHARE * area_m2(areas.iter()) {
        return Vec::new();
    }
    let Some(substance) = category.and_then(defining_substance) else {
        return own;
    };
    let is_defining = |id: MaterialId| house.materials[id].substance == substance;
    let defining = own.iter().copied();
    let defining = defining.filter(|(id, _)| is_defining(*id));
    let defining: Vec<_> = defining.collect();
    if defining.is_empty() { own } else { defining }
}

/// Returns whether `word` is among the words of a surface; undecided where people divide on it.
pub(crate) fn shows_color<'a>(words: impl Iterator<Item = &'a str> + Clone, word: &str) -> Truth {
    if words.clone().any(|own| own == word) {
        return Truth::True;
    }
    let mut words = words;
    if words.any(|own| speakers_disagree(own, word)) {
        return Truth::Undecided(UndecidedReason::DividedColor);
    }
    Truth::False
}

fn is_clear(house: &House, id: MaterialId) -> bool {
    let material = &house.materials[id];
    material.opacity < CLEAR_OPACITY || material.substance == "mirror"
}

fn area_m2<'a>(of: impl Iterator<Item = &'a (MaterialId, f32)>) -> f32 {
    of.map(|(_, area_m2)| area_m2).sum()
}

/// The substance of the part that a thing has its colour from, where it has others, too: the leaves or flowers of a plant, not its pot; the
/// basin of a sink, not its cabinet.
fn defining_substance(category: &SemanticCategory) -> Option<&'static str> {
    let first = category.substances.first().copied();
    first.filter(|first| *first == "leaves" || category.name == "sink")
}

/// The sorts of colour by opacity-weighted share of `areas`, largest first.
fn patches(house: &House, paints: &MaterialColors, areas: &[(MaterialId, f32)]) -> Vec<ColorShare> {
    let opaque = |id: MaterialId| house.materials[id].opacity.max(0.02);
    paints.patches(areas.iter().map(|(id, area)| (*id, area * opaque(*id))))
}

/// The pattern of the material on most of `areas`.
fn pattern(
    paints: &MaterialColors,
    category: Option<&SemanticCategory>,
    areas: &[(MaterialId, f32)],
) -> Option<SurfacePattern> {
    const SHOWING: [&str; 5] = ["picture", "television", "books", "paper", "clock"];
    if category.is_none_or(|row| SHOWING.contains(&row.nyu40_name) || SHOWING.contains(&row.name)) {
        return None;
    }
    let whole: f32 = areas.iter().map(|(_, area_m2)| area_m2).sum();
    let mut most = areas.iter();
    let (material, _) = most.find(|(_, area_m2)| *area_m2 >= MADE_OF_SHARE * whole)?;
    paints.pattern(*material)
}

/// Substances by share of `areas`, largest first.
/// The substance of at least [`MADE_OF_SHARE`] of `areas`.
fn main_substance(house: &House, areas: &[(MaterialId, f32)]) -> Option<&'static Substance> {
    let all = substances(house, areas);
    let (substance, share) = all.first()?;
    (*share >= MADE_OF_SHARE).then_some(*substance)
}

fn substances(house: &House, areas: &[(MaterialId, f32)]) -> Substances {
    let total: f32 = areas.iter().map(|(_, area)| area).sum();
    let mut substances: Substances = Vec::new();
    for (material, area) in areas {
        let substance = library().get_or_default(&house.materials[*material].substance);
        let share = area / total;
        match substances
            .iter_mut()
            .find(|(known, _)| known.name == substance.name)
        {
            Some((_, sum)) => *sum += share,
            None => substances.push((substance, share)),
        }
    }
    substances.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.name.cmp(&q.0.name)));
    substances
}
