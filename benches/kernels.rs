//! The kernels alone, one term to a model: force, and force with the exact tangent, gathered, evaluated and added.
//! `cargo bench --bench kernels`; items are elements.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use ropewalk::Error;
use ropewalk::bench::{FullIteration, Pendulum, models};
use ropewalk::core::{FieldTerm, Laws, Model, NodeId, Pool, Start, Term, Width};
use ropewalk::elements::cable::quadrature::Rule;
use ropewalk::elements::cable::{AxialDamping, BendingDamping, L4, LockingFree, T3};
use ropewalk::forces::{AddedMass, Drag, NormalLaw, TangentialLaw};
use std::fmt;

const ELEMENTS: usize = 256;

fn main() {
    divan::main();
}

/// A kernel at a width that the processor has.
struct Case {
    name: String,
    width: Width,
    make: Box<dyn Fn(Width) -> Result<FullIteration, Error>>,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {:?}", self.name, self.width)
    }
}

fn widths() -> Vec<Width> {
    let all = [Width::One, Width::Four, Width::Eight];
    all.into_iter().filter(|w| w.lanes() <= Width::best().lanes()).collect()
}

fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    for width in widths() {
        for models in models() {
            let (l, t, rule) = (models.longitudinal, models.transverse, models.integration);
            let make = move |width| {
                let whole = Pendulum::new(ELEMENTS).with_models(models).bent();
                let mut scene = ropewalk::Scene::new();
                scene.elements = whole.elements;
                FullIteration::of(scene.build()?.with_width(width))
            };
            all.push(Case { name: format!("{l:?}+{t:?} {rule:?}"), width, make: Box::new(make) });
        }
        let mut term = |name: &str, of: fn(&Model) -> Box<dyn Term>| {
            let make = move |width| {
                let whole = Pendulum::new(ELEMENTS).in_water().bent().build()?;
                let start = Start { q: whole.state().q, v: whole.state().v, modes: Vec::new() };
                let terms = vec![of(&whole)];
                let model = Model::new(whole.nodes().to_vec(), terms, vec![], vec![], start, 1.0);
                FullIteration::of(model.with_width(width))
            };
            all.push(Case { name: name.into(), width, make: Box::new(make) });
        };
        term("drag", |m| {
            field(m, |laws| laws.push(drag(NormalLaw::Constant(1.2), TangentialLaw::Quadratic(0.01))))
        });
        term("drag, Choo and Casarella", |m| {
            field(m, |laws| laws.push(drag(NormalLaw::ChooCasarella, TangentialLaw::ChooCasarella)))
        });
        term("added mass", |m| field(m, |laws| laws.push(AddedMass::new(1025.0, 1.0).expect("legal"))));
        term("axial damping", |m| {
            let mut pool = Pool::new();
            for on in along(m) {
                let element =
                    AxialDamping::<L4, <LockingFree as Rule>::Axial>::new(1.0 / ELEMENTS as f64, 5.0);
                assert!(pool.push(m.nodes(), element, &on));
            }
            Box::new(pool)
        });
        term("bending damping", |m| {
            let mut pool = Pool::new();
            for on in along(m) {
                let element =
                    BendingDamping::<T3, <LockingFree as Rule>::Bending>::new(1.0 / ELEMENTS as f64, 1e-4);
                assert!(pool.push(m.nodes(), element, &on));
            }
            Box::new(pool)
        });
    }
    all
}

fn along(m: &Model) -> impl Iterator<Item = [NodeId; 2]> {
    (1..m.nodes().len() as u32).map(|k| [NodeId(k - 1), NodeId(k)])
}

fn drag(normal: NormalLaw, tangential: TangentialLaw) -> Drag {
    Drag::new(1025.0, 1.08e-3, normal, tangential).expect("legal")
}

fn field(m: &Model, add: impl Fn(&mut Laws)) -> Box<dyn Term> {
    let mut laws = Laws::default();
    add(&mut laws);
    let stations = m.part("cable").and_then(|p| p.stations()).expect("stations");
    Box::new(FieldTerm { part: "cable".into(), stations, laws })
}

#[divan::bench(args = cases())]
fn force(bencher: Bencher<'_, '_>, case: &Case) {
    let mut one = (case.make)(case.width).expect("model");
    bencher.counter(ItemsCount::new(ELEMENTS)).bench_local(|| black_box(&mut one).residual());
}

#[divan::bench(args = cases())]
fn force_and_tangent(bencher: Bencher<'_, '_>, case: &Case) {
    let mut one = (case.make)(case.width).expect("model");
    bencher.counter(ItemsCount::new(ELEMENTS)).bench_local(|| black_box(&mut one).assemble());
}
