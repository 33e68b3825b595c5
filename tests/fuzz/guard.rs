//! What becomes of a scene, and that it comes to an end.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, Simulation, State};
use ropewalk_core::integrator::StepReport;
use ropewalk_core::{Model, Observer};
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Longer than any case may take, with all else that the machine does.
const PATIENCE: Duration = Duration::from_secs(120);

pub enum Verdict {
    /// A typed error before anything moved.
    Refused,
    /// A model could be made of it.
    Built,
    /// The solver gave up with a typed error, and left a finite state.
    GaveUp,
    /// It took its steps.
    Stepped,
    /// What must never be.
    Bad(String),
}

impl Verdict {
    pub fn name(&self) -> &'static str {
        match self {
            Verdict::Refused => "refused",
            Verdict::Built => "built",
            Verdict::GaveUp => "gave up",
            Verdict::Stepped => "stepped",
            Verdict::Bad(_) => "bad",
        }
    }
}

/// Reads a text and builds its model.
pub fn read(text: &str) -> Verdict {
    let built =
        SceneFile::parse(text, "fuzz.toml", Format::Toml, &[]).ok().and_then(|f| f.scene().build().ok());
    match built {
        Some(model) if !model.state().is_finite() => Verdict::Bad("the start isn't finite".into()),
        Some(_) => Verdict::Built,
        None => Verdict::Refused,
    }
}

/// Stops after twenty steps, or where something isn't finite.
#[derive(Default)]
struct Twenty {
    steps: usize,
    bad: Option<String>,
}

impl Observer for Twenty {
    fn step(&mut self, model: &Model, state: &State, _: &StepReport) -> ControlFlow<()> {
        self.steps += 1;
        let energy = model.energy(&state.at());
        if !state.is_finite() || !(energy.kinetic + energy.potential).is_finite() {
            self.bad = Some(format!("not finite after {} steps at t = {} s", self.steps, state.t));
        }
        if self.bad.is_some() || self.steps >= 20 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Reads a text, builds its model and takes twenty steps.
pub fn run(text: &str) -> Verdict {
    let Ok(file) = SceneFile::parse(text, "fuzz.toml", Format::Toml, &[]) else { return Verdict::Refused };
    let scene = file.scene();
    let Ok(model) = scene.build() else { return Verdict::Refused };
    let Ok(mut s) = Simulation::new(model, &scene.solver, scene.run.duration) else {
        return Verdict::Refused;
    };
    let mut twenty = Twenty::default();
    let end = s.advance(scene.run.duration, f64::INFINITY, &mut twenty);
    match (twenty.bad, end) {
        (Some(why), _) => Verdict::Bad(why),
        _ if !s.state.is_finite() => Verdict::Bad("the last state isn't finite".into()),
        (None, Err(_)) => Verdict::GaveUp,
        (None, Ok(_)) => Verdict::Stepped,
    }
}

/// The case under way: since when, which, its text.
type Case = Option<(Instant, String)>;

/// Catches panics, and ends the program with the case that hangs.
pub struct Guard {
    now: Arc<Mutex<Case>>,
}

impl Guard {
    pub fn new() -> Self {
        let now: Arc<Mutex<Case>> = Arc::default();
        let watched = Arc::downgrade(&now);
        std::thread::spawn(move || {
            while let Some(now) = watched.upgrade() {
                if let Some((since, case)) = now.lock().expect("case").as_ref()
                    && since.elapsed() > PATIENCE
                {
                    eprintln!("hangs: {case}");
                    std::process::abort();
                }
                drop(now);
                std::thread::sleep(Duration::from_secs(1));
            }
        });
        Guard { now }
    }

    pub fn watch(&self, what: &str, seed: u64, text: &str, judge: impl FnOnce() -> Verdict) -> Verdict {
        *self.now.lock().expect("case") = Some((Instant::now(), format!("{what} {seed}\n{text}")));
        let verdict = catch_unwind(AssertUnwindSafe(judge));
        *self.now.lock().expect("case") = None;
        verdict.unwrap_or_else(|panic| {
            let said = panic.downcast_ref::<String>().cloned();
            let said = said.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
            Verdict::Bad(format!("panic: {}", said.unwrap_or_default()))
        })
    }
}

/// Leaves out tables and then lines, as long as the text still shows what it shows.
pub fn smallest(text: &str, still: impl Fn(&str) -> bool) -> String {
    let mut now = text.to_string();
    for separator in ["\n[", "\n"] {
        let mut k = 0;
        loop {
            let parts: Vec<&str> = now.split(separator).collect();
            if k >= parts.len() {
                break;
            }
            let fewer: Vec<&str> =
                parts.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, p)| *p).collect();
            let fewer = fewer.join(separator);
            if still(&fewer) { now = fewer } else { k += 1 }
        }
    }
    now
}
