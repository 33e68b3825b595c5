//! Functions that a program writes for scenes: forces and motions to try out, in Rust, Python or whatever calls this.
//!
//! A program registers a function under a name; scenes ask for it by `type = "function"` and `function = "name"`, or by
//! `type = "name"` alone. Functions live in their process: neither the command line nor a worker elsewhere knows them.

use crate::document::{Document, did_you_mean};
use crate::spec::{SpecKind, registered};
use ropewalk_core::broken::{self, Broken};
use ropewalk_core::rotation::M3;
use ropewalk_core::{BuildError, Station, V3};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt;
use std::sync::{Arc, PoisonError, RwLock};

/// What a scene gives a function besides the state: numbers, texts, lists.
pub type Parameters = BTreeMap<String, serde_json::Value>;

/// What of the state a function looks at. Its derivatives by all else are zero, and aren't asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reads {
    /// The time.
    pub time: bool,
    /// Positions.
    pub position: bool,
    /// Velocities.
    pub velocity: bool,
    /// The slope of a cable.
    pub slope: bool,
    /// The attitude of a body.
    pub attitude: bool,
    /// The angular velocity of a body.
    pub angular_velocity: bool,
}

/// How a marker that a force acts on lies and moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Position [m].
    pub position: V3<f64>,
    /// Velocity [m/s].
    pub velocity: V3<f64>,
    /// Rotation matrix of its body, whose columns are the body's axes in space; that of nothing else is the unit matrix.
    pub attitude: M3,
    /// Angular velocity of its body, in space [rad/s].
    pub angular_velocity: V3<f64>,
}

/// A displacement [m], and its first and second derivative where they are known.
pub type Displaced = (V3<f64>, [Option<V3<f64>>; 2]);

/// Why a function gave nothing.
#[derive(Clone, Debug)]
pub struct Trouble {
    /// As the end of a sentence that begins with the function's name, such as "raised ZeroDivisionError".
    pub why: String,
    /// The error itself.
    pub source: Option<Arc<dyn Error + Send + Sync>>,
}

impl Trouble {
    /// Without an error of its own.
    pub fn new(why: impl Into<String>) -> Self {
        Trouble { why: why.into(), source: None }
    }
}

/// A function with its parameters. It is one of the three things below; the others are refused.
pub trait Function: fmt::Debug + Send + Sync {
    /// What it looks at.
    fn reads(&self) -> Reads;
    /// Force [N] and moment [N m] on a marker, both in space.
    ///
    /// # Errors
    /// It gives none.
    fn force(&self, _t: f64, _at: &Seen) -> Result<[V3<f64>; 2], Trouble> {
        Err(Trouble::new("gives no force at a marker"))
    }
    /// Force per unstretched length at all stations of a cable [N/m], in space.
    ///
    /// # Errors
    /// It gives none, or not one for each station.
    fn load(&self, _t: f64, _at: &[Station<f64>]) -> Result<Vec<V3<f64>>, Trouble> {
        Err(Trouble::new("gives no force along cables"))
    }
    /// Displacement [m], and its first and second derivative if it knows them.
    ///
    /// # Errors
    /// It gives none.
    fn motion(&self, _t: f64) -> Result<Displaced, Trouble> {
        Err(Trouble::new("gives no motion"))
    }
}

/// A function before it has its parameters.
pub trait Written: Send + Sync {
    /// Gives it its parameters.
    ///
    /// # Errors
    /// There is one too many or too few, or one that it can't use.
    fn bind(&self, parameters: &Parameters) -> Result<Arc<dyn Function>, BuildError>;
}

static ALL: RwLock<BTreeMap<String, Arc<dyn Written>>> = RwLock::new(BTreeMap::new());

/// Makes a function known to the scenes of this process, in place of another one of this name.
pub fn register_function(name: &str, function: Arc<dyn Written>) {
    let former = ALL.write().unwrap_or_else(PoisonError::into_inner).insert(name.to_string(), function);
    // dropped behind the lock: it may be the last of a program's objects, whose end calls back
    drop(former);
}

/// Makes a function unknown again. Scenes that were built with it keep it, but those whose mesh changes build anew.
pub fn forget_function(name: &str) {
    let former = ALL.write().unwrap_or_else(PoisonError::into_inner).remove(name);
    drop(former);
}

/// The names of all functions of this process.
pub fn functions() -> Vec<String> {
    ALL.read().unwrap_or_else(PoisonError::into_inner).keys().cloned().collect()
}

/// A function of a scene, as forces and motions call it. What goes wrong ends the computation of this thread.
#[derive(Clone, Debug)]
pub struct Called {
    name: String,
    function: Arc<dyn Function>,
    /// What it looks at.
    pub reads: Reads,
}

impl Called {
    /// The function of this name with these parameters.
    ///
    /// # Errors
    /// There is none, or its parameters are wrong.
    pub fn find(name: &str, parameters: &Parameters) -> Result<Self, BuildError> {
        let found = ALL.read().unwrap_or_else(PoisonError::into_inner).get(name).cloned();
        let function = found.ok_or_else(|| missing(name))?.bind(parameters)?;
        Ok(Called { name: name.to_string(), reads: function.reads(), function })
    }

    /// What a result is, or NaN in place of it.
    fn told<T>(&self, t: f64, result: Result<T, Trouble>, finite: impl Fn(&T) -> bool, none: T) -> T {
        let broken = |why: String, source| Broken { name: self.name.clone(), t, why, source };
        match result {
            Err(Trouble { why, source }) => {
                broken::fail(broken(why, source));
                none
            }
            Ok(x) => {
                if !finite(&x) {
                    broken::doubt(broken("gave what is no finite number".into(), None));
                }
                x
            }
        }
    }

    /// As [`Function::force`]; NaN if that gives none.
    pub fn force(&self, t: f64, at: &Seen) -> [V3<f64>; 2] {
        let none = [[f64::NAN; 3]; 2];
        if broken::has_failed() {
            return none;
        }
        self.told(t, self.function.force(t, at), |f| f.iter().flatten().all(|f| f.is_finite()), none)
    }

    /// As [`Function::load`]; NaN if that gives none.
    pub fn load(&self, t: f64, at: &[Station<f64>]) -> Vec<V3<f64>> {
        let none = vec![[f64::NAN; 3]; at.len()];
        if broken::has_failed() {
            return none;
        }
        let result = self.function.load(t, at).and_then(|f| match f.len() == at.len() {
            true => Ok(f),
            false => Err(Trouble::new(format!("gave {} forces for {} stations", f.len(), at.len()))),
        });
        self.told(t, result, |f| f.iter().flatten().all(|f| f.is_finite()), none)
    }

    /// As [`Function::motion`]; NaN if that gives none.
    pub fn motion(&self, t: f64) -> Displaced {
        let none = ([f64::NAN; 3], [None; 2]);
        if broken::has_failed() {
            return none;
        }
        let finite =
            |(x, rates): &Displaced| x.iter().chain(rates.iter().flatten().flatten()).all(|x| x.is_finite());
        self.told(t, self.function.motion(t), finite, none)
    }
}

fn missing(name: &str) -> BuildError {
    let all = functions();
    let there = match (all.is_empty(), did_you_mean(name, &all)) {
        (true, _) => "there are none here".into(),
        (_, Some(guess)) => guess,
        _ => {
            format!("those here are {}", all.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", "))
        }
    };
    let message = format!(
        "there is no function `{name}` in this process; {there}. A function is known to the program that registers it, such \
         as a script in Python by `@ropewalk.function`, and not to the command line or to workers that don't register it too"
    );
    BuildError::at("function", message)
}

/// What a force and a motion by a function have of their own; all else is a parameter.
const OWN: [(SpecKind, &[&str]); 2] = [
    (SpecKind::Force, &["function", "name", "marker", "on", "parameters"]),
    (SpecKind::Motion, &["function", "name", "parameters"]),
];

/// Lets a scene say `type = "name"` of a function: from here on it says `type = "function"`.
pub(crate) fn name_types(document: &mut Document) {
    let all = functions();
    if all.is_empty() {
        return;
    }
    for (kind, own) in OWN {
        let is_function = |name: &str| {
            let taken = registered().iter().any(|s| s.kind == kind && s.name == name);
            !taken && all.iter().any(|f| f == name)
        };
        document.call_functions(kind.list(), own, &is_function);
    }
}
