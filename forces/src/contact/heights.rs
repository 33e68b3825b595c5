//! A bed whose height is known on a grid: smooth in between, with its exact distance.

use super::hollows::Hollows;
use super::shape::Gap;
use ropewalk_core::{BuildError, V3, dot};
use ropewalk_scene::file;
use std::fmt;
use std::io::Read;
use std::path::Path;

/// More heights than this are refused.
const MOST: usize = 4_000_000;
/// Iterations for the nearest point, and when they are over, in parts of the distance between two lines of the grid.
const ITERATIONS: usize = 30;
const CLOSE: f64 = 1e-13;

/// The surface `z = h(x, y)` through heights on a grid of lines along x and y.
///
/// Between four heights it is a bicubic polynomial whose slopes at the grid are central differences, so that the normal is
/// continuous everywhere; planes are planes. Beyond its borders it goes on with the slope that it has there. The distance is that
/// of the nearest point, found by Newton's method from the point straight below: exact as long as the surface isn't so hollow that
/// two of its points are nearest.
pub struct Heights {
    x: Vec<f64>,
    y: Vec<f64>,
    /// `h`, `h_x`, `h_y`, `h_xy` at each corner; along y first.
    corners: Vec<[f64; 4]>,
    /// The steepest slope that it has.
    steepest: f64,
    hollows: Hollows,
}

impl fmt::Debug for Heights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Heights on {} by {} lines", self.x.len(), self.y.len())
    }
}

/// Height, slopes and second derivatives: `h`, `h_x`, `h_y`, `h_xx`, `h_xy`, `h_yy`.
type Local = [f64; 6];

/// Slopes by central differences, by one-sided ones at the ends.
fn slopes(x: &[f64], h: impl Fn(usize) -> f64) -> Vec<f64> {
    let last = x.len() - 1;
    let chord = |k: usize| (h(k + 1) - h(k)) / (x[k + 1] - x[k]);
    (0..=last)
        .map(|k| match k {
            0 => chord(0),
            k if k == last => chord(last - 1),
            // that of the parabola through three heights
            k => {
                let (a, b) = (x[k] - x[k - 1], x[k + 1] - x[k]);
                (b * chord(k - 1) + a * chord(k)) / (a + b)
            }
        })
        .collect()
}

/// Values, first and second derivatives of the four cubics of Hermite over an interval of length `l` at `u` of it.
fn cubics(u: f64, l: f64) -> [[f64; 4]; 3] {
    let v = 1.0 - u;
    let s = u * u * (3.0 - 2.0 * u);
    let (d, e) = (6.0 * u * v / l, (6.0 - 12.0 * u) / (l * l));
    [
        [1.0 - s, l * u * v * v, s, -l * u * u * v],
        [-d, v * (1.0 - 3.0 * u), d, u * (3.0 * u - 2.0)],
        [-e, (6.0 * u - 4.0) / l, e, (6.0 * u - 2.0) / l],
    ]
}

impl Heights {
    /// The surface through heights [m] `z[i][j]` at `x[i]`, `y[j]` [m].
    ///
    /// # Errors
    /// Fewer than two lines in a direction, lines that don't ascend, rows of other lengths, numbers that aren't finite, more than
    /// four million heights.
    pub fn new(x: Vec<f64>, y: Vec<f64>, z: &[Vec<f64>]) -> Result<Self, BuildError> {
        for (field, lines) in [("x", &x), ("y", &y)] {
            ropewalk_core::error::finite(field, lines)?;
            if lines.len() < 2 || lines.windows(2).any(|w| !(w[1] > w[0])) {
                let message = format!("`{field}` of a grid needs two lines or more, in ascending order");
                return Err(BuildError::at(field, message));
            }
        }
        if x.len() * y.len() > MOST {
            let message =
                format!("the grid has {} heights, more than {MOST}: thin it out", x.len() * y.len());
            return Err(BuildError::new(message));
        }
        if z.len() != x.len() || z.iter().any(|row| row.len() != y.len()) {
            let message = format!(
                "`z` needs a row for each of the {} lines `x`, with a height for each of the {} lines `y`",
                x.len(),
                y.len()
            );
            return Err(BuildError::at("z", message));
        }
        for row in z {
            ropewalk_core::error::finite("z", row)?;
        }
        let by_y: Vec<Vec<f64>> = z.iter().map(|row| slopes(&y, |j| row[j])).collect();
        let mut corners: Vec<[f64; 4]> = Vec::with_capacity(x.len() * y.len());
        for (row, by_y) in z.iter().zip(&by_y) {
            corners.extend(row.iter().zip(by_y).map(|(h, hy)| [*h, 0.0, *hy, 0.0]));
        }
        for j in 0..y.len() {
            let (hx, hxy) = (slopes(&x, |i| z[i][j]), slopes(&x, |i| by_y[i][j]));
            for i in 0..x.len() {
                corners[i * y.len() + j][1] = hx[i];
                corners[i * y.len() + j][3] = hxy[i];
            }
        }
        let mut grid = Heights { x, y, corners, steepest: 0.0, hollows: Hollows::default() };
        let (steepest, hollow) = grid.bounds();
        (grid.steepest, grid.hollows) = (steepest, Hollows::new(&grid.x, &grid.y, &grid.corners, hollow));
        Ok(grid)
    }

    /// Reads `x`, `y`, `z` [m] from the rows of a CSV file, in any order, one for each crossing of the grid's lines; a first line
    /// that isn't numbers is a heading.
    ///
    /// # Errors
    /// What is wrong with the file, with its line.
    pub fn read(path: &Path) -> Result<Self, BuildError> {
        let wrong = |why: String| BuildError::at("file", format!("grid `{}`: {why}", path.display()));
        let mut text = String::new();
        file::open(path)
            .and_then(|mut f| f.read_to_string(&mut text).map_err(|e| e.to_string()))
            .map_err(wrong)?;
        let mut rows: Vec<V3<f64>> = Vec::new();
        for (k, line) in
            text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty() && !l.trim().starts_with('#'))
        {
            let cells: Vec<Result<f64, _>> = line.split(',').map(|c| c.trim().parse::<f64>()).collect();
            match cells[..] {
                [Ok(x), Ok(y), Ok(z)] if [x, y, z].iter().all(|x| x.is_finite()) => rows.push([x, y, z]),
                _ if rows.is_empty() && cells.iter().all(Result::is_err) => {}
                _ => {
                    return Err(wrong(format!(
                        "line {} isn't `x, y, z`: three finite numbers in metres",
                        k + 1
                    )));
                }
            }
        }
        let lines = |c: usize| {
            let mut all: Vec<f64> = rows.iter().map(|r| r[c]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        };
        let (x, y) = (lines(0), lines(1));
        if x.len().saturating_mul(y.len()) != rows.len() {
            return Err(wrong(format!(
                "{} rows don't fill a grid of {} lines x and {} lines y: it needs one height at each crossing",
                rows.len(),
                x.len(),
                y.len()
            )));
        }
        let mut z = vec![vec![f64::NAN; y.len()]; x.len()];
        for [px, py, pz] in &rows {
            let place = |lines: &[f64], p: f64| lines.partition_point(|l| *l < p);
            z[place(&x, *px)][place(&y, *py)] = *pz;
        }
        if z.iter().flatten().any(|z| z.is_nan()) {
            return Err(wrong("a place has two heights and another one none".into()));
        }
        Heights::new(x, y, &z).map_err(|e| wrong(e.message))
    }

    /// Bounds of slope and curvature of the whole, from nine places of every cell.
    fn bounds(&self) -> (f64, f64) {
        let between = |w: &[f64]| [w[0], 0.5 * (w[0] + w[1]), w[1] - 1e-12 * (w[1] - w[0])];
        let (mut steepest, mut hollow) = (0.0_f64, 0.0_f64);
        for w in self.x.windows(2) {
            for v in self.y.windows(2) {
                for (x, y) in between(w).into_iter().flat_map(|x| between(v).map(|y| (x, y))) {
                    let [_, a, b, xx, xy, yy] = self.at(x, y);
                    steepest = steepest.max(a.hypot(b));
                    hollow = hollow.max(0.5 * (xx + yy) + (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
                }
            }
        }
        // between those places a cubic rises a little above
        (1.25 * steepest, 1.25 * hollow)
    }

    /// The surface at a place.
    pub(super) fn at(&self, x: f64, y: f64) -> Local {
        let cell = |lines: &[f64], p: f64| lines.partition_point(|l| *l <= p).clamp(1, lines.len() - 1) - 1;
        let (i, j) = (cell(&self.x, x), cell(&self.y, y));
        let n = self.y.len();
        let ([x0, x1], [y0, y1]) = ([self.x[i], self.x[i + 1]], [self.y[j], self.y[j + 1]]);
        let (cx, cy) = (x.clamp(self.x[0], self.x[self.x.len() - 1]), y.clamp(self.y[0], self.y[n - 1]));
        let (px, py) = (cubics((cx - x0) / (x1 - x0), x1 - x0), cubics((cy - y0) / (y1 - y0), y1 - y0));
        let mut sum = [0.0; 6];
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let [h, hx, hy, hxy] = self.corners[(i + a) * n + j + b];
            // derivatives by x and by y of each
            for (k, (dx, dy)) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)].into_iter().enumerate() {
                let ([vx, sx], [vy, sy]) =
                    ([px[dx][2 * a], px[dx][2 * a + 1]], [py[dy][2 * b], py[dy][2 * b + 1]]);
                sum[k] += vx * vy * h + sx * vy * hx + vx * sy * hy + sx * sy * hxy;
            }
        }
        let (over_x, over_y) = (x - cx, y - cy);
        if over_x != 0.0 || over_y != 0.0 {
            let [h, hx, hy, xx, xy, yy] = sum;
            // straight on across a border, as curved as before along it
            let (xx, yy) = (if over_x == 0.0 { xx } else { 0.0 }, if over_y == 0.0 { yy } else { 0.0 });
            let on = h + hx * over_x + hy * over_y + xy * over_x * over_y;
            sum = [on, hx + xy * over_y, hy + xy * over_x, xx, xy, yy];
        }
        sum
    }

    /// How far a point is beyond the borders of the grid [m]; nought inside.
    pub(super) fn beyond(&self, x: &V3<f64>) -> f64 {
        let out = |lines: &[f64], x: f64| {
            let (first, last) = (lines[0], lines[lines.len() - 1]);
            (first - x).max(x - last).max(0.0)
        };
        out(&self.x, x[0]).hypot(out(&self.y, x[1]))
    }

    /// The surface as seen from a point.
    pub(super) fn gap(&self, x: &V3<f64>, reach: f64) -> Option<Gap> {
        let [h, a, b, ..] = self.at(x[0], x[1]);
        let above = x[2] - h;
        // nothing of the surface is nearer than this
        let least = above.abs() / self.steepest.hypot(1.0);
        if above > 0.0 && least >= reach {
            return None;
        }
        if self.hollows.most * above.abs() > 0.5 {
            // too far away for a single nearest point
            let norm = a.hypot(b).hypot(1.0);
            let distance = if above > 0.0 { least } else { -least };
            return (distance < reach).then(|| Gap::flat(distance, [-a / norm, -b / norm, 1.0 / norm]));
        }
        let mut p = [x[0], x[1]];
        let size = (self.x[1] - self.x[0]).abs().max((self.y[1] - self.y[0]).abs());
        let mut here = self.at(p[0], p[1]);
        for _ in 0..ITERATIONS {
            let [h, a, b, xx, xy, yy] = here;
            let up = h - x[2];
            let r = [p[0] - x[0] + up * a, p[1] - x[1] + up * b];
            let k = [1.0 + a * a + up * xx, a * b + up * xy, 1.0 + b * b + up * yy];
            let det = k[0] * k[2] - k[1] * k[1];
            let step = [(k[2] * r[0] - k[1] * r[1]) / det, (k[0] * r[1] - k[1] * r[0]) / det];
            p = [p[0] - step[0], p[1] - step[1]];
            here = self.at(p[0], p[1]);
            if step[0].hypot(step[1]) <= CLOSE * size {
                break;
            }
        }
        let [h, a, b, xx, xy, yy] = here;
        let norm = a.hypot(b).hypot(1.0);
        let n = [-a / norm, -b / norm, 1.0 / norm];
        let way = [x[0] - p[0], x[1] - p[1], x[2] - h];
        let distance = dot(&way, &n);
        if !(distance < reach) {
            return None;
        }
        // how the surface curves along two directions in it, and then along those in which it curves most and least
        let [u, v, _] = ropewalk_core::rotation::around(n);
        let along = |s: &V3<f64>, t: &V3<f64>| {
            (xx * s[0] * t[0] + xy * (s[0] * t[1] + s[1] * t[0]) + yy * s[1] * t[1]) / norm
        };
        let [uu, uv, vv] = [along(&u, &u), along(&u, &v), along(&v, &v)];
        let angle = 0.5 * (2.0 * uv).atan2(uu - vv);
        let (sin, cos) = angle.sin_cos();
        let s: V3<f64> = std::array::from_fn(|i| cos * u[i] + sin * v[i]);
        let t: V3<f64> = std::array::from_fn(|i| cos * v[i] - sin * u[i]);
        let bend = |way: V3<f64>| {
            let k = -along(&way, &way);
            (k / (1.0 + k * distance), way)
        };
        Some(Gap { distance, normal: n, bends: [bend(s), bend(t)] })
    }

    /// A distance that it is at least away.
    pub(super) fn at_least(&self, x: &V3<f64>) -> Option<Gap> {
        let [h, a, b, ..] = self.at(x[0], x[1]);
        let norm = a.hypot(b).hypot(1.0);
        let above = x[2] - h;
        let slope = self.steepest.hypot(1.0);
        let distance = if above > 0.0 { above / slope } else { above };
        Some(Gap::flat(distance, [-a / norm, -b / norm, 1.0 / norm]))
    }

    /// How hollow level surfaces are within `way` of a point and nearer than `reach` [1/m].
    pub(super) fn hollow(&self, x: &V3<f64>, way: f64, reach: f64) -> f64 {
        let hollow = self.hollows.within([&self.x, &self.y], [x[0], x[1]], way + reach);
        let rest = 1.0 - hollow * reach;
        if rest > 0.0 { hollow / rest } else { f64::INFINITY }
    }

    /// Corners and triangles to draw it.
    pub(super) fn surface(&self) -> (Vec<V3<f64>>, Vec<[u32; 3]>) {
        let n = self.y.len();
        let corner = |(k, c): (usize, &[f64; 4])| [self.x[k / n], self.y[k % n], c[0]];
        let corners = self.corners.iter().enumerate().map(corner).collect();
        let at = |i: usize, j: usize| (i * n + j) as u32;
        let cell = |i: usize, j: usize| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        };
        let all = (0..self.x.len() - 1).flat_map(|i| (0..n - 1).flat_map(move |j| cell(i, j)));
        (corners, all.collect())
    }
}
