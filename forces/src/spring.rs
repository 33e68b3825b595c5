//! A spring and damper between two points.

use crate::signals::{change, least, rate, reach};
use ropewalk_core::error::{need, not_negative};
use ropewalk_core::held::{Held, Pull as Pair, delta, dofs, pull};
use ropewalk_core::{
    Assembly, At, BuildError, Column, Energy, Marker, Node, Pattern, Power, Shows, Signal, Term, Timed, V3,
    dot,
};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A spring with a damper along the line between two markers: `F = k (l - l0) + c dl/dt`, a pull if positive.
///
/// Use it for: moorings, fenders, soft attachments. With `tension_only` it goes slack below its rest length and never
/// pushes, as a rope does. Markers may be on cable nodes, points, rigid bodies, and the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// A name, such as `mooring`.
    pub label: String,
    /// Stiffness `k` [N/m].
    pub stiffness: Signal,
    /// Damping `c` [N s/m].
    pub damping: Signal,
    /// Rest length `l0` [m].
    pub rest_length: Signal,
    /// Whether it only pulls.
    pub tension_only: bool,
    ends: [Held; 2],
}

/// What a spring does at a state.
struct Pull {
    /// Unit vector from the first end to the second, and the relative velocity.
    e: V3<f64>,
    w: V3<f64>,
    length: f64,
    /// Rate of the length, force, and its elastic part.
    rate: f64,
    force: f64,
    elastic: f64,
    /// Whether it resists at all.
    taut: bool,
}

impl Spring {
    /// An undamped spring between two markers; set the other fields afterwards.
    ///
    /// # Errors
    /// Both ends on the ground or on the same node; negative or infinite numbers.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        between: [Marker; 2],
        stiffness: impl Into<Signal>,
        rest_length: impl Into<Signal>,
    ) -> Result<Self, BuildError> {
        let (label, stiffness, rest_length) = (label.into(), stiffness.into(), rest_length.into());
        not_negative(&format!("{label}: stiffness"), stiffness.at(0.0))?;
        not_negative(&format!("{label}: rest length"), rest_length.at(0.0))?;
        let [a, b] = &between;
        need(a.on() != b.on(), || {
            format!("{label}: its ends must be on two different nodes, or one on the ground")
        })?;
        let ends = [Held::new(nodes, a, &label)?, Held::new(nodes, b, &label)?];
        Ok(Spring { label, stiffness, damping: 0.0.into(), rest_length, tension_only: false, ends })
    }

    /// The force now [N], positive if it pulls.
    pub fn force(&self, at: &At<'_>) -> f64 {
        self.pull(at).force
    }

    fn signals(&self) -> [&Signal; 3] {
        [&self.stiffness, &self.damping, &self.rest_length]
    }

    /// Power of whoever changes stiffness and rest length: the rate of the strain energy at a fixed length [W].
    fn supplied(&self, t: f64, p: &Pull) -> f64 {
        let rate = |s: &Signal| rate(s, t);
        let stretch = p.length - self.rest_length.at(t);
        if self.tension_only && stretch <= 0.0 {
            return 0.0;
        }
        0.5 * rate(&self.stiffness) * stretch * stretch
            - self.stiffness.at(t) * stretch * rate(&self.rest_length)
    }

    fn pull(&self, at: &At<'_>) -> Pull {
        let [a, b] = &self.ends;
        let between = |x: V3<f64>, y: V3<f64>| -> V3<f64> { std::array::from_fn(|i| y[i] - x[i]) };
        let (d, w) = (between(a.x(at), b.x(at)), between(a.velocity(at), b.velocity(at)));
        let length = dot(&d, &d).sqrt();
        // without length there is no direction, and no force
        let e = if length > 0.0 { d.map(|d| d / length) } else { [0.0; 3] };
        let rate = dot(&e, &w);
        let (stiffness, damping) = (self.stiffness.at(at.t), self.damping.at(at.t));
        let rest_length = self.rest_length.at(at.t);
        let elastic = stiffness * (length - rest_length);
        let force = elastic + damping * rate;
        if self.tension_only && (length <= rest_length || force <= 0.0) {
            return Pull { e, w, length, rate, force: 0.0, elastic: elastic.max(0.0), taut: false };
        }
        Pull { e, w, length, rate, force, elastic, taut: true }
    }
}

impl Term for Spring {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("spring")
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(dofs(&self.ends));
    }
    fn symmetric(&self) -> bool {
        matches!(self.damping, Signal::Constant(0.0))
            && !self.ends.iter().any(|e| matches!(e, Held::Beside { .. }))
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let p = self.pull(at);
        let mut both = Pair { f: p.e.map(|e| -p.force * e), ..Pair::default() };
        if out.wants_tangent() && p.taut {
            // F/l, which has a limit where both go to zero together
            let (stiffness, damping) = (self.stiffness.at(at.t), self.damping.at(at.t));
            let turn = match (p.length > 0.0, self.rest_length.at(at.t) == 0.0) {
                (true, _) => p.force / p.length,
                (false, true) => stiffness,
                (false, false) => 0.0,
            };
            let inverse = if p.length > 0.0 { 1.0 / p.length } else { 0.0 };
            for i in 0..3 {
                for j in 0..3 {
                    let ee = p.e[i] * p.e[j];
                    let sway = damping * p.e[i] * (p.w[j] - p.rate * p.e[j]) * inverse;
                    both.by_x[i][j] = -(stiffness * ee + turn * (delta(i, j) - ee) + sway);
                    both.by_v[i][j] = -damping * ee;
                }
            }
        }
        pull(&self.ends, at, &both, 0, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let p = self.pull(at);
        let stretch = p.length - self.rest_length.at(at.t);
        let slack = self.tension_only && stretch <= 0.0;
        let potential = if slack { 0.0 } else { 0.5 * self.stiffness.at(at.t) * stretch * stretch };
        Energy { potential, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let p = self.pull(at);
        Power {
            dissipated: (p.force - p.elastic) * p.rate,
            supplied: self.supplied(at.t, &p),
            ..Power::default()
        }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if change(self.signals().into_iter()) { Some(self) } else { None }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Timed for Spring {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(reach(self.signals().into_iter(), t, h))
    }
}

impl Shows for Spring {
    fn columns(&self) -> Vec<Column> {
        vec![Column::new("tension", "N")]
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.push(self.force(at));
    }
}

/// A spring and damper between two markers, along the line between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringSpec {
    /// Name.
    pub name: String,
    /// One end.
    pub marker: MarkerRef,
    /// The other end: a marker or a point in space.
    pub to: MarkerRef,
    /// Stiffness [N/m].
    #[serde(deserialize_with = "quantity::setting::spring_stiffness")]
    pub stiffness: Setting,
    /// Damping [N s/m].
    #[serde(default, deserialize_with = "quantity::setting::damping")]
    pub damping: Setting,
    /// Length without force [m]. Default: the initial length.
    #[serde(default, deserialize_with = "quantity::setting::optional::length")]
    pub length: Option<Setting>,
    /// Whether it can only pull.
    #[serde(default)]
    pub tension_only: bool,
}
register_spec!(Force, "spring", SpringSpec);

#[typetag::serde(name = "spring")]
impl ForceSpec for SpringSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker, &self.to]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let stiffness = b.signal("stiffness", &self.stiffness, &kind::SPRING_STIFFNESS)?;
        let damping = b.signal("damping", &self.damping, &kind::DAMPING)?;
        not_negative("stiffness", least(&stiffness))?;
        not_negative("damping", least(&damping))?;
        let ends = [b.marker("marker", &self.marker)?, b.marker("to", &self.to)?];
        let [a, c] = [b.place(&ends[0]).x, b.place(&ends[1]).x];
        let start = (0..3).map(|i| (c[i] - a[i]).powi(2)).sum::<f64>().sqrt();
        b.reaches(start);
        let length = match &self.length {
            Some(length) => b.signal("length", length, &kind::LENGTH)?,
            None => Signal::Constant(start),
        };
        not_negative("length", least(&length))?;
        let mut spring = Spring::new(&self.name, b.nodes(), ends, stiffness, length)?;
        spring.damping = damping;
        spring.tension_only = self.tension_only;
        b.term(Box::new(spring));
        Ok(())
    }
}
