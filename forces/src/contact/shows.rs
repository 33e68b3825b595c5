//! What a contact shows: forces and depths in records, its shape in pictures, and remarks.

use super::group::{Group, Scratch, What};
use super::search::{Depth, Search};
use super::seat::{Frame, Seat};
use super::shape::Shape;
use super::term::Contact;
use ropewalk_core::rotation::times;
use ropewalk_core::{At, Attitude, Column, Shows, Solid, SpanLine, V3};

impl Contact {
    /// How deep each point and then each slender piece is at a state [m]; `None` where it doesn't touch.
    pub fn depths<'a>(&'a self, at: &'a At<'_>) -> impl Iterator<Item = Option<f64>> + 'a {
        let frame = self.fixed.frame(at);
        let mut scratch = Scratch::default();
        let fixed = self.groups.iter().map(move |group| self.depth(group, &frame, at, &mut scratch));
        fixed.chain(self.flowing.iter().map(move |f| {
            let (now, mut scratch) = (f.now(at), Scratch::default());
            self.depth(&now.group, &self.fixed.frame(at), &now.at(at), &mut scratch)
        }))
    }

    fn depth(&self, group: &Group, frame: &Frame, at: &At<'_>, scratch: &mut Scratch) -> Option<f64> {
        group.gather(&self.fixed, frame, at, scratch);
        match &group.what {
            What::Ball(b) => {
                let s = self.fixed.place(frame, &b.held.x(at));
                self.fixed.gap(&s, b.radius).map(|g| b.radius - g.distance)
            }
            What::Span(span) => {
                let curve = span.curve(&self.fixed, frame, at);
                let search = Search::new(&self.fixed.shape, &curve, span.radius);
                scratch.found.iter().map(|piece| search.deepest(*piece)).reduce(f64::max)
            }
        }
    }

    /// What to say where cables lie around a shape on elements too long for it. A cubic isn't quite an arc: with the
    /// curvature `κ` on a length `h` it is off by `h⁴ κ³/384` from peak to peak, by which the depth, and with it the
    /// pressure, swings to and fro.
    fn coarse(&self, at: &At<'_>) -> Option<String> {
        const SWING: f64 = 0.1;
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        let (mut many, mut worst, mut finer) = (0, 0.0_f64, f64::INFINITY);
        for group in &self.groups {
            let What::Span(span) = &group.what else { continue };
            group.gather(&self.fixed, &frame, at, &mut scratch);
            let &[[from, to]] = &scratch.found[..] else { continue };
            if !matches!(span.line, SpanLine::Cubic { .. }) || to - from < 1.0 {
                continue;
            }
            let depths = scratch.balls.iter().filter(|b| b.radius > 0.0).map(|b| {
                let s = self.fixed.place(&frame, &b.held.x(at));
                (self.fixed.gap(&s, b.radius).map_or(0.0, |g| b.radius - g.distance), b.k)
            });
            let (sum, k) = depths.fold((0.0, 0.0), |(sum, all), (d, k)| (sum + d * k, all + k));
            // the normal part of its curvature
            let curve = span.curve(&self.fixed, &frame, at);
            let Some(gap) = self.fixed.shape.gap(&curve.at(0.5), f64::INFINITY) else { continue };
            let curvature = curve.curvature(&gap.normal).max(0.0);
            let (h, mean) = (span.length, sum / k);
            let off = h.powi(4) * curvature.powi(3) / 384.0;
            if off > SWING * mean {
                many += 1;
                worst = worst.max(off / mean);
                finer = finer.min((384.0 * SWING * mean / curvature.powi(3)).powf(0.25));
            }
        }
        (many > 0).then(|| {
            format!(
                "`{}`: {many} elements that lie around it are too long to be arcs: along them the pressure swings by up \
                 to {:.0} % from peak to peak. Take elements of at most {finer:.2e} m there, or a softer contact. What the \
                 ends and the shape feel is right all the same",
                self.label,
                100.0 * worst.min(9.99)
            )
        })
    }

    /// What to say where something lies on a bed of which the grid says nothing.
    fn beyond(&self, at: &At<'_>) -> Option<String> {
        let Shape::Heights(heights) = &self.fixed.shape else { return None };
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        let mut farthest = 0.0_f64;
        for group in &self.groups {
            if self.depth(group, &frame, at, &mut scratch).is_some() {
                let there = self.fixed.inside(&frame, &group.held().x(at));
                farthest = farthest.max(heights.beyond(&there));
            }
        }
        (farthest > 0.0).then(|| {
            format!(
                "`{}`: something lies up to {farthest:.3} m beyond the borders of the grid, where the bed goes on with the slope \
                 that it has there. Give it heights as far as that",
                self.label
            )
        })
    }
}

impl Shows for Contact {
    fn columns(&self) -> Vec<Column> {
        let force = |name: &str| Column::new(name, "N");
        let mut all = ["fx", "fy", "fz", "normal"].map(force).to_vec();
        all.extend([Column::new("depth", "m"), Column::new("points", "1"), Column::new("length", "m")]);
        if self.law.friction.is_some() {
            all.push(Column::new("slipping", "1"));
        }
        all
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let (mut sum, mut normal, mut deepest): (V3<f64>, f64, f64) = ([0.0; 3], 0.0, 0.0);
        self.each(at, |_, touch, frame| {
            let f = times(&frame.r, &touch.f);
            (0..3).for_each(|i| sum[i] += f[i]);
            normal += touch.normal;
        });
        let (mut points, mut length) = (0.0, 0.0);
        let (frame, mut scratch) = (self.fixed.frame(at), Scratch::default());
        for group in &self.groups {
            let Some(depth) = self.depth(group, &frame, at, &mut scratch) else { continue };
            deepest = deepest.max(depth);
            match &group.what {
                What::Ball(_) => points += 1.0,
                What::Span(s) => length += scratch.found.iter().map(|[a, b]| s.length * (b - a)).sum::<f64>(),
            }
        }
        for flowing in &self.flowing {
            let now = flowing.now(at);
            let Some(depth) = self.depth(&now.group, &frame, &now.at(at), &mut scratch) else { continue };
            deepest = deepest.max(depth);
            length += scratch.found.iter().map(|[a, b]| now.l * (b - a)).sum::<f64>();
        }
        let (mut slipping, mut all) = (0.0, 0.0);
        self.each_braked(at, |f| {
            let f = times(&frame.r, f);
            (0..3).for_each(|i| sum[i] += f[i]);
        });
        self.each_bristle(at, |hold, pressed| {
            let f = times(&frame.r, &hold.f);
            (0..3).for_each(|i| sum[i] += f[i]);
            all += pressed;
            slipping += if hold.slips { pressed } else { 0.0 };
        });
        out.extend(sum);
        out.extend([normal, deepest, points, length]);
        if self.law.friction.is_some() {
            out.push(if all > 0.0 { slipping / all } else { 0.0 });
        }
    }
    fn solids(&self) -> Vec<Solid> {
        let fixed = &self.fixed;
        let carrier = match fixed.seat {
            Seat::Ground => None,
            Seat::Body { q, .. } => Some(q),
        };
        let seat = Attitude::new(fixed.origin, &fixed.axes);
        vec![Solid { name: self.label.clone(), surface: fixed.shape.surface(), carrier, seat }]
    }
    fn remark(&self, at: &At<'_>) -> Option<String> {
        self.beyond(at).or_else(|| self.coarse(at))
    }
    fn local(&self, quantity: &str, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
        if quantity == "clearance" { self.clearance(part, s, at) } else { None }
    }
}
