//! The steady balloon: the shape at rest in the frame that turns with the lift-off point.
//!
//! It solves the same equations on the same grid as the motion in time, with `ẋ = Ω × x` and `ẍ = Ω × ẋ`. A balloon of given
//! tension is found along the family of balloons of growing length, which begins with a nearly straight cable under a
//! high tension: over the length, the tension at the eyelet has one value only, but it may have a least one (a fold),
//! below which there is no steady balloon.

use super::Rule;
use super::history::Shape;
use super::problem::{LiftOff, Unwinding};
use super::start::cross;
use super::state::{Column, M3, Now, Rates, State, identity, length, minus, plus, product};
use ropewalk_core::{BuildError, V3, dot};
use ropewalk_scene::Current;

/// A steady balloon.
#[derive(Clone, Debug)]
pub struct Balloon {
    /// Shape with tensions and curvatures.
    pub shape: Shape,
    /// Tension at the eyelet [N].
    pub tension: f64,
    /// Tension at the lift-off point [N]; with bending stiffness it may be negative.
    pub lift_tension: f64,
    /// Angular velocity about the axis [rad/s].
    pub spin: f64,
    /// Length peeled before [m].
    pub peeled: f64,
    state: State,
}

/// Why there is no steady balloon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SteadyError {
    /// The tension is below the fold of the family.
    #[error(
        "there is no steady balloon with {tension} N at the eyelet: below {least:.6} N (at a free length of \
         {length:.6} m) none exists; give a higher tension or a lower speed"
    )]
    Nothing {
        /// Tension asked for [N].
        tension: f64,
        /// Least tension at the eyelet for which a balloon exists [N].
        least: f64,
        /// Free length of the balloon at this tension [m].
        length: f64,
    },
    /// The family could not be followed as far as that.
    #[error(
        "the steady balloon with {tension} N at the eyelet was not found: the balloons could be followed down to \
         {reached:.6} N, at a free length of {length:.6} m; try more segments or a higher tension"
    )]
    Lost {
        /// Tension asked for [N].
        tension: f64,
        /// The last tension with a balloon [N].
        reached: f64,
        /// Free length of that balloon [m].
        length: f64,
    },
    /// The data make no sense.
    #[error("{0}")]
    Input(#[from] BuildError),
}

/// What stays as it is while Newton's method runs.
struct Frame<'a> {
    problem: &'a Unwinding,
    now: Now,
    spin: V3<f64>,
}

/// A member of the family.
#[derive(Clone)]
struct Member {
    y: State,
    tension: f64,
}

impl Member {
    fn length(&self) -> f64 {
        self.y.length[0]
    }
}

impl Unwinding {
    /// The steady balloon with a tension at the eyelet [N] when the cable is drawn at a speed [m/s] and `peeled` [m] have
    /// been peeled. The lift-off point turns about the axis and stays at its height; the eyelet lies on the axis. A cable that is neither
    /// drawn nor heavy is straight, or bent by the package alone.
    ///
    /// # Errors
    /// See [`SteadyError`].
    pub fn steady(&self, speed: f64, tension: f64, peeled: f64) -> Result<Balloon, SteadyError> {
        self.check()?;
        ropewalk_core::error::positive("tension", tension)?;
        ropewalk_core::error::not_negative("speed", speed)?;
        let mut hinged = self.clone();
        hinged.lift_off = LiftOff::Free;
        let Some(now) = self.now(0.0, peeled) else {
            return Err(BuildError::at("peeled", format!("{peeled} m can't have been peeled")).into());
        };
        let now = Now { speed: [speed, 0.0], ..now };
        let arm = minus(&now.lay.x, &self.eyelet);
        let axis = self.path.axis();
        let across = plus(&arm, -dot(&arm, &axis), &axis);
        let round = cross(&axis, &across);
        let rate = speed * dot(&round, &now.lay.tangent) / dot(&across, &across);
        let spin = axis.map(|a| rate * a);
        let off = self.path.cylindrical(&self.eyelet)[0];
        if !(off <= 1e-9 * length(&arm)) {
            let message =
                format!("a steady balloon needs the eyelet on the axis, but it is {off} m beside it");
            return Err(BuildError::at("eyelet", message).into());
        }
        let across = |x: &V3<f64>| length(&plus(x, -dot(x, &axis), &axis)) > 1e-12 * length(x);
        let still = |u: &Current| match u {
            Current::Still => true,
            Current::Uniform(u) => !across(u),
            _ => false,
        };
        if across(&self.weight) || self.drag.as_ref().is_some_and(|d| !still(&d.current)) {
            let message = "weight or current across the axis shakes the balloon as it turns: none is steady; take \
                           them along the axis, or none";
            return Err(BuildError::at("weight", message).into());
        }
        let frame = Frame { problem: &hinged, now, spin };
        let mut found = frame.follow(tension)?;
        let mut problem = &hinged;
        if self.lift_off == LiftOff::Tangent {
            found = self.turn(found, now, spin, tension)?;
            problem = self;
        }
        let lift_tension = problem.tensions(&found.y, &now)[1];
        let shape = problem.shape(&found.y, &now);
        found.y.peeled[0] = peeled;
        Ok(Balloon { shape, tension: found.tension, lift_tension, spin: rate, peeled, state: found.y })
    }

    /// The state that begins in a steady balloon.
    ///
    /// # Errors
    /// As [`Unwinding::start`].
    pub fn start_steady(&self, balloon: &Balloon) -> Result<State, BuildError> {
        let mut y = balloon.state.clone();
        let Some(now) = self.now(y.t, balloon.peeled) else {
            return Err(BuildError::at("peeled", "the package is empty at the start"));
        };
        let speed = balloon.state.peeled[1];
        if !((now.speed[0] - speed).abs() <= 1e-9 * speed.abs()) {
            let message = format!(
                "the balloon is steady at {speed} m/s, but the cable is drawn at {} m/s",
                now.speed[0]
            );
            return Err(BuildError::at("feed", message));
        }
        self.accelerate(&mut y, &now, 0.0)?;
        Ok(y)
    }

    /// Turns the cable at the lift-off point from where a hinge leaves it to where it is held.
    fn turn(&self, from: Member, now: Now, spin: V3<f64>, tension: f64) -> Result<Member, SteadyError> {
        let n = self.elements;
        let d = minus(&from.y.x[n], &from.y.x[n - 1]);
        let begin = d.map(|x| x / length(&d));
        let angle = dot(&begin, &now.clamp).clamp(-1.0, 1.0).acos();
        let (mut done, mut stride, mut member) = (0.0, 0.1_f64, from);
        while done < 1.0 {
            let share = (done + stride).min(1.0);
            // on the great circle between both
            let (a, b) = (((1.0 - share) * angle).sin(), (share * angle).sin());
            let clamp = if angle < 1e-6 || share == 1.0 {
                now.clamp
            } else {
                [0, 1, 2].map(|i| (a * begin[i] + b * now.clamp[i]) / angle.sin())
            };
            let frame = Frame { problem: self, now: Now { clamp, ..now }, spin };
            match frame.settle(member.y.clone(), Some(tension)) {
                Some(next) => {
                    (member, done) = (next, share);
                    stride = (1.5 * stride).min(0.2);
                }
                None if stride > 1e-4 => stride *= 0.5,
                None => {
                    let (reached, length) = (member.tension, member.length());
                    return Err(SteadyError::Lost { tension, reached, length });
                }
            }
        }
        Ok(member)
    }
}

impl Frame<'_> {
    /// The first member of the family, nearly straight, and on from there to the one with this tension.
    fn follow(&self, tension: f64) -> Result<Member, SteadyError> {
        let straight = length(&minus(&self.now.lay.x, &self.problem.eyelet));
        let mut last = self.first(tension, straight)?;
        if last.tension == tension {
            return Ok(last);
        }
        let mut before: Option<Member> = None;
        let (mut factor, floor) = (1.4_f64, 1.0005);
        loop {
            let e = last.length() - straight;
            let next = straight + factor * e;
            let guess = before.as_ref().map_or(last.y.clone(), |b| ahead(b, &last, next, straight));
            let Some(member) = self.settle_length(guess, next).filter(|m| m.tension > 0.0) else {
                factor = 1.0 + 0.5 * (factor - 1.0);
                if factor < floor || !(next < 100.0 * straight) {
                    let (reached, length) = (last.tension, last.length());
                    return Err(SteadyError::Lost { tension, reached, length });
                }
                continue;
            };
            if member.tension <= tension {
                return self.between(last, member, tension);
            }
            if member.tension >= last.tension {
                let from = before.unwrap_or_else(|| last.clone());
                let least = self.least(from.clone(), member);
                if least.tension > tension {
                    let length = least.length();
                    return Err(SteadyError::Nothing { tension, least: least.tension, length });
                }
                return self.between(from, least, tension);
            }
            before = Some(std::mem::replace(&mut last, member));
            factor = (1.1 * (factor - 1.0) + 1.0).min(1.4);
        }
    }

    fn first(&self, tension: f64, straight: f64) -> Result<Member, SteadyError> {
        let problem = self.problem;
        let cable = &problem.cable;
        let fast = self.now.speed[0].max(length(&self.spin) * straight);
        let drag = problem.drag.as_ref().map_or(0.0, |d| 0.6 * d.density * cable.diameter * fast * fast);
        let load = drag + length(&problem.weight) + cable.mass * fast * fast / straight;
        if load == 0.0 {
            return self.straight(tension).ok_or(SteadyError::Lost {
                tension,
                reached: tension,
                length: straight,
            });
        }
        let mut high = 20.0 * tension.max(load * straight);
        for _ in 0..8 {
            if let Some(member) = self.straight(high).filter(|m| m.length() - straight > 1e-13 * straight) {
                return Ok(member);
            }
            high *= 4.0;
        }
        let message = "no nearly straight balloon was found; give more segments, or another speed";
        Err(BuildError::at("speed", message).into())
    }

    /// The member with a tension, looked for from a straight line.
    fn straight(&self, tension: f64) -> Option<Member> {
        let (n, begin) = (self.problem.elements, self.problem.eyelet);
        let way = minus(&self.now.lay.x, &begin);
        let y = State {
            t: 0.0,
            x: (0..=n).map(|j| plus(&begin, j as f64 / n as f64, &way)).collect(),
            v: vec![[0.0; 3]; n + 1],
            a: vec![[0.0; 3]; n + 1],
            lambda: vec![tension; n],
            peeled: [0.0, self.now.speed[0], 0.0],
            length: [length(&way), 0.0, 0.0],
        };
        self.settle(y, Some(tension))
    }

    /// The member with this tension between two with a higher and a lower one.
    fn between(&self, mut a: Member, mut b: Member, tension: f64) -> Result<Member, SteadyError> {
        for _ in 0..60 {
            let share = ((tension - a.tension) / (b.tension - a.tension)).clamp(0.02, 0.98);
            let guess = mix(&a.y, &b.y, share);
            let inside = |l: f64| (l - a.length()) * (l - b.length()) <= 0.0;
            if let Some(member) = self.settle(guess.clone(), Some(tension)).filter(|m| inside(m.length())) {
                return Ok(member);
            }
            let middle = a.length() + share * (b.length() - a.length());
            let Some(member) = self.settle_length(guess, middle) else { break };
            if member.tension > tension { a = member } else { b = member }
        }
        let (reached, length) = (a.tension, a.length());
        Err(SteadyError::Lost { tension, reached, length })
    }

    /// The member with the least tension between two, by golden sections.
    fn least(&self, mut a: Member, mut b: Member) -> Member {
        let golden = 0.5 * (3.0 - 5.0_f64.sqrt());
        let mut best = if a.tension < b.tension { a.clone() } else { b.clone() };
        let inner = |a: &Member, b: &Member, share: f64| {
            let l = a.length() + share * (b.length() - a.length());
            self.settle_length(mix(&a.y, &b.y, share), l)
        };
        let (mut c, mut d) = (inner(&a, &b, golden), inner(&a, &b, 1.0 - golden));
        for _ in 0..40 {
            let (Some(m), Some(q)) = (&c, &d) else { break };
            for x in [m, q] {
                if x.tension < best.tension {
                    best = x.clone();
                }
            }
            if (b.length() - a.length()).abs() < 1e-7 * b.length() {
                break;
            }
            if m.tension < q.tension {
                (b, d) = (q.clone(), c.clone());
                c = inner(&a, &b, golden);
            } else {
                (a, c) = (m.clone(), d.clone());
                d = inner(&a, &b, 1.0 - golden);
            }
        }
        best
    }

    fn settle_length(&self, mut y: State, l: f64) -> Option<Member> {
        y.length = [l, 0.0, 0.0];
        self.settle(y, None)
    }

    /// Newton's method: with the length given, or with the tension at the eyelet.
    fn settle(&self, mut y: State, tension: Option<f64>) -> Option<Member> {
        let (problem, n) = (self.problem, self.problem.elements);
        let turning = turning(&self.spin);
        let rates = Rates { x: 1.0, v: turning, a: product(&turning, &turning) };
        let column = Column { length: [1.0, 0.0, 0.0], ..Column::default() };
        let mut system = problem.system(tension.is_some());
        let mut last = f64::INFINITY;
        for _ in 0..40 {
            y.x[0] = problem.eyelet;
            y.x[n] = self.now.lay.x;
            for j in 0..=n {
                y.v[j] = cross(&self.spin, &minus(&y.x[j], &problem.eyelet));
                y.a[j] = cross(&self.spin, &y.v[j]);
            }
            let scalar = tension.is_some().then_some(&column);
            problem.assemble(&y, &self.now, &rates, scalar, [1.0, 0.0, 0.0], &mut system);
            if let Some(tension) = tension {
                problem.pulled(&y, &self.now, tension, &rates, &column, &mut system);
            }
            system.solve().ok()?;
            let d = &system.rhs;
            let node = |j: usize| [d[4 * j - 3], d[4 * j - 2], d[4 * j - 1]];
            let mut moved =
                (1..n).fold(0.0, |m: f64, j| if length(&node(j)) <= m { m } else { length(&node(j)) });
            if tension.is_some() {
                moved = moved.max(d[4 * n - 3].abs());
            }
            if !moved.is_finite() {
                return None;
            }
            let step = (0.1 * y.length[0] / moved).min(1.0);
            for j in 1..n {
                y.x[j] = plus(&y.x[j], step, &node(j));
            }
            (0..n).for_each(|j| y.lambda[j] += step * d[4 * j]);
            if tension.is_some() {
                y.length[0] += step * d[4 * n - 3];
            }
            if !(y.length[0] > 0.0) {
                return None;
            }
            let l = y.length[0];
            if moved <= 1e-12 * l || (moved <= 1e-9 * l && !(moved < 0.5 * last)) {
                for j in 0..=n {
                    y.v[j] = cross(&self.spin, &minus(&y.x[j], &problem.eyelet));
                    y.a[j] = cross(&self.spin, &y.v[j]);
                }
                let tension = tension.unwrap_or_else(|| problem.tensions(&y, &self.now)[0]);
                return Some(Member { y, tension });
            }
            last = moved;
        }
        None
    }
}

/// `Ω ×` as a matrix.
fn turning(spin: &V3<f64>) -> M3 {
    let columns = identity(1.0).map(|e| cross(spin, &e));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i]))
}

/// A state between two, of positions and multipliers.
fn mix(a: &State, b: &State, share: f64) -> State {
    let mut y = a.clone();
    for j in 0..a.x.len() {
        y.x[j] = plus(&a.x[j], share, &minus(&b.x[j], &a.x[j]));
    }
    for j in 0..a.lambda.len() {
        y.lambda[j] += share * (b.lambda[j] - a.lambda[j]);
    }
    y.length[0] += share * (b.length[0] - a.length[0]);
    y
}

/// A guess for the member of the next length: amplitudes grow with the root of the excess over the straight length.
fn ahead(a: &Member, b: &Member, next: f64, straight: f64) -> State {
    let root = |l: f64| (l - straight).max(0.0).sqrt();
    let share = (root(next) - root(a.length())) / (root(b.length()) - root(a.length()));
    let mut y = mix(&a.y, &b.y, share);
    // tensions fall with it
    let inverse = |l: f64| 1.0 / root(l);
    let share = (inverse(next) - inverse(a.length())) / (inverse(b.length()) - inverse(a.length()));
    for j in 0..y.lambda.len() {
        y.lambda[j] = a.y.lambda[j] + share * (b.y.lambda[j] - a.y.lambda[j]);
    }
    y
}

/// The rule that keeps a steady balloon in the motion in time.
impl Balloon {
    /// The tension at its eyelet, as a rule.
    pub fn rule(&self) -> Rule {
        Rule::Tension(super::Pull::constant(self.tension))
    }
}
