//! What a run leaves behind for the eye: the field record, the page of the browser, files for ParaView.

use super::recorder::Recorder;
use super::statistics::Told;
use super::summary::Summary;
use super::{Outcome, page};
use crate::certificate::statement::Certificate;
use ropewalk_report::{FieldRecord, OutputError, Page, RunFolder, vtk};
use ropewalk_scene::SceneFile;
use serde::{Deserialize, Serialize};

/// Which files a run leaves behind beside scene, history, shapes, tables and summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leaves {
    /// `report.html`, and what it is made of: `field.npy`, `bodies.npy` and `forces.npy`, and `steps.csv`.
    pub report: bool,
    /// `plots/*.svg`.
    pub plots: bool,
    /// `vtk.pvd` and the files in `vtk/`, for ParaView.
    pub vtk: bool,
}

impl Default for Leaves {
    /// The page and the pictures.
    fn default() -> Self {
        Leaves { report: true, plots: true, vtk: false }
    }
}

impl Leaves {
    /// Whether a field record is needed.
    pub(super) fn field(self) -> bool {
        self.report || self.vtk
    }
}

/// Writes the field record; says what can't be written.
pub(super) fn write_field(
    folder: &RunFolder,
    leaves: Leaves,
    field: &FieldRecord,
    warn: &mut dyn FnMut(&str),
) {
    let npy = || field.write_npy(&folder.field_file(), &folder.bodies_file());
    let forces = || field.write_forces_npy(&folder.forces_file());
    let for_vtk = || if leaves.vtk { vtk::write(field, folder.path(), "vtk") } else { Ok(()) };
    for written in [npy(), forces(), for_vtk()] {
        written.unwrap_or_else(|e| warn(&e.to_string()));
    }
}

/// Writes the page, and gives it back so that more can be put onto it.
pub(super) fn write_page(
    folder: &RunFolder,
    file: &SceneFile,
    summary: &Summary,
    recorder: &mut Recorder<'_>,
    (field, told): (FieldRecord, Told),
    warn: &mut dyn FnMut(&str),
) -> Option<Page> {
    let history = std::mem::take(&mut recorder.table);
    let steps = recorder.steps.take();
    let mut page = page::page(file, summary, history, &recorder.figures, field, steps);
    told.onto(&mut page);
    let written = page.write(&folder.report_file());
    // one copy of it is enough
    recorder.table = std::mem::take(&mut page.history);
    written.map_err(|e| warn(&e.to_string())).ok().map(|()| page)
}

impl Outcome {
    /// Keeps how far the run can be trusted with its results: in the summary, on the page and in the report.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn certified(&mut self, certificate: Certificate) -> Result<(), OutputError> {
        let text = certificate.text();
        self.report += &text;
        self.summary.certificate = Some(certificate);
        self.folder.write_summary(&self.summary)?;
        if let Some(page) = &mut self.page {
            page.notes.extend(page::lines(&text));
            std::mem::swap(&mut page.history, &mut self.history);
            let written = page.write(&self.folder.report_file());
            std::mem::swap(&mut page.history, &mut self.history);
            written?;
        }
        Ok(())
    }
}
