//! The shapes that are kept while a run goes on: those that pictures show, and those of the field record.

use super::scenery::Scenery;
use super::shapes::Shape;
use ropewalk_core::{At, Model, State};
use ropewalk_report::{FieldRecord, RunFolder};
use ropewalk_scene::Run;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Most rows of `field.npy`: about 60 MB.
const MOST_POINTS: usize = 500_000;
/// The field record is written at most this often while the run goes on …
const PERIOD: Duration = Duration::from_secs(5);
/// … and takes at most this part of the time.
const SHARE: u32 = 50;
/// Fewer snapshots of a field record would show no motion.
const LEAST: usize = 61;

/// Where a field record is written, when that was done last, and how long it took.
struct Live {
    files: [PathBuf; 3],
    last: Instant,
    cost: Duration,
}

/// Shapes, and when others are to follow.
pub(crate) struct Kept {
    /// All of them, in the order of time.
    pub shapes: Vec<Shape>,
    /// When shapes are still to be kept for pictures, last first …
    pub due: Vec<f64>,
    /// … and for the field record.
    pub field_due: Vec<f64>,
    /// What there is to be seen, if a field record is wanted.
    pub scenery: Option<Scenery>,
    duration: f64,
    /// Where the field record is written while the run goes on.
    live: Option<Live>,
    /// What was asked for, and what there is of it, if that is less.
    pub thinned: Option<String>,
}

impl Kept {
    /// Shapes for pictures only.
    pub fn new(run: &Run) -> Self {
        let due = evenly(run.snapshots, run.duration);
        let (shapes, field_due) = (Vec::new(), Vec::new());
        Kept { shapes, due, field_due, scenery: None, duration: run.duration, live: None, thinned: None }
    }

    /// Keeps shapes for a field record too, and measures along lines.
    pub fn want_field(&mut self, run: &Run, scenery: Scenery) {
        let mut count = run.field_snapshots;
        let points = scenery.points().max(1);
        if count.saturating_mul(points) > MOST_POINTS {
            let fits = (MOST_POINTS / points).max(LEAST).min(count);
            if fits < count {
                self.thinned = Some(format!(
                    "the field record holds {fits} snapshots, not the {count} of `field_snapshots`: each has {points} points"
                ));
            }
            count = fits;
        }
        self.field_due = evenly(count, run.duration);
        self.scenery = Some(scenery);
    }

    /// Writes the field record into this folder now and then, so that a run that still goes on can be seen.
    pub fn live_in(&mut self, folder: &RunFolder) {
        let files = [folder.field_file(), folder.bodies_file(), folder.forces_file()];
        self.live =
            self.scenery.is_some().then(|| Live { files, last: Instant::now(), cost: Duration::ZERO });
    }

    /// Writes it if that is long ago. What goes wrong is said when it is written for good.
    fn write_now_and_then(&mut self) {
        let due = |live: &Live| live.last.elapsed() >= PERIOD.max(SHARE * live.cost);
        if !self.live.as_ref().is_some_and(due) {
            return;
        }
        let (start, field) = (Instant::now(), self.field());
        if let (Some(field), Some(live)) = (field, &mut self.live) {
            let _ = field.write_npy(&live.files[0], &live.files[1]);
            let _ = field.write_forces_npy(&live.files[2]);
            (live.last, live.cost) = (Instant::now(), start.elapsed());
        }
    }

    /// Looks at another model of the same scene: what it consists of is counted anew.
    pub fn follow(&mut self, model: &Model) {
        if let Some(scenery) = &mut self.scenery {
            scenery.follow(model);
        }
    }

    /// Whether a field record is kept.
    pub fn has_field(&self) -> bool {
        self.scenery.is_some()
    }

    /// What is due at `t`: an instant that is off by rounding is the right one.
    fn until(&self, t: f64) -> f64 {
        t + 1e-9 * self.duration
    }

    /// Whether a shape is due at `t`.
    pub fn is_due(&self, t: f64) -> bool {
        [&self.due, &self.field_due].iter().any(|due| due.last().is_some_and(|due| *due <= self.until(t)))
    }

    /// Keeps the shape if one is due at `t`.
    pub fn look(&mut self, t: f64, shape: impl FnOnce(Option<&Scenery>) -> Shape) {
        let now = self.until(t);
        let [is_drawn, of_field] = [&mut self.due, &mut self.field_due].map(|due| {
            let before = due.len();
            due.truncate(before - due.iter().rev().take_while(|due| **due <= now).count());
            due.len() < before
        });
        if is_drawn || of_field {
            self.push(Shape { is_drawn, ..shape(self.scenery.as_ref()) });
        }
    }

    /// Keeps the state in which the run ended, unless it is there already.
    pub fn last(&mut self, model: &Model, state: &State) {
        let missing = self.shapes.last().is_some_and(|last| last.t < state.t);
        if missing && (!self.due.is_empty() || !self.field_due.is_empty()) {
            let shape = Shape::of(model, &state.at(), &state.lambda, self.scenery.as_ref());
            self.push(Shape { is_drawn: !self.due.is_empty(), ..shape });
        }
    }

    fn push(&mut self, shape: Shape) {
        self.shapes.push(shape);
        self.write_now_and_then();
    }

    /// The field record, if one is kept.
    pub fn field(&self) -> Option<FieldRecord> {
        self.scenery.as_ref().map(|scenery| scenery.field(&self.shapes))
    }

    /// Those that pictures show.
    pub fn drawn(&self) -> impl Iterator<Item = &Shape> {
        self.shapes.iter().filter(|shape| shape.is_drawn)
    }

    /// An instant of a model, as it is looked at.
    pub fn sample(&mut self, model: &Model, at: &At<'_>, lambda: &[f64]) {
        self.look(at.t, |scenery| Shape::of(model, at, lambda, scenery));
    }
}

/// Instants from 0 to the end, last first; a single one is the end.
fn evenly(count: usize, duration: f64) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    let at = |k: usize| duration * if count == 1 { 1.0 } else { k as f64 / last as f64 };
    (0..count).rev().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(t: f64) -> Shape {
        Shape::bare(t)
    }

    #[test]
    fn shapes_are_kept_when_one_is_due() {
        let run = Run { duration: 1.0, snapshots: 3, field_snapshots: 5, ..Run::default() };
        let mut kept = Kept::new(&run);
        kept.want_field(&run, Scenery::default());
        for k in 0..=10 {
            let t = 0.1 * f64::from(k);
            assert_eq!(kept.is_due(t), [0, 3, 5, 8, 10].contains(&k), "{t}");
            kept.look(t, |_| shape(t));
        }
        let told: Vec<(i32, bool)> =
            kept.shapes.iter().map(|s| ((10.0 * s.t).round() as i32, s.is_drawn)).collect();
        assert_eq!(told, [(0, true), (3, false), (5, true), (8, false), (10, true)]);
        assert_eq!(kept.drawn().count(), 3);
    }

    #[test]
    fn without_a_field_record_only_pictures_are_kept() {
        let mut kept = Kept::new(&Run { duration: 1.0, snapshots: 1, ..Run::default() });
        (0..=4).for_each(|k| kept.look(0.25 * f64::from(k), |_| shape(0.25 * f64::from(k))));
        assert_eq!(kept.shapes, [shape(1.0)]);
    }

    #[test]
    fn a_huge_field_record_is_thinned_and_says_so() {
        let run = Run::default();
        let mut kept = Kept::new(&run);
        kept.want_field(&run, Scenery::of_points(5_000));
        assert_eq!(kept.field_due.len(), 100);
        assert!(kept.thinned.unwrap().contains("100 snapshots, not the 361"));
    }
}
