//! Energy that appears from nowhere is told at once and ends the run, and steps that had to be cut are counted.

use ropewalk::SceneFile;
use ropewalk::scene::Format;
use ropewalk_core::integrator::{Options, Scheme, StepError, StepReport, Stepping};
use ropewalk_core::{Model, Observer, Sample, Simulation, State};
use std::ops::ControlFlow;

/// Watches for the first warning, and how much energy there was by then.
#[derive(Default)]
struct Watch {
    said: Option<String>,
}

impl Observer for Watch {
    fn warn(&mut self, text: &str) {
        // of a rope whose end whips, or that nothing damps, others speak
        if !["times as fast as the line", "nothing damps the waves"].iter().any(|other| text.contains(other))
        {
            self.said = Some(text.into());
        }
    }
    fn step(&mut self, _: &Model, _: &State, _: &StepReport) -> ControlFlow<()> {
        if self.said.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A rope that is let go horizontally: mass per length [kg/m], EA [N], EI [N m²], length [m].
fn swing(mass: f64, ea: f64, ei: f64, length: f64) -> String {
    format!(
        "[[elements]]\ntype='cable'\nname='c'\npoints=[[0,0,0],[{length},0,0]]\nelements=20\n\
         section={{ mass={mass}, ea={ea}, ei={ei} }}\n\
         [[constraints]]\ntype='spherical'\nname='h'\nmarker='c.start'\n[[forces]]\ntype='gravity'\n"
    )
}

/// What a run says of its energy, if anything: a warning, or the error that ends it.
fn watched(text: &str, options: &Options, duration: f64) -> (Option<String>, Simulation) {
    let file = SceneFile::parse(text, "swing", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let model = file.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, options, duration).unwrap_or_else(|e| panic!("{e}"));
    let mut watch = Watch::default();
    let ended = s.advance(duration, f64::INFINITY, &mut watch).err();
    (watch.said.or(ended.map(|e| e.to_string())), s)
}

fn fixed(h: f64) -> Options {
    Options { stepping: Stepping::Fixed { h }, ..Options::default() }
}

#[test]
fn fixed_steps_that_make_energy_are_told_at_once() {
    for (rope, h, text, energy) in [
        ("nylon, 12 mm", 5e-3, swing(0.1, 5e4, 0.01, 10.0), 0.1 * 9.81 * 10.0 * 5.0),
        ("steel wire, 6 mm", 10e-3, swing(0.14, 1.5e6, 0.1, 10.0), 0.14 * 9.81 * 10.0 * 5.0),
    ] {
        let (said, s) = watched(&text, &fixed(h), 10.0);
        println!("{rope}: {said:?}, {} J of {energy} J at {} s", s.audit.imbalance(), s.state.t);
        let said = said.unwrap_or_else(|| panic!("{rope}: silent"));
        assert!(said.contains("appeared from nowhere") && said.contains("smaller `h`"), "{said}");
    }
}

/// Counts samples, and looks at nothing else.
#[derive(Default)]
struct Samples(usize);

impl Observer for Samples {
    fn sample(&mut self, _: &Sample<'_>) -> ControlFlow<()> {
        self.0 += 1;
        ControlFlow::Continue(())
    }
}

/// The rope has 49 J to fall by. Left alone, steps of 5 ms make two million of them.
#[test]
fn a_run_ends_where_most_of_its_energy_is_from_nowhere() {
    let file = SceneFile::parse(&swing(0.1, 5e4, 0.01, 10.0), "swing", Format::Toml, &[])
        .unwrap_or_else(|e| panic!("{e}"));
    let go = |options: &Options| {
        let model = file.build().unwrap_or_else(|e| panic!("{e}"));
        let mut s = Simulation::new(model, options, 3.0).unwrap_or_else(|e| panic!("{e}"));
        let mut samples = Samples::default();
        let end = s.advance(3.0, 0.01, &mut samples);
        (end, s, samples.0)
    };
    let (end, s, samples) = go(&fixed(5e-3));
    let Err(StepError::Energy { t, gained, all, .. }) = end else { panic!("{end:?}") };
    println!("{}", StepError::Energy { t, gained, all, remedy: "…" });
    assert!(
        (1.0..2.0).contains(&t) && gained > 10.0 && gained < 500.0 && gained >= 0.5 * all,
        "{t} {gained}"
    );
    // what came before is there
    assert!(
        s.state.t == t && s.state.is_finite() && samples as f64 >= t / 0.01,
        "{samples} samples until {t}"
    );
    let remedies = [
        Options { scheme: Scheme::RadauIia5, ..fixed(5e-3) },
        Options { scheme: Scheme::GeneralizedAlpha { rho_inf: 0.5 }, ..fixed(5e-3) },
        Options::default(),
    ];
    for options in remedies {
        let (end, s, _) = go(&options);
        assert!(end.is_ok(), "{:?}: {end:?}", options.scheme);
        assert!(s.audit.imbalance() < 5.0, "{:?}: {} J", options.scheme, s.audit.imbalance());
    }
}

#[test]
fn right_runs_are_not_suspected() {
    let radau = Options { scheme: Scheme::RadauIia5, ..Options::default() };
    for (text, duration) in [
        (swing(0.1, 5e4, 0.01, 10.0), 2.0),
        (swing(0.14, 1.5e6, 0.1, 10.0), 1.0),
        // at rest for all time
        (
            "[[elements]]\ntype='rigid_body'\nname='b'\nposition=[0,0,0]\nmass=1\ninertia=[1,1,1]\n".into(),
            10.0,
        ),
        (
            "[[elements]]\ntype='cable'\nname='c'\npoints=[[3,0,0],[3,0,1]]\nelements=4\n\
          section={ mass=0.5, ea=1e6, ei=0.1 }\n"
                .into(),
            10.0,
        ),
    ] {
        for options in [Options::default(), radau.clone(), fixed(1e-3)] {
            let (said, _) = watched(&text, &options, duration);
            assert_eq!(said, None, "{text}");
        }
    }
}

/// A crank that turns by more than its joint can tell apart in one step of 20 ms.
#[test]
fn fixed_steps_that_are_cut_are_counted() {
    let crank = |rate: f64| {
        let text = format!(
            "[[elements]]\ntype='rigid_body'\nname='b'\nposition=[0,0,0]\nmass=1\ninertia=[1,1,1]\n\
             angular_velocity=[0,0,{rate}]\n[[motions]]\ntype='spin'\nname='turn'\nrate={rate}\nramp=0\n\
             [[constraints]]\ntype='revolute'\nname='hinge'\nmarker='b'\naxis=[0,0,1]\n\
             [[constraints]]\ntype='rotation'\nname='drive'\nmarker='b'\naxis=[0,0,1]\nmotion='turn'\n"
        );
        let (_, s) = watched(&text, &fixed(20e-3), 0.2);
        (s.work.counts.cut, s.work.counts.steps)
    };
    assert_eq!(crank(10.0), (0, 10));
    let (cut, steps) = crank(100.0);
    assert!(cut > 5 && steps > 10, "{cut} of {steps}");
}

#[test]
fn a_balance_that_only_its_own_integration_may_explain_is_said_to_be_blind() {
    let energy = |kinetic| ropewalk_core::Energy { kinetic, potential: 0.0 };
    let power = |supplied| ropewalk_core::Power { supplied, ..ropewalk_core::Power::zero() };
    let mut audit = ropewalk_core::Audit::start(energy(0.0));
    audit.add(1.0, energy(1.0), power(1.0), power(1.0));
    assert!(!audit.is_blind(0.0), "{audit:?}");
    // twice as much again from nowhere, between powers that swing by a hundred times that
    let mut swinging = audit;
    swinging.add(1.0, energy(3.0), power(-100.0), power(100.0));
    assert!(swinging.is_blind(0.0), "{swinging:?}");
    assert_eq!(swinging.created(0.0), ropewalk_core::Created::None);
    // the same between powers that don't is no blindness: energy was made
    audit.add(1.0, energy(3.0), power(0.0), power(0.0));
    assert!(!audit.is_blind(0.0), "{audit:?}");
}

/// Between long steps a falling weight has the energy of the moment, not that of the last step.
#[test]
fn energy_is_told_of_the_instant_of_a_sample() {
    let text = r#"
        gravity = [0, 0, -10]
        [run]
        duration = 1
        output = 0.01
        [[elements]]
        type = "point_mass"
        name = "weight"
        marker = [0, 0, 0]
        mass = 2
        [[forces]]
        type = "gravity"
        [[records]]
        type = "energy"
        "#;
    let file = SceneFile::parse(text, "falls", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let run = ropewalk::simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
    assert!(run.counts.steps < 50, "the steps are to be longer than samples: {:?}", run.counts);
    let kinetic = run.column("energy.kinetic").expect("recorded");
    for (t, kinetic) in run.times().iter().zip(kinetic) {
        let exact = 0.5 * 2.0 * (10.0 * t).powi(2);
        assert!((kinetic - exact).abs() < 1e-6 * 100.0, "{t} s: {kinetic} J instead of {exact}");
    }
}
