//! What lies on a wheel between two spans of a cable: stiffness, inertia, weight, and friction on the groove.
//!
//! All of it is stated once over any carrier of derivatives. The unknowns are the two tangent points `r_e` (the end of the
//! span before) and `r_s` (the start of the span behind), the material coordinates `P_e` and `P_s` there, and the wheel's
//! centre, axis and spin. With `e = (r - c)/R` and `f = a × e`, the direction in which the cable runs, a tangential force
//! `F` on the cable at one end acts as `F f` on the point, `-F f` on the centre and `-F λ` on the material coordinate,
//! where `λ = R θ/A` is the stretch of the arc; `λ` and not the slope of the span, so that the speed of the cable along
//! the groove is the rate of a function of the configuration.

use super::inline::{each, three, two};
use ropewalk_core::rotation::{along, cross};
use ropewalk_core::{Jet, V3};
use ropewalk_scene::Strand;
use std::f64::consts::TAU;

/// Wraps below this are those of a cable that has lost touch with its wheel [rad]: its range is from here to a whole turn.
const LEAST: f64 = -1e-3;

/// A moving end of the arc.
#[derive(Clone, Copy, Debug)]
pub struct End<S> {
    /// Place, velocity and acceleration of the node in space.
    pub r: [V3<S>; 3],
    /// Material coordinate, its rate and its acceleration [m].
    pub p: [S; 3],
}

/// The wheel.
#[derive(Clone, Copy, Debug)]
pub struct Wheel<S> {
    /// Place, velocity and acceleration of the centre in space.
    pub c: [V3<S>; 3],
    /// Axis in space, a unit vector about which the cable turns by the right-hand rule.
    pub axis: V3<S>,
    /// Angular velocity of the groove about the axis, in space [rad/s].
    pub spin: S,
    /// The same of what carries the wheel.
    pub carrier: S,
}

/// What makes the tension on both sides of a wheel different.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// The cable slides on the groove, with this coefficient of friction; 0 without.
    Slides(f64),
    /// The cable doesn't slide on the wheel, which turns with it: its moment of inertia over its radius squared [kg].
    Turns(f64),
}

/// The numbers of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Radius to the middle of the cable [m].
    pub radius: f64,
    /// The cable.
    pub strand: Strand,
    /// Acceleration of gravity, of a cable that has weight [m/s²].
    pub gravity: V3<f64>,
    /// How cable and groove go together.
    pub grip: Grip,
    /// Speed of sliding below which friction fades [m/s].
    pub slip_speed: f64,
    /// At an equilibrium, which way the cable goes that friction resists in full: 1 to its start, -1 to its end. Otherwise
    /// 0: friction is by the speed.
    pub sliding: f64,
    /// Angle within half a turn of which the wrap is, of a cable that may lie in several turns [rad].
    pub near: Option<f64>,
    /// In a search for equilibrium, the elastic tension that geometric stiffness is taken with; otherwise that of the arc as
    /// it is [N].
    pub stress: Option<f64>,
    /// Tension that the twist of a laid rope adds to that of its stretch [N]. Friction and bearing see it; as a force it acts with
    /// the torsion.
    pub pull: f64,
    /// Moment of friction in the bearing, of a wheel that turns with the cable: a constant part [N m], one by the force on
    /// the axle [m], one by the spin [N m s].
    pub bearing: [f64; 3],
}

/// Residuals: minus the generalised forces, and inertia.
#[derive(Clone, Copy, Debug)]
pub struct Residual<S> {
    /// Of the two points.
    pub r: [V3<S>; 2],
    /// Of their material coordinates.
    pub p: [S; 2],
    /// Of the centre.
    pub centre: V3<S>,
    /// Moment about the axis on the groove.
    pub groove: S,
}

/// What there is to know of an arc at an instant, for records, energy and power.
#[derive(Clone, Copy, Debug)]
pub struct Instant<S> {
    /// Angle of wrap [rad].
    pub wrap: S,
    /// Unstretched length on the wheel [m].
    pub length: S,
    /// Elastic tension [N].
    pub tension: S,
    /// Tension before and behind the wheel [N].
    pub beside: [S; 2],
    /// Speed of the cable along the groove in space, at both ends [m/s].
    pub speed: [S; 2],
    /// Tension that doesn't press on the groove, at both ends: of the speed, less what weight does [N].
    pub lift: [S; 2],
    /// Friction on the cable along the groove, at both ends [N].
    pub friction: [S; 2],
    /// Force of the cable on the axle [N].
    pub axle: V3<S>,
    /// Kinetic and potential energy [J].
    pub energy: [S; 2],
    /// Power that friction, bearing and damping turn into heat [W].
    pub dissipated: S,
}

/// How a cable lies on a wheel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lay<S> {
    /// Directions from the centre to both ends, and those in which the cable runs there.
    e: [V3<S>; 2],
    f: [V3<S>; 2],
    /// Angle of wrap [rad].
    pub wrap: S,
    /// Unstretched length on the wheel [m], and its stretch.
    length: S,
    stretch: S,
    /// Elastic tension [N].
    pub tension: S,
    /// Speed of the material along the groove at both ends [m/s].
    v: [S; 2],
}

impl<S: Jet> Lay<S> {
    #[inline(always)]
    fn mean(&self) -> S {
        (self.v[0] + self.v[1]) * 0.5
    }
}

#[inline(always)]
fn minus<S: Jet>(a: &V3<S>, b: &V3<S>) -> V3<S> {
    three!(|i| a[i] - b[i])
}

/// The angle of a point of the plane, regular all round, a quarter turn too: derivatives are taken where it is small.
#[inline(always)]
pub(super) fn angle<S: Jet>(y: S, x: S) -> S {
    let now = y.re().atan2(x.re());
    let (sin, cos) = now.sin_cos();
    ((y * cos - x * sin) / (x * cos + y * sin)).atan() + now
}

/// `x / √(x² + x0²)`: the direction of sliding, rounded where it turns.
#[inline(always)]
pub fn direction<S: Jet>(x: S, x0: f64) -> S {
    x / (x * x + x0 * x0).sqrt()
}

/// Friction on half of a wrap.
struct Half<S> {
    /// Tension that presses on the groove [N].
    presses: S,
    /// Angle times coefficient of friction.
    angle: S,
    /// 1 at the end where the arc begins, -1 where it ends.
    sign: f64,
    /// See [`Arc::slip_speed`].
    slip_speed: f64,
}

impl<S: Jet> Half<S> {
    /// Friction on the cable along the groove that is used up in this direction [N].
    #[inline(always)]
    fn full(&self, way: f64) -> S {
        ((self.angle * (way * self.sign)).exp() - 1.0) * self.presses * self.sign
    }

    /// Friction on the cable along the groove where the groove is faster by this [N].
    #[inline(always)]
    fn sliding(&self, slip: S) -> S {
        ((direction(slip, self.slip_speed) * self.angle * self.sign).exp() - 1.0) * self.presses * self.sign
    }

    /// The same where material flows, at a rate over the axial stiffness [m/(s N)]: the half by which it arrives changes
    /// its stretch, hence its speed, towards that of the groove. So it sticks, and slides only by what the other half can't
    /// hold, which is the creep of a belt (Grashof).
    ///
    /// The slip `y` with `y + flow F(y) = slip`, whose left side rises, by Newton's method between bounds.
    #[inline(always)]
    fn sticking(&self, slip: S, flow: S) -> S {
        let flow = flow * self.sign;
        if !(flow.re() > 0.0) {
            return self.sliding(slip);
        }
        let Half { sign, slip_speed, .. } = *self;
        let re = Half { presses: self.presses.re(), angle: self.angle.re(), sign, slip_speed };
        // friction, and the slope of the left side
        let left = |y: f64| {
            let square = y * y + re.slip_speed.powi(2);
            let turns = re.slip_speed.powi(2) / (square * square.sqrt());
            let pull = re.sliding(y);
            (pull, 1.0 + flow.re() * (re.presses + re.sign * pull) * re.angle * turns)
        };
        let (mut low, mut high) = (slip.re().min(0.0), slip.re().max(0.0));
        // where all of it slides that is near
        let mut y = (slip.re() - flow.re() * re.sliding(slip.re())).clamp(low, high);
        let mut slope = 1.0;
        for _ in 0..60 {
            let (pull, now) = left(y);
            slope = now;
            let off = y + flow.re() * pull - slip.re();
            if off > 0.0 {
                high = y
            } else {
                low = y
            }
            let next = y - off / slope;
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            let done = (next - y).abs() <= 1e-15 * slip.re().abs().max(re.slip_speed);
            y = next;
            if done {
                break;
            }
        }
        // one more step, which brings the derivatives
        let at = S::from(y);
        let y = at - (at + flow * self.sliding(at) - slip) / slope;
        self.sliding(y)
    }
}

impl Arc {
    /// How the cable lies; `stored` is the unstretched length for material coordinates of 0.
    #[inline(always)]
    pub(super) fn lay<S: Jet>(&self, stored: f64, ends: &[End<S>; 2], wheel: &Wheel<S>) -> Lay<S> {
        let Strand { ea, ei, .. } = self.strand;
        let (radius, [c, cd, _], a) = (self.radius, &wheel.c, &wheel.axis);
        let e = two!(|k| each!(minus(&ends[k].r[0], c), |x| x / radius));
        // `f/R` is what the wrap changes by with an end, wherever that is: so a force along it has a potential
        let beside = two!(|k| along(a, &e[k]));
        let f = two!(|k| {
            let flat = along(&e[k], &e[k]) - beside[k] * beside[k];
            each!(cross(a, &e[k]), |x| x / flat)
        });
        let wrap = angle(along(a, &cross(&e[0], &e[1])), along(&e[0], &e[1]) - beside[0] * beside[1]);
        let wrap = match self.near {
            Some(near) => wrap + TAU * ((near - wrap.re()) / TAU).round(),
            None if wrap.re() < LEAST => wrap + TAU,
            None => wrap,
        };
        let length = ends[1].p[0] - ends[0].p[0] + stored;
        let stretch = wrap * radius / length;
        let tension = (stretch - 1.0) * ea + wrap * ei / (length * radius);
        let v = two!(|k| along(&f[k], &minus(&ends[k].r[1], cd)) - stretch * ends[k].p[1]);
        Lay { e, f, wrap, length, stretch, tension, v }
    }

    /// Tension that doesn't press on the groove, at both ends: that which turns the cable's momentum, less what weight does.
    #[inline(always)]
    pub(super) fn lift<S: Jet>(&self, lay: &Lay<S>, wheel: &Wheel<S>) -> [S; 2] {
        let Lay { e, f, wrap, .. } = lay;
        let h = self.falls(wheel);
        let middle: V3<S> = {
            let (sin, cos) = ((*wrap * 0.5).sin(), (*wrap * 0.5).cos());
            three!(|i| e[0][i] * cos + f[0][i] * sin)
        };
        let across = cross(&wheel.axis, &middle);
        let half = [minus(&f[0], &across), minus(&across, &f[1])];
        let mean = lay.mean();
        two!(|k| {
            (mean * mean - along(&h, &half[k]) * 2.0 / *wrap * self.radius) * self.strand.mass / lay.stretch
        })
    }

    /// Acceleration of the centre against free fall [m/s²].
    #[inline(always)]
    fn falls<S: Jet>(&self, wheel: &Wheel<S>) -> V3<S> {
        three!(|i| wheel.c[2][i] - self.gravity[i])
    }

    /// Evaluates all of it; `stored` is the unstretched length for material coordinates of 0.
    #[inline(always)]
    pub fn eval<S: Jet>(
        &self,
        stored: f64,
        ends: &[End<S>; 2],
        wheel: &Wheel<S>,
    ) -> (Residual<S>, Instant<S>) {
        let Strand { mass, ea, ei, damping, .. } = self.strand;
        let (radius, [c, cd, cdd]) = (self.radius, &wheel.c);
        let lay = self.lay(stored, ends, wheel);
        let Lay { e, f, wrap, length, stretch, tension, v } = lay;

        // elastic: closed ends, since the energy goes on into the arc
        let tension = self.stress.map_or(tension, |stress| tension - tension.re() + stress);
        let by_length = -(stretch * stretch - 1.0) * (0.5 * ea) - wrap * wrap * ei / (length * length * 2.0);
        let mut out = Residual {
            r: [each!(f[0], |x| -(x * tension)), each!(f[1], |x| x * tension)],
            p: [-by_length, by_length],
            centre: three!(|i| (f[0][i] - f[1][i]) * tension),
            groove: S::zero(),
        };

        // speeds and accelerations of the material along the groove
        let rate = (v[1] - v[0]) / length;
        let w = two!(|k| {
            let [_, pd, pdd] = ends[k].p;
            along(&f[k], &minus(&ends[k].r[2], cdd)) - stretch * pdd - rate * pd * 2.0
        });
        let mean = lay.mean();
        let pulled = tension + self.pull;

        // inertia and weight, the motion linear along the arc
        let m = length * mass;
        let h = self.falls(wheel);
        let turned = each!(minus(&f[0], &f[1]), |x| x / (wrap * wrap));
        let b: [V3<S>; 2] = [three!(|i| turned[i] - e[0][i] / wrap), three!(|i| e[1][i] / wrap - turned[i])];
        let mut inertia = [
            m * (w[0] / 3.0 + w[1] / 6.0 + along(&h, &b[0])),
            m * (w[0] / 6.0 + w[1] / 3.0 + along(&h, &b[1])),
        ];
        let square = (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]) / 3.0;
        let flux = square / (wrap * radius);
        for i in 0..3 {
            out.centre[i] += m * (h[i] + w[0] * b[0][i] + w[1] * b[1][i] + flux * (f[1][i] - f[0][i]));
        }
        // Kelvin-Voigt damping of the arc
        let viscous = rate * damping;
        // friction; what presses on the groove is less than the tension by that which turns the cable's momentum
        let lift = self.lift(&lay, wheel);
        let mut friction = [S::zero(); 2];
        let mut strain = [S::zero(); 2];
        let mut axle_friction = S::zero();
        let mut moving = S::zero();
        match self.grip {
            Grip::Slides(mu) => {
                let rim = wheel.spin * radius;
                for k in 0..2 {
                    let presses = pulled - lift[k];
                    if mu > 0.0 && presses.re() > 0.0 {
                        let half = Half {
                            presses,
                            angle: wrap * (0.5 * mu),
                            sign: if k == 0 { 1.0 } else { -1.0 },
                            slip_speed: self.slip_speed,
                        };
                        friction[k] = if self.sliding == 0.0 {
                            half.sticking(rim - v[k], -ends[k].p[1] / ea)
                        } else {
                            half.full(self.sliding)
                        };
                        // it acts where the stretch is on its way to that beside the wheel
                        strain[k] = friction[k] * (0.5 * half.sign / ea);
                    }
                }
                moving = rim * (friction[0] + friction[1]);
            }
            Grip::Turns(wheel_mass) => {
                let spin = mean / radius - wheel.carrier;
                let pressed = (pulled - (lift[0] + lift[1]) * 0.5) * ((wrap * 0.5).sin() * 2.0);
                let moment = match self.sliding {
                    0.0 => self.moment(spin, pressed),
                    way => -(self.rubbing(pressed) * way),
                };
                axle_friction = moment * spin;
                for k in 0..2 {
                    friction[k] = -moment / (2.0 * radius);
                    inertia[k] += (w[0] + w[1]) * (0.25 * wheel_mass);
                }
            }
        }
        let push = [inertia[0] - friction[0] - viscous, inertia[1] - friction[1] + viscous];
        for k in 0..2 {
            for i in 0..3 {
                out.r[k][i] += f[k][i] * push[k];
                out.centre[i] -= f[k][i] * push[k];
            }
            out.p[k] -= stretch * push[k] - strain[k] * friction[k];
        }
        out.groove = (friction[0] + friction[1]) * radius;

        let lost = match self.grip {
            Grip::Slides(_) => {
                let gains = two!(|k| friction[k] * (v[k] - strain[k] * ends[k].p[1]));
                moving - gains[0] - gains[1]
            }
            Grip::Turns(_) => axle_friction,
        };
        let wheel_energy = match self.grip {
            Grip::Turns(mass) => mean * mean * (0.5 * mass),
            Grip::Slides(_) => S::zero(),
        };
        let lean = two!(|k| along(cd, &b[k]) * v[k]);
        let kinetic = m * ((along(cd, cd) + square) * 0.5 + lean[0] + lean[1]) + wheel_energy;
        let place: V3<S> = three!(|i| c[i] + (f[0][i] - f[1][i]) * radius / wrap);
        let weight = along(&place, &each!(self.gravity, |g| S::from(g)));
        let excess = wrap * radius - length;
        let potential =
            excess * excess * ea / (length * 2.0) + wrap * wrap * ei / (length * 2.0) - m * weight;
        let instant = Instant {
            wrap,
            length,
            tension: pulled,
            beside: [pulled - push[0], pulled + push[1]],
            speed: v,
            lift,
            friction,
            axle: three!(|i| (f[1][i] - f[0][i]) * self.pull - out.centre[i]),
            energy: [kinetic, potential],
            dissipated: lost + viscous * rate * length,
        };
        (out, instant)
    }

    /// Moment with which the bearing resists a spin under a force on the axle [N m].
    #[inline(always)]
    pub fn moment<S: Jet>(&self, spin: S, pressed: S) -> S {
        direction(spin, self.slip_speed / self.radius) * self.rubbing(pressed) + spin * self.bearing[2]
    }

    /// Its dry friction under a force on the axle [N m].
    #[inline(always)]
    fn rubbing<S: Jet>(&self, pressed: S) -> S {
        let pressed = if pressed.re() > 0.0 { pressed * self.bearing[1] } else { S::zero() };
        pressed + self.bearing[0]
    }
}
