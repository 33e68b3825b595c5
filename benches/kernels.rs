//! The kernels alone, one term to a model: force, and force with the exact tangent, gathered, evaluated and added.
//! `cargo bench --bench kernels`; items are elements.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use ropewalk::Error;
use ropewalk::bench::{FullIteration, Pendulum, models};
use ropewalk::core::{Element, FieldTerm, Laws, Model, NodeId, Pool, Start, Term, Width};
use ropewalk::elements::cable::quadrature::Rule;
use ropewalk::elements::cable::{AxialDamping, BendingDamping, CableModel, L4, LockingFree};
use ropewalk::forces::{AddedMass, Drag, NormalLaw, TangentialLaw};
use std::fmt;

const ELEMENTS: usize = 256;

fn main() {
    divan::main();
}

/// What is evaluated.
#[derive(Clone, Copy)]
enum Kernel {
    Cable(CableModel),
    Other(&'static str, fn(&Model) -> Box<dyn Term>),
}

/// The kernels besides those of stiffness.
const OTHERS: [Kernel; 5] = [
    Kernel::Other("drag", |m| {
        field(m, |laws| laws.push(drag(NormalLaw::Constant(1.2), TangentialLaw::Quadratic(0.01))))
    }),
    Kernel::Other("drag by Choo and Casarella", |m| {
        field(m, |laws| laws.push(drag(NormalLaw::ChooCasarella, TangentialLaw::ChooCasarella)))
    }),
    Kernel::Other("added mass", |m| {
        field(m, |laws| laws.push(AddedMass::new(1025.0, 1.0).expect("positive")))
    }),
    Kernel::Other("axial damping", |m| {
        pool(m, AxialDamping::new(1.0 / ELEMENTS as f64, 5.0, L4, LockingFree.axial()))
    }),
    Kernel::Other("bending damping", |m| {
        pool(m, BendingDamping::new(1.0 / ELEMENTS as f64, 1e-4, LockingFree.bending()))
    }),
];

/// A kernel at a width that the processor has.
#[derive(Clone, Copy)]
struct Case(Kernel, Width);

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Kernel::Cable(m) => write!(f, "{:?}+{:?} {:?}", m.longitudinal, m.transverse, m.integration)?,
            Kernel::Other(name, _) => write!(f, "{name}")?,
        }
        write!(f, ", {:?}", self.1)
    }
}

impl Case {
    /// A bent cable whose only term is the kernel.
    fn make(self) -> Result<FullIteration, Error> {
        let model = match self.0 {
            Kernel::Cable(models) => {
                let mut scene = Pendulum::new(ELEMENTS).with_models(models).bent();
                scene.constraints.clear();
                scene.forces.clear();
                scene.build()?
            }
            Kernel::Other(_, term) => {
                let whole = Pendulum::new(ELEMENTS).in_water().bent().build()?;
                let start = Start { q: whole.state().q, v: whole.state().v, internal: Vec::new() };
                Model::new(whole.nodes().to_vec(), vec![term(&whole)], vec![], vec![], start, 1.0)
            }
        };
        FullIteration::of(model.with_width(self.1))
    }
}

fn cases() -> Vec<Case> {
    let widths = [Width::One, Width::Four, Width::Eight];
    let widths = widths.into_iter().filter(|w| w.lanes() <= Width::best().lanes());
    let kernels: Vec<Kernel> = models().into_iter().map(Kernel::Cable).chain(OTHERS).collect();
    widths.flat_map(|w| kernels.iter().map(move |k| Case(*k, w)).collect::<Vec<_>>()).collect()
}

fn pool<E: Element<12, 12>>(m: &Model, element: E) -> Box<dyn Term> {
    let mut pool = Pool::new();
    for k in 1..m.nodes().len() as u32 {
        assert!(pool.push(m.nodes(), element.clone(), &[NodeId(k - 1), NodeId(k)]));
    }
    Box::new(pool)
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
fn force(bencher: Bencher<'_, '_>, case: Case) {
    let mut one = case.make().expect("model");
    bencher.counter(ItemsCount::new(ELEMENTS)).bench_local(|| black_box(&mut one).residual());
}

#[divan::bench(args = cases())]
fn force_and_tangent(bencher: Bencher<'_, '_>, case: Case) {
    let mut one = case.make().expect("model");
    bencher.counter(ItemsCount::new(ELEMENTS)).bench_local(|| black_box(&mut one).assemble());
}
