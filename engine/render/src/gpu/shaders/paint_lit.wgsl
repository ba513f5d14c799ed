// Lit colour, from what each pixel sees first, what lies behind it, and what mirrors show. As in `cpu/shade.rs`.

const MIRRORS: u32 = 2u;
const OFF_SURFACE: f32 = 1e-3;
// Most reflections that wait to be followed.
const WAITING: u32 = 4u;

// Source: Z. H. Cigolle et al., JCGT 3 (2014), 2: octahedral map.
fn unpack_normal(packed: u32) -> vec3<f32> {
    // Sign-extended halves.
    let x = f32(i32(packed << 16u) >> 16u) / 32767.0;
    let y = f32(i32(packed) >> 16u) / 32767.0;
    let z = 1.0 - abs(x) - abs(y);
    let fold = max(-z, 0.0);
    let n = vec3<f32>(x - select(fold, -fold, x < 0.0), y - select(fold, -fold, y < 0.0), z);
    return n / max(length(n), 1e-9);
}

fn corner_of(row: u32, lane: u32) -> vec3<f32> {
    return vec3<f32>(
        bitcast<f32>(blocks[row][lane]),
        bitcast<f32>(blocks[row + 1u][lane]),
        bitcast<f32>(blocks[row + 2u][lane]),
    );
}

// The interpolated normal, not of unit length; in the space of the triangle's own.
fn smooth_normal(v: View, ray: Ray, s: Sight) -> vec3<f32> {
    let local = in_instance(ray, s.source, v.world);
    let origin = local.origin;
    let direction = local.direction;
    let row = (s.slot / 4u) * BLOCK_ROWS;
    let lane = s.slot % 4u;
    let a = corner_of(row, lane) - origin;
    let b = corner_of(row + 3u, lane) - origin;
    let c = corner_of(row + 6u, lane) - origin;
    var w = vec3<f32>(
        dot(cross(b - c, b + c), direction),
        dot(cross(c - a, c + a), direction),
        dot(cross(a - b, a + b), direction),
    );
    if w.x + w.y + w.z < 0.0 {
        w = -w;
    }
    w = max(w, vec3<f32>(0.0));
    let sum = w.x + w.y + w.z;
    w = select(vec3<f32>(1.0, 0.0, 0.0), w / max(sum, 1e-30), sum > 0.0);
    let packed = triangles[s.row + 3u];
    return unpack_normal(packed.y) * w.x + unpack_normal(packed.z) * w.y + unpack_normal(packed.w) * w.z;
}

// Whether a thing is switched off, of those that glow.
fn is_off(light: u32, id: i32) -> bool {
    let word = u32(max(id, 0)) >> 5u;
    return (frame[frame[light].w + (word >> 2u)][word & 3u] & (1u << (u32(id) & 31u))) != 0u;
}

@compute @workgroup_size(8, 8)
fn paint_lit(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let pixel = pixel_of(group, groups, local);
    if !pixel.is_there {
        return;
    }
    let v = pixel.view;
    let place = frame[v.row + 9u].x;
    let preset = frame[v.row + 14u];
    if place == NOTHING || preset.x != LIT {
        return;
    }
    let light = preset.y;
    let per_lx = bitcast<f32>(preset.z);
    var ray = ray_of(v, pixel.x, pixel.y);
    if dot(ray.direction, ray.direction) == 0.0 {
        images[place + pixel.index] = 0u;
        return;
    }
    var origins: array<vec3<f32>, WAITING>;
    var directions: array<vec3<f32>, WAITING>;
    var shares: array<vec3<f32>, WAITING>;
    // Depth so far, and how many more mirrors are met.
    var depths: array<f32, WAITING>;
    var counts: array<u32, WAITING>;
    var waiting = 0u;
    var total = vec3<f32>(0.0);
    var share = vec3<f32>(1.0);
    var mirrors = MIRRORS;
    var layer = 0u;
    var before = 0.0;
    var is_reflected = false;
    var hidden = v.hidden;
    let first = seen[v.first_pixel + pixel.index];
    var source = first.x;
    var slot = first.y;
    var distance = bitcast<f32>(first.z);
    var id = bitcast<i32>(first.w);
    loop {
        var ends = true;
        if slot == NOTHING {
            total += share * lit_sky(ray.direction, per_lx);
        } else {
            var sight = sight_of(ray, source, slot, distance, id);
            sight.depth += before;
            let skin = skin_of(v, sight);
            ends = skin.opacity >= OPAQUE || layer == LAYERS;
            let part = select(skin.opacity, 1.0, ends);
            let towards = facing(skin.normal, sight.direction);
            if skin.is_mirror && mirrors > 0u && waiting < WAITING {
                origins[waiting] = sight.point + towards * OFF_SURFACE;
                directions[waiting] = normalize(reflect(ray.direction, towards));
                shares[waiting] = share * skin.color * part;
                depths[waiting] = sight.depth;
                counts[waiting] = mirrors - 1u;
                waiting += 1u;
            } else {
                let turned = rotate(place_of(v.world, source).rotation, smooth_normal(v, ray, sight));
                let size = length(turned);
                var rounded = select(towards, turned / max(size, 1e-30), size > 1e-9);
                if dot(rounded, towards) < 0.0 {
                    rounded = -rounded;
                }
                let at = Site(
                    sight.point,
                    rounded,
                    sight.point + towards * 0.1 - ray.direction * 0.2,
                    sight.point + towards * OFF_SURFACE,
                    towards,
                    id,
                );
                var shown = skin.color * brightness(v, light, per_lx, at);
                if any(skin.emission > vec3<f32>(0.0)) && !is_off(light, id) {
                    shown += skin.emission;
                }
                total += share * shown * part;
            }
            share *= 1.0 - skin.opacity;
        }
        if ends {
            if waiting == 0u {
                break;
            }
            waiting -= 1u;
            ray.origin = origins[waiting];
            ray.direction = directions[waiting];
            ray.near = 0.0;
            ray.far = FAR;
            share = shares[waiting];
            before = depths[waiting];
            mirrors = counts[waiting];
            layer = 1u;
            hidden = 0;
            is_reflected = true;
        } else {
            ray.near = behind(distance, select(ray.per_length, 1.0, is_reflected));
            layer += 1u;
        }
        let next = closest(ray, hidden, v.world);
        source = next.source;
        slot = next.slot;
        distance = next.distance;
        id = next.id;
    }
    let shown = display(total);
    images[place + pixel.index] = encode(shown.x) | (encode(shown.y) << 8u) | (encode(shown.z) << 16u);
}
