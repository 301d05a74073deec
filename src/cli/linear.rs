//! `lacuna estimate --lti`.

use super::args::Estimate as Args;
use super::console::Console;
use super::failure::Failure;
use super::no_model::Asked;
use super::stdout;
use lacuna::digits::{estimated, number};
use lacuna::estimate::{LinearEstimate, LinearParameter, Mode, linear_with};
use lacuna::report::documents;

pub fn run(args: &Args, look: &Console) -> Result<u8, Failure> {
    let order = args.lti.flatten();
    let asked = Asked { columns: &args.columns, step: args.sampling_time, order };
    let records = asked.records(&args.data, look)?;
    look.hear_interrupts()?;
    let found = linear_with(&records, order, look)?;
    look.clear();
    stdout::model(&found.system, &args.out, "Written by `lacuna estimate --lti`.")?;
    summarise(&found, look);
    if args.out.as_os_str() != "-" {
        look.say(&format!("Wrote {}", args.out.display()));
    }
    let file = args.out.display().to_string();
    look.document(&documents::linear(&found, Some(&file)));
    Ok(0)
}

fn summarise(found: &LinearEstimate, look: &Console) {
    let values: Vec<String> =
        found.singular_values.iter().take(16).map(|value| number(*value, None)).collect();
    look.detail(&format!("singular values: {}", values.join(", ")));
    look.detail(&format!("{} stand above the noise", number(found.edge, None)));
    look.headline(&format!("A linear model of order {}", found.order));
    for mode in &found.modes {
        look.result(&format!("  {}", words(mode)));
    }
    for parameter in &found.parameters {
        look.result(&line(parameter));
    }
    for remark in &found.remarks {
        look.result(remark);
    }
    let (before, after) = found.nrmse;
    look.result(&format!("NRMSE {before:.4} before the refinement, {after:.4} after"));
}

fn words(mode: &Mode) -> String {
    let [re, im] = mode.pole;
    match (mode.frequency, mode.damping, mode.time_constant) {
        (Some(frequency), Some(damping), _) => format!(
            "poles {re:.6} +- {im:.6}i: {} Hz, damping ratio {}",
            number(frequency, None),
            number(damping, None)
        ),
        (.., Some(time)) => format!("pole {re:.6}: time constant {} s", number(time, None)),
        _ => format!("pole {re:.6}"),
    }
}

fn line(p: &LinearParameter) -> String {
    format!("{} = {}", p.name, estimated(p.value, p.std_error, &p.unit))
}
