//! The contact of lines with each other.

use super::super::law::ContactLaw;
use super::super::search::Depth;
use super::curve::Curve;
use super::facing::{Facing, Scratch};
use super::friction::{CELLS, Rubs};
use super::near::Near;
use super::pieces::{APART, Piece, Pieces};
use super::push::{Pressed, Push, Sum};
use crate::gauss::gauss;
use ropewalk_core::error::{need, positive};
use ropewalk_core::{
    Assembly, At, BuildError, Column, ContactSpan, Couples, Energy, Foresees, Pattern, Power, Relaxed,
    Remembers, Shows, SpanLine, Term, V3, Weights, dot,
};
use std::borrow::Cow;
use std::sync::Arc;

/// Lines that touch each other and themselves, anywhere along them.
///
/// Use it for: lines that cross, coils, knots, bundles, a line that falls onto itself, cables beside a hull. Where the middle
/// lines are nearer than both radii, by `d`, they are pushed apart with `k d^p` per length and damped by the
/// [`ContactLaw`], each of both with half of the stiffness along its own length. The force follows from an energy and
/// doesn't depend on where nodes are. [`LineContact::with_friction`] holds what would slip. Only pieces that are near each other are coupled: which these are
/// is looked at anew as they move.
#[derive(Clone)]
pub struct LineContact {
    /// A name, such as `crossing`.
    pub label: String,
    /// Elasticity and damping.
    pub law: ContactLaw,
    /// Stiffness per length [N/m^p/m].
    pub(super) per_length: f64,
    pub(super) pieces: Arc<Pieces>,
    pub(super) near: Near,
    /// What holds them where they would slip.
    pub(super) rubs: Option<Arc<Rubs>>,
}

/// A line with what it touches by.
#[derive(Clone, Debug)]
pub struct Touching {
    /// Its name, for messages.
    pub name: String,
    /// Its pieces, one after the other.
    pub spans: Vec<ContactSpan>,
}

/// Points of the Gauss rule on each interval.
const POINTS: usize = 8;
/// How far apart pieces are that are worth knowing of: in parts of the thickness of the thickest, and of the mean length of
/// a piece.
const MARGIN: [f64; 2] = [2.0, 0.25];
/// A line whose end is as deep in another, in parts of the thinner one's radius, is tied to it.
const TIED: f64 = 0.5;

/// Where two lines are deepest in each other.
#[derive(Clone, Debug)]
pub struct Deepest {
    /// How deep [m].
    pub depth: f64,
    /// The radius of the thinner one [m].
    pub radius: f64,
    /// Both lines, and where along them [m].
    pub lines: [(String, f64); 2],
}

impl LineContact {
    /// Contact of these lines with one another, and, if so told, of each with itself, as they lie at a state.
    ///
    /// # Errors
    /// No two that could touch, a line without thickness, one that feeds, bad numbers.
    pub fn new(
        label: impl Into<String>,
        lines: &[Touching],
        itself: bool,
        per_length: f64,
        law: ContactLaw,
        at: &At<'_>,
    ) -> Result<Self, BuildError> {
        let label = label.into();
        law.check()?;
        let per_length = positive("stiffness_per_length", per_length)?;
        need(lines.len() > 1 || itself, || {
            format!(
                "{label}: a single line has nothing to touch but itself: name two, or set `itself = true`"
            )
        })?;
        let mut all = Vec::new();
        for (number, line) in lines.iter().enumerate() {
            let name = &line.name;
            for span in &line.spans {
                need(span.flow.is_none(), || {
                    format!(
                        "`{name}` feeds, and contact between lines of which one runs through isn't known here: leave it out \
                         by `on`"
                    )
                })?;
                let &ContactSpan { line: curve, length, s, tips, .. } = span;
                let radius = positive("diameter", span.radius).map_err(|_| {
                    BuildError::new(format!("`{name}` has no thickness to touch with: give it a `diameter`"))
                })?;
                all.push(Piece { line: number, span: curve, radius, length, s, tips, tied: Vec::new() });
            }
        }
        need(!all.is_empty(), || format!("{label}: there is nothing that could touch"))?;
        let thickest = all.iter().map(|p| 2.0 * p.radius).fold(0.0, f64::max);
        let mean = all.iter().map(|p| p.length).sum::<f64>() / all.len() as f64;
        let margin = (MARGIN[0] * thickest).max(MARGIN[1] * mean);
        let names = lines.iter().map(|l| l.name.clone()).collect();
        let mut pieces = Pieces { all, names, itself, margin };
        tie(&mut pieces, at);
        let near = Near::new(&pieces, at);
        Ok(LineContact { label, law, per_length, pieces: Arc::new(pieces), near, rubs: None })
    }

    /// The pairs of pieces that are coupled, by number along the lines, one line after the other.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.near.couples.iter().map(|c| c.pieces)
    }

    /// The middle lines of the pieces that are near others, and of the links next to those.
    pub(super) fn curves(&self, near: &Near, at: &At<'_>) -> Vec<Option<Curve>> {
        let mut curves = vec![None; self.pieces.all.len()];
        for &k in &near.active {
            let mut see = |k: usize| curves[k] = Some(Curve::of(&self.pieces.all[k].span, at));
            see(k);
            self.pieces.links(k).into_iter().flatten().for_each(see);
        }
        curves
    }

    /// Both ways in which two pieces face each other.
    pub(super) fn facings<'a>(
        &self,
        [i, j]: [usize; 2],
        curves: &'a [Option<Curve>],
    ) -> impl Iterator<Item = ([usize; 2], Facing<'a>)> {
        let all = self.pieces.clone();
        [([i, j], true), ([j, i], false)].into_iter().filter_map(move |(pair, ahead)| {
            let (Some(a), Some(b)) = (&curves[pair[0]], &curves[pair[1]]) else { return None };
            let facing = all.facing(pair, [a, b], ahead)?;
            Some((pair, Facing { corners: all.corners(pair[1], curves), ..facing }))
        })
    }

    /// Sees every place where one piece touches another.
    pub(super) fn each_of(
        &self,
        pair: [usize; 2],
        facing: &Facing<'_>,
        at: &At<'_>,
        scratch: &mut Scratch,
        see: &mut impl FnMut(Push),
    ) {
        facing.find(scratch);
        if self.rubs.is_some() {
            scratch.cut(CELLS);
        }
        let [one, other] = pair.map(|k| &self.pieces.all[k]);
        for &[from, to] in &scratch.found {
            for &(place, weight) in gauss(POINTS) {
                let xi = from + (to - from) * place;
                let Some(nearest) = facing.nearest(xi, &facing.one.cubic.at(xi)) else { continue };
                let share = 0.5 * one.length * (to - from) * weight;
                let lines = [&one.span, &other.span];
                let k = self.softened(lines, [xi, nearest.t], share, facing.thick, at);
                if let Some(push) = Push::new(&self.law, lines, (xi, nearest), facing.thick, k, at) {
                    see(push);
                }
            }
        }
    }

    /// What is near at a state: as listed, or, for one that somebody else has found, as it is.
    pub(super) fn near(&self, at: &At<'_>) -> Cow<'_, Near> {
        if self.near.holds(&self.pieces, at) {
            Cow::Borrowed(&self.near)
        } else {
            Cow::Owned(Near::new(&self.pieces, at))
        }
    }

    fn each(&self, at: &At<'_>, mut see: impl FnMut(Push)) {
        let near = self.near(at);
        let (curves, mut scratch) = (self.curves(&near, at), Scratch::default());
        for couple in &near.couples {
            for (pair, facing) in self.facings(couple.pieces, &curves) {
                self.each_of(pair, &facing, at, &mut scratch, &mut see);
            }
        }
    }

    /// The stiffness of a place that stands for so much length; on the way to an equilibrium hardly more than the load can
    /// use where the last iteration has moved it by more than a radius, so that what still comes down isn't thrown up again.
    fn softened(&self, lines: [&SpanLine; 2], xi: [f64; 2], share: f64, thick: f64, at: &At<'_>) -> f64 {
        const SHARE: f64 = 10.0;
        let k = self.per_length * share;
        let Some(Relaxed { last: Some(last), how }) = at.relaxed else { return k };
        let there = At { v: last, ..*at };
        let [a, b] = [0, 1].map(|n| lines[n].held(xi[n]).velocity(&there));
        let d: V3<f64> = std::array::from_fn(|i| a[i] - b[i]);
        let (moved, radius) = (dot(&d, &d).sqrt(), 0.5 * thick);
        if !(moved > radius) {
            return k;
        }
        let most = SHARE * how.load / (moved - radius).powf(self.law.exponent);
        k.min(most.max(k * (radius / moved).powi(3)))
    }

    /// Where the lines are deepest in each other at a state; nothing if they don't touch.
    pub fn deepest(&self, at: &At<'_>) -> Option<Deepest> {
        let near = self.near(at);
        let (curves, mut scratch) = (self.curves(&near, at), Scratch::default());
        let mut worst: Option<Deepest> = None;
        for couple in &near.couples {
            for (pair, facing) in self.facings(couple.pieces, &curves) {
                facing.find(&mut scratch);
                for &piece in &scratch.found {
                    let (xi, depth) = facing.deepest_at(piece);
                    let Some(near) = facing.nearest(xi, &facing.one.cubic.at(xi)) else { continue };
                    let all = pair.map(|k| &self.pieces.all[k]);
                    let radius = all[0].radius.min(all[1].radius);
                    if worst.as_ref().is_some_and(|w| w.depth / w.radius >= depth / radius) {
                        continue;
                    }
                    let place = [xi, near.t.clamp(0.0, 1.0)];
                    let lines = std::array::from_fn(|n| self.place(pair[n], place[n]));
                    worst = Some(Deepest { depth, radius, lines });
                }
            }
        }
        worst
    }

    /// A place as messages call it: the line, and how far along it [m].
    pub(super) fn place(&self, piece: usize, xi: f64) -> (String, f64) {
        let piece = &self.pieces.all[piece];
        (self.pieces.names[piece.line].clone(), piece.s + xi * piece.length)
    }
}

/// Finds ends that are in other lines at the start: they are tied to them, so that both leave each other alone there.
fn tie(pieces: &mut Pieces, at: &At<'_>) {
    let curves: Vec<Curve> = pieces.all.iter().map(|p| Curve::of(&p.span, at)).collect();
    let mut ties: Vec<([usize; 2], [f64; 2], f64)> = Vec::new();
    for (i, piece) in pieces.all.iter().enumerate() {
        for end in (0..2).filter(|&end| piece.tips[end]) {
            let (xi, mut nearest) = (end as f64, None::<(f64, usize, f64)>);
            let x = curves[i].cubic.at(xi);
            for (j, other) in pieces.all.iter().enumerate().filter(|(_, p)| p.line != piece.line) {
                let t = curves[j].nearest(&x, [0.0, 1.0]);
                let y = curves[j].cubic.at(t);
                let way: V3<f64> = std::array::from_fn(|i| x[i] - y[i]);
                let distance = dot(&way, &way).sqrt();
                let deep = piece.radius + other.radius - distance > TIED * piece.radius.min(other.radius);
                if deep && nearest.is_none_or(|n| distance < n.0) {
                    nearest = Some((distance, j, t));
                }
            }
            if let Some((_, j, t)) = nearest {
                let other = &pieces.all[j];
                let s = [piece.s + xi * piece.length, other.s + t * other.length];
                ties.push(([piece.line, other.line], s, APART * pieces.thick(i, j)));
            }
        }
    }
    for ([a, b], [s, t], reach) in ties {
        for piece in &mut pieces.all {
            for (_, other, s) in [(a, b, s), (b, a, t)].iter().filter(|(line, ..)| *line == piece.line) {
                let range = [s - reach, s + reach].map(|x| (x - piece.s) / piece.length);
                if range[1] > 0.0 && range[0] < 1.0 {
                    piece.tied.push((*other, range));
                }
            }
        }
    }
}

impl Term for LineContact {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        for couple in &self.near.couples {
            p.clique(couple.dofs.iter().copied());
        }
    }
    fn symmetric(&self) -> bool {
        self.law.conservative() && self.pieces.all.iter().all(|p| matches!(p.span, SpanLine::Cubic { .. }))
    }
    fn has_tangent(&self, w: &Weights) -> bool {
        w.q != 0.0 || w.v != 0.0
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let tangent = out.wants_tangent().then(|| out.weights());
        // the matrix has places for what is listed
        let near = if tangent.is_some() { Cow::Borrowed(&self.near) } else { self.near(at) };
        if near.couples.is_empty() {
            return;
        }
        let (curves, mut scratch) = (self.curves(&near, at), Scratch::default());
        let mut sum = Sum::default();
        for (clique, couple) in near.couples.iter().enumerate() {
            let n = couple.dofs.len();
            for (pair, facing) in self.facings(couple.pieces, &curves) {
                let turned = pair != couple.pieces;
                let place = [usize::from(turned), usize::from(!turned)].map(|k| &couple.place[k][..]);
                let Some(rubs) = &self.rubs else {
                    let see = &mut |push: Push| push.add(place, n, tangent, &mut sum, None);
                    self.each_of(pair, &facing, at, &mut scratch, see);
                    continue;
                };
                let mut cells = [Pressed::NONE; CELLS];
                self.each_of(pair, &facing, at, &mut scratch, &mut |push| {
                    let cell = &mut cells[Rubs::cell(push.xi[0])];
                    cell.add(&push);
                    push.add(place, n, tangent, &mut sum, Some(cell));
                });
                self.add_friction(rubs, (pair, &facing), &cells, (place, n), at, out, &mut sum);
            }
            if sum.touched {
                for (dof, r) in couple.dofs.iter().zip(&sum.r) {
                    out.add(*dof, *r);
                }
                if tangent.is_some() {
                    out.add_square(clique, &sum.k);
                }
                sum.clear(n);
            }
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        self.balance(at).0
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.balance(at).1
    }
    fn balance(&self, at: &At<'_>) -> (Energy, Power) {
        let (mut potential, mut dissipated) = (0.0, 0.0);
        self.each(at, |push| {
            let (force, elastic) = push.normal();
            // the elastic force of a power of the depth, times the depth over the exponent and one
            potential += elastic * push.depth / (self.law.exponent + 1.0);
            dissipated += (force - elastic) * push.rate;
        });
        self.each_bristle(at, |bristle, hold, _| dissipated += bristle.heat(hold));
        (Energy { potential, ..Energy::default() }, Power { dissipated, ..Power::default() })
    }
    fn kinked(&self) -> bool {
        self.rubs.is_some()
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        if self.rubs.is_some() { Some(self) } else { None }
    }
    fn acts(&self) -> Option<&'static str> {
        Some("contact")
    }
    fn foresees(&self) -> Option<&dyn Foresees> {
        Some(self)
    }
    fn couples(&self) -> Option<&dyn Couples> {
        Some(self)
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Couples for LineContact {
    fn renewed(&self, at: &At<'_>, anyhow: bool) -> Option<Arc<dyn Term>> {
        if !anyhow && self.near.is_fresh(&self.pieces, at) {
            return None;
        }
        Some(Arc::new(LineContact { near: Near::new(&self.pieces, at), ..self.clone() }))
    }
}

impl Shows for LineContact {
    fn columns(&self) -> Vec<Column> {
        let mut all = vec![Column::new("normal", "N"), Column::new("depth", "m"), Column::new("length", "m")];
        if self.rubs.is_some() {
            all.extend([Column::new("friction", "N"), Column::new("slipping", "1")]);
        }
        all
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        let mut normal = 0.0;
        self.each(at, |push| normal += push.normal().0);
        let near = self.near(at);
        let (curves, mut scratch) = (self.curves(&near, at), Scratch::default());
        let (mut deepest, mut length) = (0.0_f64, 0.0);
        for couple in &near.couples {
            for (pair, facing) in self.facings(couple.pieces, &curves) {
                facing.find(&mut scratch);
                for &piece in &scratch.found {
                    deepest = deepest.max(facing.deepest(piece));
                    // either of both is as long as they touch
                    length += 0.5 * (piece[1] - piece[0]) * self.pieces.all[pair[0]].length;
                }
            }
        }
        out.extend([normal, deepest, length]);
        if self.rubs.is_some() {
            let (mut held, mut slipping, mut all) = (0.0, 0.0, 0.0);
            self.each_bristle(at, |bristle, hold, pressed| {
                held += bristle.force(hold.h);
                all += pressed;
                slipping += if hold.slips { pressed } else { 0.0 };
            });
            out.extend([held, if all > 0.0 { slipping / all } else { 0.0 }]);
        }
    }
    fn remark(&self, at: &At<'_>) -> Option<String> {
        let all = [self.crowded(at), self.tight(at)];
        all.into_iter().flatten().reduce(|a, b| format!("{a}. {b}"))
    }
}
