//! Response amplitude operators as a scene writes them: motions of a vessel, or loads on it, per metre of wave amplitude.

use ropewalk_core::BuildError;
use ropewalk_quantity as quantity;
use ropewalk_sea::{MOTIONS, Responses};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Response amplitude operators: motions of a vessel, or loads on it, per metre of wave amplitude.
///
/// A wave `a cos θ` makes the motion (or load) `a A cos(θ + lag)`, with the wave's `θ` at the reference point in still water. `θ`
/// falls with time, so that a positive lag is later than the crest. Axes: x ahead, y to port, z up; pitch turns the bow down,
/// roll port up. On long waves, motions should have: surge 1 with lag 90 from astern, heave 1 with lag 0, pitch with lag -90 from
/// astern, roll with lag 90 in waves towards port; loads: surge with lag -90 from astern, heave its stiffness with lag 0, pitch and
/// roll as motions. The notes of a run say what a table has. `phase`, `waves`, `per`, `symmetry` and `angles` say how the table was
/// written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RaoSpec {
    /// Directions that waves travel relative to the heading, ascending from 0 [rad]: 0 from astern, 90 deg towards port, 180 deg a
    /// head sea. Between them, and round from the last to the first, responses are interpolated.
    #[serde(deserialize_with = "quantity::list::angle")]
    pub headings: Vec<f64>,
    /// Angular frequencies, ascending [rad/s]. Beyond them responses are those at the ends.
    #[serde(deserialize_with = "quantity::list::angular_velocity")]
    pub omegas: Vec<f64>,
    /// For each direction and frequency, per metre of wave amplitude. Motions: surge, sway, heave in metres, roll, pitch, yaw in
    /// degrees. Loads: forces in N along x, y, z, moments in N m about them.
    pub amplitude: Vec<Vec<[f64; MOTIONS]>>,
    /// For each direction and frequency the lag of each behind the crest in degrees.
    pub lag: Vec<Vec<[f64; MOTIONS]>>,
    /// Whether phases lag behind the crest, or lead it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub phase: RaoPhase,
    /// Whether `headings` are where waves travel to, or where they come from.
    #[serde(default, skip_serializing_if = "is_default")]
    pub waves: RaoWaves,
    /// Whether responses are per metre of amplitude, or of height from trough to crest.
    #[serde(default, skip_serializing_if = "is_default")]
    pub per: RaoPer,
    /// Whether the table goes from 0 to 180 deg and holds for the other side of a symmetric vessel too.
    #[serde(default, skip_serializing_if = "is_default")]
    pub symmetry: RaoSymmetry,
    /// Unit of amplitudes of roll, pitch and yaw.
    #[serde(default, skip_serializing_if = "is_default")]
    pub angles: RaoAngles,
}

/// What phases of a table count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RaoPhase {
    /// A positive phase is later than the crest.
    #[default]
    Lag,
    /// A positive phase is before the crest.
    Lead,
}

/// What directions of waves mean in a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RaoWaves {
    /// Where waves travel to, relative to the heading: 0 from astern.
    #[default]
    Towards,
    /// Where waves come from, relative to the heading: 0 a head sea.
    From,
}

/// What the responses of a table are divided by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RaoPer {
    /// The amplitude of the wave.
    #[default]
    Amplitude,
    /// Its height, twice the amplitude.
    Height,
}

/// Symmetry of a vessel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RaoSymmetry {
    /// The table has all directions.
    #[default]
    None,
    /// Port and starboard are alike: the table goes from 0 to 180 deg.
    Xz,
}

/// Unit of angles per metre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RaoAngles {
    /// Degrees.
    #[default]
    Deg,
    /// Radians.
    Rad,
}

fn is_default<T: Default + PartialEq>(x: &T) -> bool {
    *x == T::default()
}

/// What waves of one direction do: by frequency, amplitudes and lags.
type Row = (f64, Vec<[f64; MOTIONS]>, Vec<[f64; MOTIONS]>);

impl RaoSpec {
    /// The table as one of motions, in metres and radians.
    ///
    /// # Errors
    /// Lists that don't ascend or don't fit each other; numbers that aren't finite. The message is about what is in `field`.
    pub fn motions(&self, field: &str) -> Result<Responses, BuildError> {
        let turn = if self.angles == RaoAngles::Deg { PI / 180.0 } else { 1.0 };
        self.responses(field, [1.0, 1.0, 1.0, turn, turn, turn])
    }

    /// The table as one of loads, in N and N m.
    ///
    /// # Errors
    /// As for [`RaoSpec::motions`]; a unit of angles, which loads don't have.
    pub fn loads(&self, field: &str) -> Result<Responses, BuildError> {
        if self.angles != RaoAngles::Deg {
            return Err(BuildError::at(
                format!("{field}.angles"),
                "loads have no angles: leave `angles` out",
            ));
        }
        self.responses(field, [1.0; MOTIONS])
    }

    fn responses(&self, field: &str, unit: [f64; MOTIONS]) -> Result<Responses, BuildError> {
        let scale = if self.per == RaoPer::Height { 2.0 } else { 1.0 };
        let sign = if self.phase == RaoPhase::Lead { -1.0 } else { 1.0 };
        let rows = |of: &[Vec<[f64; MOTIONS]>], by: &dyn Fn(usize, f64) -> f64| -> Vec<Vec<[f64; MOTIONS]>> {
            let one = |row: &[f64; MOTIONS]| std::array::from_fn(|k| by(k, row[k]));
            of.iter().map(|row| row.iter().map(one).collect()).collect()
        };
        let amplitude = rows(&self.amplitude, &|k, a| scale * unit[k] * a);
        let lag = rows(&self.lag, &|_, lag| sign * lag.to_radians());
        let fault = |e: ropewalk_sea::SeaError| BuildError::at(format!("{field}.{}", e.field), e.message);
        // as written, so that what is wrong is found where it stands
        let written = Responses::new(self.headings.clone(), self.omegas.clone(), &amplitude, &lag);
        if self.symmetry == RaoSymmetry::None && self.waves == RaoWaves::Towards {
            return written.map_err(fault);
        }
        written.map_err(fault)?;
        let mut all: Vec<Row> = (0..self.headings.len())
            .map(|i| (self.headings[i], amplitude[i].clone(), lag[i].clone()))
            .collect();
        if self.symmetry == RaoSymmetry::Xz {
            all.extend(self.mirrored(field, &all)?);
        }
        if self.waves == RaoWaves::From {
            all.iter_mut().for_each(|(heading, ..)| *heading = (*heading + PI).rem_euclid(TAU));
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let headings = all.iter().map(|row| row.0).collect();
        let amplitude: Vec<_> = all.iter().map(|row| row.1.clone()).collect();
        let lag: Vec<_> = all.iter().map(|row| row.2.clone()).collect();
        Responses::new(headings, self.omegas.clone(), &amplitude, &lag).map_err(fault)
    }

    /// The rows of the other side: sway, roll and yaw are turned round.
    fn mirrored(&self, field: &str, rows: &[Row]) -> Result<Vec<Row>, BuildError> {
        if let Some((heading, ..)) = rows.iter().find(|row| row.0 > PI + 1e-9) {
            let message = format!(
                "a symmetric vessel has `headings` from 0 to 180 deg, and one is {:.1} deg: leave `symmetry` out",
                heading.to_degrees()
            );
            return Err(BuildError::at(format!("{field}.headings"), message));
        }
        let aside = rows.iter().filter(|row| row.0 > 1e-9 && row.0 < PI - 1e-9);
        let turned =
            |lag: &[f64; MOTIONS]| std::array::from_fn(|k| if k % 2 == 1 { lag[k] + PI } else { lag[k] });
        Ok(aside
            .map(|(heading, a, lag)| (TAU - heading, a.clone(), lag.iter().map(turned).collect()))
            .collect())
    }

    /// What a table of motions has on its longest waves, in a sentence beside what it should have.
    pub fn long_motions(&self) -> Option<String> {
        let responses = self.motions("").ok()?;
        let (from_astern, towards_port) = ends(&responses);
        let metres = |k: usize| {
            format!("{:.3} m/m with lag {:.0} deg", from_astern[k][0], from_astern[k][1].to_degrees())
        };
        let degrees =
            |[a, lag]: [f64; 2]| format!("{:.3} deg/m with lag {:.0} deg", a.to_degrees(), lag.to_degrees());
        Some(format!(
            "on its longest waves, of {:.1} s, from astern: surge {}, heave {}, pitch {}; towards port: roll {}. Endlessly long \
             ones have lags of 90, 0, -90 and 90 deg",
            TAU / responses.band()[0],
            metres(0),
            metres(2),
            degrees(from_astern[4]),
            degrees(towards_port[3]),
        ))
    }

    /// The same of a table of loads, beside what the stiffness of heave, roll and pitch makes of long waves.
    pub fn long_loads(&self, [heave, roll, pitch]: [f64; 3]) -> Option<String> {
        let responses = self.loads("").ok()?;
        let (from_astern, towards_port) = ends(&responses);
        let omega = responses.band()[0];
        let slope = omega * omega / crate::GRAVITY[2].abs();
        let say = |[a, lag]: [f64; 2], still: f64, wanted: f64| {
            format!(
                "{a:.3e} with lag {:.0} deg (from stiffness {still:.3e} with {wanted:.0} deg)",
                lag.to_degrees()
            )
        };
        Some(format!(
            "on its longest waves, of {:.1} s, per metre, from astern: surge {:.3e} N with lag {:.0} deg (long ones -90 deg), heave \
             {} N, pitch {} N m; towards port: roll {} N m, in deep water",
            TAU / omega,
            from_astern[0][0],
            from_astern[0][1].to_degrees(),
            say(from_astern[2], heave, 0.0),
            say(from_astern[4], pitch * slope, -90.0),
            say(towards_port[3], roll * slope, 90.0),
        ))
    }
}

/// The longest waves from astern and towards port.
fn ends(responses: &Responses) -> ([[f64; 2]; MOTIONS], [[f64; 2]; MOTIONS]) {
    let omega = responses.band()[0];
    (responses.at(0.0, omega), responses.at(0.25 * TAU, omega))
}
