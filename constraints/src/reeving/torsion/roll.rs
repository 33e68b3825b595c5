//! The twist of a cable that comes to its groove by a fleet angle and rolls down the flank.

use super::shape::Shape;
use super::{ArcTorsion, CARRIER, MOST, SECOND, leave_out, of_groove};
use crate::reeving::flank::Flank;
use crate::reeving::hold::Mode;
use crate::reeving::inline::{each, three};
use crate::reeving::local::Local;
use ropewalk_core::rotation::{along, cross, transposed_times};
use ropewalk_core::{
    Assembly, At, Column, Jet, Pattern, Power, Residuals, Seeds, Shows, Term, V3, Weights, tangent,
};

/// What rolls the cable in a groove, at both ends of what lies there.
///
/// Cable that passes a tangent point at the rate `Ṗ` by the slope `p` comes down to the groove at the speed `Ṗ a·p` along its axis `a`,
/// about which it turns. Rolling without slip its section would spin at `w = 2 Ṗ a·p/D` against the wheel's carrier, about its
/// tangent, whichever flank that is. Friction drives the section that arrives towards a share `f` of this by a torque of at most
/// `μ T sin δ D/2`: as it is turned into the groove by the force `T sin δ`. That is so where it leaves too, but there it is lifted
/// off without rolling.
///
/// The torque works on the material, whose twist steps there: on the spin of the node, and by its mean `K` on the boundary. What it
/// takes to roll is friction against the way down, and so against the cable's run: the force `2 f τ a·p/(D λ)` along the groove, and
/// back on the carrier, as is the torque. All that is lost is the torque times the spin by which it slides, and where the tangent point
/// moves round the wheel, work of that force, of either sign.
pub(in crate::reeving) struct Rolls {
    pub torsion: ArcTorsion,
    pub flank: Flank,
}

/// What the term of this wheel is called.
pub(in crate::reeving) fn label(wheel: &str) -> String {
    format!("{wheel}: roll")
}

/// Sine of a fleet angle below which there is no flank.
const NONE: f64 = 1e-8;

impl Rolls {
    /// Residual, and the torque on the cable at both ends, after increments of the unknowns from where the twist is as given.
    #[inline(always)]
    fn eval<S: Jet>(&self, at: &At<'_>, x: &Local<S, MOST>, shape: &Shape<f64>) -> ([S; MOST], [S; 2]) {
        let (mut r, mut torques) = ([S::zero(); MOST], [S::zero(); 2]);
        let groove = self.torsion.at();
        let Some(twist) = groove.twist else { return (r, torques) };
        let Flank { share, radius, friction, .. } = self.flank;
        let hub = self.torsion.hub(at, &x.d);
        let axis = each!(hub.axis, |a| a * groove.side());
        let p = |k: usize| x.d[SECOND * k + 7] + at.q[groove.ends[k].q];
        let angle = shape.by_twist.iter().zip(&x.d).fold(S::from(shape.twist), |sum, (g, d)| sum + *d * *g);
        let length = p(1) - p(0) + groove.stored;
        let twisted = angle / length;
        // of a laid rope, as friction sees it
        let pulls = (S::from(twist.last(at)) / length - twist.torsion.free) * twist.torsion.lay;
        let omega: V3<S> = three!(|i| match &hub.turn {
            Some(turn) => along(&turn[i], &three!(|j| x.v[CARRIER + 3 + j])),
            None => S::zero(),
        });
        for (k, end) in groove.ends.iter().enumerate() {
            let i = SECOND * k;
            let [place, slope] = self.torsion.end(k, at, &x.d);
            let stretch = along(&slope, &slope).sqrt();
            let (t, lean) = (each!(slope, |p| p / stretch), along(&axis, &slope));
            if lean.re().abs() <= NONE * stretch.re() {
                continue;
            }
            let rate = x.v[i + 7];
            let pull = (stretch - 1.0) * groove.arc.strand.ea + pulls;
            let presses = pull - stretch * rate * rate * groove.arc.strand.mass;
            if presses.re() <= 0.0 {
                continue;
            }
            let comes = -(stretch * rate * end.sign);
            let sine = lean * lean.re().signum() / stretch;
            let most = presses * sine * (friction * radius);
            let gear = lean * self.flank.enters(comes) * (share / radius);
            let gap = gear * rate - (x.v[i + 6] - rate * twisted - along(&omega, &t));
            let flow = -(rate * (end.sign / twist.torsion.gj));
            let torque = self.flank.torque(gap, most, flow);
            // the twist between that before the torque and behind it
            let mean = twisted + torque * (0.5 * end.sign / twist.torsion.gj);
            let drag = torque * gear / stretch;
            let out: V3<S> = three!(|c| place[c] - hub.centre[c]);
            let beside = along(&axis, &out);
            let flat: V3<S> = three!(|c| out[c] - axis[c] * beside);
            let far = along(&flat, &flat).sqrt();
            let force = each!(cross(&axis, &flat), |f| f * drag / far);
            for c in 0..3 {
                r[i + c] -= force[c];
            }
            r[i + 6] -= torque;
            r[i + 7] += torque * mean + drag * stretch;
            let size = self.torsion.sheave.seat.size();
            if size > 0 {
                (0..3).for_each(|c| r[CARRIER + c] += force[c]);
            }
            if let Some(turn) = &hub.turn {
                let lever: V3<S> = three!(|c| out[c] + hub.arm[c]);
                let moment = cross(&lever, &force);
                let all = three!(|c| moment[c] + t[c] * torque);
                let own = transposed_times(turn, &all);
                (0..3).for_each(|c| r[CARRIER + 3 + c] += own[c]);
            }
            torques[k] = torque;
        }
        (r, torques)
    }

    /// Where it lies in its groove: the motion, and its twist there.
    fn lies(&self, at: &At<'_>) -> Option<(Local<f64, MOST>, Shape<f64>)> {
        let wraps = Mode::of(at.internal, self.torsion.at().mode) == Mode::Wraps;
        let torsion = &self.torsion;
        wraps.then(|| {
            let now = [torsion.twist_now(at), torsion.length(at)];
            (Local::of(&torsion.dofs(), at), torsion.shaped(at, &[0.0; MOST], now))
        })
    }
}

/// A cable that rolls at an instant.
struct On<'a> {
    rolls: &'a Rolls,
    at: &'a At<'a>,
    x: &'a Local<f64, MOST>,
    w: Weights,
    shape: &'a Shape<f64>,
}

impl Residuals<MOST> for On<'_> {
    #[inline(always)]
    fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; MOST] {
        self.rolls.eval(self.at, &self.x.along(self.w, seeds), self.shape).0
    }
}

impl Term for Rolls {
    fn label(&self) -> String {
        label(&self.torsion.sheave.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        self.torsion.pattern(p);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let Some((x, shape)) = self.lies(at) else { return };
        let (dofs, w) = (self.torsion.dofs(), out.weights());
        let (force, torques) = self.eval(at, &x, &shape);
        for (dof, r) in dofs.iter().zip(force) {
            out.add(*dof, r);
        }
        if !out.wants_tangent() {
            return;
        }
        let mut block = [[0.0; MOST]; MOST];
        tangent(&On { rolls: self, at, x: &x, w, shape: &shape }, dofs.len(), &mut block);
        leave_out(&self.torsion.at().ends, at, w.q, torques.map(|t| -t), &mut block);
        out.add_square(0, &block);
    }
    fn power(&self, at: &At<'_>) -> Power {
        let Some((x, shape)) = self.lies(at) else { return Power::default() };
        let (force, _) = self.eval(at, &x, &shape);
        Power { dissipated: force.iter().zip(&x.v).map(|(r, v)| r * v).sum(), ..Power::default() }
    }
    fn shows(&self) -> Option<&dyn Shows> {
        Some(self)
    }
}

impl Shows for Rolls {
    fn columns(&self) -> Vec<Column> {
        let prefix = of_groove(&self.torsion.sheave, self.torsion.groove);
        ["in", "out"].map(|end| Column::new(format!("{prefix}{end}.roll"), "N m")).to_vec()
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        out.extend(self.lies(at).map_or([0.0; 2], |(x, shape)| self.eval(at, &x, &shape).1));
    }
}
