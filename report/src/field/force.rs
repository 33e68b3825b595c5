//! Forces that act at points.

use super::FieldRecord;
use super::npy::{Read, Rows};
use crate::OutputError;
use std::path::Path;

/// A force at a point, at each time of a record: what is drawn as an arrow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceRecord {
    /// What exerts it on what, behind its kind and a colon: `reaction: pin`, `drag: hose`.
    pub name: String,
    /// Where it acts, one for each time [m]; NaN while it isn't there.
    pub points: Vec<[f64; 3]>,
    /// The force, one for each time [N].
    pub forces: Vec<[f64; 3]>,
}

/// What a file of forces begins a row with, and its numbers.
const FORCE: [&str; 7] = ["t", "x", "y", "z", "fx", "fy", "fz"];

impl ForceRecord {
    /// What kind it is: forces of one kind are shown together.
    ///
    /// ```
    /// # use ropewalk_report::ForceRecord;
    /// let drag = ForceRecord { name: "drag: hose".into(), ..ForceRecord::default() };
    /// assert_eq!(drag.kind(), "drag");
    /// ```
    pub fn kind(&self) -> &str {
        self.name.split_once(": ").map_or(&self.name, |(kind, _)| kind)
    }
}

impl FieldRecord {
    /// Writes the forces, if there are any, as a structured array for NumPy: `name t x y z fx fy fz`, a row for each time
    /// and force that is there.
    ///
    /// # Errors
    /// [`OutputError::Field`] for a record with a hole, [`OutputError::Io`] for what can't be written.
    pub fn write_forces_npy(&self, path: &Path) -> Result<(), OutputError> {
        self.check()?;
        if self.forces.is_empty() {
            return Ok(());
        }
        let names = self.forces.iter().map(|f| f.name.as_str());
        let mut rows = Rows::new("name", names, FORCE.iter().map(ToString::to_string));
        for (k, t) in self.times.iter().enumerate() {
            for force in self.forces.iter().filter(|f| f.points[k].iter().all(|x| x.is_finite())) {
                let name = rows.name(&force.name);
                rows.push(&name, [*t].into_iter().chain(force.points[k]).chain(force.forces[k]));
            }
        }
        rows.write(path)
    }

    /// Reads the forces back; their times have to be among those of the record. Without a file there are none.
    ///
    /// # Errors
    /// [`OutputError::Npy`] for a file that isn't such a one, [`OutputError::Io`] for one that can't be read.
    pub fn read_forces_npy(&mut self, path: &Path) -> Result<(), OutputError> {
        self.forces.clear();
        if !path.exists() {
            return Ok(());
        }
        let nowhere = vec![[f64::NAN; 3]; self.times.len()];
        for (name, row) in Read::file(path, &FORCE)?.rows {
            let Ok(at) = self.times.binary_search_by(|t| t.total_cmp(&row[0])) else { continue };
            let k = self.forces.iter().position(|f| f.name == name).unwrap_or_else(|| {
                let (points, forces) = (nowhere.clone(), nowhere.clone());
                self.forces.push(ForceRecord { name, points, forces });
                self.forces.len() - 1
            });
            self.forces[k].points[at] = [row[1], row[2], row[3]];
            self.forces[k].forces[at] = [row[4], row[5], row[6]];
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("forces.npy");
        let nan = [f64::NAN; 3];
        let force = |name: &str, points: [[f64; 3]; 2], forces: [[f64; 3]; 2]| ForceRecord {
            name: name.into(),
            points: points.into(),
            forces: forces.into(),
        };
        let field = FieldRecord {
            times: vec![0.0, 0.5],
            forces: vec![
                force(
                    "reaction: pin",
                    [[1.0, 2.0, 3.0], [1.0; 3]],
                    [[0.0, 0.0, -1e3], [1.0 / 3.0, 0.0, 0.0]],
                ),
                force("contact: drum on hose", [nan, [4.0; 3]], [nan, [5.0; 3]]),
            ],
            ..FieldRecord::default()
        };
        field.write_forces_npy(&path).unwrap();
        let mut back = FieldRecord { times: vec![0.0, 0.5], ..FieldRecord::default() };
        back.read_forces_npy(&path).unwrap();
        assert_eq!(back.forces[0], field.forces[0]);
        assert_eq!((&back.forces[1].name, back.forces[1].points[1]), (&field.forces[1].name, [4.0; 3]));
        assert!(back.forces[1].points[0][0].is_nan());
        assert_eq!(back.forces[1].kind(), "contact");
        back.read_forces_npy(&folder.path().join("none")).unwrap();
        assert!(back.forces.is_empty());
    }
}
