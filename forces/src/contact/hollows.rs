//! How hollow a bed on a grid is, cell by cell: a flat is searched as a plane is, whatever rises elsewhere.

/// A window of more cells than this is taken for the whole bed.
const MOST: usize = 16;

/// Bounds of the curvature of each cell towards whoever is above [1/m]; 0 where it bends away or is flat.
#[derive(Default)]
pub(super) struct Hollows {
    cells: Vec<f64>,
    /// The largest of them, or a better bound of the whole.
    pub(super) most: f64,
}

/// The largest curvature of a bicubic cell of the size `lx` by `ly` that its control points allow. Its corners come along
/// y first, each with `h`, `h_x`, `h_y`, `h_xy`.
fn bound(corners: [&[f64; 4]; 4], [lx, ly]: [f64; 2]) -> f64 {
    let mut net = [[0.0; 4]; 4];
    for (k, [h, hx, hy, hxy]) in corners.into_iter().enumerate() {
        let (right, up) = (k / 2, k % 2);
        // from a corner inwards
        let (dx, dy) = (lx / 3.0 * [1.0, -1.0][right], ly / 3.0 * [1.0, -1.0][up]);
        let (i, j) = (3 * right, 3 * up);
        let (i1, j1) = (1 + right, 1 + up);
        net[i][j] = *h;
        net[i1][j] = h + dx * hx;
        net[i][j1] = h + dy * hy;
        net[i1][j1] = h + dx * hx + dy * hy + dx * dy * hxy;
    }
    let (mut most, mut twist) = (0.0_f64, 0.0_f64);
    for (i, j) in (0..2).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let along_x = net[i][j] - 2.0 * net[i + 1][j] + net[i + 2][j];
        let along_y = net[j][i] - 2.0 * net[j][i + 1] + net[j][i + 2];
        most = most.max(6.0 * along_x / (lx * lx)).max(6.0 * along_y / (ly * ly));
    }
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let mixed = net[i + 1][j + 1] - net[i + 1][j] - net[i][j + 1] + net[i][j];
        twist = twist.max(9.0 * mixed.abs() / (lx * ly));
    }
    most + twist
}

impl Hollows {
    /// Of the surface through these corners, which is nowhere more hollow than `most`.
    pub(super) fn new(x: &[f64], y: &[f64], corners: &[[f64; 4]], most: f64) -> Self {
        let n = y.len();
        let mut cells = Vec::with_capacity((x.len() - 1) * (n - 1));
        for (i, a) in x.windows(2).enumerate() {
            for (j, b) in y.windows(2).enumerate() {
                let at = |i: usize, j: usize| &corners[i * n + j];
                let around = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
                cells.push(bound(around, [a[1] - a[0], b[1] - b[0]]).min(most));
            }
        }
        Hollows { cells, most }
    }

    /// The same of what is within `way` of a place along x and along y.
    pub(super) fn within(&self, [x, y]: [&[f64]; 2], at: [f64; 2], way: f64) -> f64 {
        let window = |lines: &[f64], at: f64| {
            let cell = |p: f64| lines.partition_point(|l| *l <= p).clamp(1, lines.len() - 1) - 1;
            cell(at - way)..=cell(at + way)
        };
        let (i, j) = (window(x, at[0]), window(y, at[1]));
        if (i.end() - i.start() + 1) * (j.end() - j.start() + 1) > MOST {
            return self.most;
        }
        i.flat_map(|i| j.clone().map(move |j| (i, j)))
            .map(|(i, j)| self.cells[i * (y.len() - 1) + j])
            .fold(0.0, f64::max)
    }
}
