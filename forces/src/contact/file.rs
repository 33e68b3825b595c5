//! Triangles from STL and OBJ files.

use super::mesh::{MOST_TRIANGLES, Soup};
use ropewalk_core::V3;
use ropewalk_scene::file;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

/// Bytes before the triangles of a binary STL file, and of each of them.
const HEADER: u64 = 84;
const FACET: u64 = 50;
/// An OBJ file isn't read if it is longer than this: it holds more triangles than contact takes.
const LONGEST: u64 = 60 * MOST_TRIANGLES as u64;

/// Reads the triangles of a file; its name ends in `.stl` or `.obj`.
///
/// # Errors
/// What is wrong with the file, without its name.
pub fn read(path: &Path) -> Result<Soup, String> {
    let kind = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let open = || file::open(path);
    match kind.as_str() {
        "stl" => stl(open()?),
        "obj" => obj(open()?),
        _ => Err("its name ends in neither `.stl` nor `.obj`, and no other meshes are read".into()),
    }
}

fn too_many(n: u64) -> String {
    format!(
        "it has {n} triangles, more than the {MOST_TRIANGLES} that contact takes: simplify it to a few thousand, which \
         is finer than a cable feels"
    )
}

fn stl(mut file: File) -> Result<Soup, String> {
    let said = |e: std::io::Error| e.to_string();
    let length = file.metadata().map_err(said)?.len();
    let mut head = Vec::new();
    file.by_ref().take(HEADER).read_to_end(&mut head).map_err(said)?;
    file.seek(SeekFrom::Start(0)).map_err(said)?;
    let count = head.get(80..84).and_then(|b| b.try_into().ok()).map(|b| u64::from(u32::from_le_bytes(b)));
    // binary files of some programs begin with `solid` too: their length tells
    if let Some(n) = count
        && length == HEADER + FACET * n
    {
        if n > MOST_TRIANGLES as u64 {
            return Err(too_many(n));
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(said)?;
        bytes[0] = 0;
        return facets(&mut Cursor::new(bytes), "its header");
    }
    if head.starts_with(b"solid") {
        return facets(&mut BufReader::new(file), "line 1");
    }
    let says = match count {
        Some(n) => format!(
            "bytes 80 to 83 say {n} triangles, which would make {} bytes, but it has {length}",
            HEADER + FACET * n
        ),
        None => format!("it has only {length} bytes"),
    };
    Err(format!("this is no STL file, or one that was cut off: it doesn't begin with `solid`, and {says}"))
}

fn facets<R: Read + Seek>(from: &mut R, start: &str) -> Result<Soup, String> {
    let broken = |n: usize, e: std::io::Error| {
        let place = if n == 0 { start.to_string() } else { format!("triangle {n}") };
        format!("this is no STL file, or a damaged one: behind {place}: {e}")
    };
    let (mut soup, mut known) = (Soup::default(), HashMap::new());
    let all = stl_io::create_stl_reader(from).map_err(|e| broken(0, e))?;
    for (n, facet) in all.enumerate() {
        let facet = facet.map_err(|e| broken(n, e))?;
        if n == MOST_TRIANGLES {
            return Err(too_many(n as u64 + 1).replacen("it has", "it has at least", 1));
        }
        soup.push(facet.vertices.map(|x| [0, 1, 2].map(|i| f64::from(x[i]))), &mut known);
    }
    Ok(soup)
}

fn obj(file: File) -> Result<Soup, String> {
    let length = file.metadata().map_err(|e| e.to_string())?.len();
    if length > LONGEST {
        return Err(format!(
            "it has {length} bytes, which is more than {MOST_TRIANGLES} triangles take: simplify it to a few thousand, \
             which is finer than a cable feels"
        ));
    }
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    // colours are of no interest
    let (models, _) =
        tobj::load_obj_buf(&mut BufReader::new(file), &options, |_| Err(tobj::LoadError::GenericFailure))
            .map_err(|e| format!("this is no OBJ file, or a damaged one: {e}"))?;
    let (mut soup, mut known) = (Soup::default(), HashMap::new());
    for mesh in models.iter().map(|m| &m.mesh) {
        let corner = |&k: &u32| -> Option<V3<f64>> {
            let x = mesh.positions.get(3 * k as usize..3 * k as usize + 3)?;
            Some([x[0], x[1], x[2]])
        };
        for t in mesh.indices.chunks_exact(3) {
            let (Some(a), Some(b), Some(c)) = (corner(&t[0]), corner(&t[1]), corner(&t[2])) else {
                return Err("a face of it names a corner that isn't there".into());
            };
            soup.push([a, b, c], &mut known);
        }
    }
    if soup.triangles.is_empty() {
        return Err("it holds no faces; is it an OBJ file?".into());
    }
    Ok(soup)
}
