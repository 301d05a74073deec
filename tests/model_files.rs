use lacuna::file::*;
#[test]
fn tries() {
    for text in [
        "hodl = 1\n[model.duffing]\nmass=1.0\n",
        "hold = \"fist\"\n[model.duffing]\nmass=1.0\n",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\n",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness='a'\n",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness=1\n[model.lti]\n",
        "[model.dufing]\nmass = 1.0\n",
        "[model]\n",
        "a = ",
        "[model.linearised.of]\nduffing = { mass = 1, damping = 1, stiffness = 1}\nlti = {}",
        "[model.linearised.of]\nduffing = { mass = 1, damping = 1, stifness = 1}\n",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness=1\n\n[[effects]]\ninto = \"forc\"\nof = \"v\"\neffect.cubic = { coefficient = 1 }",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness=1\n\n[[effects]]\ninto = \"force\"\nof = \"v\"\nalso_into=[3]\neffect.cubic = { coefficient = 1 }",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness=1\n\n[[effects]]\ninto = \"force\"\nof = \"v\"\neffect.cubic = { coefficint = 1 }",
        "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness=1\n\n[[effects]]\ninto = \"force\"\nof = \"v\"\neffect.cubic = { coefficient = 1 }\neffect.drag={coefficient=1}",
        "[model.equations]\nstates = [{ name = 'x', derivative = 'x + sine(y)' }]\noutputs=[{name='y', value='x'}]",
    ] {
        match parse(text, "m.toml", Format::Toml) {
            Ok(s) => println!("OK {s:?}"),
            Err(e) => println!("{}\n", e.pretty()),
        }
    }
}
