//! Where the two markers of a joint are, and how the vectors between them and of their axes change.

use crate::algebra::lane::V3;
use crate::algebra::rotation::{IDENTITY, M3, cross, matrix, product, skew, times, transposed_times};
use crate::model::joint::equation::{Arrow, Equation};
use crate::model::marker::Marker;
use crate::model::node::{Node, NodeKind};
use crate::model::state::At;
use crate::model::twist::{self, Turned, VELOCITIES};
use std::ops::Range;

/// More unknowns than two nodes have.
pub(super) const MOST: usize = 14;

/// Where one marker is.
pub(super) struct End {
    pub kind: Option<NodeKind>,
    /// Its node's first unknown among those of the joint.
    pub start: usize,
    /// First velocity of its node.
    pub v: usize,
    /// Position in space, and on the body.
    pub x: V3<f64>,
    pub point: V3<f64>,
    /// Axes of the marker: on the body, or in space.
    pub axes: M3,
    pub r: M3,
    /// The slope of a cable.
    pub slope: V3<f64>,
    /// How the section of a cable with torsion turns.
    pub section: Option<Turned>,
}

/// A vector now: its value, its change with time at rest, its first and second change along the motion.
pub(super) struct Flow {
    pub value: V3<f64>,
    pub by_t: V3<f64>,
    pub first: V3<f64>,
    pub second: V3<f64>,
}

impl End {
    /// Where a marker is whose node's first unknown is number `start` of the joint.
    pub fn new(marker: &Marker, start: usize, nodes: &[Node], at: &At<'_>) -> End {
        let none = [0.0; 3];
        match *marker {
            Marker::Ground { point, axes } => End {
                kind: None,
                start,
                v: 0,
                x: point,
                point,
                axes,
                r: [none; 3],
                slope: none,
                section: None,
            },
            Marker::Node { node, point, axes } => {
                let n = &nodes[node.0 as usize];
                let q = &at.q[n.coords()];
                let (mut x, mut r, mut slope) = ([q[0], q[1], q[2]], [none; 3], none);
                let mut section = None;
                match n.kind {
                    NodeKind::Frame => r = matrix(&[q[3], q[4], q[5], q[6]]),
                    NodeKind::Slope => slope = [q[3], q[4], q[5]],
                    NodeKind::Twist => {
                        slope = [q[3], q[4], q[5]];
                        r = twist::section(q);
                        section = Some(Turned::new(q));
                    }
                    NodeKind::Scalars(_) | NodeKind::Point => {}
                }
                if matches!(n.kind, NodeKind::Frame | NodeKind::Twist) {
                    let arm = times(&r, &point);
                    (0..3).for_each(|i| x[i] += arm[i]);
                }
                let axes =
                    if matches!(n.kind, NodeKind::Scalars(_)) { [[q[0], q[1], q[2]]; 3] } else { axes };
                End { kind: Some(n.kind), start, v: n.v, x, point, axes, r, slope, section }
            }
        }
    }
    pub fn is_body(&self) -> bool {
        self.kind == Some(NodeKind::Frame)
    }
    /// An axis, on the body or in space, and its change with time.
    fn axis(&self, arrow: &Arrow, t: f64) -> [V3<f64>; 3] {
        match arrow {
            Arrow::Turned { angle, .. } => {
                let m = angle.at(t);
                let ((sin, cos), [e, f, _]) = (m.x[0].sin_cos(), self.axes);
                let (rate, change) = (m.v[0], m.a[0]);
                let mix = |a: f64, b: f64| -> V3<f64> { std::array::from_fn(|i| a * e[i] + b * f[i]) };
                [
                    mix(-sin, cos),
                    mix(-rate * cos, -rate * sin),
                    mix(rate * rate * sin - change * cos, -rate * rate * cos - change * sin),
                ]
            }
            Arrow::Axis { axis, .. } => [self.axes[*axis], [0.0; 3], [0.0; 3]],
            Arrow::Tangent { .. } => [self.axes[2], [0.0; 3], [0.0; 3]],
            Arrow::Between => [[0.0; 3]; 3],
        }
    }
    /// Whether its vectors turn with a rotation.
    fn turns(&self) -> bool {
        self.is_body() || self.section.is_some()
    }
    /// Whether an arrow is its slope.
    fn is_slope(&self, arrow: &Arrow) -> bool {
        match self.kind {
            Some(NodeKind::Slope) => true,
            Some(NodeKind::Twist) => matches!(arrow, Arrow::Tangent { .. }),
            _ => false,
        }
    }
    /// The unknowns that change its point, or the vectors of its axes.
    fn span(&self, of_point: bool) -> Range<usize> {
        let first = if of_point || matches!(self.kind, Some(NodeKind::Scalars(_))) { 0 } else { 3 };
        let last = match self.kind {
            None => first,
            Some(NodeKind::Twist) => VELOCITIES,
            Some(NodeKind::Frame) => 6,
            Some(NodeKind::Slope) if !of_point => 6,
            Some(_) => 3,
        };
        self.start + first..self.start + last
    }
    fn in_space(&self, u: &V3<f64>) -> V3<f64> {
        if self.turns() { times(&self.r, u) } else { *u }
    }
    /// Adds the change of `p·x` by the unknowns.
    fn add_point(&self, p: &V3<f64>, sign: f64, row: &mut [f64]) {
        if self.kind.is_none() {
            return;
        }
        (0..3).for_each(|i| row[self.start + i] += sign * p[i]);
        if self.turns() {
            self.add_turn(&self.point, p, sign, row);
        }
    }
    /// Adds the change of `p·R u` by the rotation.
    fn add_turn(&self, u: &V3<f64>, p: &V3<f64>, sign: f64, row: &mut [f64]) {
        if let Some(section) = &self.section {
            let by = section.slope(&times(&self.r, u), p);
            (0..4).for_each(|i| row[self.start + 3 + i] += sign * by[i]);
            return;
        }
        let turn = cross(u, &transposed_times(&self.r, p));
        (0..3).for_each(|i| row[self.start + 3 + i] += sign * turn[i]);
    }
    /// Adds the change of what [`End::add_turn`] adds, by the rotation; of a cable the symmetric part, see
    /// [`twist`](crate::model::twist).
    pub fn add_turn_twice(&self, u: &V3<f64>, p: &V3<f64>, scale: f64, n: usize, h: &mut [f64]) {
        if let Some(section) = &self.section {
            for (i, row) in section.second(&times(&self.r, u), p).iter().enumerate() {
                for (j, x) in row.iter().enumerate() {
                    h[(self.start + 3 + i) * n + self.start + 3 + j] += scale * x;
                }
            }
            return;
        }
        let k = product(&skew(u), &skew(&transposed_times(&self.r, p)));
        for i in 0..3 {
            for j in 0..3 {
                h[(self.start + 3 + i) * n + self.start + 3 + j] += scale * k[i][j];
            }
        }
    }
    /// Velocity, or second change along the motion, of a vector of the body that changes with time.
    fn turning(&self, at: &At<'_>, [u, du, ddu]: &[V3<f64>; 3]) -> [V3<f64>; 2] {
        if let Some(section) = &self.section {
            let [omega, change] = section.spinning(&at.v[self.v..self.v + 7]);
            let [u, du, ddu] = [u, du, ddu].map(|x| times(&self.r, x));
            let once = cross(&omega, &u);
            let (twice, swing, with) = (cross(&omega, &once), cross(&change, &u), cross(&omega, &du));
            return [
                std::array::from_fn(|i| once[i] + du[i]),
                std::array::from_fn(|i| twice[i] + swing[i] + 2.0 * with[i] + ddu[i]),
            ];
        }
        let omega = [at.v[self.v + 3], at.v[self.v + 4], at.v[self.v + 5]];
        let once = cross(&omega, u);
        let (twice, with) = (cross(&omega, &once), cross(&omega, du));
        [
            times(&self.r, &std::array::from_fn(|i| once[i] + du[i])),
            times(&self.r, &std::array::from_fn(|i| twice[i] + 2.0 * with[i] + ddu[i])),
        ]
    }
}

pub(super) fn value(arrow: &Arrow, ends: &[End; 2], t: f64) -> V3<f64> {
    match arrow {
        Arrow::Between => std::array::from_fn(|i| ends[1].x[i] - ends[0].x[i]),
        Arrow::Axis { of, .. } | Arrow::Tangent { of } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            if end.is_slope(arrow) { end.slope } else { end.in_space(&end.axis(arrow, t)[0]) }
        }
    }
}

/// What the vectors of an equation are now.
pub(super) fn values(equation: &Equation, ends: &[End; 2], t: f64) -> [V3<f64>; 2] {
    equation.arrows().map_or([[0.0; 3]; 2], |arrows| arrows.map(|arrow| value(arrow, ends, t)))
}

/// Adds the change of `p·arrow` by the unknowns.
pub(super) fn add(arrow: &Arrow, ends: &[End; 2], t: f64, p: &V3<f64>, row: &mut [f64]) {
    match arrow {
        Arrow::Between => {
            ends[0].add_point(p, -1.0, row);
            ends[1].add_point(p, 1.0, row);
        }
        Arrow::Axis { of, .. } | Arrow::Tangent { of } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            match end.kind {
                _ if end.is_slope(arrow) => (0..3).for_each(|i| row[end.start + 3 + i] += p[i]),
                Some(NodeKind::Frame | NodeKind::Twist) => {
                    end.add_turn(&end.axis(arrow, t)[0], p, 1.0, row);
                }
                Some(NodeKind::Scalars(_)) => (0..3).for_each(|i| row[end.start + i] += p[i]),
                _ => {}
            }
        }
    }
}

/// Adds the change of what [`add`] adds while `p` stays.
pub(super) fn add_twice(
    arrow: &Arrow,
    ends: &[End; 2],
    t: f64,
    p: &V3<f64>,
    scale: f64,
    n: usize,
    h: &mut [f64],
) {
    match arrow {
        Arrow::Between => {
            for (end, sign) in ends.iter().zip([-scale, scale]) {
                if end.turns() && end.point != [0.0; 3] {
                    end.add_turn_twice(&end.point, p, sign, n, h);
                }
            }
        }
        Arrow::Axis { of, .. } | Arrow::Tangent { of } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            if end.turns() && !end.is_slope(arrow) {
                end.add_turn_twice(&end.axis(arrow, t)[0], p, scale, n, h);
            }
        }
    }
}

/// The first derivatives of a vector: row by component, nought but for the unknowns in `spans`.
pub(super) struct Derivatives {
    pub rows: [[f64; MOST]; 3],
    pub spans: [Range<usize>; 2],
}

impl Derivatives {
    /// Adds `l ∂a/∂q_i·∂b/∂q_j`, and its transpose, to the matrix of `n` unknowns.
    pub fn add_product(&self, other: &Derivatives, l: f64, n: usize, h: &mut [f64]) {
        for i in self.spans.iter().cloned().flatten() {
            let a = [0, 1, 2].map(|c| l * self.rows[c][i]);
            for j in other.spans.iter().cloned().flatten() {
                let x = a[0] * other.rows[0][j] + a[1] * other.rows[1][j] + a[2] * other.rows[2][j];
                h[i * n + j] += x;
                h[j * n + i] += x;
            }
        }
    }
}

pub(super) fn derivatives(arrow: &Arrow, ends: &[End; 2], t: f64) -> Derivatives {
    let mut rows = [[0.0; MOST]; 3];
    for (i, row) in rows.iter_mut().enumerate() {
        add(arrow, ends, t, &IDENTITY[i], row);
    }
    let spans = match arrow {
        Arrow::Between => [ends[0].span(true), ends[1].span(true)],
        Arrow::Axis { of, .. } | Arrow::Tangent { of } | Arrow::Turned { of, .. } => {
            [ends[*of].span(false), 0..0]
        }
    };
    Derivatives { rows, spans }
}

pub(super) fn flow(arrow: &Arrow, ends: &[End; 2], at: &At<'_>) -> Flow {
    let none = [0.0; 3];
    match arrow {
        Arrow::Between => {
            let mut f = Flow { value: value(arrow, ends, at.t), by_t: none, first: none, second: none };
            for (end, sign) in ends.iter().zip([-1.0, 1.0]) {
                if end.kind.is_none() {
                    continue;
                }
                (0..3).for_each(|i| f.first[i] += sign * at.v[end.v + i]);
                if end.turns() {
                    let [first, second] = end.turning(at, &[end.point, none, none]);
                    for i in 0..3 {
                        f.first[i] += sign * first[i];
                        f.second[i] += sign * second[i];
                    }
                }
            }
            f
        }
        Arrow::Axis { of, .. } | Arrow::Tangent { of } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            let axis = end.axis(arrow, at.t);
            match end.kind {
                Some(NodeKind::Frame | NodeKind::Twist) if !end.is_slope(arrow) => {
                    let [first, second] = end.turning(at, &axis);
                    let value = times(&end.r, &axis[0]);
                    Flow { value, by_t: times(&end.r, &axis[1]), first, second }
                }
                Some(kind) => {
                    let v = end.v + if kind.has_slope() { 3 } else { 0 };
                    let first = [at.v[v], at.v[v + 1], at.v[v + 2]];
                    Flow { value: value(arrow, ends, at.t), by_t: none, first, second: none }
                }
                None => Flow { value: axis[0], by_t: axis[1], first: axis[1], second: axis[2] },
            }
        }
    }
}
