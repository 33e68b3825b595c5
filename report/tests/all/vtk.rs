//! Files for ParaView, read back by their XML: offsets, lengths, numbers.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use ropewalk_report::{BodyRecord, FieldRecord, LineRecord, LineSnapshot, Pose, Quantity, Shape, Solid, vtk};

/// A tag with its attributes.
type Tag = (String, HashMap<String, String>);

/// A small reader of XML: all tags in order; it fails on whatever isn't nested or quoted as it must be.
fn tags(text: &str) -> Vec<Tag> {
    let (mut all, mut open): (Vec<Tag>, Vec<String>) = (Vec::new(), Vec::new());
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        if let Some(comment) = rest.strip_prefix("!--") {
            let end = comment.find("--").unwrap();
            assert_eq!(&comment[end..end + 3], "-->", "two hyphens in a comment");
            rest = &comment[end + 3..];
            continue;
        }
        let end = rest.find('>').unwrap();
        let (tag, after) = rest.split_at(end);
        rest = after;
        if tag.starts_with('?') {
            continue;
        }
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name));
            continue;
        }
        let body = tag.trim_end_matches('/');
        let (name, mut attributes) = body.split_once(' ').unwrap_or((body, ""));
        let mut map = HashMap::new();
        while let Some((key, value)) = attributes.split_once("=\"") {
            let (value, next) = value.split_once('"').unwrap();
            assert!(!value.contains(['<', '&']) || value.contains(';'));
            map.insert(key.trim().to_string(), value.to_string());
            attributes = next;
        }
        if !tag.ends_with('/') {
            open.push(name.to_string());
        }
        all.push((name.to_string(), map));
    }
    assert!(open.is_empty(), "{open:?}");
    all
}

/// Arrays of a `.vtp` by name (the cells' by kind and name) as numbers, and the counts of its piece.
fn read(path: &Path) -> (HashMap<String, Vec<f64>>, HashMap<String, String>) {
    let bytes = fs::read(path).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let raw = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
    let tail = b"\n</AppendedData>\n</VTKFile>\n";
    assert!(bytes.ends_with(tail));
    let head = format!("{}</AppendedData></VTKFile>", std::str::from_utf8(&bytes[..raw]).unwrap());
    let (mut arrays, mut piece, mut group) = (HashMap::new(), HashMap::new(), String::new());
    let mut expected = 0;
    for (name, attributes) in tags(&head) {
        match name.as_str() {
            "Piece" => piece = attributes,
            "VTKFile" => assert_eq!(attributes["header_type"], "UInt64"),
            "DataArray" => {
                let offset: usize = attributes["offset"].parse().unwrap();
                assert_eq!(offset, expected, "arrays follow each other");
                let at = raw + offset;
                let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
                let values = &bytes[at + 8..at + 8 + length];
                let numbers: Vec<f64> = match attributes["type"].as_str() {
                    "Float64" => {
                        values.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
                    }
                    "Int64" => {
                        values.chunks(8).map(|b| i64::from_le_bytes(b.try_into().unwrap()) as f64).collect()
                    }
                    "Int32" => {
                        values.chunks(4).map(|b| i32::from_le_bytes(b.try_into().unwrap()).into()).collect()
                    }
                    other => panic!("{other}"),
                };
                expected = offset + 8 + length;
                arrays.insert(format!("{group}/{}", attributes["Name"]), numbers);
            }
            other => group = other.to_string(),
        }
    }
    assert_eq!(raw + expected + tail.len(), bytes.len(), "the last array ends where the file does");
    (arrays, piece)
}

fn record() -> FieldRecord {
    let line = |name: &str, unit: &str, counts: [usize; 2]| LineRecord {
        quantities: vec![Quantity::new("tension", unit)],
        snapshots: counts
            .iter()
            .map(|n| LineSnapshot {
                s: (0..*n).map(|k| k as f64).collect(),
                position: (0..*n).map(|k| [0.1 * k as f64, 1.0 / 3.0, -2.0]).collect(),
                values: vec![(0..*n).map(|k| 100.0 + k as f64).collect()],
                ..LineSnapshot::default()
            })
            .collect(),
        ..LineRecord::new(name, "cable", 0.1)
    };
    let quarter = (0.5_f64).sqrt();
    let pose = Pose { position: [5.0, 0.0, 1.0], orientation: [quarter, 0.0, 0.0, quarter] };
    let ship = BodyRecord {
        shapes: vec![Shape::new("hull", Solid::Box { half: [2.0, 1.0, 0.5] }, Pose::default())],
        poses: vec![Pose::default(), pose],
        ..BodyRecord::new("the--ship", "rigid body")
    };
    let point = BodyRecord { poses: vec![Pose::at([1.0, 2.0, 3.0]); 2], ..BodyRecord::new("buoy", "point") };
    FieldRecord {
        times: vec![0.0, 0.1],
        lines: vec![line("a <b> & \"c\"", "N", [3, 3]), line("late", "kN", [0, 2])],
        bodies: vec![ship, point],
        shapes: vec![Shape::new("bed", Solid::Plane, Pose::at([0.0, 0.0, -10.0]))],
        ..FieldRecord::default()
    }
}

#[test]
fn offsets_and_numbers_of_every_file_are_right() {
    let folder = tempfile::tempdir().unwrap();
    vtk::write(&record(), folder.path(), "run & more").unwrap();
    let list = tags(&fs::read_to_string(folder.path().join("run & more.pvd")).unwrap());
    let sets: Vec<_> = list.iter().filter(|(name, _)| name == "DataSet").map(|(_, a)| a).collect();
    assert_eq!(sets.len(), 4);
    for set in &sets {
        assert!(folder.path().join(set["file"].replace("&amp;", "&")).exists(), "{}", set["file"]);
    }
    assert_eq!((sets[2]["timestep"].as_str(), sets[2]["part"].as_str()), ("0.1", "0"));

    let inner = folder.path().join("run & more");
    let (first, piece) = read(&inner.join("00000.vtp"));
    assert_eq!(piece["NumberOfLines"], "1");
    assert_eq!(piece["NumberOfVerts"], "1");
    assert_eq!(first["Lines/offsets"], [3.0]);

    let (second, piece) = read(&inner.join("00001.vtp"));
    let points: usize = piece["NumberOfPoints"].parse().unwrap();
    assert_eq!(points, 3 + 2 + 8 + 1);
    assert_eq!(second["Points/Points"].len(), 3 * points);
    assert_eq!(second["Points/Points"][3..6], [0.1, 1.0 / 3.0, -2.0], "to the last digit");
    assert_eq!(second["Lines/connectivity"], [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(second["Lines/offsets"], [3.0, 5.0]);
    assert_eq!(second["Polys/connectivity"].len(), 3 * 12);
    // points first, then lines, then triangles
    assert_eq!(second["CellData/part"][..3], [3.0, 0.0, 1.0]);
    assert!(second["CellData/part"][3..].iter().all(|part| *part == 2.0));
    let tension = &second["PointData/tension [N]"];
    assert_eq!(tension.len(), points);
    assert_eq!(tension[..3], [100.0, 101.0, 102.0]);
    assert!(tension[3..].iter().all(|x| x.is_nan()));
    assert_eq!(second["PointData/tension [kN]"][3..5], [100.0, 101.0]);
    // a quarter turn about z takes the bow from x to y
    let hull = &second["Points/Points"][15..15 + 24];
    let far = hull.chunks(3).map(|x| x[1]).fold(f64::NEG_INFINITY, f64::max);
    assert!((far - 2.0).abs() < 1e-15);

    let (ground, piece) = read(&inner.join("ground.vtp"));
    assert_eq!(piece["NumberOfPolys"], "2");
    assert!(ground["Points/Points"].chunks(3).all(|x| x[2] == -10.0));
}

#[test]
fn a_record_with_a_hole_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut record = record();
    record.bodies[0].poses.pop();
    assert!(vtk::write(&record, folder.path(), "run").is_err());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
