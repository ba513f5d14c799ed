// What both kernels of colour share. As in `cpu/shade.rs` and `color.rs`.

const LAYERS: u32 = 8u;
const OPAQUE: f32 = 0.998046875;
const GAP: vec2<f32> = vec2<f32>(2e-4, 2e-6);

fn encode(linear: f32) -> u32 {
    // Not a number is black.
    let positive = select(0.0, linear, linear > 0.0);
    let step = u32(round(min(positive, 1.0) * 8191.0));
    return (table_word(tables[1].y, step >> 2u) >> ((step & 3u) * 8u)) & 255u;
}

fn plain_sky(direction: vec3<f32>) -> vec3<f32> {
    if direction.y >= 0.0 {
        return mix(vec3<f32>(0.85, 0.92, 1.0), vec3<f32>(0.35, 0.55, 0.9), min(sqrt(direction.y), 1.0));
    }
    return vec3<f32>(0.42, 0.42, 0.38);
}

// Where a ray goes on behind a surface, as a distance along it.
fn behind(distance: f32, per_length: f32) -> f32 {
    return (distance * per_length * (1.0 + GAP.y) + GAP.x) / per_length;
}
