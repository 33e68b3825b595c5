//! Joints: equations between the points and axes of two markers, with closed-form
//! Jacobians, geometric stiffness and rates.
//!
//! With `D = x_1 - x_0` and axes `u`, `w` of the markers the equations are `d·D = …` (a coordinate in space),
//! `u·D = …` (a coordinate in a body's axes, "dot-2"), `u·w = …` (an angle, "dot-1") and `|D| = L`. An axis of a body
//! turns with it: `δ(R u) = R (θ × u)`, that of a cable's section with its slope and spin; the "axis" of a cable without
//! torsion is its slope `r'`, whose length doesn't matter to a right angle. Haug, *Computer-Aided Kinematics and Dynamics* (1989), chapter 9, has them all.

mod end;
pub mod equation;

use crate::algebra::lane::{V3, dot};
use crate::algebra::rotation::{M3, cross, matrix, product, skew, times, transposed_times};
use crate::error::{BuildError, finite, need};
use crate::model::constraint::{Constraint, RowKind};
use crate::model::joint::end::{End, MOST, add, add_twice, derivatives, flow, value, values};
use crate::model::joint::equation::{Arrow, Equation};
use crate::model::marker::Marker;
use crate::model::motion::Motion;
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::state::At;
use std::sync::Arc;

/// Equations between two markers, as a constraint.
#[derive(Clone, Debug)]
pub struct Joint {
    name: String,
    equations: Vec<Equation>,
    markers: [Marker; 2],
    nodes: Vec<NodeId>,
    rows: Vec<RowKind>,
    range: (f64, f64),
    linear: bool,
    linear_rows: Vec<bool>,
    /// Whether it only holds two points together, which chains do by the thousand.
    coincide: bool,
}

impl Joint {
    /// Equations between two markers, of which the first may be on the ground.
    ///
    /// # Errors
    /// Both on the ground or on the same node; a node without position; an axis asked of a node that has none.
    pub fn new(
        name: impl Into<String>,
        nodes: &[Node],
        markers: [Marker; 2],
        equations: Vec<Equation>,
    ) -> Result<Self, BuildError> {
        let name = name.into();
        let on: Vec<NodeId> = markers.iter().filter_map(Marker::on).collect();
        for id in &on {
            let node = nodes.get(id.0 as usize);
            let node = node.ok_or_else(|| BuildError::new(format!("{name}: there is no node {}", id.0)))?;
            need(!matches!(node.kind, NodeKind::Scalars(n) if n != 3), || {
                format!("{name}: node {} has no position", id.0)
            })?;
        }
        need(!on.is_empty(), || format!("{name}: holds only fixed points; put one marker on a part"))?;
        need(on.len() < 2 || on[0] != on[1], || {
            format!("{name}: both markers are on the same body or node: there is nothing to join")
        })?;
        for marker in &markers {
            if let Marker::Ground { point, .. } = marker {
                finite(&format!("{name}: point"), point)?;
            }
        }
        let mut range = (f64::NEG_INFINITY, f64::INFINITY);
        for motion in equations.iter().flat_map(Equation::motion) {
            let (a, b) = motion.range();
            range = (range.0.max(a), range.1.min(b));
        }
        let rows = equations.iter().map(Equation::kind).collect();
        // levers on the section of a cable are rare
        let lever = |m: &Marker| match m {
            Marker::Node { node, point, .. } => {
                nodes[node.0 as usize].kind == NodeKind::Twist && *point != [0.0; 3]
            }
            Marker::Ground { .. } => false,
        };
        let coincide = Equation::coincide_only(&equations) && !markers.iter().any(lever);
        let linear_rows = Vec::new();
        let mut c =
            Joint { name, equations, markers, nodes: on, rows, range, linear: false, linear_rows, coincide };
        c.check_axes(nodes)?;
        c.linear_rows = c.equations.iter().map(|e| c.is_linear(nodes, e)).collect();
        c.linear = c.linear_rows.iter().all(|linear| *linear);
        Ok(c)
    }

    fn motions(&self) -> impl Iterator<Item = &Arc<dyn Motion>> {
        self.equations.iter().flat_map(Equation::motion)
    }

    fn kind(&self, nodes: &[Node], of: usize) -> Option<NodeKind> {
        self.markers[of].on().map(|n| nodes[n.0 as usize].kind)
    }

    fn check_axes(&self, nodes: &[Node]) -> Result<(), BuildError> {
        for arrow in self.equations.iter().filter_map(Equation::arrows).flatten() {
            let (of, turned) = match arrow {
                Arrow::Between => continue,
                Arrow::Tangent { of } if self.kind(nodes, *of).is_some_and(NodeKind::has_slope) => continue,
                Arrow::Axis { of, .. } | Arrow::Tangent { of } => (*of, false),
                Arrow::Turned { of, .. } => (*of, true),
            };
            let node = self.markers[of].on().map_or(0, |n| n.0);
            let good = match self.kind(nodes, of) {
                None | Some(NodeKind::Frame | NodeKind::Twist) => true,
                Some(NodeKind::Slope | NodeKind::Scalars(_)) => !turned,
                Some(NodeKind::Point) => false,
            };
            need(good, || {
                format!(
                    "{}: node {node} is {}, which has no axis to hold; hold a rigid body or the end of a cable",
                    self.name,
                    match self.kind(nodes, of) {
                        Some(NodeKind::Slope) => "on a cable without twist",
                        _ => "a point",
                    }
                )
            })?;
        }
        Ok(())
    }

    /// Whether an equation is linear in the increments of its nodes.
    fn is_linear(&self, nodes: &[Node], equation: &Equation) -> bool {
        // 0: constant, 1: linear, 2: neither
        let point = |of: usize| match (self.kind(nodes, of), self.markers[of]) {
            (None, _) => 0,
            (Some(NodeKind::Frame | NodeKind::Twist), Marker::Node { point, .. }) if point != [0.0; 3] => 2,
            _ => 1,
        };
        let degree = |arrow: &Arrow| match arrow {
            Arrow::Between => point(0).max(point(1)),
            Arrow::Axis { of, .. } | Arrow::Tangent { of } | Arrow::Turned { of, .. } => {
                match self.kind(nodes, *of) {
                    None => 0,
                    Some(NodeKind::Twist) if matches!(arrow, Arrow::Tangent { .. }) => 1,
                    Some(NodeKind::Slope | NodeKind::Scalars(_)) => 1,
                    Some(_) => 2,
                }
            }
        };
        match equation {
            Equation::Along { .. } => degree(&Arrow::Between) <= 1,
            Equation::Dot { a, b, .. } => degree(a) + degree(b) <= 1,
            Equation::Distance { .. } => false,
        }
    }

    /// The two points of a joint that only holds them together: sign, first unknown, position, and on a body its
    /// rotation and the arm.
    #[inline(always)]
    fn points(
        &self,
        nodes: &[Node],
        at: &At<'_>,
        mut see: impl FnMut(f64, usize, V3<f64>, Option<(M3, V3<f64>)>),
    ) {
        let mut start = 0;
        for (marker, sign) in self.markers.iter().zip([-1.0, 1.0]) {
            match *marker {
                Marker::Ground { point, .. } => see(sign, usize::MAX, point, None),
                Marker::Node { node, point, .. } => {
                    let n = &nodes[node.0 as usize];
                    let q = &at.q[n.q..];
                    let mut x = [q[0], q[1], q[2]];
                    let mut turning = None;
                    if n.kind == NodeKind::Frame && point != [0.0; 3] {
                        let r = matrix(&[q[3], q[4], q[5], q[6]]);
                        let arm = times(&r, &point);
                        (0..3).for_each(|i| x[i] += arm[i]);
                        turning = Some((r, point));
                    }
                    see(sign, start, x, turning);
                    start += n.kind.velocities();
                }
            }
        }
    }

    /// Where the two markers are. Each is written where it stays: they are large, and every iteration asks for them.
    fn ends(&self, nodes: &[Node], at: &At<'_>) -> [End; 2] {
        let second = self.markers[0].on().map_or(0, |n| nodes[n.0 as usize].kind.velocities());
        [End::new(&self.markers[0], 0, nodes, at), End::new(&self.markers[1], second, nodes, at)]
    }

    fn size(&self, nodes: &[Node]) -> usize {
        self.nodes.iter().map(|n| nodes[n.0 as usize].kind.velocities()).sum()
    }
}

impl Constraint for Joint {
    fn name(&self) -> &str {
        &self.name
    }
    fn rows(&self) -> &[RowKind] {
        &self.rows
    }
    fn markers(&self) -> &[Marker] {
        &self.markers
    }
    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }
    fn linear(&self) -> bool {
        self.linear
    }
    fn linear_row(&self, row: usize) -> bool {
        self.linear_rows[row]
    }
    fn range(&self) -> (f64, f64) {
        self.range
    }
    fn moves(&self) -> bool {
        self.motions().next().is_some()
    }
    fn is_steady(&self) -> bool {
        !self.moves()
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.motions().try_fold(h, |h, m| m.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.motions().fold(f64::INFINITY, |least, m| least.min(m.period(t)))
    }
    fn turned(&self, from: f64, to: f64) -> f64 {
        let arrows = self.equations.iter().filter_map(Equation::arrows).flatten();
        let angles = arrows.filter_map(|arrow| match arrow {
            Arrow::Turned { angle, .. } => Some((angle.at(to).x[0] - angle.at(from).x[0]).abs()),
            _ => None,
        });
        angles.fold(0.0, f64::max)
    }
    fn imposes(&self) -> Option<&dyn Motion> {
        self.equations.iter().find_map(|e| match e {
            Equation::Along { motion, .. } => motion.as_deref(),
            _ => None,
        })
    }

    fn jacobian(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], jac: &mut [f64]) {
        let n = self.size(nodes);
        jac.fill(0.0);
        if self.coincide {
            g.fill(0.0);
            self.points(nodes, at, |sign, start, x, turning| {
                for i in 0..3 {
                    g[i] += sign * x[i];
                    if start == usize::MAX {
                        continue;
                    }
                    let row = &mut jac[i * n + start..(i + 1) * n];
                    row[i] = sign;
                    if let Some((r, arm)) = &turning {
                        let turn = cross(arm, &r[i]);
                        (0..3).for_each(|k| row[3 + k] = sign * turn[k]);
                    }
                }
            });
            return;
        }
        let ends = self.ends(nodes, at);
        let d = value(&Arrow::Between, &ends, at.t);
        for ((equation, g), row) in self.equations.iter().zip(g).zip(jac.chunks_exact_mut(n)) {
            let arrows = values(equation, &ends, at.t);
            *g = equation.violation(&d, &arrows, at.t);
            match equation {
                Equation::Along { direction, .. } => add(&Arrow::Between, &ends, at.t, direction, row),
                Equation::Dot { a, b, .. } => {
                    add(a, &ends, at.t, &arrows[1], row);
                    add(b, &ends, at.t, &arrows[0], row);
                }
                Equation::Distance { .. } => {
                    let size = dot(&d, &d).sqrt();
                    add(&Arrow::Between, &ends, at.t, &d.map(|d| d / size), row);
                }
            }
        }
    }

    fn violation(&self, nodes: &[Node], at: &At<'_>, g: &mut [f64], _: &mut [f64]) {
        if self.coincide {
            g.fill(0.0);
            self.points(nodes, at, |sign, _, x, _| (0..3).for_each(|i| g[i] += sign * x[i]));
            return;
        }
        let ends = self.ends(nodes, at);
        let d = value(&Arrow::Between, &ends, at.t);
        for (equation, g) in self.equations.iter().zip(g) {
            *g = equation.violation(&d, &values(equation, &ends, at.t), at.t);
        }
    }

    fn geometric(&self, nodes: &[Node], at: &At<'_>, lambda: &[f64], h: &mut [f64]) {
        let n = self.size(nodes);
        h.fill(0.0);
        if self.coincide {
            self.points(nodes, at, |sign, start, _, turning| {
                if let Some((r, arm)) = &turning {
                    let force = transposed_times(r, &[lambda[0], lambda[1], lambda[2]]);
                    let k = product(&skew(arm), &skew(&force));
                    for i in 0..3 {
                        (0..3).for_each(|j| h[(start + 3 + i) * n + start + 3 + j] = sign * k[i][j]);
                    }
                }
            });
            return;
        }
        let ends = self.ends(nodes, at);
        let d = value(&Arrow::Between, &ends, at.t);
        // the forces of all equations in space come as one
        let mut force = [0.0; 3];
        for (equation, &l) in self.equations.iter().zip(lambda) {
            match equation {
                Equation::Along { direction, .. } => (0..3).for_each(|i| force[i] += l * direction[i]),
                Equation::Dot { a, b, .. } => {
                    let (va, vb) = (value(a, &ends, at.t), value(b, &ends, at.t));
                    derivatives(a, &ends, at.t).add_product(&derivatives(b, &ends, at.t), l, n, h);
                    add_twice(a, &ends, at.t, &vb, l, n, h);
                    add_twice(b, &ends, at.t, &va, l, n, h);
                }
                Equation::Distance { .. } => {
                    let size = dot(&d, &d).sqrt();
                    let (e, jd) = (d.map(|d| d / size), derivatives(&Arrow::Between, &ends, at.t).rows);
                    let along: [f64; MOST] =
                        std::array::from_fn(|i| (0..3).map(|c| e[c] * jd[c][i]).sum::<f64>());
                    for i in 0..n {
                        for j in 0..n {
                            let whole: f64 = (0..3).map(|c| jd[c][i] * jd[c][j]).sum();
                            h[i * n + j] += l / size * (whole - along[i] * along[j]);
                        }
                    }
                    (0..3).for_each(|i| force[i] += l * e[i]);
                }
            }
        }
        add_twice(&Arrow::Between, &ends, at.t, &force, 1.0, n, h);
    }

    fn rates(&self, nodes: &[Node], at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        let ends = self.ends(nodes, at);
        let between = flow(&Arrow::Between, &ends, at);
        let (d, first, second) = (&between.value, &between.first, &between.second);
        for ((equation, rate), bias) in self.equations.iter().zip(rate).zip(bias) {
            match equation {
                Equation::Along { direction, motion } => {
                    let m = motion.as_ref().map(|m| m.at(at.t)).unwrap_or_default();
                    *rate = -dot(direction, &m.v);
                    *bias = dot(direction, second) - dot(direction, &m.a);
                }
                Equation::Dot { a, b, motion, .. } => {
                    let m = motion.as_ref().map(|m| m.at(at.t)).unwrap_or_default();
                    let (a, b) = (flow(a, &ends, at), flow(b, &ends, at));
                    *rate = dot(&a.by_t, &b.value) + dot(&a.value, &b.by_t) - m.v[0];
                    *bias =
                        dot(&a.second, &b.value) + 2.0 * dot(&a.first, &b.first) + dot(&a.value, &b.second)
                            - m.a[0];
                }
                Equation::Distance { .. } => {
                    let size = dot(d, d).sqrt();
                    let along = dot(d, first) / size;
                    *rate = 0.0;
                    *bias = (dot(first, first) + dot(d, second) - along * along) / size;
                }
            }
        }
    }
}
