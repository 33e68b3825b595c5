//! A cable that meets its wheel from the side: what turns it into the groove.

use super::hold::Mode;
use super::inline::{each, three};
use super::local::from;
use super::seat::{Seat, turned};
use ropewalk_core::rotation::{along, cross, times, transposed_times};
use ropewalk_core::{
    Assembly, At, Jet, MovingBoundary, Pattern, Power, Residuals, Seeds, Term, V3, Weights, tangent,
};
use ropewalk_scene::Strand;

/// The end of a span that comes by a fleet angle `δ` turns sharply into the plane of the groove, as in a ring that stands
/// there on what carries the wheel.
///
/// The tension `T` is the same before and behind, so with the direction `t` of the span and `f` of the groove the groove pushes
/// by `G = (T - q)(t - f)`, where `q = m λ P'²` turns the momentum. Its part along the axis is the multiplier of `a·d = x`. What
/// is left is `T (1 - cos δ)` along `f`, which would else be a moment of `T R (1 - cos δ)` on the direction of the span: no cable
/// without bending stiffness has that, and a finer mesh would bend the more.
///
/// Material runs through without work. Where the tangent point moves round the wheel, `G` does work of the order
/// `T R δ²/2` by angle, of either sign: a tangent in the plane of the groove isn't the shortest way there. It counts as dissipated.
/// Whether an equilibrium is stable isn't for an error of that order to say: where material stands still, a tangent that is to tell
/// takes the tension that turns as it is, and the mean of what is left and its mirror image.
pub(super) struct Fleet {
    pub name: String,
    pub boundary: MovingBoundary,
    pub seat: Seat,
    pub strand: Strand,
    /// Place of the internal variable that says whether the cable is on the wheel, if it may leave it.
    pub mode: Option<usize>,
}

/// Unknowns: the end of the span and its slope, the material coordinate there, what carries the wheel.
const MOST: usize = 13;

/// Sine of a fleet angle below which there is nothing to turn.
const NONE: f64 = 1e-8;

/// Forces by the turn, from the place of the end and its slope, centre and axis of the wheel.
struct Turn<S> {
    /// On the end, what momentum takes included [N].
    end: V3<S>,
    /// Of the groove along itself, on the end [N].
    groove: V3<S>,
}

impl Fleet {
    /// `flux` is `m P'²`; `stiff` whether the tension changes with the stretch.
    #[inline(always)]
    fn turn<S: Jet>(&self, d: &V3<S>, slope: &V3<S>, axis: &V3<S>, flux: S, stiff: bool) -> Turn<S> {
        let beside = along(axis, d);
        let flat: V3<S> = three!(|i| d[i] - axis[i] * beside);
        let radius = along(&flat, &flat).sqrt();
        let round = each!(cross(axis, &flat), |x| x / radius);
        let size = along(slope, slope).sqrt();
        let way = along(&round, slope);
        // the groove runs on as the cable does; it pulls at the end of a span forwards, at its start backwards
        let side = if way.re() < 0.0 { -1.0 } else { 1.0 };
        let pulls = each!(round, |x| x * (side * self.boundary.sign));
        let left = -(way * side / size) + 1.0;
        let strain = size - 1.0;
        let tension = if stiff { strain } else { S::from(strain.re()) } * self.strand.ea;
        let sideways = along(axis, slope) * (flux * self.boundary.sign);
        Turn {
            end: three!(|i| axis[i] * sideways - pulls[i] * tension * left),
            groove: each!(pulls, |x| x * -(tension - size * flux) * left),
        }
    }

    /// Residual of its unknowns after increments of them, and of the rate of the material; and the force of the groove.
    #[inline(always)]
    fn eval<S: Jet>(&self, at: &At<'_>, x: &[S; MOST], rate: S) -> ([S; MOST], V3<S>) {
        let q = self.boundary.end_q;
        let r: V3<S> = three!(|i| x[i] + at.q[q + i]);
        let slope: V3<S> = three!(|i| x[3 + i] + at.q[q + 3 + i]);
        let (arm, own) = (each!(self.seat.point, |x| S::from(x)), each!(self.seat.axis, |x| S::from(x)));
        let mut turn = None;
        let (foot, c, axis) = match self.seat.on {
            None => ([S::zero(); 3], arm, own),
            Some((q, _, turns)) => {
                let foot: V3<S> = three!(|i| x[7 + i] + at.q[q + i]);
                if turns {
                    let m = turned(at, q, &from(x, 10));
                    turn = Some(m);
                    let out = times(&m, &arm);
                    (foot, three!(|i| foot[i] + out[i]), times(&m, &own))
                } else {
                    (foot, foot, own)
                }
            }
        };
        let d: V3<S> = three!(|i| r[i] - c[i]);
        let rate = rate + at.v[self.boundary.v];
        let Turn { end, groove } =
            self.turn(&d, &slope, &axis, rate * rate * self.strand.mass, !self.is_judged(at));
        let mut out = [S::zero(); MOST];
        for i in 0..3 {
            (out[i], out[7 + i]) = (-end[i], groove[i]);
        }
        if let Some(m) = turn {
            let lever: V3<S> = three!(|i| r[i] - foot[i]);
            out[10..].copy_from_slice(&transposed_times(&m, &cross(&lever, &groove)));
        }
        (out, groove)
    }

    fn dofs(&self) -> Vec<usize> {
        let (end, front) = (self.boundary.end_v, self.boundary.v);
        let own = (end..end + 6).chain([front]);
        own.chain(self.seat.on.into_iter().flat_map(|(_, v, _)| v..v + self.seat.size())).collect()
    }

    /// Whether the tangent is to tell stable from unstable where material stands still.
    fn is_judged(&self, at: &At<'_>) -> bool {
        at.relaxed.is_some_and(|r| r.how.judges) && at.v[self.boundary.v] == 0.0
    }

    /// Whether there is something to turn.
    fn acts(&self, at: &At<'_>) -> bool {
        if self.mode.is_some_and(|mode| Mode::of(at.internal, mode) != Mode::Wraps) {
            return false;
        }
        let slope: V3<f64> = std::array::from_fn(|i| at.q[self.boundary.end_q + 3 + i]);
        let axis = self.seat.axis_now(at);
        along(&axis, &slope).powi(2) > NONE * NONE * along(&slope, &slope)
    }
}

/// Makes a matrix the mean of itself and its mirror image.
fn mirror(block: &mut [[f64; MOST]; MOST]) {
    for i in 0..MOST {
        for j in 0..i {
            let mean = 0.5 * (block[i][j] + block[j][i]);
            (block[i][j], block[j][i]) = (mean, mean);
        }
    }
}

/// An end by its fleet angle at an instant.
struct On<'a> {
    fleet: &'a Fleet,
    at: &'a At<'a>,
    w: Weights,
}

impl Residuals<MOST> for On<'_> {
    #[inline(always)]
    fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; MOST] {
        let mut towards = [S::zero(); MOST];
        for (i, x) in towards.iter_mut().enumerate() {
            *x = seeds.of(i, 0.0, self.w.q);
        }
        self.fleet.eval(self.at, &towards, seeds.of(6, 0.0, self.w.v)).0
    }
}

impl Term for Fleet {
    fn label(&self) -> String {
        format!("{}: fleet", self.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        p.clique(self.dofs());
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        if !self.acts(at) {
            return;
        }
        let (dofs, w) = (self.dofs(), out.weights());
        let (residual, _) = self.eval(at, &[0.0; MOST], 0.0);
        for (dof, r) in dofs.iter().zip(residual) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let mut block = [[0.0; MOST]; MOST];
        tangent(&On { fleet: self, at, w }, dofs.len(), &mut block);
        if self.is_judged(at) {
            mirror(&mut block);
        }
        out.add_square(0, &block);
    }
    fn power(&self, at: &At<'_>) -> Power {
        if !self.acts(at) {
            return Power::default();
        }
        let (_, groove) = self.eval(at, &[0.0; MOST], 0.0);
        let (q, v) = (self.boundary.end_q, self.boundary.end_v);
        let place: V3<f64> = std::array::from_fn(|i| at.q[q + i]);
        let carried = self.seat.velocity(at, &place);
        let work = (0..3).map(|i| groove[i] * (at.v[v + i] - carried[i])).sum::<f64>();
        Power { dissipated: -work, ..Power::default() }
    }
}
