//! Current: the velocity of the water, as a function of height.

use ropewalk_core::error::{finite, need};
use ropewalk_core::{BuildError, Real, Signal, V3};

/// Velocity of the water [m/s] at height `z` [m, up]; it does not change within a step.
///
/// Use it for: still water, a tow seen from the ship, a tidal or boundary-layer profile.
///
/// ```
/// use ropewalk_scene::Current;
/// let current = Current::profile(vec![-10.0, 0.0], vec![[0.0; 3], [2.0, 0.0, 0.0]])?;
/// assert_eq!(current.at(-5.0_f64).0, [1.0, 0.0, 0.0]);
/// # Ok::<(), ropewalk_core::BuildError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Current {
    /// Water at rest.
    #[default]
    Still,
    /// The same velocity everywhere [m/s].
    Uniform(V3<f64>),
    /// The same velocity everywhere, of inputs that hold: it changes between steps alone [m/s].
    Driven(Box<[Signal; 3]>),
    /// `velocity + gradient (z - z0)`, without limit.
    Linear {
        /// Height where the water has `velocity` [m].
        z0: f64,
        /// Velocity at `z0` [m/s].
        velocity: V3<f64>,
        /// Change of velocity with height [1/s].
        gradient: V3<f64>,
    },
    /// Linear between given heights, constant above the highest and below the lowest.
    Profile {
        /// Heights [m], ascending.
        z: Vec<f64>,
        /// Velocity at each height [m/s].
        velocity: Vec<V3<f64>>,
        /// Factor of all of them; of an input that holds.
        factor: Signal,
    },
}

impl Current {
    /// A profile through `velocity[k]` at height `z[k]`.
    ///
    /// # Errors
    /// Heights that don't ascend, lists of different length, no entry, numbers that aren't finite.
    pub fn profile(z: Vec<f64>, velocity: Vec<V3<f64>>) -> Result<Self, BuildError> {
        let current = Current::Profile { z, velocity, factor: 1.0.into() };
        current.check().map(|()| current)
    }

    /// Whether its numbers make sense; laws that are given a current ask for this.
    ///
    /// # Errors
    /// As [`Current::profile`]; numbers that aren't finite in the other kinds.
    pub fn check(&self) -> Result<(), BuildError> {
        match self {
            Current::Still => Ok(()),
            Current::Uniform(u) => finite("current", u),
            Current::Driven(_) => Ok(()),
            Current::Linear { z0, velocity, gradient } => {
                finite("height of the current", &[*z0])?;
                finite("current", velocity)?;
                finite("gradient of the current", gradient)
            }
            Current::Profile { z, velocity, factor } => {
                finite("factor of the current profile", &[factor.at(0.0)])?;
                let (n, m) = (z.len(), velocity.len());
                need(n == m, || format!("current profile has {n} heights but {m} velocities"))?;
                need(n > 0, || "current profile has no entry; give one at least".into())?;
                finite("heights of the current profile", z)?;
                velocity.iter().try_for_each(|u| finite("velocities of the current profile", u))?;
                need(z.windows(2).all(|z| z[0] < z[1]), || {
                    "heights of the current profile must ascend; z is up, so start at the bottom".into()
                })
            }
        }
    }

    /// Whether it is the same at all heights, so that loads don't depend on position.
    pub fn is_uniform(&self) -> bool {
        matches!(self, Current::Still | Current::Uniform(_) | Current::Driven(_))
    }

    /// Velocity `u` and its derivative `du/dz` at height `z`.
    #[inline(always)]
    pub fn at<R: Real>(&self, z: R) -> (V3<R>, V3<R>) {
        let nought = [R::zero(); 3];
        match self {
            Current::Still => (nought, nought),
            Current::Uniform(u) => ([R::of(u[0]), R::of(u[1]), R::of(u[2])], nought),
            Current::Driven(u) => (now(u).map(R::of), nought),
            Current::Linear { z0, velocity, gradient } => {
                let dz = z - R::of(*z0);
                let (mut u, mut du) = (nought, nought);
                for i in 0..3 {
                    du[i] = R::of(gradient[i]);
                    u[i] = du[i].fma(dz, R::of(velocity[i]));
                }
                (u, du)
            }
            Current::Profile { z: heights, velocity, factor } => {
                let factor = held(factor);
                let (mut u, mut du) = (nought, nought);
                if let Some(lowest) = velocity.first() {
                    u = [R::of(factor * lowest[0]), R::of(factor * lowest[1]), R::of(factor * lowest[2])];
                }
                for (h, w) in heights.windows(2).zip(velocity.windows(2)) {
                    let (from, to) = (R::of(h[0]), R::of(h[1]));
                    // the part of this layer that lies below z
                    let below = z.if_gt(from, z.if_gt(to, to, z), from) - from;
                    let inside = z.if_gt(from, z.if_gt(to, R::zero(), R::of(1.0)), R::zero());
                    for i in 0..3 {
                        let gradient = R::of(factor * (w[1][i] - w[0][i]) / (h[1] - h[0]));
                        u[i] = gradient.fma(below, u[i]);
                        du[i] = gradient.fma(inside, du[i]);
                    }
                }
                (u, du)
            }
        }
    }
}

/// What inputs that hold are set to.
fn now(u: &[Signal; 3]) -> V3<f64> {
    u.each_ref().map(held)
}

fn held(u: &Signal) -> f64 {
    match u {
        Signal::Constant(x) => *x,
        Signal::Input(input) => input.latest(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn profile_is_linear_between_its_heights_and_constant_beyond() {
        let c = Current::profile(vec![-10.0, -4.0, 0.0], vec![[0.0; 3], [0.6, 0.0, 0.0], [1.0, 2.0, 0.0]])
            .unwrap();
        let cases = [
            (-20.0, [0.0, 0.0, 0.0], 0.0),
            (-7.0, [0.3, 0.0, 0.0], 0.1),
            (-1.0, [0.9, 1.5, 0.0], 0.1),
            (5.0, [1.0, 2.0, 0.0], 0.0),
        ];
        for (z, exact, slope) in cases {
            let (u, du) = c.at(z);
            assert_relative_eq!(u[..], exact[..], epsilon = 1e-14);
            assert_relative_eq!(du[0], slope, epsilon = 1e-14);
        }
    }

    #[test]
    fn bad_profiles_are_refused() {
        assert!(Current::profile(vec![], vec![]).is_err());
        assert!(Current::profile(vec![0.0], vec![]).is_err());
        assert!(Current::profile(vec![0.0, 0.0], vec![[0.0; 3]; 2]).is_err());
        assert!(Current::profile(vec![f64::NAN], vec![[0.0; 3]]).is_err());
        assert!(Current::Uniform([f64::INFINITY, 0.0, 0.0]).check().is_err());
    }

    #[test]
    fn linear_current_has_its_gradient() {
        let c = Current::Linear { z0: 1.0, velocity: [1.0, 0.0, 0.0], gradient: [0.5, 0.0, 0.25] };
        assert_eq!(c.at(3.0), ([2.0, 0.0, 0.5], [0.5, 0.0, 0.25]));
        assert!(!c.is_uniform());
    }
}
