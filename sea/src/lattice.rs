//! The motion of the water in many waves from a table that is filled where it is looked at.
//!
//! A sum over 200 waves costs as much as a hundred elements of a cable. Its terms vary no faster than the shortest wave,
//! so that it can be interpolated: in space between lines `x' = i Δ` along the waves' direction and heights `z_j`, by
//! bicubic Hermite polynomials of velocities, and in time between instants `n τ`, by cubic ones of velocities and
//! accelerations, whose derivative is the acceleration. The table holds exact sums. Since the flow is irrotational and
//! free of divergence, `u_z = w_x`, `w_z = -u_x`, six sums make all that is needed of velocities at a corner, and six that
//! of accelerations. The phases of a line of the table are the same at all heights, and what is left of a wave at a height
//! the same at all lines and instants: each is found once, and a corner is a sum of their products.

use crate::waves::{Component, Flow, Stretching, Waves};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A line of the table is this part of the shortest wave away from the next.
const ALONG: f64 = 0.2;
/// Heights near the surface are this part of the shortest wave apart.
const DOWN: f64 = 0.1;
/// Farther down they are this part of the depth below the surface apart: short waves don't reach there.
const GROWTH: f64 = 0.07;
/// Instants are this part of the shortest period apart.
const TIME: f64 = 1.0 / 12.0;
/// Columns are forgotten beyond this number.
const MOST: usize = 4096;

/// Velocities along the waves and upwards, each with its derivative along the waves and the second one, and then the
/// same of accelerations.
type Corner = [f64; 12];

/// A line of the table at one instant.
#[derive(Clone, Debug)]
struct Column {
    /// Numbers of line and instant.
    key: (i64, i64),
    /// Elevation, its slope, and the time derivatives of both.
    surface: [f64; 4],
    phases: Phases,
    corners: Vec<Option<Corner>>,
}

/// Numbers of a line and an instant, well mixed: they come from nobody who would wish them to meet.
#[derive(Clone, Debug, Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u64(u64::from(*b)));
    }
    fn write_u64(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(23) ^ x).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    fn write_i64(&mut self, x: i64) {
        self.write_u64(x.cast_unsigned());
    }
}

/// Sine and cosine of a phase of each wave.
type Phases = Vec<[f64; 2]>;

/// What is left of a wave at a height: the amplitudes of its velocities along it and upwards [m/s].
type Amplitudes = Vec<[f64; 2]>;

/// The table of a sea whose waves have one direction. It has a memory of its own, and so is looked at by one at a time.
#[derive(Clone, Debug)]
pub struct Lattice {
    waves: Waves,
    way: [f64; 2],
    /// Speed of the current that carries them, along them [m/s].
    current: f64,
    /// Distance of lines [m], of instants [s].
    along: f64,
    time: f64,
    /// Heights [m], descending from the highest.
    heights: Vec<f64>,
    /// Of each height what is left of the waves there.
    amplitudes: Vec<Amplitudes>,
    /// Phases that each line adds, and that each instant takes off: those of a column are their differences.
    lines: HashMap<i64, Phases, BuildHasherDefault<Mixed>>,
    instants: HashMap<i64, Phases, BuildHasherDefault<Mixed>>,
    columns: Vec<Column>,
    /// Where those are of a line and an instant.
    places: HashMap<(i64, i64), usize, BuildHasherDefault<Mixed>>,
    /// The cell that was looked at last, and the columns around it.
    latest: Option<((i64, i64), [usize; 4])>,
}

impl Lattice {
    /// The table of these waves, down to the bed, or to where nothing of them is left; `None` if they have more than one
    /// direction.
    ///
    /// `finer` divides its distances: the error falls with the fourth power.
    pub fn new(waves: Waves, finer: f64) -> Option<Self> {
        let way = waves.way()?;
        let length = std::f64::consts::TAU / waves.shortest();
        let time = TIME * std::f64::consts::TAU / waves.fastest() / finer;
        let top = match waves.stretching {
            // stretched to still water, but for rounding
            Stretching::Wheeler | Stretching::Constant => 0.0,
            Stretching::None => 6.0 * waves.deviation(),
        };
        let step = DOWN * length / finer;
        let mut heights = vec![top + 2.0 * step];
        let mut z = heights[0];
        // a factor of 1e-9 of the longest wave is nothing
        let longest = waves.all.iter().fold(f64::INFINITY, |m, c| c.k.min(m));
        let bottom = (-waves.depth()).max(-21.0 / longest);
        while z > bottom {
            z -= step.max(-GROWTH / finer * z);
            heights.push(z);
        }
        let current = waves.all.first().map_or(0.0, |c| (c.omega - c.sigma) / c.k);
        let amplitudes = heights.iter().map(|&z| {
            let left = waves.all.iter().map(|c| {
                let [ch, sh, _] = c.depths(z, waves.depth());
                [c.a * c.sigma * ch, c.a * c.sigma * sh]
            });
            left.collect()
        });
        Some(Lattice {
            amplitudes: amplitudes.collect(),
            way,
            current,
            along: ALONG * length / finer,
            time,
            heights,
            columns: Vec::new(),
            lines: HashMap::default(),
            instants: HashMap::default(),
            places: HashMap::default(),
            latest: None,
            waves,
        })
    }

    /// The waves themselves.
    pub fn waves(&self) -> &Waves {
        &self.waves
    }

    /// Number of columns that it holds.
    pub fn columns(&self) -> usize {
        self.columns.len()
    }

    /// The motion of the water, as [`Waves::at`] gives it, but for the pressure, which is left out.
    pub fn at(&mut self, [x, y, z]: [f64; 3], t: f64) -> Flow {
        let place = (x * self.way[0] + y * self.way[1]) / self.along;
        let instant = t / self.time;
        let (i, n) = (place.floor(), instant.floor());
        let (across, late) = (place - i, instant - n);
        let (i, n) = (i as i64, n as i64);
        if self.columns.len() > MOST {
            self.forget(n);
        }
        let around = match self.latest {
            Some((cell, around)) if cell == (i, n) => around,
            _ => [(i, n), (i + 1, n), (i, n + 1), (i + 1, n + 1)].map(|key| self.column(key)),
        };
        self.latest = Some(((i, n), around));
        let [risen, rising] = self.waves.risen(t);
        let [elevation, steep, rate] = self.surface(around, across, late);
        let mut flow = Flow {
            elevation: risen * elevation,
            slope: self.way.map(|w| risen * steep * w),
            rising: risen * rate + rising * elevation,
            ..Flow::default()
        };
        let (up, by_z, by_eta) = self.waves.stretched(z, flow.elevation);
        // below the last height nothing moves
        let below = self.heights.partition_point(|h| *h > up);
        let j = below.clamp(1, self.heights.len() - 1) - 1;
        if below < self.heights.len() || self.waves.depth().is_finite() {
            let (u, w) = self.inside(around, j, across, late, up);
            let [cx, cy] = self.way;
            // as one sees it who drifts with the current
            let (du, dw) = (u[3] + self.current * u[1], w[3] + self.current * w[1]);
            flow.velocity = [u[0] * cx, u[0] * cy, w[0]];
            flow.acceleration = [du * cx, du * cy, dw];
            let rows = |k: usize| {
                [
                    [u[k] * cx * cx, u[k] * cx * cy, u[k + 1] * cx],
                    [u[k] * cx * cy, u[k] * cy * cy, u[k + 1] * cy],
                    [w[k] * cx, w[k] * cy, w[k + 1]],
                ]
            };
            // of what drifting adds to the acceleration the change from place to place is left out
            (flow.gradient, flow.acceleration_gradient) = (rows(1), rows(4));
        }
        flow.rise([risen, rising], [by_z, by_eta], self.waves.current);
        flow
    }

    /// Elevation, slope and rate before the waves have risen, between two columns at each of two instants.
    fn surface(&self, around: [usize; 4], across: f64, late: f64) -> [f64; 3] {
        let (h, dh, tau) = (hermite(late), slopes(late), self.time);
        let blend = |i: usize| {
            let [a, b] = [around[i], around[i + 2]].map(|k| &self.columns[k].surface);
            let at = |k: usize| h[0] * a[k] + h[1] * tau * a[k + 2] + h[2] * b[k] + h[3] * tau * b[k + 2];
            let rate = |k: usize| (dh[0] * a[k] + dh[2] * b[k]) / tau + dh[1] * a[k + 2] + dh[3] * b[k + 2];
            [at(0), at(1), rate(0), rate(1)]
        };
        let (a, b, h, dh) = (blend(0), blend(1), hermite(across), slopes(across));
        let value = |k: usize| {
            h[0] * a[k] + h[1] * self.along * a[k + 1] + h[2] * b[k] + h[3] * self.along * b[k + 1]
        };
        let slope = (dh[0] * a[0] + dh[2] * b[0]) / self.along + dh[1] * a[1] + dh[3] * b[1];
        [value(0), slope, value(2)]
    }

    /// Velocity along the waves and upwards, each with its derivatives along and upwards, and then the same of their rates,
    /// at a height in the cell below height `j`.
    fn inside(
        &mut self,
        around: [usize; 4],
        j: usize,
        across: f64,
        late: f64,
        up: f64,
    ) -> ([f64; 6], [f64; 6]) {
        let (h, dh, tau) = (hermite(late), slopes(late), self.time);
        // the four corners at this instant: of each its velocities and their rates
        let mut corners = [[[0.0; 6]; 2]; 4];
        for (k, corner) in corners.iter_mut().enumerate() {
            let (i, j) = (k % 2, j + k / 2);
            let (a, b) = (self.corner(around[i], j), self.corner(around[i + 2], j));
            for m in 0..6 {
                let (a, da, b, db) = (a[m], a[m + 6], b[m], b[m + 6]);
                corner[0][m] = h[0] * a + h[1] * tau * da + h[2] * b + h[3] * tau * db;
                corner[1][m] = (dh[0] * a + dh[2] * b) / tau + dh[1] * da + dh[3] * db;
            }
        }
        let (top, height) = (self.heights[j], self.heights[j] - self.heights[j + 1]);
        let depth = (top - up) / height;
        let (hx, dx, hz, dz) = (hermite(across), slopes(across), hermite(depth), slopes(depth));
        let (mut u, mut w) = ([0.0; 6], [0.0; 6]);
        for (k, corner) in corners.iter().enumerate() {
            let (x, z) = (2 * (k % 2), 2 * (k / 2));
            // heights count downwards
            let (fx, fz) = ([hx[x], hx[x + 1] * self.along], [hz[z], -hz[z + 1] * height]);
            let (gx, gz) = ([dx[x] / self.along, dx[x + 1]], [-dz[z] / height, dz[z + 1]]);
            let sum = |f: [f64; 4], x: &[f64; 2], z: &[f64; 2]| {
                z[0] * (x[0] * f[0] + x[1] * f[1]) + z[1] * (x[0] * f[2] + x[1] * f[3])
            };
            for (rate, [a, ax, axx, b, bx, bxx]) in corner.iter().enumerate() {
                // value, by x, by z, by both: u_z = w_x, u_xz = w_xx, w_z = -u_x, w_xz = -u_xx
                for (to, f) in [(&mut u, [*a, *ax, *bx, *bxx]), (&mut w, [*b, *bx, -ax, -axx])] {
                    to[3 * rate] += sum(f, &fx, &fz);
                    to[3 * rate + 1] += sum(f, &gx, &fz);
                    to[3 * rate + 2] += sum(f, &fx, &gz);
                }
            }
        }
        (u, w)
    }

    fn corner(&mut self, column: usize, j: usize) -> Corner {
        if let Some(corner) = self.columns[column].corners[j] {
            return corner;
        }
        let mut sums = [0.0; 12];
        let waves = self.waves.all.iter().zip(&self.columns[column].phases).zip(&self.amplitudes[j]);
        for ((c, [sin, cos]), [u, w]) in waves {
            let (k, omega) = (c.k, c.omega);
            let (cos_u, sin_u, cos_w, sin_w) = (u * cos, k * u * sin, k * w * cos, w * sin);
            // by x, and by x again
            let [u_x, w_x, u_xx, w_xx] = [-sin_u, cos_w, -k * k * cos_u, -k * k * sin_w];
            let own = [
                cos_u,
                u_x,
                u_xx,
                sin_w,
                w_x,
                w_xx,
                omega * u * sin,
                omega * k * cos_u,
                -omega * k * sin_u,
                -omega * w * cos,
                omega * k * sin_w,
                omega * k * cos_w,
            ];
            sums.iter_mut().zip(own).for_each(|(sum, x)| *sum += x);
        }
        self.columns[column].corners[j] = Some(sums);
        sums
    }

    /// Forgets all but the columns of an instant and the next one.
    fn forget(&mut self, n: i64) {
        self.columns.retain(|column| column.key.1 == n || column.key.1 == n + 1);
        self.places = self.columns.iter().enumerate().map(|(k, column)| (column.key, k)).collect();
        self.latest = None;
        self.instants.retain(|k, _| *k == n || *k == n + 1);
        if self.lines.len() > MOST {
            self.lines.clear();
        }
    }

    /// The number of a column, which is made if there is none.
    fn column(&mut self, (i, n): (i64, i64)) -> usize {
        if let Some(place) = self.places.get(&(i, n)) {
            return *place;
        }
        let (x, t) = (i as f64 * self.along, n as f64 * self.time);
        let of = |phase: &dyn Fn(&Component) -> f64| -> Phases {
            let pair = |c| <[f64; 2]>::from(phase(c).sin_cos());
            self.waves.all.iter().map(pair).collect()
        };
        let line = self.lines.entry(i).or_insert_with(|| of(&|c| c.k * x + c.phase));
        let instant = self.instants.entry(n).or_insert_with(|| of(&|c| c.omega * t));
        let minus = |([a, b], [c, d]): (&[f64; 2], &[f64; 2])| [a * d - b * c, b * d + a * c];
        let phases: Phases = line.iter().zip(instant.iter()).map(minus).collect();
        let mut surface = [0.0; 4];
        for (c, [sin, cos]) in self.waves.all.iter().zip(&phases) {
            let own = [c.a * cos, -c.a * c.k * sin, c.a * c.omega * sin, c.a * c.k * c.omega * cos];
            surface.iter_mut().zip(own).for_each(|(sum, x)| *sum += x);
        }
        self.columns.push(Column { key: (i, n), surface, phases, corners: vec![None; self.heights.len()] });
        self.places.insert((i, n), self.columns.len() - 1);
        self.columns.len() - 1
    }
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
