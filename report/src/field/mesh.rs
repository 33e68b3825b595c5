//! Triangles: of shapes from files, and of round ones where only triangles will do.

use std::collections::HashMap;
use std::f64::consts::TAU;

/// Triangles over shared points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The corners [m].
    pub points: Vec<[f64; 3]>,
    /// Indices of the corners of each triangle, anticlockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Corners of a circle.
const AROUND: u32 = 32;

impl Mesh {
    /// A ball of parallels and meridians.
    pub(super) fn ball(radius: f64) -> Self {
        let rings = AROUND / 2;
        let mut points = vec![[0.0, 0.0, -radius]];
        for ring in 1..rings {
            let polar = 0.5 * TAU * f64::from(ring) / f64::from(rings);
            points.extend(circle(radius * polar.sin(), -radius * polar.cos()));
        }
        points.push([0.0, 0.0, radius]);
        let mut triangles = Vec::new();
        for k in 0..AROUND {
            let next = (k + 1) % AROUND;
            triangles.push([0, 1 + next, 1 + k]);
            for ring in 0..rings - 2 {
                band(&mut triangles, 1 + ring * AROUND, 1 + (ring + 1) * AROUND, k, next);
            }
            let last = 1 + (rings - 2) * AROUND;
            triangles.push([last + k, last + next, last + AROUND]);
        }
        Self { points, triangles }
    }

    /// A cylinder along z, with or without its ends.
    pub(super) fn cylinder(radius: f64, half: f64, closed: bool) -> Self {
        let mut points = circle(radius, -half);
        points.extend(circle(radius, half));
        points.extend([[0.0, 0.0, -half], [0.0, 0.0, half]]);
        let mut triangles = Vec::new();
        for k in 0..AROUND {
            let next = (k + 1) % AROUND;
            band(&mut triangles, 0, AROUND, k, next);
            if closed {
                triangles.push([2 * AROUND, next, k]);
                triangles.push([2 * AROUND + 1, AROUND + k, AROUND + next]);
            }
        }
        Self { points, triangles }
    }

    /// A cuboid.
    pub(super) fn cuboid(half: [f64; 3]) -> Self {
        let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        let points = (0..8).map(|k| [0, 1, 2].map(|i| half[i] * sign(k >> i & 1))).collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Self { points, triangles }
    }

    /// A coarser mesh of at most about `limit` triangles: corners that share a cell of a grid become one.
    pub(crate) fn coarser(&self, limit: usize) -> Self {
        let low = [0, 1, 2].map(|i| self.points.iter().fold(f64::INFINITY, |m, x| m.min(x[i])));
        let high = [0, 1, 2].map(|i| self.points.iter().fold(f64::NEG_INFINITY, |m, x| m.max(x[i])));
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let mut cells = 2.0 * (limit as f64).sqrt();
        loop {
            let mesh = self.on_grid(low, size / cells);
            if mesh.triangles.len() <= limit || cells < 2.0 || !size.is_finite() {
                return mesh;
            }
            cells *= 0.8;
        }
    }

    fn on_grid(&self, low: [f64; 3], cell: f64) -> Self {
        let mut found: HashMap<[i64; 3], u32> = HashMap::new();
        let mut mesh = Self::default();
        let index: Vec<u32> = self
            .points
            .iter()
            .map(|x| {
                let place = [0, 1, 2].map(|i| ((x[i] - low[i]) / cell).floor() as i64);
                *found.entry(place).or_insert_with(|| {
                    mesh.points.push(*x);
                    mesh.points.len() as u32 - 1
                })
            })
            .collect();
        let corner = |k: &u32| index.get(*k as usize).copied();
        for [a, b, c] in &self.triangles {
            if let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c))
                && a != b
                && b != c
                && c != a
            {
                mesh.triangles.push([a, b, c]);
            }
        }
        mesh
    }
}

fn circle(radius: f64, z: f64) -> Vec<[f64; 3]> {
    let angles = (0..AROUND).map(|k| TAU * f64::from(k) / f64::from(AROUND));
    angles.map(|a| [radius * a.cos(), radius * a.sin(), z]).collect()
}

/// Two triangles between a lower and an upper circle.
fn band(triangles: &mut Vec<[u32; 3]>, lower: u32, upper: u32, k: u32, next: u32) {
    triangles.push([lower + k, lower + next, upper + next]);
    triangles.push([lower + k, upper + next, upper + k]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive only if all triangles face outwards.
    fn volume(mesh: &Mesh) -> f64 {
        let six = mesh.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|k| mesh.points[k as usize]);
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        });
        six.sum::<f64>() / 6.0
    }

    /// In a closed surface each edge is run through once either way.
    fn closed(mesh: &Mesh) -> bool {
        let edges = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        let all: std::collections::HashSet<_> = mesh.triangles.iter().flat_map(edges).collect();
        all.len() == 3 * mesh.triangles.len() && all.iter().all(|(a, b)| all.contains(&(*b, *a)))
    }

    #[test]
    fn solids_are_closed_and_enclose_their_volume() {
        let cases = [
            (Mesh::cuboid([1.0, 2.0, 3.0]), 48.0, 1e-14),
            (Mesh::cylinder(2.0, 1.5, true), 1.5 * TAU * 4.0, 0.01),
            (Mesh::ball(2.0), 8.0 * TAU * 2.0 / 3.0, 0.02),
        ];
        for (mesh, exact, tolerance) in cases {
            assert!(closed(&mesh));
            assert!((volume(&mesh) / exact - 1.0).abs() < tolerance, "{} {exact}", volume(&mesh));
        }
        assert!(!closed(&Mesh::cylinder(2.0, 1.5, false)));
    }

    #[test]
    fn a_coarser_mesh_keeps_its_extent() {
        let fine = Mesh::ball(1.0);
        let coarse = fine.coarser(200);
        assert!(coarse.triangles.len() <= 200 && coarse.triangles.len() > 50, "{}", coarse.triangles.len());
        assert!((volume(&coarse) / volume(&fine) - 1.0).abs() < 0.2);
        assert_eq!(fine.coarser(1_000_000).triangles.len(), fine.triangles.len());
    }
}
