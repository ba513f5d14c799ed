//! Coverings of floors, walls and ceilings, by the words of the material's name.

use dwell_furniture::finishes::Finish;
use dwell_furniture::textures::Srgb;
use serde_json::Value;

/// Words of names (lower case), their meaning, and its usual colour; the first that occurs counts.
const COVERS: &[(&str, &str, &str, Srgb)] = &[
    ("carpet", "carpet", "carpet", [150, 140, 128]),
    ("brick", "brick_surface", "brick", [168, 92, 66]),
    ("marble", "marble_surface", "stone", [222, 218, 210]),
    ("granite", "granite_surface", "stone", [120, 116, 112]),
    ("concrete", "concrete_surface", "concrete", [150, 150, 148]),
    ("tile", "tiles", "ceramic_tile", [214, 214, 208]),
    ("ceramic", "tiles", "ceramic_tile", [214, 214, 208]),
    ("lino", "linoleum_floor", "linoleum", [168, 160, 140]),
    ("darkwood", "dark_parquet", "parquet", [92, 62, 42]),
    ("wood", "parquet_floor", "parquet", [158, 118, 78]),
    ("laminate", "laminate_floor", "laminate", [176, 140, 100]),
    ("black", "black_paint", "painted_plaster", [40, 40, 42]),
    ("white", "white_paint", "painted_plaster", [236, 234, 228]),
    ("grey", "grey_paint", "painted_plaster", [160, 160, 160]),
    ("gray", "grey_paint", "painted_plaster", [160, 160, 160]),
    ("red", "red_paint", "painted_plaster", [168, 70, 60]),
    ("orange", "orange_paint", "painted_plaster", [206, 132, 70]),
    ("yellow", "yellow_paint", "painted_plaster", [222, 200, 120]),
    ("green", "green_paint", "painted_plaster", [130, 160, 120]),
    ("blue", "blue_paint", "painted_plaster", [110, 140, 176]),
    ("purple", "purple_paint", "painted_plaster", [140, 110, 156]),
    ("pink", "pink_paint", "painted_plaster", [216, 170, 176]),
    ("brown", "brown_paint", "painted_plaster", [128, 96, 72]),
    ("drywall", "paint", "painted_plaster", [226, 222, 212]),
    ("wall", "paint", "painted_plaster", [226, 222, 212]),
];

/// The finish for a name without a meaning, or none.
const PLAIN: Finish = Finish::plain("paint", "painted_plaster", [226, 222, 212]);

/// Returns the finish of a material of the file: a name, or an object with a `name` and a `color`. The name is returned beside it
/// where it has no known meaning.
pub(super) fn finish_of_material(material: &Value) -> (Finish, Option<String>) {
    let name = material
        .as_str()
        .or_else(|| material["name"].as_str())
        .unwrap_or_default();
    let color = color(&material["color"]);
    let painted = |finish: Finish| Finish {
        srgb: color.unwrap_or(finish.srgb),
        ..finish
    };
    let lower = name.to_ascii_lowercase();
    let known = COVERS.iter().find(|(word, ..)| lower.contains(word));
    if let Some((_, called, substance, srgb)) = known {
        return (painted(Finish::plain(called, substance, *srgb)), None);
    }
    let unknown = Some(name.to_owned()).filter(|name| !name.is_empty());
    (painted(PLAIN), unknown)
}

/// Red, green and blue of the file, each 0 to 1.
fn color(value: &Value) -> Option<Srgb> {
    let [r, g, b] = ["r", "g", "b"].map(|c| value[c].as_f64());
    let byte = |c: Option<f64>| c.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    Some([byte(r)?, byte(g)?, byte(b)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::material::library;
    use serde_json::json;

    #[test]
    fn every_cover_is_a_substance_of_the_table() {
        for (word, _, substance, _) in COVERS {
            assert!(library().get(substance).is_some(), "{word}: {substance}");
        }
    }

    #[test]
    fn names_and_colours_of_files_are_understood() {
        let seen = |value| {
            let (finish, unknown) = finish_of_material(&value);
            assert_eq!(unknown, None);
            (finish.substance, finish.srgb)
        };
        assert_eq!(seen(json!("DarkWoodFloors")).0, "parquet");
        let red = json!({"name": "PureWhite", "color": {"r": 1.0, "g": 0.5, "b": 0.0}});
        assert_eq!(seen(red), ("painted_plaster", [255, 128, 0]));
        assert_eq!(seen(json!(null)).0, "painted_plaster");
        assert_eq!(
            finish_of_material(&json!("Xyz 4")).1.as_deref(),
            Some("Xyz 4")
        );
    }
}
