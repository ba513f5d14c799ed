// What all kernels share: buffers, and the rows of a view. Rows are four numbers; `gpu/house.rs` and `gpu/rows.rs` write them.

@group(0) @binding(0) var<storage, read> nodes: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read> blocks: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> tables: array<vec4<u32>>;
@group(1) @binding(0) var<storage, read> frame: array<vec4<u32>>;
@group(1) @binding(1) var<storage, read> lens_rays: array<vec4<f32>>;
@group(1) @binding(2) var<storage, read_write> seen: array<vec4<u32>>;
@group(1) @binding(3) var<storage, read_write> images: array<u32>;

const NOTHING: u32 = 0xffffffffu;
// Stands for an infinite distance.
const FAR: f32 = 3e38;
const PI: f32 = 3.14159265358979;

fn table_word(base: u32, word: u32) -> u32 {
    return tables[base + (word >> 2u)][word & 3u];
}

fn table_number(base: u32, word: u32) -> f32 {
    return bitcast<f32>(table_word(base, word));
}

fn numbers(row: vec4<u32>) -> vec4<f32> {
    return bitcast<vec4<f32>>(row);
}

fn rotate(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

fn conjugate(q: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(-q.xyz, q.w);
}

struct View {
    // The position of its first row.
    row: u32,
    right: vec3<f32>,
    up: vec3<f32>,
    back: vec3<f32>,
    eye: vec3<f32>,
    near: f32,
    far: f32,
    hidden: i32,
    // The first row of its world.
    world: u32,
    lens: vec4<f32>,
    bend: vec4<f32>,
    more: vec2<f32>,
    kind: u32,
    // The first of its rays in `lens_rays`.
    rays: u32,
    width: u32,
    height: u32,
    first_row: u32,
    rows: u32,
    first_tile: u32,
    // The position of its first pixel in `seen`.
    first_pixel: u32,
}

const VIEW_ROWS: u32 = 16u;

fn view_at(k: u32) -> View {
    var v: View;
    v.row = 1u + k * VIEW_ROWS;
    let right = frame[v.row];
    let up = frame[v.row + 1u];
    let back = frame[v.row + 2u];
    let eye = frame[v.row + 3u];
    v.right = numbers(right).xyz;
    v.up = numbers(up).xyz;
    v.back = numbers(back).xyz;
    v.eye = numbers(eye).xyz;
    v.near = bitcast<f32>(right.w);
    v.far = bitcast<f32>(up.w);
    v.hidden = bitcast<i32>(back.w);
    v.world = eye.w;
    v.lens = numbers(frame[v.row + 4u]);
    v.bend = numbers(frame[v.row + 5u]);
    let kind = frame[v.row + 6u];
    v.more = numbers(kind).xy;
    v.kind = kind.z;
    v.rays = kind.w;
    let size = frame[v.row + 7u];
    v.width = size.x;
    v.height = size.y;
    v.first_row = size.z;
    v.rows = size.w;
    v.first_tile = frame[v.row + 8u].x;
    v.first_pixel = frame[v.row + 8u].y;
    return v;
}

// The view that a tile of 8 by 8 pixels belongs to; they stand in the order of their tiles.
fn view_of_tile(tile: u32) -> u32 {
    var low = 0u;
    var high = frame[0].x;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if frame[1u + middle * VIEW_ROWS + 8u].x <= tile {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

struct Pixel {
    is_there: bool,
    view: View,
    // In the image.
    x: u32,
    y: u32,
    // In the rows that are wanted.
    index: u32,
}

// The pixel of an invocation of a kernel over all tiles of all views.
fn pixel_of(group: vec3<u32>, groups: vec3<u32>, local: vec3<u32>) -> Pixel {
    var pixel: Pixel;
    pixel.is_there = false;
    let tile = group.y * groups.x + group.x;
    if tile >= frame[0].y {
        return pixel;
    }
    pixel.view = view_at(view_of_tile(tile));
    let own = tile - pixel.view.first_tile;
    let across = (pixel.view.width + 7u) / 8u;
    pixel.x = (own % across) * 8u + local.x;
    let row = (own / across) * 8u + local.y;
    pixel.y = pixel.view.first_row + row;
    pixel.is_there = pixel.x < pixel.view.width && row < pixel.view.rows;
    pixel.index = row * pixel.view.width + pixel.x;
    return pixel;
}
