//! One instance of the FMU: variables by number, and time steps.

use ropewalk::scene::SceneText;
use ropewalk::studies::fmu::{Interface, Kind, Resources};
use ropewalk::{Session, Snapshot, Watch};
use std::collections::BTreeMap;
use std::ffi::CString;
use std::path::Path;

/// What goes wrong, said to whoever runs the co-simulation.
pub(crate) type Failure = String;

/// A scene with its variables.
pub(crate) struct Instance {
    text: SceneText,
    /// Parameters that were set when the FMU was made.
    exported: Vec<String>,
    interface: Interface,
    /// Parameters that were set since, by number.
    parameters: BTreeMap<u32, String>,
    /// Inputs that were set, by number.
    inputs: BTreeMap<u32, f64>,
    /// Texts that were handed out and have to live until the next ones are.
    pub(crate) texts: Vec<CString>,
    /// The run, from the beginning of the initialisation on.
    session: Option<Session>,
    /// The co-simulation's time at the run's time 0 [s].
    start: f64,
    /// How many of the run's warnings were told.
    told: usize,
}

/// The complete state of an instance.
#[derive(Clone)]
pub(crate) struct Saved {
    snapshot: Option<Snapshot>,
    parameters: BTreeMap<u32, String>,
    inputs: BTreeMap<u32, f64>,
    start: f64,
}

/// A state as bytes: a tuple, since the derives of serde would be a dependency for this alone.
type Packed = (Option<Snapshot>, BTreeMap<u32, String>, BTreeMap<u32, f64>, f64);

impl Instance {
    /// An instance of what the folder `resources` of an unpacked FMU holds, if it is the one of this token.
    pub(crate) fn new(resources: &Path, token: &str) -> Result<Self, Failure> {
        let Resources { text, set } = Resources::read(resources).map_err(|e| e.to_string())?;
        let interface = Interface::new(&text, &set).map_err(|e| e.to_string())?;
        if interface.token() != token {
            return Err(format!(
                "the description belongs to another scene: its token is {token}, not {}",
                interface.token()
            ));
        }
        Ok(Instance {
            text,
            exported: set,
            interface,
            parameters: BTreeMap::new(),
            inputs: BTreeMap::new(),
            texts: Vec::new(),
            session: None,
            start: 0.0,
            told: 0,
        })
    }

    /// Back to how it was made.
    pub(crate) fn reset(&mut self) {
        self.parameters.clear();
        self.inputs.clear();
        (self.session, self.told) = (None, 0);
    }

    /// Builds the scene with the parameters that were set and puts it at its start.
    pub(crate) fn initialise(&mut self, start: f64) -> Result<(), Failure> {
        if !start.is_finite() {
            return Err(format!("the start time is {start}"));
        }
        let mut set = self.exported.clone();
        for (reference, value) in &self.parameters {
            let name = &self.interface.variable(*reference).ok_or("an unknown parameter was set")?.name;
            // what was exported with a value of its own has another one now
            set.retain(|s| s.split_once('=').is_none_or(|(key, _)| key.trim() != name));
            set.push(format!("{name}={value}"));
        }
        let file = self.text.with(&set).map_err(|e| e.to_string())?;
        let mut session = Session::start(file, Watch::default()).map_err(|e| e.to_string())?;
        for (reference, value) in &self.inputs {
            let name = &self.interface.variable(*reference).ok_or("an unknown input was set")?.name;
            session.set_input(name, *value).map_err(|e| e.to_string())?;
        }
        (self.session, self.start, self.told) = (Some(session), start, 0);
        Ok(())
    }

    fn session(&mut self) -> Result<&mut Session, Failure> {
        self.session.as_mut().ok_or_else(|| "the FMU was not initialised".into())
    }

    /// Takes a step of the co-simulation; whether the motion has come to its end by an event.
    pub(crate) fn step(&mut self, from: f64, size: f64) -> Result<bool, Failure> {
        let start = self.start;
        let session = self.session()?;
        let here = session.t() + start;
        if !(size >= 0.0 && (from - here).abs() <= 1e-9 * (1.0 + here.abs())) {
            return Err(format!(
                "a step of {size} s from t = {from} s was asked for, but the FMU is at t = {here} s"
            ));
        }
        session.advance(from + size - start).map_err(|e| e.to_string())?;
        Ok(session.stopped_by().is_some())
    }

    /// Present time of the co-simulation [s].
    pub(crate) fn t(&self) -> f64 {
        self.start + self.session.as_ref().map_or(0.0, Session::t)
    }

    /// Warnings that were not told yet.
    pub(crate) fn news(&mut self) -> Vec<String> {
        let all = self.session.as_ref().map_or(&[][..], Session::warnings);
        let new = all.get(self.told..).unwrap_or_default().to_vec();
        self.told = all.len();
        new
    }

    pub(crate) fn number(&mut self, reference: u32) -> Result<f64, Failure> {
        let t = self.t();
        let variable = self.interface.variable(reference).ok_or_else(|| unknown(reference))?;
        match &variable.kind {
            Kind::Time => Ok(t),
            Kind::Input { start, .. } => Ok(self.inputs.get(&reference).copied().unwrap_or(*start)),
            Kind::Output => {
                let name = variable.name.clone();
                self.session()?.value(&name).map_err(|e| e.to_string())
            }
            Kind::Parameter { .. } => Err(format!("`{}` is a text", variable.name)),
        }
    }

    pub(crate) fn set_number(&mut self, reference: u32, value: f64) -> Result<(), Failure> {
        let variable = self.interface.variable(reference).ok_or_else(|| unknown(reference))?;
        let Kind::Input { .. } = variable.kind else {
            return Err(format!("`{}` can't be set", variable.name));
        };
        if let Some(session) = &mut self.session {
            session.set_input(&variable.name, value).map_err(|e| e.to_string())?;
        }
        self.inputs.insert(reference, value);
        Ok(())
    }

    pub(crate) fn text(&self, reference: u32) -> Result<String, Failure> {
        let variable = self.interface.variable(reference).ok_or_else(|| unknown(reference))?;
        match &variable.kind {
            Kind::Parameter { start } => Ok(self.parameters.get(&reference).unwrap_or(start).clone()),
            _ => Err(format!("`{}` is a number", variable.name)),
        }
    }

    pub(crate) fn set_text(&mut self, reference: u32, value: &str) -> Result<(), Failure> {
        let variable = self.interface.variable(reference).ok_or_else(|| unknown(reference))?;
        let Kind::Parameter { .. } = variable.kind else {
            return Err(format!("`{}` is no parameter", variable.name));
        };
        if self.session.is_some() {
            return Err(format!("the parameter `{}` has to be set before the initialisation", variable.name));
        }
        self.parameters.insert(reference, value.to_string());
        Ok(())
    }

    pub(crate) fn save(&mut self) -> Result<Saved, Failure> {
        let snapshot = self.session.as_mut().map(Session::snapshot).transpose().map_err(|e| e.to_string())?;
        let (parameters, inputs) = (self.parameters.clone(), self.inputs.clone());
        Ok(Saved { snapshot, parameters, inputs, start: self.start })
    }

    pub(crate) fn restore(&mut self, saved: Saved) -> Result<(), Failure> {
        let Saved { snapshot, parameters, inputs, start } = saved;
        let same = self.session.is_some() && parameters == self.parameters;
        (self.parameters, self.inputs, self.start) = (parameters, inputs, start);
        match snapshot {
            Some(snapshot) => {
                if !same {
                    self.initialise(start)?;
                }
                self.session()?.restore(snapshot).map_err(|e| e.to_string())
            }
            None => {
                self.session = None;
                Ok(())
            }
        }
    }
}

impl Saved {
    pub(crate) fn bytes(&self) -> Result<Vec<u8>, Failure> {
        let packed: (_, &_, &_, _) = (&self.snapshot, &self.parameters, &self.inputs, self.start);
        postcard::to_stdvec(&packed).map_err(|e| e.to_string())
    }

    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self, Failure> {
        let packed: Packed =
            postcard::from_bytes(bytes).map_err(|e| format!("this is no state of the FMU: {e}"))?;
        let (snapshot, parameters, inputs, start) = packed;
        Ok(Saved { snapshot, parameters, inputs, start })
    }
}

fn unknown(reference: u32) -> Failure {
    format!("there is no variable {reference}")
}
