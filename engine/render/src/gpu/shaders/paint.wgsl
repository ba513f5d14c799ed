// Flat colour, from what each pixel sees first and, where light passes, behind it. As in `cpu/shade.rs`.

@compute @workgroup_size(8, 8)
fn paint(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let pixel = pixel_of(group, groups, local);
    if !pixel.is_there {
        return;
    }
    let v = pixel.view;
    let place = frame[v.row + 9u].x;
    if place == NOTHING || frame[v.row + 14u].x != FLAT {
        return;
    }
    var ray = ray_of(v, pixel.x, pixel.y);
    if dot(ray.direction, ray.direction) == 0.0 {
        images[place + pixel.index] = 0u;
        return;
    }
    var light = vec3<f32>(0.0);
    var rest = 1.0;
    let first = seen[v.first_pixel + pixel.index];
    var source = first.x;
    var slot = first.y;
    var distance = bitcast<f32>(first.z);
    var id = bitcast<i32>(first.w);
    for (var layer = 0u; layer <= LAYERS; layer += 1u) {
        if slot == NOTHING {
            light += plain_sky(ray.direction) * rest;
            break;
        }
        let sight = sight_of(ray, source, slot, distance, id);
        let skin = skin_of(v, sight);
        if skin.opacity >= OPAQUE || layer == LAYERS {
            light += skin.color * rest;
            break;
        }
        light += skin.color * (skin.opacity * rest);
        rest *= 1.0 - skin.opacity;
        ray.near = behind(distance, ray.per_length);
        let next = closest(ray, v.hidden, v.world);
        source = next.source;
        slot = next.slot;
        distance = next.distance;
        id = next.id;
    }
    images[place + pixel.index] = encode(light.x) | (encode(light.y) << 8u) | (encode(light.z) << 16u);
}
