//! Exact sums at the corners of the table.
//!
//! Since the flow is irrotational and free of divergence, `u_z = w_x`, `w_z = -u_x`, six sums make all that is needed of
//! velocities at a corner, and six that of accelerations. The phases of a line of the table are the same at all heights, and
//! what is left of a wave at a height the same at all lines and instants: each is found once, and a corner is a sum of
//! their products.

use super::spots::Mixed;
use crate::waves::Waves;
use ropewalk_core::{LaneTask, Real, Width, run};
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

/// Lines whose phases are remembered.
const MOST: usize = 4096;
/// Instants before and after the one that is looked at, whose columns are kept.
const KEPT: u64 = 3;

/// `u, u_x, w, w_x` and the same of accelerations, and then what each of them changes by along the waves.
pub(super) type Corner = [f64; 16];

/// Numbers of each wave, side by side; filled up with noughts to as many as lanes take.
type Row = Vec<f64>;

/// Sines and cosines of the phase of each wave.
type Phases = [Row; 2];

/// A line of the table at one instant.
#[derive(Clone, Debug)]
struct Column {
    /// Numbers of the line and the instant.
    line: i64,
    instant: i64,
    /// Elevation, its slope and how that changes; then the rates of these.
    surface: [f64; 6],
    phases: Phases,
    /// Which of its corners are known, by height.
    known: Vec<bool>,
    corners: Vec<Corner>,
}

impl Column {
    /// Room for one of so many waves and heights.
    fn new((waves, heights): (usize, usize)) -> Self {
        let phases = [vec![0.0; waves], vec![0.0; waves]];
        let (known, corners) = (vec![false; heights], vec![[0.0; 16]; heights]);
        Column { line: 0, instant: 0, surface: [0.0; 6], phases, known, corners }
    }
}

/// All lines that have been looked at.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    k: Row,
    omega: Row,
    a: Row,
    phase: Row,
    /// Of each height what is left of the waves there: the amplitudes of their velocities along them and upwards [m/s].
    left: Vec<[Row; 2]>,
    /// Phases that each line adds, and that each instant takes off: those of a column are their differences.
    lines: HashMap<i64, Phases, BuildHasherDefault<Mixed>>,
    instants: HashMap<i64, Phases, BuildHasherDefault<Mixed>>,
    all: Vec<Column>,
    /// Those that were forgotten, to be filled anew.
    spare: Vec<Column>,
    /// Where those are of a line and an instant.
    places: HashMap<(i64, i64), usize, BuildHasherDefault<Mixed>>,
    latest: i64,
}

impl Columns {
    pub fn new(waves: &Waves, heights: &[f64]) -> Self {
        let row = |of: &dyn Fn(&crate::waves::Component) -> f64| -> Row {
            let mut row: Row = waves.all.iter().map(of).collect();
            row.resize(row.len().next_multiple_of(8), 0.0);
            row
        };
        let left = heights.iter().map(|&z| {
            let at = |k: usize| row(&|c| c.a * c.sigma * c.depths(z, waves.depth())[k]);
            [at(0), at(1)]
        });
        Columns {
            k: row(&|c| c.k),
            omega: row(&|c| c.omega),
            a: row(&|c| c.a),
            phase: row(&|c| c.phase),
            left: left.collect(),
            lines: HashMap::default(),
            instants: HashMap::default(),
            all: Vec::new(),
            spare: Vec::new(),
            places: HashMap::default(),
            latest: 0,
        }
    }

    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// The number of the column of line `i` at `x` [m] and instant `n` at `t` [s], which is made if there is none.
    pub fn number(&mut self, (i, n): (i64, i64), x: f64, t: f64) -> usize {
        if let Some(place) = self.places.get(&(i, n)) {
            return *place;
        }
        let of = |phase: &dyn Fn(usize) -> f64| -> Phases {
            let (sin, cos) = (0..self.k.len()).map(|c| phase(c).sin_cos()).unzip();
            [sin, cos]
        };
        let line = self.lines.entry(i).or_insert_with(|| of(&|c| self.k[c] * x + self.phase[c]));
        let instant = self.instants.entry(n).or_insert_with(|| of(&|c| self.omega[c] * t));
        let size = (self.k.len(), self.left.len());
        let mut column = self.spare.pop().unwrap_or_else(|| Column::new(size));
        (column.line, column.instant) = (i, n);
        column.known.fill(false);
        let waves = [&self.k, &self.omega, &self.a].map(Vec::as_slice);
        let Column { phases, surface, .. } = &mut column;
        run(Width::best(), Meets { line, instant, waves, phases, surface });
        self.all.push(column);
        self.places.insert((i, n), self.all.len() - 1);
        self.all.len() - 1
    }

    /// Elevation, its slope and how that changes; then the rates of these.
    pub fn surface(&self, column: usize) -> &[f64; 6] {
        &self.all[column].surface
    }

    /// The corner of a column at a height.
    pub fn corner(&mut self, column: usize, j: usize) -> &Corner {
        let Column { phases, known, corners, .. } = &mut self.all[column];
        if !std::mem::replace(&mut known[j], true) {
            let waves = [&self.k, &self.omega].map(Vec::as_slice);
            let mut sums = [0.0; 12];
            run(Width::best(), Sums { phases, left: &self.left[j], waves, sums: &mut sums });
            let [u, ux, uxx, w, wx, wxx, a, ax, axx, b, bx, bxx] = sums;
            corners[j] = [u, ux, w, wx, a, ax, b, bx, ux, uxx, wx, wxx, ax, axx, bx, bxx];
        }
        &corners[j]
    }

    /// Forgets all but the columns of instants near this one, if it is far from that when this was done before.
    pub fn forget_far(&mut self, n: i64) {
        if n.abs_diff(self.latest) <= KEPT {
            return;
        }
        self.latest = n;
        let near = |instant: i64| instant.abs_diff(n) <= KEPT;
        self.instants.retain(|instant, _| near(*instant));
        if self.lines.len() > MOST {
            self.lines.clear();
        }
        let (kept, gone) = self.all.drain(..).partition::<Vec<_>, _>(|column| near(column.instant));
        (self.all, self.spare) = (kept, gone);
        self.places =
            self.all.iter().enumerate().map(|(k, column)| ((column.line, column.instant), k)).collect();
    }
}

/// The phases of a line at an instant, and the surface there.
struct Meets<'a> {
    line: &'a Phases,
    instant: &'a Phases,
    /// Wavenumbers, frequencies and amplitudes.
    waves: [&'a [f64]; 3],
    phases: &'a mut Phases,
    surface: &'a mut [f64; 6],
}

impl LaneTask for Meets<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Meets { line, instant, waves: [k, omega, a], phases, surface } = self;
        let mut sums = [R::zero(); 6];
        for c in (0..k.len()).step_by(R::LANES) {
            let [s, co] = [R::read(&line[0][c..]), R::read(&line[1][c..])];
            let [si, ci] = [R::read(&instant[0][c..]), R::read(&instant[1][c..])];
            let (sin, cos) = (s * ci - co * si, co * ci + s * si);
            sin.write(&mut phases[0][c..]);
            cos.write(&mut phases[1][c..]);
            let [k, omega, a] = [R::read(&k[c..]), R::read(&omega[c..]), R::read(&a[c..])];
            let (cos, sin) = (a * cos, a * sin);
            let (kc, ks) = (k * cos, k * sin);
            sums[0] += cos;
            sums[1] -= ks;
            sums[2] -= k * kc;
            sums[3] += omega * sin;
            sums[4] += omega * kc;
            sums[5] -= omega * (k * ks);
        }
        for i in 0..6 {
            surface[i] = total(sums[i]);
        }
    }
}

/// The sums of a corner.
struct Sums<'a> {
    phases: &'a Phases,
    left: &'a [Row; 2],
    waves: [&'a [f64]; 2],
    sums: &'a mut [f64; 12],
}

impl LaneTask for Sums<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Sums { phases: [sin, cos], left: [u, w], waves: [k, omega], sums } = self;
        let mut all = [R::zero(); 12];
        for c in (0..k.len()).step_by(R::LANES) {
            let (sin, cos) = (R::read(&sin[c..]), R::read(&cos[c..]));
            let (u, w) = (R::read(&u[c..]), R::read(&w[c..]));
            let (k, omega) = (R::read(&k[c..]), R::read(&omega[c..]));
            let (cu, su, cw, sw) = (u * cos, u * sin, w * cos, w * sin);
            let (kcu, ksu, kcw, ksw) = (k * cu, k * su, k * cw, k * sw);
            all[0] += cu;
            all[1] -= ksu;
            all[2] -= k * kcu;
            all[3] += sw;
            all[4] += kcw;
            all[5] -= k * ksw;
            all[6] += omega * su;
            all[7] += omega * kcu;
            all[8] -= omega * (k * ksu);
            all[9] -= omega * cw;
            all[10] += omega * ksw;
            all[11] += omega * (k * kcw);
        }
        for i in 0..12 {
            sums[i] = total(all[i]);
        }
    }
}

/// The sum of all lanes.
#[inline(always)]
fn total<R: Real>(x: R) -> f64 {
    let mut all = [0.0; 8];
    x.write(&mut all);
    ((all[0] + all[1]) + (all[2] + all[3])) + ((all[4] + all[5]) + (all[6] + all[7]))
}
