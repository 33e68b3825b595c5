//! The problems that scalings of the equations are compared on.

use crate::error::Error;
use ropewalk_constraints::{DirectionSpec, RevoluteSpec, SphericalSpec};
use ropewalk_core::V3;
use ropewalk_core::integrator::{NewtonPolicy, Options, Scheme, Stepping};
use ropewalk_elements::cable::{Integration, LongitudinalModel, TransverseModel};
use ropewalk_elements::{CableSpec, RigidBodySpec, Section};
use ropewalk_forces::{GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::records::{AccelerationSpec, PositionSpec, ReactionSpec};
use ropewalk_scene::{Fault, Format, Scene, SceneFile};
use serde::Serialize;

const G: V3<f64> = [0.0, 0.0, -9.81];
/// Of the rod, as Escalona, Hussien & Shabana (1998, J. Sound Vib. 214) have it, but of steel.
const LENGTH: f64 = 1.2;
const AREA: f64 = 0.0018;
const SECOND: f64 = 1.215e-8;
const DENSITY: f64 = 5540.0;
const YOUNG: f64 = 2.07e11;
/// A sudden force at the tip of a cantilever of 1 m and EI = 1 N m², small enough for the linear deflection.
const FORCE: f64 = 0.03;

/// A problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Problem {
    /// A cantilever with a sudden force at its tip, which swings about its deflection.
    Cantilever,
    /// A steel rod on a hinge, released from the horizontal.
    Revolute,
    /// The same on a ball joint.
    Spherical,
    /// A hose behind a ship that runs straight ahead at 25 kn.
    Straight,
    /// A hose behind a ship that turns at 25 kn.
    Turn,
}

impl Problem {
    /// All of them.
    pub const ALL: [Problem; 5] =
        [Problem::Cantilever, Problem::Revolute, Problem::Spherical, Problem::Straight, Problem::Turn];

    /// What tables and pictures call it.
    pub fn title(self) -> &'static str {
        match self {
            Problem::Cantilever => "cantilever",
            Problem::Revolute => "pendulum with a revolute joint",
            Problem::Spherical => "pendulum with a spherical joint",
            Problem::Straight => "hose, straight run at 25 kn",
            Problem::Turn => "hose, turn at 25 kn",
        }
    }

    /// A short word for names of files.
    pub fn name(self) -> &'static str {
        match self {
            Problem::Cantilever => "cantilever",
            Problem::Revolute => "revolute",
            Problem::Spherical => "spherical",
            Problem::Straight => "straight",
            Problem::Turn => "turn",
        }
    }

    /// Name of its cable.
    pub fn cable(self) -> &'static str {
        match self {
            Problem::Straight | Problem::Turn => "hose",
            _ => "rod",
        }
    }

    /// Its step [s].
    pub fn step(self) -> f64 {
        match self {
            Problem::Straight | Problem::Turn => 5e-3,
            _ => 1e-3,
        }
    }

    /// Its length [s]: of the cantilever four periods, so that its mean is the deflection.
    pub fn duration(self) -> f64 {
        match self {
            Problem::Cantilever => 4.0 * std::f64::consts::TAU / 3.516_015_268,
            Problem::Revolute | Problem::Spherical => 1.0,
            Problem::Straight | Problem::Turn => 20.0,
        }
    }

    /// The scene with this number of elements, fixed steps and a new matrix at every iteration.
    ///
    /// # Errors
    /// A bundled scene that isn't there.
    pub fn scene(self, elements: usize) -> Result<Scene, Error> {
        let mut scene = match self {
            Problem::Cantilever => cantilever(elements),
            Problem::Revolute | Problem::Spherical => self.pendulum(elements),
            Problem::Straight => towed("hose-straight", elements)?,
            Problem::Turn => towed("hose-turn", elements)?,
        };
        let end = format!("{}.end", self.cable());
        scene.records.clear();
        scene.record(PositionSpec::new(&end)).record(AccelerationSpec { of: end, name: None, title: None });
        self.watch_joint(&mut scene);
        scene.run.duration = self.duration();
        scene.run.output = self.duration() / 400.0;
        scene.run.audit = false;
        scene.solver = Options {
            scheme: Scheme::GeneralizedAlpha { rho_inf: 0.8 },
            stepping: Stepping::Fixed { h: self.step() },
            newton: NewtonPolicy::Full,
            ..Options::default()
        };
        Ok(scene)
    }

    /// The pendulum as one rigid body.
    pub fn rigid(self) -> Option<Scene> {
        let mass = DENSITY * AREA * LENGTH;
        // its own turning about the axis plays no part in a plane
        let (about, across) = (1e-3 * mass * LENGTH.powi(2), mass * LENGTH.powi(2) / 12.0);
        let rod = RigidBodySpec {
            centre: [0.5 * LENGTH, 0.0, 0.0],
            ..RigidBodySpec::new("rod", [0.0; 3], mass, [about, across, across])
        };
        let rod = rod.with_point("end", [LENGTH, 0.0, 0.0]);
        let mut scene = Scene::new();
        scene.element(rod).set_gravity(G).force(GravitySpec::default());
        match self {
            Problem::Revolute => scene.constraint(hinge("rod")),
            Problem::Spherical => scene.constraint(SphericalSpec::pin("joint", "rod")),
            _ => return None,
        };
        let end = || "rod.end".to_string();
        scene.record(PositionSpec::new(&end())).record(AccelerationSpec {
            of: end(),
            name: None,
            title: None,
        });
        self.watch_joint(&mut scene);
        scene.run.duration = self.duration();
        scene.run.output = self.duration() / 400.0;
        scene.solver.stepping = Stepping::Fixed { h: self.step() };
        Some(scene)
    }

    fn watch_joint(self, scene: &mut Scene) {
        if self == Problem::Spherical {
            let of = "joint".to_string();
            scene.record(ReactionSpec { of, what: Default::default(), name: None, title: None });
        }
    }

    fn pendulum(self, elements: usize) -> Scene {
        let section = Section::new(DENSITY * AREA, YOUNG * AREA, YOUNG * SECOND);
        let rod = CableSpec::straight("rod", [0.0; 3], [LENGTH, 0.0, 0.0], elements, section);
        let (l, t) = (LongitudinalModel::L4, TransverseModel::T3);
        let mut scene = Scene::new();
        scene.element(rod.models(l, t, Integration::Full)).set_gravity(G).force(GravitySpec::default());
        if self == Problem::Revolute {
            scene.constraint(hinge("rod.start"));
        } else {
            scene.constraint(SphericalSpec::pin("joint", "rod.start"));
        }
        scene
    }
}

/// Deflection of the cantilever by linear theory, `F L³ / 3 EI` [m].
pub(super) const DEFLECTION: f64 = FORCE / 3.0;

fn cantilever(elements: usize) -> Scene {
    let section = Section::new(1.0, 1.6e5, 1.0);
    let mut scene = Scene::new();
    scene
        .element(CableSpec::straight("rod", [0.0; 3], [1.0, 0.0, 0.0], elements, section))
        .constraint(SphericalSpec::pin("root", "rod.start"))
        .constraint(DirectionSpec::new("clamp", "rod.start"))
        .force(PointForceSpec::new("rod.end", [0.0, 0.0, FORCE], TimeFunction::default()));
    scene
}

fn hinge(marker: &str) -> RevoluteSpec {
    RevoluteSpec { name: "joint".into(), marker: marker.into(), to: None, axis: [0.0, 1.0, 0.0] }
}

/// A bundled tow that starts at once.
fn towed(name: &str, elements: usize) -> Result<Scene, Error> {
    let bundled = ropewalk_models::bundled();
    let text = bundled.iter().find(|b| b.name == name).map(|b| b.text);
    let text = text.ok_or_else(|| Fault::new(format!("the scene {name} isn't bundled")))?;
    let overrides = [format!("elements={elements}"), "speed=25 kn".into(), "start=0.5 s".into()];
    Ok(SceneFile::parse(text, name, Format::Toml, &overrides)?.into_scene())
}
