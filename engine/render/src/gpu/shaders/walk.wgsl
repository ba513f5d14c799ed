// Rays through the house: the tree over what never moves, then that over the instances of a world. As
// `dwell_scene::bvh::kernels` does, four boxes or triangles at a time.

const NODE_ROWS: u32 = 7u;
const BLOCK_ROWS: u32 = 14u;
const INSTANCE_ROWS: u32 = 7u;
const LEAF: u32 = 0x80000000u;

// A ray in the space of a tree.
struct Probe {
    origin: vec3<f32>,
    direction: vec3<f32>,
    inverse: vec3<f32>,
    margin: f32,
    longest: f32,
    near: f32,
    far: f32,
}

// The nearest hit so far; see `dwell_scene::bvh::kernels::nearest`.
struct Nearest {
    distance: f32,
    limit: f32,
    others: f32,
    unsure_at: f32,
    reach: f32,
    source: u32,
    slot: u32,
    id: i32,
    index: u32,
}

fn inverse_of(component: f32) -> f32 {
    let size = max(abs(component), 1e-24);
    return select(1.0, -1.0, component < 0.0) / size;
}

fn probe(low: vec3<f32>, high: vec3<f32>, origin: vec3<f32>, direction: vec3<f32>, near: f32, far: f32, longest: f32) -> Probe {
    let reach = max(abs(origin - low), abs(origin - high));
    let margin = clamp(max(max(reach.x, reach.y), reach.z) / 1048576.0, 1e-9, 1e18);
    let inverse = vec3<f32>(inverse_of(direction.x), inverse_of(direction.y), inverse_of(direction.z));
    return Probe(origin, direction, inverse, margin, longest, near, far);
}

fn horizon(distance: f32) -> f32 {
    return (distance + 32.0 * 1e-5) * (1.0 + 2.0 * 32.0 * 1e-6);
}

fn nearest_from(distance: f32, far: f32) -> Nearest {
    let limit = select(min(far, horizon(distance)), far, distance >= FAR);
    return Nearest(distance, limit, FAR, FAR, FAR, 0u, NOTHING, 0, 0u);
}

fn offer(n: ptr<function, Nearest>, distance: f32, reach: f32, source: u32, slot: u32, id: i32, index: u32) {
    if horizon(distance) >= (*n).distance {
        if reach > (*n).distance {
            return;
        }
        if (*n).slot != NOTHING {
            let nearest = min(distance, (*n).distance);
            let same_id = id == (*n).id;
            let wins = id < (*n).id || (same_id && source < (*n).source)
                || (same_id && source == (*n).source && index < (*n).index);
            if wins {
                (*n).others = min((*n).others, (*n).reach);
            } else if (*n).reach <= nearest {
                (*n).others = min((*n).others, reach);
                if distance < (*n).distance {
                    (*n).distance = distance;
                    (*n).limit = min((*n).limit, horizon(distance));
                }
                return;
            } else if (*n).others <= nearest {
                (*n).unsure_at = nearest;
            }
        }
    }
    (*n).source = source;
    (*n).slot = slot;
    (*n).id = id;
    (*n).index = index;
    (*n).reach = reach;
    if distance < (*n).distance {
        (*n).distance = distance;
        (*n).limit = min((*n).limit, horizon(distance));
    }
}

struct Corners {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

// Corners of a block as seen from an origin.
fn corners(row: u32, origin: vec3<f32>) -> Corners {
    return Corners(
        numbers(blocks[row]) - origin.x,
        numbers(blocks[row + 1u]) - origin.y,
        numbers(blocks[row + 2u]) - origin.z,
    );
}

struct Side {
    value: vec4<f32>,
    tolerance: vec4<f32>,
}

// The edge function of a direction for the edge between two corners, and by how much it may be off.
fn side(p: Corners, q: Corners, direction: vec3<f32>, longest: f32) -> Side {
    let ex = p.x - q.x;
    let ey = p.y - q.y;
    let ez = p.z - q.z;
    let sx = p.x + q.x;
    let sy = p.y + q.y;
    let sz = p.z + q.z;
    let value = (ey * sz - ez * sy) * direction.x + (ez * sx - ex * sz) * direction.y + (ex * sy - ey * sx) * direction.z;
    let size = (abs(ex) + abs(ey) + abs(ez)) * (abs(sx) + abs(sy) + abs(sz));
    return Side(value, size * (8.0 / 16777216.0 * longest));
}

// Offers what a ray meets of a block.
fn meet(n: ptr<function, Nearest>, block: u32, p: Probe, source: u32, instance_id: i32, hidden: i32) {
    let row = block * BLOCK_ROWS;
    let a = corners(row, p.origin);
    let b = corners(row + 3u, p.origin);
    let c = corners(row + 6u, p.origin);
    let u = side(c, a, p.direction, p.longest);
    let v = side(a, b, p.direction, p.longest);
    let w = side(b, c, p.direction, p.longest);
    let lowest = min(min(u.value + u.tolerance, v.value + v.tolerance), w.value + w.tolerance);
    let highest = max(max(u.value - u.tolerance, v.value - v.tolerance), w.value - w.tolerance);
    let inside = (lowest >= vec4<f32>(0.0)) | (highest <= vec4<f32>(0.0));
    if !any(inside) {
        return;
    }
    let nx = numbers(blocks[row + 9u]);
    let ny = numbers(blocks[row + 10u]);
    let nz = numbers(blocks[row + 11u]);
    let slope = nx * p.direction.x + ny * p.direction.y + nz * p.direction.z;
    let height = nx * a.x + ny * a.y + nz * a.z;
    let sloped = slope != vec4<f32>(0.0);
    let plane = height / select(vec4<f32>(1.0), slope, sloped);
    let x0 = (min(min(a.x, b.x), c.x) - p.margin) * p.inverse.x;
    let x1 = (max(max(a.x, b.x), c.x) + p.margin) * p.inverse.x;
    let y0 = (min(min(a.y, b.y), c.y) - p.margin) * p.inverse.y;
    let y1 = (max(max(a.y, b.y), c.y) + p.margin) * p.inverse.y;
    let z0 = (min(min(a.z, b.z), c.z) - p.margin) * p.inverse.z;
    let z1 = (max(max(a.z, b.z), c.z) + p.margin) * p.inverse.z;
    let enter = max(max(min(x0, x1), min(y0, y1)), min(z0, z1));
    let leave = min(min(max(x0, x1), max(y0, y1)), max(z0, z1));
    let distance = min(max(plane, enter), leave);
    let off = abs((plane - distance) * slope);
    let limit = min(p.far, (*n).limit);
    let counts = inside & sloped & (enter <= leave) & (off <= vec4<f32>(p.margin))
        & (distance >= vec4<f32>(p.near)) & (distance <= vec4<f32>(limit));
    if !any(counts) {
        return;
    }
    let ids = bitcast<vec4<i32>>(blocks[row + 12u]);
    let indices = blocks[row + 13u];
    let across = inverseSqrt(dot(p.direction, p.direction));
    for (var k = 0u; k < 4u; k += 1u) {
        if !counts[k] || indices[k] == NOTHING || distance[k] > (*n).limit {
            continue;
        }
        let id = select(instance_id, ids[k], source == 0u);
        if source == 0u && id == hidden {
            continue;
        }
        let grazing = min(1.0 / max(abs(slope[k]) * across, 1e-6), 32.0);
        let reach = plane[k] - (1e-5 + 1e-6 * plane[k]) * grazing;
        offer(n, distance[k], reach, source, block * 4u + k, id, indices[k]);
    }
}

fn walk(ray: Ray, hidden: i32, world: u32, n: ptr<function, Nearest>) {
    var links: array<u32, STACK>;
    var enters: array<f32, STACK>;
    let header = frame[world];
    let instances = header.y;
    let above = world + 3u;
    for (var stage = 0u; stage < 2u; stage += 1u) {
        var in_tree = stage == 1u;
        var outer: Probe;
        var link = NOTHING;
        if in_tree {
            outer = probe(numbers(frame[world + 1u]).xyz, numbers(frame[world + 2u]).xyz, ray.origin, ray.direction, ray.near, ray.far, 1.0);
            link = header.x;
        } else {
            outer = probe(numbers(tables[3]).xyz, numbers(tables[4]).xyz, ray.origin, ray.direction, ray.near, ray.far, 1.0);
            link = tables[2].x;
        }
        var p = outer;
        var top = 0u;
        var ground = NOTHING;
        var source = 0u;
        var id = 0;
        if link == NOTHING {
            continue;
        }
        loop {
            let index = link & ~LEAF;
            var goes_on = false;
            if (link & LEAF) == 0u {
                // A node: its children that the ray enters, the nearest first.
                let row = index * NODE_ROWS;
                var planes: array<vec4<f32>, 6>;
                var children: vec4<u32>;
                if in_tree {
                    for (var k = 0u; k < 6u; k += 1u) {
                        planes[k] = numbers(frame[above + row + k]);
                    }
                    children = frame[above + row + 6u];
                } else {
                    for (var k = 0u; k < 6u; k += 1u) {
                        planes[k] = numbers(nodes[row + k]);
                    }
                    children = nodes[row + 6u];
                }
                let low = p.origin + p.margin;
                let high = p.origin - p.margin;
                let x0 = (planes[0] - low.x) * p.inverse.x;
                let x1 = (planes[3] - high.x) * p.inverse.x;
                let y0 = (planes[1] - low.y) * p.inverse.y;
                let y1 = (planes[4] - high.y) * p.inverse.y;
                let z0 = (planes[2] - low.z) * p.inverse.z;
                let z1 = (planes[5] - high.z) * p.inverse.z;
                let enter = max(max(max(min(x0, x1), min(y0, y1)), min(z0, z1)), vec4<f32>(p.near));
                let leave = min(min(max(x0, x1), max(y0, y1)), max(z0, z1));
                let limit = min((*n).limit, p.far);
                let entered = (enter <= min(leave, vec4<f32>(limit))) & (children != vec4<u32>(NOTHING));
                var closest = FAR;
                let bottom = top;
                for (var k = 0u; k < 4u; k += 1u) {
                    if !entered[k] {
                        continue;
                    }
                    var way = children[k];
                    var at = enter[k];
                    if !goes_on {
                        goes_on = true;
                        closest = at;
                        link = way;
                        continue;
                    }
                    if at < closest {
                        let other = link;
                        link = way;
                        way = other;
                        let further = closest;
                        closest = at;
                        at = further;
                    }
                    var place = top;
                    while place > bottom && enters[place - 1u] < at {
                        links[place] = links[place - 1u];
                        enters[place] = enters[place - 1u];
                        place -= 1u;
                    }
                    links[place] = way;
                    enters[place] = at;
                    top += 1u;
                }
            } else if in_tree {
                // An instance: into its own space, where the ray is in its box.
                let row = instances + index * INSTANCE_ROWS;
                let low = frame[row + 3u];
                let high = frame[row + 4u];
                let longest = bitcast<f32>(low.w);
                let instance_id = bitcast<i32>(high.w);
                if longest > 0.0 && instance_id != hidden {
                    let e = (numbers(low).xyz - (outer.origin + outer.margin)) * outer.inverse;
                    let l = (numbers(high).xyz - (outer.origin - outer.margin)) * outer.inverse;
                    let first = min(e, l);
                    let last = max(e, l);
                    let start = max(max(max(first.x, first.y), first.z), outer.near);
                    let end = min(min(min(last.x, last.y), last.z), outer.far);
                    if start <= min(end, (*n).limit) {
                        let i = numbers(frame[row]);
                        let j = numbers(frame[row + 1u]);
                        let k = numbers(frame[row + 2u]);
                        let way = outer.origin - vec3<f32>(i.w, j.w, k.w);
                        let origin = vec3<f32>(dot(i.xyz, way), dot(j.xyz, way), dot(k.xyz, way));
                        let d = outer.direction;
                        let direction = vec3<f32>(dot(i.xyz, d), dot(j.xyz, d), dot(k.xyz, d));
                        let mesh = mesh_row(index);
                        p = probe(numbers(tables[mesh]).xyz, numbers(tables[mesh + 1u]).xyz, origin, direction, start, end, longest);
                        link = tables[mesh].w;
                        if link != NOTHING {
                            goes_on = true;
                            in_tree = false;
                            ground = top;
                            source = index + 1u;
                            id = instance_id;
                        }
                    }
                }
            } else {
                meet(n, index, p, source, id, hidden);
            }
            if goes_on {
                continue;
            }
            // What waits.
            var is_done = false;
            loop {
                if top == ground {
                    in_tree = true;
                    p = outer;
                    ground = NOTHING;
                }
                if top == 0u {
                    is_done = true;
                    break;
                }
                top -= 1u;
                if enters[top] <= min((*n).limit, p.far) {
                    link = links[top];
                    break;
                }
            }
            if is_done {
                break;
            }
        }
    }
}

// As `rays::BODY_PIECES`.
const BODY_PIECES: u32 = 25u;

// The row of the mesh of an instance: the parts that move, then the pieces of agents' bodies.
fn mesh_row(instance: u32) -> u32 {
    let parts = tables[2].z;
    let k = select(instance, parts + (instance - parts) % BODY_PIECES, instance >= parts);
    return tables[1].z + k * 2u;
}

// The nearest surface on a ray; its slot is NOTHING when there is none.
fn closest(ray: Ray, hidden: i32, world: u32) -> Nearest {
    var n = nearest_from(FAR, ray.far);
    if ray.near > ray.far {
        return n;
    }
    walk(ray, hidden, world, &n);
    if n.unsure_at < FAR && n.unsure_at <= horizon(n.distance) {
        n = nearest_from(n.distance, ray.far);
        walk(ray, hidden, world, &n);
    }
    return n;
}
