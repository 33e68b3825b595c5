//! Exact sums at the corners of the table.
//!
//! Since the flow is irrotational and free of divergence, `u_z = w_x`, `w_z = -u_x`, six sums make all that is needed of
//! velocities at a corner, and six that of accelerations. The phases of a line of the table are the same at all heights, and
//! what is left of a wave at a height the same at all lines and instants: each is found once, and a corner is a sum of
//! their products. Of the corners themselves the sums alone are kept: phases of each would fill the caches.

use super::spots::Mixed;
use crate::waves::Waves;
use ropewalk_core::{LaneTask, Real, Width, run};
use std::collections::HashMap;
use std::hash::BuildHasherDefault;

/// Lines whose phases are remembered.
const MOST: usize = 4096;
/// Instants before and after the one that is looked at, whose sums are kept.
const KEPT: u64 = 3;

/// `u, u_x, w, w_x` and the same of accelerations, and then what each of them changes by along the waves.
pub(super) type Corner = [f64; 16];
/// Elevation, its slope and how that changes; then the rates of these.
pub(super) type Top = [f64; 6];

/// Numbers of each wave, side by side; filled up with noughts to as many as lanes take.
type Row = Vec<f64>;

/// Sines and cosines of the phase of each wave.
type Phases = [Row; 2];

type Map<K, X> = HashMap<K, X, BuildHasherDefault<Mixed>>;

/// All lines that have been looked at.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// Distance of lines [m], of instants [s].
    along: f64,
    time: f64,
    k: Row,
    omega: Row,
    phase: Row,
    a: Row,
    /// Of each height what is left of the waves there: the amplitudes of their velocities along them and upwards [m/s].
    left: Vec<[Row; 2]>,
    /// Phases that each line adds, and that each instant takes off: those of a column are their differences.
    lines: Map<i64, Phases>,
    instants: Map<i64, Phases>,
    /// The surface by line and instant; the water by line, height and instant.
    tops: Map<(i64, i64), Top>,
    corners: Map<(i64, i64, i64), Corner>,
    latest: i64,
}

impl Columns {
    pub fn new(waves: &Waves, heights: &[f64], [along, time]: [f64; 2]) -> Self {
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
            along,
            time,
            k: row(&|c| c.k),
            omega: row(&|c| c.omega),
            phase: row(&|c| c.phase),
            a: row(&|c| c.a),
            left: left.collect(),
            lines: HashMap::default(),
            instants: HashMap::default(),
            tops: HashMap::default(),
            corners: HashMap::default(),
            latest: 0,
        }
    }

    /// Number of columns whose surface is known.
    pub fn len(&self) -> usize {
        self.tops.len()
    }

    /// The surface at line `i` and instant `n`.
    pub fn top(&mut self, i: i64, n: i64) -> Top {
        if let Some(top) = self.tops.get(&(i, n)) {
            return *top;
        }
        self.meet(i, n);
        let (mut sums, line, instant) = ([0.0; 6], &self.lines[&i], &self.instants[&n]);
        let waves = [&self.k, &self.omega, &self.a].map(Vec::as_slice);
        run(Width::best(), Tops { line, instant, waves, sums: &mut sums });
        self.tops.insert((i, n), sums);
        sums
    }

    /// The corner of line `i` and instant `n` at height `j`.
    pub fn corner(&mut self, i: i64, j: usize, n: i64) -> Corner {
        let key = (i, j as i64, n);
        if let Some(corner) = self.corners.get(&key) {
            return *corner;
        }
        self.meet(i, n);
        let (mut sums, line, instant) = ([0.0; 12], &self.lines[&i], &self.instants[&n]);
        let waves = [&self.k, &self.omega].map(Vec::as_slice);
        run(Width::best(), Corners { line, instant, left: &self.left[j], waves, sums: &mut sums });
        let [u, ux, uxx, w, wx, wxx, a, ax, axx, b, bx, bxx] = sums;
        let corner = [u, ux, w, wx, a, ax, b, bx, ux, uxx, wx, wxx, ax, axx, bx, bxx];
        self.corners.insert(key, corner);
        corner
    }

    /// Finds the phases of a line and of an instant.
    fn meet(&mut self, i: i64, n: i64) {
        let (x, t) = (i as f64 * self.along, n as f64 * self.time);
        let of = |phase: &dyn Fn(usize) -> f64| -> Phases {
            let (sin, cos) = (0..self.k.len()).map(|c| phase(c).sin_cos()).unzip();
            [sin, cos]
        };
        self.lines.entry(i).or_insert_with(|| of(&|c| self.k[c] * x + self.phase[c]));
        self.instants.entry(n).or_insert_with(|| of(&|c| self.omega[c] * t));
    }

    /// Forgets all but what is of instants near this one, if it is far from that when this was done before.
    pub fn forget_far(&mut self, n: i64) {
        if n.abs_diff(self.latest) <= KEPT {
            return;
        }
        self.latest = n;
        let near = |instant: i64| instant.abs_diff(n) <= KEPT;
        self.instants.retain(|instant, _| near(*instant));
        self.tops.retain(|key, _| near(key.1));
        self.corners.retain(|key, _| near(key.2));
        if self.lines.len() > MOST {
            self.lines.clear();
        }
    }
}

/// The sine and cosine of the phase at a line and an instant, of the waves from one on.
#[inline(always)]
fn phase<R: Real>(line: &Phases, instant: &Phases, c: usize) -> [R; 2] {
    let [s, co] = [R::read(&line[0][c..]), R::read(&line[1][c..])];
    let [si, ci] = [R::read(&instant[0][c..]), R::read(&instant[1][c..])];
    [s * ci - co * si, co * ci + s * si]
}

/// The sums of the surface.
struct Tops<'a> {
    line: &'a Phases,
    instant: &'a Phases,
    /// Wavenumbers, frequencies and amplitudes.
    waves: [&'a [f64]; 3],
    sums: &'a mut Top,
}

impl LaneTask for Tops<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Tops { line, instant, waves: [k, omega, a], sums } = self;
        let mut all = [R::zero(); 6];
        for c in (0..k.len()).step_by(R::LANES) {
            let [sin, cos] = phase::<R>(line, instant, c);
            let [k, omega, a] = [R::read(&k[c..]), R::read(&omega[c..]), R::read(&a[c..])];
            let (cos, sin) = (a * cos, a * sin);
            let (kc, ks) = (k * cos, k * sin);
            all[0] += cos;
            all[1] -= ks;
            all[2] -= k * kc;
            all[3] += omega * sin;
            all[4] += omega * kc;
            all[5] -= omega * (k * ks);
        }
        for i in 0..6 {
            sums[i] = total(all[i]);
        }
    }
}

/// The sums of a corner.
struct Corners<'a> {
    line: &'a Phases,
    instant: &'a Phases,
    left: &'a [Row; 2],
    waves: [&'a [f64]; 2],
    sums: &'a mut [f64; 12],
}

impl LaneTask for Corners<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Corners { line, instant, left: [u, w], waves: [k, omega], sums } = self;
        let mut all = [R::zero(); 12];
        for c in (0..k.len()).step_by(R::LANES) {
            let [sin, cos] = phase::<R>(line, instant, c);
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
