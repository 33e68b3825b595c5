//! What resists bending at the joints of a chain.

use ropewalk_core::held::three;
use ropewalk_core::rotation::{M3, cross, matrix, product, skew, times, transposed_times};
use ropewalk_core::{Assembly, At, Energy, Pattern, Power, Term, V3, dot};

/// One joint between two links, by the first coordinates and velocities of their nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// First coordinate of each link.
    pub q: [usize; 2],
    /// First velocity of each link.
    pub v: [usize; 2],
    /// Where the second link points without bending moment: a unit vector in the axes of the first.
    pub rest: V3<f64>,
}

/// Springs and dampers at the joints of a chain.
///
/// A spring resists the angle `θ` between the second link's direction and that in which it is free of moment, with the
/// energy `k (1 - cos θ)`: `k = EI / l` makes a beam of it as links grow in number. It doesn't resist twist. A damper
/// takes the moment `c` times the relative angular velocity about every axis, so that no link spins for ever.
#[derive(Clone, Debug, PartialEq)]
pub struct Bends {
    /// A name, such as `hose: joints`.
    pub label: String,
    /// Stiffness `k` [N m/rad].
    pub stiffness: f64,
    /// Damping `c` [N m s/rad].
    pub damping: f64,
    /// The joints.
    pub joints: Vec<Bend>,
}

/// The direction of a link in its own axes.
const AHEAD: V3<f64> = [1.0, 0.0, 0.0];

impl Bend {
    /// Turns vectors of the second link into the axes of the first.
    fn between(&self, at: &At<'_>) -> M3 {
        let [a, b] = self.q.map(|q| matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]));
        // aᵀ b
        let column = |m: &M3, i: usize| [m[0][i], m[1][i], m[2][i]];
        std::array::from_fn(|i| std::array::from_fn(|j| dot(&column(&a, i), &column(&b, j))))
    }
    fn spins(&self, at: &At<'_>) -> [V3<f64>; 2] {
        self.v.map(|v| three(at.v, v + 3))
    }
}

fn transposed(a: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

impl Term for Bends {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        for j in &self.joints {
            p.clique(j.v.iter().flat_map(|v| v + 3..v + 6));
        }
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (k, c, w) = (self.stiffness, self.damping, out.weights());
        for (n, joint) in self.joints.iter().enumerate() {
            let b = joint.between(at);
            let [one, two] = joint.spins(at);
            // each link's own view of the other's direction and spin
            let (ahead, rest) = (times(&b, &AHEAD), transposed_times(&b, &joint.rest));
            let (spin_two, spin_one) = (times(&b, &two), transposed_times(&b, &one));
            let (m0, m1) = (cross(&joint.rest, &ahead), cross(&AHEAD, &rest));
            for i in 0..3 {
                out.add(joint.v[0] + 3 + i, -k * m0[i] + c * (one[i] - spin_two[i]));
                out.add(joint.v[1] + 3 + i, -k * m1[i] + c * (two[i] - spin_one[i]));
            }
            if !out.wants_tangent() {
                continue;
            }
            let back = transposed(&b);
            let (u, e) = (skew(&joint.rest), skew(&AHEAD));
            let bend = [
                [product(&u, &skew(&ahead)), product(&u, &product(&b, &e))],
                [product(&e, &product(&back, &u)), product(&e, &skew(&rest))],
            ];
            let turn =
                [[skew(&spin_two), product(&b, &skew(&two))], [product(&back, &skew(&one)), skew(&spin_one)]];
            let block = |row: usize, column: usize, i: usize, j: usize| -> f64 {
                let sign = if row == column { -1.0 } else { 1.0 };
                let slip = match (row, column) {
                    (0, 1) => -b[i][j],
                    (1, 0) => -back[i][j],
                    _ => f64::from(i == j),
                };
                w.q * sign * (k * bend[row][column][i][j] + c * turn[row][column][i][j]) + w.v * c * slip
            };
            out.add_block(n, 6, |i, j| block(i / 3, j / 3, i % 3, j % 3));
        }
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        let bent = |j: &Bend| 1.0 - dot(&j.rest, &times(&j.between(at), &AHEAD));
        Energy { potential: self.stiffness * self.joints.iter().map(bent).sum::<f64>(), ..Energy::default() }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let slip = |j: &Bend| -> f64 {
            let ([one, two], b) = (j.spins(at), j.between(at));
            let seen = times(&b, &two);
            (0..3).map(|i| (seen[i] - one[i]).powi(2)).sum()
        };
        Power { dissipated: self.damping * self.joints.iter().map(slip).sum::<f64>(), ..Power::default() }
    }
}
