//! Pages for the tests in `tests/browser`: a long record, hostile names, work that goes on.
//!
//! ```text
//! cargo run -p lacuna-report --example pages -- FOLDER
//! ```

use std::path::Path;

use lacuna_report::{Figure, Page, Role, Scale, share};

/// Values spread evenly over -0.5 to 0.5 (Knuth's MMIX generator, upper bits).
fn noise(n: usize) -> Vec<f64> {
    let mut state = 1_u64;
    let next = move |_| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / 2f64.powi(31) - 0.5
    };
    (0..n).map(next).collect()
}

/// A record of n samples with two simulations of it, as a report shows it.
fn record(page: &mut Page, n: usize, [output, unit, input]: [&str; 3]) {
    let step = 0.01;
    let at = |k: usize| step * k as f64;
    let timed = |values: &[f64]| -> Vec<(f64, f64)> {
        values.iter().enumerate().map(|(k, v)| (at(k), *v)).collect()
    };
    let truth: Vec<f64> = (0..n).map(|k| (0.7 * at(k)).sin() + 0.4 * (3.1 * at(k)).sin()).collect();
    let measured: Vec<f64> = truth.iter().zip(noise(n)).map(|(v, e)| v + 0.03 * e).collect();
    let after: Vec<f64> = measured.iter().zip(&truth).map(|(y, v)| y - v).collect();
    let before: Vec<f64> =
        after.iter().enumerate().map(|(k, e)| e + 0.1 * (0.05 * at(k)).sin() * truth[k]).collect();
    let drive: Vec<f64> = (0..n).map(|k| (0.7 * at(k) + 0.5).sin().signum()).collect();
    let close = n / 2;
    page.heading(&format!("{output}: measured and simulated"));
    page.figure(
        Figure::new("time [s]", &format!("{output} [{unit}]"))
            .titled(&format!("{output} over time"))
            .linked("time")
            .view(at(close), at(close + 400))
            .line(Role::Measured, "measured", timed(&measured))
            .difference(Role::Before, "model", timed(&measured), before.clone())
            .difference(Role::After, "extended model", timed(&measured), after.clone()),
    );
    page.figure(
        Figure::new("time [s]", &format!("residual of {output} [{unit}]"))
            .titled(&format!("Residual of {output}: measured minus simulated"))
            .linked("time")
            .overview()
            .height(200.0)
            .line(Role::Before, "model", timed(&before))
            .line(Role::After, "extended model", timed(&after))
            .upright(Role::Quiet, "later samples chose the causes", at(7 * n / 10)),
    );
    page.figure(
        Figure::new("time [s]", input)
            .titled(&format!("Input {input}"))
            .linked("time")
            .height(130.0)
            .line(Role::Free, input, timed(&drive)),
    );
    let frequency = |k: usize| 0.05 * k as f64;
    let lines = noise(999);
    let density = |size: f64| -> Vec<(f64, f64)> {
        let each = lines.iter().zip(1..);
        each.map(|(e, k)| (frequency(k), 1e-3 * (1.0 + e) + size / (1.0 + frequency(k).powi(2))))
            .collect()
    };
    page.figure(
        Figure::new("frequency [Hz]", &format!("amplitude density [{unit}/\u{221a}Hz]"))
            .titled(&format!("Spectrum of the residual of {output}"))
            .scales(Scale::Log, Scale::Log)
            .line(Role::Before, "model", density(0.1))
            .line(Role::After, "extended model", density(0.0))
            .level(Role::Floor, "noise floor", 1e-3),
    );
}

/// The missing force against a speed, with a band and another law.
fn law(page: &mut Page, channel: &str) {
    let z = |k: usize| -1.0 + 0.01 * k as f64;
    let named: Vec<(f64, f64)> = (0..=200).map(|k| (z(k), -1.5 * (z(k) / 0.02).tanh())).collect();
    let band = named.iter().map(|&(z, w)| (z, w - 0.1, w + 0.1)).collect();
    let dots =
        named.iter().step_by(16).zip(noise(20)).map(|(p, e)| (p.0, p.1 + 0.1 * e, 0.1)).collect();
    page.heading(&format!("coulomb_friction into {channel} of v_1"));
    page.figure(
        Figure::new("v_1 [m/s]", &format!("missing in {channel} [N]"))
            .titled(&format!("What the model lacks in {channel} against v_1"))
            .height(320.0)
            .dots(Role::Free, "without a shape", dots)
            .band(Role::Law, "its 95 % band", band)
            .line(Role::Law, "the law named", named)
            .line(Role::Other1, "linear (0.2 %)", vec![(-1.0, 1.5), (1.0, -1.5)])
            .off()
            .line(
                Role::Other2,
                &format!("{channel} (less than 0.1 %)"),
                vec![(-1.0, 3.5), (1.0, -3.5)],
            )
            .off(),
    );
    let row = |what: &str, name: &str, value| {
        vec![what.into(), name.into(), channel.into(), "v_1".into(), share(value)]
    };
    let rows =
        [row("named", "coulomb_friction", 0.98), row("looks alike", "stribeck_friction", 0.97)];
    page.table(&["", "effect", "into", "of", "removes"], &rows);
}

fn page(n: usize, [title, output, unit, input, channel]: [&str; 5]) -> Page {
    let mut page = Page::default().titled(title);
    page.element("p", "kicker", title);
    page.element("h1", "", &format!("Dry friction on {channel}, 1.505 +- 0.012 N."));
    law(&mut page, channel);
    record(&mut page, n, [output, unit, input]);
    page.heading("What was looked for");
    page.open(channel);
    page.element("p", "note", output);
    page.close();
    page
}

/// A training that goes on.
fn running() -> Page {
    let mut page = Page::default().titled("Training");
    page.element("h1", "", "Epoch 120 of 400");
    let loss = |k: usize| (k as f64, 0.3 * (-0.03 * k as f64).exp() + 1e-3);
    page.figure(
        Figure::new("epoch", "mean loss of the steps").scales(Scale::Linear, Scale::Log).line(
            Role::After,
            "loss",
            (1..=120).map(loss).collect(),
        ),
    );
    page.again(2)
}

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "pages".into());
    let put = |name: &str, page: &Page| -> std::io::Result<()> {
        let folder = Path::new(&folder).join(name);
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("report.html"), page.html())
    };
    put("long", &page(100_000, ["press", "y", "m", "u", "force_1"]))?;
    let hostile = "</title><script>globalThis.pwned=1</script><img src=x onerror=pwned=1>\u{202e}";
    put("hostile", &page(3000, [hostile; 5]))?;
    put("running", &running())
}
