//! Stress at points round the section of a cable.

use crate::wall::Wall;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::rotation::cross;
use ropewalk_core::{At, BuildError, Column, Model, Quantity, Record, Sample, V3, dot, scaled};
use ropewalk_scene::records::{RecordPlace, check_places, named, part};
use ropewalk_scene::{RecordSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Axial stress at points round the section of a pipe or cable, `σ = T_w/A + M c/I`: columns `riser.stress@50%.0deg`, `.45deg`, … in Pa, for
/// fatigue too.
///
/// The wall's tension is that of `wall_tension` where something presses on it, else the tension. Angles count from a direction that
/// is carried along the line from its start without twist (parallel transport), towards the right hand about the tangent: of a cable without
/// torsion the section knows no other; of a cable with torsion (`section.gj`) they count from the first director of its section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StressSpec {
    /// The cable.
    pub of: String,
    /// Outer diameter of what carries [m].
    #[serde(deserialize_with = "quantity::length")]
    pub diameter: f64,
    /// Its inner diameter [m]. Default: it is solid.
    #[serde(default, deserialize_with = "quantity::length")]
    pub inner_diameter: f64,
    /// Number of points round the section.
    #[serde(default = "eight")]
    pub points: usize,
    /// Direction in space from which angles count at the start of the line, without its part along the tangent. Default: z, or x where the
    /// line starts upright.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<V3<f64>>,
    /// Where: as for `along`. Default: in the middle.
    #[serde(default = "middle")]
    pub at: Vec<RecordPlace>,
    /// Name in results. Default: that of the cable and `.stress`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "stress", StressSpec);

fn eight() -> usize {
    8
}

fn middle() -> Vec<RecordPlace> {
    vec![RecordPlace::Share(0.5)]
}

struct Stress {
    wall: Wall,
    at: Vec<RecordPlace>,
    /// Area [m²], and radius over second moment of area [1/m³].
    area: f64,
    per_moment: f64,
    points: usize,
    reference: V3<f64>,
    name: String,
    title: String,
}

/// Points between which a direction is carried along.
const STATIONS: usize = 200;
/// Parts of an element over which differences find its curvature: exact for cubics.
const NEAR: f64 = 1e-2;

impl Stress {
    /// Unit tangent and curvature vector [1/m] at an arc length.
    fn bent(&self, s: f64, at: &At<'_>) -> Option<(V3<f64>, V3<f64>)> {
        let part = self.wall.part.as_ref();
        let length = part.length_now(at);
        // within one element, whatever side of a node
        let mesh = part.line()?.mesh_now(at);
        let after = mesh.partition_point(|x| *x <= s).clamp(1, mesh.len().max(2) - 1);
        let (a, b) =
            (mesh.get(after - 1).copied().unwrap_or(0.0), mesh.get(after).copied().unwrap_or(length));
        let step = NEAR * (b - a);
        let s = s.clamp(a + step, b - step);
        let [before, here, behind] = [s - step, s, s + step].map(|s| part.point(s, at).map(|(x, _)| x));
        let (before, here, behind) = (before?, here?, behind?);
        let slope: V3<f64> = std::array::from_fn(|i| (behind[i] - before[i]) / (2.0 * step));
        let second: V3<f64> =
            std::array::from_fn(|i| (behind[i] - 2.0 * here[i] + before[i]) / (step * step));
        let square = dot(&slope, &slope);
        let along = dot(&second, &slope) / square;
        let t = scaled(1.0 / square.sqrt(), &slope);
        Some((t, std::array::from_fn(|i| (second[i] - along * slope[i]) / square)))
    }

    /// The direction from which angles count at an arc length, carried along by double reflection (Wang and others, *ACM Trans.
    /// Graphics* 27, 2008).
    fn carried(&self, s: f64, at: &At<'_>) -> Option<V3<f64>> {
        let part = self.wall.part.as_ref();
        let place = |k: usize| s * k as f64 / STATIONS as f64;
        let (mut t, _) = self.bent(0.0, at)?;
        let mut r = self.reference;
        let along = dot(&r, &t);
        (0..3).for_each(|i| r[i] -= along * t[i]);
        let mut x = part.point(0.0, at)?.0;
        for k in 1..=STATIONS {
            let (next, there) = (part.point(place(k), at)?.0, self.bent(place(k), at)?.0);
            let way: V3<f64> = std::array::from_fn(|i| next[i] - x[i]);
            let square = dot(&way, &way);
            if square > 0.0 {
                let reflect = |v: &V3<f64>, way: &V3<f64>, square: f64| -> V3<f64> {
                    let twice = 2.0 * dot(v, way) / square;
                    std::array::from_fn(|i| v[i] - twice * way[i])
                };
                let (once, turned) = (reflect(&r, &way, square), reflect(&t, &way, square));
                let left: V3<f64> = std::array::from_fn(|i| there[i] - turned[i]);
                let rest = dot(&left, &left);
                r = if rest > 0.0 { reflect(&once, &left, rest) } else { once };
            }
            (x, t) = (next, there);
        }
        let along = dot(&r, &t);
        (0..3).for_each(|i| r[i] -= along * t[i]);
        Some(scaled(1.0 / dot(&r, &r).sqrt(), &r))
    }

    /// Bending stress at the directions 0 and 90 degrees [Pa].
    fn bending(&self, s: f64, at: &At<'_>) -> Option<[f64; 2]> {
        let part = self.wall.part.as_ref();
        let observe = |what| part.observe(what, s, at);
        if let (Some(about_first), Some(about_second)) =
            (observe(Quantity::MomentNormal), observe(Quantity::MomentAcross))
        {
            // a moment about the second director pulls at the first
            return Some([about_second, -about_first].map(|m| -m * self.per_moment));
        }
        let (t, curvature) = self.bent(s, at)?;
        let size = dot(&curvature, &curvature).sqrt();
        if size == 0.0 {
            return Some([0.0; 2]);
        }
        let moment = observe(Quantity::Moment)?;
        let first = self.carried(s, at)?;
        let second = cross(&t, &first);
        // fibres away from the centre of curvature are pulled
        Some([first, second].map(|d| -moment * self.per_moment * dot(&curvature, &d) / size))
    }
}

impl Record for Stress {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let angle = |k: usize| 360.0 * k as f64 / self.points as f64;
        let round = |at: &RecordPlace| {
            let name = format!("{}{at}", self.name);
            (0..self.points).map(move |k| Column::new(format!("{name}.{}deg", angle(k).round()), "Pa"))
        };
        self.at.iter().flat_map(round).collect()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        for place in &self.at {
            let at = place.now(self.wall.part.as_ref(), &s.at);
            let axial = self.wall.tension(at, s.model, &s.at) / self.area;
            let [first, second] = self.bending(at, &s.at).unwrap_or([f64::NAN; 2]);
            out.extend((0..self.points).map(|k| {
                let (sin, cos) = (TAU * k as f64 / self.points as f64).sin_cos();
                axial + first * cos + second * sin
            }));
        }
    }
}

#[typetag::serde(name = "stress")]
impl RecordSpec for StressSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let (outer, inner) =
            (positive("diameter", self.diameter)?, not_negative("inner_diameter", self.inner_diameter)?);
        if inner >= outer {
            let message = format!("`inner_diameter` {inner} m must be less than `diameter` {outer} m");
            return Err(BuildError::at("inner_diameter", message));
        }
        if !(1..=360).contains(&self.points) {
            return Err(BuildError::at(
                "points",
                format!("`points` must be from 1 to 360, not {}", self.points),
            ));
        }
        let state = model.state();
        if part.observe(Quantity::Moment, 0.0, &state.at()).is_none() {
            let message = format!("`{}` is a {}, which has no bending moment", part.name(), part.kind());
            return Err(BuildError::at("of", message));
        }
        check_places(part.as_ref(), &self.at)?;
        let area = PI / 4.0 * (outer * outer - inner * inner);
        let second = PI / 64.0 * (outer.powi(4) - inner.powi(4));
        let name = named(&self.name, || format!("{}.stress", part.name()));
        let title = named(&self.title, || format!("Stress round {}", part.name()));
        let mut stress = Stress {
            wall: Wall::new(model, part),
            at: self.at.clone(),
            area,
            per_moment: 0.5 * outer / second,
            points: self.points,
            reference: [0.0, 0.0, 1.0],
            name,
            title,
        };
        let start = stress.bent(0.0, &state.at()).map_or([0.0; 3], |(t, _)| t);
        stress.reference = match self.reference {
            Some(d) => d,
            None if start[2].abs() < 0.99 => [0.0, 0.0, 1.0],
            None => [1.0, 0.0, 0.0],
        };
        let side = cross(&stress.reference, &start);
        if !(dot(&side, &side) > 1e-6 * dot(&stress.reference, &stress.reference)) {
            let message = "`reference` lies along the line where it starts: give a direction across";
            return Err(BuildError::at("reference", message));
        }
        Ok(Box::new(stress))
    }
}
