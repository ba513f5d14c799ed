//! What hangs on walls and ceilings.

use super::shade;
use crate::finishes::{Finish, cloth};
use crate::model::Model;
use crate::models::textiles::Curtains;
use crate::models::{bookshelf, decoration, gadgets, lamps, openings};
use crate::sampling::SizeSampler;
use crate::style::Style;
use dwell_scene::random::RandomKey;

/// What pictures show: recipes of textures.
const MOTIFS: [&str; 7] = [
    "shapes",
    "branch",
    "landscape",
    "planets",
    "fields",
    "rings",
    "waves",
];

/// A printed or painted picture in tones of the style.
fn image(style: &Style, d: &SizeSampler) -> Finish {
    let tones = ["first", "second", "third"].map(|tone| style.cloth(&mut d.stream(tone)).srgb);
    let recipe = d.of("motif", MOTIFS);
    let seed = 1 + d.below("seed", 5) as u64;
    let colors = match recipe {
        // Sky, hills, trees; and paper under twigs.
        "landscape" => [[188, 212, 226], tones[1], tones[2]],
        "branch" => [[238, 232, 220], tones[1], tones[2]],
        _ => tones,
    };
    Finish::picture("framed_image", "paper", recipe, colors, seed)
}

pub(crate) fn picture(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("picture", key);
    let (w, h) = (d.m("width"), d.m("height"));
    let wood = style.any_wood(&mut d.stream("wood"));
    decoration::picture(w, h, wood, &image(style, &d))
}

pub(crate) fn poster(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("poster", key);
    decoration::poster(d.m("width"), d.m("height"), &image(style, &d))
}

pub(crate) fn wall_clock(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_clock", key);
    let rim = Finish {
        name: "clock_rim",
        substance: "plastic",
        ..style.metal.clone()
    };
    gadgets::wall_clock(0.5 * d.m("width")).repainted("black_lacquer", &rim)
}

pub(crate) fn wall_shelf(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_shelf", key);
    bookshelf::wall_shelf(
        d.m("width"),
        d.m("depth"),
        style.any_wood(&mut d.stream("wood")),
    )
}

pub(crate) fn curtains(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("curtains", key);
    let tone = style.cloth(&mut d.stream("cloth")).srgb;
    let substance = d.of("weight", ["light_curtain", "heavy_curtain"]);
    // The ends of the rod stand 62 mm over.
    Curtains {
        width_m: d.m("width") - 0.124,
        height_m: d.m("height") - 0.022,
        drawn: d.range("drawn", 0.14, 0.3),
        cloth: Finish {
            substance,
            ..cloth("curtain_cloth", tone)
        },
    }
    .build()
}

pub(crate) fn radiator(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("radiator", key);
    openings::radiator(d.m("width"), d.m("height")).switched(true)
}

pub(crate) fn light_switch(_style: &Style, key: RandomKey) -> Model {
    openings::light_switch().resized(SizeSampler::new("light_switch", key).m("width") / 0.08)
}

pub(crate) fn ceiling_lamp(_style: &Style, key: RandomKey) -> Model {
    lamps::ceiling_dome(0.5 * SizeSampler::new("ceiling_lamp", key).m("width"), 14.0)
}

pub(crate) fn drum_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("drum_lamp", key);
    lamps::drum(d.m("height"), 0.5 * d.m("width"), &shade(style, &d), 14.0)
}

pub(crate) fn pendant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pendant", key);
    let tone = style.glaze(&mut d.stream("tone")).srgb;
    let lacquer = Finish::plain("pendant_lacquer", "steel", tone);
    let metal = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        lacquer
    };
    lamps::pendant(d.m("height"), 0.5 * d.m("width"), &metal, 12.0)
}

pub(crate) fn mirror_lamp(_style: &Style, key: RandomKey) -> Model {
    lamps::mirror_lamp(SizeSampler::new("mirror_lamp", key).m("width"))
}
