//! A record at equal intervals of time.

use ropewalk_report::Column;

/// A record at equal intervals.
pub(crate) struct Course<'a> {
    pub column: &'a Column,
    pub dt: f64,
    pub values: Vec<f64>,
}

/// The part of a column within a time, at equal intervals: rows of events in between are left out by interpolation.
pub(crate) fn course<'a>(t: &[f64], column: &'a Column, [from, to]: [f64; 2]) -> Option<Course<'a>> {
    let points: Vec<(f64, f64)> = t
        .iter()
        .zip(&column.values)
        .filter(|(t, x)| **t >= from && **t <= to && x.is_finite())
        .map(|(t, x)| (*t, *x))
        .collect();
    let (first, last) = (points.first()?.0, points.last()?.0);
    if points.len() < 4 {
        return None;
    }
    let mut steps: Vec<f64> = points.windows(2).map(|w| w[1].0 - w[0].0).filter(|h| *h > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    let dt = *steps.get(steps.len() / 2)?;
    let count = ((last - first) / dt * (1.0 + 1e-9)).floor() as usize;
    let mut k = 0;
    let at = |i: usize| {
        let t = (first + dt * i as f64).min(last);
        while k + 2 < points.len() && points[k + 1].0 < t {
            k += 1;
        }
        let ((a, x), (b, y)) = (points[k], points[k + 1]);
        if b > a { x + (y - x) * ((t - a) / (b - a)).clamp(0.0, 1.0) } else { y }
    };
    Some(Course { column, dt, values: (0..=count).map(at).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_events_do_not_disturb_a_course() {
        let t: Vec<f64> = (0..100)
            .map(|k| 0.1 * f64::from(k))
            .flat_map(|t| if (t - 3.0).abs() < 1e-9 { vec![t, t + 0.03] } else { vec![t] })
            .collect();
        let column = Column { values: t.iter().map(|t| 2.0 * t + 1.0).collect(), ..Column::new("x", "m") };
        let c = course(&t, &column, [1.0, 8.0]).expect("course");
        assert!((c.dt - 0.1).abs() < 1e-9 && c.values.len() == 71);
        assert!(c.values.iter().enumerate().all(|(k, x)| (x - (3.0 + 0.2 * k as f64)).abs() < 1e-9));
    }
}
