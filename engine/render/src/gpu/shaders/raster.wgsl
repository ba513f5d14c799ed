// The raster path: triangles, with what pixels need to know of them. Corners are read where rays read them. An instance of a
// call is a piece: some blocks of triangles, and the record of where they stand.

struct Corner {
    @builtin(position) place: vec4<f32>,
    // 0 or the instance and 1, the triangle's slot, the id, and the id that is not seen.
    @location(0) @interpolate(flat, either) facts: vec4<u32>,
}

const DRAW_ROWS: u32 = 5u;
const BLOCK_VERTICES: u32 = 12u;

@vertex
fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Corner {
    // The first rows of records and of pieces.
    let starts = frame[0].zw;
    let piece = frame[starts.y + instance];
    var out: Corner;
    // Beyond the picture: a piece has fewer blocks than a call.
    out.place = vec4<f32>(2.0, 2.0, 2.0, 1.0);
    if vertex / BLOCK_VERTICES >= piece.y {
        return out;
    }
    let row = starts.x + piece.z * DRAW_ROWS;
    let head = frame[row + 4u];
    let slot = piece.x * 4u + vertex / 3u;
    let lane = slot % 4u;
    let block = (slot / 4u) * 14u;
    let first = block + (vertex % 3u) * 3u;
    let point = vec4<f32>(
        bitcast<f32>(blocks[first][lane]),
        bitcast<f32>(blocks[first + 1u][lane]),
        bitcast<f32>(blocks[first + 2u][lane]),
        1.0,
    );
    var id = head.y;
    if head.x == 0u {
        id = blocks[block + 12u][lane];
    }
    out.facts = vec4<u32>(head.x, slot, id, head.z);
    if blocks[block + 13u][lane] == NOTHING {
        return out;
    }
    out.place = vec4<f32>(
        dot(numbers(frame[row]), point),
        dot(numbers(frame[row + 1u]), point),
        dot(numbers(frame[row + 2u]), point),
        dot(numbers(frame[row + 3u]), point),
    );
    return out;
}

@fragment
fn surface(corner: Corner) -> @location(0) vec4<u32> {
    if corner.facts.z == corner.facts.w {
        discard;
    }
    // The slot and 1: what is cleared is nothing. Last, depth.
    return vec4<u32>(corner.facts.x, corner.facts.y + 1u, corner.facts.z, bitcast<u32>(1.0 / corner.place.w));
}
