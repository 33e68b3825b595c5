//! The contact of many points with one shape.

use super::law::ContactLaw;
use super::shape::{Gap, Shape};
use super::touch::{PAIR, Pair, Touch};
use ropewalk_core::build::{BuildError, need, positive};
use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::{IDENTITY, M3, cross, matrix, times, transposed_times};
use ropewalk_core::{
    Assembly, At, Column, ContactPoint, Energy, Leap, Marker, Node, NodeKind, Pattern, Power, Term, V3, dot,
};
use std::ops::Range;

/// Balls along cables and on bodies that touch a shape, which is fixed in space or on a rigid body and feels the
/// opposite force.
///
/// Use it for: sea floors, drums, sheaves, guide tubes, decks. A ball of radius `r` whose centre is at the distance `s`
/// from the surface is pushed out with `k d^p`, `d = r - s`, is damped by the [`ContactLaw`] and, where it slips, held
/// back by friction. On a body the force acts where the ball touches, so that a ball rolls; on a cable, which doesn't
/// know twist, and a point mass it acts at the centre.
#[derive(Clone, Debug)]
pub struct Contact {
    /// A name, such as `drum`.
    pub label: String,
    /// Elasticity, damping and friction.
    pub law: ContactLaw,
    shape: Shape,
    seat: Seat,
    /// Where the shape's own origin is in the axes of what it is on, and its axes there, one after the other.
    origin: V3<f64>,
    axes: M3,
    balls: Vec<Ball>,
    /// Balls that the same unknowns move.
    groups: Vec<Range<usize>>,
}

/// What a shape is fixed to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Seat {
    Ground,
    /// A rigid body with these first coordinate and velocity.
    Body {
        q: usize,
        v: usize,
    },
}

/// A ball that can touch.
#[derive(Clone, Copy, Debug)]
struct Ball {
    held: Held,
    radius: f64,
    /// Stiffness of its contact [N/m^p].
    k: f64,
}

/// Where the body of a shape is.
struct Frame {
    r: M3,
    x: V3<f64>,
    v: V3<f64>,
    omega: V3<f64>,
}

/// Unknowns of a group: of a cable element and a body.
const MOST: usize = 18;

/// The part of the radius that a point may go on by in a step once it touches.
const PRESS: f64 = 0.25;

fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

impl Contact {
    /// Contact of points with a shape whose origin and axes are those of a marker on the ground or on a rigid body.
    /// Each point has the `stiffness` [N/m^p]; one that stands for a length has that per length [N/m^p/m].
    ///
    /// # Errors
    /// A marker on something else, no points, a point without radius or on the shape's own body, bad numbers.
    pub fn new(
        label: impl Into<String>,
        nodes: &[Node],
        shape: Shape,
        marker: &Marker,
        points: &[ContactPoint],
        stiffness: [f64; 2],
        law: ContactLaw,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        law.check()?;
        let (seat, origin, axes) = match *marker {
            Marker::Ground { point, axes } => (Seat::Ground, point, axes),
            Marker::Node { node, point, axes } => {
                let n = ropewalk_core::held::find(nodes, node, &label)?;
                need(n.kind == NodeKind::Frame, || {
                    format!("{label}: a shape can only be on the ground or on a rigid body")
                })?;
                (Seat::Body { q: n.q, v: n.v }, point, axes)
            }
        };
        need(!points.is_empty(), || format!("{label}: there is nothing that could touch the shape"))?;
        let mut balls = Vec::with_capacity(points.len());
        let mut groups: Vec<Range<usize>> = Vec::new();
        for p in points {
            positive("radius", p.radius)?;
            let (field, k) = match p.length > 0.0 {
                true => ("stiffness_per_length", stiffness[1] * p.length),
                false => ("stiffness", stiffness[0]),
            };
            positive(field, k)?;
            let own = matches!((seat, p.held), (Seat::Body { v, .. }, Held::Beside { v: w, .. } | Held::Moves { v: w, .. }) if v == w);
            need(!own, || format!("{label}: a body can't touch a shape of its own"))?;
            let ball = Ball { held: p.held, radius: p.radius, k };
            match groups.last_mut() {
                Some(g) if balls.last().is_some_and(|b: &Ball| b.held.dofs().eq(ball.held.dofs())) => {
                    g.end += 1
                }
                _ => groups.push(balls.len()..balls.len() + 1),
            }
            balls.push(ball);
        }
        Ok(Contact { label, law, shape, seat, origin, axes, balls, groups })
    }

    /// Depth of each point at a state [m]; `None` where it doesn't touch.
    pub fn depths<'a>(&'a self, at: &'a At<'_>) -> impl Iterator<Item = Option<f64>> + 'a {
        let frame = self.frame(at);
        self.balls.iter().map(move |b| {
            let s = self.place(&frame, &b.held.x(at));
            self.gap(&s, b.radius).map(|g| b.radius - g.distance)
        })
    }

    fn frame(&self, at: &At<'_>) -> Frame {
        match self.seat {
            Seat::Ground => Frame { r: IDENTITY, x: [0.0; 3], v: [0.0; 3], omega: [0.0; 3] },
            Seat::Body { q, v } => {
                Frame { r: rotation(at, q), x: three(at.q, q), v: three(at.v, v), omega: three(at.v, v + 3) }
            }
        }
    }

    /// A point in the axes of the shape's body.
    #[inline]
    fn place(&self, frame: &Frame, x: &V3<f64>) -> V3<f64> {
        match self.seat {
            Seat::Ground => *x,
            Seat::Body { .. } => transposed_times(&frame.r, &minus(x, &frame.x)),
        }
    }

    /// The surface as seen from a point in the axes of the shape's body.
    #[inline]
    fn gap(&self, s: &V3<f64>, reach: f64) -> Option<Gap> {
        let gap = self.shape.gap(&times(&self.axes, &minus(s, &self.origin)), reach)?;
        Some(gap.turned(|x| transposed_times(&self.axes, x)))
    }

    #[inline]
    fn touch(&self, ball: &Ball, frame: &Frame, at: &At<'_>) -> Option<(Touch, Pair)> {
        let s = self.place(frame, &ball.held.x(at));
        let gap = self.gap(&s, ball.radius)?;
        let (v, carrier) = match ball.held {
            Held::Beside { q, v, arm } => {
                let omega = three(at.v, v + 3);
                let carrier = Pair::carried(&frame.r, &rotation(at, q), &arm, &omega, ball.radius);
                (three(at.v, v), Some(carrier))
            }
            held => (held.velocity(at), None),
        };
        let g = match self.seat {
            Seat::Ground => v,
            Seat::Body { .. } => transposed_times(&frame.r, &minus(&v, &frame.v)),
        };
        let pair = Pair { r: frame.r, omega: frame.omega, s, g, carrier };
        let u = pair.velocity(&gap.normal);
        Some((Touch::new(&self.law, gap, ball.radius, ball.k, &u), pair))
    }

    /// Whether a ball that slips now may have stopped on the way.
    fn may_stick(&self, ball: &Ball, touch: &Touch, leap: Leap<'_>, at: &At<'_>) -> bool {
        let before = At { v: leap.v, ..*at };
        let was = match (self.seat, ball.held) {
            (Seat::Ground, Held::Moves { .. } | Held::Between { .. }) => {
                let (u, n) = (ball.held.velocity(&before), &touch.gap.normal);
                let approach = dot(&u, n);
                std::array::from_fn(|i| u[i] - approach * n[i])
            }
            _ => match self.touch(ball, &self.frame(&before), &before) {
                Some((was, _)) => was.slip,
                None => return false,
            },
        };
        self.law.may_stick(&was, &touch.slip, leap.predicted)
    }

    fn each(&self, at: &At<'_>, mut see: impl FnMut(&Ball, &Touch, &Frame)) {
        let frame = self.frame(at);
        for ball in &self.balls {
            if let Some((touch, _)) = self.touch(ball, &frame, at) {
                see(ball, &touch, &frame);
            }
        }
    }

    /// The longest step from here in which this ball can't get deeper than a part of its radius unseen [s].
    fn free(&self, ball: &Ball, frame: &Frame, at: &At<'_>) -> f64 {
        let s = self.place(frame, &ball.held.x(at));
        let y = times(&self.axes, &minus(&s, &self.origin));
        let Some(gap) = self.shape.at_least(&y) else { return f64::INFINITY };
        let gap = gap.turned(|x| transposed_times(&self.axes, x));
        let (v, mut a) = (ball.held.velocity(at), ball.held.velocity(&At { v: at.a, ..*at }));
        if let Held::Beside { q, v, arm } = ball.held {
            let omega = three(at.v, v + 3);
            let inwards = times(&rotation(at, q), &cross(&omega, &cross(&omega, &arm)));
            (0..3).for_each(|i| a[i] += inwards[i]);
        }
        // as seen from the shape's body
        let (u, a) = match self.seat {
            Seat::Ground => (v, a),
            Seat::Body { v: first, .. } => {
                let (omega, alpha) = (&frame.omega, three(at.a, first + 3));
                let swing = cross(omega, &s);
                let u = minus(&transposed_times(&frame.r, &minus(&v, &frame.v)), &swing);
                let a = transposed_times(&frame.r, &minus(&a, &three(at.a, first)));
                let (spun, turned, fled) = (cross(&alpha, &s), cross(omega, &u), cross(omega, &swing));
                (u, std::array::from_fn(|i| a[i] - spun[i] - 2.0 * turned[i] - fled[i]))
            }
        };
        let room = gap.distance - ball.radius;
        // `w` towards it and gaining `b`: the room is used up when w t + b t²/2 reaches it
        let time = |room: f64, w: f64, b: f64| {
            let (w, b) = (w.max(0.0), b.max(0.0));
            2.0 * room / (w + (w * w + 2.0 * b * room).sqrt())
        };
        let press = room.max(PRESS * ball.radius);
        // a hollow surface comes nearer to what passes along it; one that curves away is no help for long
        let hollow = dot(&u, &gap.turn(&u)).min(0.0);
        let ahead = time(press, -dot(&gap.normal, &u), -dot(&gap.normal, &a) - hollow);
        if self.shape.concave() {
            // another side of it can be as near, whichever way the ball goes
            let size = |x: &V3<f64>| dot(x, x).sqrt();
            return ahead.min(time(room.max(0.0) + ball.radius, size(&u), size(&a)));
        }
        ahead
    }
}

fn rotation(at: &At<'_>, q: usize) -> M3 {
    matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]])
}

/// The block of a group: what has been added of it so far.
struct Block {
    k: [[f64; MOST]; MOST],
    any: bool,
}

impl Block {
    /// Adds the derivative of the force on a ball on the ground, in space.
    fn add_point(&mut self, held: &Held, d: &M3) {
        self.any = true;
        let weights = weights(held);
        for (a, wa) in weights.iter().enumerate().filter(|w| *w.1 != 0.0) {
            for (b, wb) in weights.iter().enumerate().filter(|w| *w.1 != 0.0) {
                let w = wa * wb;
                for (row, d) in self.k[3 * a..3 * a + 3].iter_mut().zip(d) {
                    let row = &mut row[3 * b..3 * b + 3];
                    for j in 0..3 {
                        row[j] -= w * d[j];
                    }
                }
            }
        }
    }
    /// Adds the derivative of the forces of a pair, of whose unknowns the last six are left out on the ground.
    fn add_pair(&mut self, held: &Held, d: &[[f64; PAIR]; PAIR]) {
        self.any = true;
        let n = held.size();
        if let Held::Beside { .. } = held {
            for i in 0..PAIR {
                for j in 0..PAIR {
                    self.k[i][j] -= d[i][j];
                }
            }
            return;
        }
        let weights = weights(held);
        self.add_point(held, &std::array::from_fn(|i| std::array::from_fn(|j| d[i][j])));
        for i in 0..6 {
            for j in 0..6 {
                self.k[n + i][n + j] -= d[6 + i][6 + j];
            }
            for (a, w) in weights.iter().enumerate() {
                for j in 0..3 {
                    self.k[n + i][3 * a + j] -= w * d[6 + i][j];
                    self.k[3 * a + j][n + i] -= w * d[j][6 + i];
                }
            }
        }
    }
}

/// By how much each of the vectors that move a point does so.
fn weights(held: &Held) -> &[f64] {
    match held {
        Held::Between { weight, .. } => weight,
        _ => &[1.0],
    }
}

impl Term for Contact {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        let body = match self.seat {
            Seat::Ground => 0..0,
            Seat::Body { v, .. } => v..v + 6,
        };
        for g in &self.groups {
            p.clique(self.balls[g.start].held.dofs().chain(body.clone()));
        }
    }
    fn symmetric(&self) -> bool {
        self.law.conservative()
            && self.seat == Seat::Ground
            && !self.balls.iter().any(|b| matches!(b.held, Held::Beside { .. }))
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (frame, w) = (self.frame(at), out.weights());
        let mut block = Block { k: [[0.0; MOST]; MOST], any: false };
        for (clique, group) in self.groups.iter().enumerate() {
            for ball in &self.balls[group.clone()] {
                let Some((mut touch, pair)) = self.touch(ball, &frame, at) else { continue };
                if let Some(leap) = out.leap()
                    && self.law.slips(&touch.slip)
                    && self.may_stick(ball, &touch, leap, at)
                {
                    touch.hold(&self.law);
                    out.approximates();
                }
                if self.seat == Seat::Ground && pair.carrier.is_none() {
                    for (a, w) in weights(&ball.held).iter().enumerate().filter(|w| *w.1 != 0.0) {
                        (0..3).for_each(|i| out.add(ball.held.dof(3 * a + i), -w * touch.f[i]));
                    }
                    if out.wants_tangent() {
                        let [x, v] = touch.slopes(&self.law, ball.k);
                        let d =
                            std::array::from_fn(|i| std::array::from_fn(|j| w.q * x[i][j] + w.v * v[i][j]));
                        block.add_point(&ball.held, &d);
                    }
                    continue;
                }
                let forces = pair.forces(&touch);
                if pair.carrier.is_some() {
                    (0..6).for_each(|i| out.add(ball.held.dof(i), -forces[i]));
                } else {
                    for (a, w) in weights(&ball.held).iter().enumerate() {
                        (0..3).for_each(|i| out.add(ball.held.dof(3 * a + i), -w * forces[i]));
                    }
                }
                if let Seat::Body { v, .. } = self.seat {
                    (0..6).for_each(|i| out.add(v + i, -forces[6 + i]));
                }
                if !out.wants_tangent() {
                    continue;
                }
                let slopes = touch.slopes(&self.law, ball.k);
                block.add_pair(&ball.held, &pair.derivative(&touch, &slopes, w));
            }
            if block.any {
                let n = self.balls[group.start].held.size() + if self.seat == Seat::Ground { 0 } else { 6 };
                out.add_square(clique, &block.k);
                block.k[..n].iter_mut().for_each(|row| row[..n].fill(0.0));
                block.any = false;
            }
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let mut potential = 0.0;
        self.each(at, |ball, touch, _| potential += self.law.stored(ball.k, touch.depth));
        Energy { potential, ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let mut dissipated = 0.0;
        self.each(at, |_, t, _| {
            dissipated += (t.normal - t.elastic) * t.rate + t.normal * dot(&t.pull, &t.slip);
        });
        Power { dissipated, ..Power::default() }
    }
    fn foresees(&self) -> bool {
        true
    }
    fn kinked(&self) -> bool {
        self.law.friction > 0.0
    }
    fn horizon(&self, at: &At<'_>) -> f64 {
        let frame = self.frame(at);
        self.balls.iter().map(|b| self.free(b, &frame, at)).fold(f64::INFINITY, f64::min)
    }
    fn columns(&self) -> Vec<Column> {
        let force = |name: &str| Column::new(name, "N");
        let mut all = ["fx", "fy", "fz", "normal"].map(force).to_vec();
        all.extend([Column::new("depth", "m"), Column::new("points", "1")]);
        all
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let (mut sum, mut normal, mut deepest, mut count) = ([0.0; 3], 0.0, 0.0_f64, 0.0);
        self.each(at, |_, touch, frame| {
            let f = times(&frame.r, &touch.f);
            (0..3).for_each(|i| sum[i] += f[i]);
            normal += touch.normal;
            deepest = deepest.max(touch.depth);
            count += 1.0;
        });
        out.extend(sum);
        out.extend([normal, deepest, count]);
    }
}
