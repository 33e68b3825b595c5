//! The inertia of a fluid that flows through a cable.

use super::Bore;
use crate::signals::rate;
use crate::time::TimeFunction;
use ropewalk_core::held::three;
use ropewalk_core::{
    Assembly, At, BuildError, ContactSpan, Energy, Part, Pattern, Power, Shows, Signal, SpanLine, Term,
    Timed, V3, Weights, dot,
};

/// Number of coordinates of an element: position and slope of its two nodes.
const N: usize = 12;

/// An element of the cable: where position and slope of its nodes stand, and its matrices.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub q: [usize; 2],
    pub v: [usize; 2],
    pub length: f64,
    /// `∫ S'ᵀS' ds` by the rule of the cable's axial strain.
    stretch: [[f64; 4]; 4],
}

/// The flow through a cable.
///
/// Its matrices are constant: `m M v̇ + m u (D - Dᵀ) v + (m u̇ D - m u² S) q` for each element, with the consistent mass `M`,
/// `D = ∫ SᵀS'` and `S = ∫ S'ᵀS'`, and the thrust at the ends. `S` is integrated as the cable integrates its axial strain,
/// so that tension and `m u²` balance at every point.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalFlow {
    /// Mass of the fluid per unstretched length `m` [kg/m].
    pub mass: f64,
    /// Speed relative to the wall `u` [m/s], towards the end of the cable.
    pub speed: Signal,
    /// A factor of that speed.
    pub time: TimeFunction,
    /// Acceleration of gravity that the fluid's weight comes of [m/s²].
    pub gravity: V3<f64>,
    /// By how much the jet is faster than the flow: the area of the bore over that of a nozzle at the outlet.
    pub nozzle: f64,
    /// Whether the outlet leads into the inlet, so that nothing enters or leaves.
    pub closed: bool,
    /// Whether it counts as steady however its speed changes: where an equilibrium is looked for.
    pub steady: bool,
    /// What pressures follow from, if they are to be known. They move nothing.
    pub bore: Option<Bore>,
    label: String,
    pub(super) part: String,
    pub(super) pieces: Vec<Piece>,
}

/// `∫ SᵀS'` of an element of length `l`.
fn convection(l: f64) -> [[f64; 4]; 4] {
    let rows = [
        [-30.0, 6.0 * l, 30.0, -6.0 * l],
        [-6.0 * l, 0.0, 6.0 * l, -l * l],
        [-30.0, -6.0 * l, 30.0, 6.0 * l],
        [6.0 * l, l * l, -6.0 * l, 0.0],
    ];
    rows.map(|row| row.map(|x| x / 60.0))
}

/// `∫ SᵀS` of an element of length `l`.
fn inertia(l: f64) -> [[f64; 4]; 4] {
    let rows = [
        [156.0, 22.0 * l, 54.0, -13.0 * l],
        [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        [54.0, 13.0 * l, 156.0, -22.0 * l],
        [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
    ];
    rows.map(|row| row.map(|x| x * l / 420.0))
}

/// The shape functions and their first two derivatives by the arc length, at a share `x` of an element of length `l`.
pub(super) fn shapes(x: f64, l: f64) -> [[f64; 4]; 3] {
    let (y, bow) = (1.0 - x, 6.0 * x * (1.0 - x) / l);
    let bend = (6.0 - 12.0 * x) / (l * l);
    [
        [y * y * (1.0 + 2.0 * x), l * x * y * y, x * x * (3.0 - 2.0 * x), -l * x * x * y],
        [-bow, 1.0 - 4.0 * x + 3.0 * x * x, bow, x * (3.0 * x - 2.0)],
        [-bend, (6.0 * x - 4.0) / l, bend, (6.0 * x - 2.0) / l],
    ]
}

/// `∫ S'ᵀS'` by a rule on [0, 1], or exactly by three points of Gauss where there is none.
fn stretch(l: f64, rule: &[[f64; 2]]) -> [[f64; 4]; 4] {
    let root = 0.5 * 0.6_f64.sqrt();
    let gauss = [[0.5 - root, 5.0 / 18.0], [0.5, 4.0 / 9.0], [0.5 + root, 5.0 / 18.0]];
    let rule = if rule.is_empty() { &gauss } else { rule };
    let mut all = [[0.0; 4]; 4];
    for [x, weight] in rule {
        let [_, s, _] = shapes(*x, l);
        for i in 0..4 {
            for j in 0..4 {
                all[i][j] += l * weight * s[i] * s[j];
            }
        }
    }
    all
}

impl InternalFlow {
    /// Mass `mass` [kg/m] that flows through a cable at `speed` [m/s], without weight, from end to end.
    ///
    /// # Errors
    /// A part that isn't a cable, or one whose length changes.
    pub fn new(part: &dyn Part, mass: f64, speed: Signal) -> Result<Self, BuildError> {
        let name = part.name();
        let Some(line) = part.line() else {
            return Err(BuildError::new(format!("`{name}` isn't a cable, and nothing flows through it")));
        };
        if (0..2).any(|end| line.boundary(end).is_some()) {
            let message =
                format!("the length of `{name}` changes: a flow needs a cable whose ends don't feed");
            return Err(BuildError::new(message));
        }
        let rule = line.axial_rule();
        let piece = |span: &ContactSpan| match span.line {
            SpanLine::Cubic { q, v, l } => {
                Some(Piece { q: [q[0], q[2]], v: [v[0], v[2]], length: l, stretch: stretch(l, &rule) })
            }
            _ => None,
        };
        let pieces: Vec<Piece> = part.contact_spans().iter().filter_map(piece).collect();
        if pieces.is_empty() {
            return Err(BuildError::new(format!("`{name}` isn't a cable, and nothing flows through it")));
        }
        Ok(InternalFlow {
            mass,
            speed,
            time: TimeFunction::Constant,
            gravity: [0.0; 3],
            nozzle: 1.0,
            closed: false,
            steady: false,
            bore: None,
            part: name.to_string(),
            label: format!("{name}: internal flow"),
            pieces,
        })
    }

    /// Speed and its rate.
    pub(super) fn flow(&self, t: f64) -> [f64; 2] {
        let (u, f) = (self.speed.at(t), self.time.at(t));
        let faster = || rate(&self.speed, t) * f + u * self.time.rate(t);
        [u * f, if self.steady { 0.0 } else { faster() }]
    }

    /// Weights of `v̇`, `v` and `q` in the residual of an element, each times the identity of space.
    fn matrices(&self, piece: &Piece, [u, du]: [f64; 2]) -> [[[f64; 4]; 4]; 3] {
        let (m, d) = (inertia(piece.length), convection(piece.length));
        let of = |f: &dyn Fn(usize, usize) -> f64| {
            std::array::from_fn(|i| std::array::from_fn(|j| self.mass * f(i, j)))
        };
        let coriolis = of(&|i, j| u * (d[i][j] - d[j][i]));
        let centrifugal = of(&|i, j| du * d[i][j] - u * u * piece.stretch[i][j]);
        [of(&|i, j| m[i][j]), coriolis, centrifugal]
    }

    /// The ends through which fluid passes, those of two sections that are joined too: piece, node, sign of the thrust, and the
    /// jet's speed over that of the flow.
    fn ends(&self, u: f64) -> impl Iterator<Item = (usize, usize, f64, f64)> {
        let last = self.pieces.len() - 1;
        // the nozzle is where the fluid leaves
        let [first, outlet] = if u >= 0.0 { [1.0, self.nozzle] } else { [self.nozzle, 1.0] };
        let outer =
            [(0, 0, -1.0, first), (last, 1, 1.0, outlet)].into_iter().take(if self.closed { 0 } else { 2 });
        let joined = (0..last).filter(|&k| self.pieces[k].q[1] != self.pieces[k + 1].q[0]);
        outer.chain(joined.flat_map(|k| [(k, 1, 1.0, 1.0), (k + 1, 0, -1.0, 1.0)]))
    }
}

/// Velocity of the jet that leaves at a slope `p`, and how it changes with it: `u p`, or `u j p/|p|` out of a nozzle.
fn jet(u: f64, nozzle: f64, p: &V3<f64>) -> (V3<f64>, [V3<f64>; 3]) {
    let plain = nozzle == 1.0;
    let stretch = dot(p, p).sqrt();
    let k = if plain { u } else { u * nozzle / stretch };
    let by = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let one = if i == j { k } else { 0.0 };
            if plain { one } else { one - k * p[i] * p[j] / (stretch * stretch) }
        })
    });
    (p.map(|x| k * x), by)
}

/// The four vectors of an element: position and slope of both nodes.
pub(super) fn nodal(x: &[f64], at: [usize; 2]) -> [V3<f64>; 4] {
    [three(x, at[0]), three(x, at[0] + 3), three(x, at[1]), three(x, at[1] + 3)]
}

/// Weight per unit load of an element.
fn shares(l: f64) -> [f64; 4] {
    [0.5 * l, l * l / 12.0, 0.5 * l, -l * l / 12.0]
}

impl Term for InternalFlow {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn acts(&self) -> Option<&'static str> {
        Some("internal flow")
    }
    fn pattern(&self, p: &mut Pattern) {
        for Piece { v: [a, b], .. } in &self.pieces {
            p.clique((*a..a + 6).chain(*b..b + 6));
        }
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let flow = self.flow(at.t);
        let wants = out.wants_tangent();
        let Weights { q: wq, v: wv, a: wa } = out.weights();
        for (k, piece) in self.pieces.iter().enumerate() {
            let [mass, coriolis, centrifugal] = self.matrices(piece, flow);
            let (a, v, q) = (nodal(at.a, piece.v), nodal(at.v, piece.v), nodal(at.q, piece.q));
            let weight = shares(piece.length);
            for i in 0..4 {
                let row = piece.v[i / 2] + 3 * (i % 2);
                for c in 0..3 {
                    let mut r = -self.mass * weight[i] * self.gravity[c];
                    for j in 0..4 {
                        r += mass[i][j] * a[j][c] + coriolis[i][j] * v[j][c] + centrifugal[i][j] * q[j][c];
                    }
                    out.add(row + c, r);
                }
            }
            if wants {
                out.add_block(k, N, |i, j| {
                    if i % 3 != j % 3 {
                        return 0.0;
                    }
                    let (i, j) = (i / 3, j / 3);
                    wa * mass[i][j] + wv * coriolis[i][j] + wq * centrifugal[i][j]
                });
            }
        }
        let u = flow[0];
        for (k, node, sign, nozzle) in self.ends(u) {
            let Piece { q, v, .. } = &self.pieces[k];
            let (q, v) = (q[node], v[node]);
            let (leaves, by) = jet(u, nozzle, &three(at.q, q + 3));
            let thrust = sign * self.mass * u;
            let velocity = three(at.v, v);
            (0..3).for_each(|c| out.add(v + c, thrust * (velocity[c] + leaves[c])));
            if wants {
                let first = 6 * node;
                out.add_block(k, N, |i, j| match (i.wrapping_sub(first), j.wrapping_sub(first)) {
                    (i @ 0..3, j @ 0..3) if i == j => wv * thrust,
                    (i @ 0..3, j @ 3..6) => wq * thrust * by[i][j - 3],
                    _ => 0.0,
                });
            }
        }
    }
    /// `½ m ∫ ṙ²` and the potential `-½ m u² ∫ (r'² - 1)` of the centrifugal forces, with that of the weight.
    fn energy(&self, at: &At<'_>) -> Energy {
        let [u, _] = self.flow(at.t);
        let mut energy = Energy::default();
        for piece in &self.pieces {
            let (v, q) = (nodal(at.v, piece.v), nodal(at.q, piece.q));
            let (m, l) = (inertia(piece.length), piece.length);
            let over = |a: &[[f64; 4]; 4], x: &[V3<f64>; 4]| {
                let row = |i: usize| (0..4).map(|j| a[i][j] * dot(&x[i], &x[j])).sum::<f64>();
                (0..4).map(row).sum::<f64>()
            };
            energy.kinetic += 0.5 * self.mass * over(&m, &v);
            let weight: f64 = shares(l).iter().zip(&q).map(|(w, x)| w * dot(&self.gravity, x)).sum();
            energy.potential -= self.mass * (0.5 * u * u * (over(&piece.stretch, &q) - l) + weight);
        }
        energy
    }
    /// What the fluid brings in and carries away, and what its pump does where the flow changes.
    fn power(&self, at: &At<'_>) -> Power {
        let [u, du] = self.flow(at.t);
        let mut supplied = 0.0;
        for (k, node, sign, nozzle) in self.ends(u) {
            let Piece { q, v, .. } = &self.pieces[k];
            let velocity = three(at.v, v[node]);
            let (leaves, _) = jet(u, nozzle, &three(at.q, q[node] + 3));
            supplied -= sign * self.mass * u * (dot(&velocity, &velocity) + dot(&leaves, &velocity));
        }
        if du != 0.0 {
            for piece in &self.pieces {
                let (v, q) = (nodal(at.v, piece.v), nodal(at.q, piece.q));
                let d = convection(piece.length);
                for i in 0..4 {
                    for j in 0..4 {
                        let stretched = u * piece.stretch[i][j] * dot(&q[i], &q[j]);
                        supplied -= self.mass * du * (d[i][j] * dot(&v[i], &q[j]) + stretched);
                    }
                }
                supplied += self.mass * du * u * piece.length;
            }
        }
        Power { supplied, ..Power::default() }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        self.bore.as_ref().map(|_| self as &dyn Shows)
    }
    fn timed(&self) -> Option<&dyn Timed> {
        if self.time.changes() || !self.speed.is_constant() { Some(self) } else { None }
    }
}

impl Timed for InternalFlow {
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.speed.reach(t, self.time.reach(t, h)))
    }
    fn period(&self, _t: f64) -> f64 {
        self.time.period()
    }
}
