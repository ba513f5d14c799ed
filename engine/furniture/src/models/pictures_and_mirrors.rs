//! Framed pictures, posters and wall mirrors.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, mirror, paper};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, frame, panel};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("wall_mirror", "mirror", 107, sample_wall_mirror),
    CatalogueEntry::new("picture", "picture_frame", 108, sample_picture).with_variants(),
    CatalogueEntry::new("poster", "picture_frame", 109, sample_poster).with_variants(),
];

/// The motifs of pictures: names of texture recipes.
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
    let tones =
        ["first", "second", "third"].map(|tone| style.random_cloth(&mut d.stream(tone)).srgb);
    let recipe = d.choose("motif", MOTIFS);
    let seed = 1 + d.below("seed", 5) as u64;
    let colors = match recipe {
        // Sky, hills, trees; and paper under twigs.
        "landscape" => [[188, 212, 226], tones[1], tones[2]],
        "branch" => [[238, 232, 220], tones[1], tones[2]],
        _ => tones,
    };
    Finish::picture("framed_image", "paper", recipe, colors, seed)
}

/// A framed picture on the wall with a passe-partout; y = 0 is its middle.
fn picture(width_m: f32, height_m: f32, wood: &Finish, image: &Finish) -> Model {
    const BAR_M: f32 = 0.022;
    let margin = 0.16 * width_m.min(height_m);
    let (w, h) = (width_m - 2.0 * BAR_M, height_m - 2.0 * BAR_M);
    let (iw, ih) = (w - margin, h - margin);
    let body = PartBuilder::new("body")
        .with(wood, frame(width_m, height_m, BAR_M, 0.024))
        .with(
            &paper("mount", [240, 236, 226]),
            block([-0.5 * w, -0.5 * h, 0.004], [0.5 * w, 0.5 * h, 0.012]),
        )
        .with(
            image,
            panel(iw, ih, 0.002)
                .translated(0.0, -0.5 * ih, 0.012)
                .visual_only(),
        );
    Model::fixed("picture", "picture_frame").part(body)
}

fn sample_picture(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("picture", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let wood = style.random_wood(&mut d.stream("wood"));
    picture(w, h, wood, &image(style, &d))
}

/// A poster without a frame.
fn poster(width_m: f32, height_m: f32, image: &Finish) -> Model {
    Model::fixed("poster", "picture_frame").part(PartBuilder::new("body").with(
        image,
        panel(width_m, height_m, 0.004).translated(0.0, -0.5 * height_m, 0.0),
    ))
}

fn sample_poster(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("poster", key);
    poster(d.sample_m("width"), d.sample_m("height"), &image(style, &d))
}

/// A mirror on the wall in a thin frame; y = 0 is its middle.
fn wall_mirror(width_m: f32, height_m: f32, rim: &Finish) -> Model {
    let (x, y) = (0.5 * width_m - 0.02, 0.5 * height_m - 0.02);
    let body = PartBuilder::new("body")
        .with(rim, frame(width_m, height_m, 0.02, 0.025))
        .with(&mirror(), block([-x, -y, 0.004], [x, y, 0.014]));
    Model::fixed("mirror", "mirror").part(body)
}

fn sample_wall_mirror(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("wall_mirror", key);
    let rim = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        style.random_wood(&mut d.stream("rim")).clone()
    };
    wall_mirror(d.sample_m("width"), d.sample_m("height"), &rim)
}
