//! What all joints of this crate are made of: equations between the points and axes of two markers, with closed-form
//! Jacobians, geometric stiffness and rates.
//!
//! With `D = x_1 - x_0` and axes `u`, `w` of the markers the equations are `d·D = …` (a coordinate in space),
//! `u·D = …` (a coordinate in a body's axes, "dot-2"), `u·w = …` (an angle, "dot-1") and `|D| = L`. An axis of a body
//! turns with it: `δ(R u) = R (θ × u)`; the "axis" of a cable is its slope `r'`, that of a director the vector itself,
//! whose length doesn't matter to a right angle. Haug, *Computer-Aided Kinematics and Dynamics* (1989), chapter 9, has them all.

use ropewalk_core::error::{finite, need};
use ropewalk_core::rotation::{M3, cross, matrix, product, skew, times, transposed_times};
use ropewalk_core::{At, BuildError, Constraint, Marker, Motion, Node, NodeId, NodeKind, RowKind, V3, dot};
use std::sync::Arc;

/// A vector that an equation is made of.
#[derive(Clone, Debug)]
pub enum Arrow {
    /// From the first marker's point to the second's [m].
    Between,
    /// An axis of one of the markers; of a cable's marker its slope, whichever axis is named.
    Axis {
        /// Which marker, 0 or 1.
        of: usize,
        /// Which of its axes.
        axis: usize,
    },
    /// The second axis of a marker, turned about the third by the angle `φ(t)` that is the motion's first component.
    Turned {
        /// Which marker, 0 or 1.
        of: usize,
        /// The angle [rad].
        angle: Arc<dyn Motion>,
    },
}

/// One equation between two markers.
#[derive(Clone, Debug)]
pub enum Equation {
    /// `d·(D - X(t)) = 0`: a coordinate in space.
    Along {
        /// Unit vector `d` in space.
        direction: V3<f64>,
        /// Displacement `X(t)`; `None` if there is none.
        motion: Option<Arc<dyn Motion>>,
    },
    /// `a·b - c - X(t) = 0`
    Dot {
        /// One vector.
        a: Arrow,
        /// The other.
        b: Arrow,
        /// The number `c`.
        value: f64,
        /// Its change with time, the motion's first component; `None` if there is none.
        motion: Option<Arc<dyn Motion>>,
    },
    /// `|D| - L = 0`
    Distance {
        /// The distance `L` [m].
        length: f64,
    },
}

impl Equation {
    /// The three coordinates of the second marker are those of the first.
    pub fn coincide() -> Vec<Equation> {
        (0..3).map(|i| Equation::coordinate(unit_axis(i), None)).collect()
    }
    /// A coordinate in space.
    pub fn coordinate(direction: V3<f64>, motion: Option<Arc<dyn Motion>>) -> Equation {
        Equation::Along { direction, motion }
    }
    /// An axis of the first marker is normal to one of the second.
    pub fn normal(axis: usize, other: usize) -> Equation {
        let (a, b) = (Arrow::Axis { of: 0, axis }, Arrow::Axis { of: 1, axis: other });
        Equation::Dot { a, b, value: 0.0, motion: None }
    }
    /// The second marker stays in the plane through the first that is normal to this axis of it.
    pub fn in_plane(axis: usize) -> Equation {
        Equation::Dot { a: Arrow::Axis { of: 0, axis }, b: Arrow::Between, value: 0.0, motion: None }
    }

    fn kind(&self) -> RowKind {
        match self {
            Equation::Dot { a, b, .. } if !matches!(a, Arrow::Between) && !matches!(b, Arrow::Between) => {
                RowKind::Direction
            }
            _ => RowKind::Position,
        }
    }
    fn motion(&self) -> Vec<&Arc<dyn Motion>> {
        let angle = |arrow: &'_ Arrow| matches!(arrow, Arrow::Turned { .. });
        match self {
            Equation::Along { motion, .. } => motion.iter().collect(),
            Equation::Dot { a, b, motion, .. } => {
                let turned = [a, b].into_iter().filter(|x| angle(x)).filter_map(|x| match x {
                    Arrow::Turned { angle, .. } => Some(angle),
                    _ => None,
                });
                motion.iter().chain(turned).collect()
            }
            Equation::Distance { .. } => Vec::new(),
        }
    }
}

fn is_coincidence(equations: &[Equation]) -> bool {
    let axis = |i: usize, e: &Equation| matches!(e, Equation::Along { direction, motion: None } if *direction == unit_axis(i));
    equations.len() == 3 && equations.iter().enumerate().all(|(i, e)| axis(i, e))
}

fn unit_axis(i: usize) -> V3<f64> {
    ropewalk_core::rotation::IDENTITY[i]
}

/// Equations between two markers, as a constraint.
#[derive(Clone, Debug)]
pub struct Connection {
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

/// More unknowns than two nodes have.
const MOST: usize = 12;

/// Where one marker is.
struct End {
    kind: Option<NodeKind>,
    /// Its node's first unknown among those of the connection.
    start: usize,
    /// First velocity of its node.
    v: usize,
    /// Position in space, and on the body.
    x: V3<f64>,
    point: V3<f64>,
    /// Axes of the marker: on the body, or in space.
    axes: M3,
    r: M3,
}

/// A vector now: its value, its change with time at rest, its first and second change along the motion.
struct Flow {
    value: V3<f64>,
    by_t: V3<f64>,
    first: V3<f64>,
    second: V3<f64>,
}

impl Connection {
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
        let coincide = is_coincidence(&equations);
        let linear_rows = Vec::new();
        let mut c = Connection {
            name,
            equations,
            markers,
            nodes: on,
            rows,
            range,
            linear: false,
            linear_rows,
            coincide,
        };
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
        let arrows = self.equations.iter().flat_map(|e| match e {
            Equation::Dot { a, b, .. } => vec![a, b],
            _ => Vec::new(),
        });
        for arrow in arrows {
            let (of, turned) = match arrow {
                Arrow::Between => continue,
                Arrow::Axis { of, .. } => (*of, false),
                Arrow::Turned { of, .. } => (*of, true),
            };
            let node = self.markers[of].on().map_or(0, |n| n.0);
            let good = match self.kind(nodes, of) {
                None | Some(NodeKind::Frame) => true,
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
            (Some(NodeKind::Frame), Marker::Node { point, .. }) if point != [0.0; 3] => 2,
            _ => 1,
        };
        let degree = |arrow: &Arrow| match arrow {
            Arrow::Between => point(0).max(point(1)),
            Arrow::Axis { of, .. } | Arrow::Turned { of, .. } => match self.kind(nodes, *of) {
                None => 0,
                Some(NodeKind::Slope | NodeKind::Scalars(_)) => 1,
                Some(_) => 2,
            },
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

    fn ends(&self, nodes: &[Node], at: &At<'_>) -> [End; 2] {
        let mut start = 0;
        self.markers.map(|m| match m {
            Marker::Ground { point, axes } => {
                End { kind: None, start, v: 0, x: point, point, axes, r: [[0.0; 3]; 3] }
            }
            Marker::Node { node, point, axes } => {
                let n = &nodes[node.0 as usize];
                let q = &at.q[n.coords()];
                let mut end = End {
                    kind: Some(n.kind),
                    start,
                    v: n.v,
                    x: [q[0], q[1], q[2]],
                    point,
                    axes,
                    r: [[0.0; 3]; 3],
                };
                start += n.kind.velocities();
                match n.kind {
                    NodeKind::Frame => {
                        end.r = matrix(&[q[3], q[4], q[5], q[6]]);
                        let arm = times(&end.r, &point);
                        (0..3).for_each(|i| end.x[i] += arm[i]);
                    }
                    NodeKind::Slope => end.axes = [[q[3], q[4], q[5]]; 3],
                    NodeKind::Scalars(_) => end.axes = [[q[0], q[1], q[2]]; 3],
                    NodeKind::Point => {}
                }
                end
            }
        })
    }

    fn size(&self, nodes: &[Node]) -> usize {
        self.nodes.iter().map(|n| nodes[n.0 as usize].kind.velocities()).sum()
    }
}

impl End {
    fn is_body(&self) -> bool {
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
            Arrow::Between => [[0.0; 3]; 3],
        }
    }
    fn in_space(&self, u: &V3<f64>) -> V3<f64> {
        if self.is_body() { times(&self.r, u) } else { *u }
    }
    /// Adds the change of `p·x` by the unknowns.
    fn add_point(&self, p: &V3<f64>, sign: f64, row: &mut [f64]) {
        if self.kind.is_none() {
            return;
        }
        (0..3).for_each(|i| row[self.start + i] += sign * p[i]);
        if self.is_body() {
            self.add_turn(&self.point, p, sign, row);
        }
    }
    /// Adds the change of `p·R u` by the rotation.
    fn add_turn(&self, u: &V3<f64>, p: &V3<f64>, sign: f64, row: &mut [f64]) {
        let turn = cross(u, &transposed_times(&self.r, p));
        (0..3).for_each(|i| row[self.start + 3 + i] += sign * turn[i]);
    }
    /// Adds the change of what [`End::add_turn`] adds, by the rotation.
    fn add_turn_twice(&self, u: &V3<f64>, p: &V3<f64>, scale: f64, n: usize, h: &mut [f64]) {
        let k = product(&skew(u), &skew(&transposed_times(&self.r, p)));
        for i in 0..3 {
            for j in 0..3 {
                h[(self.start + 3 + i) * n + self.start + 3 + j] += scale * k[i][j];
            }
        }
    }
    /// Velocity, or second change along the motion, of a vector of the body that changes with time.
    fn turning(&self, at: &At<'_>, [u, du, ddu]: &[V3<f64>; 3]) -> [V3<f64>; 2] {
        let omega = [at.v[self.v + 3], at.v[self.v + 4], at.v[self.v + 5]];
        let once = cross(&omega, u);
        let (twice, with) = (cross(&omega, &once), cross(&omega, du));
        [
            times(&self.r, &std::array::from_fn(|i| once[i] + du[i])),
            times(&self.r, &std::array::from_fn(|i| twice[i] + 2.0 * with[i] + ddu[i])),
        ]
    }
}

fn value(arrow: &Arrow, ends: &[End; 2], t: f64) -> V3<f64> {
    match arrow {
        Arrow::Between => std::array::from_fn(|i| ends[1].x[i] - ends[0].x[i]),
        Arrow::Axis { of, .. } | Arrow::Turned { of, .. } => ends[*of].in_space(&ends[*of].axis(arrow, t)[0]),
    }
}

/// Adds the change of `p·arrow` by the unknowns.
fn add(arrow: &Arrow, ends: &[End; 2], t: f64, p: &V3<f64>, row: &mut [f64]) {
    match arrow {
        Arrow::Between => {
            ends[0].add_point(p, -1.0, row);
            ends[1].add_point(p, 1.0, row);
        }
        Arrow::Axis { of, .. } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            match end.kind {
                Some(NodeKind::Frame) => end.add_turn(&end.axis(arrow, t)[0], p, 1.0, row),
                Some(NodeKind::Slope) => (0..3).for_each(|i| row[end.start + 3 + i] += p[i]),
                Some(NodeKind::Scalars(_)) => (0..3).for_each(|i| row[end.start + i] += p[i]),
                _ => {}
            }
        }
    }
}

/// Adds the change of what [`add`] adds while `p` stays.
fn add_twice(arrow: &Arrow, ends: &[End; 2], t: f64, p: &V3<f64>, scale: f64, n: usize, h: &mut [f64]) {
    match arrow {
        Arrow::Between => {
            for (end, sign) in ends.iter().zip([-scale, scale]) {
                if end.is_body() && end.point != [0.0; 3] {
                    end.add_turn_twice(&end.point, p, sign, n, h);
                }
            }
        }
        Arrow::Axis { of, .. } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            if end.is_body() {
                end.add_turn_twice(&end.axis(arrow, t)[0], p, scale, n, h);
            }
        }
    }
}

/// Derivatives of a vector by all unknowns: row by component.
fn derivatives(arrow: &Arrow, ends: &[End; 2], t: f64) -> [[f64; MOST]; 3] {
    let mut j = [[0.0; MOST]; 3];
    for (i, row) in j.iter_mut().enumerate() {
        add(arrow, ends, t, &unit_axis(i), row);
    }
    j
}

fn flow(arrow: &Arrow, ends: &[End; 2], at: &At<'_>) -> Flow {
    let value = value(arrow, ends, at.t);
    let none = [0.0; 3];
    match arrow {
        Arrow::Between => {
            let mut f = Flow { value, by_t: none, first: none, second: none };
            for (end, sign) in ends.iter().zip([-1.0, 1.0]) {
                if end.kind.is_none() {
                    continue;
                }
                (0..3).for_each(|i| f.first[i] += sign * at.v[end.v + i]);
                if end.is_body() {
                    let [first, second] = end.turning(at, &[end.point, none, none]);
                    for i in 0..3 {
                        f.first[i] += sign * first[i];
                        f.second[i] += sign * second[i];
                    }
                }
            }
            f
        }
        Arrow::Axis { of, .. } | Arrow::Turned { of, .. } => {
            let end = &ends[*of];
            let axis = end.axis(arrow, at.t);
            match end.kind {
                Some(NodeKind::Frame) => {
                    let [first, second] = end.turning(at, &axis);
                    Flow { value, by_t: times(&end.r, &axis[1]), first, second }
                }
                Some(kind) => {
                    let v = end.v + if kind == NodeKind::Slope { 3 } else { 0 };
                    let first = [at.v[v], at.v[v + 1], at.v[v + 2]];
                    Flow { value, by_t: none, first, second: none }
                }
                None => Flow { value, by_t: axis[1], first: axis[1], second: axis[2] },
            }
        }
    }
}

impl Constraint for Connection {
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
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.motions().try_fold(h, |h, m| m.reach(t, h))
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
            match equation {
                Equation::Along { direction, motion } => {
                    let x = motion.as_ref().map_or([0.0; 3], |m| m.at(at.t).x);
                    *g = (0..3).map(|i| direction[i] * (d[i] - x[i])).sum();
                    add(&Arrow::Between, &ends, at.t, direction, row);
                }
                Equation::Dot { a, b, value: c, motion } => {
                    let (va, vb) = (value(a, &ends, at.t), value(b, &ends, at.t));
                    *g = dot(&va, &vb) - c - motion.as_ref().map_or(0.0, |m| m.at(at.t).x[0]);
                    add(a, &ends, at.t, &vb, row);
                    add(b, &ends, at.t, &va, row);
                }
                Equation::Distance { length } => {
                    let size = dot(&d, &d).sqrt();
                    *g = size - length;
                    add(&Arrow::Between, &ends, at.t, &d.map(|d| d / size), row);
                }
            }
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
                    let (ja, jb) = (derivatives(a, &ends, at.t), derivatives(b, &ends, at.t));
                    for i in 0..n {
                        for j in 0..n {
                            h[i * n + j] +=
                                l * (0..3).map(|c| ja[c][i] * jb[c][j] + jb[c][i] * ja[c][j]).sum::<f64>();
                        }
                    }
                    add_twice(a, &ends, at.t, &vb, l, n, h);
                    add_twice(b, &ends, at.t, &va, l, n, h);
                }
                Equation::Distance { .. } => {
                    let size = dot(&d, &d).sqrt();
                    let (e, jd) = (d.map(|d| d / size), derivatives(&Arrow::Between, &ends, at.t));
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
