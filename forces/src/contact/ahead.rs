//! How long a step may be that leaps over no contact.

use super::group::{Ball, Group, Scratch, Span, What};
use super::search::{Cubic, Look, Search};
use super::seat::{Frame, Seat, minus, rotation};
use super::shape::{Gap, Shape};
use super::term::Contact;
use ropewalk_core::held::{Held, three};
use ropewalk_core::rotation::{cross, times, transposed_times};
use ropewalk_core::{At, SpanLine, V3, dot};

/// The part of the radius that a point may go on by in a step once it touches.
const PRESS: f64 = 0.25;

/// A point as seen from the shape's body: where it is, its velocity and its acceleration.
struct Seen {
    s: V3<f64>,
    u: V3<f64>,
    a: V3<f64>,
}

fn size(x: &V3<f64>) -> f64 {
    dot(x, x).sqrt()
}

/// The middle of a cubic of these control points.
fn middle([a, b, c, d]: &[Seen; 4]) -> V3<f64> {
    std::array::from_fn(|i| 0.125 * (a.s[i] + 3.0 * (b.s[i] + c.s[i]) + d.s[i]))
}

/// When the room is used up by what approaches with `w` and gains `b`: `w t + b t²/2` reaches it.
pub(super) fn time(room: f64, w: f64, b: f64) -> f64 {
    let (w, b) = (w.max(0.0), b.max(0.0));
    2.0 * room / (w + (w * w + 2.0 * b * room).sqrt())
}

impl Contact {
    /// The longest step from here in which this group can't get deeper than a part of its radius unseen [s].
    /// What is longer than `enough` needn't be known.
    pub(super) fn free(&self, group: &Group, frame: &Frame, at: &At<'_>, enough: f64) -> f64 {
        match &group.what {
            What::Ball(ball) => self.free_ball(ball, frame, at),
            What::Span(span) => match self.level().and_then(|level| level.free(span, at)) {
                Some(free) => free,
                None => self.free_span(span, frame, at, enough),
            },
        }
    }

    /// The control points of a piece.
    fn hull(&self, span: &Span, frame: &Frame, at: &At<'_>) -> [Seen; 4] {
        let (Seat::Ground, SpanLine::Cubic { q, v, l }) = (self.fixed.seat, &span.line) else {
            return span.line.controls().map(|held| self.seen(&held, frame, at));
        };
        let third = l / 3.0;
        let of = |x: &[f64], i: &[usize; 4]| -> [V3<f64>; 4] {
            let [a, da, b, db] = i.map(|i| three(x, i));
            let [start, end] =
                [(a, da, third), (b, db, -third)].map(|(a, d, t)| std::array::from_fn(|i| a[i] + t * d[i]));
            [a, start, end, b]
        };
        let (s, u, a) = (of(at.q, q), of(at.v, v), of(at.a, v));
        std::array::from_fn(|k| Seen { s: s[k], u: u[k], a: a[k] })
    }

    fn seen(&self, held: &Held, frame: &Frame, at: &At<'_>) -> Seen {
        let s = self.fixed.place(frame, &held.x(at));
        let (v, mut a) = (held.velocity(at), held.velocity(&At { v: at.a, ..*at }));
        if let Held::Beside { q, v, arm } = *held {
            let omega = three(at.v, v + 3);
            let inwards = times(&rotation(at, q), &cross(&omega, &cross(&omega, &arm)));
            (0..3).for_each(|i| a[i] += inwards[i]);
        }
        let Seat::Body { v: first, .. } = self.fixed.seat else { return Seen { s, u: v, a } };
        let (omega, alpha) = (&frame.omega, three(at.a, first + 3));
        let swing = cross(omega, &s);
        let u = minus(&transposed_times(&frame.r, &minus(&v, &frame.v)), &swing);
        let a = transposed_times(&frame.r, &minus(&a, &three(at.a, first)));
        let (spun, turned, fled) = (cross(&alpha, &s), cross(omega, &u), cross(omega, &swing));
        Seen { s, u, a: std::array::from_fn(|i| a[i] - spun[i] - 2.0 * turned[i] - fled[i]) }
    }

    /// What was on one side of the shape before a step and is on the other behind it, through the shape.
    pub(super) fn passed(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        if let Shape::Plane = self.fixed.shape {
            return None;
        }
        let frames = [self.fixed.frame(before), self.fixed.frame(after)];
        let place = |held: &Held| {
            [(&frames[0], before), (&frames[1], after)].map(|(f, at)| self.fixed.inside(f, &held.x(at)))
        };
        let (mut pieces, mut found) = (Vec::new(), Vec::new());
        // the way of a point, as if it were straight, goes in on one side and out on the other
        let mut through = |held: &Held, radius: f64| {
            let [a, b] = place(held);
            let way = minus(&b, &a);
            // what isn't deep goes nowhere in less than what is left of its radius
            if self.fixed.shape.at_least(&a).is_none_or(|gap| gap.distance > size(&way)) {
                return false;
            }
            let curve = Cubic([a, way, b, way]);
            found.clear();
            Search::new(&self.fixed.shape, &curve, radius).find(&mut pieces, &mut found);
            let normal = |xi: f64| self.fixed.shape.gap(&curve.at(xi), f64::INFINITY).map(|g| g.normal);
            found.iter().any(|&[from, to]| match (normal(from), normal(to)) {
                (Some(a), Some(b)) => dot(&a, &b) < 0.0,
                _ => false,
            })
        };
        let (mut scratch, mut places) = (Scratch::default(), Vec::new());
        let (mut looked, mut near) = (Vec::new(), Vec::new());
        let mut gone = |group: &Group| match &group.what {
            What::Ball(ball) => through(&ball.held, ball.radius),
            What::Span(span) => {
                let [old, new] =
                    [(&frames[0], before), (&frames[1], after)].map(|(f, at)| span.curve(&self.fixed, f, at));
                if self.stays_outside(&old, &new, span.radius, (&mut looked, &mut near)) {
                    return false;
                }
                places.clear();
                places.extend([0.0, 0.25, 0.5, 0.75, 1.0]);
                for (frame, at) in [(&frames[0], before), (&frames[1], after)] {
                    group.gather(&self.fixed, frame, at, &mut scratch);
                    places.extend(scratch.found.iter().map(|[a, b]| 0.5 * (a + b)));
                }
                places.iter().any(|&xi| through(&span.line.held(xi), span.radius))
            }
        };
        let group = self.groups.iter().find(|g| gone(g))?;
        let (k, what) = match &group.what {
            What::Ball(ball) => (ball.k, "stiffness"),
            What::Span(span) => (span.k / span.length, "stiffness_per_length"),
        };
        Some(format!(
            "something is pushed through `{}` and out on its other side, however short the steps: a `{what}` of {k:e} is too \
             soft for what hits it. How deep a hit goes falls with its root: make it stiffer, or the shape thicker",
            self.label
        ))
    }

    /// Whether the middle of a curve hasn't come into the shape between two places of it, for certain.
    fn stays_outside(
        &self,
        old: &Cubic,
        new: &Cubic,
        radius: f64,
        (pieces, near): (&mut Vec<[Look; 2]>, &mut Vec<[f64; 2]>),
    ) -> bool {
        let (shape, hulls) = (&self.fixed.shape, [old.controls(), new.controls()]);
        // what is farther from it than anything has moved is still on its side
        let reach = hulls[0].iter().zip(&hulls[1]).map(|(a, b)| size(&minus(a, b))).fold(0.0, f64::max);
        if shape.convex() {
            // beyond the plane on the nearest place of its surface there is nothing of it
            let middle = old.at(0.5);
            let Some(gap) = shape.at_least(&middle) else { return true };
            let level = dot(&gap.normal, &middle) - gap.distance;
            if hulls.as_flattened().iter().all(|p| dot(&gap.normal, p) > level) {
                return true;
            }
            near.clear();
            Search::new(shape, old, reach).find(pieces, near);
            return near.is_empty();
        }
        Search::new(shape, old, radius).room() + radius > reach
    }

    /// The surface as seen from a point, at least as far away as told.
    fn facing(&self, s: &V3<f64>) -> Option<Gap> {
        let y = times(&self.fixed.axes, &minus(s, &self.fixed.origin));
        Some(self.fixed.outwards(self.fixed.shape.at_least(&y)?))
    }

    fn free_ball(&self, ball: &Ball, frame: &Frame, at: &At<'_>) -> f64 {
        let Seen { s, u, a } = self.seen(&ball.held, frame, at);
        let Some(gap) = self.facing(&s) else { return f64::INFINITY };
        let room = gap.distance - ball.radius;
        let press = room.max(PRESS * ball.radius);
        // a hollow surface comes nearer to what passes along it; one that curves away is no help for long
        let hollow = dot(&u, &gap.turn(&u)).min(0.0);
        let ahead = time(press, -dot(&gap.normal, &u), -dot(&gap.normal, &a) - hollow);
        if self.fixed.shape.concave() {
            // another side of it can be as near, whichever way the ball goes
            return ahead.min(time(room.max(0.0) + ball.radius, size(&u), size(&a)));
        }
        ahead
    }

    /// The curve lies in the hull of its control points, and beyond the plane on the surface nearest to one of its
    /// points, a convex shape ends.
    fn free_span(&self, span: &Span, frame: &Frame, at: &At<'_>, enough: f64) -> f64 {
        let all = self.hull(span, frame, at);
        let most = |of: fn(&Seen) -> &V3<f64>| all.iter().fold(0.0_f64, |m, p| m.max(size(of(p))));
        let press = PRESS * span.radius;
        if let Shape::Tube { .. } = self.fixed.shape {
            // inside, the distance is least at a control point; across its ends, near the curve
            let near = [0.0, 0.5, 1.0].map(|xi| span.line.held(xi));
            let all = span.line.controls().into_iter().chain(near);
            let one =
                |held| self.free_ball(&Ball { held, radius: span.radius, k: span.k, cell: 0 }, frame, at);
            return all.map(one).fold(f64::INFINITY, f64::min);
        }
        if self.fixed.shape.concave() {
            let curve = span.curve(&self.fixed, frame, at);
            let room = Search::new(&self.fixed.shape, &curve, span.radius).room();
            let (u, a) = (most(|p| &p.u), most(|p| &p.a));
            let anyhow = time(room.max(span.radius), u, a);
            let nearer = self.facing(&middle(&all));
            let Some(gap) = nearer else { return f64::INFINITY };
            // towards the side that it faces
            let towards = all.iter().map(|p| {
                let bent = dot(&p.u, &gap.turn(&p.u)).min(0.0);
                time(room.max(press), -dot(&gap.normal, &p.u), -dot(&gap.normal, &p.a) - bent)
            });
            return towards.fold(anyhow, f64::min);
        }
        let mut longest = 0.0_f64;
        for s in [middle(&all), all[0].s, all[3].s] {
            let Some(gap) = self.facing(&s) else { return f64::INFINITY };
            let n = &gap.normal;
            let level = dot(n, &s) - gap.distance;
            let one = |p: &Seen| {
                let room = dot(n, &p.s) - level - span.radius;
                time(room.max(press), -dot(n, &p.u), -dot(n, &p.a))
            };
            longest = longest.max(all.iter().map(one).fold(f64::INFINITY, f64::min));
            if longest >= enough {
                break;
            }
        }
        longest
    }
}
