//! Kelvin–Voigt damping of bending where sections turn.

use super::directed::{self, ANGLES, BUBBLE, Section, VARIABLES, count, derivatives, dofs, twisting};
use super::quadrature::{Point, Points, Quadrature};
use super::twisting::{SECOND, Twisting, three, times};
use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Element, Local, Power, Real, Share, Weights};

/// Damping of bending in a cable with torsion: the moments `η EI_d K̇_d` and `η EI_e K̇_e` about both directors of the section,
/// besides the elastic ones.
///
/// The rates are those in axes of the section, so a bent cable that spins about its own axis is damped: its fibres are strained to
/// and fro. A motion as of a rigid body loses nothing. Of a shaft that turns at `Ω` and whirls at `ω` with small deflections
/// the power lost goes with `(ω - Ω)²`: above its critical speed damping inside of it drives the whirl on (Kimball, Phil. Mag.
/// 49 (1925) 724).
///
/// It stands on two nodes of kind [`Twist`](ropewalk_core::NodeKind::Twist), and on the bubble of a [`Directed`](super::Directed)
/// element if there is one.
#[derive(Clone, Copy, Debug)]
pub struct SectionDamping {
    /// Unstretched length [m].
    pub l: f64,
    /// `η EI` about the first director and the second [N m² s], which without a bubble are alike.
    pub eta_ei: [f64; 2],
    /// Where the curvature is taken.
    pub rule: Points,
}

/// The same over lanes.
#[derive(Clone, Copy, Debug)]
pub struct SectionDampingLanes<R> {
    l: R,
    eta_ei: [R; 2],
    rule: Points,
}

impl SectionDamping {
    /// For an element of length `l`.
    pub fn new(l: f64, eta_ei: [f64; 2], rule: impl Quadrature) -> Self {
        SectionDamping { l, eta_ei, rule: Points::of(rule) }
    }
}

/// Derivatives of a curvature by the variables.
type Gradient<R> = [R; VARIABLES];

/// An element as it moves.
struct Moving<R> {
    x: [R; directed::COORDINATES],
    twisting: Twisting<R>,
    il: R,
    /// Rates of the variables.
    v: Gradient<R>,
    /// What two rotations of a node one after the other add to the change of a rate, over its derivative by the angle there.
    turns: [[R; 3]; 2],
}

impl<R: Real> Moving<R> {
    #[inline(always)]
    fn new<const C: usize, const V: usize>(l: R, at: &Local<R, C, V>) -> Self {
        let il = R::of(1.0) / l;
        let mut x = [R::zero(); directed::COORDINATES];
        x[..C].copy_from_slice(&at.q);
        let twisting = if V < directed::VELOCITIES { derivatives(&x, il) } else { twisting(&x, il) };
        let mut v = [R::zero(); VARIABLES];
        for (i, v) in v.iter_mut().enumerate() {
            for &(dof, share) in &dofs(i, il)[..counted::<V>(i)] {
                *v = share.fma(at.v[dof], *v);
            }
        }
        let mut turns = [[R::zero(); 3]; 2];
        for (turn, (end, at_v)) in turns.iter_mut().zip([(0, 3), (2, SECOND + 3)]) {
            let i = twisting.inverse[end];
            *turn = times(R::of(-0.5) * i * i, &cross(&twisting.e[end], &three(&at.v, at_v)));
        }
        Moving { x, twisting, il, v, turns }
    }

    /// The section at a point: without a bubble all directions are alike.
    #[inline(always)]
    fn section<const V: usize>(&self, at: &Point) -> Section<R> {
        if V < directed::VELOCITIES {
            Section::turned(&self.x, &self.twisting, at, self.il, None)
        } else {
            Section::new(&self.x, &self.twisting, at, self.il)
        }
    }

    #[inline(always)]
    fn rate(&self, by: &Gradient<R>) -> R {
        let mut sum = R::zero();
        for i in 0..VARIABLES {
            sum = by[i].fma(self.v[i], sum);
        }
        sum
    }

    /// How the rate of a curvature changes with the variables while velocities stay.
    #[inline(always)]
    fn change(&self, section: &Section<R>, which: usize, by: &Gradient<R>) -> Gradient<R> {
        let (one, zero) = (R::of(1.0), R::zero());
        let moments = if which == 0 { [one, zero] } else { [zero, one] };
        let (mut f, mut h) = ([zero; VARIABLES], [[zero; VARIABLES]; VARIABLES]);
        section.add::<true>(&self.twisting, one, moments, zero, self.il, &mut f, &mut h);
        let mut out = [zero; VARIABLES];
        for i in 0..VARIABLES {
            out[i] = self.rate(&h[i]);
        }
        for (end, (slope, angle)) in [(0, ANGLES), (6, ANGLES + 1)].into_iter().enumerate() {
            for c in 0..3 {
                out[slope + c] = by[angle].fma(self.turns[end][c], out[slope + c]);
            }
        }
        out
    }
}

/// How many increments of an element with so many velocities a variable is made of: without a bubble none makes one.
#[inline(always)]
fn counted<const V: usize>(variable: usize) -> usize {
    if variable == BUBBLE && V < directed::VELOCITIES { 0 } else { count(variable) }
}

impl<R: Real> SectionDampingLanes<R> {
    #[inline(always)]
    fn of(batch: &Batch<'_, SectionDamping>) -> Self {
        let eta_ei = [batch.get(|e| e.eta_ei[0]), batch.get(|e| e.eta_ei[1])];
        SectionDampingLanes { l: batch.get(|e| e.l), eta_ei, rule: batch.first().rule }
    }

    #[inline(always)]
    fn add<const C: usize, const V: usize, const TANGENT: bool>(
        &self,
        x: &Local<R, C, V>,
        w: &Weights,
        out: &mut Share<R, V>,
    ) {
        let (moving, zero) = (Moving::new(self.l, x), R::zero());
        let (wq, wv) = (R::of(w.q), R::of(w.v));
        let (mut f, mut h) = ([zero; VARIABLES], [[zero; VARIABLES]; VARIABLES]);
        let mut k = [[zero; VARIABLES]; VARIABLES];
        for at in self.rule.points() {
            let section = moving.section::<V>(at);
            let by = section.gradients(&moving.twisting, moving.il);
            let s = R::of(at.w) * self.l;
            let m = [self.eta_ei[0] * moving.rate(&by[0]), self.eta_ei[1] * moving.rate(&by[1])];
            if !TANGENT {
                for i in 0..VARIABLES {
                    f[i] = s.fma(m[0].fma(by[0][i], m[1] * by[1][i]), f[i]);
                }
                continue;
            }
            section.add::<true>(&moving.twisting, s, m, zero, moving.il, &mut f, &mut h);
            for which in 0..2 {
                let change = moving.change(&section, which, &by[which]);
                for i in 0..VARIABLES {
                    let row = s * self.eta_ei[which] * by[which][i];
                    for j in 0..VARIABLES {
                        k[i][j] += row * wv.fma(by[which][j], wq * change[j]);
                    }
                }
            }
        }
        for i in 0..VARIABLES {
            for &(row, by_row) in &dofs(i, moving.il)[..counted::<V>(i)] {
                out.r[row] = by_row.fma(f[i], out.r[row]);
                if !TANGENT {
                    continue;
                }
                for j in 0..VARIABLES {
                    for &(column, by_column) in &dofs(j, moving.il)[..counted::<V>(j)] {
                        out.k[row][column] += by_row * by_column * wq.fma(h[i][j], k[i][j]);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn power<const C: usize, const V: usize>(&self, x: &Local<R, C, V>) -> Power<R> {
        let moving = Moving::new(self.l, x);
        let mut dissipated = R::zero();
        for at in self.rule.points() {
            let section = moving.section::<V>(at);
            let by = section.gradients(&moving.twisting, moving.il);
            for which in 0..2 {
                let rate = moving.rate(&by[which]);
                dissipated += R::of(at.w) * self.l * self.eta_ei[which] * rate * rate;
            }
        }
        Power { dissipated, ..Power::zero() }
    }
}

/// On two nodes, and with a bubble as a third.
macro_rules! on_nodes {
    ($coordinates:literal, $velocities:literal, $wide:literal) => {
        impl Element<$coordinates, $velocities> for SectionDamping {
            type Lanes<R: Real> = SectionDampingLanes<R>;
            const WIDE: bool = $wide;

            fn label(&self) -> String {
                format!("bending damping of sections {}", self.rule.label())
            }
            fn symmetric(&self) -> bool {
                false
            }
            fn has_tangent(w: &Weights) -> bool {
                w.q != 0.0 || w.v != 0.0
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> SectionDampingLanes<R> {
                SectionDampingLanes::of(batch)
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                lanes: &SectionDampingLanes<R>,
                x: &Local<R, $coordinates, $velocities>,
                w: &Weights,
                out: &mut Share<R, $velocities>,
            ) {
                lanes.add::<$coordinates, $velocities, TANGENT>(x, w, out);
            }
            #[inline(always)]
            fn power<R: Real>(
                lanes: &SectionDampingLanes<R>,
                x: &Local<R, $coordinates, $velocities>,
            ) -> Power<R> {
                lanes.power::<$coordinates, $velocities>(x)
            }
        }
    };
}

on_nodes!(20, 14, true);
// its code is long, and wide copies of it take longer to compile than they save
on_nodes!(21, 15, false);
