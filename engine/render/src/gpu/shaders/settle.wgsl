// From rasterized pictures to what each pixel sees first. Where neighbours show other things, or depth jumps, a ray decides:
// rasterizers round corners to fractions of a pixel.

@group(2) @binding(0) var atlas: texture_2d<u32>;

fn corner_at(row: u32, lane: u32, origin: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(bitcast<f32>(blocks[row][lane]), bitcast<f32>(blocks[row + 1u][lane]), bitcast<f32>(blocks[row + 2u][lane])) - origin;
}

// Edge function and its bound, as `side` in `walk.wgsl`.
fn edge(p: vec3<f32>, q: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let d = abs(p - q);
    let s = abs(p + q);
    let size = (d.x + d.y + d.z) * (s.x + s.y + s.z) * length(direction);
    return vec2<f32>(dot(cross(p - q, p + q), direction), size * (8.0 / 16777216.0));
}

// The distance along a ray to a triangle; negative where it passes beside.
fn distance_to(v: View, ray: Ray, source: u32, slot: u32) -> f32 {
    let local = in_instance(ray, source, v.world);
    let origin = local.origin;
    let direction = local.direction;
    let row = (slot / 4u) * BLOCK_ROWS;
    let lane = slot % 4u;
    let a = corner_at(row, lane, origin);
    let b = corner_at(row + 3u, lane, origin);
    let c = corner_at(row + 6u, lane, origin);
    let e = edge(c, a, direction);
    let f = edge(a, b, direction);
    let g = edge(b, c, direction);
    let lowest = min(min(e.x + e.y, f.x + f.y), g.x + g.y);
    let highest = max(max(e.x - e.y, f.x - f.y), g.x - g.y);
    if lowest < 0.0 && highest > 0.0 {
        return -1.0;
    }
    let normal = corner_at(row + 9u, lane, vec3<f32>(0.0));
    let slope = dot(normal, direction);
    if abs(slope) < 1e-9 {
        return -1.0;
    }
    return dot(normal, a) / slope;
}

@compute @workgroup_size(8, 8)
fn settle(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let pixel = pixel_of(group, groups, local);
    if !pixel.is_there {
        return;
    }
    let v = pixel.view;
    let place = frame[v.row + 15u];
    if place.x == 0u {
        return;
    }
    let x = i32(pixel.x);
    let y = i32(pixel.y - v.first_row);
    let corner = vec2<i32>(i32(place.y), i32(place.z));
    let here = textureLoad(atlas, corner + vec2<i32>(x, y), 0);
    let depth = bitcast<f32>(here.w);
    var is_sure = true;
    for (var j = max(y - 1, 0); j <= min(y + 1, i32(v.rows) - 1); j += 1) {
        for (var i = max(x - 1, 0); i <= min(x + 1, i32(v.width) - 1); i += 1) {
            let other = textureLoad(atlas, corner + vec2<i32>(i, j), 0);
            let same = other.x == here.x && other.z == here.z && (other.y == 0u) == (here.y == 0u);
            let jump = abs(bitcast<f32>(other.w) - depth) > 0.1 * depth;
            is_sure = is_sure && same && !jump;
        }
    }
    let ray = ray_of(v, pixel.x, pixel.y);
    var found = vec4<u32>(0u, NOTHING, bitcast<u32>(FAR), 0u);
    if is_sure && here.y > 0u {
        let distance = distance_to(v, ray, here.x, here.y - 1u);
        let off = abs(distance * ray.per_length - depth);
        is_sure = distance >= ray.near && distance <= ray.far && off < 1e-4 * depth + 1e-5;
        found = vec4<u32>(here.x, here.y - 1u, bitcast<u32>(distance), here.z);
    }
    if !is_sure {
        let n = closest(ray, v.hidden, v.world);
        found = vec4<u32>(n.source, n.slot, bitcast<u32>(n.distance), bitcast<u32>(n.id));
    }
    seen[v.first_pixel + pixel.index] = found;
}
