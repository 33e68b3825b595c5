//! What is known of the table around stations.

use ropewalk_core::Real;
use std::ops::{Deref, DerefMut};

/// As many lanes as the widest carrier has.
pub(super) const LANES: usize = 8;

/// A number of each lane, where the widest carrier reads it at once.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Row(pub [f64; LANES]);

impl Deref for Row {
    type Target = [f64];
    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl DerefMut for Row {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

/// A generation of slots that never was.
const NEVER: u64 = u64::MAX;

/// What is known of the table around stations side by side: it stays the same until one of them gets to another spot, or the
/// time to another instant.
///
/// What every look needs is together, for the sake of the caches.
#[derive(Clone, Debug)]
pub struct Stations {
    /// How many there are: as many others know nothing of these.
    pub(super) lanes: usize,
    pub(super) surface: Known<1, 6>,
    pub(super) water: Known<2, 12>,
    /// Who is so near a spot of the cell that it is in is next to it [m].
    pub(super) near: Row,
    /// The depths between which such cells are [m].
    pub(super) from: Row,
    pub(super) to: Row,
    pub(super) kept: Box<Kept>,
}

/// Where it comes from.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    pub surface: Ends<2, 6>,
    pub water: Ends<4, 12>,
    /// Spots of the cells in which the stations are are so far apart [m].
    pub apart: Row,
}

/// Numbers at the spots next to stations at a time: values, and then their rates.
#[derive(Clone, Debug)]
pub(super) struct Known<const D: usize, const N: usize> {
    /// The number of the instant before the time, and the time.
    pub n: f64,
    pub t: f64,
    /// Where the spots are, along the waves and downwards [m].
    pub places: [Row; D],
    now: [Row; N],
}

/// The same at both instants about a time.
#[derive(Clone, Debug)]
pub(super) struct Ends<const CORNERS: usize, const N: usize> {
    /// Of what is known of slots.
    pub generation: u64,
    /// Numbers of the spots along the waves and downwards.
    pub spots: [Row; 2],
    /// Slots of the corners around them.
    pub slots: [[u32; CORNERS]; LANES],
    /// What is there, number by number, of even instants and of odd ones.
    pub rows: [[Row; N]; 2],
}

const NOWHERE: Row = Row([f64::NAN; LANES]);

impl<const CORNERS: usize, const N: usize> Ends<CORNERS, N> {
    fn nothing() -> Self {
        Ends {
            generation: NEVER,
            spots: [NOWHERE; 2],
            slots: [[0; CORNERS]; LANES],
            rows: [[Row([0.0; LANES]); N]; 2],
        }
    }

    /// What is at the instants before and after a time, of which the first has this number.
    #[inline(always)]
    pub fn about(&self, n: f64) -> [&[Row; N]; 2] {
        let first = place_of(n as i64);
        [&self.rows[first], &self.rows[1 - first]]
    }
}

/// Where the numbers of an instant are: the second one becomes the first as time goes on, and stays where it is.
#[inline(always)]
pub(super) fn place_of(instant: i64) -> usize {
    (instant & 1) as usize
}

impl<const D: usize, const N: usize> Known<D, N> {
    fn nothing() -> Self {
        Known { n: f64::NAN, t: f64::NAN, places: [NOWHERE; D], now: [Row([0.0; LANES]); N] }
    }

    /// Moves on to a time between the instants, which are `tau` apart [s].
    #[inline(always)]
    pub fn go_to<R: Real>(&mut self, [first, second]: [&[Row; N]; 2], t: f64, late: f64, tau: f64) {
        let ([a, da, b, db], [ra, rda, rb, rdb]) = (hermite(late), slopes(late));
        let (value, rate) = ([a, tau * da, b, tau * db], [ra / tau, rda, rb / tau, rdb]);
        for k in 0..N / 2 {
            let rates = k + N / 2;
            let ends =
                [R::read(&first[k]), R::read(&first[rates]), R::read(&second[k]), R::read(&second[rates])];
            blend(&value, &ends).write(&mut self.now[k]);
            blend(&rate, &ends).write(&mut self.now[rates]);
        }
        self.t = t;
    }

    /// Some numbers at the time, from one on.
    #[inline(always)]
    pub fn read<R: Real, const M: usize>(&self, first: usize) -> [R; M] {
        let mut out = [R::zero(); M];
        for k in 0..M {
            out[k] = R::read(&self.now[first + k]);
        }
        out
    }
}

impl Stations {
    /// Of so many stations of which nothing is known.
    pub(super) fn of(lanes: usize) -> Self {
        let kept = Kept { surface: Ends::nothing(), water: Ends::nothing(), apart: NOWHERE };
        Stations {
            lanes,
            surface: Known::nothing(),
            water: Known::nothing(),
            near: NOWHERE,
            from: NOWHERE,
            to: NOWHERE,
            kept: Box::new(kept),
        }
    }
}

impl Default for Stations {
    /// Of nothing.
    fn default() -> Self {
        Stations::of(0)
    }
}

/// A sum of what is at both ends.
#[inline(always)]
fn blend<R: Real>([w, dw, g, dg]: &[f64; 4], [x, dx, y, dy]: &[R; 4]) -> R {
    R::of(*w).fma(*x, R::of(*dw).fma(*dx, R::of(*g).fma(*y, R::of(*dg) * *dy)))
}

/// Cubic Hermite polynomials on 0 … 1: value and derivative at the start, value and derivative at the end.
fn hermite(x: f64) -> [f64; 4] {
    let (x2, rest) = (x * x, 1.0 - x);
    let s = x2 * (3.0 - 2.0 * x);
    [1.0 - s, x * rest * rest, s, -x2 * rest]
}

/// Their derivatives.
fn slopes(x: f64) -> [f64; 4] {
    let s = 6.0 * x * (1.0 - x);
    [-s, (1.0 - x) * (1.0 - 3.0 * x), s, x * (3.0 * x - 2.0)]
}
