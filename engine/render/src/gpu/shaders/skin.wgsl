// What is seen of a surface before light. As in `surfaces.rs`, `texture.rs` and `footprint.rs`.

// Presets of a view.
const FLAT: u32 = 0u;
const LIT: u32 = 1u;

// What a ray met.
struct Sight {
    point: vec3<f32>,
    // Of the ray; unit length.
    direction: vec3<f32>,
    depth: f32,
    per_length: f32,
    id: i32,
    // 0 for what never moves, otherwise the instance and 1.
    source: u32,
    slot: u32,
    // Of its triangle in `triangles`.
    row: u32,
}

fn sight_of(ray: Ray, source: u32, slot: u32, distance: f32, id: i32) -> Sight {
    let index = blocks[(slot / 4u) * BLOCK_ROWS + 13u][slot % 4u];
    var first = 0u;
    if source > 0u {
        first = tables[mesh_row(source - 1u) + 1u].w;
    }
    return Sight(
        ray.origin + ray.direction * distance,
        ray.direction,
        distance * ray.per_length,
        ray.per_length,
        id,
        source,
        slot,
        (first + index) * 4u,
    );
}

// Rotation and position of what a triangle moves with.
struct Place {
    rotation: vec4<f32>,
    position: vec3<f32>,
}

fn place_of(world: u32, source: u32) -> Place {
    if source == 0u {
        return Place(vec4<f32>(0.0, 0.0, 0.0, 1.0), vec3<f32>(0.0));
    }
    let row = frame[world].y + (source - 1u) * INSTANCE_ROWS + 5u;
    return Place(numbers(frame[row]), numbers(frame[row + 1u]).xyz);
}

// The colour of a person's piece, sRGB, and 255; 0 for everything else.
fn tint_of(world: u32, source: u32) -> u32 {
    if source == 0u {
        return 0u;
    }
    return frame[frame[world].y + (source - 1u) * INSTANCE_ROWS + 6u].w;
}

fn into(place: Place, point: vec3<f32>) -> vec3<f32> {
    return rotate(conjugate(place.rotation), point - place.position);
}

struct Neighbours {
    first: u32,
    second: u32,
    weight: f32,
}

fn wrapped(k: i32, size: u32) -> u32 {
    let inside = select(k, k + i32(size), k < 0);
    return select(min(u32(inside), size - 1u), size - 1u, inside < 0);
}

// The two texels beside a repeating coordinate, and the weight of the second.
fn neighbours(coordinate: f32, size: u32) -> Neighbours {
    let c = clamp(coordinate, -1e6, 1e6);
    let place = (c - round(c)) * f32(size) - 0.5;
    let below = round(place - 0.5);
    let first = i32(below);
    return Neighbours(wrapped(first, size), wrapped(first + 1, size), place - below);
}

fn texel(index: u32) -> vec4<f32> {
    return decoded(table_word(tables[1].w, index));
}

fn decoded(bytes: u32) -> vec4<f32> {
    let decode = tables[1].x;
    return vec4<f32>(
        table_number(decode, bytes & 255u),
        table_number(decode, (bytes >> 8u) & 255u),
        table_number(decode, (bytes >> 16u) & 255u),
        f32(bytes >> 24u) / 255.0,
    );
}

// Linear colour and alpha of an image, of the level whose texels are about as large as the pixel.
fn sample(image: u32, uv: vec2<f32>, texels_per_pixel: f32) -> vec4<f32> {
    // First level, last level, whether some texel is clear.
    let header = tables[tables[0].y + image];
    var level = 0u;
    if texels_per_pixel >= 2.0 {
        let exponent = (bitcast<u32>(texels_per_pixel) >> 23u) & 255u;
        level = (max(exponent, 126u) - 126u) / 2u;
    }
    let size = tables[tables[0].x + header.x + min(level, header.y)];
    let x = neighbours(uv.x, size.y);
    let y = neighbours(-uv.y, size.z);
    let above = size.x + y.first * size.y;
    let below = size.x + y.second * size.y;
    let sum = texel(above + x.first) * ((1.0 - x.weight) * (1.0 - y.weight))
        + texel(above + x.second) * (x.weight * (1.0 - y.weight))
        + texel(below + x.first) * ((1.0 - x.weight) * y.weight)
        + texel(below + x.second) * (x.weight * y.weight);
    return vec4<f32>(sum.xyz, select(1.0, sum.w, header.z != 0u));
}

// The least cosine between ray and normal at which a pixel's footprint still grows.
const GRAZING: f32 = 0.05;
// Most samples along the longer axis of a footprint.
const MOST_TAPS: f32 = 8.0;

// Below this sine a surface is seen straight on.
const STRAIGHT: f32 = 1e-3;

// Some unit vector across another. Source: T. Duff et al., JCGT 6(1), 2017: orthonormal basis.
fn any_across(n: vec3<f32>) -> vec3<f32> {
    let side = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (side + n.z);
    return vec3<f32>(n.x * n.y * a, side + n.y * n.y * a, -n.y);
}

// A triangle's map to texture coordinates, for ways on it.
struct Ways {
    u: vec3<f32>,
    v: vec3<f32>,
    size: vec2<f32>,
}

fn uv_along(ways: Ways, way: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(dot(ways.u, way), dot(ways.v, way));
}

// The mean over what a ray of this width covers of an image. As in `footprint.rs`.
fn sample_along(image: u32, uv: vec2<f32>, ways: Ways, normal: vec3<f32>, direction: vec3<f32>, width: f32) -> vec4<f32> {
    let along = dot(normal, direction);
    var ahead = direction - normal * along;
    let sine = length(ahead);
    if sine > STRAIGHT {
        ahead /= sine;
    } else {
        ahead = any_across(normal);
    }
    let beside = cross(normal, ahead);
    var long = uv_along(ways, ahead) * (width / max(abs(along), GRAZING));
    let other = uv_along(ways, beside) * width;
    let a = length(long * ways.size);
    let b = length(other * ways.size);
    if a < b {
        long = other;
    }
    let most = max(a, b);
    let wide = max(max(min(a, b), most / MOST_TAPS), 1.0);
    let taps = clamp(u32(most / wide + 0.75), 1u, u32(MOST_TAPS));
    let step = long / f32(taps);
    var at = uv - step * (0.5 * f32(taps - 1u));
    var sum = vec4<f32>(0.0);
    for (var tap = 0u; tap < taps; tap += 1u) {
        sum += sample(image, at, wide * wide);
        at += step;
    }
    return sum / f32(taps);
}

struct Skin {
    color: vec3<f32>,
    opacity: f32,
    // By the winding, in the world.
    normal: vec3<f32>,
    emission: vec3<f32>,
    is_mirror: bool,
}

fn skin_of(v: View, s: Sight) -> Skin {
    let facts = triangles[s.row + 2u];
    let look = tables[0].z + triangles[s.row + 3u].x * 3u;
    let base = numbers(tables[look]);
    let glow = numbers(tables[look + 1u]);
    let more = tables[look + 2u];
    let place = place_of(v.world, s.source);
    var skin = Skin(base.xyz, base.w, rotate(place.rotation, numbers(facts).xyz), glow.xyz, more.y != 0u);
    let tint = tint_of(v.world, s.source);
    if tint != 0u {
        skin.color = decoded(tint).xyz;
    }
    if more.x != NOTHING {
        let area = numbers(frame[v.row + 11u]).xy;
        let covered = (area.x + area.y * s.depth * s.depth) * s.per_length;
        let point = vec4<f32>(into(place, s.point), 1.0);
        let to_u = numbers(triangles[s.row]);
        let to_v = numbers(triangles[s.row + 1u]);
        let uv = vec2<f32>(dot(to_u, point), dot(to_v, point));
        var found: vec4<f32>;
        if frame[v.row + 14u].x == FLAT {
            let slope = max(abs(dot(skin.normal, s.direction)), GRAZING);
            found = sample(more.x, uv, covered / slope * bitcast<f32>(facts.w) * glow.w);
        } else {
            let size = tables[tables[0].x + tables[tables[0].y + more.x].x];
            let ways = Ways(to_u.xyz, to_v.xyz, vec2<f32>(f32(size.y), f32(size.z)));
            let turned = rotate(conjugate(place.rotation), s.direction);
            found = sample_along(more.x, uv, ways, numbers(facts).xyz, turned, sqrt(covered));
        }
        skin.color *= found.xyz;
        skin.opacity *= found.w;
    }
    return skin;
}

// Towards the viewer.
fn facing(normal: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    return select(normal, -normal, dot(normal, direction) > 0.0);
}
