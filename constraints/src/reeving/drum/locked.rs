//! The stretch and the twist with which cable lies on a drum: as it was wound, it stays until it is paid out.

use num_dual::Dual64;
use ropewalk_core::{Assembly, At, Jet, MovingBoundary, Pattern, Power, Remembers, Term};

/// Places along the wound cable at which its stretch is known; when there are more, the one goes whose neighbours are most alike.
const PLACES: usize = 64;

/// Numbers that are remembered: whether an equilibrium has told the stretch of what was wound before; how much that is more than
/// the stretch at the start; at the last state the length fed out, what it is longer than the same with the former stretch, and
/// the stretch beyond that; the number of places; and of the outermost cable that was wound, and of each place, from the
/// deepest on, the same three numbers.
const MEMORY: usize = 6 + 3 * (PLACES + 1);

/// The stretch of what is wound, or its twist per length.
///
/// The stretched length `Λ` by the length `f` that is fed out is known at places, with its slope, which is the stretch there;
/// in between it is a cubic of Hermite. So nothing jumps as cable of another stretch comes off. Of a twist `Λ` is the angle by which
/// what is fed out is twisted, and its slope the twist per length; what is said of stretches here holds of that too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Locked {
    /// First of its internal variables.
    first: usize,
    /// Stretch at the start.
    laid: f64,
    /// Least distance of places [m].
    apart: f64,
}

/// A place: the length fed out, `Λ` there beyond that with the stretch of what lies deepest, and its slope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Place {
    fed: f64,
    more: f64,
    slope: f64,
}

/// The stretched length that was fed out, or the angle by which that is twisted, around a length that was fed out: a cubic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fed {
    from: f64,
    c: [f64; 4],
}

impl Fed {
    /// The stretched length, or the angle by which it is twisted.
    pub fn sum<S: Jet>(&self, fed: S) -> S {
        let (x, c) = (fed - self.from, self.c);
        ((x * c[3] + c[2]) * x + c[1]) * x + c[0]
    }

    /// The stretch of what passes, or its twist per length: the slope of that.
    pub fn per_length<S: Jet>(&self, fed: S) -> S {
        let (x, c) = (fed - self.from, self.c);
        (x * (3.0 * c[3]) + 2.0 * c[2]) * x + c[1]
    }

    /// Of two places, the second of which is deeper.
    fn between(base: f64, a: Place, b: Place) -> Self {
        let h = b.fed - a.fed;
        let mean = (b.more - a.more) / h;
        let c2 = (3.0 * mean - 2.0 * a.slope - b.slope) / h;
        let c3 = (a.slope + b.slope - 2.0 * mean) / (h * h);
        Fed { from: a.fed, c: [base * a.fed + a.more, base + a.slope, c2, c3] }
    }

    /// On one side of a place, with one stretch.
    fn straight(base: f64, a: Place) -> Self {
        Fed { from: a.fed, c: [base * a.fed + a.more, base + a.slope, 0.0, 0.0] }
    }
}

impl Locked {
    /// Its numbers begin there; nothing is wound yet since the start.
    pub fn new(first: usize, laid: f64, apart: f64) -> Self {
        Locked { first, laid, apart }
    }

    /// Numbers that it remembers.
    pub const fn memory() -> usize {
        MEMORY
    }

    fn own<'a>(&self, internal: &'a [f64]) -> &'a [f64] {
        internal.get(self.first..self.first + MEMORY).unwrap_or(&[0.0; MEMORY])
    }

    /// Stretch of what was wound before the start.
    pub fn base(&self, internal: &[f64]) -> f64 {
        self.laid + self.own(internal)[1]
    }

    /// What passes where this length is fed out: what is wound now has the stretch of the cable, what is paid out that with
    /// which it was wound.
    pub fn at(&self, internal: &[f64], fed: f64) -> Fed {
        let m = self.own(internal);
        let base = self.laid + m[1];
        let (last, outermost) = (place(m, LAST), place(m, OUTERMOST));
        // at the last state itself as it came there
        let winds = fed < last.fed || fed == last.fed && last.fed == outermost.fed;
        if winds { Fed::straight(base, last) } else { self.wound(m, fed) }
    }

    /// What lies where this length is fed out.
    fn wound(&self, m: &[f64], fed: f64) -> Fed {
        let base = self.laid + m[1];
        let n = m[5] as usize;
        let mut outer = place(m, OUTERMOST);
        for k in (0..n).rev() {
            let deeper = place(m, FIRST + 3 * k);
            if fed < deeper.fed {
                return Fed::between(base, outer, deeper);
            }
            outer = deeper;
        }
        // below lies what was there at the start
        let still = if n > 0 { outer } else { place(m, LAST) };
        Fed::straight(base, Place { slope: 0.0, ..still })
    }

    /// Goes on to a state in which this length is fed out and the cable has this stretch.
    pub fn wind(&self, internal: &mut [f64], fed: f64, stretch: f64) {
        let base = self.base(internal);
        let Some(m) = internal.get_mut(self.first..self.first + MEMORY) else { return };
        let (last, outermost) = (place(m, LAST), place(m, OUTERMOST));
        let more = if fed < last.fed {
            let n = m[5] as usize;
            if n == 0 || last.fed > outermost.fed {
                // the first after some was paid out: what is left goes on from here
                let from = self.wound(m, last.fed).per_length(last.fed) - base;
                let kept = (0..n).take_while(|&k| place(m, FIRST + 3 * k).fed > last.fed).count();
                m[5] = kept as f64;
                self.push(m, Place { slope: from, ..last });
            } else {
                self.push(m, outermost);
            }
            let more = last.more + last.slope * (fed - last.fed);
            set(m, OUTERMOST, Place { fed, more, slope: last.slope });
            more
        } else {
            self.wound(m, fed).sum(fed) - base * fed
        };
        set(m, LAST, Place { fed, more, slope: stretch - base });
    }

    /// Remembers a place, if it is far enough from the one before.
    fn push(&self, m: &mut [f64], next: Place) {
        let mut n = m[5] as usize;
        if n > 0 && place(m, FIRST + 3 * (n - 1)).fed - next.fed < self.apart {
            return;
        }
        if n == PLACES {
            let slope = |k: usize| place(m, FIRST + 3 * k).slope;
            let bends = |k: &usize| (slope(k - 1) - 2.0 * slope(*k) + slope(k + 1)).abs();
            let least = (1..n - 1).min_by(|a, b| bends(a).total_cmp(&bends(b))).unwrap_or(1);
            m.copy_within(FIRST + 3 * (least + 1)..FIRST + 3 * n, FIRST + 3 * least);
            n -= 1;
        }
        set(m, FIRST + 3 * n, next);
        m[5] = (n + 1) as f64;
    }
}

/// Where the numbers of the last state, of the outermost cable and of the deepest place begin.
const LAST: usize = 2;
const OUTERMOST: usize = 6;
const FIRST: usize = 9;

fn place(m: &[f64], at: usize) -> Place {
    Place { fed: m[at], more: m[at + 1], slope: m[at + 2] }
}

fn set(m: &mut [f64], at: usize, Place { fed, more, slope }: Place) {
    m[at..at + 3].copy_from_slice(&[fed, more, slope]);
}

/// What the stretch of cable changes by where it leaves the drum.
///
/// What is paid out takes the tension `T` of the free cable at once: it pulls with that on the drum, and a moment `T R` is
/// all that it has about the axis. So of the work `T λ` by length that the free cable does on what it is fed, `T (λ - λ_w)`
/// stretches it on the way and doesn't arrive at the drum: it becomes the energy that it has more then, and
/// `EA (λ - λ_w)²/2` of heat. Nothing of it where it is wound, with the stretch that it has.
pub(super) struct Loosens {
    pub name: String,
    pub boundary: MovingBoundary,
    pub locked: Locked,
    /// Axial stiffness [N].
    pub ea: f64,
    /// Whether an equilibrium tells the stretch of what was wound before.
    pub settles: bool,
}

impl Loosens {
    /// Stretch of the free cable, and of what passes.
    fn stretches(&self, at: &At<'_>) -> [f64; 2] {
        let fed = self.boundary.fed(at);
        [self.boundary.stretch(at), self.locked.at(at.internal, fed).per_length(fed)]
    }
}

impl Term for Loosens {
    fn label(&self) -> String {
        format!("{}: stretch", self.name)
    }
    fn pattern(&self, p: &mut Pattern) {
        let slope = self.boundary.end_v + 3;
        p.clique([self.boundary.v, slope, slope + 1, slope + 2]);
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (free, fed, sign) = (self.boundary.stretch(at), self.boundary.fed(at), self.boundary.sign);
        let passes = self.locked.at(at.internal, fed);
        let force =
            |free: Dual64, fed: Dual64| (free - 1.0) * (free - passes.per_length(fed)) * (self.ea * sign);
        let by_free = force(Dual64::new(free, 1.0), Dual64::from(fed));
        out.add(self.boundary.v, by_free.re);
        let w = out.weights().q;
        if out.wants_tangent() {
            let mut block = [[0.0; 4]; 4];
            block[0][0] = w * sign * force(Dual64::from(free), Dual64::new(fed, 1.0)).eps;
            for i in 0..3 {
                block[0][1 + i] = w * by_free.eps * at.q[self.boundary.end_q + 3 + i] / free;
            }
            out.add_square(0, &block);
        }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let ([free, wound], rate) = (self.stretches(at), self.boundary.rate(at));
        let stored = 0.5 * self.ea * ((free - 1.0).powi(2) - (wound - 1.0).powi(2));
        let lost = 0.5 * self.ea * (free - wound).powi(2);
        Power { dissipated: lost * rate, carried: -stored * rate, ..Power::default() }
    }
    fn remembers(&self) -> Option<&dyn Remembers> {
        Some(self)
    }
}

impl Remembers for Loosens {
    fn remember(&self, at: &At<'_>, memory: &mut [f64]) {
        self.locked.wind(memory, self.boundary.fed(at), self.boundary.stretch(at));
    }
    fn rests(&self) -> bool {
        true
    }
    fn settle(&self, at: &At<'_>, memory: &mut [f64]) -> bool {
        let Some(m) = memory.get_mut(self.locked.first..self.locked.first + MEMORY) else { return false };
        let first = m[0] == 0.0 && self.settles;
        m[0] = 1.0;
        if first {
            // what was wound before has the tension of the free cable
            m[1] = self.boundary.stretch(at) - self.locked.laid;
            return m[1].abs() > 1e-12;
        }
        self.remember(at, memory);
        false
    }
}
