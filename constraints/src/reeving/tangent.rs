//! The point at which a cable meets or leaves a wheel.

use ropewalk_core::{Jet, Place, Relation, RowKind};

/// The end of a span lies in the groove and is tangent to it: with `d = r - c` and the slope `s`, `a·d = 0`, `|d| = R` (of
/// the part normal to the axis) and `d·s = 0`.
///
/// The first marker is the end of the cable; the third axis of the second is that of the wheel. The cable may leave the
/// plane of the wheel: there is no equation for its fleet angle. No angle is an unknown.
#[derive(Clone, Copy, Debug)]
pub struct Tangent {
    /// Radius to the middle of the cable [m].
    pub radius: f64,
}

impl Relation for Tangent {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Position, RowKind::Position, RowKind::Direction]
    }
    fn g<S: Jet>(&self, _t: S, at: &[Place<S>], g: &mut [S]) {
        let ([end, wheel], slope) = ([&at[0], &at[1]], &at[0].axes[0]);
        let axis = &wheel.axes[2];
        let d: [S; 3] = std::array::from_fn(|i| end.x[i] - wheel.x[i]);
        let along = |a: &[S; 3], b: &[S; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        g[0] = along(axis, &d);
        let flat: [S; 3] = std::array::from_fn(|i| d[i] - axis[i] * g[0]);
        g[1] = along(&flat, &flat).sqrt() - self.radius;
        g[2] = along(&d, slope) / self.radius;
    }
}
