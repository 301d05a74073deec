//! A finish by least squares, on few sections; samples in which a section settles.

use lacuna::train::Trainer;

use super::learned_part::{gain, run, task};

#[test]
fn a_finish_by_least_squares_is_as_low_in_a_few_steps_on_a_few_sections() {
    let slow = run("optimiser = { rate = 5e-3 }\nfinish = { legs = 3, steps = 30 }\n");
    let fast = run("optimiser = { rate = 5e-3 }\n\
        finish = { legs = 2, steps = 5, sections = 60, optimiser.levenberg_marquardt = {} }\n");
    println!("{} and {}", gain(&slow), gain(&fast));
    assert!(gain(&fast) < 1.05 * gain(&slow), "{} and {}", gain(&slow), gain(&fast));
    // a penalty that is no square is refused, and says so
    let (recipe, start, [training, validation]) =
        task("sparse = { s = 1e-6 }\nfinish.optimiser.levenberg_marquardt = {}\n");
    let error = recipe.training.fit(&start, &[training], &[validation], &mut ()).unwrap_err();
    assert!(error.to_string().contains("levenberg_marquardt"), "{error}");
}

#[test]
fn samples_in_which_a_section_settles_do_not_count() {
    let (recipe, start, [training, _]) = task("settle = 6\n");
    let training = [training];
    let parameters = start.parameters();
    let of = |length: usize, settle: usize| {
        let trainer = Trainer { length, settle, ..recipe.training.clone() };
        let mut loss = trainer.loss(&start, &training).unwrap();
        let mut gradient = vec![0.0; loss.count()];
        let value = loss.loss(&parameters, &[40, 200], Some(&mut gradient)).unwrap();
        (value, gradient)
    };
    let (whole, begun, rest) = (of(20, 0), of(6, 0), of(20, 6));
    let left = |whole: f64, begun: f64| (20.0 * whole - 6.0 * begun) / 14.0;
    assert!((rest.0 - left(whole.0, begun.0)).abs() < 1e-12 * whole.0);
    for (i, slope) in rest.1.iter().enumerate() {
        let wanted = left(whole.1[i], begun.1[i]);
        assert!((slope - wanted).abs() < 1e-9 * (1.0 + wanted.abs()), "{i}: {slope}, {wanted}");
    }
    let (recipe, start, [training, validation]) = task("settle = 20\n");
    let error = recipe.training.fit(&start, &[training], &[validation], &mut ()).unwrap_err();
    assert!(error.to_string().contains("settle"), "{error}");
}
