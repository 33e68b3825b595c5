//! The curve that wound cable lies on.

use super::{Hand, PackageSpec, Side, Traverse};
use crate::check::unit;
use crate::motion::smooth::{step, step_second};
use ropewalk_core::{Attitude, BuildError, Solid, Surface, V3, dot};
use std::f64::consts::{FRAC_PI_2, PI};

/// A point of the wound cable, with derivatives by the arc length that has been peeled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lay {
    /// Position `H` [m].
    pub x: V3<f64>,
    /// Unit tangent `H'`, away from the lift-off point into the package.
    pub tangent: V3<f64>,
    /// Curvature vector `H''` [1/m].
    pub curvature: V3<f64>,
}

/// A package of wound cable: where its lift-off point is once a length `σ` has been peeled.
///
/// Every layer is a helix; half a turn about its end the radius goes over to that of the next layer and the
/// traverse turns round, both by quintic steps. So `H(σ)` has two continuous derivatives, and as `σ` is the arc length
/// of this very curve, `|H'| = 1` to rounding.
#[derive(Clone, Debug)]
pub struct Package {
    spec: PackageSpec,
    /// Along the axis, the reference, and across both.
    frame: [V3<f64>; 3],
    /// Way along the axis per angle, and the sign of the angle.
    climb: f64,
    sense: f64,
    /// Half of the angle in which one layer goes over to the next.
    half: f64,
    pieces: Vec<Piece>,
    wound: f64,
}

/// A part of the curve: within one layer, or from one to the next.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Layer that it is in or comes from.
    layer: usize,
    turns_over: bool,
    /// Arc length, angle and height where it begins.
    sigma: f64,
    angle: f64,
    height: f64,
}

/// Height and radius over the angle, with their first two derivatives.
struct Profile {
    radius: [f64; 3],
    height: [f64; 3],
}

impl Profile {
    /// Arc length per angle.
    fn speed(&self) -> f64 {
        let [r, dr, _] = self.radius;
        (r * r + dr * dr + self.height[1] * self.height[1]).sqrt()
    }
}

impl Package {
    /// A package as the spec says.
    ///
    /// # Errors
    /// See [`PackageSpec::check`].
    pub fn new(spec: &PackageSpec) -> Result<Self, BuildError> {
        spec.check()?;
        let axis = unit("axis", spec.axis)?;
        let x_along = axis[0].abs() > 0.9;
        let reference = spec.reference.unwrap_or(if x_along { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] });
        let along = dot(&reference, &axis);
        let reference = unit("reference", [0, 1, 2].map(|i| reference[i] - along * axis[i]))?;
        let side = [
            axis[1] * reference[2] - axis[2] * reference[1],
            axis[2] * reference[0] - axis[0] * reference[2],
            axis[0] * reference[1] - axis[1] * reference[0],
        ];
        let forward = if spec.traverse == Traverse::Forward { 1.0 } else { -1.0 };
        let way = if forward > 0.0 { spec.length - spec.first() } else { spec.first() };
        let per_turn = 2.0 * PI / spec.pitch();
        let mut package = Package {
            frame: [axis, reference, side],
            climb: forward / per_turn,
            sense: if spec.hand == Hand::Right { 1.0 } else { -1.0 },
            half: FRAC_PI_2,
            pieces: Vec::new(),
            wound: 0.0,
            spec: spec.clone(),
        };
        package.lay(way * per_turn, spec.length * per_turn);
        Ok(package)
    }

    /// Lays out the pieces of all layers; the first layer has its own angle.
    fn lay(&mut self, first: f64, full: f64) {
        let (mut sigma, mut angle, mut height) = (0.0, 0.0, self.spec.first());
        let last = self.spec.layers - 1;
        for layer in 0..=last {
            let piece = Piece { layer, turns_over: false, sigma, angle, height };
            let ends = if layer == 0 { first } else { full };
            let begun = if layer == 0 { 0.0 } else { self.half };
            let left = if layer == last { 0.0 } else { self.half };
            self.pieces.push(piece);
            let plain = ends - begun - left;
            let p = self.profile(&piece, 0.0);
            sigma += plain * p.speed();
            angle += plain;
            height += plain * p.height[1];
            if layer < last {
                let piece = Piece { layer, turns_over: true, sigma, angle, height };
                self.pieces.push(piece);
                sigma += self.arc(&piece, 2.0 * self.half);
                angle += 2.0 * self.half;
                height = self.profile(&piece, 2.0 * self.half).height[0];
            }
        }
        self.wound = sigma;
    }

    /// What it was made of.
    pub fn spec(&self) -> &PackageSpec {
        &self.spec
    }
    /// Length of cable that it holds, from the first lift-off point on [m].
    pub fn wound(&self) -> f64 {
        self.wound
    }
    /// What it looks like: the first layer that is unwound, from the side that lies bare.
    pub fn solid(&self, name: &str) -> Solid {
        let (spec, [z, x, y]) = (&self.spec, self.frame);
        let (radius, half) = (spec.radius, 0.5 * spec.length);
        let surface = match spec.side {
            Side::Inner => Surface::Tube { radius, half },
            Side::Outer => Surface::Cylinder { radius, half },
        };
        let middle = std::array::from_fn(|i| spec.origin[i] + half * z[i]);
        let seat = Attitude::new(middle, &[x, y, z]);
        Solid { name: name.into(), surface, carrier: None, seat }
    }
    /// Unit vector along its axis.
    pub fn axis(&self) -> V3<f64> {
        self.frame[0]
    }
    /// Distance of a point from the axis, and its way along the axis from the origin [m].
    pub fn cylindrical(&self, x: &V3<f64>) -> [f64; 2] {
        let d = [0, 1, 2].map(|i| x[i] - self.spec.origin[i]);
        let along = dot(&d, &self.frame[0]);
        let across = [0, 1, 2].map(|i| d[i] - along * self.frame[0][i]);
        [dot(&across, &across).sqrt(), along]
    }
    /// Layer that unwinds when a length `sigma` [m] has been peeled, from 0.
    pub fn layer(&self, sigma: f64) -> usize {
        let piece = self.piece(sigma);
        let over = piece.turns_over && self.angle(&piece, sigma - piece.sigma) > self.half;
        piece.layer + usize::from(over)
    }
    /// How deep a point lies in the wound cable [m]: above zero where a free cable would touch it. `lift_off` is the
    /// lift-off point, which tells the radius of the layer that lies bare.
    pub fn depth(&self, x: &V3<f64>, lift_off: &V3<f64>) -> f64 {
        let [radius, along] = self.cylindrical(x);
        if !(along >= 0.0 && along <= self.spec.length) {
            return f64::NEG_INFINITY;
        }
        let [wall, _] = self.cylindrical(lift_off);
        if self.spec.side == Side::Inner { radius - wall } else { wall - radius }
    }

    /// The lift-off point when a length `sigma` [m] has been peeled; nothing where the package is empty. Below zero the
    /// first layer is thought to go on.
    pub fn at(&self, sigma: f64) -> Option<Lay> {
        // a NaN is no place either
        if !(sigma <= self.wound * (1.0 + 1e-12)) {
            return None;
        }
        let piece = self.piece(sigma);
        let along = self.angle(&piece, sigma - piece.sigma);
        let p = self.profile(&piece, along);
        let (sin, cos) = (piece.angle + along).sin_cos();
        let [axis, reference, side] = &self.frame;
        let sense = self.sense;
        let out = [0, 1, 2].map(|i| cos * reference[i] + sense * sin * side[i]);
        let round = [0, 1, 2].map(|i| -sin * reference[i] + sense * cos * side[i]);
        let ([r, dr, ddr], [z, dz, ddz]) = (p.radius, p.height);
        let x = [0, 1, 2].map(|i| self.spec.origin[i] + r * out[i] + z * axis[i]);
        let first = [0, 1, 2].map(|i| dr * out[i] + r * round[i] + dz * axis[i]);
        let second = [0, 1, 2].map(|i| (ddr - r) * out[i] + 2.0 * dr * round[i] + ddz * axis[i]);
        let speed = p.speed();
        let tangent = first.map(|d| d / speed);
        let along = dot(&tangent, &second);
        let curvature = [0, 1, 2].map(|i| (second[i] - along * tangent[i]) / (speed * speed));
        Some(Lay { x, tangent, curvature })
    }

    fn piece(&self, sigma: f64) -> Piece {
        let k = self.pieces.partition_point(|p| p.sigma <= sigma);
        self.pieces[k.max(1) - 1]
    }

    /// The profile of a piece at an angle from its beginning.
    fn profile(&self, piece: &Piece, angle: f64) -> Profile {
        let (growth, k) = (self.spec.growth(), piece.layer as f64);
        let radius = self.spec.radius + growth * k;
        let climb = if piece.layer.is_multiple_of(2) { self.climb } else { -self.climb };
        if !piece.turns_over {
            return Profile {
                radius: [radius, 0.0, 0.0],
                height: [piece.height + climb * angle, climb, 0.0],
            };
        }
        let width = 2.0 * self.half;
        let u = angle / width;
        let ([sum, rise, slope], second) = (step(u), step_second(u));
        let turned = [
            piece.height + climb * width * (u - 2.0 * sum),
            climb * (1.0 - 2.0 * rise),
            -2.0 * climb * slope / width,
        ];
        let wider = [radius + growth * rise, growth * slope / width, growth * second / (width * width)];
        Profile { radius: wider, height: turned }
    }

    /// Angle from the beginning of a piece at an arc length from there.
    fn angle(&self, piece: &Piece, arc: f64) -> f64 {
        let mut angle = arc / self.profile(piece, 0.0).speed();
        if piece.turns_over {
            // the arc length is nearly linear, so that Newton's method ends after two or three
            for _ in 0..8 {
                let step = (arc - self.arc(piece, angle)) / self.profile(piece, angle).speed();
                angle += step;
                if !(step.abs() > 1e-15) {
                    break;
                }
            }
        }
        angle
    }

    /// Arc length from the beginning of a piece that turns over, by Gauss's quadrature.
    fn arc(&self, piece: &Piece, angle: f64) -> f64 {
        const PANELS: usize = 4;
        let width = angle / PANELS as f64;
        let at = |u: f64| self.profile(piece, u).speed();
        let panel = |k: usize| -> f64 {
            let middle = (k as f64 + 0.5) * width;
            GAUSS
                .iter()
                .map(|(x, w)| w * (at(middle - 0.5 * x * width) + at(middle + 0.5 * x * width)))
                .sum::<f64>()
        };
        0.5 * width * (0..PANELS).map(panel).sum::<f64>()
    }
}

/// Points and weights of Gauss's quadrature of order 16 on [-1, 1], one of each pair.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];
