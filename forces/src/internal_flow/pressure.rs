//! The pressure in a bore, and what the wall carries of a cable's tension.

use super::term::{InternalFlow, Piece, nodal, shapes};
use ropewalk_core::{At, Shows, V3, dot};
use std::f64::consts::PI;

/// What a record asks for.
pub(crate) const PRESSURE: &str = "internal pressure";
/// By how much the wall carries more than the effective tension.
pub(crate) const WALL: &str = "wall tension above the effective one";

/// The bore, what the fluid meets where it leaves, and what is around.
#[derive(Clone, Debug, PartialEq)]
pub struct Bore {
    /// Inner diameter of the unstretched cable [m].
    pub diameter: f64,
    /// Density of the fluid [kg/m³].
    pub density: f64,
    /// Darcy's friction factor.
    pub friction: f64,
    /// Pressure above that of the surroundings behind the outlet, or of a closed loop at its start [Pa].
    pub outlet: f64,
    /// Water around it: specific weight [N/m³], height of its surface [m], and outer diameter of the cable [m].
    pub water: Option<[f64; 3]>,
}

impl Bore {
    /// Pressure of the water around at a height [Pa].
    fn outside(&self, z: f64) -> f64 {
        self.water.map_or(0.0, |[weight, level, _]| weight * (level - z).max(0.0))
    }
}

const GAUSS: [[f64; 2]; 3] =
    [[0.112_701_665_379_258_31, 5.0 / 18.0], [0.5, 4.0 / 9.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];

impl InternalFlow {
    /// Element and share of it at an arc length.
    fn find(&self, s: f64) -> Option<(usize, f64)> {
        let mut start = 0.0;
        for (k, piece) in self.pieces.iter().enumerate() {
            let xi = (s - start) / piece.length;
            if xi <= 1.0 || k + 1 == self.pieces.len() {
                return (-1e-9..=1.0 + 1e-9).contains(&xi).then(|| (k, xi.clamp(0.0, 1.0)));
            }
            start += piece.length;
        }
        None
    }

    /// Rise of the pressure over a part of an element, between two shares of it: against the fluid's acceleration, with its
    /// weight, against friction.
    fn rise(&self, piece: &Piece, [from, to]: [f64; 2], [u, du]: [f64; 2], at: &At<'_>) -> f64 {
        let Some(bore) = &self.bore else { return f64::NAN };
        let (q, v, a) = (nodal(at.q, piece.q), nodal(at.v, piece.v), nodal(at.a, piece.v));
        let mut rise = 0.0;
        for [x, weight] in GAUSS {
            let [value, slope, bend] = shapes(from + x * (to - from), piece.length);
            let sum = |n: &[f64; 4], x: &[V3<f64>; 4]| -> V3<f64> {
                std::array::from_fn(|c| (0..4).map(|i| n[i] * x[i][c]).sum())
            };
            let (p, turn, bow) = (sum(&slope, &q), sum(&slope, &v), sum(&bend, &q));
            let own = sum(&value, &a);
            let less: V3<f64> = std::array::from_fn(|c| {
                self.gravity[c] - own[c] - 2.0 * u * turn[c] - u * u * bow[c] - du * p[c]
            });
            let stretch = dot(&p, &p).sqrt();
            let speed = u * stretch;
            let friction = bore.friction * speed * speed.abs() / (2.0 * bore.diameter) * stretch;
            rise += weight * (to - from) * piece.length * bore.density * (dot(&less, &p) - friction);
        }
        rise
    }

    /// Pressure above that of the air at a place of an element [Pa].
    fn pressure(&self, (k, xi): (usize, f64), at: &At<'_>) -> f64 {
        let Some(bore) = &self.bore else { return f64::NAN };
        let flow = self.flow(at.t);
        let last = self.pieces.len() - 1;
        // from the outlet, where it is known, towards the place
        let forwards = flow[0] >= 0.0 && !self.closed;
        let (end, piece) = if forwards { (1, last) } else { (0, 0) };
        let node = nodal(at.q, self.pieces[piece].q);
        let (place, slope) = (node[2 * end], node[2 * end + 1]);
        let speed = flow[0] * dot(&slope, &slope).sqrt();
        let jet = self.nozzle * flow[0];
        // Bernoulli's law through the nozzle
        let nozzle = if self.nozzle == 1.0 { 0.0 } else { 0.5 * bore.density * (jet * jet - speed * speed) };
        let known = bore.outlet + bore.outside(place[2]) + nozzle;
        let over = |j: usize, part: [f64; 2]| self.rise(&self.pieces[j], part, flow, at);
        if forwards {
            known - over(k, [xi, 1.0]) - (k + 1..=last).map(|j| over(j, [0.0, 1.0])).sum::<f64>()
        } else {
            known + over(k, [0.0, xi]) + (0..k).map(|j| over(j, [0.0, 1.0])).sum::<f64>()
        }
    }
}

impl Shows for InternalFlow {
    fn local(&self, quantity: &str, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
        let bore = self.bore.as_ref().filter(|_| part == self.part)?;
        let (k, xi) = self.find(s)?;
        let pressure = self.pressure((k, xi), at);
        match quantity {
            PRESSURE => Some(pressure),
            WALL => {
                let (q, [value, slope, _]) =
                    (nodal(at.q, self.pieces[k].q), shapes(xi, self.pieces[k].length));
                let z = (0..4).map(|i| value[i] * q[i][2]).sum();
                let p: V3<f64> = std::array::from_fn(|c| (0..4).map(|i| slope[i] * q[i][c]).sum());
                let area = |d: f64| PI * d * d / 4.0 / dot(&p, &p).sqrt();
                let outer = bore.water.map_or(0.0, |[.., d]| area(d) * bore.outside(z));
                Some(pressure * area(bore.diameter) - outer)
            }
            _ => None,
        }
    }
}
