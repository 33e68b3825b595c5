//! Rigid bodies that move as vessels do: as their responses to waves say, or a table of six motions over time.

use crate::motion::csv::{self, Wanted};
use crate::pair::{kind as kind_of, pair};
use ropewalk_core::error::not_negative;
use ropewalk_core::reach::Knots;
use ropewalk_core::{
    BuildError, EndSlope, Interpolation, Jet, Join, Model, Motion, Moving, NodeKind, Place, Related,
    Relation, RowKind, V3, lift, reach,
};
use ropewalk_scene::quantity::{self, kind};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, RaoSpec, register_spec};
use ropewalk_sea::{MOTIONS, VesselResponse};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Moves a rigid body as a vessel, in all six degrees of freedom: by its responses to the waves of the scene (`rao`), or by a table
/// of its motions over time (`file`).
///
/// The marker is the vessel's reference point, and the body starts at rest as it lies in still water: let the waves rise (`ramp`). Surge, sway and heave are
/// along the axes of the mean heading (x ahead, y to port, z up), then yaw, pitch (bow down) and roll (port up) turn it: `R = Rz(heading +
/// yaw) Ry(pitch) Rx(roll)`. The reaction is what it takes to move it. What is fastened to the body's points moves along.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VesselSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// Reference point, on a rigid body.
    pub marker: MarkerRef,
    /// Heading, from x to y [rad].
    #[serde(default, deserialize_with = "quantity::angle")]
    pub heading: f64,
    /// Responses to waves; the scene needs `[water.waves]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rao: Option<RaoSpec>,
    /// CSV file with the columns `t`, and any of `surge`, `sway`, `heave` (in m), `roll`, `pitch`, `yaw` (in rad unless their
    /// headings say deg): joined by cubic splines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Time from t = 0 in which the motions of a `file` grow from nothing, as `(1 - cos πt/ramp)/2` [s]. Responses to waves grow
    /// with the waves.
    #[serde(default, deserialize_with = "quantity::time")]
    pub ramp: f64,
}
register_spec!(Constraint, "vessel", VesselSpec);

/// Six motions over time, each with its first and second derivative.
type Six = [[f64; 3]; MOTIONS];

/// Where the six motions come from.
enum Source {
    /// With the shortest and the mean period of the waves [s].
    Waves {
        response: VesselResponse,
        periods: [f64; 2],
    },
    Table {
        curves: Vec<Interpolation>,
        knots: Vec<Knots>,
        range: (f64, f64),
        ramp: f64,
    },
}

impl Source {
    fn at(&self, t: f64) -> Six {
        match self {
            Source::Waves { response, .. } => response.at(t),
            Source::Table { curves, range, ramp, .. } => std::array::from_fn(|k| {
                let [_, x, v, a] = curves[k].at(t.clamp(range.0, range.1));
                risen(*ramp, t, [x, v, a])
            }),
        }
    }
}

/// A motion that grows from nothing.
fn risen(ramp: f64, t: f64, [x, v, a]: [f64; 3]) -> [f64; 3] {
    if t >= ramp {
        return [x, v, a];
    }
    let (w, (sin, cos)) = (PI / ramp, (PI * t.max(0.0) / ramp).sin_cos());
    let (r, dr, ddr) = (0.5 * (1.0 - cos), 0.5 * w * sin, 0.5 * w * w * cos);
    [r * x, r * v + dr * x, r * a + 2.0 * dr * v + ddr * x]
}

/// The motions of a vessel about where it lies in still water.
struct Course {
    place: V3<f64>,
    heading: f64,
    source: Source,
    /// The motions that were asked for last.
    latest: Mutex<(f64, Six)>,
}

impl Course {
    fn six(&self, t: f64) -> Six {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        if latest.0 != t {
            *latest = (t, self.source.at(t));
        }
        latest.1
    }

    /// Place of the reference point, and the three axes, over any carrier of the time.
    fn pose<S: Jet>(&self, t: S) -> (V3<S>, [V3<S>; 3]) {
        let [surge, sway, heave, roll, pitch, yaw] = self.six(t.re()).map(|x| lift(t, x));
        let (sin, cos) = self.heading.sin_cos();
        let x = [
            surge * cos - sway * sin + self.place[0],
            surge * sin + sway * cos + self.place[1],
            heave + self.place[2],
        ];
        let yaw = yaw + self.heading;
        let ([sr, cr], [sp, cp], [sy, cy]) =
            ([roll.sin(), roll.cos()], [pitch.sin(), pitch.cos()], [yaw.sin(), yaw.cos()]);
        let axes = [
            [cy * cp, sy * cp, -sp],
            [cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr],
            [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr],
        ];
        (x, axes)
    }
}

impl fmt::Debug for Course {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Course")
            .field("place", &self.place)
            .field("heading", &self.heading)
            .finish_non_exhaustive()
    }
}

/// The motion of the reference point.
impl Motion for Course {
    fn at(&self, t: f64) -> Moving {
        let six = self.six(t);
        let (sin, cos) = self.heading.sin_cos();
        let turned =
            |k: usize| [six[0][k] * cos - six[1][k] * sin, six[0][k] * sin + six[1][k] * cos, six[2][k]];
        Moving { x: turned(0), v: turned(1), a: turned(2) }
    }
    fn range(&self) -> (f64, f64) {
        match &self.source {
            Source::Waves { .. } => (f64::NEG_INFINITY, f64::INFINITY),
            Source::Table { range, .. } => *range,
        }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(match &self.source {
            Source::Waves { periods: [shortest, _], .. } => reach::period(*shortest, h),
            Source::Table { knots, ramp, .. } => {
                knots.iter().fold(reach::rise(0.0, *ramp, t, h), |h, knots| knots.reach(t, h))
            }
        })
    }
    fn period(&self, t: f64) -> f64 {
        match &self.source {
            Source::Waves { periods: [_, mean], .. } => *mean,
            Source::Table { knots, .. } => {
                knots.iter().map(|knots| knots.period(t)).fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// A body is where a course leads it: three coordinates, and three right angles between axes.
struct Steered(Arc<Course>);

impl Relation for Steered {
    fn rows(&self) -> Vec<RowKind> {
        [[RowKind::Position; 3], [RowKind::Direction; 3]].concat()
    }
    fn follows(&self) -> Option<&dyn Motion> {
        Some(self.0.as_ref())
    }
    fn turned(&self, from: f64, to: f64) -> f64 {
        let [before, after] = [self.0.six(from), self.0.six(to)];
        (3..6).map(|i| (after[i][0] - before[i][0]).abs()).sum()
    }
    fn g<S: Jet>(&self, t: S, at: &[Place<S>], g: &mut [S]) {
        let (x, axes) = self.0.pose(t);
        for i in 0..3 {
            g[i] = at[0].x[i] - x[i];
            // each axis with the next one, as of a weld
            let (a, b) = (&at[0].axes[i], &axes[(i + 1) % 3]);
            g[3 + i] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        }
    }
}

impl VesselSpec {
    fn source(&self, b: &Builder, place: &V3<f64>) -> Result<Source, BuildError> {
        match (&self.rao, &self.file) {
            (Some(_), None) if self.ramp != 0.0 => {
                let message = "responses grow with the waves: give [water.waves] the `ramp`";
                Err(BuildError::at("ramp", message))
            }
            (Some(rao), None) => {
                let responses = rao.motions("rao")?;
                let sea = b.water().ok().and_then(|water| water.sea.clone()).ok_or_else(|| {
                    let message =
                        "responses are to waves, and the scene has none: add [water.waves], or take a `file`";
                    BuildError::at("rao", message)
                })?;
                let waves = sea.waves();
                let response = VesselResponse::new(waves, &responses, [place[0], place[1]], self.heading);
                Ok(Source::Waves { response, periods: sea.periods() })
            }
            (None, Some(file)) => {
                let ramp = not_negative("ramp", self.ramp)?;
                table(file, ramp).map_err(|e| BuildError::at("file", e))
            }
            (Some(_), Some(_)) => Err(BuildError::at("file", "give either a `rao` or a `file`")),
            (None, None) => Err(BuildError::new("a vessel needs a `rao`, or a `file` of its motions")),
        }
    }
}

/// Six motions out of a CSV file.
fn table(path: &str, ramp: f64) -> Result<Source, String> {
    let length = |name| Wanted { name, kind: &kind::LENGTH, needed: false };
    let angle = |name| Wanted { name, kind: &kind::ANGLE, needed: false };
    let wanted = [
        Wanted { name: "t", kind: &kind::TIME, needed: true },
        length("surge"),
        length("sway"),
        length("heave"),
        angle("roll"),
        angle("pitch"),
        angle("yaw"),
    ];
    let csv::Columns { rows, lines, .. } =
        csv::columns(path, wanted, "t [s],surge [m],heave [m],pitch [deg]")?;
    let Some(last) = rows.last().filter(|_| rows.len() > 1) else {
        return Err(format!("{path}: a vessel's motion needs two rows at least"));
    };
    if let Some(k) = (1..rows.len()).find(|&k| !(rows[k][0] > rows[k - 1][0])) {
        return Err(format!("{path}, line {}: times must ascend", lines[k]));
    }
    let t: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let curve = |k: usize| {
        let values: Vec<f64> = rows.iter().map(|row| row[k + 1]).collect();
        // at rest before the first row, unless it grows from nothing anyway
        let start = if ramp > 0.0 { EndSlope::Smooth } else { EndSlope::Given(0.0) };
        Interpolation::new(&t, &values, Join::Cubic, [start, EndSlope::Smooth])
    };
    let curves: Vec<Interpolation> = (0..MOTIONS).map(curve).collect();
    let knots = curves.iter().map(|curve| Knots::halfway(&t, |t| [curve.at(t)[1], 0.0, 0.0])).collect();
    Ok(Source::Table { curves, knots, range: (t[0], last[0]), ramp })
}

#[typetag::serde(name = "vessel")]
impl ConstraintSpec for VesselSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn responses(&self) -> Option<&RaoSpec> {
        self.rao.as_ref()
    }
    fn notes(&self, _: &Model) -> Vec<String> {
        let long = self.rao.as_ref().and_then(RaoSpec::long_motions);
        long.into_iter().map(|text| format!("`{}` {text}", self.name)).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = pair(b, &self.marker, None)?[1];
        if kind_of(b, &marker) != Some(NodeKind::Frame) {
            let message = format!("a vessel is a rigid body, and {} isn't on one", self.marker);
            return Err(BuildError::at("marker", message));
        }
        let place = b.place(&marker).x;
        let source = self.source(b, &place)?;
        let (sin, cos) = self.heading.sin_cos();
        let axes = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let marker = marker.with_axes(b.nodes(), b.coordinates(), axes);
        let latest = Mutex::new((f64::NAN, [[0.0; 3]; MOTIONS]));
        let course = Arc::new(Course { place, heading: self.heading, source, latest });
        let range = course.range();
        b.constraint(Related::new(&self.name, Steered(course), vec![marker]).within(range))
    }
}
