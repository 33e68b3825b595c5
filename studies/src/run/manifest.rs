//! `manifest.json`: what was built from a scene, so that a run can be understood without running it again.

use super::pictures::shape_titles;
use ropewalk_core::{Guard, Model, Width};
use ropewalk_report::Sheet;
use ropewalk_scene::{Analysis, Fault, Scene, SceneFile};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// What a model consists of. An effect that the scene doesn't name is not in it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Manifest {
    /// Title of the scene.
    pub title: String,
    /// Version of Ropewalk.
    pub ropewalk: &'static str,
    /// What is computed.
    pub analysis: Analysis,
    /// The parts, each as name and type.
    pub parts: Vec<(String, &'static str)>,
    /// Labels of the terms of the equations of motion.
    pub terms: Vec<String>,
    /// The constraints, each as name and number of equations.
    pub constraints: Vec<(String, usize)>,
    /// What one should know about them.
    pub notes: Vec<String>,
    /// Columns of the history, without time.
    pub records: Vec<String>,
    /// Titles of the pictures, by column of the history and by name of the picture of shapes.
    pub titles: BTreeMap<String, String>,
    /// Number of velocities.
    pub unknowns: usize,
    /// Number of multipliers.
    pub multipliers: usize,
    /// Entries of the iteration matrix that may differ from zero; of a symmetric one, those of one half.
    pub non_zeros: usize,
    /// Whether the iteration matrix is symmetric.
    pub symmetric: bool,
    /// The linear solver.
    pub solver: &'static str,
    /// Elements that are evaluated at once.
    pub lanes: usize,
}

impl Manifest {
    /// Looks at a scene and its model.
    ///
    /// # Errors
    /// A record that can't be made, or not enough memory for the structure of the equations.
    pub fn new(file: &SceneFile, model: &Model) -> Result<Self, Fault> {
        let s = model.structure();
        let solver = Guard::new(s).map_err(|e| Fault::new(e.to_string()))?.name();
        let processes = &file.scene().processes;
        let records = file.records(model)?;
        let records = records.iter().map(|r| (r.title(), r.columns()));
        let channels = processes.iter().flat_map(|p| p.channels()).map(|c| (c.title, c.columns));
        let mut titles = BTreeMap::new();
        let mut columns = Vec::new();
        for (title, own) in records.chain(channels) {
            titles.extend(own.iter().map(|c| (c.name.clone(), title.clone())));
            columns.extend(own.into_iter().map(|c| c.name));
        }
        titles.extend(shape_titles(&file.scene().run.shape_titles));
        Ok(Manifest {
            title: file.title().to_string(),
            ropewalk: env!("CARGO_PKG_VERSION"),
            analysis: file.scene().run.analysis,
            parts: model
                .parts()
                .iter()
                .map(|p| (p.name().to_string(), p.kind()))
                .chain(processes.iter().map(|p| (p.name().to_string(), p.typetag_name())))
                .collect(),
            terms: model.terms().iter().map(|t| t.label()).collect(),
            constraints: model.constraints().iter().map(|c| (c.name().to_string(), c.rows().len())).collect(),
            notes: notes(file.scene(), model),
            records: columns,
            titles,
            unknowns: model.velocities() + processes.iter().map(|p| p.unknowns()).sum::<usize>(),
            multipliers: model.multipliers(),
            non_zeros: s.entries(),
            symmetric: s.symmetric,
            solver,
            lanes: Width::best().lanes(),
        })
    }
}

/// What the constraints and the waves of a scene have to say of themselves.
pub(super) fn notes(scene: &Scene, model: &Model) -> Vec<String> {
    let sea = scene.water.as_ref().and_then(|water| water.raised(scene.gravity).ok().flatten());
    let waves = sea.into_iter().map(|sea| sea.about().to_string());
    let constraints = scene.constraints.iter().flat_map(|c| c.notes(model));
    constraints.chain(scene.forces.iter().flat_map(|f| f.notes())).chain(waves).collect()
}

impl fmt::Display for Manifest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut sheet = Sheet::new(&self.title).with_labels(12);
        let equations = |n: usize| if n == 1 { "1 equation".to_string() } else { format!("{n} equations") };
        sheet.entries("parts", self.parts.iter().map(|(name, kind)| format!("{name} ({kind})")));
        sheet.entries("terms", &self.terms);
        sheet.entries(
            "constraints",
            self.constraints.iter().map(|(n, rows)| format!("{n} ({})", equations(*rows))),
        );
        sheet.entries("notes", &self.notes);
        sheet.entries("records", &self.records);
        // a process has its own equations
        let multipliers = format!(", and {} multipliers", self.multipliers);
        let multipliers = if self.non_zeros == 0 { "" } else { &multipliers };
        sheet.entry("unknowns", format!("{}{multipliers}", self.unknowns));
        if self.non_zeros > 0 {
            let symmetric = if self.symmetric { "symmetric" } else { "unsymmetric" };
            sheet.entry("matrix", format!("{} non-zeros, {symmetric}", self.non_zeros));
            sheet.entry("solver", format!("{}, {} elements at once", self.solver, self.lanes));
        }
        f.write_str(sheet.to_string().trim_end())
    }
}
