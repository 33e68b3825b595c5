//! What there is to be seen in a scene: lines, bodies, the shapes that they touch, water and bed.

use super::forces::{self, Acting, Forces};
use super::shapes::{Line, MEASURED, Shape};
use ropewalk_core::rotation::{from_matrix, matrix, transposed_times};
use ropewalk_core::{At, Attitude, Marker, Model, NodeKind, Part, Quantity, Solid, Surface, V3};
use ropewalk_report as output;
use ropewalk_report::{
    BodyRecord, FieldRecord, LineRecord, LineSnapshot, Mesh, Plane, Pose, ShapePlot, Wave, Waves,
};
use ropewalk_scene::{Analysis, Process, SceneFile, Water};

const SPEED: &str = "speed";

/// Parts and shapes of a scene with all that doesn't change while it runs.
#[derive(Default)]
pub(crate) struct Scenery {
    /// All of it, without times.
    still: FieldRecord,
    /// What each of its bodies is in the model.
    movers: Vec<Mover>,
    /// Wheels, drums and other cylinders that aren't bodies, each with the number of the body that carries it.
    wheels: Vec<(Option<usize>, output::Shape)>,
    /// Points of all lines together.
    points: usize,
    /// What exerts forces.
    forces: Forces,
}

/// What moves a body.
enum Mover {
    /// It is a part of this number.
    Part(usize),
    /// It is a node that carries a shape, by its first coordinate.
    Node(usize),
    /// It is a point that the motion of the constraint of this number leads.
    Driven(usize),
}

impl Scenery {
    /// What a scene and its model show; `process` is what it runs instead of a model, if it does.
    pub fn new(file: &SceneFile, model: &Model, process: Option<&dyn Process>) -> Self {
        let scene = file.scene();
        let place = |list: &str, k: usize| {
            let place = file.document().fault_at(&format!("{list}[{k}]"), "").place;
            place.map_or_else(String::new, |p| format!("{}:{}", p.file, p.line))
        };
        let of_part = |part: &dyn Part| {
            let k = scene.elements.iter().position(|e| e.name() == part.name());
            k.map_or_else(String::new, |k| place("elements", k))
        };
        let state = model.state();
        let at = state.at();
        let moves = scene.run.analysis != Analysis::Statics;
        let mut scenery = Scenery::default();
        for (k, part) in model.parts().iter().enumerate() {
            let (part, kind) = (part.as_ref(), part.kind().replace('_', " "));
            if part.attitude(&at).is_some() {
                let shapes = part.solids().iter().map(|s| shape(s, &[0.0; 3])).collect();
                let body = BodyRecord { place: of_part(part), shapes, ..BodyRecord::new(part.name(), kind) };
                scenery.still.bodies.push(body);
                scenery.movers.push(Mover::Part(k));
                continue;
            }
            scenery.points += part.centre_line(&at).len();
            if !part.centre_line(&at).is_empty() {
                let quantities = quantities(part, moves);
                let line = LineRecord::new(part.name(), kind, diameter(part));
                scenery.still.lines.push(LineRecord { place: of_part(part), quantities, ..line });
            }
        }
        if let (Some(process), Some(spec)) = (process, scene.processes.first()) {
            let known = [("tension", process.tensions()), ("curvature", process.curvatures())];
            let known = known.iter().filter(|(_, values)| !values.is_empty());
            let quantities = known.map(|(name, _)| output::Quantity::new(*name, unit(name))).collect();
            let line = LineRecord::new(spec.name(), spec.typetag_name().replace('_', " "), 0.0);
            scenery.still.lines.push(LineRecord { place: place("processes", 0), quantities, ..line });
            scenery.points += process.line().len();
        }
        scenery.add_driven(model);
        scenery.forces = Forces::new(model);
        let of_terms = model.terms().iter().filter_map(|t| t.shows()).flat_map(|s| s.solids());
        let of_constraints = model.constraints().iter().flat_map(|c| c.solids());
        let of_process = process.into_iter().flat_map(|p| p.solids());
        scenery.still.water = scene.water.as_ref().and_then(|water| water.level);
        scenery.still.waves = scene.water.as_ref().and_then(|water| waves(water, scene.gravity));
        for solid in of_terms.chain(of_constraints).chain(of_process) {
            scenery.add_solid(model, &solid);
        }
        scenery
    }

    /// Points that a motion leads through space, such as the end of a hose on a ship that isn't a body.
    fn add_driven(&mut self, model: &Model) {
        for (k, constraint) in model.constraints().iter().enumerate() {
            let [Marker::Ground { .. }, Marker::Node { node, .. }] = constraint.markers() else { continue };
            let shown = model.parts().iter().any(|part| {
                self.still.bodies.iter().any(|b| b.name == part.name()) && part.place_of(*node).is_some()
            });
            if constraint.imposes().is_some() && !shown {
                self.still.bodies.push(BodyRecord::new(constraint.name(), "driven point"));
                self.movers.push(Mover::Driven(k));
            }
        }
    }

    /// A shape, on the ground or on the body that carries it.
    fn add_solid(&mut self, model: &Model, solid: &Solid) {
        let Some(carrier) = solid.carrier else {
            // a floor below water is what the page calls the bed
            let normal = matrix(&solid.seat.turn).map(|row| row[2]);
            let is_bed = solid.surface == Surface::Plane && normal == [0.0, 0.0, 1.0];
            match is_bed && self.still.water.is_some() && self.still.bed.is_none() {
                true => self.still.bed = Some(solid.seat.x[2]),
                false => {
                    let there = shape(solid, &[0.0; 3]);
                    self.wheels.push((None, there.clone()));
                    self.still.shapes.push(there);
                }
            }
            return;
        };
        let state = model.state();
        let node = model.nodes().iter().find(|n| n.q == carrier && n.kind.has_position());
        let at = state.at();
        let Some(there) = node.and_then(|node| Attitude::of(node, &at)) else { return };
        let is_carrier = |mover: &Mover| match mover {
            Mover::Part(k) => model.parts()[*k].seats().iter().any(|seat| seat.0 == carrier),
            Mover::Node(q) => *q == carrier,
            Mover::Driven(_) => false,
        };
        let k = self.movers.iter().position(is_carrier).unwrap_or_else(|| {
            self.still.bodies.push(BodyRecord::new(&solid.name, "shape"));
            self.movers.push(Mover::Node(carrier));
            self.movers.len() - 1
        });
        let origin = match &self.movers[k] {
            Mover::Part(k) => model.parts()[*k].attitude(&at).map_or(there.x, |a| a.x),
            Mover::Node(_) | Mover::Driven(_) => there.x,
        };
        let arm: V3<f64> = std::array::from_fn(|i| origin[i] - there.x[i]);
        let arm = transposed_times(&matrix(&there.turn), &arm);
        let there = shape(solid, &arm);
        self.wheels.push((Some(k), there.clone()));
        self.still.bodies[k].shapes.push(there);
    }

    /// A plot of these shapes with all wheels, as they are seen in its plane.
    pub fn with_wheels(&self, plot: ShapePlot, plane: Plane, shapes: &[&Shape]) -> ShapePlot {
        let standing = self.wheels.iter().filter(|(body, _)| body.is_none()).map(|(_, shape)| shape);
        plot.with_wheels(plane, standing, |k| {
            let wheels = self.wheels.iter().filter_map(|(body, wheel)| Some(((*body)?, wheel)));
            wheels.filter_map(|(body, wheel)| Some((wheel, *shapes[k].bodies.get(body)?))).collect()
        })
    }

    /// Another model of the same scene, whose nodes have other numbers: carriers of shapes are found anew.
    pub fn follow(&mut self, model: &Model) {
        self.forces = Forces::new(model);
        let solids: Vec<Solid> =
            model.terms().iter().filter_map(|t| t.shows()).flat_map(|s| s.solids()).collect();
        for (mover, body) in self.movers.iter_mut().zip(&self.still.bodies) {
            if let Mover::Node(q) = mover
                && let Some(carrier) = solids.iter().find(|s| s.name == body.name).and_then(|s| s.carrier)
            {
                *q = carrier;
            }
        }
    }

    /// Points of all lines together.
    pub fn points(&self) -> usize {
        self.points
    }

    #[cfg(test)]
    pub fn of_points(points: usize) -> Self {
        Scenery { points, ..Scenery::default() }
    }

    /// Where all bodies are. What only a motion leads looks where it goes; its orientation is NaN while it stands.
    pub fn poses(&self, model: &Model, at: &At<'_>) -> Vec<Pose> {
        let nowhere = Attitude { x: [f64::NAN; 3], turn: [1.0, 0.0, 0.0, 0.0] };
        let pose = |mover: &Mover| {
            let there = match mover {
                Mover::Part(k) => model.parts().get(*k).and_then(|part| part.attitude(at)),
                Mover::Node(q) => {
                    let node = model.nodes().iter().find(|n| n.q == *q && n.kind == NodeKind::Frame);
                    node.and_then(|node| Attitude::of(node, at))
                }
                Mover::Driven(k) => model.constraints().get(*k).and_then(|constraint| {
                    let x = constraint.markers().last()?.now(model.nodes(), at).x;
                    let turn = heading(&constraint.imposes()?.at(at.t).v);
                    Some(Attitude { x, turn: turn.unwrap_or([f64::NAN; 4]) })
                }),
            };
            let Attitude { x, turn } = there.unwrap_or(nowhere);
            Pose { position: x, orientation: turn }
        };
        self.movers.iter().map(pose).collect()
    }

    /// All forces at a state with these multipliers.
    pub fn forces(&self, model: &Model, at: &At<'_>, lambda: &[f64]) -> Vec<Acting> {
        self.forces.at(model, at, lambda)
    }

    /// The field record of these shapes.
    pub fn field(&self, shapes: &[Shape]) -> FieldRecord {
        let mut field = self.still.clone();
        let mut forces: Vec<&[Acting]> = Vec::new();
        for shape in shapes {
            // a load path may turn back, or stand at a critical load
            if field.times.last().is_some_and(|last| !(shape.t > *last)) {
                continue;
            }
            field.times.push(shape.t);
            forces.push(&shape.forces);
            for line in &mut field.lines {
                let of = shape.lines.iter().find(|of| of.part == line.name);
                line.snapshots.push(snapshot(&line.quantities, of));
            }
            let poses = shape.bodies.iter().copied().map(Some).chain(std::iter::repeat(None));
            for (body, pose) in field.bodies.iter_mut().zip(poses) {
                body.poses.push(pose.unwrap_or(Pose { position: [f64::NAN; 3], ..Pose::default() }));
            }
        }
        field.bodies.iter_mut().for_each(|body| settle(&mut body.poses));
        field.forces = forces::records(forces.into_iter());
        field
    }

    /// What was read back from files, with the units, shapes and places that aren't in them.
    pub fn dress(&self, mut read: FieldRecord) -> FieldRecord {
        for line in &mut read.lines {
            if let Some(own) = self.still.lines.iter().find(|own| own.name == line.name) {
                line.kind.clone_from(&own.kind);
                line.place.clone_from(&own.place);
                line.diameter = own.diameter;
            }
            for quantity in &mut line.quantities {
                quantity.unit = unit(&quantity.name).into();
            }
            // a column of the file that this line has no values for
            for k in (0..line.quantities.len()).rev() {
                if line.snapshots.iter().all(|s| s.values[k].iter().all(|x| x.is_nan())) {
                    line.quantities.remove(k);
                    line.snapshots.iter_mut().for_each(|s| drop(s.values.remove(k)));
                }
            }
        }
        for body in &mut read.bodies {
            if let Some(own) = self.still.bodies.iter().find(|own| own.name == body.name) {
                body.kind.clone_from(&own.kind);
                body.place.clone_from(&own.place);
                body.shapes.clone_from(&own.shapes);
            }
        }
        FieldRecord {
            shapes: self.still.shapes.clone(),
            water: self.still.water,
            waves: self.still.waves.clone(),
            bed: self.still.bed,
            ..read
        }
    }
}

/// The waves on the water, if there are some that can be.
fn waves(water: &Water, [.., g]: V3<f64>) -> Option<Waves> {
    let (drift, _) = water.current().ok()?.at(water.level?);
    let waves = water.waves.as_ref()?.waves(-g, drift).ok()?;
    let all = waves.iter().map(|(amplitude, k, omega, phase)| Wave { amplitude, k, omega, phase });
    Some(Waves { all: all.collect(), ramp: waves.ramp() })
}

/// Unit of what is measured along lines.
fn unit(name: &str) -> &'static str {
    let measured = MEASURED.iter().find(|(_, known)| *known == name);
    measured.map_or(if name == SPEED { "m/s" } else { "" }, |(what, _)| what.unit())
}

/// What is known along a line.
fn quantities(part: &dyn Part, moves: bool) -> Vec<output::Quantity> {
    let bends = part.slender().is_some_and(|s| s.ei > 0.0);
    let known = MEASURED.iter().filter(|(what, _)| *what != Quantity::Moment || bends);
    let measured = part.line().is_some().then_some(known).into_iter().flatten().map(|(_, name)| *name);
    // what the joints of a chain carry
    let carried = (!part.links().is_empty()).then_some("tension");
    let names = carried.into_iter().chain(measured).chain(moves.then_some(SPEED));
    names.map(|name| output::Quantity::new(name, unit(name))).collect()
}

fn diameter(part: &dyn Part) -> f64 {
    let of_span = || part.contact_spans().first().map(|span| 2.0 * span.radius);
    part.tips().first().map(|tip| tip.diameter).or_else(of_span).unwrap_or(0.0)
}

/// A line at one time; one that isn't there has no points.
fn snapshot(quantities: &[output::Quantity], line: Option<&Line>) -> LineSnapshot {
    let Some(line) = line else {
        return LineSnapshot { values: vec![Vec::new(); quantities.len()], ..LineSnapshot::default() };
    };
    let of = |quantity: &output::Quantity| {
        let mut values = match MEASURED.iter().position(|(_, name)| *name == quantity.name) {
            Some(k) => line.values[k].clone(),
            None => line.speeds(),
        };
        values.resize(line.x.len(), f64::NAN);
        values
    };
    let values = quantities.iter().map(of).collect();
    LineSnapshot { s: line.s.clone(), position: line.x.clone(), velocity: line.v.clone(), values }
}

/// What has no orientation keeps the one before, or else has the first that comes.
fn settle(poses: &mut [Pose]) {
    let known = |pose: &Pose| pose.orientation.iter().all(|x| x.is_finite());
    let mut last =
        poses.iter().find(|pose| known(pose)).map_or(Pose::default().orientation, |p| p.orientation);
    for pose in poses {
        match known(pose) {
            true => last = pose.orientation,
            false => pose.orientation = last,
        }
    }
}

/// The turn about the vertical that takes x where this leads; `None` if that is nowhere, or upright.
fn heading(v: &V3<f64>) -> Option<[f64; 4]> {
    let along = v[0].hypot(v[1]);
    let (c, s) = (v[0] / along, v[1] / along);
    (along > 0.0).then(|| from_matrix(&[[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
}

/// A solid as reports know it, with its place less `origin`.
fn shape(solid: &Solid, origin: &V3<f64>) -> output::Shape {
    let surface = match &solid.surface {
        Surface::Plane => output::Solid::Plane,
        Surface::Ball { radius } => output::Solid::Ball { radius: *radius },
        Surface::Cylinder { radius, half } => output::Solid::Cylinder { radius: *radius, half: *half },
        Surface::Tube { radius, half } => output::Solid::Tube { radius: *radius, half: *half },
        Surface::Cuboid { half } => output::Solid::Box { half: *half },
        Surface::Triangles { corners, triangles } => {
            output::Solid::Mesh(Mesh { points: corners.clone(), triangles: triangles.clone() })
        }
    };
    let position = std::array::from_fn(|i| solid.seat.x[i] - origin[i]);
    output::Shape::new(&solid.name, surface, Pose { position, orientation: solid.seat.turn })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_core::rotation::times;

    #[test]
    fn what_is_led_looks_where_it_goes_and_stays_so_at_rest() {
        let turn = heading(&[0.0, -2.0, 5.0]).unwrap();
        let ahead = times(&matrix(&turn), &[1.0, 0.0, 0.0]);
        assert!((ahead[1] + 1.0).abs() < 1e-15 && ahead[2].abs() < 1e-15);
        assert_eq!(heading(&[0.0, 0.0, 1.0]), None);
        let pose = |orientation| Pose { orientation, ..Pose::default() };
        let none = pose([f64::NAN; 4]);
        let mut poses = [none, pose(turn), none];
        settle(&mut poses);
        assert!(poses.iter().all(|p| p.orientation == turn));
        let mut still = [none];
        settle(&mut still);
        assert_eq!(still, [Pose::default()]);
    }

    #[test]
    fn a_load_path_that_turns_back_leaves_times_that_rise() {
        let shape = Shape::bare;
        let field = Scenery::default().field(&[shape(0.0), shape(0.5), shape(0.5), shape(0.4), shape(0.6)]);
        assert_eq!(field.times, [0.0, 0.5, 0.6]);
        field.check().unwrap();
    }
}
