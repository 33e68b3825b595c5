//! `modelDescription.xml` (FMI 3.0, section 2.4).

use super::{Interface, Kind, LIBRARY, Variable};
use std::collections::BTreeSet;
use std::fmt::Write as _;

impl Interface {
    /// The file `modelDescription.xml` of the FMU.
    pub fn description(&self) -> String {
        let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
        let [duration, output] = self.experiment;
        // writing to a string can't fail
        let _ = writeln!(
            out,
            "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{}\" instantiationToken=\"{}\" description=\"{}\" \
             generationTool=\"Ropewalk {}\">",
            escaped(&self.name),
            escaped(&self.token),
            escaped(&self.title),
            env!("CARGO_PKG_VERSION")
        );
        let _ = writeln!(
            out,
            "<CoSimulation modelIdentifier=\"{LIBRARY}\" canHandleVariableCommunicationStepSize=\"true\" \
             canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"/>"
        );
        out += "<UnitDefinitions>\n";
        let units: BTreeSet<&str> =
            self.variables.iter().map(|v| v.unit.as_str()).filter(|u| !u.is_empty()).collect();
        for unit in units {
            let _ = writeln!(out, "<Unit name=\"{}\"/>", escaped(unit));
        }
        out += "</UnitDefinitions>\n";
        let _ = writeln!(
            out,
            "<DefaultExperiment startTime=\"0\" stopTime=\"{duration}\" stepSize=\"{output}\"/>"
        );
        out += "<ModelVariables>\n";
        self.variables.iter().for_each(|v| variable(&mut out, v));
        out += "</ModelVariables>\n<ModelStructure>\n";
        for element in ["Output", "InitialUnknown"] {
            for v in self.variables.iter().filter(|v| v.kind == Kind::Output) {
                let _ = writeln!(out, "<{element} valueReference=\"{}\"/>", v.reference);
            }
        }
        out += "</ModelStructure>\n</fmiModelDescription>\n";
        out
    }
}

fn variable(out: &mut String, v: &Variable) {
    let about = |name: &str, text: &str| {
        if text.is_empty() { String::new() } else { format!(" {name}=\"{}\"", escaped(text)) }
    };
    let common = format!(
        "name=\"{}\" valueReference=\"{}\"{}{}",
        escaped(&v.name),
        v.reference,
        about("description", &v.description),
        about("unit", &v.unit)
    );
    let _ = match &v.kind {
        Kind::Time => {
            writeln!(out, "<Float64 {common} causality=\"independent\" variability=\"continuous\"/>")
        }
        Kind::Parameter { start } => {
            let start = escaped(start);
            writeln!(
                out,
                "<String {common} causality=\"parameter\" variability=\"fixed\"><Start value=\"{start}\"/></String>"
            )
        }
        Kind::Input { start, range } => {
            let limit =
                |name: &str, x: f64| if x.is_finite() { format!(" {name}=\"{x}\"") } else { String::new() };
            let (min, max) = (limit("min", range[0]), limit("max", range[1]));
            writeln!(
                out,
                "<Float64 {common} causality=\"input\" variability=\"continuous\" start=\"{start}\"{min}{max}/>"
            )
        }
        Kind::Output => writeln!(out, "<Float64 {common} causality=\"output\" variability=\"continuous\"/>"),
    };
}

/// Text that may stand in an attribute.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            // a line break in an attribute would be read as a blank
            '\n' => out += "&#10;",
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}
