//! How a cable is held at a wheel: it wraps it, touches it at a point, or is off.
//!
//! All three are six equations between the end of the span before, the start of the span behind and the wheel, so that the
//! equations of a run keep their structure while the cable lifts off and comes back. Between the two ends there is an arc
//! as long as the cable wraps the wheel; then a straight piece, as long as the chord of the least wrap.
//!
//! | | wraps | touches | off |
//! | --- | --- | --- | --- |
//! | in the groove | both ends | both ends | |
//! | at the radius | both ends | both ends | |
//! | tangent | both ends | the piece lies between them alike | the piece is nearest to the axis in its middle |
//! | chord | | is given | is given |
//! | slopes | | | both along the piece |
//!
//! The piece that is off stays opposite to the wheel while the cable runs on: material goes through it. So it is the place
//! that meets the wheel again.

use super::tangent::{self, Tangency};
use ropewalk_core::rotation::{along, cross};
use ropewalk_core::{At, Constraint, Jet, Marker, Node, NodeId, Place, Related, Relation, RowKind, V3};

/// The least wrap [rad]: below it the arc is a straight piece.
pub(super) const LEAST_WRAP: f64 = 0.01;

/// Length of the straight piece on a wheel of this radius [m].
pub(super) fn chord(radius: f64) -> f64 {
    2.0 * radius * (0.5 * LEAST_WRAP).sin()
}

/// How a cable is held at a wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// It lies on an arc.
    Wraps,
    /// It touches the wheel at a point, over which it may have a kink.
    Touches,
    /// It is off the wheel.
    Off,
}

impl Mode {
    /// By the internal variable that has it.
    pub fn of(internal: &[f64], variable: usize) -> Self {
        match internal.get(variable) {
            Some(x) if *x == 1.0 => Mode::Touches,
            Some(x) if *x == 2.0 => Mode::Off,
            _ => Mode::Wraps,
        }
    }

    /// The value of that variable.
    pub fn value(self) -> f64 {
        f64::from(self as u8)
    }
}

fn unit<S: Jet>(a: &V3<S>) -> V3<S> {
    let size = along(a, a).sqrt();
    a.map(|x| x / size)
}

/// From the centre of the wheel to a place: along its axis, and the part across it.
fn across<S: Jet>(wheel: &Place<S>, x: &V3<S>) -> (S, V3<S>) {
    let (axis, d) = (&wheel.axes[2], std::array::from_fn(|i| x[i] - wheel.x[i]));
    let beside = along(axis, &d);
    (beside, std::array::from_fn(|i| d[i] - axis[i] * beside))
}

const KINDS: [RowKind; 6] = [
    RowKind::Position,
    RowKind::Position,
    RowKind::Direction,
    RowKind::Position,
    RowKind::Position,
    RowKind::Direction,
];

/// A straight piece that touches a wheel of this radius [m] with both of its ends.
struct Touch(f64);

impl Relation for Touch {
    fn rows(&self) -> Vec<RowKind> {
        KINDS.to_vec()
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let mut lean = S::zero();
        for (k, end) in at[..2].iter().enumerate() {
            let (beside, d) = across(&at[2], &end.x);
            g[3 * k] = beside;
            g[3 * k + 1] = along(&d, &d).sqrt() - self.0;
            lean += along(&d, &end.axes[0]);
        }
        g[2] = lean / self.0;
        g[5] = (apart(at) - chord(self.0)) / self.0;
    }
}

fn apart<S: Jet>(at: &[Place<S>]) -> S {
    let c: V3<S> = std::array::from_fn(|i| at[1].x[i] - at[0].x[i]);
    along(&c, &c).sqrt()
}

/// A straight piece of cable beside a wheel of this radius [m], nearest to its axis in the middle.
struct Off(f64);

impl Relation for Off {
    fn rows(&self) -> Vec<RowKind> {
        KINDS.to_vec()
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let axis = &at[2].axes[2];
        let c: V3<S> = std::array::from_fn(|i| at[1].x[i] - at[0].x[i]);
        let middle = std::array::from_fn(|i| (at[1].x[i] + at[0].x[i]) * 0.5);
        let [t, other] = [0, 1].map(|k| unit(&at[k].axes[0]));
        let inwards = cross(axis, &t);
        let lean = along(axis, &t);
        let beside = std::array::from_fn(|i| axis[i] - t[i] * lean);
        g[0] = along(&c, &beside);
        g[1] = along(&across(&at[2], &middle).1, &t);
        g[2] = along(&other, &beside);
        g[3] = along(&c, &inwards);
        g[4] = along(&other, &inwards) * self.0;
        g[5] = (apart(at) - chord(self.0)) / self.0;
    }
}

/// One of the ways in which a cable is held: constraints on the ends, and which of the columns theirs are.
struct Way(Vec<(Box<dyn Constraint>, Vec<usize>)>);

/// The six equations of a cable at a wheel.
pub struct Hold {
    name: String,
    /// Place of the internal variable with its [`Mode`].
    mode: usize,
    ways: [Way; 3],
    markers: [Marker; 3],
    nodes: Vec<NodeId>,
    ends: [NodeId; 2],
    width: usize,
}

/// Most velocities that it touches: two nodes of cables that can be twisted and a body.
const MOST: usize = 20;

impl Hold {
    /// Of the end of the span before and the start of the span behind at a wheel of this radius [m], by the mode in an
    /// internal variable.
    pub fn new(
        name: impl Into<String>,
        all: &[Node],
        ends: [NodeId; 2],
        wheel: Marker,
        radius: f64,
        mode: usize,
    ) -> Self {
        let name = name.into();
        let markers = [tangent::end(all, ends[0]), tangent::end(all, ends[1]), wheel];
        let mut nodes: Vec<NodeId> = markers.iter().filter_map(Marker::on).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let size = |k: &NodeId| all[k.0 as usize].kind.velocities();
        let first = |k: &NodeId| nodes.iter().take_while(|n| *n != k).map(size).sum::<usize>();
        let columns = |c: &dyn Constraint| {
            c.nodes().iter().flat_map(|k| first(k)..first(k) + size(k)).collect::<Vec<_>>()
        };
        let way = |own: Vec<Box<dyn Constraint>>| {
            Way(own
                .into_iter()
                .map(|c| {
                    let columns = columns(c.as_ref());
                    (c, columns)
                })
                .collect())
        };
        let tangent = |end: usize| -> Box<dyn Constraint> {
            Box::new(Tangency::new(name.clone(), ends[end], wheel, radius))
        };
        let ways = [
            way(vec![tangent(0), tangent(1)]),
            way(vec![Box::new(Related::new(name.clone(), Touch(radius), markers.to_vec()))]),
            way(vec![Box::new(Related::new(name.clone(), Off(radius), markers.to_vec()))]),
        ];
        let width = nodes.iter().map(size).sum();
        Hold { name, mode, ways, markers, nodes, ends, width }
    }

    /// The constraints that hold now, with the first of their rows, their number, and their columns.
    fn now(&self, at: &At<'_>) -> impl Iterator<Item = (&dyn Constraint, usize, &[usize])> {
        let way = &self.ways[Mode::of(at.internal, self.mode) as usize];
        let rows = if way.0.len() == 2 { 3 } else { 6 };
        way.0.iter().enumerate().map(move |(k, (c, columns))| (c.as_ref(), k * rows, &columns[..]))
    }
}

impl Constraint for Hold {
    fn name(&self) -> &str {
        &self.name
    }
    fn rows(&self) -> &[RowKind] {
        &KINDS
    }
    fn markers(&self) -> &[Marker] {
        &self.markers
    }
    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }
    fn told_by(&self) -> Option<&str> {
        Some("`axle_force` of a record of type `sheave`")
    }
    fn behind(&self) -> &[NodeId] {
        &self.ends
    }
    fn linear(&self) -> bool {
        false
    }
    fn is_steady(&self) -> bool {
        true
    }
    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        let mut own = [0.0; 6 * MOST];
        jac.fill(0.0);
        for (c, first, columns) in self.now(at) {
            let (n, rows) = (columns.len(), c.rows().len());
            c.jacobian(nodes, at, &mut g[first..first + rows], &mut own[..n * rows]);
            for (r, row) in own[..n * rows].chunks_exact(n).enumerate() {
                let to = &mut jac[(first + r) * self.width..][..self.width];
                columns.iter().zip(row).for_each(|(&j, x)| to[j] = *x);
            }
        }
    }
    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]) {
        let mut own = [0.0; MOST * MOST];
        h.fill(0.0);
        for (c, first, columns) in self.now(at) {
            let n = columns.len();
            c.geometric(nodes, at, &lambda[first..first + c.rows().len()], &mut own[..n * n]);
            for (row, &i) in own[..n * n].chunks_exact(n).zip(columns) {
                columns.iter().zip(row).for_each(|(&j, x)| h[i * self.width + j] += x);
            }
        }
    }
    fn rates(&self, nodes: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        for (c, first, _) in self.now(at) {
            let rows = first..first + c.rows().len();
            c.rates(nodes, at, &mut rate[rows.clone()], &mut bias[rows]);
        }
    }
}
