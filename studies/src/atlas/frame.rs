//! A frame that moves with a recorded point, such as the ship's: what is near the point is seen there.

use super::spec::Panel;
use ropewalk_core::V3;
use ropewalk_report::Table;

/// Positions are given from a point on its way, and its course may be the x axis.
pub(super) struct Frame {
    t: Vec<f64>,
    origin: [Vec<f64>; 3],
    /// Cosine and sine of the course.
    course: Vec<(f64, f64)>,
}

/// The columns of a point's position.
pub(super) fn columns(point: &str) -> [String; 3] {
    ["x", "y", "z"].map(|axis| format!("{point}.{axis}"))
}

/// The point and the axis of a column such as `hose.end.x`.
pub(super) fn component(column: &str) -> Option<(&str, usize)> {
    let (point, axis) = column.rsplit_once('.')?;
    Some((point, ["x", "y", "z"].iter().position(|a| *a == axis)?))
}

impl Frame {
    /// The frame of a panel, if it names one; none as well where a column is missing.
    pub(super) fn of(panel: &Panel, history: &Table) -> Option<Self> {
        let point = panel.relative_to.as_deref()?;
        let [x, y, z] = columns(point).map(|name| history.column(&name).map(|c| c.values.clone()));
        let origin = [x?, y?, z?];
        let t = history.columns.first()?.values.clone();
        let course = match panel.along_course {
            true => course(&t, &origin[0], &origin[1]),
            false => vec![(1.0, 0.0); t.len()],
        };
        Some(Frame { t, origin, course })
    }

    /// A position at a row of the history, seen in the frame.
    pub(super) fn at(&self, row: usize, x: V3<f64>) -> V3<f64> {
        let d = [0, 1, 2].map(|i| x[i] - self.origin[i][row]);
        let (cos, sin) = self.course[row];
        [cos * d[0] + sin * d[1], cos * d[1] - sin * d[0], d[2]]
    }

    /// The row that is nearest to a time.
    pub(super) fn row(&self, t: f64) -> usize {
        let after = self.t.partition_point(|x| *x < t).min(self.t.len().saturating_sub(1));
        let before = after.saturating_sub(1);
        if (self.t[before] - t).abs() < (self.t[after] - t).abs() { before } else { after }
    }
}

/// Direction of the way in the plane; at rest the one before or, at first, the one to come.
fn course(t: &[f64], x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    const AT_REST: f64 = 1e-6;
    let velocity: Vec<(f64, f64)> = (0..t.len()).map(|k| (slope(t, x, k), slope(t, y, k))).collect();
    let speed = |k: usize| velocity[k].0.hypot(velocity[k].1);
    let largest = (0..t.len()).map(speed).fold(0.0, f64::max);
    let direction = |k: usize| {
        (speed(k) > AT_REST * largest).then(|| (velocity[k].0 / speed(k), velocity[k].1 / speed(k)))
    };
    let mut course = (0..t.len()).find_map(direction).unwrap_or((1.0, 0.0));
    let along = |k: usize| {
        course = direction(k).unwrap_or(course);
        course
    };
    (0..t.len()).map(along).collect()
}

/// Slope at a row, of the parabola through three rows: at the ends as exact as in between.
fn slope(t: &[f64], x: &[f64], k: usize) -> f64 {
    if t.len() < 3 {
        return if t.len() == 2 { (x[1] - x[0]) / (t[1] - t[0]) } else { 0.0 };
    }
    let m = k.clamp(1, t.len() - 2);
    let (before, after) = ((x[m] - x[m - 1]) / (t[m] - t[m - 1]), (x[m + 1] - x[m]) / (t[m + 1] - t[m]));
    let curved = (after - before) / (t[m + 1] - t[m - 1]);
    before + curved * (2.0 * t[k] - t[m - 1] - t[m])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_report::Column;

    #[test]
    fn what_follows_a_turning_ship_stays_behind_it() {
        let mut history = Table::new(["x", "y", "z"].map(|a| Column::new(format!("ship.{a}"), "m")));
        // at rest, then once round a circle of 25 m
        for k in 0..=400 {
            let angle = f64::from(k.max(100) - 100) * 0.01;
            let row = [0.1 * f64::from(k), 25.0 * angle.sin(), 25.0 * (1.0 - angle.cos()), 1.0];
            history.push_row(&row).unwrap();
        }
        let panel = Panel { relative_to: Some("ship".into()), along_course: true, ..Panel::default() };
        let frame = Frame::of(&panel, &history).unwrap();
        // at rest the course is the first one to come, half a step round
        let seen = frame.at(0, [-3.0, 1.0, 0.0]);
        assert!((seen[0] + 3.0).abs() < 0.02 && (seen[1] - 1.0).abs() < 0.02 && seen[2] == -1.0, "{seen:?}");
        for k in [150, 300, 399, 400] {
            let angle = f64::from(k as u32 - 100) * 0.01;
            // 10 m behind on the tangent and 2 m towards the centre
            let (forth, left) = ([angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]);
            let at = |i: usize| frame.origin[i][k] - 10.0 * forth[i] + 2.0 * left[i];
            let seen = frame.at(k, [at(0), at(1), 0.0]);
            let away = [seen[0] + 10.0, seen[1] - 2.0, seen[2] + 1.0];
            assert!(away.iter().all(|d| d.abs() < 1e-3), "{seen:?}");
        }
        assert_eq!((frame.row(0.26), frame.row(1e9), frame.row(-1.0)), (3, 400, 0));
        assert_eq!(component("hose.end.z"), Some(("hose.end", 2)));
        assert_eq!((component("hose.end.tension"), component("length")), (None, None));
    }
}
