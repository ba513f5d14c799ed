//! Materials with their properties beyond looks.

use dwell_scene::{Id, Material};
use serde_json::{Value, json};

/// A material of the file. `extras.dwell` holds its substance, its physical and acoustic properties in SI units, and
/// emission, which the format caps; absorption and scattering of energy, and transmission loss in dB, by band.
pub(super) fn material(material: &Material) -> Value {
    let [r, g, b] = material.base_color;
    let mut pbr = json!({
        "baseColorFactor": [r, g, b, material.opacity],
        "metallicFactor": material.metallic,
        "roughnessFactor": material.roughness,
    });
    if let Some(texture) = material.texture {
        // Our v counts upwards, glTF's downwards: the view is turned over, the numbers stay as they are.
        let turned = json!({"KHR_texture_transform": {"offset": [0.0, 1.0], "scale": [1.0, -1.0]}});
        pbr["baseColorTexture"] = json!({"index": texture.index(), "extensions": turned});
    }
    let known = json!({
        "substance": material.substance,
        "emission": material.emission,
        "density_kg_m3": material.density_kg_m3,
        "friction": material.friction,
        "restitution": material.restitution,
        "absorption": material.absorption,
        "scattering": material.scattering,
        "transmission_loss_db": material.transmission_loss_db,
    });
    let mut value = json!({
        "name": material.name, "pbrMetallicRoughness": pbr, "doubleSided": true, "extras": {"dwell": known}
    });
    if material.opacity < 1.0 {
        value["alphaMode"] = json!("BLEND");
    }
    if material.emission.iter().any(|e| *e > 0.0) {
        // The format caps emission at 1.
        value["emissiveFactor"] = json!(material.emission.map(|e| e.min(1.0)));
    }
    value
}
