//! The data of a page: a JSON text that names arrays, and the arrays.

use serde::Serialize;
use serde_json::{Value, json};

use super::{Page, RangeGraph, Steps, pack, panel};
use crate::{BodyRecord, FieldRecord, ForceRecord, LineRecord, Pose, Shape, Solid, Wave, Waves};
use std::f64::consts::TAU;

/// Version of the format, for a page that is older than its data.
const VERSION: u32 = 1;

/// Where an array is and how it is stored.
#[derive(Serialize)]
struct Array {
    /// First byte, counted from the end of the JSON text.
    at: usize,
    rows: usize,
    columns: usize,
    /// See [`pack::rows`].
    code: u8,
    /// What is added to every number: histories of time are stored from their start.
    #[serde(skip_serializing_if = "is_zero")]
    from: f64,
}

fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

#[derive(Default)]
struct Arrays {
    bytes: Vec<u8>,
}

impl Arrays {
    /// Rows of numbers, less `from`.
    fn add(&mut self, values: impl Iterator<Item = f64>, columns: usize, from: f64) -> Array {
        // what single precision can't hold is a gap, not an infinity
        let single = |x: f64| {
            let x = (x - from) as f32;
            if x.is_finite() { x } else { f32::NAN }
        };
        let values: Vec<f32> = values.map(single).collect();
        let at = self.bytes.len();
        let columns = columns.max(1);
        let code = pack::rows(&values, columns, &mut self.bytes);
        Array { at, rows: values.len() / columns, columns, code, from }
    }

    fn series(&mut self, values: &[f64]) -> Array {
        self.add(values.iter().copied(), 1, 0.0)
    }

    /// Times, whose steps matter and not how late they are.
    fn times(&mut self, values: &[f64]) -> Array {
        let from = values.first().copied().filter(|t| t.is_finite()).unwrap_or(0.0);
        self.add(values.iter().copied(), 1, from)
    }
}

/// The data of a page, deflated; `thinned` says what was left out of it.
pub(super) fn deflated(page: &Page, thinned: &[String]) -> Vec<u8> {
    let mut arrays = Arrays::default();
    let columns = &page.history.columns;
    let axis = columns.first().map_or(("t", "s"), |c| (c.name.as_str(), c.unit.as_str()));
    let history: Vec<Value> = columns
        .iter()
        .enumerate()
        .map(|(k, c)| {
            let values = if k == 0 { arrays.times(&c.values) } else { arrays.series(&c.values) };
            json!({"name": c.name, "unit": c.unit, "values": values})
        })
        .collect();
    let text = json!({
        "version": VERSION,
        "title": page.title,
        "subtitle": page.subtitle,
        "status": page.status,
        "scene": page.scene,
        "summary": page.summary,
        "warnings": page.warnings,
        "notes": page.notes,
        "events": page.events,
        "settings": page.settings,
        "energy": page.energy,
        "sections": page.sections,
        "listings": page.listings,
        "ranges": page.ranges.iter().map(|r| range(&mut arrays, r)).collect::<Vec<_>>(),
        "axis": {"name": axis.0, "unit": axis.1},
        "history": history,
        "panels": panel::drawn(columns, &page.panels),
        "steps": page.steps.as_ref().map(|s| steps(&mut arrays, s)),
        "restarts": page.restarts,
        "field": field(&mut arrays, &page.field),
        "thinned": thinned,
    })
    .to_string();
    let mut bytes = Vec::with_capacity(4 + text.len() + arrays.bytes.len());
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(arrays.bytes);
    pack::deflated(&bytes)
}

fn field(arrays: &mut Arrays, record: &FieldRecord) -> Value {
    let bounds = record.bounds().unwrap_or_default();
    // places are stored from near the middle of the path, so that far from the origin they are as fine as near it
    let origin = [0, 1, 2].map(|i| (0.5 * (bounds[0][i] + bounds[1][i])).round());
    json!({
        "origin": origin,
        "times": arrays.times(&record.times),
        "lines": record.lines.iter().map(|l| line(arrays, l, &origin)).collect::<Vec<_>>(),
        "bodies": record.bodies.iter().map(|b| body(arrays, b, &origin)).collect::<Vec<_>>(),
        "forces": record.forces.iter().map(|f| force(arrays, f, &origin)).collect::<Vec<_>>(),
        "shapes": record.shapes.iter().map(|s| shape(arrays, s, &origin)).collect::<Vec<_>>(),
        "water": record.water,
        "waves": record.waves.as_ref().map(|w| waves(arrays, w, &origin)),
        "bed": record.bed,
    })
}

/// Rows of amplitude, wavenumbers, frequency and phase, that of the field's origin.
fn waves(arrays: &mut Arrays, waves: &Waves, origin: &[f64; 3]) -> Value {
    let row = |w: &Wave| {
        let phase = (w.k[0] * origin[0] + w.k[1] * origin[1] + w.phase).rem_euclid(TAU);
        [w.amplitude, w.k[0], w.k[1], w.omega, phase]
    };
    json!({"ramp": waves.ramp, "all": arrays.add(waves.all.iter().flat_map(row), 5, 0.0)})
}

fn range(arrays: &mut Arrays, range: &RangeGraph) -> Value {
    let mut text =
        json!({"name": range.name, "quantity": range.quantity, "unit": range.unit, "window": range.window});
    let columns = [
        ("s", &range.s),
        ("start", &range.start),
        ("least", &range.least),
        ("mean", &range.mean),
        ("greatest", &range.greatest),
        ("deviation", &range.deviation),
        ("t_least", &range.t_least),
        ("t_greatest", &range.t_greatest),
    ];
    for (name, values) in columns {
        text[name] = json!(arrays.series(values));
    }
    text
}

/// A line whose points are always as many has a row for each snapshot, else a row for each point.
fn line(arrays: &mut Arrays, line: &LineRecord, origin: &[f64; 3]) -> Value {
    let counts: Vec<usize> = line.snapshots.iter().map(|s| s.position.len()).collect();
    let count = counts.first().copied().unwrap_or(0);
    let steady = counts.iter().all(|c| *c == count);
    let width = if steady { count } else { 1 };
    let first = line.snapshots.first();
    let same_s = steady && line.snapshots.iter().all(|s| Some(&s.s) == first.map(|f| &f.s));
    let s = if same_s {
        arrays.add(first.into_iter().flat_map(|s| s.s.iter().copied()), count, 0.0)
    } else {
        arrays.add(line.snapshots.iter().flat_map(|s| s.s.iter().copied()), width, 0.0)
    };
    let near = |x: &[f64; 3]| [0, 1, 2].map(|i| x[i] - origin[i]);
    let position = line.snapshots.iter().flat_map(|s| s.position.iter().flat_map(near));
    let position = arrays.add(position, 3 * width, 0.0);
    let quantities: Vec<Value> = line
        .quantities
        .iter()
        .enumerate()
        .map(|(k, q)| {
            let values = line.snapshots.iter().flat_map(|s| s.values[k].iter().copied());
            json!({"name": q.name, "unit": q.unit, "values": arrays.add(values, width, 0.0)})
        })
        .collect();
    json!({
        "name": line.name,
        "kind": line.kind,
        "place": line.place,
        "diameter": line.diameter,
        "counts": if steady { json!(count) } else { json!(counts) },
        "s": s,
        "position": position,
        "quantities": quantities,
    })
}

fn body(arrays: &mut Arrays, body: &BodyRecord, origin: &[f64; 3]) -> Value {
    let position = body.poses.iter().flat_map(|p| [0, 1, 2].map(|i| p.position[i] - origin[i]));
    let position = arrays.add(position, 3, 0.0);
    json!({
        "name": body.name,
        "kind": body.kind,
        "place": body.place,
        "shapes": body.shapes.iter().map(|s| shape(arrays, s, &[0.0; 3])).collect::<Vec<_>>(),
        "position": position,
        "orientation": arrays.add(body.poses.iter().flat_map(|p| p.orientation), 4, 0.0),
    })
}

fn force(arrays: &mut Arrays, force: &ForceRecord, origin: &[f64; 3]) -> Value {
    let points = force.points.iter().flat_map(|x| [0, 1, 2].map(|i| x[i] - origin[i]));
    json!({
        "name": force.name,
        "kind": force.kind(),
        "position": arrays.add(points, 3, 0.0),
        "force": arrays.add(force.forces.iter().flatten().copied(), 3, 0.0),
    })
}

fn steps(arrays: &mut Arrays, steps: &Steps) -> Value {
    json!({
        "t": arrays.times(&steps.t),
        "least": arrays.series(&steps.least),
        "greatest": arrays.series(&steps.greatest),
        "cause": arrays.add(steps.cause.iter().map(|k| *k as f64), 1, 0.0),
        "causes": steps.causes,
        "counts": steps.counts,
    })
}

/// Infinite lengths become null.
fn shape(arrays: &mut Arrays, shape: &Shape, origin: &[f64; 3]) -> Value {
    let solid = match &shape.solid {
        Solid::Mesh(mesh) => json!({
            "type": "mesh",
            "points": arrays.add(mesh.points.iter().flatten().copied(), 3, 0.0),
            "triangles": arrays.add(mesh.triangles.iter().flatten().map(|k| f64::from(*k)), 3, 0.0),
        }),
        solid => json!(solid),
    };
    let position = [0, 1, 2].map(|i| shape.pose.position[i] - origin[i]);
    json!({"name": shape.name, "solid": solid, "pose": Pose { position, ..shape.pose }})
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::{Column, Event, LineSnapshot, Listing, Mesh, Quantity, Table};
    use std::io::Read;

    /// The JSON text and the arrays of a page's data, as the page reads them.
    pub fn open(data: &str) -> (Value, Vec<u8>) {
        let (packed, mut bytes) = (pack::tests::bytes(data), Vec::new());
        flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        (serde_json::from_slice(&bytes[4..4 + length]).unwrap(), bytes[4 + length..].to_vec())
    }

    /// The numbers of an array.
    pub fn array(arrays: &[u8], of: &Value) -> Vec<f64> {
        let number = |key: &str| of[key].as_u64().unwrap() as usize;
        let (columns, count) = (number("columns"), number("rows") * number("columns"));
        let numbers = pack::tests::numbers(&arrays[number("at")..], count, columns, number("code") as u8);
        numbers.into_iter().map(|x| f64::from(x) + of["from"].as_f64().unwrap_or(0.0)).collect()
    }

    fn page() -> Page {
        let mut history = Table::new([Column::new("end.x", "m"), Column::new("end.tension", "N")]);
        for row in [[1e6, 1.0, f64::NAN], [1e6 + 0.001, 2.5, 1e300], [1e6 + 0.002, -3.0, 4.0]] {
            history.push_row(&row).unwrap();
        }
        let snapshot = |n: usize, t: f64| LineSnapshot {
            s: (0..n).map(|k| k as f64 * 0.5).collect(),
            position: (0..n).map(|k| [500_000.25 + k as f64, t, -0.5]).collect(),
            values: vec![(0..n).map(|k| t * k as f64).collect()],
            ..LineSnapshot::default()
        };
        let line = |name: &str, counts: [usize; 3]| LineRecord {
            quantities: vec![Quantity::new("tension", "N")],
            snapshots: counts.iter().zip([0.0, 1.0, 2.0]).map(|(n, t)| snapshot(*n, t)).collect(),
            ..LineRecord::new(name, "cable", 0.02)
        };
        let mesh =
            Mesh { points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], triangles: vec![[0, 1, 2]] };
        let body = BodyRecord {
            poses: vec![Pose { position: [500_003.0, 2.0, 1.0], orientation: [0.0, 1.0, 0.0, 0.0] }; 3],
            shapes: vec![Shape::new("rock", Solid::Mesh(mesh), Pose::default())],
            ..BodyRecord::new("ship", "rigid body")
        };
        let endless = Solid::Tube { radius: 0.5, half: f64::INFINITY };
        Page {
            title: "A title".into(),
            history,
            steps: Some(Steps {
                t: vec![0.001, 0.002],
                least: vec![1e-4, 2e-4],
                greatest: vec![1e-3; 2],
                cause: vec![1, 0],
                causes: vec!["a".into(), "b".into()],
                counts: vec![3, 7],
            }),
            restarts: vec![0.0, 1.0],
            events: vec![Event { t: 0.5, text: "it broke".into() }],
            field: FieldRecord {
                times: vec![0.0, 1.0, 2.0],
                lines: vec![line("steady", [4, 4, 4]), line("growing", [0, 2, 3])],
                bodies: vec![body],
                forces: vec![ForceRecord {
                    name: "drag: steady".into(),
                    points: vec![[500_001.0, 0.0, 0.5]; 3],
                    forces: vec![[0.0, -2.5, 1e4]; 3],
                }],
                shapes: vec![Shape::new("hole", endless, Pose::at([0.0, 0.0, 2.0]))],
                water: Some(0.0),
                waves: Some(Waves {
                    all: vec![Wave { amplitude: 1.5, k: [0.5, -0.25], omega: 2.0, phase: 0.25 }],
                    ramp: 20.0,
                }),
                bed: None,
            },
            listings: vec![Listing {
                title: "Statistics".into(),
                headings: vec!["record".into(), "mean".into()],
                rows: vec![vec!["end.x [m]".into(), "1.5".into()]],
                note: "from 5 s on".into(),
            }],
            ranges: vec![RangeGraph {
                name: "steady".into(),
                quantity: "tension".into(),
                unit: "N".into(),
                window: [5.0, 20.0],
                s: vec![0.0, 1.0],
                least: vec![1.0, 2.0],
                greatest: vec![4.0, f64::NAN],
                ..RangeGraph::default()
            }],
            ..Page::default()
        }
    }

    #[test]
    fn the_block_gives_back_the_numbers() {
        let page = page();
        let data = pack::base64(&deflated(&page, &["half of it".into()]));
        let (text, arrays) = open(&data);
        let get = |of: &Value| array(&arrays, of);
        assert_eq!(text["thinned"][0], "half of it");
        assert_eq!(text["events"][0]["t"], 0.5);
        assert_eq!(text["field"]["bed"], Value::Null);
        let t = get(&text["history"][0]["values"]);
        assert!((t[1] - 1e6 - 0.001).abs() < 1e-9, "a late time is as fine as an early one");
        assert_eq!(get(&text["history"][1]["values"]), [1.0, 2.5, -3.0]);
        let tension = get(&text["history"][2]["values"]);
        assert!(tension[0].is_nan() && tension[1].is_nan() && tension[2] == 4.0);
        let origin = [0, 1, 2].map(|i| text["field"]["origin"][i].as_f64().unwrap());
        for (k, line) in page.field.lines.iter().enumerate() {
            let stored = &text["field"]["lines"][k];
            let x: Vec<f64> =
                line.snapshots.iter().flat_map(|s| s.position.iter().flatten().copied()).collect();
            let back = get(&stored["position"]);
            assert_eq!(back.len(), x.len());
            assert!(back.iter().zip(&x).enumerate().all(|(i, (b, x))| b + origin[i % 3] == *x));
            let values: Vec<f64> = line.snapshots.iter().flat_map(|s| s.values[0].clone()).collect();
            assert_eq!(get(&stored["quantities"][0]["values"]), values);
        }
        assert_eq!(text["field"]["lines"][0]["counts"], 4);
        assert_eq!(get(&text["field"]["lines"][0]["s"]), [0.0, 0.5, 1.0, 1.5]);
        assert_eq!(text["field"]["lines"][1]["counts"], json!([0, 2, 3]));
        assert_eq!(get(&text["field"]["lines"][1]["s"]), [0.0, 0.5, 0.0, 0.5, 1.0]);
        let ship = &text["field"]["bodies"][0];
        assert_eq!(get(&ship["orientation"])[4..8], [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(get(&ship["shapes"][0]["solid"]["triangles"]), [0.0, 1.0, 2.0]);
        let drag = &text["field"]["forces"][0];
        assert_eq!(drag["kind"], "drag");
        assert_eq!(get(&drag["force"])[..3], [0.0, -2.5, 1e4]);
        assert_eq!(get(&drag["position"])[0] + origin[0], 500_001.0);
        assert_eq!(get(&text["steps"]["cause"]), [1.0, 0.0]);
        assert_eq!((&text["steps"]["counts"], &text["restarts"]), (&json!([3, 7]), &json!([0.0, 1.0])));
        assert_eq!(text["field"]["shapes"][0]["solid"], json!({"type": "tube", "radius": 0.5, "half": null}));
        assert_eq!(text["field"]["shapes"][0]["pose"]["position"][0], -origin[0]);
        let sea = get(&text["field"]["waves"]["all"]);
        let phase = (0.5 * origin[0] - 0.25 * origin[1] + 0.25).rem_euclid(TAU);
        assert_eq!(sea[..4], [1.5, 0.5, -0.25, 2.0]);
        assert!((sea[4] - phase).abs() < 1e-6, "waves are counted from the origin of the field");
        assert_eq!(text["listings"][0]["rows"][0][1], "1.5");
        let range = &text["ranges"][0];
        assert_eq!((&range["quantity"], &range["window"]), (&json!("tension"), &json!([5.0, 20.0])));
        assert_eq!(get(&range["least"]), [1.0, 2.0]);
        assert!(get(&range["greatest"])[1].is_nan());
    }

    #[test]
    fn an_empty_page_has_data_too() {
        let (text, arrays) = open(&pack::base64(&deflated(&Page::default(), &[])));
        assert_eq!(text["version"], VERSION);
        assert_eq!(text["axis"]["unit"], "s");
        assert!(array(&arrays, &text["field"]["times"]).is_empty());
    }
}
