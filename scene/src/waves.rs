//! `[water.waves]`: a sea state, and how its motion is found.

use crate::file;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::{BuildError, V3};
use ropewalk_sea::{Regular, Sampling, SeaError, Spectrum, Spreading, Stretching, Waves, measured, sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::io::Read;
use std::path::PathBuf;

/// More waves than any sea needs: the time that their table takes goes with the square of their number.
const MOST: usize = 10_000;

/// Waves on the water, by linear (Airy) theory.
///
/// Give one of `regular`, `jonswap`, `pierson_moskowitz`, `white`, `components` and `measured`. The water's `level` is the surface without
/// waves. Waves and current add up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WavesSpec {
    /// One regular wave.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regular: Option<RegularWave>,
    /// A wind sea with a sharp peak.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jonswap: Option<Jonswap>,
    /// A fully developed wind sea: JONSWAP with `gamma = 1`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pierson_moskowitz: Option<PiersonMoskowitz>,
    /// The same energy at all frequencies of a band, for tests of response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub white: Option<WhiteSea>,
    /// Regular waves, one by one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<WaveComponent>,
    /// A sea as it was measured: the waves of a record of its elevation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredSea>,
    /// Direction that the waves travel towards, the mean if they spread: from x to y [rad].
    #[serde(deserialize_with = "ropewalk_quantity::angle")]
    pub direction: f64,
    /// How directions spread about the mean. Default: all waves have the same direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spreading: Option<SpreadingSpec>,
    /// Number of regular waves that make a spectrum, 10000 at most.
    pub count: usize,
    /// How their frequencies are chosen.
    pub sampling: WaveSampling,
    /// Seed of their random phases: the same seed gives the same sea on every machine.
    pub seed: u64,
    /// Depth of the water [m]. Default: deep water.
    #[serde(
        deserialize_with = "ropewalk_quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub depth: Option<f64>,
    /// Time from t = 0 in which the waves rise from still water, as `(1 - cos πt/ramp)/2` [s].
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub ramp: f64,
    /// What linear theory, which ends at still water, says between there and the surface.
    pub stretching: WaveStretching,
    /// Whether the current carries the waves: their periods are those seen from a fixed place, and their lengths change. Default:
    /// waves as in water at rest, and current, are added.
    pub doppler: bool,
    /// `exact`, the sum over all waves, or `lattice`, a table of it. Default: `lattice` for more than 8 waves of one direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evaluation: Option<Evaluation>,
    /// Largest error of velocities from the lattice, in parts of their standard deviation at still water; checked when the scene
    /// is built.
    #[serde(deserialize_with = "ropewalk_quantity::number")]
    pub lattice_error: f64,
}

impl Default for WavesSpec {
    fn default() -> Self {
        WavesSpec {
            regular: None,
            jonswap: None,
            pierson_moskowitz: None,
            white: None,
            components: Vec::new(),
            measured: None,
            direction: 0.0,
            spreading: None,
            count: 200,
            sampling: WaveSampling::EqualEnergy,
            seed: 1,
            depth: None,
            ramp: 0.0,
            stretching: WaveStretching::Wheeler,
            doppler: false,
            evaluation: None,
            lattice_error: 1e-3,
        }
    }
}

/// One regular wave. With phase 0 a crest is at the origin at t = 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegularWave {
    /// Height from trough to crest [m].
    #[serde(deserialize_with = "ropewalk_quantity::length")]
    pub height: f64,
    /// Period [s].
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub period: f64,
    /// Phase at the origin at t = 0 [rad].
    #[serde(default, deserialize_with = "ropewalk_quantity::angle")]
    pub phase: f64,
}

fn gamma() -> f64 {
    3.3
}

/// Spectrum of a growing wind sea (Hasselmann et al., 1973), scaled so that the significant height is exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Jonswap {
    /// Significant height, four times the standard deviation of the elevation [m].
    #[serde(deserialize_with = "ropewalk_quantity::length")]
    pub hs: f64,
    /// Peak period [s].
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub tp: f64,
    /// Peakedness.
    #[serde(default = "gamma", deserialize_with = "ropewalk_quantity::number")]
    pub gamma: f64,
}

/// Spectrum of a fully developed wind sea (Pierson and Moskowitz, 1964).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PiersonMoskowitz {
    /// Significant height [m].
    #[serde(deserialize_with = "ropewalk_quantity::length")]
    pub hs: f64,
    /// Peak period [s].
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub tp: f64,
}

/// White noise in a band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WhiteSea {
    /// Significant height [m].
    #[serde(deserialize_with = "ropewalk_quantity::length")]
    pub hs: f64,
    /// Lowest angular frequency [rad/s].
    #[serde(deserialize_with = "ropewalk_quantity::angular_velocity")]
    pub from: f64,
    /// Highest angular frequency [rad/s].
    #[serde(deserialize_with = "ropewalk_quantity::angular_velocity")]
    pub to: f64,
}

/// One of many regular waves: `a cos(k (x cos β + y sin β) - 2π t/T + φ)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveComponent {
    /// Amplitude, half of the height [m].
    #[serde(deserialize_with = "ropewalk_quantity::length")]
    pub amplitude: f64,
    /// Period [s].
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub period: f64,
    /// Phase at the origin at t = 0: 0 is a crest [rad].
    #[serde(default, deserialize_with = "ropewalk_quantity::angle")]
    pub phase: f64,
    /// Direction that it travels towards, from x to y [rad]. Default: that of all.
    #[serde(
        default,
        deserialize_with = "ropewalk_quantity::optional::angle",
        skip_serializing_if = "Option::is_none"
    )]
    pub direction: Option<f64>,
}

fn shortest() -> f64 {
    2.0
}

/// A record of the elevation at the origin, from t = 0 on. Waves travel in one direction; the record repeats after its length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredSea {
    /// A file with rows `t, elevation` [s, m] at equal intervals, parted by commas or blanks; its path is relative to the scene file.
    pub file: PathBuf,
    /// Shorter waves are left out [s].
    #[serde(default = "shortest", deserialize_with = "ropewalk_quantity::time")]
    pub shortest: f64,
}

impl MeasuredSea {
    /// The elevations, and their interval.
    fn read(&self) -> Result<(Vec<f64>, f64), String> {
        let mut text = String::new();
        file::open(&self.file)?.read_to_string(&mut text).map_err(|e| e.to_string())?;
        let mut rows: Vec<[f64; 2]> = Vec::new();
        for (k, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
            let cells: Vec<Option<f64>> = line
                .split(|c: char| c == ',' || c.is_whitespace())
                .filter(|cell| !cell.is_empty())
                .map(|cell| cell.parse().ok())
                .collect();
            match cells[..] {
                [Some(t), Some(x)] => rows.push([t, x]),
                _ if rows.is_empty() && cells.iter().all(Option::is_none) => {}
                _ => return Err(format!("line {} isn't `t, elevation`: two numbers, in s and m", k + 1)),
            }
        }
        let &[[first, _], .., [last, _]] = &rows[..] else {
            return Err("it holds fewer than two rows".into());
        };
        let dt = (last - first) / (rows.len() - 1) as f64;
        let even = |(k, row): (usize, &[f64; 2])| (row[0] - first - dt * k as f64).abs() <= 1e-3 * dt;
        if !(dt > 0.0 && rows.iter().enumerate().all(even)) {
            return Err("its rows aren't at equal intervals of time".into());
        }
        Ok((rows.iter().map(|row| row[1]).collect(), dt))
    }

    /// How long its record is [s].
    pub fn lasts(&self) -> Option<f64> {
        let (elevation, dt) = self.read().ok()?;
        Some(dt * elevation.len() as f64)
    }

    fn waves(&self, direction: f64) -> Result<Vec<Regular>, BuildError> {
        let wrong = |why: String| {
            let message = format!("record `{}`: {why}", self.file.display());
            BuildError::at("water.waves.measured.file", message)
        };
        let (elevation, dt) = self.read().map_err(wrong)?;
        measured(&elevation, dt, self.shortest, direction).map_err(|e| match e.field {
            "shortest" => BuildError::at("water.waves.measured.shortest", e.message),
            "direction" => BuildError::at("water.waves.direction", e.message),
            _ => wrong(e.message),
        })
    }
}

/// Directions by `cos^{2s}` of half the angle to the mean (Longuet-Higgins, Cartwright and Smith, 1963).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpreadingSpec {
    /// Exponent: the larger, the narrower.
    #[serde(deserialize_with = "ropewalk_quantity::number")]
    pub s: f64,
    /// Number of directions, of equal energy each.
    pub directions: usize,
}

/// How the frequencies of a spectrum are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WaveSampling {
    /// At the median energy of bins of equal energy: all amplitudes are equal, and nothing repeats.
    EqualEnergy,
    /// At random in bins of equal width: more waves in the tail of the spectrum.
    Jitter,
}

/// How linear theory goes on above still water.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WaveStretching {
    /// The column of water is stretched to the surface (Wheeler, 1970).
    Wheeler,
    /// Above still water the motion is that at still water.
    Constant,
    /// The formulas as they are: short waves grow without bound in crests. For verification.
    None,
}

impl From<WaveStretching> for Stretching {
    fn from(stretching: WaveStretching) -> Self {
        match stretching {
            WaveStretching::Wheeler => Stretching::Wheeler,
            WaveStretching::Constant => Stretching::Constant,
            WaveStretching::None => Stretching::None,
        }
    }
}

/// How the sum over all waves is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Evaluation {
    /// Wave by wave.
    Exact,
    /// Between places and instants of a table, which is filled as the run goes on.
    Lattice,
}

impl WavesSpec {
    /// The table of the spec that the sea state is in.
    fn state(&self) -> &'static str {
        match () {
            () if self.jonswap.is_some() => "jonswap",
            () if self.pierson_moskowitz.is_some() => "pierson_moskowitz",
            () if self.white.is_some() => "white",
            () if self.regular.is_some() => "regular",
            () => "components",
        }
    }

    /// An error of the sea as one of the scene.
    pub(crate) fn fault(&self, error: SeaError) -> BuildError {
        let field = match error.field {
            "hs" | "tp" | "gamma" | "from" | "to" => format!("{}.{}", self.state(), error.field),
            "amplitude" | "omega" | "phase" => self.state().into(),
            "s" | "directions" => format!("spreading.{}", error.field),
            "components" => "count".into(),
            other => other.into(),
        };
        BuildError::at(format!("water.waves.{field}"), error.message)
    }

    /// Whether there is one sea state, and what belongs to it alone.
    fn check(&self) -> Result<(), BuildError> {
        let at = |field: &str, message: String| BuildError::at(format!("water.waves{field}"), message);
        let given = [
            self.regular.is_some(),
            self.jonswap.is_some(),
            self.pierson_moskowitz.is_some(),
            self.white.is_some(),
            !self.components.is_empty(),
            self.measured.is_some(),
        ];
        let number = given.iter().filter(|given| **given).count();
        if number != 1 {
            let message = format!(
                "[water.waves] has {}: give one of `regular`, `jonswap`, `pierson_moskowitz`, `white`, `components` and \
                 `measured`",
                if number == 0 { "no sea state" } else { "more than one sea state" }
            );
            return Err(at("", message));
        }
        let single = self.regular.is_some() || !self.components.is_empty() || self.measured.is_some();
        if single && self.spreading.is_some() {
            let message = "`spreading` is for spectra: give each of the `components` its `direction`";
            return Err(at(".spreading", message.into()));
        }
        if self.count > MOST {
            let message =
                format!("`count` must be between 1 and {MOST}, not {}: some hundreds make a sea", self.count);
            return Err(at(".count", message));
        }
        positive("lattice_error", self.lattice_error).map_err(|e| e.of("water.waves.lattice_error"))?;
        Ok(())
    }

    /// The waves under gravity `g` [m/s²], on a current of velocity `drift` [m/s] if they are told to feel it.
    ///
    /// # Errors
    /// Numbers that make no sense.
    pub fn waves(&self, g: f64, drift: V3<f64>) -> Result<Waves, BuildError> {
        let of = |e: SeaError| self.fault(e);
        let depth = self.depth.unwrap_or(f64::INFINITY);
        let waves = Waves::new(&self.components()?, depth, g, self.stretching.into()).map_err(of)?;
        let waves = waves.with_ramp(self.ramp).map_err(of)?;
        let trough = 0.5 * waves.height();
        if !(trough < 0.95 * depth) {
            let message = format!(
                "the troughs of these waves are {trough:.3} m deep, and the water is only {depth} m: take lower waves, or more `depth`"
            );
            return Err(BuildError::at("water.waves.depth", message));
        }
        if self.doppler { waves.on_current([drift[0], drift[1]]).map_err(of) } else { Ok(waves) }
    }

    /// The regular waves that make it.
    ///
    /// # Errors
    /// No sea state or more than one; numbers that make no sense.
    pub fn components(&self) -> Result<Vec<Regular>, BuildError> {
        self.check()?;
        let omega = |period: f64| positive("period", period).map(|t| TAU / t);
        if let Some(wave) = self.regular {
            not_negative("height", wave.height).map_err(|e| e.of("water.waves.regular.height"))?;
            let of = |e: BuildError| e.of("water.waves.regular.period");
            let (amplitude, omega) = (0.5 * wave.height, omega(wave.period).map_err(of)?);
            return Ok(vec![Regular { amplitude, omega, phase: wave.phase, direction: self.direction }]);
        }
        if !self.components.is_empty() {
            let one = |w: &WaveComponent| {
                let omega = omega(w.period).map_err(|e| e.of("water.waves.components"))?;
                let direction = w.direction.unwrap_or(self.direction);
                Ok(Regular { amplitude: w.amplitude, omega, phase: w.phase, direction })
            };
            return self.components.iter().map(one).collect();
        }
        if let Some(record) = &self.measured {
            return record.waves(self.direction);
        }
        let spectrum = match (self.jonswap, self.pierson_moskowitz, self.white) {
            (Some(Jonswap { hs, tp, gamma }), ..) => Spectrum::Jonswap { hs, tp, gamma },
            (_, Some(PiersonMoskowitz { hs, tp }), _) => Spectrum::Jonswap { hs, tp, gamma: 1.0 },
            (.., Some(WhiteSea { hs, from, to })) => Spectrum::White { hs, from, to },
            _ => return Ok(Vec::new()),
        };
        let sampling = match self.sampling {
            WaveSampling::EqualEnergy => Sampling::EqualEnergy,
            WaveSampling::Jitter => Sampling::Jitter,
        };
        let spreading = self.spreading.map(|s| Spreading { s: s.s, directions: s.directions });
        sample(&spectrum, self.count, self.seed, sampling, self.direction, spreading)
            .map_err(|e| self.fault(e))
    }
}
