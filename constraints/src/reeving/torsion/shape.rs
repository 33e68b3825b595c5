//! How the twist of what lies on a wheel, and its stretched length, change with both ends and the wheel.

use super::{ArcTorsion, CARRIER, MOST, SECOND};
use crate::reeving::hold::Mode;
use crate::reeving::inline::{each, three, two};
use crate::reeving::seat::turned;
use ropewalk_core::model::twist::{between, section};
use ropewalk_core::rotation::{along, cross, times, transposed_times};
use ropewalk_core::{At, Jet, V3};

#[inline(always)]
fn less<S: Jet>(a: &V3<S>, s: S, b: &V3<S>) -> V3<S> {
    three!(|i| a[i] - b[i] * s)
}

/// How twist and stretched length change with the unknowns, and what they are.
pub(super) struct Shape<S> {
    pub twist: S,
    pub by_twist: [S; MOST],
    pub length: S,
    pub by_length: [S; MOST],
}

/// Where the wheel is and how it stands, over any carrier.
pub(super) struct Hub<S> {
    pub centre: V3<S>,
    pub axis: V3<S>,
    /// From the origin of what carries it to the centre, and its rotation, if it turns.
    pub arm: V3<S>,
    pub turn: Option<[V3<S>; 3]>,
}

impl ArcTorsion {
    #[inline(always)]
    pub(super) fn hub<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> Hub<S> {
        let seat = &self.sheave.seat;
        let (point, axis) = (each!(seat.point, |x| S::from(x)), each!(seat.axis, |x| S::from(x)));
        let moved = |q: usize| -> V3<S> { three!(|i| d[CARRIER + i] + at.q[q + i]) };
        match seat.on {
            None => Hub { centre: point, axis, arm: point, turn: None },
            Some((q, _, false)) => Hub { centre: moved(q), axis, arm: point, turn: None },
            Some((q, _, true)) => {
                let turn = turned(at, q, &three!(|i| d[CARRIER + 3 + i]));
                let (foot, arm) = (moved(q), times(&turn, &point));
                let centre = three!(|i| foot[i] + arm[i]);
                Hub { centre, axis: times(&turn, &axis), arm, turn: Some(turn) }
            }
        }
    }

    /// Place and slope of an end.
    #[inline(always)]
    pub(super) fn end<S: Jet>(&self, k: usize, at: &At<'_>, d: &[S; MOST]) -> [V3<S>; 2] {
        let (q, i) = (self.at().ends[k].end_q, SECOND * k);
        two!(|n| three!(|c| d[i + 3 * n + c] + at.q[q + 3 * n + c]))
    }

    /// Where it wraps the wheel.
    #[inline(always)]
    fn wraps<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> [[S; MOST]; 2] {
        let (hub, groove) = (self.hub(at, d), self.at());
        let (a, zero) = (&hub.axis, S::zero());
        let (mut by_twist, mut by_length) = ([zero; MOST], [zero; MOST]);
        let (mut place, mut turning, mut pulls) = ([zero; 3], [zero; 3], [zero; 3]);
        let mut outs = [[zero; 3]; 2];
        for k in 0..2 {
            let sign = if k == 0 { -1.0 } else { 1.0 };
            let [r, p] = self.end(k, at, d);
            let out: V3<S> = three!(|i| r[i] - hub.centre[i]);
            outs[k] = out;
            let beside = along(a, &out);
            let rho = less(&out, beside, a);
            let square = along(&rho, &rho);
            let size = along(&p, &p).sqrt();
            let t = each!(p, |x| x / size);
            let lean = along(&rho, &t);
            let b = each!(cross(&rho, &t), |x| x * sign / (square - lean * lean));
            let axial = along(&b, a);
            let across = less(&b, axial, a);
            let i = SECOND * k;
            for c in 0..3 {
                by_twist[i + c] = across[c];
                by_twist[i + 3 + c] = -(b[c] * lean / size);
                place[c] -= across[c];
            }
            by_twist[i + 6] = S::from(sign);
            let (tilt, swing) = (cross(a, &b), cross(a, &out));
            for c in 0..3 {
                turning[c] -= tilt[c] * beside + swing[c] * axial;
            }
            let radius = groove.arc.radius;
            let f = each!(cross(a, &rho), |x| x * (radius * groove.side() * sign) / square);
            by_length[i..i + 3].copy_from_slice(&f);
            pulls = less(&pulls, S::one(), &f);
        }
        self.carry(&hub, &place, &turning, &mut by_twist);
        // of an end beside the plane of the wheel the wrap changes as the axis tilts
        let beside = outs.map(|out| along(a, &out));
        let (y, x) =
            (along(a, &cross(&outs[0], &outs[1])), along(&outs[0], &outs[1]) - beside[0] * beside[1]);
        let normal = cross(&outs[0], &outs[1]);
        let share = S::from(groove.arc.radius * groove.side()) / (x * x + y * y);
        let by_axis = std::array::from_fn(|i| {
            share * (x * normal[i] + y * (outs[0][i] * beside[1] + outs[1][i] * beside[0]))
        });
        self.carry(&hub, &pulls, &cross(a, &by_axis), &mut by_length);
        [by_twist, by_length]
    }

    /// Its twist there, but for whole turns: the difference of the angles at which the direction from the axis is seen in the sections.
    fn seen(&self, at: &At<'_>) -> f64 {
        let (hub, ends) = (self.hub(at, &[0.0; MOST]), self.at().ends);
        let [from, to] = ends.map(|end| {
            let out: V3<f64> = std::array::from_fn(|i| at.q[end.end_q + i] - hub.centre[i]);
            let rho = less(&out, along(&hub.axis, &out), &hub.axis);
            let own = section(&at.q[end.end_q..]);
            let [x, y] = [1, 0].map(|c| (0..3).map(|i| rho[i] * own[i][c]).sum::<f64>());
            y.atan2(x)
        });
        to - from
    }

    /// Spreads what the centre and the rotation of the wheel do over what carries it.
    #[inline(always)]
    fn carry<S: Jet>(&self, hub: &Hub<S>, place: &V3<S>, turning: &V3<S>, by: &mut [S; MOST]) {
        let size = self.sheave.seat.size();
        if size > 0 {
            by[CARRIER..CARRIER + 3].copy_from_slice(place);
        }
        if let Some(turn) = &hub.turn {
            let lever = cross(&hub.arm, place);
            let all = three!(|i| lever[i] + turning[i]);
            by[CARRIER + 3..].copy_from_slice(&transposed_times(turn, &all));
        }
    }

    /// Where a straight piece lies between both ends. The directors go from the tangent of one over the direction `D` of the piece
    /// to that of the other: that is twice the area of their triangle besides the smallest rotation between both.
    #[inline(always)]
    fn straight<S: Jet>(&self, at: &At<'_>, d: &[S; MOST]) -> [[S; MOST]; 2] {
        let zero = S::zero();
        let [[r1, p1], [r2, p2]] = two!(|k| self.end(k, at, d));
        let chord = less(&r2, S::one(), &r1);
        let unit = |x: &V3<S>| {
            let size = along(x, x).sqrt();
            (each!(*x, |x| x / size), size)
        };
        let ((t1, n1), (t2, n2), (way, size)) = (unit(&p1), unit(&p2), unit(&chord));
        let c = along(&t1, &t2);
        let turn = cross(&t1, &t2);
        let volume = along(&way, &turn);
        let open = c + along(&t1, &way) + along(&way, &t2) + 1.0;
        let b = each!(turn, |x| x / (c + 1.0));
        // derivative by a unit vector, from that of the volume and that of the opening
        let area = |volume_by: &V3<S>, open_by: [&V3<S>; 2], own: &V3<S>| -> V3<S> {
            let g: V3<S> =
                three!(|i| (volume_by[i] - (open_by[0][i] + open_by[1][i]) * volume / open) * 4.0 / open);
            less(&g, along(&g, own), own)
        };
        let g1 = area(&cross(&t2, &way), [&way, &t2], &t1);
        let g2 = area(&cross(&way, &t1), [&way, &t1], &t2);
        let middle = area(&turn, [&t1, &t2], &way);
        let (mut by_twist, mut by_length) = ([zero; MOST], [zero; MOST]);
        for i in 0..3 {
            by_twist[i] = -(middle[i] / size);
            by_twist[SECOND + i] = middle[i] / size;
            by_twist[3 + i] = (b[i] + g1[i]) / n1;
            by_twist[SECOND + 3 + i] = (b[i] + g2[i]) / n2;
            by_length[i] = -way[i];
            by_length[SECOND + i] = way[i];
        }
        by_twist[6] = S::from(-1.0);
        by_twist[SECOND + 6] = S::one();
        [by_twist, by_length]
    }

    /// Its twist there, but for whole turns.
    fn turned(&self, at: &At<'_>) -> f64 {
        let [[r1, p1], [r2, p2]] = [0, 1].map(|k| self.end::<f64>(k, at, &[0.0; MOST]));
        let unit = |x: &V3<f64>| {
            let size = along(x, x).sqrt();
            x.map(|x| x / size)
        };
        let (t1, t2, way) = (unit(&p1), unit(&p2), unit(&less(&r2, 1.0, &r1)));
        let [d1, d2] = self.at().ends.map(|end| {
            let own = section(&at.q[end.end_q..]);
            std::array::from_fn(|i| own[i][0])
        });
        let (volume, c) = (along(&way, &cross(&t1, &t2)), along(&t1, &t2));
        between([&t1, &d1], [&t2, &d2]) + 4.0 * volume / (1.0 + c + along(&t1, &way) + along(&way, &t2))
    }

    fn wrapped(&self, at: &At<'_>) -> bool {
        Mode::of(at.internal, self.at().mode) == Mode::Wraps
    }

    /// Its twist now, but for whole turns.
    pub(super) fn uncounted(&self, at: &At<'_>) -> f64 {
        if self.wrapped(at) { self.seen(at) } else { self.turned(at) }
    }

    /// Its stretched length now.
    pub(super) fn length(&self, at: &At<'_>) -> f64 {
        if self.wrapped(at) {
            return self.at().arc.radius * self.sheave.lay(self.groove, at).0.wrap;
        }
        let [[from, _], [to, _]] = [0, 1].map(|k| self.end::<f64>(k, at, &[0.0; MOST]));
        let chord = less(&to, 1.0, &from);
        along(&chord, &chord).sqrt()
    }

    /// Twist and length, which are these now, with their derivatives.
    #[inline(always)]
    pub(super) fn shaped<S: Jet>(&self, at: &At<'_>, d: &[S; MOST], now: [f64; 2]) -> Shape<S> {
        let [by_twist, by_length] = if self.wrapped(at) { self.wraps(at, d) } else { self.straight(at, d) };
        let moved =
            |now: f64, by: &[S; MOST]| by.iter().zip(d).fold(S::from(now), |sum, (b, d)| sum + *b * *d);
        Shape { twist: moved(now[0], &by_twist), by_twist, length: moved(now[1], &by_length), by_length }
    }
}
