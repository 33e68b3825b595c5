//! What an atlas file says.

use crate::sweep::Report;
use ropewalk_scene::quantity;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Names with values, in the order of the file.
pub(super) type Values = Map<String, Value>;

/// A whole atlas.
pub(super) struct Atlas {
    /// What it is of.
    pub title: String,
    /// What one should know of all of it.
    pub description: String,
    pub chapters: Vec<Chapter>,
    /// Scenes under names of the atlas, with parameters that all runs of them have.
    pub scenes: BTreeMap<String, SceneUse>,
    /// Panels that several figures have.
    pub layouts: BTreeMap<String, Layout>,
    /// What legends call parameters.
    pub names: BTreeMap<String, String>,
    pub entries: Vec<Entry>,
}

/// A chapter, under which entries are shown.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Chapter {
    pub number: String,
    pub title: String,
}

/// A scene as the atlas uses it.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct SceneUse {
    /// A bundled scene, or …
    #[serde(default)]
    pub scene: Option<String>,
    /// … the path of one, from the atlas.
    #[serde(default)]
    pub file: Option<String>,
    /// Parameters that all runs have.
    #[serde(default)]
    pub set: Values,
    /// Other values at places such as `solver.stepping`.
    #[serde(default)]
    pub edit: Values,
    /// Parameters for a first look, with `--quick`.
    #[serde(default)]
    pub quick: Values,
}

/// Panels that several figures have.
#[derive(Clone, Debug, Default, Deserialize)]
pub(super) struct Layout {
    /// Panels side by side.
    #[serde(default)]
    pub columns: Option<usize>,
    pub panels: Vec<Panel>,
}

/// Something with a number.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Entry {
    /// Curves.
    Figure(Figure),
    /// Numbers.
    Table(Sheet),
    /// What isn't computed.
    Other(Other),
}

/// What every entry has.
pub(super) struct Head<'a> {
    /// `4.43`
    pub number: &'a str,
    pub title: &'a str,
    pub chapter: &'a str,
    pub note: &'a str,
}

impl Entry {
    pub(super) fn head(&self) -> Head<'_> {
        let (number, title, chapter, note) = match self {
            Entry::Figure(f) => (&f.number, &f.title, &f.chapter, &f.note),
            Entry::Table(t) => (&t.number, &t.title, &t.chapter, &t.note),
            Entry::Other(o) => (&o.number, &o.title, &o.chapter, &o.note),
        };
        Head { number, title, chapter, note }
    }

    /// What `--only` and files call it: `4.43`, `table-4.11`.
    pub(super) fn name(&self) -> String {
        match self {
            Entry::Table(t) => format!("table-{}", t.number),
            Entry::Other(o) if o.table => format!("table-{}", o.number),
            _ => self.head().number.to_string(),
        }
    }

    /// `Figure 4.43`
    pub(super) fn caption(&self) -> String {
        let table = matches!(self, Entry::Table(_)) || matches!(self, Entry::Other(o) if o.table);
        format!("{} {}", if table { "Table" } else { "Figure" }, self.head().number)
    }

    /// Whether its runs have to be computed: of a table of parameters they needn't.
    pub(super) fn needs_results(&self) -> bool {
        !matches!(self, Entry::Table(sheet) if !sheet.parameters.is_empty())
    }

    /// The runs that it is made of.
    pub(super) fn runs(&self) -> &[Runs] {
        match self {
            Entry::Figure(f) => &f.runs,
            Entry::Table(t) => &t.runs,
            Entry::Other(_) => &[],
        }
    }
}

/// A run, or all combinations of some parameters; those that differ in the last one follow each other.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Runs {
    /// A scene of the atlas, or a bundled one.
    pub scene: String,
    #[serde(default)]
    pub set: Values,
    /// Other values at places such as `solver.scales`.
    #[serde(default)]
    pub edit: Values,
    /// Lists of values by name of the parameter.
    #[serde(default)]
    pub vary: Values,
    /// What legends call these runs, in front of what is varied.
    #[serde(default)]
    pub label: Option<String>,
}

/// A picture.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Figure {
    pub number: String,
    pub title: String,
    #[serde(default)]
    pub chapter: String,
    #[serde(default)]
    pub note: String,
    #[serde(default)]
    pub runs: Vec<Runs>,
    /// Name of a layout, whose panels come first.
    #[serde(default)]
    pub layout: Option<String>,
    #[serde(default)]
    pub panels: Vec<Panel>,
    /// Panels side by side.
    #[serde(default)]
    pub columns: Option<usize>,
    /// Measured or published curves to be laid over.
    #[serde(default)]
    pub overlay: Vec<Overlay>,
}

/// A CSV file: the first column is along the horizontal axis, the others are curves.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Overlay {
    pub file: String,
    /// What the legend calls it; otherwise its columns' names.
    #[serde(default)]
    pub label: Option<String>,
}

/// A plot of a figure: records, or shapes, or a function.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Panel {
    pub title: String,
    /// Columns of the history.
    pub y: Vec<String>,
    /// What legends call them.
    pub labels: Vec<String>,
    /// What they are drawn over, if not time.
    pub x: Option<String>,
    /// The parameter that they are drawn over: a point for each run.
    pub over: Option<String>,
    /// Which value stands for a run there.
    pub value: Report,
    /// Last share of a run that it is taken over.
    #[serde(deserialize_with = "quantity::optional::number")]
    pub share: Option<f64>,
    /// A number of each run instead of a record, drawn over the parameter.
    pub quantity: Option<Quantity>,
    /// From where shapes are seen.
    pub shapes: Option<View>,
    /// Shapes at how many times, evenly in the window; 1 is the last.
    pub count: Option<usize>,
    /// Parts whose shapes are drawn; otherwise all.
    pub parts: Vec<String>,
    /// Functions to be drawn.
    pub functions: Vec<Function>,
    /// Their range.
    pub range: Option<[f64; 2]>,
    /// A recorded point whose position is subtracted from positions and shapes.
    pub relative_to: Option<String>,
    /// Whether its course is turned into the x axis as well.
    pub along_course: bool,
    /// From when to when.
    pub window: Option<[Time; 2]>,
    /// What is before this time doesn't count for the vertical axis.
    #[serde(deserialize_with = "quantity::optional::time")]
    pub after: Option<f64>,
    /// Least and largest value of the vertical axis.
    pub y_range: Option<[f64; 2]>,
    /// Whether both axes have one scale: for shapes unless said otherwise, for records if said so.
    pub equal: Option<bool>,
    pub log_x: bool,
    pub log_y: bool,
    pub x_label: String,
    pub y_label: String,
    /// Whether values are points of few runs, to be marked.
    pub dots: bool,
    /// What stands around.
    pub guides: Vec<Guide>,
}

/// A time of a run [s].
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(transparent)]
pub(super) struct Time(#[serde(deserialize_with = "quantity::time")] pub f64);

/// From where shapes are seen.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(super) enum View {
    /// z over x.
    Side,
    /// y over x.
    Top,
    /// z over y.
    End,
    /// From far away, obliquely.
    Space,
    /// z over the distance from the z axis.
    Radial,
}

/// A line in grey: a drum, a limit, an exact value.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Guide {
    #[serde(default)]
    pub label: String,
    /// Its corners, in the units of the axes; of a panel of shapes in space points with three coordinates.
    #[serde(default)]
    pub points: Vec<Vec<f64>>,
    /// A circle about this point, of three coordinates in space, there about the z axis.
    #[serde(default)]
    pub centre: Vec<f64>,
    #[serde(default)]
    pub radius: f64,
    /// A level all along the horizontal axis.
    #[serde(default)]
    pub level: Option<f64>,
}

/// A function that is known to the program.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Function {
    /// Normal drag coefficient over the Reynolds number of the normal flow.
    ChooCasarellaCn,
    /// Tangential drag force by viscosity and speed over the same.
    ChooCasarellaCt,
}

/// A number that a run has beside its records.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Quantity {
    /// CPU time [s].
    Cpu,
    /// Accepted steps.
    Steps,
    /// Steps that were repeated smaller.
    Rejected,
    /// Newton iterations.
    Iterations,
    /// The same by steps.
    IterationsPerStep,
    /// `l² √(ρA/EI)` with the length `l` of an element of the first cable [s].
    BendingTime,
    /// `V T / l` with the bending time `T` and the speed `V` of the scene's parameter `winding`.
    WindingCoefficient,
}

/// A table.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Sheet {
    pub number: String,
    pub title: String,
    #[serde(default)]
    pub chapter: String,
    #[serde(default)]
    pub note: String,
    #[serde(default)]
    pub runs: Vec<Runs>,
    /// The columns of a row for each run, or for each time.
    #[serde(default)]
    pub columns: Vec<Cell>,
    /// The parameter whose values become columns, or `case` for the labels of `runs`.
    #[serde(default)]
    pub across: Option<String>,
    /// Whether the first of them by the others is shown as well.
    #[serde(default)]
    pub ratio: bool,
    /// A row at multiples of this time instead of one for each run.
    #[serde(default, deserialize_with = "quantity::optional::time")]
    pub every: Option<f64>,
    /// Parameters of the scenes, a row for each, instead of results.
    #[serde(default)]
    pub parameters: Vec<String>,
    /// A table that the program knows.
    #[serde(default)]
    pub computed: Option<Known>,
}

/// A column of a table.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Cell {
    /// A column of the history, or …
    #[serde(default)]
    pub record: Option<String>,
    /// … a number of the run.
    #[serde(default)]
    pub quantity: Option<Quantity>,
    /// What the column is called.
    #[serde(default)]
    pub heading: Option<String>,
    /// Which value of the record stands for the run.
    #[serde(default)]
    pub value: Report,
    /// Last share of a run that it is taken over, and that tells whether it is steady.
    #[serde(default, deserialize_with = "quantity::optional::number")]
    pub share: Option<f64>,
}

/// A table that the program knows.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Known {
    /// Newmark's family: β, γ, stability limit, order.
    NewmarkFamily,
    /// What this machine is.
    Machine,
    /// The longitudinal stiffness models.
    LongitudinalModels,
    /// Which of them go with which transverse models.
    StiffnessPairs,
}

/// What isn't computed.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Other {
    pub number: String,
    pub title: String,
    #[serde(default)]
    pub chapter: String,
    /// Whether it is a table.
    #[serde(default)]
    pub table: bool,
    pub what: Nature,
    #[serde(default)]
    pub note: String,
}

/// Why something isn't computed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(super) enum Nature {
    Drawing,
    Photograph,
    Measured,
}

impl Nature {
    pub fn words(self) -> &'static str {
        match self {
            Nature::Drawing => "a drawing",
            Nature::Photograph => "a photograph",
            Nature::Measured => "measured",
        }
    }
}
