//! Leaves out points that a reader couldn't see, so that a file of a long run stays small.

/// A point in pixels.
pub(super) type Pixel = (f64, f64);

/// Points that are joined by a line; `None` breaks it.
pub(super) fn runs(points: &[Option<Pixel>], budget: usize) -> Vec<Vec<Pixel>> {
    let mut runs: Vec<Vec<Pixel>> = points
        .split(Option::is_none)
        .map(|run| run.iter().flatten().copied().collect::<Vec<_>>())
        .filter(|run| !run.is_empty())
        .collect();
    if runs.len() > budget / 8 {
        runs = joined(runs, 0.5);
    }
    let total: usize = runs.iter().map(Vec::len).sum();
    for run in &mut runs {
        let share = budget as f64 * run.len() as f64 / total as f64;
        *run = thinned(run, (share as usize).max(4));
    }
    runs
}

/// Points that are drawn as dots: none closer than a pixel to the one before, at most `budget`.
pub(super) fn dots(points: &[Option<Pixel>], budget: usize) -> Vec<Pixel> {
    let all: Vec<Pixel> = points.iter().flatten().copied().collect();
    let kept = spaced(&all, 1.0);
    let stride = kept.len().div_ceil(budget.max(2)).max(1);
    kept.into_iter().step_by(stride).collect()
}

/// At most about `budget` points that look the same as a line.
fn thinned(run: &[Pixel], budget: usize) -> Vec<Pixel> {
    let forward = run.windows(2).all(|w| w[0].0 <= w[1].0);
    // Finer than a line is wide, then coarser until it fits.
    let mut pixel = if forward { 0.5 } else { 0.2 };
    loop {
        let kept = if forward { columns(run, pixel) } else { spaced(run, pixel) };
        // The widest plot is far below this; a few points always remain.
        if kept.len() <= budget || pixel > 1e4 {
            return kept;
        }
        pixel *= 1.5;
    }
}

/// Of the points in each column of pixels, the first, lowest, highest and last: the line through
/// them covers the same pixels, whatever oscillates in between.
fn columns(run: &[Pixel], width: f64) -> Vec<Pixel> {
    let column = |p: &Pixel| (p.0 / width).floor();
    let mut kept = Vec::new();
    for group in run.chunk_by(|a, b| column(a) == column(b)) {
        let extreme = |sign: f64| {
            let values = group.iter().map(|p| sign * p.1).enumerate();
            values.fold((0, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a }).0
        };
        let mut picks = [0, extreme(1.0), extreme(-1.0), group.len() - 1];
        picks.sort_unstable();
        for (i, pick) in picks.iter().enumerate() {
            if i == 0 || picks[i - 1] != *pick {
                kept.push(group[*pick]);
            }
        }
    }
    kept
}

/// Leaves out points nearer than `distance` to the last one kept; the ends stay.
fn spaced(run: &[Pixel], distance: f64) -> Vec<Pixel> {
    let mut kept: Vec<Pixel> = Vec::new();
    for (i, point) in run.iter().enumerate() {
        let near = kept.last().is_some_and(|last| (point.0 - last.0).hypot(point.1 - last.1) < distance);
        if !near || (i + 1 == run.len() && kept.last() != Some(point)) {
            kept.push(*point);
        }
    }
    kept
}

/// Bridges gaps too narrow to be seen; only for data that consist of gaps mostly.
fn joined(runs: Vec<Vec<Pixel>>, gap: f64) -> Vec<Vec<Pixel>> {
    let mut result: Vec<Vec<Pixel>> = Vec::new();
    for run in runs {
        match (result.last_mut(), run.first()) {
            (Some(before), Some(first))
                if before.last().is_some_and(|last| (first.0 - last.0).abs() < gap) =>
            {
                before.extend(run);
            }
            _ => result.push(run),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(count: usize) -> Vec<Option<Pixel>> {
        (0..count)
            .map(|i| {
                let x = 600.0 * i as f64 / count as f64;
                Some((x, 200.0 + 150.0 * (x * 37.0).sin()))
            })
            .collect()
    }

    #[test]
    fn a_long_history_keeps_its_extremes() {
        let points = history(1_000_000);
        let mut spiked = points.clone();
        spiked[123_456] = Some((600.0 * 0.123_456, 399.0));
        let runs = runs(&spiked, 6000);
        assert_eq!(runs.len(), 1);
        assert!(runs[0].len() <= 6000 && runs[0].len() > 1000);
        assert!(runs[0].iter().any(|p| p.1 == 399.0));
        assert!(runs[0].windows(2).all(|w| w[0].0 <= w[1].0));
        assert_eq!(runs[0].first(), spiked[0].as_ref());
        assert_eq!(runs[0].last(), spiked[999_999].as_ref());
    }

    #[test]
    fn few_points_are_kept_as_they_are() {
        let points: Vec<_> = (0..50).map(|i| Some((f64::from(i), f64::from(i * i)))).collect();
        let all: Vec<Pixel> = points.iter().flatten().copied().collect();
        assert_eq!(runs(&points, 1000), [all]);
    }

    #[test]
    fn gaps_break_the_line() {
        let mut points = history(100);
        points[40] = None;
        points[42] = None;
        let lengths: Vec<_> = runs(&points, 1000).iter().map(Vec::len).collect();
        assert_eq!(lengths, [40, 1, 57]);
    }

    #[test]
    fn data_of_gaps_and_closed_curves_stay_within_their_budget() {
        let mut points = history(100_000);
        points.iter_mut().step_by(2).for_each(|p| *p = None);
        let total: usize = runs(&points, 2000).iter().map(Vec::len).sum();
        assert!(total <= 2400, "{total}");
        let orbit: Vec<_> = (0..500_000)
            .map(|i| f64::from(i) * 0.01)
            .map(|a| Some((300.0 + 100.0 * a.cos(), 200.0 + 100.0 * a.sin())))
            .collect();
        assert!(runs(&orbit, 3000)[0].len() <= 3000);
        assert!(dots(&orbit, 500).len() <= 500);
    }
}
