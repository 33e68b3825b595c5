//! What moved in a run: lines, bodies and the shapes that they touch, at the times of its snapshots.
//!
//! The [`FieldRecord`] is the one source of the page in the browser ([`Page`](crate::Page)) and of the files
//! for ParaView ([`vtk`](crate::vtk)).

mod force;
mod mesh;
mod npy;
mod solid;
mod wave;

pub use force::ForceRecord;
pub use mesh::Mesh;
pub use solid::{Pose, Shape, Solid};
pub use wave::{Wave, Waves};

use crate::OutputError;

/// All parts of a run at each of its snapshots.
///
/// ```
/// # use ropewalk_report::{FieldRecord, LineRecord, LineSnapshot, OutputError, Quantity};
/// let mut hose = LineRecord::new("hose", "cable", 0.05);
/// hose.quantities.push(Quantity::new("tension", "N"));
/// hose.snapshots.push(LineSnapshot {
///     s: vec![0.0, 15.0, 30.0],
///     position: vec![[0.0, 0.0, 0.0], [-9.0, 0.0, -12.0], [-18.0, 0.0, -24.0]],
///     values: vec![vec![250.0, 120.0, 0.0]],
///     ..LineSnapshot::default()
/// });
/// let field = FieldRecord { times: vec![0.0], lines: vec![hose], water: Some(0.0), ..FieldRecord::default() };
/// field.check()?;
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldRecord {
    /// Times of the snapshots, rising [s]; the load factors of a load path.
    pub times: Vec<f64>,
    /// Cables, chains and whatever else has a line.
    pub lines: Vec<LineRecord>,
    /// Rigid bodies and points.
    pub bodies: Vec<BodyRecord>,
    /// Forces at points, for arrows.
    pub forces: Vec<ForceRecord>,
    /// Shapes that stand on the ground.
    pub shapes: Vec<Shape>,
    /// Height of the water's surface [m], if there is one.
    pub water: Option<f64>,
    /// The waves on it, if there are some.
    pub waves: Option<Waves>,
    /// Height of the sea bed [m], if there is one.
    pub bed: Option<f64>,
}

/// A line and what is known along it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineRecord {
    /// Name of the part, such as `hose`.
    pub name: String,
    /// What it is, such as `cable`.
    pub kind: String,
    /// Where the scene says so, such as `scene.toml:12`; empty if nowhere.
    pub place: String,
    /// Outer diameter [m].
    pub diameter: f64,
    /// What is known at its points beside their place: tension, curvature, speed, …
    pub quantities: Vec<Quantity>,
    /// One for each time of the record.
    pub snapshots: Vec<LineSnapshot>,
}

/// A number that each point of a line has.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Quantity {
    /// Its name, such as `tension`. Equal names on several lines share one scale of colours.
    pub name: String,
    /// Its unit, such as `N`; empty for none.
    pub unit: String,
}

impl Quantity {
    /// A quantity of this name and unit.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// A line at one time. A line that isn't there yet has no points; their number may change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineSnapshot {
    /// Unstretched arc lengths of the points, rising [m].
    pub s: Vec<f64>,
    /// Places of the points [m].
    pub position: Vec<[f64; 3]>,
    /// Velocities of the material there [m/s]; empty where they aren't known.
    pub velocity: Vec<[f64; 3]>,
    /// For each of the line's quantities its values at the points; NaN where there is none.
    pub values: Vec<Vec<f64>>,
}

/// A body, or a point that moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyRecord {
    /// Name of the part, such as `ship`.
    pub name: String,
    /// What it is, such as `rigid body`.
    pub kind: String,
    /// Where the scene says so, such as `scene.toml:12`; empty if nowhere.
    pub place: String,
    /// Its hull and the shapes fixed to it, in its axes. Without any it is drawn as a point.
    pub shapes: Vec<Shape>,
    /// One for each time of the record.
    pub poses: Vec<Pose>,
}

impl LineRecord {
    /// A line of this name, kind and diameter [m], without snapshots.
    pub fn new(name: impl Into<String>, kind: impl Into<String>, diameter: f64) -> Self {
        Self { name: name.into(), kind: kind.into(), diameter, ..Self::default() }
    }
}

impl BodyRecord {
    /// A body of this name and kind, without shapes and poses.
    pub fn new(name: impl Into<String>, kind: impl Into<String>) -> Self {
        Self { name: name.into(), kind: kind.into(), ..Self::default() }
    }
}

impl FieldRecord {
    /// Whether all parts have a snapshot for each time, and all points all their numbers.
    ///
    /// # Errors
    /// [`OutputError::Field`], naming the part and the time.
    pub fn check(&self) -> Result<(), OutputError> {
        let fail = |part: &str, message: String| OutputError::Field { part: part.into(), message };
        if let Some(k) = (1..self.times.len()).find(|k| !(self.times[k - 1] < self.times[*k])) {
            return Err(fail("times", format!("{} comes after {}", self.times[k], self.times[k - 1])));
        }
        let count = self.times.len();
        for line in &self.lines {
            if line.snapshots.len() != count {
                return Err(fail(
                    &line.name,
                    format!("{} snapshots for {count} times", line.snapshots.len()),
                ));
            }
            for (t, snapshot) in self.times.iter().zip(&line.snapshots) {
                let points = snapshot.position.len();
                let lengths = snapshot.values.iter().map(Vec::len);
                let named = line.quantities.iter().map(|q| q.name.as_str()).zip(lengths);
                let lengths = std::iter::once(("s", snapshot.s.len())).chain(named);
                let velocities =
                    (!snapshot.velocity.is_empty()).then_some(("velocity", snapshot.velocity.len()));
                for (name, found) in lengths.chain(velocities) {
                    if found != points {
                        return Err(fail(
                            &line.name,
                            format!("{found} values of {name} for {points} points at {t}"),
                        ));
                    }
                }
                if snapshot.values.len() != line.quantities.len() {
                    let (found, named) = (snapshot.values.len(), line.quantities.len());
                    return Err(fail(&line.name, format!("{found} columns for {named} quantities at {t}")));
                }
            }
        }
        for body in &self.bodies {
            if body.poses.len() != count {
                return Err(fail(&body.name, format!("{} poses for {count} times", body.poses.len())));
            }
        }
        for force in &self.forces {
            for found in [force.points.len(), force.forces.len()] {
                if found != count {
                    return Err(fail(&force.name, format!("{found} forces for {count} times")));
                }
            }
        }
        Ok(())
    }

    /// Least and greatest coordinates of all that moves [m]; `None` if nothing has a finite place.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let lines =
            self.lines.iter().flat_map(|line| &line.snapshots).flat_map(|snapshot| &snapshot.position);
        let bodies = self.bodies.iter().flat_map(|body| &body.poses).map(|pose| &pose.position);
        let mut bounds: Option<[[f64; 3]; 2]> = None;
        for x in lines.chain(bodies).filter(|x| x.iter().all(|x| x.is_finite())) {
            let [low, high] = bounds.get_or_insert([*x, *x]);
            for i in 0..3 {
                low[i] = low[i].min(x[i]);
                high[i] = high[i].max(x[i]);
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> FieldRecord {
        let mut line = LineRecord::new("hose", "cable", 0.1);
        line.quantities.push(Quantity::new("tension", "N"));
        let snapshot = LineSnapshot {
            s: vec![0.0, 1.0],
            position: vec![[0.0; 3], [1.0; 3]],
            values: vec![vec![5.0, f64::NAN]],
            ..LineSnapshot::default()
        };
        line.snapshots = vec![snapshot.clone(), snapshot];
        let body = BodyRecord { poses: vec![Pose::default(); 2], ..BodyRecord::new("ship", "point") };
        FieldRecord { times: vec![0.0, 1.0], lines: vec![line], bodies: vec![body], ..FieldRecord::default() }
    }

    #[test]
    fn a_record_with_a_hole_is_refused_by_the_name_of_the_part() {
        record().check().unwrap();
        type Spoil = fn(&mut FieldRecord);
        let spoilt: [(Spoil, &str); 5] = [
            (|r| r.times[1] = 0.0, "times"),
            (|r| r.times[1] = f64::NAN, "times"),
            (|r| r.lines[0].snapshots.truncate(1), "1 snapshots for 2 times"),
            (|r| r.lines[0].snapshots[1].values[0].truncate(1), "1 values of tension for 2 points at 1"),
            (|r| r.bodies[0].poses.truncate(1), "'ship'"),
        ];
        for (spoil, words) in spoilt {
            let mut record = record();
            spoil(&mut record);
            let message = record.check().unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn bounds_leave_out_what_has_no_place() {
        let mut record = record();
        record.bodies[0].poses[1].position = [f64::NAN, 50.0, 0.0];
        record.lines[0].snapshots[1].position[0] = [-2.0, 0.5, 3.0];
        assert_eq!(record.bounds(), Some([[-2.0, 0.0, 0.0], [1.0, 1.0, 3.0]]));
        assert_eq!(FieldRecord::default().bounds(), None);
    }
}
