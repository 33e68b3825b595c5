//! What a shape is fixed to, and how things look from there.

use super::shape::{Gap, Shape};
use ropewalk_core::held::three;
use ropewalk_core::rotation::{IDENTITY, M3, matrix, times, transposed_times};
use ropewalk_core::{At, V3};

/// What a shape is fixed to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Seat {
    Ground,
    /// A rigid body with these first coordinate and velocity.
    Body {
        q: usize,
        v: usize,
    },
}

/// Where the body of a shape is.
pub(crate) struct Frame {
    pub r: M3,
    pub x: V3<f64>,
    pub v: V3<f64>,
    pub omega: V3<f64>,
}

pub(crate) fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The rotation matrix of the body whose coordinates begin at `q`.
pub(crate) fn rotation(at: &At<'_>, q: usize) -> M3 {
    matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]])
}

/// A shape in its place.
#[derive(Clone, Debug)]
pub(crate) struct Fixed {
    pub shape: Shape,
    pub seat: Seat,
    /// Where the shape's own origin is in the axes of what it is on, and its axes there, one after the other.
    pub origin: V3<f64>,
    pub axes: M3,
}

impl Fixed {
    pub fn frame(&self, at: &At<'_>) -> Frame {
        match self.seat {
            Seat::Ground => Frame { r: IDENTITY, x: [0.0; 3], v: [0.0; 3], omega: [0.0; 3] },
            Seat::Body { q, v } => {
                Frame { r: rotation(at, q), x: three(at.q, q), v: three(at.v, v), omega: three(at.v, v + 3) }
            }
        }
    }

    /// A point in the axes of the shape's body.
    #[inline]
    pub fn place(&self, frame: &Frame, x: &V3<f64>) -> V3<f64> {
        match self.seat {
            Seat::Ground => *x,
            Seat::Body { .. } => transposed_times(&frame.r, &minus(x, &frame.x)),
        }
    }

    /// A point in the shape's own axes.
    #[inline]
    pub fn inside(&self, frame: &Frame, x: &V3<f64>) -> V3<f64> {
        times(&self.axes, &minus(&self.place(frame, x), &self.origin))
    }

    /// A direction in the shape's own axes.
    #[inline]
    pub fn turned(&self, frame: &Frame, x: &V3<f64>) -> V3<f64> {
        match self.seat {
            Seat::Ground => times(&self.axes, x),
            Seat::Body { .. } => times(&self.axes, &transposed_times(&frame.r, x)),
        }
    }

    /// The surface as seen from a point in the axes of the shape's body.
    #[inline]
    pub fn gap(&self, s: &V3<f64>, reach: f64) -> Option<Gap> {
        let gap = self.shape.gap(&times(&self.axes, &minus(s, &self.origin)), reach)?;
        Some(self.outwards(gap))
    }

    /// What is seen in the shape's own axes, in those of its body.
    #[inline]
    pub fn outwards(&self, gap: Gap) -> Gap {
        gap.turned(|x| transposed_times(&self.axes, x))
    }
}
