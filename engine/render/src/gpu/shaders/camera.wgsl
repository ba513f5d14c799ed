// Rays of pixels, and where points appear. As in `camera/`.

const PINHOLE: u32 = 0u;
const BROWN_CONRADY: u32 = 1u;
const FISHEYE: u32 = 2u;
const EQUIRECTANGULAR: u32 = 3u;
const CUBEMAP: u32 = 4u;
const ORTHOGRAPHIC: u32 = 5u;

struct Ray {
    origin: vec3<f32>,
    // Unit length; zero for a pixel that sees nothing.
    direction: vec3<f32>,
    near: f32,
    far: f32,
    // Depth per length along the ray.
    per_length: f32,
}

// A ray in the space of the mesh that moves; as it is for what stands still (source 0).
fn in_instance(ray: Ray, source: u32, world: u32) -> Ray {
    var local = ray;
    if source > 0u {
        let row = frame[world].y + (source - 1u) * INSTANCE_ROWS;
        let i = numbers(frame[row]);
        let j = numbers(frame[row + 1u]);
        let k = numbers(frame[row + 2u]);
        let way = ray.origin - vec3<f32>(i.w, j.w, k.w);
        let d = ray.direction;
        local.origin = vec3<f32>(dot(i.xyz, way), dot(j.xyz, way), dot(k.xyz, way));
        local.direction = vec3<f32>(dot(i.xyz, d), dot(j.xyz, d), dot(k.xyz, d));
    }
    return local;
}

fn depth_is_range(v: View) -> bool {
    return v.kind == FISHEYE || v.kind == EQUIRECTANGULAR || v.kind == CUBEMAP;
}

fn ray_of(v: View, column: u32, row: u32) -> Ray {
    let x = f32(column) + 0.5;
    let y = f32(row) + 0.5;
    var ray = Ray(v.eye, -v.back, v.near, v.far, 1.0);
    if v.kind == ORTHOGRAPHIC {
        let across = (x / f32(v.width) - 0.5) * v.lens.x;
        let up = (0.5 - y / f32(v.height)) * v.lens.y;
        ray.origin = v.eye + v.right * across + v.up * up;
        return ray;
    }
    if v.kind == PINHOLE {
        let across = (x - v.lens.z) / v.lens.x;
        let up = (v.lens.w - y) / v.lens.y;
        let distance = sqrt(across * across + (up * up + 1.0));
        ray.direction = (v.right * across + (v.up * up - v.back)) / distance;
        ray.per_length = 1.0 / distance;
        ray.near = v.near * distance;
        ray.far = v.far * distance;
        return ray;
    }
    let bent = lens_rays[v.rays + row * v.width + column].xyz;
    let distance = length(bent);
    if distance < 1e-9 {
        ray.direction = vec3<f32>(0.0);
        ray.near = 0.0;
        ray.far = -1.0;
        return ray;
    }
    ray.direction = (v.right * bent.x + v.up * bent.y + v.back * bent.z) / distance;
    if !depth_is_range(v) {
        ray.per_length = 1.0 / distance;
        ray.near = v.near * distance;
        ray.far = v.far * distance;
    }
    return ray;
}

// Source: S. L. Moshier, Cephes Mathematical Library: atanf, good to 2e-7.
fn arc_tangent(x: f32) -> f32 {
    var z = abs(x);
    var start = 0.0;
    if z > 2.414213562373095 {
        start = 0.5 * PI;
        z = -1.0 / z;
    } else if z > 0.4142135623730950 {
        start = 0.25 * PI;
        z = (z - 1.0) / (z + 1.0);
    }
    let s = z * z;
    let part = (((8.05374449538e-2 * s - 1.38776856032e-1) * s + 1.99777106478e-1) * s - 3.33329491539e-1) * s * z + z;
    let angle = start + part;
    return select(angle, -angle, x < 0.0);
}

fn arc_tangent2(y: f32, x: f32) -> f32 {
    if abs(x) < 1e-30 {
        return select(select(0.0, -0.5 * PI, y < 0.0), 0.5 * PI, y > 0.0);
    }
    let angle = arc_tangent(y / x);
    if x > 0.0 {
        return angle;
    }
    return select(angle + PI, angle - PI, y < 0.0);
}

// Whether a number is infinite or none. Asked of its bits, since compilers may take it that no number is.
fn is_endless(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) == 0x7f800000u;
}

struct Projected {
    is_seen: bool,
    image: vec2<f32>,
}

fn nowhere() -> Projected {
    return Projected(false, vec2<f32>(0.0));
}

struct Bent {
    at: vec2<f32>,
    by_x: vec2<f32>,
    by_y: vec2<f32>,
}

fn bend(v: View, p: vec2<f32>) -> Bent {
    let k = v.bend.xyz;
    let p1 = v.bend.w;
    let p2 = v.more.x;
    let r2 = dot(p, p);
    let radial = 1.0 + r2 * (k.x + r2 * (k.y + r2 * k.z));
    let slope = k.x + r2 * (2.0 * k.y + r2 * 3.0 * k.z);
    let mixed = 2.0 * p.x * p.y * slope + 2.0 * p1 * p.x + 2.0 * p2 * p.y;
    return Bent(
        vec2<f32>(
            p.x * radial + 2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x),
            p.y * radial + p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y,
        ),
        vec2<f32>(radial + 2.0 * p.x * p.x * slope + 2.0 * p1 * p.y + 6.0 * p2 * p.x, mixed),
        vec2<f32>(mixed, radial + 2.0 * p.y * p.y * slope + 6.0 * p1 * p.y + 2.0 * p2 * p.x),
    );
}

// The lens of Brown and Conrady; nothing beyond its fold.
fn distort(v: View, p: vec2<f32>) -> Projected {
    for (var ring = 1u; ring <= 24u; ring += 1u) {
        let at = bend(v, p * (f32(ring) / 24.0));
        let area = at.by_x.x * at.by_y.y - at.by_x.y * at.by_y.x;
        if !(area > 0.0 && at.by_x.x + at.by_y.y > 0.0) {
            return nowhere();
        }
    }
    return Projected(true, v.lens.zw + v.lens.xy * bend(v, p).at);
}

fn cube_project(v: View, point: vec3<f32>) -> Projected {
    var right = array<vec3<f32>, 6>(
        vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, -1.0), vec3<f32>(-1.0, 0.0, 0.0),
        vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(1.0, 0.0, 0.0),
    );
    var up = array<vec3<f32>, 6>(
        vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 1.0, 0.0),
        vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.0, 0.0, -1.0),
    );
    var back = array<vec3<f32>, 6>(
        vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, -1.0),
        vec3<f32>(-1.0, 0.0, 0.0), vec3<f32>(0.0, -1.0, 0.0), vec3<f32>(0.0, 1.0, 0.0),
    );
    var face = 6u;
    var deepest = 0.0;
    for (var k = 0u; k < 6u; k += 1u) {
        let depth = -dot(point, back[k]);
        if depth > deepest {
            deepest = depth;
            face = k;
        }
    }
    if face == 6u {
        return nowhere();
    }
    let edge = f32(v.width);
    let x = (dot(point, right[face]) / deepest + 1.0) * 0.5 * edge;
    let y = (1.0 - dot(point, up[face]) / deepest) * 0.5 * edge;
    return Projected(true, vec2<f32>(x, y + f32(face) * edge));
}

// Where a point in camera space appears.
fn project(v: View, point: vec3<f32>) -> Projected {
    let depth = -point.z;
    let across = length(point.xy);
    switch v.kind {
        case ORTHOGRAPHIC: {
            return Projected(true, vec2<f32>(
                (point.x / v.lens.x + 0.5) * f32(v.width),
                (0.5 - point.y / v.lens.y) * f32(v.height),
            ));
        }
        case PINHOLE: {
            if depth <= 0.0 {
                return nowhere();
            }
            return Projected(true, v.lens.zw + v.lens.xy * vec2<f32>(point.x, -point.y) / depth);
        }
        case BROWN_CONRADY: {
            if depth <= 0.0 {
                return nowhere();
            }
            return distort(v, vec2<f32>(point.x, -point.y) / depth);
        }
        case FISHEYE: {
            let angle = arc_tangent2(across, depth);
            if angle > v.more.y || is_endless(across) || (across == 0.0 && depth == 0.0) {
                return nowhere();
            }
            let s = angle * angle;
            let radius = angle * (1.0 + s * (v.bend.x + s * (v.bend.y + s * (v.bend.z + s * v.bend.w))));
            let scale = select(0.0, radius / across, across > 0.0);
            return Projected(true, v.lens.zw + v.lens.xy * vec2<f32>(point.x, -point.y) * scale);
        }
        case EQUIRECTANGULAR: {
            let level = length(point.xz);
            if level == 0.0 && point.y == 0.0 {
                return nowhere();
            }
            let right = arc_tangent2(point.x, depth);
            let up = arc_tangent2(point.y, level);
            return Projected(true, vec2<f32>(
                (right / (2.0 * PI) + 0.5) * f32(v.width),
                (0.5 - up / PI) * f32(v.height),
            ));
        }
        default: {
            return cube_project(v, point);
        }
    }
}
