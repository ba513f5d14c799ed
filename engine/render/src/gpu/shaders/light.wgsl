// The light of lit pictures. As in `light/`, whose `flat.rs` writes the rows.

const OUTSIDE: u32 = 0xffffu;
const PANE_TRANSMITTANCE: f32 = 0.7;
const PENUMBRA: f32 = 0.03;
const NEAREST: f32 = 0.05;
const PANES: u32 = 8u;
const LUMINANCE: vec3<f32> = vec3<f32>(0.2126, 0.7152, 0.0722);
const TO_LOW_SUN: vec3<f32> = vec3<f32>(0.485, 0.588, 0.647);

// The first row of the house's light.
fn house_light() -> u32 {
    return tables[2].y;
}

fn has_air() -> bool {
    return numbers(tables[house_light() + 2u]).w > 0.0;
}

// The first row of the open air.
fn air_row() -> u32 {
    return tables[house_light() + 3u].w;
}

// The room of a point, or OUTSIDE.
fn room_of(point: vec3<f32>) -> u32 {
    let head = tables[house_light()];
    let size = tables[house_light() + 1u];
    let grid = numbers(head);
    let place = (point.xz - grid.xy) * grid.z;
    if !(place.x >= 0.0 && place.y >= 0.0 && place.x < f32(size.x) && place.y < f32(size.y)) {
        return OUTSIDE;
    }
    let cell = u32(place.y) * size.x + u32(place.x);
    for (var k = head.w; k > 0u; k -= 1u) {
        let storey = tables[house_light() + 3u + k];
        if point.y < bitcast<f32>(storey.x) || point.y > bitcast<f32>(storey.y) {
            continue;
        }
        let room = (table_word(storey.z, cell >> 1u) >> ((cell & 1u) * 16u)) & 0xffffu;
        if room != OUTSIDE {
            return room;
        }
    }
    return OUTSIDE;
}

// Illuminance by one lamp.
fn lamp_light(row: u32, point: vec3<f32>, normal: vec3<f32>, id: i32) -> vec3<f32> {
    let place = frame[row];
    let way = numbers(place).xyz - point;
    let distance = max(length(way), NEAREST);
    let direction = way / distance;
    var cosine = dot(normal, direction);
    if id == bitcast<i32>(place.w) {
        cosine = abs(cosine);
    }
    if cosine <= 0.0 {
        return vec3<f32>(0.0);
    }
    let intensity = numbers(frame[row + 1u]);
    let cone = numbers(frame[row + 2u]);
    var part = 1.0;
    if intensity.w > -1.5 {
        let turn = -dot(cone.xyz, direction);
        if turn < intensity.w {
            return vec3<f32>(0.0);
        }
        if cone.w > 0.0 {
            part = pow(max(turn, 0.0), cone.w);
        }
    }
    let attenuation = numbers(frame[row + 3u]).xyz;
    let weakening = attenuation.x + distance * (attenuation.y + distance * attenuation.z);
    return intensity.xyz * (part * cosine / max(weakening, NEAREST * NEAREST));
}

// Sources that a ray tells of; others are positions of what casts shadows.
const NO_SOURCE: u32 = 0xffffffffu;
const SUN: u32 = 0xfffffffeu;

// Light on a point: of the two strongest sources apart, of which a ray each tells whether it arrives; the rest arrives.
struct Incoming {
    light: vec3<f32>,
    first: vec3<f32>,
    second: vec3<f32>,
    first_source: u32,
    second_source: u32,
}

fn offer_light(incoming: ptr<function, Incoming>, source: u32, light: vec3<f32>) {
    let strength = dot(light, LUMINANCE);
    if strength <= 0.0 {
        return;
    }
    let first = dot((*incoming).first, LUMINANCE);
    let second = dot((*incoming).second, LUMINANCE);
    if strength <= min(first, second) {
        (*incoming).light += light;
    } else if second < first {
        (*incoming).light += (*incoming).second;
        (*incoming).second = light;
        (*incoming).second_source = source;
    } else {
        (*incoming).light += (*incoming).first;
        (*incoming).first = light;
        (*incoming).first_source = source;
    }
}

// Adds the light of the lamps of a room; `place` is 0 outside, else the room and 1.
fn lamplight(incoming: ptr<function, Incoming>, light: u32, place: u32, at: Site, per_lx: f32) {
    let head = frame[light];
    let start = frame[head.y + (place >> 2u)][place & 3u];
    let next = place + 1u;
    let end = frame[head.y + (next >> 2u)][next & 3u];
    var source = NO_SOURCE;
    var sum = vec3<f32>(0.0);
    for (var k = start; k <= end; k += 1u) {
        var its = NO_SOURCE;
        var more = vec3<f32>(0.0);
        if k < end {
            let row = head.x + k * 4u;
            more = lamp_light(row, at.point, at.normal, at.id) * per_lx;
            // A shade shines by the light that passes it.
            its = select(frame[row + 3u].w, NO_SOURCE, at.id == bitcast<i32>(frame[row].w));
        }
        if its != source || k == end {
            if source == NO_SOURCE {
                (*incoming).light += sum;
            } else {
                offer_light(incoming, source, sum);
            }
            source = its;
            sum = vec3<f32>(0.0);
        }
        sum += more;
    }
}

struct Daylight {
    sky: vec3<f32>,
    // How much of the sun the surface has, where its ray passes the window.
    sun: f32,
}

fn daylight(row: u32, to_sun: vec3<f32>, point: vec3<f32>, normal: vec3<f32>) -> Daylight {
    let center = numbers(tables[row]);
    let inwards = numbers(tables[row + 1u]).xyz;
    let way = center.xyz - point;
    let height = -dot(inwards, way);
    if height <= 0.0 {
        return Daylight(vec3<f32>(0.0), 0.0);
    }
    let squared = dot(way, way);
    let distance = sqrt(squared);
    let direction = way / distance;
    let cosines = max(dot(normal, direction), 0.0) * (height / distance);
    let up = numbers(tables[row + 4u]).xyz;
    let down = numbers(tables[row + 5u]).xyz;
    let luminance = mix(down, up, clamp(0.5 + 1.5 * direction.y, 0.0, 1.0));
    let sky = luminance * (PANE_TRANSMITTANCE * center.w * cosines / (squared + center.w / PI));
    let against = -dot(inwards, to_sun);
    let on_surface = dot(normal, to_sun);
    if against <= 0.01 || on_surface <= 0.0 {
        return Daylight(sky, 0.0);
    }
    let on_window = point + to_sun * (height / against) - center.xyz;
    let across = numbers(tables[row + 2u]);
    let along = numbers(tables[row + 3u]);
    let inside = clamp((across.w - abs(dot(on_window, across.xyz))) / PENUMBRA, 0.0, 1.0)
        * clamp((along.w - abs(dot(on_window, along.xyz))) / PENUMBRA, 0.0, 1.0);
    return Daylight(sky, on_surface * inside);
}

// Whether nothing but glass stands on a ray, apart from a thing.
fn passes(start: Ray, hidden: i32, world: u32) -> bool {
    var ray = start;
    for (var k = 0u; k < PANES; k += 1u) {
        let n = closest(ray, hidden, world);
        if n.slot == NOTHING {
            return true;
        }
        let s = sight_of(ray, n.source, n.slot, n.distance, n.id);
        let look = tables[0].z + triangles[s.row + 3u].x * 3u;
        if numbers(tables[look]).w > 0.5 {
            return false;
        }
        ray.near = n.distance * (1.0 + 1e-5) + 1e-3;
    }
    return false;
}

// Whether light of a source arrives.
fn arrives(v: View, light: u32, source: u32, at: Site) -> bool {
    if source == NO_SOURCE {
        return true;
    }
    if source == SUN {
        let to_sun = numbers(tables[house_light() + 2u]).xyz;
        return passes(Ray(at.off, to_sun, 0.0, 500.0, 1.0), 0, v.world);
    }
    let caster = frame[frame[light + 1u].x + source];
    let center = numbers(caster).xyz;
    let way = at.off - center;
    let distance = length(way);
    // A flat surface that faces away meets light only by its rounded normal.
    if distance <= 1e-3 || dot(at.facing, way) >= 0.0 {
        return true;
    }
    return passes(Ray(center, way / distance, 0.0, distance, 1.0), bitcast<i32>(caster.w), v.world);
}

// Illuminance by the sky: nine spherical harmonics weighed by the cosine.
fn skylight(n: vec3<f32>) -> vec3<f32> {
    let first = air_row() + 3u;
    var sum = numbers(tables[first]).xyz * (0.282095 * PI);
    let linear = 2.0 * PI / 3.0 * 0.488603;
    sum += numbers(tables[first + 1u]).xyz * (linear * n.y);
    sum += numbers(tables[first + 2u]).xyz * (linear * n.z);
    sum += numbers(tables[first + 3u]).xyz * (linear * n.x);
    let quarter = PI / 4.0;
    sum += numbers(tables[first + 4u]).xyz * (quarter * 1.092548 * n.x * n.y);
    sum += numbers(tables[first + 5u]).xyz * (quarter * 1.092548 * n.y * n.z);
    sum += numbers(tables[first + 6u]).xyz * (quarter * 0.315392 * (3.0 * n.z * n.z - 1.0));
    sum += numbers(tables[first + 7u]).xyz * (quarter * 1.092548 * n.x * n.z);
    sum += numbers(tables[first + 8u]).xyz * (quarter * 0.546274 * (n.x * n.x - n.y * n.y));
    return max(sum, vec3<f32>(0.0));
}

// What white shows in the open air of a house that knows no sky.
fn open_air(normal: vec3<f32>) -> vec3<f32> {
    return vec3<f32>((0.35 + 0.25 * normal.y + 0.5 * max(dot(normal, TO_LOW_SUN), 0.0)) * 1.3);
}

struct Site {
    point: vec3<f32>,
    // Towards the viewer, interpolated between corners.
    normal: vec3<f32>,
    // Where the point's room is looked up.
    beside: vec3<f32>,
    // Where shadow rays end.
    off: vec3<f32>,
    // Of the flat triangle, towards the viewer.
    facing: vec3<f32>,
    id: i32,
}

// What a surface of reflectance 1 shows, in units of display white, before shadows.
fn incoming_light(light: u32, per_lx: f32, at: Site) -> Incoming {
    let room = room_of(at.beside);
    let air = has_air();
    let n = at.normal;
    var incoming = Incoming(vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), NO_SOURCE, NO_SOURCE);
    if room == OUTSIDE {
        if !air {
            incoming.light = open_air(n);
            lamplight(&incoming, light, 0u, at, per_lx);
            return incoming;
        }
        let row = air_row();
        let sun = numbers(tables[row]);
        let exposed = min(sun.w, per_lx);
        let ground = numbers(tables[row + 2u]).xyz * (0.5 - 0.5 * n.y);
        incoming.light = (skylight(n) + ground) * exposed;
        lamplight(&incoming, light, 0u, at, exposed);
        let across = max(dot(n, sun.xyz), 0.0);
        offer_light(&incoming, SUN, numbers(tables[row + 1u]).xyz * (across * exposed));
        return incoming;
    }
    let rooms = frame[light].z;
    let fill = 0.95 + 0.08 * n.y + 0.07 * n.x + 0.03 * n.z;
    var lx = numbers(frame[rooms + room]).xyz * fill;
    let size = tables[house_light() + 1u];
    let to_sun = numbers(tables[house_light() + 2u]).xyz;
    let sun_lx = numbers(tables[house_light() + 3u]).xyz;
    let start = table_word(size.w, room);
    let end = table_word(size.w, room + 1u);
    var sun = 0.0;
    for (var k = start; k < end; k += 1u) {
        let day = daylight(size.z + k * 6u, to_sun, at.point, n);
        lx += day.sky;
        if air {
            // Windows side by side let in one and the same sun.
            sun = max(sun, day.sun);
        } else {
            lx += sun_lx * day.sun;
        }
    }
    incoming.light = lx * per_lx;
    lamplight(&incoming, light, room + 1u, at, per_lx);
    offer_light(&incoming, SUN, sun_lx * (sun * per_lx));
    return incoming;
}

// What a surface of reflectance 1 shows, in units of display white.
fn brightness(v: View, light: u32, per_lx: f32, at: Site) -> vec3<f32> {
    let incoming = incoming_light(light, per_lx, at);
    var sum = incoming.light;
    if arrives(v, light, incoming.first_source, at) {
        sum += incoming.first;
    }
    if arrives(v, light, incoming.second_source, at) {
        sum += incoming.second;
    }
    return sum;
}

// One of the fifteen coefficients of the sky: A to E for Y, x and y.
fn coefficient(first: u32, k: u32) -> f32 {
    return bitcast<f32>(tables[first + (k >> 2u)][k & 3u]);
}

fn perez_part(first: u32, k: u32, cosine: f32, to_sun: f32) -> f32 {
    let c = clamp(to_sun, -1.0, 1.0);
    let angle = arc_tangent2(sqrt(max(1.0 - c * c, 0.0)), c);
    let a = coefficient(first, k);
    let b = coefficient(first, k + 1u);
    return (1.0 + a * exp(b / max(cosine, 0.02)))
        * (1.0 + coefficient(first, k + 2u) * exp(coefficient(first, k + 3u) * angle)
            + coefficient(first, k + 4u) * to_sun * to_sun);
}

// Luminance of the sky above level; as `dwell_scene::Dome::luminance`.
fn dome(direction: vec3<f32>) -> vec3<f32> {
    let first = air_row() + 12u;
    let sun = numbers(tables[first]);
    let zenith = numbers(tables[first + 1u]);
    if sun.w == 0.0 {
        return vec3<f32>((1.0 + 2.0 * direction.y) / 3.0 * zenith.z);
    }
    let to_sun = dot(direction, sun.xyz);
    var parts: array<f32, 3>;
    for (var k = 0u; k < 3u; k += 1u) {
        parts[k] = perez_part(first + 2u, k * 5u, direction.y, to_sun) / perez_part(first + 2u, k * 5u, 1.0, sun.y);
    }
    let bright = parts[0] * zenith.z;
    let x = zenith.x * parts[1];
    let y = zenith.y * parts[2];
    let over_y = bright / max(y, 1e-3);
    let big_x = x * over_y;
    let big_z = (1.0 - x - y) * over_y;
    let rgb = vec3<f32>(
        3.2406 * big_x - 1.5372 * bright - 0.4986 * big_z,
        -0.9689 * big_x + 1.8758 * bright + 0.0415 * big_z,
        0.0557 * big_x - 0.2040 * bright + 1.0570 * big_z,
    );
    let least = min(min(rgb.x, rgb.y), rgb.z);
    if least >= 0.0 {
        return rgb;
    }
    let part = bright / (bright - least);
    return max(vec3<f32>(bright) + (rgb - vec3<f32>(bright)) * part, vec3<f32>(0.0));
}

// What is seen where nothing is.
fn lit_sky(direction: vec3<f32>, per_lx: f32) -> vec3<f32> {
    if !has_air() {
        return plain_sky(direction) * 2.5;
    }
    let row = air_row();
    let exposed = min(numbers(tables[row]).w, per_lx);
    if direction.y >= 0.0 {
        return dome(direction) * (PI * exposed);
    }
    return numbers(tables[row + 2u]).xyz * exposed;
}

fn compress(light: f32) -> f32 {
    return min(light * (1.0 + light * (1.0 / 64.0)) / (1.0 + light), 1.0);
}

// Light as a display shows it. Source: E. Reinhard et al. (2002), equation 4.
fn display(light: vec3<f32>) -> vec3<f32> {
    let each = vec3<f32>(compress(light.x), compress(light.y), compress(light.z));
    let bright = dot(light, LUMINANCE);
    let whole = light * (compress(bright) / max(bright, 1e-6));
    return min((each + whole) * 0.5, vec3<f32>(1.0));
}
