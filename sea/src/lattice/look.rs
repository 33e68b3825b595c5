//! The motion of the water at stations, over lanes.

use super::{Lattice, SPOTS, hermite, slopes};
use crate::waves::Flow;
use ropewalk_core::Real;

/// As many lanes as the widest carrier has.
const LANES: usize = 8;

/// What is known of the table around stations side by side: it stays the same until one of them gets to another spot, or the
/// time to another instant.
#[derive(Clone, Debug)]
pub struct Stations {
    /// How many there are: as many others know nothing of these.
    lanes: usize,
    /// The spots along the waves and the instant that the surface was asked for, and those that the water was.
    nearest: [[f64; LANES]; 2],
    n: [i64; 2],
    /// The surface there, number by number.
    edges: [[f64; LANES]; 16],
    /// The heights at which the cells begin that they are in, and how high these are [m].
    tops: [f64; LANES],
    sizes: [f64; LANES],
    /// How many spots below that each is.
    numbers: [f64; LANES],
    /// The water there.
    spots: [[f64; LANES]; 32],
}

impl Default for Stations {
    /// Of nothing.
    fn default() -> Self {
        let nowhere = [f64::NAN; LANES];
        Stations {
            lanes: 0,
            nearest: [nowhere; 2],
            n: [0; 2],
            edges: [[0.0; LANES]; 16],
            tops: nowhere,
            sizes: nowhere,
            numbers: nowhere,
            spots: [[0.0; LANES]; 32],
        }
    }
}

impl Stations {
    /// Whether one of them is still where it was, if it is at this height.
    fn is_at(&self, lane: usize, up: f64) -> bool {
        let (down, size) = (self.tops[lane] - up, self.sizes[lane]);
        down >= 0.0 && down < size && (down * SPOTS / size + 0.5).floor() == self.numbers[lane]
    }
}

/// An instant and how far it is from it to the next, in parts of their distance.
#[derive(Clone, Copy)]
struct Instant {
    n: i64,
    late: f64,
}

/// Polynomials in time of values and rates at both instants, and their derivatives [1/s].
struct Blend {
    value: [f64; 4],
    rate: [f64; 4],
}

impl Blend {
    #[inline(always)]
    fn of<R: Real>(weights: &[f64; 4], [a, da, b, db]: [R; 4]) -> R {
        let [h, dh, g, dg] = *weights;
        R::of(h).fma(a, R::of(dh).fma(da, R::of(g).fma(b, R::of(dg) * db)))
    }
}

impl Lattice {
    /// The motion of the water, as [`Waves::at`](crate::Waves::at) gives it, but for the pressure, which is left out.
    pub fn at(&mut self, [x, y, z]: [f64; 3], t: f64) -> Flow {
        let mut stations = Stations::default();
        let mut flow = self.surface(t, [x, y], &mut stations);
        self.within(t, [x, y, z], &mut stations, &mut flow);
        flow
    }

    fn instant(&self, t: f64) -> Instant {
        let instant = t / self.time;
        let n = instant.floor();
        Instant { n: n as i64, late: instant - n }
    }

    fn blend(&self, late: f64) -> Blend {
        let tau = self.time;
        let ([a, da, b, db], [ra, rda, rb, rdb]) = (hermite(late), slopes(late));
        Blend { value: [a, tau * da, b, tau * db], rate: [ra / tau, rda, rb / tau, rdb] }
    }

    /// How far spots are apart along the waves [m].
    fn spot(&self) -> f64 {
        self.along / SPOTS
    }

    /// The surface above places, of a flow of which nothing else is known.
    #[inline(always)]
    pub fn surface<R: Real>(&mut self, t: f64, place: [R; 2], stations: &mut Stations) -> Flow<R> {
        if stations.lanes != R::LANES {
            *stations = Stations { lanes: R::LANES, ..Stations::default() };
        }
        let Instant { n, late } = self.instant(t);
        let (nearest, off) = self.nearest(place);
        if stations.n[0] != n || !same::<R>(&nearest, &stations.nearest[0]) {
            self.meet_surface(&nearest, n, R::LANES, stations);
        }
        let edges = &stations.edges;
        let Blend { value, rate } = self.blend(late);
        let (mut now, mut rates) = ([R::zero(); 3], [R::zero(); 3]);
        for k in 0..3 {
            let four = read(edges, [k, 4 + k, 8 + k, 12 + k]);
            now[k] = Blend::of(&value, four);
            rates[k] = Blend::of(&rate, four);
        }
        let ([elevation, steep, bend], [rising, steepening, bending]) = (now, rates);
        let half = R::of(0.5) * off;
        let elevation = off.fma(half.fma(bend, steep), elevation);
        let rate = off.fma(half.fma(bending, steepening), rising);
        let steep = off.fma(bend, steep);
        let [risen, rises] = self.waves.risen(t);
        let (risen, rises, [cx, cy]) = (R::of(risen), R::of(rises), self.way);
        Flow {
            elevation: risen * elevation,
            slope: [risen * steep * R::of(cx), risen * steep * R::of(cy)],
            rising: risen.fma(rate, rises * elevation),
            ..Flow::still()
        }
    }

    /// The numbers of the nearest spots along the waves, and how far places are from them [m].
    #[inline(always)]
    fn nearest<R: Real>(&self, [x, y]: [R; 2]) -> ([f64; LANES], R) {
        let spot = self.spot();
        let along = x.fma(R::of(self.way[0]), y * R::of(self.way[1]));
        let numbers = rounded(along * R::of(1.0 / spot));
        (numbers, along - R::read(&numbers) * R::of(spot))
    }

    /// Adds to a flow, of which the surface is known, what is under it at places: under still water if stretched so.
    #[inline(always)]
    pub fn within<R: Real>(
        &mut self,
        t: f64,
        [x, y, z]: [R; 3],
        stations: &mut Stations,
        flow: &mut Flow<R>,
    ) {
        let Instant { n, late } = self.instant(t);
        let (nearest, across) = self.nearest([x, y]);
        let [up, by_z, by_eta] = self.waves.stretched(z, flow.elevation);
        let (top, size) = (R::read(&stations.tops), R::read(&stations.sizes));
        let mut numbers = rounded((top - up) * R::of(SPOTS) / size);
        if stations.n[1] != n
            || !same::<R>(&nearest, &stations.nearest[1])
            || !same::<R>(&numbers, &stations.numbers)
            || !inside(top - up, size)
        {
            up.write(&mut numbers);
            self.meet(&nearest, &numbers, n, R::LANES, stations);
        }
        let (top, size) = (R::read(&stations.tops), R::read(&stations.sizes));
        let upwards = up - top + R::read(&stations.numbers) * size * R::of(1.0 / SPOTS);
        let spots = &stations.spots;
        let Blend { value, rate } = self.blend(late);
        // values of u and w, along the waves, upwards, and along them twice; and their rates
        let (mut now, mut rates) = ([[R::zero(); 2]; 4], [[R::zero(); 2]; 4]);
        for k in 0..4 {
            for i in 0..2 {
                let first = 4 * k + i;
                let four = read(spots, [first, first + 2, first + 16, first + 18]);
                now[k][i] = Blend::of(&value, four);
                rates[k][i] = Blend::of(&rate, four);
            }
        }
        let (u, du) = (around(now, [across, upwards]), around(rates, [across, upwards]));
        let [cx, cy] = [R::of(self.way[0]), R::of(self.way[1])];
        // as one sees it who drifts with the current
        let current = R::of(self.current);
        let [a, b] = [current.fma(u[1][0], du[0][0]), current.fma(u[1][1], du[0][1])];
        flow.velocity = [u[0][0] * cx, u[0][0] * cy, u[0][1]];
        flow.acceleration = [a * cx, a * cy, b];
        // of what drifting adds to the acceleration the change from place to place is left out
        (flow.gradient, flow.acceleration_gradient) = (turned(&u, [cx, cy]), turned(&du, [cx, cy]));
        flow.rise(self.waves.risen(t), [by_z, by_eta], self.waves.current);
    }

    /// Finds the surface at these spots.
    #[cold]
    #[inline(never)]
    fn meet_surface(&mut self, nearest: &[f64; LANES], n: i64, lanes: usize, stations: &mut Stations) {
        for lane in 0..lanes {
            if stations.n[0] == n && stations.nearest[0][lane] == nearest[lane] {
                continue;
            }
            let number = nearest[lane] as i64;
            for (rows, n) in stations.edges.chunks_exact_mut(8).zip(n..) {
                let (place, known) = self.edges.find([number, 0, n]);
                if !known {
                    *self.edges.numbers(place) = self.edge(number, n);
                }
                let numbers = self.edges.numbers(place);
                rows.iter_mut().zip(numbers).for_each(|(row, x)| row[lane] = *x);
            }
        }
        (stations.nearest[0], stations.n[0]) = (*nearest, n);
    }

    /// Finds the spots along the waves and at these heights.
    #[cold]
    #[inline(never)]
    fn meet(
        &mut self,
        nearest: &[f64; LANES],
        up: &[f64; LANES],
        n: i64,
        lanes: usize,
        stations: &mut Stations,
    ) {
        for lane in 0..lanes {
            if stations.n[1] == n
                && stations.nearest[1][lane] == nearest[lane]
                && stations.is_at(lane, up[lane])
            {
                continue;
            }
            let j = self.heights.partition_point(|h| *h > up[lane]).clamp(1, self.heights.len() - 1) - 1;
            let (top, size) = (self.heights[j], self.heights[j] - self.heights[j + 1]);
            let number = ((top - up[lane]) * SPOTS / size + 0.5).floor();
            let along = nearest[lane] as i64;
            let down = ((j as i64) << 32).wrapping_add(number as i64);
            for (rows, n) in stations.spots.chunks_exact_mut(16).zip(n..) {
                let (place, known) = self.spots.find([along, down, n]);
                if !known {
                    *self.spots.numbers(place) = self.around(along, (j, top - number * size / SPOTS), n);
                }
                let numbers = self.spots.numbers(place);
                rows.iter_mut().zip(numbers).for_each(|(row, x)| row[lane] = *x);
            }
            (stations.tops[lane], stations.sizes[lane], stations.numbers[lane]) = (top, size, number);
        }
        (stations.nearest[1], stations.n[1]) = (*nearest, n);
    }

    /// The two lines between which a place is, of those that are so far apart, and where it is between them.
    fn between(&self, x: f64, level: u32) -> ([i64; 2], f64) {
        let apart = 1_i64 << level;
        let place = x / (self.along * apart as f64);
        let i = place.floor();
        let first = i as i64 * apart;
        ([first, first + apart], place - i)
    }

    /// The surface at a spot at an instant: elevation, slope, its change, and a nought; then the rates of these.
    fn edge(&mut self, spot: i64, n: i64) -> [f64; 8] {
        let (lines, across) = self.between(spot as f64 * self.spot(), 0);
        let (h, dh) = (hermite(across), slopes(across));
        self.columns.forget_far(n);
        let [a, b] = lines.map(|i| self.columns.top(i, n));
        let between = |w: &[f64; 4], k: usize, size: f64| {
            w[0] * a[k] + w[2] * b[k] + size * (w[1] * a[k + 1] + w[3] * b[k + 1])
        };
        let mut out = [0.0; 8];
        for rate in 0..2 {
            let (k, to) = (3 * rate, &mut out[4 * rate..]);
            to[0] = between(&h, k, self.along);
            to[1] = between(&dh, k, self.along) / self.along;
            to[2] = between(&dh, k + 1, self.along) / self.along;
        }
        out
    }

    /// The water at a spot below height `j` at an instant: `u`, `w` and their rates; the same along the waves, upwards, and
    /// along the waves twice.
    fn around(&mut self, spot: i64, (j, up): (usize, f64), n: i64) -> [f64; 16] {
        let mut out = [0.0; 16];
        let bottom = self.heights[self.heights.len() - 1];
        if up < bottom && self.waves.depth().is_infinite() {
            // nothing moves there
            return out;
        }
        let level = self.levels[j];
        let (lines, across) = self.between(spot as f64 * self.spot(), level);
        let size = self.along * (1_i64 << level) as f64;
        let height = self.heights[j] - self.heights[j + 1];
        let depth = (self.heights[j] - up) / height;
        let (hx, dx, hz, dz) = (hermite(across), slopes(across), hermite(depth), slopes(depth));
        self.columns.forget_far(n);
        for k in 0..2 {
            // along the waves: u, u_x, w, w_x and their rates, and what each of them changes by
            let (mut a, mut b) = ([0.0; 8], [0.0; 8]);
            for end in 0..2 {
                let corner = self.columns.corner(lines[end], j + k, n);
                let (value, change) = corner.split_at(8);
                let ([x, g], [by, dg]) =
                    ([hx[2 * end], dx[2 * end] / size], [hx[2 * end + 1] * size, dx[2 * end + 1]]);
                for m in 0..8 {
                    a[m] += x * value[m] + by * change[m];
                    b[m] += g * value[m] + dg * change[m];
                }
            }
            // heights count downwards; u_z = w_x, w_z = -u_x
            let (z, by_z) = (hz[2 * k], -hz[2 * k + 1] * height);
            let (g, by_g) = (-dz[2 * k] / height, dz[2 * k + 1]);
            let share = if k == 0 { 1.0 - depth } else { depth };
            for rate in 0..2 {
                let (m, to) = (4 * rate, &mut out[2 * rate..]);
                to[0] += z * a[m] + by_z * a[m + 3];
                to[1] += z * a[m + 2] - by_z * a[m + 1];
                to[4] += z * b[m] + by_z * b[m + 3];
                to[5] += z * b[m + 2] - by_z * b[m + 1];
                to[8] += g * a[m] + by_g * a[m + 3];
                to[9] += g * a[m + 2] - by_g * a[m + 1];
                to[12] += share * b[m + 1];
                to[13] += share * b[m + 3];
            }
        }
        out
    }
}

/// Whole numbers next to these.
#[inline(always)]
fn rounded<R: Real>(x: R) -> [f64; LANES] {
    let mut numbers = [0.0; LANES];
    x.write(&mut numbers);
    for x in &mut numbers[..R::LANES] {
        *x = (*x + 0.5).floor();
    }
    numbers
}

/// Whether they are the same in all lanes; what is no number never is.
#[inline(always)]
fn same<R: Real>(a: &[f64; LANES], b: &[f64; LANES]) -> bool {
    let mut same = true;
    for lane in 0..R::LANES {
        same &= a[lane] == b[lane];
    }
    same
}

/// Whether all are within cells of these sizes.
#[inline(always)]
fn inside<R: Real>(down: R, size: R) -> bool {
    let (mut all, mut most) = ([0.0; LANES], [0.0; LANES]);
    down.write(&mut all);
    size.write(&mut most);
    let mut inside = true;
    for lane in 0..R::LANES {
        inside &= (all[lane] >= 0.0) & (all[lane] < most[lane]);
    }
    inside
}

/// Four rows of numbers.
#[inline(always)]
fn read<R: Real, const N: usize>(rows: &[[f64; LANES]; N], [a, b, c, d]: [usize; 4]) -> [R; 4] {
    [R::read(&rows[a]), R::read(&rows[b]), R::read(&rows[c]), R::read(&rows[d])]
}

/// `u` and `w` so far from a spot, and what they change by along the waves and upwards. Their second derivatives upwards are
/// those along the waves with the other sign, `u_xz = w_xx` and `w_xz = -u_xx`.
#[inline(always)]
fn around<R: Real>([at, by_x, by_z, bend]: [[R; 2]; 4], [x, z]: [R; 2]) -> [[R; 2]; 3] {
    let [[u, w], [ux, wx], [uz, wz], [uxx, wxx]] = [at, by_x, by_z, bend];
    let (square, both) = (R::of(0.5) * (x * x - z * z), x * z);
    [
        [
            x.fma(ux, z.fma(uz, square.fma(uxx, both.fma(wxx, u)))),
            x.fma(wx, z.fma(wz, square.fma(wxx, w - both * uxx))),
        ],
        [x.fma(uxx, z.fma(wxx, ux)), x.fma(wxx, wx - z * uxx)],
        [x.fma(wxx, uz - z * uxx), wz - x * uxx - z * wxx],
    ]
}

/// What a vector in the plane of the waves changes by from place to place, in space.
#[inline(always)]
fn turned<R: Real>([_, x, z]: &[[R; 2]; 3], [cx, cy]: [R; 2]) -> [[R; 3]; 3] {
    let (ux, uy) = (x[0] * cx, x[0] * cy);
    [[ux * cx, ux * cy, z[0] * cx], [ux * cy, uy * cy, z[0] * cy], [x[1] * cx, x[1] * cy, z[1]]]
}
