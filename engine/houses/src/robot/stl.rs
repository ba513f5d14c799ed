//! STL files, binary and text.

use dwell_scene::Mesh;
use glam::Vec3;

/// Bytes before the triangles of a binary file, and of a triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file.
///
/// # Errors
/// A message that says what is wrong with the file.
pub(super) fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let count = bytes
        .get(80..HEADER)
        .map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]) as usize);
    // Some binary files begin with "solid" too, so the size decides.
    let corners = match count {
        Some(count) if bytes.len() == HEADER + TRIANGLE * count => binary(&bytes[HEADER..]),
        _ if bytes.trim_ascii_start().starts_with(b"solid") => text(bytes)?,
        Some(count) => {
            let (found, expected) = (bytes.len(), HEADER + TRIANGLE * count);
            return Err(format!("{found} bytes, {count} triangles need {expected}"));
        }
        None => return Err(format!("{} bytes are no STL file", bytes.len())),
    };
    if let Some(k) = corners.iter().position(|corner| !corner.is_finite()) {
        return Err(format!(
            "corner {} of triangle {} is not finite",
            k % 3,
            k / 3
        ));
    }
    let triangles = (0..corners.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    Ok(Mesh {
        triangles: triangles.collect(),
        positions: corners,
        ..Mesh::default()
    })
}

fn binary(body: &[u8]) -> Vec<Vec3> {
    let number = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    body.chunks_exact(TRIANGLE)
        .flat_map(|triangle| triangle[12..48].chunks_exact(12))
        .map(|c| Vec3::new(number(c), number(&c[4..]), number(&c[8..])))
        .collect()
}

fn text(bytes: &[u8]) -> Result<Vec<Vec3>, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut corners = Vec::new();
    for (line, words) in text.lines().map(str::split_whitespace).enumerate() {
        let mut words = words;
        if words.next() != Some("vertex") {
            continue;
        }
        let numbers: Vec<f32> = words.map_while(|word| word.parse().ok()).collect();
        let [x, y, z] = numbers[..] else {
            return Err(format!("line {}: a vertex has three numbers", line + 1));
        };
        corners.push(Vec3::new(x, y, z));
    }
    if corners.len() % 3 != 0 {
        return Err(format!("{} corners make no triangles", corners.len()));
    }
    Ok(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
                        endsolid a\n";

    #[test]
    fn text_and_binary_say_the_same() {
        let mut bytes = b"solid, says a careless exporter".to_vec();
        bytes.resize(80, 0);
        bytes.extend(1_u32.to_le_bytes());
        for number in [0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0_f32] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
        assert_eq!(read(&bytes).unwrap(), read(TEXT.as_bytes()).unwrap());
        bytes.pop();
        assert!(read(&bytes).is_ok_and(|mesh| mesh.triangles.is_empty()) || read(&bytes).is_err());
        assert!(read(b"nothing").is_err());
        assert!(read(TEXT.replace("1 0 0", "nan 0 0").as_bytes()).is_err());
    }
}
