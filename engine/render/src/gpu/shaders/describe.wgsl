// Every image but colour, from what each pixel sees first.

fn put3(first: u32, index: u32, value: vec3<f32>) {
    let at = first + index * 3u;
    images[at] = bitcast<u32>(value.x);
    images[at + 1u] = bitcast<u32>(value.y);
    images[at + 2u] = bitcast<u32>(value.z);
}

// Where in the world a point was before.
fn point_before(v: View, s: Sight) -> vec3<f32> {
    if s.source == 0u {
        return s.point;
    }
    let row = frame[v.row + 11u].w + (s.source - 1u) * 2u;
    let in_part = into(place_of(v.world, s.source), s.point);
    return rotate(numbers(frame[row]), in_part) + numbers(frame[row + 1u]).xyz;
}

fn flow_of(v: View, image: vec2<f32>, was_in_camera: vec3<f32>) -> vec2<f32> {
    let was = project(v, was_in_camera);
    if !was.is_seen {
        return vec2<f32>(0.0);
    }
    var flow = image - was.image;
    let width = f32(v.width);
    if v.kind == EQUIRECTANGULAR {
        let turns = flow.x / width;
        // Away from zero at halves.
        flow.x -= sign(turns) * floor(abs(turns) + 0.5) * width;
    } else if v.kind == CUBEMAP && floor(image.y / width) != floor(was.image.y / width) {
        return vec2<f32>(0.0);
    }
    // As by `cpu`: what was infinitely far outside the image has no flow.
    if is_endless(flow.x) || is_endless(flow.y) {
        return vec2<f32>(0.0);
    }
    return flow;
}

fn class_of(id: i32) -> u32 {
    let count = tables[2].w;
    return table_word(tables[0].w, min(u32(max(id, 0)), count - 1u));
}

@compute @workgroup_size(8, 8)
fn describe(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let pixel = pixel_of(group, groups, local);
    if !pixel.is_there {
        return;
    }
    let v = pixel.view;
    let ray = ray_of(v, pixel.x, pixel.y);
    let first = seen[v.first_pixel + pixel.index];
    let is_seen = first.y != NOTHING;
    let places = frame[v.row + 9u];
    let more = frame[v.row + 10u];
    let distance = bitcast<f32>(first.z);
    var id = 0;
    if is_seen {
        id = bitcast<i32>(first.w);
    }
    if places.y != NOTHING {
        var depth = v.far;
        if is_seen {
            depth = clamp(distance * ray.per_length, v.near, v.far);
        }
        images[places.y + pixel.index] = bitcast<u32>(depth);
    }
    if places.z != NOTHING {
        images[places.z + pixel.index] = bitcast<u32>(id);
    }
    if places.w != NOTHING {
        images[places.w + pixel.index] = class_of(id);
    }
    if more.x == NOTHING && more.y == NOTHING && more.z == NOTHING {
        return;
    }
    var normal = vec3<f32>(0.0);
    var albedo = vec3<f32>(0.0);
    var was = rotate(conjugate(numbers(frame[v.row + 12u])), ray.direction);
    if is_seen {
        let sight = sight_of(ray, first.x, first.y, distance, id);
        let skin = skin_of(v, sight);
        let towards = facing(skin.normal, sight.direction);
        normal = vec3<f32>(dot(v.right, towards), dot(v.up, towards), dot(v.back, towards));
        albedo = clamp(skin.color, vec3<f32>(0.0), vec3<f32>(1.0));
        let place = Place(numbers(frame[v.row + 12u]), numbers(frame[v.row + 13u]).xyz);
        was = into(place, point_before(v, sight));
    }
    if more.x != NOTHING {
        put3(more.x, pixel.index, normal);
    }
    if more.y != NOTHING {
        put3(more.y, pixel.index, albedo);
    }
    if more.z != NOTHING {
        var flow = vec2<f32>(0.0);
        let has_before = frame[v.row + 11u].z != 0u;
        if has_before && (is_seen || v.kind != ORTHOGRAPHIC) {
            flow = flow_of(v, vec2<f32>(f32(pixel.x), f32(pixel.y)) + 0.5, was);
        }
        images[more.z + pixel.index * 2u] = bitcast<u32>(flow.x);
        images[more.z + pixel.index * 2u + 1u] = bitcast<u32>(flow.y);
    }
}
