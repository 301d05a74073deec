//! The descriptions of a unit: FMI 2.0.4, sec. 2.2 and 4.3; FMI 3.0.1, sec. 2.4 and 4.3.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::Variable;
use crate::Model;

fn escaped(text: &str) -> String {
    let kept: String = text.chars().filter(|c| !c.is_control()).collect();
    kept.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn units(variables: &[Variable]) -> String {
    let units: BTreeSet<&str> =
        variables.iter().map(|v| v.unit.as_str()).filter(|unit| !unit.is_empty()).collect();
    if units.is_empty() {
        return String::new();
    }
    let each: String =
        units.iter().map(|unit| format!("    <Unit name=\"{}\"/>\n", escaped(unit))).collect();
    format!("  <UnitDefinitions>\n{each}  </UnitDefinitions>\n")
}

/// Attributes of a number.
fn attributes(variable: &Variable) -> String {
    let mut text = String::new();
    if let Some(start) = variable.start {
        let _ = write!(text, " start=\"{start:?}\"");
    }
    if !variable.unit.is_empty() {
        let _ = write!(text, " unit=\"{}\"", escaped(&variable.unit));
    }
    text
}

/// How a variable changes and where its first value is from, as both versions write it.
fn kind(variable: &Variable) -> &'static str {
    match variable.causality {
        "parameter" => "variability=\"tunable\" initial=\"exact\"",
        "output" => "variability=\"continuous\" initial=\"calculated\"",
        _ => "variability=\"continuous\"",
    }
}

/// modelDescription.xml of FMI 2.0; `compile` are the files to compile.
pub fn version2(
    model: &Model<'_>,
    variables: &[Variable],
    token: &str,
    compile: &[String],
) -> String {
    let (name, step) = (model.name, model.step.sampling_time);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"2.0\" \
         modelName=\"{name}\" guid=\"{token}\" generationTool=\"lacuna\" \
         variableNamingConvention=\"flat\">\n  <CoSimulation modelIdentifier=\"{name}\" \
         canHandleVariableCommunicationStepSize=\"true\" canInterpolateInputs=\"{}\">\n    \
         <SourceFiles>\n",
        model.step.ramps
    );
    for file in compile {
        let _ = writeln!(text, "      <File name=\"{file}\"/>");
    }
    let _ = write!(
        text,
        "    </SourceFiles>\n  </CoSimulation>\n{}  <DefaultExperiment startTime=\"0.0\" \
         stepSize=\"{step:?}\"/>\n  <ModelVariables>\n",
        units(variables)
    );
    for variable in variables {
        let _ = writeln!(
            text,
            "    <ScalarVariable name=\"{}\" valueReference=\"{}\" causality=\"{}\" {}>\
             <Real{}/></ScalarVariable>",
            escaped(&variable.name),
            variable.reference,
            variable.causality,
            kind(variable),
            attributes(variable)
        );
    }
    text += "  </ModelVariables>\n  <ModelStructure>\n";
    let outputs = variables.iter().filter(|v| v.causality == "output");
    // the index of a variable is its place in the list, from 1
    let unknowns: String =
        outputs.map(|v| format!("      <Unknown index=\"{}\"/>\n", v.reference)).collect();
    if !unknowns.is_empty() {
        let _ = write!(
            text,
            "    <Outputs>\n{unknowns}    </Outputs>\n    <InitialUnknowns>\n{unknowns}    \
             </InitialUnknowns>\n"
        );
    }
    text + "  </ModelStructure>\n</fmiModelDescription>\n"
}

/// modelDescription.xml of FMI 3.0.
pub fn version3(model: &Model<'_>, variables: &[Variable], token: &str) -> String {
    let (name, step) = (model.name, model.step.sampling_time);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\" \
         modelName=\"{name}\" instantiationToken=\"{token}\" generationTool=\"lacuna\">\n  \
         <CoSimulation modelIdentifier=\"{name}\" \
         canHandleVariableCommunicationStepSize=\"true\" fixedInternalStepSize=\"{step:?}\"/>\n\
         {}  <DefaultExperiment startTime=\"0.0\" stepSize=\"{step:?}\"/>\n  <ModelVariables>\n    \
         <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" \
         variability=\"continuous\"/>\n",
        units(variables)
    );
    for variable in variables {
        let _ = writeln!(
            text,
            "    <Float64 name=\"{}\" valueReference=\"{}\" causality=\"{}\" {}{}/>",
            escaped(&variable.name),
            variable.reference,
            variable.causality,
            kind(variable),
            attributes(variable)
        );
    }
    text += "  </ModelVariables>\n  <ModelStructure>\n";
    for element in ["Output", "InitialUnknown"] {
        for variable in variables.iter().filter(|v| v.causality == "output") {
            let _ = writeln!(text, "    <{element} valueReference=\"{}\"/>", variable.reference);
        }
    }
    text + "  </ModelStructure>\n</fmiModelDescription>\n"
}

/// sources/buildDescription.xml of FMI 3.0.
pub fn build(name: &str, compile: &[String]) -> String {
    let files: String =
        compile.iter().map(|file| format!("      <SourceFile name=\"{file}\"/>\n")).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n  \
         <BuildConfiguration modelIdentifier=\"{name}\">\n    <SourceFileSet language=\"C99\">\n\
         {files}    </SourceFileSet>\n    <Library name=\"m\"/>\n  </BuildConfiguration>\n\
         </fmiBuildDescription>\n"
    )
}
