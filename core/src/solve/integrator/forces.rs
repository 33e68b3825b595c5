//! The forces at work in each part, by which Newton's method judges what is left of the equations of motion.
//!
//! A residual is small if it is small beside the tension, the reactions and the inertia of the part that it is left in:
//! positions alone don't tell, since a stiff cable makes `EA/l` of force of every metre that they are off.

use super::norm::Norms;
use crate::model::Model;
use crate::model::constraint::RowKind;
use crate::model::node::NodeKind;
use crate::model::state::State;

/// What forces are compared with, group by group.
#[derive(Clone, Debug, Default)]
pub(crate) struct Forces {
    /// Tension at the start of the step, or most of what forces were before [N].
    present: Vec<f64>,
    /// What rounding leaves of forces with the present matrix [N].
    rounding: Vec<f64>,
    /// For every multiplier what turns it into a force, and the groups that it acts on.
    rows: Vec<(f64, Vec<usize>)>,
    /// The cables: tension is looked at in some places.
    cables: Vec<Line>,
    /// Tension in these places at the start of the step, cable by cable [N].
    seen: Vec<f64>,
    /// Of each such place tension at the start of the step before [N], its rate over the one before that [N/s], and by how much
    /// it missed the line through the two before [N].
    past: Vec<[f64; 3]>,
    /// Sums over the groups: of squares of the residual, of those of inertia; and the largest multipliers.
    residual: Vec<f64>,
    inertia: Vec<f64>,
    reaction: Vec<f64>,
}

/// What an increment makes of the tension of a cable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strained {
    /// Over what it may.
    pub ratio: f64,
    /// The number of the cable among the parts.
    pub part: usize,
    /// Where it is largest [N].
    pub off: f64,
    /// The largest force at work in the cable, or many times what rounding makes of it [N].
    pub at_work: f64,
    /// Amplitude of the waves along the cable that its tension showed in the last steps [N].
    pub wave: f64,
}

/// Whether tension swings to and fro from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Ringing {
    /// The number of a part whose tension does so by a multiple of its tolerance.
    pub part: Option<usize>,
    /// Whether a swing is large or grows from step to step: where stiff directions turn along with the motion, long steps make more of what
    /// the scheme damps in directions that stay.
    pub grows: bool,
}

/// A cable as its tension is seen.
#[derive(Clone, Debug)]
struct Line {
    /// Its number among the parts.
    part: usize,
    /// Where tension is looked at [m].
    places: Vec<f64>,
    ea: f64,
    /// A bound from below on the squares of its axial frequencies, with everything hung from it [1/s²].
    slowest: f64,
    /// Amplitude of the waves along it as of the last [`Forces::ring`], and by how much its tension swings [N].
    wave: f64,
    swing: f64,
    /// Steps in which that has grown one after the other.
    grown: u32,
    /// First coordinate and velocity of each node, and the length of the element behind it [m].
    nodes: Vec<(usize, usize, f64)>,
}

/// In how many places tension is looked at.
const PLACES: usize = 9;
/// What tension may swing by from step to step before it is told, in parts of its tolerance …
const SWING: f64 = 2.0;
/// … before steps are too long for the scheme, and the same if it grows.
const LONG: f64 = 0.5;
const GROWS: f64 = 0.1;
/// In how many steps one after the other it has grown then.
const GROWN: u32 = 2;
/// What is kept of the largest force from one step to the next: forces that pass through zero are no reason to iterate.
const MEMORY: f64 = 0.9;
/// Residuals below so many units of rounding wander instead of falling.
const NOISE: f64 = 30.0;
/// Forces of so many times what they wander by are nothing: those of a cable at rest.
const QUIET: f64 = 1e4;

/// The larger of two sizes; a NaN counts as the largest.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// What an iteration leaves of forces that it found off by `now` times their tolerance, and the one before by `before` if
/// that had the same matrix: they fall as they did. What a first iteration leaves of them is of second order, which no
/// rate tells.
pub(crate) fn left_of(now: f64, before: Option<f64>) -> f64 {
    before.map_or(now, |before| now * (now / before).min(1.0))
}

impl Forces {
    pub fn new(model: &Model, norms: &Norms) -> Self {
        let mut rows = Vec::new();
        for c in model.constraints() {
            let mut on: Vec<usize> = c.nodes().iter().map(|&k| norms.of(model.node(k).v)).collect();
            on.sort_unstable();
            on.dedup();
            // the multiplier of a direction is a moment
            let arm = on.iter().map(|&g| norms.groups[g].size).fold(0.0, f64::max);
            rows.extend(c.rows().iter().map(|kind| match kind {
                RowKind::Position => (1.0, on.clone()),
                RowKind::Direction => (1.0 / arm, on.clone()),
            }));
        }
        let mass: f64 = norms.groups.iter().map(|g| g.mass).sum();
        let cables = model.parts().iter().enumerate().filter_map(|(part, p)| {
            let (mesh, seats, ea) = (p.mesh(), p.seats(), p.slender()?.ea);
            let last = (mesh.len().checked_sub(1)?) as f64;
            let place = |i: usize| mesh[(last * i as f64 / (PLACES - 1) as f64).round() as usize];
            let mut places: Vec<f64> = (0..PLACES).map(place).collect();
            places.dedup();
            let behind = mesh.iter().skip(1).zip(mesh).map(|(b, a)| b - a).chain([0.0]);
            let length = mesh[mesh.len() - 1] - mesh[0];
            let slowest = ea / (mass * length);
            let nodes = seats.iter().zip(behind).map(|(&(q, v), l)| (q, v, l)).collect();
            Some(Line { part, places, ea, slowest, wave: 0.0, swing: 0.0, grown: 0, nodes })
        });
        let none = vec![0.0; norms.groups.len()];
        Forces {
            present: none.clone(),
            rounding: none.clone(),
            rows,
            cables: cables.collect(),
            seen: Vec::new(),
            past: Vec::new(),
            residual: none.clone(),
            inertia: none.clone(),
            reaction: none,
        }
    }

    /// Looks at the forces at the start of a step.
    pub fn look(&mut self, model: &Model, norms: &Norms, state: &State) {
        self.present.fill(0.0);
        for (p, m) in self.present.iter_mut().zip(&state.control.forces) {
            *p = MEMORY * m;
        }
        // what holds a spinning body together is at work too
        for node in model.nodes().iter().filter(|n| n.kind == NodeKind::Frame) {
            let spin = node.dofs().skip(3).map(|i| norms.mass[i] * state.v[i].powi(2)).fold(0.0, f64::max);
            let present = &mut self.present[norms.of(node.v)];
            *present = present.max(spin);
        }
        self.seen.clear();
        for Line { part, places, .. } in &self.cables {
            for &s in places {
                let line = model.parts()[*part].line();
                let tension = line.and_then(|line| line.pulls(s, &state.at())).unwrap_or(0.0);
                self.present[*part] = self.present[*part].max(tension.abs());
                self.seen.push(tension);
            }
        }
    }

    /// Notes what rounding of positions makes of forces, with the diagonal of an iteration matrix over `β h²`.
    pub fn round(&mut self, norms: &Norms, stiffness: impl Fn(usize) -> f64) {
        let u = 0.5 * f64::EPSILON;
        norms.sums(
            |i| {
                let group = &norms.groups[norms.of(i)];
                // slopes and rotations are of the size of one, and act by an arm
                let off = if norms.arm[i] == 1.0 { group.rounding * group.length } else { u * norms.arm[i] };
                (stiffness(i).max(0.0) * off).powi(2)
            },
            &mut self.rounding,
        );
        self.rounding.iter_mut().for_each(|r| *r = NOISE * r.sqrt());
    }

    /// The residual over `tolerance` times the forces at work, in the part where that is largest; at accelerations `a` and
    /// multipliers `lambda`. Below one it is small enough.
    pub fn ratio(
        &mut self,
        norms: &Norms,
        residual: &[f64],
        a: &[f64],
        lambda: &[f64],
        tolerance: f64,
    ) -> f64 {
        norms.squares(&norms.arm, residual, &mut self.residual);
        norms.squares(&norms.mass, a, &mut self.inertia);
        self.reaction.fill(0.0);
        for ((scale, on), l) in self.rows.iter().zip(lambda) {
            for &g in on {
                self.reaction[g] = self.reaction[g].max((scale * l).abs());
            }
        }
        (0..self.residual.len()).fold(0.0, |worst, g| {
            let limit = tolerance * self.at_work(g) + self.rounding[g];
            larger(worst, self.residual[g].sqrt() / limit.max(f64::MIN_POSITIVE))
        })
    }

    /// What an increment `d` of the configuration `q` changes tensions by, over `tolerance` times the forces at work as of
    /// the last [`Forces::ratio`], in the cable where that is largest: at nodes and in the middle of elements.
    pub fn strained(&self, q: &[f64], d: &[f64], tolerance: f64) -> Strained {
        let mut worst = Strained::default();
        for line in &self.cables {
            let mut most = 0.0;
            for (k, &(x, i, l)) in line.nodes.iter().enumerate() {
                let along = |slope: [f64; 3], change: [f64; 3]| {
                    slope.iter().zip(change).map(|(s, c)| s * c).sum::<f64>().abs()
                };
                let three = |of: &[f64], at: usize| [of[at], of[at + 1], of[at + 2]];
                let (slope, change) = (three(q, x + 3), three(d, i + 3));
                most = larger(most, along(slope, change));
                if let Some(&(y, j, _)) = line.nodes.get(k + 1) {
                    // the slope of the Hermite cubic in the middle
                    let middle = |of: &[f64], a: usize, b: usize| {
                        std::array::from_fn(|c| {
                            1.5 * (of[b + c] - of[a + c]) / l - 0.25 * (of[a + 3 + c] + of[b + 3 + c])
                        })
                    };
                    most = larger(most, along(middle(q, x, y), middle(d, i, j)));
                }
            }
            // where nothing pulls, what iterations leave is all there is
            let (part, off, noise) = (line.part, line.ea * most, 10.0 * self.rounding[line.part]);
            let allowed = tolerance * self.at_work(part) + noise;
            let ratio = off / allowed.max(f64::MIN_POSITIVE);
            if !(ratio <= worst.ratio) {
                let at_work = self.at_work(part).max(QUIET * noise);
                worst = Strained { ratio, part, off, at_work, wave: line.wave };
            }
        }
        worst
    }

    /// The largest force in a group as of the last [`Forces::ratio`] [N].
    fn at_work(&self, g: usize) -> f64 {
        self.present[g].max(self.inertia[g].sqrt()).max(self.reaction[g])
    }

    /// Looks whether the tension of a cable swings to and fro from step to step, as seen at the start of the step that ends; `h` is
    /// the one before [s]. Waves that steps resolve bend to the other side now and then, those that they don't in every step. Notes how
    /// large the waves are as well.
    pub fn ring(&mut self, h: f64, tolerance: f64) -> Ringing {
        let mut ringing = Ringing::default();
        if self.past.len() != self.seen.len() || !(h > 0.0) {
            self.past.clear();
            // without a rate nothing is missed, and nothing swings
            self.past.extend(self.seen.iter().map(|&tension| [tension, f64::NAN, f64::NAN]));
            return ringing;
        }
        let mut places = self.past.iter_mut().zip(&self.seen);
        for line in &mut self.cables {
            let before = line.swing;
            (line.wave, line.swing) = (0.0, 0.0);
            for ([last, rate, missed], &tension) in places.by_ref().take(line.places.len()) {
                let misses = tension - (*last + *rate * h);
                // a swing of one to either side misses by four
                if misses * *missed < 0.0 {
                    line.swing = line.swing.max(0.25 * misses.abs().min(missed.abs()));
                }
                // a wave that steps resolve by its square of angle
                line.wave = line.wave.max(misses.abs() / (line.slowest * h * h).min(4.0));
                (*last, *rate, *missed) = (tension, (tension - *last) / h, misses);
            }
            let most = |part: f64| part * tolerance * self.present[line.part] + self.rounding[line.part];
            if line.swing > most(SWING) {
                ringing.part = Some(line.part);
            }
            line.grown = if line.swing > most(GROWS).max(before) { line.grown + 1 } else { 0 };
            ringing.grows |= line.grown >= GROWN || line.swing > most(LONG);
        }
        ringing
    }

    /// Remembers the forces of an accepted step.
    pub fn keep(&self, memory: &mut Vec<f64>) {
        memory.clear();
        memory.extend((0..self.present.len()).map(|g| self.at_work(g)));
    }
}
