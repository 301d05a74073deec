//! A model as Functional Mock-up Units for co-simulation: FMI 2.0.4 and FMI 3.0.1.
//!
//! A unit is a zip file with a description, the C source, and a binary where a C compiler is
//! there. Its step is the model's sampling time, or a whole number of them.

mod description;

use std::io::{Cursor, Write as _};
use std::process::Command;

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::{ExportError, Files, Model, WRITTEN_BY, c};

/// One variable of a unit.
struct Variable {
    name: String,
    unit: String,
    causality: &'static str,
    start: Option<f64>,
    reference: usize,
}

/// Both units, `NAME_fmi2.fmu` and `NAME_fmi3.fmu`.
pub fn files(model: &Model<'_>, remarks: &mut Vec<String>) -> Result<Files, ExportError> {
    let variables = variables(model);
    let token = token(&(c::header(model) + &c::source(model)));
    let mut files = vec![];
    let mut compiled = true;
    for (version, wrapper) in
        [(2, include_str!("runtime/fmi2.c")), (3, include_str!("runtime/fmi3.c"))]
    {
        let name = model.name;
        let wrapper_name = format!("fmi{version}_{name}.c");
        let sources = [
            (format!("{name}.h"), c::header(model)),
            (format!("{name}.c"), c::source(model)),
            ("fmi_common.h".to_string(), common(model)),
            (wrapper_name.clone(), wrapper.replace("@TOKEN@", &token)),
        ];
        let compile = [format!("{name}.c"), wrapper_name];
        let description = match version {
            2 => description::version2(model, &variables, &token, &compile),
            _ => description::version3(model, &variables, &token),
        };
        let mut content = vec![("modelDescription.xml".to_string(), description.into_bytes())];
        for (file, text) in &sources {
            content.push((format!("sources/{file}"), text.clone().into_bytes()));
        }
        if version == 3 {
            let build = description::build(name, &compile);
            content.push(("sources/buildDescription.xml".into(), build.into_bytes()));
        }
        let folder = if version == 2 { "linux64" } else { "x86_64-linux" };
        match binary(name, &sources, &compile)? {
            Some(binary) => content.push((format!("binaries/{folder}/{name}.so"), binary)),
            None => compiled = false,
        }
        files.push((format!("{name}_fmi{version}.fmu"), zipped(&content)));
    }
    if !compiled {
        remarks.push(
            "No binary in the units, as there is no C compiler for Linux on x86-64 here: \
             only their source."
                .into(),
        );
    }
    remarks.push(format!(
        "The step of a unit is {} s, or a whole number of these.",
        model.step.sampling_time
    ));
    if model.step.ramps {
        remarks.push(
            "Between samples the inputs move along straight lines: set the slopes `der(..)`, \
             in 1/s, or each input stays where it is."
                .into(),
        );
    }
    Ok(files)
}

/// All variables but time, in the order of their references.
fn variables(model: &Model<'_>) -> Vec<Variable> {
    let step = model.step;
    let mut found: Vec<Variable> = vec![];
    let mut add = |name: &str, unit: &str, causality, start| {
        let taken = |name: &str| name == "time" || found.iter().any(|v| v.name == name);
        let mut own = name.to_string();
        if taken(&own) {
            own = format!("{causality}.{name}");
        }
        while taken(&own) {
            own.push('_');
        }
        let reference = found.len() + 1;
        found.push(Variable { name: own, unit: unit.into(), causality, start, reference });
    };
    for input in &step.inputs {
        add(&input.name, &input.unit, "input", Some(0.0));
    }
    if step.ramps {
        for input in &step.inputs {
            add(&format!("der({})", input.name), "", "input", Some(0.0));
        }
    }
    for output in &step.output_signals {
        add(&output.name, &output.unit, "output", None);
    }
    for parameter in &step.parameters {
        add(&parameter.name, &parameter.unit, "parameter", Some(parameter.value));
    }
    found
}

fn common(model: &Model<'_>) -> String {
    let step = model.step;
    let nu = step.inputs.len();
    include_str!("runtime/fmi_common.c")
        .replace("@NAME@", model.name)
        .replace("@NU@", &nu.to_string())
        .replace("@NS@", &if step.ramps { nu } else { 0 }.to_string())
        .replace("@NY@", &step.outputs.len().to_string())
        .replace("@NP@", &step.parameters.len().to_string())
        .replace("@RAMPS@", if step.ramps { "1" } else { "0" })
        .replace("@NEXT@", if step.ramps { "next, " } else { "" })
        .replace("@TS@", &format!("{:?}", step.sampling_time))
}

/// A text that stands for the source: FNV-1a of 64 bits, with two starts.
fn token(source: &str) -> String {
    let hash = |start: u64| {
        source.bytes().fold(start, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
    };
    format!("{{{:016x}{:016x}}}", hash(0xcbf2_9ce4_8422_2325), hash(0x9ae1_6a3b_2f90_404f))
}

/// The shared library, where there is a C compiler for the machine that the units name.
fn binary(
    name: &str,
    sources: &[(String, String)],
    compile: &[String],
) -> Result<Option<Vec<u8>>, ExportError> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return Ok(None);
    }
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let folder = std::env::temp_dir().join(format!("lacuna-fmu-{}-{name}", std::process::id()));
    let cannot = |error: std::io::Error| ExportError::Write {
        file: folder.display().to_string(),
        reason: error.to_string(),
    };
    std::fs::create_dir_all(&folder).map_err(cannot)?;
    for (file, text) in sources {
        std::fs::write(folder.join(file), text).map_err(cannot)?;
    }
    let made = Command::new(&compiler)
        .current_dir(&folder)
        .args(["-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-o", "made.so"])
        .args(compile)
        .arg("-lm")
        .output();
    let result = match made {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(ExportError::Compiler { compiler, said: error.to_string() }),
        Ok(output) if !output.status.success() => Err(ExportError::Compiler {
            compiler,
            said: String::from_utf8_lossy(&output.stderr).trim().to_string(),
        }),
        Ok(_) => std::fs::read(folder.join("made.so")).map(Some).map_err(cannot),
    };
    // what cannot be removed is left to the system: it is a folder for such files
    let _ = std::fs::remove_dir_all(&folder);
    result
}

/// A zip file in memory; the same content gives the same bytes.
fn zipped(content: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    let options = SimpleFileOptions::default();
    // by which the program knows that it may replace the file
    let _ = zip.set_comment(WRITTEN_BY);
    for (name, bytes) in content {
        // writing into memory does not fail below the size of a zip file, 4 GiB
        let _ = zip.start_file(name.as_str(), options).map(|()| zip.write_all(bytes));
    }
    zip.finish().map(Cursor::into_inner).unwrap_or_default()
}
