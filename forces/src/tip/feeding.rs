//! The water at an end of a cable that feeds.

use crate::{AddedMass, Surface};
use ropewalk_core::held::three;
use ropewalk_core::{Assembly, At, Dual, MovingBoundary, Pattern, Power, Real, Term, Timed, V3, dot};

/// What the energy of the water beside a cable asks at an end through which material flows.
///
/// The water is closed while the cable grows: with the added mass `m_a`, the velocity `n` across the axis relative to the water, and
/// the rate `ṗ` of the material coordinate there, the end's node feels `±ṗ m_a n` and its boundary `∓½ m_a |n|²`, the upper
/// signs at the start. At an eyelet at rest in still water both are nothing.
pub struct FeedingEnd {
    /// A name, such as `hose: water at its start`.
    pub label: String,
    /// The water, and the added mass.
    pub added_mass: AddedMass,
    /// Hydrodynamic diameter of the cable [m].
    pub diameter: f64,
    /// The surface of the water, if it has one.
    pub surface: Option<Surface>,
    /// The end.
    pub boundary: MovingBoundary,
}

/// How an end moves: place, velocity, slope, rate of the material coordinate.
struct End<R> {
    x: V3<R>,
    v: V3<R>,
    slope: V3<R>,
    rate: R,
}

impl FeedingEnd {
    fn end(&self, at: &At<'_>) -> End<f64> {
        let f = &self.boundary;
        End {
            x: three(at.q, f.end_q),
            v: three(at.v, f.end_v),
            slope: three(at.q, f.end_q + 3),
            rate: at.v[f.v],
        }
    }

    /// `m_a` and `n`, over single numbers.
    fn across<R: Real>(&self, t: f64, end: &End<R>) -> (R, V3<R>) {
        let u = self.added_mass.fluid(t, &end.x);
        let wet = self
            .surface
            .as_ref()
            .map_or(R::of(1.0), |surface| surface.ball(t, &end.x, 0.5 * self.diameter).0);
        let w: V3<R> = std::array::from_fn(|i| end.v[i] - u[i]);
        let along = dot(&w, &end.slope) / dot(&end.slope, &end.slope);
        let n = std::array::from_fn(|i| w[i] - along * end.slope[i]);
        (wet * self.added_mass.mass(R::of(self.diameter)), n)
    }

    /// The force on the node, and that on the boundary, over single numbers.
    fn force<R: Real>(&self, t: f64, end: &End<R>) -> [R; 4] {
        let (mass, n) = self.across(t, end);
        // the sign of a boundary is -1 at the start
        let sign = R::of(-self.boundary.sign) * mass;
        let f = n.map(|n| sign * end.rate * n);
        [f[0], f[1], f[2], -(R::of(0.5) * sign * dot(&n, &n))]
    }
}

impl Term for FeedingEnd {
    fn label(&self) -> String {
        self.label.clone()
    }
    fn pattern(&self, p: &mut Pattern) {
        let f = &self.boundary;
        p.clique((f.end_v..f.end_v + 6).chain([f.v]));
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn is_load(&self) -> bool {
        true
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        let (f, end) = (&self.boundary, self.end(at));
        let force = self.force(at.t, &end);
        for i in 0..3 {
            out.add(f.end_v + i, -force[i]);
        }
        out.add(f.v, -force[3]);
        if !out.wants_tangent() {
            return;
        }
        let w = out.weights();
        let by: [[f64; 4]; 7] = std::array::from_fn(|j| {
            let d = |here: bool, weight: f64| if here { weight } else { 0.0 };
            let moved = End {
                x: std::array::from_fn(|i| Dual::new(end.x[i], d(j == i, w.q))),
                v: std::array::from_fn(|i| Dual::new(end.v[i], d(j == i, w.v))),
                slope: std::array::from_fn(|i| Dual::new(end.slope[i], d(j == 3 + i, w.q))),
                rate: Dual::new(end.rate, d(j == 6, w.v)),
            };
            self.force(at.t, &moved).map(|f| f.eps)
        });
        out.add_block(0, 7, |i, j| match i {
            0..3 => -by[j][i],
            6 => -by[j][3],
            _ => 0.0,
        });
    }
    fn power(&self, at: &At<'_>) -> Power {
        let end = self.end(at);
        let (mass, n) = self.across(at.t, &end);
        let u = self.added_mass.fluid(at.t, &end.x);
        Power { supplied: -self.boundary.sign * end.rate * mass * dot(&n, &u), ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        self.added_mass.sea.as_ref().map(|_| self as &dyn Timed)
    }
}

impl Timed for FeedingEnd {
    fn reach(&self, _t: f64, h: f64) -> Option<f64> {
        Some(self.added_mass.sea.as_ref().map_or(h, |sea| sea.reach(h)))
    }
    fn period(&self, _t: f64) -> f64 {
        self.added_mass.sea.as_ref().map_or(f64::INFINITY, |sea| sea.period())
    }
}
