// The compute path: what each pixel sees first, by a ray.

@compute @workgroup_size(8, 8)
fn trace(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let pixel = pixel_of(group, groups, local);
    // Those of the raster path come another way.
    if !pixel.is_there || frame[pixel.view.row + 15u].x != 0u {
        return;
    }
    let n = closest(ray_of(pixel.view, pixel.x, pixel.y), pixel.view.hidden, pixel.view.world);
    seen[pixel.view.first_pixel + pixel.index] = vec4<u32>(n.source, n.slot, bitcast<u32>(n.distance), bitcast<u32>(n.id));
}
