use super::*;
use crate::builder::Builder;
use crate::spec::RecordSpec;
use ropewalk_core::{
    Assembly, At, Audit, BuildError, Jet, Line, Marker, Model, NodeId, NodeKind, Part, Per, Place, Quantity,
    Related, Relation, RowKind, Sample, Slender, Spot, Term, V3,
};
use std::sync::Arc;

/// A straight line between two points.
struct Straight([NodeId; 2]);

impl Part for Straight {
    fn name(&self) -> &str {
        "line"
    }
    fn kind(&self) -> &'static str {
        "line"
    }
    fn marker(&self, spot: &Spot) -> Result<Marker, String> {
        match spot {
            Spot::Named(n) if n == "end" => Ok(Marker::node(self.0[1])),
            other => Err(format!("no place {other:?}; there is `line.end`")),
        }
    }
    fn dead_load(&self, _: Per, _: V3<f64>) -> Option<Box<dyn Term>> {
        None
    }
    fn point(&self, s: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        let mix = |x: &[f64]| std::array::from_fn(|i| x[i] + 0.5 * s * (x[3 + i] - x[i]));
        (0.0..=2.0).contains(&s).then(|| (mix(at.q), mix(at.v)))
    }
    fn length(&self) -> f64 {
        2.0
    }
    fn place_of(&self, _: NodeId) -> Option<String> {
        None
    }
    fn line(&self) -> Option<&dyn Line> {
        Some(self)
    }
}

impl Line for Straight {
    fn slender(&self) -> Slender {
        Slender { element: 2.0, mass: 0.0, ea: 0.0, ei: 0.0 }
    }
    fn mesh(&self) -> &[f64] {
        &[]
    }
    fn length_now(&self, _: &At<'_>) -> f64 {
        2.0
    }
    fn observe(&self, what: Quantity, s: f64, at: &At<'_>) -> Option<f64> {
        ((0.0..=2.0).contains(&s) && what == Quantity::Tension).then(|| s + at.q[3])
    }
}

/// Holds a point in x and z.
struct Rail;

impl Relation for Rail {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position; 2]
    }
    fn g<S: Jet>(&self, _: S, at: &[Place<S>], g: &mut [S]) {
        (g[0], g[1]) = (at[1].x[0] - at[0].x[0], at[1].x[2] - at[0].x[2]);
    }
}

struct Nothing;

impl Term for Nothing {
    fn label(&self) -> String {
        "nothing".into()
    }
    fn pattern(&self, _: &mut ropewalk_core::Pattern) {}
    fn add(&self, _: &At<'_>, _: &mut Assembly<'_>) {}
}

fn model() -> Model {
    let mut b = Builder::new();
    let ends = [
        b.node(NodeKind::Point, &[0.0; 3], &[0.0; 3]).unwrap(),
        b.node(NodeKind::Point, &[2.0, 0.0, 0.0], &[0.0, 4.0, 0.0]).unwrap(),
    ];
    b.part(Arc::new(Straight(ends))).unwrap();
    b.term(Box::new(Nothing));
    let held = vec![Marker::ground([2.0, 0.0, 0.0]), Marker::node(ends[1])];
    b.constraint(Related::new("rail", Rail, held)).unwrap();
    b.finish().unwrap()
}

fn sampled(spec: &dyn RecordSpec) -> Result<(String, Vec<String>, Vec<f64>), BuildError> {
    let model = model();
    let record = spec.build(&model)?;
    let mut state = model.state();
    state.a[3..].copy_from_slice(&[6.0, 0.0, -8.0]);
    let audit = Audit { kinetic: 3.0, potential: -1.0, supplied: 2.5, ..Audit::default() };
    let mut out = Vec::new();
    record.sample(&Sample { model: &model, at: state.at(), lambda: &[3.0, -4.0], audit: &audit }, &mut out);
    let columns: Vec<String> = record.columns().iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect();
    assert_eq!(columns.len(), out.len());
    Ok((record.name(), columns, out))
}

fn spec(json: &str) -> Box<dyn RecordSpec> {
    serde_json::from_str(json).unwrap_or_else(|e| panic!("{json}: {e}"))
}

#[test]
fn a_named_place_and_any_arc_length_have_position_velocity_and_acceleration() {
    for (json, name, first, values) in [
        (r#"{"position": {"of": "line.end"}}"#, "line.end", "line.end.x [m]", [2.0, 0.0, 0.0]),
        (r#"{"position": {"of": "line @ 50 cm"}}"#, "line@50cm", "line@50cm.x [m]", [0.5, 0.0, 0.0]),
        (r#"{"velocity": {"of": "line@1"}}"#, "line@1.velocity", "line@1.vx [m/s]", [0.0, 2.0, 0.0]),
        (r#"{"velocity": {"of": "line.end", "name": "tip"}}"#, "tip", "tip.vx [m/s]", [0.0, 4.0, 0.0]),
        (
            r#"{"acceleration": {"of": "line.end"}}"#,
            "line.end.acceleration",
            "line.end.ax [m/s^2]",
            [6.0, 0.0, -8.0],
        ),
        (r#"{"acceleration": {"of": "line@1m", "name": "mid"}}"#, "mid", "mid.ax [m/s^2]", [3.0, 0.0, -4.0]),
    ] {
        let (found, columns, out) = sampled(spec(json).as_ref()).unwrap();
        assert_eq!((found.as_str(), columns[0].as_str(), &out[..]), (name, first, &values[..]));
    }
}

#[test]
fn only_what_depends_on_forces_asks_for_them() {
    let needs = |json: &str| spec(json).build(&model()).unwrap().needs_forces();
    assert!(needs(r#"{"acceleration": {"of": "line.end"}}"#) && needs(r#"{"reaction": {"of": "rail"}}"#));
    assert!(!needs(r#"{"position": {"of": "line.end"}}"#) && !needs(r#"{"energy": {}}"#));
}

#[test]
fn tension_is_observed_at_ends_and_arc_lengths() {
    for (at, name, value) in [
        ("\"end\"", "line.end.tension", 4.0),
        ("\"start\"", "line.start.tension", 2.0),
        ("\"50 cm\"", "line@0.5m.tension", 2.5),
        ("1", "line@1m.tension", 3.0),
    ] {
        let json = format!(r#"{{"along": {{"of": "line", "what": "tension", "at": {at}}}}}"#);
        assert_eq!(
            sampled(spec(&json).as_ref()).unwrap(),
            (name.to_string(), vec![format!("{name} [N]")], vec![value])
        );
    }
}

#[test]
fn a_direction_is_told_by_its_angles() {
    let json =
        r#"{"direction": {"of": "line", "at": ["start", "50 cm"], "degrees": true, "axis": [-1, 0, 1]}}"#;
    let (name, columns, out) = sampled(spec(json).as_ref()).unwrap();
    assert_eq!(name, "line.direction");
    assert_eq!(columns[0], "line.start.declination [deg]");
    assert_eq!(columns[5], "line@0.5m.angle [deg]");
    for (k, angle) in [90.0, 0.0, 135.0, 90.0, 0.0, 135.0].into_iter().enumerate() {
        assert!((out[k] - angle).abs() < 1e-9, "{columns:?} {out:?}");
    }
    for (json, field) in [
        (r#"{"direction": {"of": "line", "axis": [0, 0, 0]}}"#, "axis"),
        (r#"{"direction": {"of": "line", "body": "line"}}"#, "body"),
        (r#"{"direction": {"of": "line", "at": []}}"#, "at"),
        (r#"{"direction": {"of": "line", "at": [9]}}"#, "at"),
    ] {
        assert_eq!(sampled(spec(json).as_ref()).unwrap_err().field.as_deref(), Some(field));
    }
}

#[test]
fn the_reaction_acts_on_the_marker_that_moves() {
    let (name, columns, out) = sampled(spec(r#"{"reaction": {"of": "rail"}}"#).as_ref()).unwrap();
    assert_eq!((name.as_str(), out), ("rail.reaction", vec![-3.0, 0.0, 4.0, 5.0]));
    assert_eq!(columns, ["rail.fx [N]", "rail.fy [N]", "rail.fz [N]", "rail.magnitude [N]"]);
}

#[test]
fn energy_is_that_of_the_audit() {
    let (_, _, out) = sampled(&EnergySpec::default()).unwrap();
    assert_eq!(out, [3.0, -1.0, 2.5, 0.0, -0.5]);
}

#[test]
fn unknown_names_are_answered_with_those_there_are() {
    for (json, field, message) in [
        (r#"{"position": {"of": "hose.end"}}"#, "of", "there is no part `hose`; the parts are `line`"),
        (r#"{"position": {"of": "line.top"}}"#, "of", "there is `line.end`"),
        (r#"{"position": {"of": "line@3"}}"#, "of", "no point at arc length 3 m: it goes from 0 to 2 m"),
        (r#"{"position": {"of": "line@3kg"}}"#, "of", "is a mass"),
        (r#"{"along": {"of": "line", "what": "tension", "at": 9}}"#, "at", "no point at arc length 9 m"),
        (r#"{"along": {"of": "line", "what": "moment", "at": 1}}"#, "what", "is a line, which has no moment"),
        (r#"{"reaction": {"of": "rial"}}"#, "of", "the constraints are `rail`"),
    ] {
        let error = sampled(spec(json).as_ref()).unwrap_err();
        assert_eq!(error.field.as_deref(), Some(field), "{error}");
        assert!(error.message.contains(message), "{error}");
    }
    assert!(serde_json::from_str::<Box<dyn RecordSpec>>(r#"{"energy": {"of": 1}}"#).is_err());
    assert!(serde_json::from_str::<RecordPlace>("\"middle\"").is_err());
}
