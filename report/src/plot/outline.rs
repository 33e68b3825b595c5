//! What wheels, drums and other cylinders look like from far away.

use super::shape::Plane;
use crate::field::{Pose, Shape, Solid};

/// Corners of a circle.
const CORNERS: usize = 64;

/// A point of a picture.
type Point = (f64, f64);

/// The outline of a cylinder on a body that is there, or on the ground, as it is seen in a plane: a closed line without its
/// last point again. `None` of what is no cylinder, of an endless one that isn't seen along its axis, and where the plane
/// shows no shapes.
pub(super) fn outline(shape: &Shape, carrier: &Pose, plane: Plane) -> Option<Vec<Point>> {
    let Solid::Cylinder { radius, half } = shape.solid else { return None };
    let seen = |x: f64, y: f64, z: f64| plane.project(carrier.apply(&shape.pose.apply(&[x, y, z])));
    let (from, to) = (seen(0.0, 0.0, 0.0), seen(0.0, 0.0, 1.0));
    let along = (to.0 - from.0).hypot(to.1 - from.1);
    if plane == Plane::Radial || (half.is_infinite() && along > 1e-3) {
        return None;
    }
    let half = if half.is_infinite() { 0.0 } else { half };
    let circle = (0..CORNERS).flat_map(|k| {
        let (y, x) = (std::f64::consts::TAU * k as f64 / CORNERS as f64).sin_cos();
        [-half, half].map(|z| seen(radius * x, radius * y, z))
    });
    let hull = hull(circle.collect());
    (hull.len() > 2 && hull.iter().all(|p| p.0.is_finite() && p.1.is_finite())).then_some(hull)
}

/// The convex hull of points, anticlockwise (Andrew's monotone chain, 1979).
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let left = |a: &Point, b: &Point, c: &Point| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let chain = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while chain.len() > 1 && left(&chain[chain.len() - 2], &chain[chain.len() - 1], &p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent(outline: &[Point]) -> [f64; 4] {
        let bounds = |of: fn(&Point) -> f64| {
            let all = outline.iter().map(of);
            [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
        };
        let ([a, b], [c, d]) = (bounds(|p| p.0), bounds(|p| p.1));
        [a, b, c, d]
    }

    #[test]
    fn a_wheel_is_a_circle_from_the_side_and_a_bar_from_above() {
        // its axis is y
        let wheel = Shape::between("wheel", [1.0, -0.1, 2.0], [1.0, 0.1, 2.0], 0.5);
        let seen = |plane| extent(&outline(&wheel, &Pose::at([0.0, 0.0, 1.0]), plane).unwrap());
        let near = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(seen(Plane::SideX), [0.75, 1.25, 2.75, 3.25]));
        assert!(near(seen(Plane::Top), [0.75, 1.25, -0.1, 0.1]));
        assert!(near(seen(Plane::SideY), [-0.1, 0.1, 2.75, 3.25]));
        assert_eq!(outline(&wheel, &Pose::default(), Plane::Radial), None);
    }

    #[test]
    fn an_endless_cylinder_is_seen_along_its_axis_only() {
        let solid = Solid::Cylinder { radius: 1.0, half: f64::INFINITY };
        let drum = Shape::new("drum", solid, Pose::default());
        let seen = |plane| outline(&drum, &Pose::default(), plane);
        assert!(seen(Plane::Top).is_some_and(|circle| circle.len() == CORNERS));
        assert_eq!(seen(Plane::SideX), None);
    }
}
